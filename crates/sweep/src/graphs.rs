//! Graphs of a study: a result over a value, a curve for each value of another.

use std::path::{Path, PathBuf};

use souple_io::plot::{Axis, Curve, Mark, Plot, Scale};
use souple_scene::{ProbeInfo, Scene};

use crate::SweepError;
use crate::study::{Graph, Study};
use crate::table::{AXES, Row, Table, VALUES};

/// Pixels of a graph for each unit of its size: as many as graphs of probes have.
const FINENESS: f64 = 2.0;

/// Writes each graph of the study as `STUDY.NAME.svg` and `STUDY.NAME.png` beside the file of its results; their paths.
///
/// # Errors
/// A graph names what no run has; a file cannot be written.
pub fn write(study: &Study, table: &Table, results: &Path) -> Result<Vec<PathBuf>, SweepError> {
    let mut written = Vec::new();
    for graph in &study.graphs {
        let plot = plot_of(study, graph, table)?;
        let [svg, png] = ["svg", "png"].map(|kind| results.with_extension(format!("{}.{kind}", graph.name)));
        plot.write_svg(&svg)?;
        plot.to_image(FINENESS)?.write_png(&png)?;
        written.extend([svg, png]);
    }
    Ok(written)
}

/// Refuses graphs of what the runs will not have, before the first of them.
///
/// # Errors
/// A graph names no path that varies and no probe of the scene.
pub fn check(study: &Study, scene: &Scene) -> Result<(), SweepError> {
    let paths: Vec<&str> = study.paths().collect();
    let refuse = |graph: &Graph, key: &str, name: &str, expected: String| {
        Err(SweepError::value(format!("graphs.{}.{key}", graph.name), format!("`{name}`"), expected))
    };
    for graph in &study.graphs {
        for (key, name) in [("x", &graph.x), ("y", &graph.y)] {
            let mut parts = name.split('.');
            let probe = parts.next().unwrap_or_default();
            let suffixes: Vec<&str> = parts.collect();
            let has_component = suffixes.iter().any(|part| AXES.contains(part));
            let is_probe = |known: &ProbeInfo| known.name == probe && known.gives_vector() == has_component;
            let unknown = suffixes.iter().find(|part| !AXES.contains(part) && !VALUES.contains(part));
            if let Some(unknown) = unknown.filter(|_| scene.probes.iter().any(|known| known.name == probe)) {
                let near = souple_table::nearest(unknown, VALUES);
                let hint = near.map(|near| format!(" (did you mean `{near}`?)")).unwrap_or_default();
                let message = format!("`{name}`, of which `{unknown}` says nothing{hint}");
                let expected = format!("{} or nothing behind a probe and its component", VALUES.join(", "));
                let place = format!("graphs.{}.{key}", graph.name);
                return Err(SweepError::value(place, message, expected));
            }
            let is_known =
                paths.contains(&name.as_str()) || name == "wall_seconds" || scene.probes.iter().any(is_probe);
            if !is_known {
                let of = |probe: &ProbeInfo| match probe.gives_vector() {
                    true => AXES.map(|axis| format!("{}.{axis}", probe.name)).join(", "),
                    false => probe.name.clone(),
                };
                let known = paths.iter().map(|path| (*path).to_owned()).chain(scene.probes.iter().map(of));
                let known: Vec<String> = known.chain(["wall_seconds".to_owned()]).collect();
                return refuse(graph, key, name, format!("one of {}", known.join(", ")));
            }
        }
        if let Some(lines) = graph.lines.as_ref().filter(|lines| !paths.contains(&lines.as_str())) {
            return refuse(graph, "lines", lines, format!("a path that varies: {}", paths.join(", ")));
        }
    }
    Ok(())
}

fn plot_of(study: &Study, graph: &Graph, table: &Table) -> Result<Plot, SweepError> {
    let place = |key: &str| format!("graphs.{}.{key}", graph.name);
    let lines = match &graph.lines {
        None => None,
        Some(path) => Some(table.paths.iter().position(|known| known == path).ok_or_else(|| {
            SweepError::value(
                place("lines"),
                format!("`{path}`"),
                format!("a path that varies: {}", table.paths.join(", ")),
            )
        })?),
    };
    let mut units = [String::new(), String::new()];
    let mut curves: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
    for row in table.rows.iter().filter(|row| row.stored.status == "done") {
        let of = |key: &str, name: &str| number(table, row, &place(key), name);
        let ((x, unit_x), (y, unit_y)) = (of("x", &graph.x)?, of("y", &graph.y)?);
        units = [unit_x, unit_y];
        // of what the value is, without where that stands
        let told = |path: usize| {
            let last = table.paths[path].rsplit('.').next().unwrap_or_default();
            format!("{last} = {}", row.values[path])
        };
        let name = lines.map_or_else(String::new, told);
        match curves.iter_mut().find(|(known, _)| *known == name) {
            Some((_, points)) => points.push((x, y)),
            None => curves.push((name, vec![(x, y)])),
        }
    }
    let curve = |(name, mut points): (String, Vec<(f64, f64)>)| {
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (x, y) = points.into_iter().unzip();
        Curve { mark: Mark::DottedLine, ..Curve::new(name, x, y) }
    };
    let [unit_x, unit_y] = units;
    let scale = |logarithmic: bool| if logarithmic { Scale::Logarithmic } else { Scale::Linear };
    Ok(Plot {
        title: graph.title.clone().unwrap_or_else(|| study.title.clone()),
        x: Axis { scale: scale(graph.logarithmic[0]), ..Axis::new(graph.x.clone(), unit_x) },
        y: Axis { scale: scale(graph.logarithmic[1]), ..Axis::new(graph.y.clone(), unit_y) },
        curves: curves.into_iter().map(curve).collect(),
        ..Plot::default()
    })
}

/// A number of a run, or what the runs have in its place.
fn number(table: &Table, row: &Row, place: &str, name: &str) -> Result<(f64, String), SweepError> {
    table.find(row, name).ok_or_else(|| {
        let names = table.paths.iter().cloned().chain(table.results().into_iter().map(|(name, _)| name));
        let known: Vec<String> =
            names.filter(|name| table.find(row, name).is_some()).chain(["wall_seconds".to_owned()]).collect();
        SweepError::value(
            place,
            format!("`{name}`"),
            format!("a number that every run has; this one has {}", known.join(", ")),
        )
    })
}
