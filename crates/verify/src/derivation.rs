//! What is read of the derivation of a law on an element: counts, as `souple derive` prints them.

use souple_formal::element::{Cut, ElementExpressions};
use souple_formal::law::EnergyLaw;
use souple_mesh::ElementKind;
use souple_models::derive::{MapKind, element_data};
use souple_models::materials::WrittenLaw;

/// What is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// Grouped constants of the energy, added up over its fragments.
    Constants,
    /// Fragments of the differential.
    Fragments,
}

/// The command line that prints it; settings are its arguments, `law=linear`.
pub fn command(settings: &[&str]) -> String {
    let arguments = settings.iter().filter_map(|setting| setting.split_once('='));
    let arguments: String = arguments.map(|(name, value)| format!(" --{name} {value}")).collect();
    format!("souple derive{arguments}")
}

/// The count for these arguments; later ones stand for earlier ones.
///
/// # Errors
/// What an argument is not.
pub fn count(count: Count, settings: &[String]) -> Result<f64, String> {
    let argument = |name: &str| {
        settings.iter().rev().filter_map(|setting| setting.split_once('=')).find(|(key, _)| *key == name)
    };
    let value = |name: &str| argument(name).map(|(_, value)| value);
    let (law, element) = (value("law").unwrap_or_default(), value("element").unwrap_or_default());
    let written = WrittenLaw::find(law).ok_or_else(|| format!("there is no law `{law}`"))?;
    let text = written.text().map_err(|error| error.to_string())?;
    let law = EnergyLaw::compile(&text).map_err(|error| error.explained(&text.energy))?;
    let kind = ElementKind::from_name(element).map_err(|unknown| unknown.to_string())?;
    let rule = match value("rule") {
        Some(name) => kind.rule(name).map_err(|unknown| unknown.to_string())?,
        None => kind.default_rule(),
    };
    let map = if value("map") == Some("box") { MapKind::Box } else { MapKind::General };
    let cut = value("cut").unwrap_or("none");
    let cut = Cut::from_name(cut).ok_or_else(|| format!("there is no cut `{cut}`"))?;
    let element = element_data(kind, rule, map).map_err(|error| error.to_string())?;
    let derived = element.derive(&law, cut).map_err(|error| error.to_string())?;
    let of_fragment = |fragment: &ElementExpressions| fragment.grouped.constants.len();
    Ok(match count {
        Count::Constants => derived.energies.iter().map(of_fragment).sum::<usize>(),
        Count::Fragments => derived.differentials.len(),
    } as f64)
}
