//! `souple bench`: speed with its error beside it.

use std::path::{Path, PathBuf};

use serde_json::Value;
use souple_io::plot::{Axis, Curve, Mark, Plot, Scale};
use souple_verify::bench::{BENCHES, Effort, Figure, benches};

use super::{End, Refusal, did_you_mean, print_json, print_line, print_note};

#[derive(clap::Args)]
pub struct Arguments {
    /// Names of benchmarks; all where none is given
    names: Vec<String>,
    #[arg(long)]
    list: bool,
    /// Fewer samples
    #[arg(long)]
    quick: bool,
    /// Fails where a figure is worse than its baseline, by time of the processor where that is known
    #[arg(long, conflicts_with = "list")]
    hold: bool,
    /// Draws the errors of figures in seconds over these, as SVG: `accuracy` gives a curve for each element (EXP-28)
    #[arg(long, value_name = "FILE", conflicts_with = "list")]
    plot: Option<PathBuf>,
    #[arg(long)]
    pub json: bool,
}

pub fn bench(arguments: &Arguments) -> Result<End, Refusal> {
    let chosen = benches(&arguments.names).map_err(|unknown| {
        let hint = did_you_mean(&unknown, BENCHES.iter().map(|bench| bench.name));
        let message = format!("there is no benchmark `{unknown}`{hint}");
        Refusal::request("unknown_bench", &unknown, "a name that `souple bench --list` prints", message)
    })?;
    if arguments.list {
        if arguments.json {
            print_json(&Value::Array(chosen.iter().map(|bench| bench.to_json()).collect()));
        } else {
            chosen.iter().for_each(|bench| print_line(format_args!("{:28} {}", bench.name, bench.what)));
        }
        return Ok(End::Done);
    }
    let mut figures: Vec<Figure> = Vec::new();
    let effort = if arguments.quick { Effort::Quick } else { Effort::Full };
    for bench in chosen {
        let measured = (bench.run)(effort)
            .map_err(|error| Refusal::work("bench", format!("{}: {error}", bench.name)))?;
        if !arguments.json {
            let width = measured.iter().map(|figure| figure.name.len()).max().unwrap_or(0);
            measured.iter().for_each(|figure| print_line(format_args!("{figure:width$}")));
        }
        figures.extend(measured);
    }
    if arguments.json {
        print_json(&Value::Array(figures.iter().map(Figure::to_json).collect()));
    }
    if let Some(path) = &arguments.plot {
        write_plot(&figures, path)?;
    }
    let missed: Vec<&Figure> = figures.iter().filter(|figure| arguments.hold && figure.misses()).collect();
    missed.iter().for_each(|figure| print_note(format_args!("worse than its baseline: {figure}")));
    let free: Vec<&str> = figures
        .iter()
        .filter(|figure| arguments.hold && figure.baseline.is_none())
        .map(|figure| figure.name.as_str())
        .collect();
    if !free.is_empty() {
        print_note(format_args!("not held, for want of a baseline: {}", free.join(", ")));
    }
    if missed.is_empty() { Ok(End::Done) } else { Ok(End::Failed) }
}

/// Errors over seconds; of one curve is what has one name up to mesh and threads, `accuracy_hex8_48x8x8_1t`.
fn write_plot(figures: &[Figure], path: &Path) -> Result<(), Refusal> {
    let mut curves: Vec<Curve> = Vec::new();
    for figure in figures.iter().filter(|figure| figure.unit == "s" && !figure.error_of.is_empty()) {
        let name = figure.name.rsplitn(3, '_').nth(2).unwrap_or(&figure.name);
        let (seconds, error) = (figure.by_processor.unwrap_or(figure.value), figure.error);
        match curves.iter_mut().find(|curve| curve.name == name) {
            Some(curve) => {
                curve.x.push(seconds);
                curve.y.push(error);
            }
            None => {
                curves.push(Curve { mark: Mark::DottedLine, ..Curve::new(name, vec![seconds], vec![error]) })
            }
        }
    }
    if curves.is_empty() {
        let message = "none of these benchmarks has figures in seconds with an error beside them".to_owned();
        return Err(Refusal::request("plot", path.display().to_string(), "`souple bench accuracy`", message));
    }
    let logarithmic = |axis: Axis| Axis { scale: Scale::Logarithmic, ..axis };
    let plot = Plot {
        x: logarithmic(Axis::new("time", "s")),
        y: logarithmic(Axis::new("error", "")),
        curves,
        ..Plot::default()
    };
    plot.write_svg(path).map_err(|error| Refusal::work("write", error.to_string()))
}
