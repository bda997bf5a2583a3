//! `souple render`: pictures, contact sheets, films and animated surfaces of a scene, of a run's folder or of a mesh.

mod figure;
mod fit;
mod overlay;
mod sheet;

use std::cell::OnceCell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use serde_json::json;
use souple_io::picture::{
    Backdrop, Cut, Image, ImageFile, Images, LegendPlace, Picture, write_animated_png, write_gif,
};
use souple_run::Options;
use souple_run::show::{Figure, Gathering, Moment, Reel, Show, ShowError, Stage, Worn, write_film};
use tempfile::TempDir;

use self::fit::Source;
use self::sheet::Sheet;
use super::progress::Meter;
use super::run::play;
use super::{
    End, Refusal, interruption, print_json, print_line, print_note, read_scene, scene_path, seconds,
    thread_count, use_threads,
};

#[derive(clap::Args)]
#[command(allow_negative_numbers = true)]
pub struct Arguments {
    /// Scene file or folder with a scene.toml, which is run; the folder of a run, whose frames are shown; a file of a mesh, with its
    /// fields; or a series of them, .pvd
    source: PathBuf,
    /// .png: one picture or a sheet; .gif, .apng, .mp4: a film; .glb: the moving surfaces
    #[arg(long)]
    out: PathBuf,
    /// Width and height in pixels; of a sheet those of the whole
    #[arg(long, value_name = "WIDTH,HEIGHT", value_parser = pixels, allow_hyphen_values = true)]
    size: Option<[usize; 2]>,
    /// Moment to show, as `0.5` or `500 ms`, to the nearest frame; the last by default
    #[arg(long, conflicts_with_all = ["sheet", "overlay"], value_parser = seconds)]
    time: Option<f64>,
    /// Several moments in one picture
    #[arg(long, value_name = "COUNT", value_parser = whole::<1, 100>)]
    sheet: Option<u64>,
    /// Several moments over each other, the earlier the fainter: a chronogram
    #[arg(long, value_name = "COUNT", conflicts_with = "sheet", value_parser = whole::<2, 100>)]
    overlay: Option<u64>,
    /// Most frames of a film; 60 if left out
    #[arg(long, value_parser = whole::<1, 4096>)]
    frames: Option<u64>,
    /// Frames of a film per second, 0.1 to 100; in real time if left out
    #[arg(long, value_parser = per_second)]
    per_second: Option<f64>,
    /// Quantity of the colours: `von_mises`, `displacement`, `velocity.x`, `stress.xx`, `element`, `adaptation`, `gap`, …,
    /// `none`; `von_mises` if left out, where there is stress
    #[arg(long)]
    colour: Option<String>,
    /// sequential, diverging, grey, adaptation, elements; that of the quantity if left out
    #[arg(long)]
    map: Option<String>,
    /// linear, or log: by powers of ten
    #[arg(long, value_name = "SCALE")]
    colour_scale: Option<String>,
    /// The folder of another run, from which the quantity `gap` is measured
    #[arg(long, value_name = "RUN")]
    against: Option<PathBuf>,
    /// Values of the first and the last colour, in Pa, m, m/s, …, whatever the legend says, or with units: `1 kPa,5 kPa`
    #[arg(long, value_name = "LOW,HIGH", value_parser = two, allow_hyphen_values = true)]
    range: Option<[String; 2]>,
    /// Cuts away of bodies what lies beyond the plane n · x = d, shapes stay whole; not with --shrink
    #[arg(long, value_name = "NX,NY,NZ,D", value_parser = list::<4>, allow_hyphen_values = true)]
    cut: Option<[f64; 4]>,
    /// Moves cells apart, by this part of their distance from the middle; with a cut, those that it leaves whole
    #[arg(long, default_value_t = 0.0)]
    explode: f64,
    /// Draws each cell smaller by this part of its size, about its own middle; not with --cut
    #[arg(long, default_value_t = 0.0, conflicts_with = "cut")]
    shrink: f64,
    /// Arrows of a vector field, `displacement` or `velocity`, each from where its point stands; a key tells their length
    #[arg(long, value_name = "FIELD")]
    arrows: Option<String>,
    /// Metres of arrow for each unit of the field; fitted if left out
    #[arg(long, requires = "arrows", value_parser = positive)]
    arrow_scale: Option<f64>,
    /// Edges of the mesh: drawn, hidden, wireframe; drawn if left out
    #[arg(long)]
    edges: Option<String>,
    /// Axes of the frames that carry bodies: drawn, numbered, hidden; drawn if left out
    #[arg(long)]
    frame_axes: Option<String>,
    /// From the eye towards the bodies, everything in the picture; the scene's if left out
    #[arg(long, value_name = "X,Y,Z", value_parser = list::<3>, allow_hyphen_values = true)]
    direction: Option<[f64; 3]>,
    /// Where the eye is [m]
    #[arg(long, value_name = "X,Y,Z", value_parser = list::<3>, allow_hyphen_values = true, requires = "look_at", conflicts_with = "direction")]
    position: Option<[f64; 3]>,
    /// What is in the middle [m]
    #[arg(long, value_name = "X,Y,Z", value_parser = list::<3>, allow_hyphen_values = true, requires = "position")]
    look_at: Option<[f64; 3]>,
    /// What is up in the picture; the scene's if left out
    #[arg(long, value_name = "X,Y,Z", value_parser = list::<3>, allow_hyphen_values = true)]
    up: Option<[f64; 3]>,
    /// From the lamp that throws shadows towards the bodies; over the eye's left shoulder if left out
    #[arg(long, value_name = "X,Y,Z", value_parser = list::<3>, allow_hyphen_values = true)]
    light: Option<[f64; 3]>,
    /// A floor below the bodies that their shadows fall on, where the scene has no ground
    #[arg(long)]
    floor: bool,
    /// Angle between the upper and the lower border [deg], 1 to 140; 28.65 if left out
    #[arg(long, value_parser = degrees)]
    field_of_view: Option<f64>,
    /// In place of the scene's; "" for none
    #[arg(long)]
    title: Option<String>,
    /// No time under the title
    #[arg(long)]
    no_time: bool,
    /// The axes x, y, z in the lower left corner
    #[arg(long)]
    axes: bool,
    /// A bar of a round length, as seen in the middle of the bodies
    #[arg(long)]
    scale_bar: bool,
    /// No legend of the colours
    #[arg(long)]
    no_legend: bool,
    #[arg(long)]
    dark: bool,
    /// A white background, as that of a page
    #[arg(long, conflicts_with = "dark")]
    white: bool,
    /// A PNG of at most 255 colours, a third of the size
    #[arg(long)]
    compact: bool,
    /// Samples along each side of a pixel; 3 by default, 2 where there are several pictures
    #[arg(long, value_parser = whole::<1, 8>)]
    samples: Option<u64>,
    /// Changes a value of the scene, as with `souple run`
    #[arg(long = "set", value_name = "PATH=VALUE")]
    settings: Vec<String>,
    #[arg(long, value_parser = thread_count)]
    threads: Option<usize>,
    #[arg(long)]
    pub json: bool,
    /// No progress
    #[arg(long)]
    quiet: bool,
}

