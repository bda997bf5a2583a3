//! The picture of the last state, and the plots of the probes.

use souple_io::plot::{Axis, Curve, Plot};
use souple_scene::spec::picture::PictureView;

use crate::output::{OutputError, OutputFolder};
use crate::show::{Figure, Moment, Show, ShowError, Stage};
use crate::{Session, Trace};

/// The picture of the last state.
pub const PICTURE: &str = "last.png";

/// All bodies of a moment, coloured by the von Mises stress of their cells, and the shapes they touch, into the folder
/// of a run.
///
/// # Errors
/// The file cannot be written.
pub fn write_last(
    folder: &mut OutputFolder,
    title: &str,
    from: PictureView,
    session: &Session,
    moment: &Moment,
) -> Result<(), OutputError> {
    let mut stage = Stage::of_model(session.world.model(), &session.bodies, from);
    stage.title = title.to_owned();
    let moment = moment.clone().without_worn();
    let show = Show { stage, moments: Vec::new() };
    let figure = Figure { samples_per_pixel: 2, ..Figure::default() };
    let plain = Figure { colour_by: None, ..figure.clone() };
    // bodies without stress are shown in colours of their own
    let picture = match figure.picture(&show, &moment).or_else(|_| plain.picture(&show, &moment)) {
        Ok(picture) => picture,
        Err(ShowError::Io(error)) => return Err(error.into()),
        Err(_) => return Ok(()),
    };
    Ok(picture.render()?.write_png(&folder.claim(PICTURE)?)?)
}

/// The files of a probe's plot.
pub fn plot_names(probe: &str) -> [String; 2] {
    [format!("{probe}.svg"), format!("{probe}.plot.png")]
}

/// A plot over time for each probe, `NAME.svg` and `NAME.plot.png`.
///
/// # Errors
/// A file cannot be written.
pub fn write_plots(folder: &mut OutputFolder, traces: &[Trace]) -> Result<(), OutputError> {
    for trace in traces.iter().filter(|trace| trace.times.len() > 1) {
        let component = |c: usize| trace.values.iter().skip(c).step_by(trace.components).copied().collect();
        let curves = match trace.components {
            1 => vec![Curve::new("", trace.times.clone(), component(0))],
            _ => ["x", "y", "z"]
                .into_iter()
                .enumerate()
                .map(|(c, name)| Curve::new(name, trace.times.clone(), component(c)))
                .collect(),
        };
        let plot = Plot {
            title: trace.name.clone(),
            x: Axis::new("time", "s"),
            y: Axis::new(trace.quantity.replace('_', " "), trace.unit),
            curves,
            ..Plot::default()
        };
        let [drawing, image] = plot_names(&trace.name);
        plot.write_svg(&folder.claim(&drawing)?)?;
        plot.to_image(2.0)?.write_png(&folder.claim(&image)?)?;
    }
    Ok(())
}
