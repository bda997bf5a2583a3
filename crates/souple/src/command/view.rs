//! `souple view`: a scene live in the browser.

use std::net::{IpAddr, Ipv4Addr};
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;

use souple_engine::Timeline;
use souple_scene::Scene;
use souple_view::{Catalogue, Options, ViewError, Viewer};

use super::{
    End, Refusal, print_line, print_note, read_scene, scene_path, timeline_of, use_threads, write_trace,
};

#[derive(clap::Args)]
pub struct Arguments {
    /// Scene file, or a folder with a scene.toml; the liver where left out
    scene: Option<String>,
    /// Changes a value of the scene: `bodies.liver.material.youngs_modulus="3 kPa"`; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    settings: Vec<String>,
    /// Port of the page; 0 picks a free one
    #[arg(long, default_value_t = PORT)]
    port: u16,
    /// Address to listen on; beyond this machine (0.0.0.0) a token is asked for, which is part of the address printed
    #[arg(long, default_value_t = LOOPBACK)]
    host: IpAddr,
    /// Worker threads; the results do not depend on it
    #[arg(long)]
    threads: Option<usize>,
    /// Writes at the end who did what when, as trace events that chrome://tracing and Perfetto draw
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
}

const PORT: u16 = 7878;
const LOOPBACK: IpAddr = IpAddr::V4(Ipv4Addr::LOCALHOST);
/// The scene of `souple view` alone, as it is in the repository.
const DEFAULT_SCENE: &str = include_str!("../../../../scenes/surgical/scene.toml");
/// Where other scenes are looked for, from the current folder.
const SCENES: &str = "scenes";

pub fn view(arguments: &Arguments) -> Result<End, Refusal> {
    if let Some(problem) = souple_view::missing_page() {
        return Err(Refusal::work("page", format!("this program was built without the page: {problem}")));
    }
    use_threads(arguments.threads)?;
    let timeline = timeline_of(arguments.trace.as_ref())?;
    let viewer = open(arguments, arguments.port, &timeline)?.map_err(refuse)?;
    // the first line is the address
    print_line(viewer.address());
    print_note("open it in a browser; Ctrl-C ends");
    let end = watch(viewer)?;
    let lost = write_trace(arguments.trace.as_ref(), &timeline);
    if let Some(refusal) = &lost {
        refusal.print(false);
    }
    Ok(end.with(lost.as_ref()))
}

/// Greets, shows the default scene, and says what to try next: what the program does without arguments. Where the port
/// is taken any other serves.
pub fn view_default_scene() -> Result<End, Refusal> {
    let arguments = Arguments {
        scene: None,
        settings: Vec::new(),
        port: PORT,
        host: LOOPBACK,
        threads: None,
        trace: None,
    };
    let timeline = Timeline::default();
    let viewer = match open(&arguments, arguments.port, &timeline)? {
        Err(ViewError::Bind { .. }) => open(&arguments, 0, &timeline)?,
        opened => opened,
    };
    let viewer = viewer.map_err(refuse)?;
    print_line(viewer.address());
    print_note(
        "Souple, a simulator of soft things. Open this address in a browser: a liver of three meshes hangs from its ligament; pull it, or push a tool on it.\n\
         Ctrl-C ends. Try next:\n  \
         souple list materials\n  \
         souple check scenes/cantilever\n  \
         souple run scenes/twisted_bar --out out/twisted_bar",
    );
    watch(viewer)
}

fn open(arguments: &Arguments, port: u16, timeline: &Timeline) -> Result<Result<Viewer, ViewError>, Refusal> {
    let (scene, scene_name) = read(arguments)?;
    for warning in &scene.warnings {
        print_note(format_args!("warning: {warning}"));
    }
    let catalogue = Catalogue::of_folder(Path::new(SCENES));
    Ok(Viewer::open(
        scene,
        Options { host: arguments.host, port, scene_name, catalogue, timeline: timeline.clone() },
    ))
}

/// Until somebody ends it.
fn watch(viewer: Viewer) -> Result<End, Refusal> {
    let (stop, stopped) = channel();
    // a second handler in one process (never, for a command line) would be refused: then Ctrl-C just ends it
    let _ = ctrlc::set_handler(move || {
        let _ = stop.send(());
    });
    let _ = stopped.recv();
    viewer.close();
    Ok(End::Interrupted)
}

fn read(arguments: &Arguments) -> Result<(Scene, String), Refusal> {
    if let Some(path) = &arguments.scene {
        return Ok((read_scene(path, &arguments.settings)?, scene_path(path).display().to_string()));
    }
    // where the repository is at hand, under the name that other commands take
    let file = Path::new(SCENES).join("surgical/scene.toml");
    if file.is_file() {
        let name = file.display().to_string();
        return Ok((read_scene(&name, &arguments.settings)?, name));
    }
    let scene = souple_scene::read_text("surgical", DEFAULT_SCENE, Path::new("."), &arguments.settings)?;
    Ok((scene, "surgical".to_owned()))
}

fn refuse(error: ViewError) -> Refusal {
    match &error {
        ViewError::Bind { address, .. } => {
            Refusal::request("port", address.to_string(), "a free port", error.to_string())
        }
        ViewError::Token(_) | ViewError::Thread(_) | ViewError::World(_) => {
            Refusal::work("view", error.to_string())
        }
    }
}