impl Arguments {
    /// Whether what is asked for is of bodies, also of those that a skin hides.
    fn looks_inside(&self) -> bool {
        let has_colour = self.colour.as_ref().is_some_and(|colour| colour != "none");
        has_colour || self.cut.is_some() || self.explode > 0.0 || self.shrink > 0.0
    }
}

/// `N` finite numbers with commas.
fn list<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    numbers
        .filter(|numbers| numbers.iter().all(|number| number.is_finite()))
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| format!("expected {N} numbers with commas, as {}", vec!["1"; N].join(",")))
}

/// Two ends, which are numbers or quantities as their unit says.
fn two(text: &str) -> Result<[String; 2], String> {
    let ends: Vec<String> = text.split(',').map(|end| end.trim().to_owned()).collect();
    let ends = <[String; 2]>::try_from(ends).ok().filter(|ends| ends.iter().all(|end| !end.is_empty()));
    ends.ok_or_else(|| "expected 2 numbers with commas, as 0,1000 or 0 kPa,1 kPa".to_owned())
}

/// Width and height of a picture.
fn pixels(text: &str) -> Result<[usize; 2], String> {
    let sides: Vec<Option<usize>> =
        text.split([',', 'x', '×']).map(|side| side.trim().parse().ok()).collect();
    match sides[..] {
        [Some(width), Some(height)] if [width, height].iter().all(|side| (1..=16384).contains(side)) => {
            Ok([width, height])
        }
        _ => Err("expected width and height, whole numbers of 1 to 16384 pixels, as 1280,800".to_owned()),
    }
}

