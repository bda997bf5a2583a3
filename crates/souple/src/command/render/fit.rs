//! What goes together: an option with the kind of file and the source that it says something about.

use std::path::Path;

use souple_io::{FORMATS, Format};
use souple_run::show::GAP;
use souple_table::Entry;

use super::{Arguments, KINDS, Kind};
use crate::command::Refusal;

/// What is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    Scene,
    /// The folder of a run.
    Run,
    /// A file that holds a mesh.
    Mesh,
    /// A list of the frames of one body.
    Series,
}

pub fn source(path: &Path) -> Source {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let holds_mesh = |format: &&&Entry<Format>| {
        format.build.read.is_some() && format.build.extensions.contains(&extension.as_str())
    };
    if path.join("frames").is_dir() || path.join("report.json").is_file() {
        Source::Run
    } else if path.is_file() && extension == "pvd" {
        Source::Series
    } else if path.is_file() && FORMATS.entries.iter().any(|format| holds_mesh(&format)) {
        Source::Mesh
    } else {
        Source::Scene
    }
}

/// An option that says something about some kinds of files alone.
struct Limited {
    name: &'static str,
    kinds: &'static [Kind],
    is_given: fn(&Arguments) -> bool,
}

const fn limited(name: &'static str, kinds: &'static [Kind], is_given: fn(&Arguments) -> bool) -> Limited {
    Limited { name, kinds, is_given }
}

const PICTURE: &[Kind] = &[Kind::Picture];
const FILM: &[Kind] = &[Kind::Gif, Kind::AnimatedPng, Kind::Film];
const MOVING: &[Kind] = &[Kind::Gif, Kind::AnimatedPng, Kind::Film, Kind::Surfaces];
const DRAWN: &[Kind] = &[Kind::Picture, Kind::Gif, Kind::AnimatedPng, Kind::Film];

const OPTIONS: &[Limited] = &[
    limited("time", PICTURE, |given| given.time.is_some()),
    limited("sheet", PICTURE, |given| given.sheet.is_some()),
    limited("overlay", PICTURE, |given| given.overlay.is_some()),
    limited("compact", PICTURE, |given| given.compact),
    limited("frames", MOVING, |given| given.frames.is_some()),
    limited("per-second", FILM, |given| given.per_second.is_some()),
    limited("size", DRAWN, |given| given.size.is_some()),
    limited("samples", DRAWN, |given| given.samples.is_some()),
    limited("cut", DRAWN, |given| given.cut.is_some()),
    limited("explode", DRAWN, |given| given.explode != 0.0),
    limited("shrink", DRAWN, |given| given.shrink != 0.0),
    limited("arrows", DRAWN, |given| given.arrows.is_some()),
    limited("edges", DRAWN, |given| given.edges.is_some()),
    limited("frame-axes", DRAWN, |given| given.frame_axes.is_some()),
    limited("direction", DRAWN, |given| given.direction.is_some()),
    limited("position", DRAWN, |given| given.position.is_some()),
    limited("up", DRAWN, |given| given.up.is_some()),
    limited("light", DRAWN, |given| given.light.is_some()),
    limited("floor", DRAWN, |given| given.floor),
    limited("field-of-view", DRAWN, |given| given.field_of_view.is_some()),
    limited("title", DRAWN, |given| given.title.is_some()),
    limited("no-time", DRAWN, |given| given.no_time),
    limited("axes", DRAWN, |given| given.axes),
    limited("scale-bar", DRAWN, |given| given.scale_bar),
    limited("no-legend", DRAWN, |given| given.no_legend),
    limited("dark", DRAWN, |given| given.dark),
    limited("white", DRAWN, |given| given.white),
];

/// Options that are given and say something about colours alone.
pub fn of_colours(arguments: &Arguments) -> impl Iterator<Item = &'static str> {
    let all = [
        ("map", arguments.map.is_some()),
        ("colour-scale", arguments.colour_scale.is_some()),
        ("range", arguments.range.is_some()),
    ];
    all.into_iter().filter(|(_, is_given)| *is_given).map(|(name, _)| name)
}

/// Refuses what cannot be done before anything is.
///
/// # Errors
/// An option says nothing about this kind of file or source, or the file could not be written.
pub fn check(arguments: &Arguments, kind: Kind, source: Source) -> Result<(), Refusal> {
    let out = &arguments.out;
    if let Some(option) =
        OPTIONS.iter().find(|option| (option.is_given)(arguments) && !option.kinds.contains(&kind))
    {
        let names = KINDS.iter().filter(|(_, kind)| option.kinds.contains(kind));
        let known: Vec<String> = names.map(|(extension, _)| format!(".{extension}")).collect();
        let message = format!("--{} says nothing about {}", option.name, out.display());
        return Err(Refusal::request(option.name, out.display().to_string(), known.join(", "), message));
    }
    if source != Source::Scene && !arguments.settings.is_empty() {
        let from = arguments.source.display().to_string();
        let message = format!("--set changes a scene before it is run, and {from} is none");
        return Err(Refusal::request("set", from, "a scene", message));
    }
    let fields = [arguments.colour.as_deref(), arguments.arrows.as_deref()];
    let measures_gap = fields.iter().flatten().any(|field| field.split('.').next() == Some(GAP));
    if measures_gap && arguments.against.is_none() {
        let message =
            "the quantity `gap` is how far bodies stand from those of another run, and none is given";
        return Err(Refusal::request("against", "", "--against RUN, the folder of that run", message));
    }
    if let Some(other) = arguments.against.as_ref().filter(|_| !measures_gap) {
        let message = "--against says nothing without the quantity `gap`".to_owned();
        return Err(Refusal::request("against", other.display().to_string(), "--colour gap", message));
    }
    if let (Some("none"), Some(name)) = (arguments.colour.as_deref(), of_colours(arguments).next()) {
        let message = format!("--{name} says nothing where `--colour none` leaves no quantity to colour by");
        return Err(Refusal::request(name, "none", "a quantity, or no such option", message));
    }
    let size = arguments.size.unwrap_or_default();
    if kind == Kind::Film && size.iter().any(|side| side % 2 != 0) {
        let [width, height] = size;
        let message = format!("a film of {width} x {height} pixels cannot be coded");
        return Err(Refusal::request("size", format!("{width},{height}"), "even numbers of pixels", message));
    }
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        let message = format!("{} cannot be written: there is no folder {}", out.display(), folder.display());
        return Err(Refusal::request(
            "out",
            out.display().to_string(),
            "a file in a folder that exists",
            message,
        ));
    }
    Ok(())
}
