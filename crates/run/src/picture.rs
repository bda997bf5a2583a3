//! The picture of the last state, and the plots of the probes.

use souple_io::picture::EdgeStyle;
use souple_io::plot::{Axis, Curve, Plot};
use souple_scene::spec::picture::PictureView;

use crate::output::{OutputError, OutputFolder};
use crate::show::{Figure, Moment, Show, ShowError, Stage, TISSUE, map_of};
use crate::{Session, Trace};

/// The picture of the last state.
pub const PICTURE: &str = "last.png";

/// All bodies of a moment, coloured by the von Mises stress of their cells, or by what tools left on surfaces where any shows
/// that, and the shapes they touch, into the folder of a run.
///
/// # Errors
/// The file cannot be written.
pub fn write_last(
    folder: &mut OutputFolder,
    title: &str,
    from: PictureView,
    session: &Session,
    moment: Moment,
) -> Result<(), OutputError> {
    let mut stage = Stage::of_model(session.world.model(), &session.bodies, from);
    stage.title = title.to_owned();
    let moment = moment.without_worn();
    let show = Show { stage, moments: Vec::new() };
    let mut figure = Figure { samples_per_pixel: 2, ..Figure::default() };
    if moment.has_field(TISSUE) {
        let colours = map_of(TISSUE).unwrap_or_default();
        figure = Figure { colour_by: Some(TISSUE.to_owned()), colours, edges: EdgeStyle::Hidden, ..figure };
    }
    // where no marks are shown, a texture is
    if !moment.has_field(TISSUE) && session.bodies.iter().any(|body| body.texture.is_some()) {
        figure = Figure { colour_by: None, edges: EdgeStyle::Hidden, ..figure };
    }
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

/// A plot for each probe, over time or over the values of another, `NAME.svg` and `NAME.plot.png`.
///
/// # Errors
/// A file cannot be written.
pub fn write_plots(folder: &mut OutputFolder, traces: &[Trace]) -> Result<(), OutputError> {
    for trace in traces.iter().filter(|trace| trace.times.len() > 1) {
        let [drawing, image] = plot_names(&trace.name);
        let plot = plot_of(trace, traces);
        plot.write_svg(&folder.claim(&drawing)?)?;
        plot.to_image(2.0)?.write_png(&folder.claim(&image)?)?;
    }
    Ok(())
}

/// Components that share a name with those of what they are over are drawn over these.
fn plot_of(trace: &Trace, traces: &[Trace]) -> Plot {
    let over = trace.over.as_ref().and_then(|name| traces.iter().find(|other| other.name == *name));
    let component = |of: &Trace, c: usize| of.values.iter().skip(c).step_by(of.components).copied().collect();
    let abscissa = |c: usize| match over {
        None => trace.times.clone(),
        Some(over) => component(over, c.min(over.components - 1)),
    };
    let names: &[&str] = if trace.components == 1 { &[""] } else { &["x", "y", "z"] };
    let curve = |(c, name): (usize, &&str)| Curve::new(*name, abscissa(c), component(trace, c));
    let axis = |of: &Trace| Axis::new(of.quantity.replace('_', " "), of.unit);
    Plot {
        title: trace.name.clone(),
        x: over.map_or_else(|| Axis::new("time", "s"), axis),
        y: axis(trace),
        curves: names.iter().enumerate().map(curve).collect(),
        ..Plot::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace(name: &str, over: Option<&str>, components: usize, values: &[f64]) -> Trace {
        let times = (0..values.len() / components).map(|step| step as f64).collect();
        let (name, over) = (name.to_owned(), over.map(str::to_owned));
        let values = values.to_vec();
        Trace { name, unit: "N", quantity: "reaction", since: 0.0, over, components, times, values }
    }

    /// Over time, over the components of a vector, and all over one number.
    #[test]
    fn plots_are_over_what_is_asked() {
        let pull = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let way = trace("way", None, 3, &[10.0, 20.0, 30.0, 40.0, 50.0, 60.0]);
        let along = trace("along", None, 1, &[7.0, 8.0]);
        let abscissas = |over: Option<&str>| -> Vec<Vec<f64>> {
            let traces = [trace("pull", over, 3, &pull), way.clone(), along.clone()];
            let plot = plot_of(&traces[0], &traces);
            assert_eq!(plot.curves[1].y, [2.0, 5.0]);
            plot.curves.iter().map(|curve| curve.x.clone()).collect()
        };
        assert_eq!(abscissas(None), [[0.0, 1.0]; 3]);
        assert_eq!(abscissas(Some("way")), [[10.0, 40.0], [20.0, 50.0], [30.0, 60.0]]);
        assert_eq!(abscissas(Some("along")), [[7.0, 8.0]; 3]);
    }
}