/// A whole number between two others.
fn whole<const LOW: u64, const HIGH: u64>(text: &str) -> Result<u64, String> {
    let number = text.trim().parse().ok().filter(|number| (LOW..=HIGH).contains(number));
    number.ok_or_else(|| format!("expected a whole number, {LOW} to {HIGH}"))
}

fn degrees(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "expected a number of degrees, 1 to 140".to_owned())
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "expected a number above 0".to_owned())
}

fn per_second(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number| (0.1..=100.0).contains(number));
    number.ok_or_else(|| "a film can be played at 0.1 to 100 frames per second".to_owned())
}

/// What to say of a picture without what it should have.
fn no_room(left_out: &[&str]) -> Option<String> {
    let (last, others) = left_out.split_last()?;
    let all =
        if others.is_empty() { (*last).to_owned() } else { format!("{} and {last}", others.join(", ")) };
    Some(format!("the picture has no room for: {all}; expected a larger `--size`"))
}

/// Most frames of a film where nothing is said.
const FRAMES: u64 = 60;

/// What a file's name asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Picture,
    Gif,
    AnimatedPng,
    Film,
    Surfaces,
}

const KINDS: [(&str, Kind); 5] = [
    ("png", Kind::Picture),
    ("gif", Kind::Gif),
    ("apng", Kind::AnimatedPng),
    ("mp4", Kind::Film),
    ("glb", Kind::Surfaces),
];

impl From<ShowError> for Refusal {
    fn from(error: ShowError) -> Self {
        match error {
            ShowError::Io(error) => error.into(),
            ShowError::UnknownField { ref name, ref expected } => Self::request(
                "field",
                name.clone(),
                expected.clone(),
                format!("no body has the field `{name}`"),
            ),
            ref other => Self::request("render", "", "", other.to_string()),
        }
    }
}

impl Arguments {
    /// How many moments one picture shows.
    fn moments(&self) -> Option<u64> {
        self.sheet.or(self.overlay)
    }
}

pub fn render(arguments: &Arguments) -> Result<End, Refusal> {
    use_threads(arguments.threads)?;
    let kind = kind_of(&arguments.out)?;
    let source = fit::source(&arguments.source);
    fit::check(arguments, kind, source)?;
    interruption::heed();
    let figure = figure::figure(arguments, kind)?;
    let scratch = Scratch::default();
    let (mut reel, mut notes) = reel(arguments, kind, source, &scratch)?;
    if interruption::is_interrupted() {
        return Ok(End::Interrupted);
    }
    if let Some(other) = &arguments.against {
        let other = Reel::of_run(other, reel.stage.clone())?;
        reel = reel.against(other);
    }
    if figure.worn == Worn::Arrows && arguments.arrows.is_none() {
        reel = reel.without_worn();
    }
    let view = figure::view(arguments, &reel.stage)?;
    // a mesh by itself has no time
    let clock = figure.clock && source != Source::Mesh;
    let figure = Figure { view: Some(view), clock, ..figure };
    let Some(count) = draw(arguments, kind, (&reel, &scratch), figure, &mut notes)? else {
        return Ok(End::Interrupted);
    };
    notes.iter().for_each(print_note);
    let out = arguments.out.as_path();
    if arguments.json {
        print_json(&json!({"out": out.display().to_string(), "moments": count, "notes": notes}));
    } else if !arguments.quiet {
        print_line(out.display());
    }
    Ok(End::Done)
}

