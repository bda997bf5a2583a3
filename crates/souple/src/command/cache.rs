//! Where laws as text are kept between runs.

use std::env;
use std::path::PathBuf;

use souple_models::materials::KeptLaws;

/// The variable that names another folder, or switches it off.
const VARIABLE: &str = "SOUPLE_CACHE";

/// In the user's cache, or where the environment says; `None` where it says `off`, and where the user has no folder.
pub fn kept_laws() -> Option<KeptLaws> {
    let folder = match env::var_os(VARIABLE).filter(|value| !value.is_empty()) {
        Some(value) if value == "off" => return None,
        Some(folder) => PathBuf::from(folder),
        None => user_cache()?.join("souple"),
    };
    Some(KeptLaws::new(folder.join("laws")))
}

/// The folder of what programs may lose; a path that is not absolute is none (XDG Base Directory Specification).
fn user_cache() -> Option<PathBuf> {
    let named = |variable: &str| env::var_os(variable).map(PathBuf::from);
    // whose home is not there, as accounts of services have it, gets none made
    let in_home = |folder: &str| env::home_dir().filter(|home| home.is_dir()).map(|home| home.join(folder));
    let folder = if cfg!(windows) {
        named("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        in_home("Library/Caches")
    } else {
        named("XDG_CACHE_HOME").filter(|folder| folder.is_absolute()).or_else(|| in_home(".cache"))
    };
    folder.filter(|folder| folder.is_absolute())
}