/// Draws what is asked for, and no other moments; how many those were, `None` where Ctrl-C ends it.
fn draw(
    arguments: &Arguments,
    kind: Kind,
    (reel, scratch): (&Reel, &Scratch),
    figure: Figure,
    notes: &mut Vec<String>,
) -> Result<Option<usize>, Refusal> {
    let out = arguments.out.as_path();
    let chosen = reel.chosen(match kind {
        Kind::Picture => arguments.moments().unwrap_or(1),
        _ => arguments.frames.unwrap_or(FRAMES),
    } as usize);
    let asked = if kind == Kind::Picture { arguments.moments() } else { arguments.frames };
    notes.extend(
        asked
            .filter(|asked| chosen.len() < *asked as usize)
            .map(|asked| format!("there are {} moments, not {asked}: each is shown once", chosen.len())),
    );
    match kind {
        Kind::Surfaces => {
            let show = reel.show(&chosen)?;
            let figure = in_colours(arguments, figure, show.moments.first(), notes);
            let (animation, of_all) = figure.animation(&show)?;
            notes.extend(of_all);
            if figure.colour_by.is_some() && show.moments.len() > 1 {
                notes.push(
                    "points move in it, and keep the colours of the last moment: glTF moves no colours"
                        .to_owned(),
                );
            }
            animation.write_glb(out)?;
        }
        Kind::Picture if arguments.moments().is_some() => {
            let show = reel.show(&chosen)?;
            let figure = in_colours(arguments, figure, show.moments.first(), notes);
            let Some(image) = sheet_of(arguments, &show, figure, notes)? else { return Ok(None) };
            write_picture(arguments, &image)?;
        }
        Kind::Picture => {
            let moment = match arguments.time {
                Some(time) => reel.moment(reel.nearest(time), None)?,
                None => reel.last_drawable()?,
            };
            let figure = in_colours(arguments, figure, Some(&moment), notes);
            notes.extend(figure.cut.and_then(|cut| of_cut(cut, [reach(cut, &moment)].into_iter())));
            notes.extend(other_moment(arguments.time, &moment, reel));
            let show = Show { stage: reel.stage.clone(), moments: vec![moment] };
            let (pictures, of_all) = figure.pictures(&show)?;
            notes.extend(of_all);
            for picture in pictures {
                notes.extend(no_room(&picture.left_out()));
                write_picture(arguments, &picture.render()?)?;
            }
        }
        Kind::Gif | Kind::AnimatedPng | Kind::Film => {
            let first = chosen.first().map(|first| reel.moment(*first, None)).transpose()?;
            let figure = in_colours(arguments, figure, first.as_ref(), notes);
            let Some(film) = film(arguments, (reel, &chosen), &figure, (scratch, notes))? else {
                return Ok(None);
            };
            write_moving(kind, out, &film, seconds_per_frame(arguments, reel, &chosen))?;
        }
    }
    Ok(Some(chosen.len()))
}

/// The same figure without colours where none are asked for and there is no stress to show: what there is at the first moment is
/// there at all or at none. Options that change nothing then are told.
fn in_colours(
    arguments: &Arguments,
    figure: Figure,
    first: Option<&Moment>,
    notes: &mut Vec<String>,
) -> Figure {
    let has_stress = |moment: &Moment| {
        let mut seen = moment.bodies.iter().filter(|body| !figure.hides(moment, body));
        seen.any(|body| body.has_field(figure::STRESS))
    };
    if arguments.colour.is_some() || first.is_none_or(has_stress) {
        return figure;
    }
    let unheard = fit::of_colours(arguments).map(|name| {
        format!("no body has stress, and no other quantity is named by `--colour`: --{name} changes nothing")
    });
    notes.extend(unheard);
    Figure { colour_by: None, ..figure }
}

/// Some moments in one picture, with what they have in common once; `None` where Ctrl-C ends it.
fn sheet_of(
    arguments: &Arguments,
    show: &Show,
    figure: Figure,
    notes: &mut Vec<String>,
) -> Result<Option<Image>, Refusal> {
    notes.extend(figure.cut.and_then(|cut| of_cut(cut, show.moments.iter().map(|m| reach(cut, m)))));
    // one title for all of them
    let title = figure.title.clone().unwrap_or_else(|| show.stage.title.clone());
    let backdrop = if arguments.white { Backdrop::White } else { Backdrop::Plain };
    let legend = figure.legend.map(|_| LegendPlace::Apart);
    let whole = arguments.size.map(|_| figure.size);
    let is_overlay = arguments.overlay.is_some();
    let cells = if is_overlay { 1 } else { show.moments.len() };
    let size = sheet::about(cells, whole);
    let letters = if is_overlay { figure.letters } else { sheet::LETTERS };
    let figure = Figure { title: Some(String::new()), backdrop, legend, size, letters, ..figure };
    let (mut pictures, of_all) = figure.pictures(show)?;
    notes.extend(of_all);
    let common = sheet::Common::taken(&mut pictures);
    if is_overlay {
        // each would say its own time
        pictures.iter_mut().for_each(|picture| picture.subtitle.clear());
    }
    let cells = &pictures[..cells.min(pictures.len())];
    let sheet = Sheet::new(cells, whole, (&title, figure.theme), common)?;
    pictures.iter_mut().for_each(|picture| picture.size = sheet.cell);
    let mut left_out = pictures.first().map(Picture::left_out).unwrap_or_default();
    let meter = Meter::new("pictures", arguments.quiet);
    let Some(mut images) = images(&pictures, (&meter, 0, pictures.len()))? else { return Ok(None) };
    if is_overlay {
        let background = pictures.first().map_or([255; 3], Picture::background);
        images = overlay::overlaid(&images, background).into_iter().collect();
    }
    let (image, of_sheet) = sheet.of(&pictures, &images);
    left_out.extend(of_sheet);
    notes.extend(no_room(&left_out));
    Ok(Some(image))
}

/// The images of a film in a file: twice through the moments, for what all have in common and to draw them, with no more of them
/// in memory than are drawn at once.
fn film(
    arguments: &Arguments,
    (reel, chosen): (&Reel, &[usize]),
    figure: &Figure,
    (scratch, notes): (&Scratch, &mut Vec<String>),
) -> Result<Option<ImageFile>, Refusal> {
    let mut gathering = Gathering::new(figure, &reel.stage);
    let (mut reaches, mut before) = (Vec::new(), None);
    for index in chosen {
        let moment = reel.moment(*index, before.as_ref())?;
        gathering.add(&moment)?;
        reaches.extend(figure.cut.map(|cut| reach(cut, &moment)));
        before = Some(moment);
        if interruption::is_interrupted() {
            return Ok(None);
        }
    }
    let common = gathering.finish()?;
    notes.extend(figure.cut.and_then(|cut| of_cut(cut, reaches.into_iter())));
    notes.extend(common.notes.iter().cloned());
    let mut film = ImageFile::create(&scratch.path()?.join("film"))?;
    let meter = Meter::new("pictures", arguments.quiet);
    for part in chosen.chunks(rayon::current_num_threads()) {
        let mut pictures = Vec::with_capacity(part.len());
        for index in part {
            let moment = reel.moment(*index, before.as_ref())?;
            pictures.push(figure.picture_in(&reel.stage, &moment, &common));
            before = Some(moment);
        }
        if film.count() == 0 {
            notes.extend(no_room(&pictures.first().map(Picture::left_out).unwrap_or_default()));
        }
        let Some(images) = images(&pictures, (&meter, film.count(), chosen.len()))? else { return Ok(None) };
        images.iter().try_for_each(|image| film.push(image))?;
    }
    Ok(Some(film))
}

fn kind_of(out: &Path) -> Result<Kind, Refusal> {
    let extension = out.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    KINDS.iter().find(|(name, _)| *name == extension).map(|(_, kind)| *kind).ok_or_else(|| {
        let message = match extension.as_str() {
            "" => format!("{}: the file's extension, which says what is drawn, is missing", out.display()),
            other => format!("{}: nothing is rendered to `.{other}`", out.display()),
        };
        Refusal::request("extension", extension, ".png, .gif, .apng, .mp4 or .glb", message)
    })
}

/// A run's folder and a mesh as they are; a scene after a run into a folder that is removed again.
fn reel(
    arguments: &Arguments,
    kind: Kind,
    source: Source,
    scratch: &Scratch,
) -> Result<(Reel, Vec<String>), Refusal> {
    let from = &arguments.source;
    match source {
        Source::Run => {
            let (stage, note) = Stage::of_report(from);
            return Ok((Reel::of_run(from, stage)?, note.into_iter().collect()));
        }
        Source::Mesh => {
            return Ok(Reel::of_file(from)?);
        }
        Source::Series => return Ok((Reel::of_series(from)?, Vec::new())),
        Source::Scene => {}
    }
    let path = from.display().to_string();
    let scene = read_scene(&path, &arguments.settings)?;
    let stage = Stage::of(&scene);
    let folder = scratch.path()?.join("run");
    let wanted = match kind {
        Kind::Picture => arguments.moments().unwrap_or(if arguments.time.is_some() { 200 } else { 1 }),
        _ => arguments.frames.unwrap_or(FRAMES),
    };
    // the start is shown beside the frames that are written on the way
    let wanted = if wanted > 1 { wanted - 1 } else { 1 };
    let options = Options {
        out: Some(folder.clone()),
        frames: Some(wanted),
        scene_name: scene_path(&path).display().to_string(),
        interruption: interruption::heed(),
        ..Options::default()
    };
    let outcome = play(scene, &options, arguments.quiet)?;
    let mut notes = outcome.report.warnings.clone();
    if outcome.report.status != souple_run::Status::Done {
        notes.push(format!("the run is {}: what it came to is shown", outcome.report.status.as_str()));
        notes.extend(outcome.report.failure.iter().map(|failure| failure.message()));
    }
    Ok((Reel::of_run(&folder, stage)?, notes))
}

/// A folder for what is written on the way, made when it is first asked for and removed when dropped.
#[derive(Default)]
struct Scratch(OnceCell<TempDir>);

impl Scratch {
    fn path(&self) -> Result<&Path, Refusal> {
        if let Some(folder) = self.0.get() {
            return Ok(folder.path());
        }
        let made = tempfile::Builder::new().prefix("souple_render_").tempdir().map_err(|error| {
            let place = std::env::temp_dir();
            Refusal::work("io", format!("no folder can be made in {}: {error}", place.display()))
        })?;
        Ok(self.0.get_or_init(|| made).path())
    }
}

/// What to say of a picture of another moment than one may think.
fn other_moment(wanted: Option<f64>, shown: &Moment, reel: &Reel) -> Option<String> {
    let last = reel.times().last().copied().unwrap_or(shown.time);
    match wanted {
        None if shown.time < last => Some(format!(
            "the bodies have run away: of {:.6} s is the last frame that can be drawn",
            shown.time
        )),
        Some(time) if time > last => {
            Some(format!("there is nothing at {time} s: the last frame, of {last:.6} s, is shown"))
        }
        Some(time) if time < 0.0 => {
            Some(format!("there is nothing at {time} s: the first frame, of {:.6} s, is shown", shown.time))
        }
        _ => None,
    }
}

/// How far the bodies of a moment reach along the normal of a cut: least and greatest [m].
fn reach(cut: Cut, moment: &Moment) -> [f64; 2] {
    let normal = cut.normal * (1.0 / cut.normal.length());
    let points = moment.bodies.iter().flat_map(|body| &body.positions);
    let along = points.filter(|x| x.is_finite()).map(|x| normal.dot(*x));
    along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], d| [low.min(d), high.max(d)])
}

/// What to say where a cut leaves nothing of any body at any of the moments, or takes nothing away.
fn of_cut(cut: Cut, reaches: impl Iterator<Item = [f64; 2]>) -> Option<String> {
    let of_all = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
    let [low, high] = reaches.reduce(of_all)?;
    let plane = cut.normal.dot(cut.point) / cut.normal.length();
    if high <= plane {
        return Some(format!(
            "the cut takes nothing away: along its normal, bodies reach from {low:.4} m to {high:.4} m, and what lies beyond {plane:.4} m is cut away"
        ));
    }
    (low > plane).then(|| {
        format!(
            "the cut leaves nothing: along its normal, bodies reach from {low:.4} m to {high:.4} m, and what lies beyond {plane:.4} m is cut away"
        )
    })
}

/// Pictures drawn side by side on all threads, after so many of all; `None` where Ctrl-C ends it.
fn images(
    pictures: &[Picture],
    (meter, before, all): (&Meter, usize, usize),
) -> Result<Option<Vec<Image>>, Refusal> {
    let done = AtomicU64::new(before as u64);
    let draw = |picture: &Picture| {
        if interruption::is_interrupted() {
            return Ok(None);
        }
        let image = picture.render()?;
        meter.show(done.fetch_add(1, Ordering::Relaxed) + 1, all as u64, "");
        Ok(Some(image))
    };
    pictures.par_iter().map(draw).collect()
}

fn write_picture(arguments: &Arguments, image: &Image) -> Result<(), Refusal> {
    let out = &arguments.out;
    let written = if arguments.compact { image.write_compact_png(out) } else { image.write_png(out) };
    Ok(written?)
}

/// [s]
fn seconds_per_frame(arguments: &Arguments, reel: &Reel, chosen: &[usize]) -> f64 {
    if let Some(per_second) = arguments.per_second {
        return 1.0 / per_second;
    }
    let at = |index: Option<&usize>| index.map(|index| reel.times()[*index]);
    let span = at(chosen.last()).zip(at(chosen.first())).map_or(0.0, |(last, first)| last - first);
    // what programs can play
    (span / (chosen.len().max(2) - 1) as f64).clamp(0.02, 1.0)
}

fn write_moving(kind: Kind, out: &Path, film: &ImageFile, seconds: f64) -> Result<(), Refusal> {
    match kind {
        Kind::Gif => Ok(write_gif(out, film, seconds)?),
        Kind::Film => {
            write_film(out, film, 1.0 / seconds).map_err(|error| Refusal::work("film", error.to_string()))
        }
        _ => Ok(write_animated_png(out, film, seconds)?),
    }
}
