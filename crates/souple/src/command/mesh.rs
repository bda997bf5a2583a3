//! `souple mesh`: generate, fill, repair, simplify, skin, convert, quality.

mod fill;
mod operators;
mod parameters;
mod repair;
mod skin;
mod summary;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Value as Json, json};
use souple_io::{Dataset, Output};
use souple_mesh::fill::surface_of;
use souple_mesh::repair::diagnose;
use souple_mesh::{CellQuality, Histogram, Mesh, TriangleQuality, TriangleSurface};
use souple_table::Parameter;

use super::{End, Refusal, print_json, print_line, print_note, scene_path};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(subcommand)]
    action: Action,
}

#[derive(clap::Subcommand)]
enum Action {
    /// Makes a mesh: `souple mesh generate bar out.msh size=1,10cm,10cm cells=30,3,3 element=tet4`
    Generate {
        /// A name that `souple list generators` prints
        generator: String,
        out: PathBuf,
        /// NAME=VALUE; vectors as three numbers with commas; with units as in scenes: `radius=5cm`, `"radius=5 cm"`
        parameters: Vec<String>,
        #[arg(long)]
        json: bool,
    },
    /// Fills a surface or a shape: `souple mesh fill liver out.msh size=0.005`, `souple mesh fill organ.stl out.msh count=10000`
    #[command(after_help = fill::parameters_help())]
    Fill {
        /// A surface file, or a name that `souple list bodies` prints
        input: String,
        out: PathBuf,
        /// NAME=VALUE: size or count, and others below; of a shape also those that `souple describe` prints
        parameters: Vec<String>,
        #[arg(long)]
        json: bool,
    },
    /// Mends a surface as far as that is safe, and says what was mended and what is left: `souple mesh repair organ.stl out.obj`
    #[command(after_help = repair::parameters_help())]
    Repair {
        input: PathBuf,
        out: PathBuf,
        /// NAME=VALUE: weld, hole, scale
        parameters: Vec<String>,
        #[arg(long)]
        json: bool,
    },
    /// Makes a surface of fewer triangles: `souple mesh simplify organ.stl out.obj distance=0.001`
    Simplify {
        input: PathBuf,
        out: PathBuf,
        /// NAME=VALUE: distance (largest, m), triangles (least number)
        parameters: Vec<String>,
        #[arg(long)]
        json: bool,
    },
    /// Dresses particles with a surface: `souple mesh skin drops.csv out.ply radius=0.01`
    Skin {
        /// A table x,y,z[,radius] with commas, or a mesh file, of which the points are taken
        input: PathBuf,
        out: PathBuf,
        /// NAME=VALUE: radius (half the distance between particles, m), voxel (the radius where left out), iso, time (of particles that move, come and go)
        parameters: Vec<String>,
        #[arg(long)]
        json: bool,
    },
    /// Reads one format and writes another, by extension or by name; tells what the written file holds
    Convert {
        input: PathBuf,
        out: PathBuf,
        /// scale=NUMBER: metres in one unit of the file; fields keep their values
        parameters: Vec<String>,
        /// A name that `souple list formats` prints: `gmsh_binary`, `ply_text`, …; by the extension where left out
        #[arg(long)]
        format: Option<String>,
        #[arg(long)]
        json: bool,
    },
    /// Measures volume, quality and conformity, of surfaces whether they are closed, and says what is wrong
    Quality {
        /// A mesh file, or a scene, of which the first body is taken
        input: PathBuf,
        /// Changes a value of the scene; may be repeated
        #[arg(long = "set", value_name = "PATH=VALUE")]
        settings: Vec<String>,
        #[arg(long)]
        json: bool,
    },
    /// Tells what the linear formulations make of a mesh of tet4, or tri3 in a plane: symmetry, growth, exactness of quadratic fields
    Operators {
        /// A mesh file, or a scene, of which the first body is taken
        input: PathBuf,
        /// NAME=VALUE: mu, lambda [Pa], density
        parameters: Vec<String>,
        /// Changes a value of the scene; may be repeated
        #[arg(long = "set", value_name = "PATH=VALUE")]
        settings: Vec<String>,
        #[arg(long)]
        json: bool,
    },
}

impl Arguments {
    pub fn wants_json(&self) -> bool {
        match &self.action {
            Action::Generate { json, .. }
            | Action::Fill { json, .. }
            | Action::Repair { json, .. }
            | Action::Simplify { json, .. }
            | Action::Skin { json, .. }
            | Action::Convert { json, .. }
            | Action::Quality { json, .. }
            | Action::Operators { json, .. } => *json,
        }
    }
}

pub fn mesh(arguments: Arguments) -> Result<End, Refusal> {
    match arguments.action {
        Action::Generate { generator, out, parameters, json } => {
            let format = souple_io::writable_format(None, &out)?;
            write(&out, format, &Output::new(&generate(&generator, &parameters)?), Vec::new(), json)
        }
        Action::Fill { input, out, parameters, json } => {
            keep_input(Path::new(&input), &out)?;
            let format = souple_io::writable_format(None, &out)?;
            let (mesh, notes) = fill::fill(&input, &parameters, json)?;
            write(&out, format, &Output::new(&mesh), notes, json)
        }
        Action::Repair { input, out, parameters, json } => {
            keep_input(&input, &out)?;
            let format = souple_io::writable_format(None, &out)?;
            let repaired = repair::repaired(&input, &parameters)?;
            let output = Output::new(&repaired.mesh);
            let (written, notes) = written(&out, format, &output, repaired.notes.clone())?;
            let mut document = document_of(&written, &notes);
            repaired.tell(&mut document);
            tell(&out, &document, json);
            Ok(End::Done)
        }
        Action::Simplify { input, out, parameters, json } => {
            keep_input(&input, &out)?;
            let format = souple_io::writable_format(None, &out)?;
            let (mesh, notes) = fill::simplified(&input, &parameters, json)?;
            write(&out, format, &Output::new(&mesh), notes, json)
        }
        Action::Skin { input, out, parameters, json } => {
            keep_input(&input, &out)?;
            let format = souple_io::writable_format(None, &out)?;
            let (mesh, notes) = skin::dressed(&input, &parameters)?;
            write(&out, format, &Output::new(&mesh), notes, json)
        }
        Action::Convert { input, out, parameters, format, json } => {
            keep_input(&input, &out)?;
            let format = souple_io::writable_format(format.as_deref(), &out)?;
            let scale = scale(&parameters)?;
            let Dataset { mut mesh, point_fields, cell_fields, mut notes, unread } =
                souple_io::read_dataset(&input)?;
            notes.extend(unread);
            mesh.points.iter_mut().for_each(|point| *point = *point * scale);
            let output =
                Output { point_fields: &point_fields, cell_fields: &cell_fields, ..Output::new(&mesh) };
            write(&out, format, &output, notes, json)
        }
        Action::Quality { input, settings, json } => {
            if let Some(mesh) = first_body(&input, &settings)? {
                report(&input, &mesh, &[], json);
                return Ok(End::Done);
            }
            let (mut mesh, mut notes) = read(&input)?;
            notes.extend(mesh.bounds_of_cells().doubt());
            // cells, or nothing at all, are validated
            if mesh.cell_count() == 0 && mesh.facet_count() > 0 {
                report(&input, &mesh, &notes, json);
                return Ok(End::Done);
            }
            let repairs = mesh.validate();
            notes.extend(repairs.map_err(|error| unfit(&input, &error))?.messages());
            report(&input, &mesh, &notes, json);
            Ok(End::Done)
        }
        Action::Operators { input, parameters, settings, json } => {
            let found = match first_body(&input, &settings)? {
                Some(mesh) => operators::of(&mesh, &parameters)?,
                None => {
                    let (mut mesh, _) = read(&input)?;
                    mesh.validate().map_err(|error| unfit(&input, &error))?;
                    operators::of(&mesh, &parameters)?
                }
            };
            if json {
                print_json(&operators::to_json(&found));
            } else {
                operators::print(&found);
            }
            Ok(End::Done)
        }
    }
}

/// The mesh of the first body of a scene; `None` of what is no scene.
fn first_body(input: &Path, settings: &[String]) -> Result<Option<Arc<Mesh>>, Refusal> {
    let path = scene_path(&input.to_string_lossy());
    if path.extension().is_none_or(|extension| extension != "toml") {
        return Ok(None);
    }
    let scene = souple_scene::read_file(&path, settings)?;
    let mesh = scene.bodies.first().map(|body| Arc::clone(&body.mesh));
    mesh.map(Some).ok_or_else(|| {
        let message = "the scene has no body".to_owned();
        Refusal::request("mesh", input.display().to_string(), "a scene with a body", message)
    })
}

fn unfit(input: &Path, error: &souple_mesh::MeshError) -> Refusal {
    Refusal::request(
        "mesh",
        input.display().to_string(),
        "a mesh that can be computed with",
        format!("{}: {error}", input.display()),
    )
}

/// Refuses to write over the file that is read: what is made of it is less than it, or something else.
fn keep_input(input: &Path, out: &Path) -> Result<(), Refusal> {
    // two ways to write one path, and links, are one file; of formats of several files each counts
    let files = |path: &Path| -> Vec<PathBuf> {
        let files = souple_io::files_of_mesh(path).into_iter();
        files.filter_map(|file| file.canonicalize().ok()).collect()
    };
    let read = files(input);
    let Some(same) = files(out).into_iter().find(|file| read.contains(file)) else { return Ok(()) };
    let name = if out.canonicalize().is_ok_and(|out| out == same) { out.to_owned() } else { same };
    let name = name.display().to_string();
    let message = format!("`{name}` is the file that is read, and would be lost");
    Err(Refusal::request("overwrite", name, "another file to write", message))
}

/// The one parameter of a conversion.
fn scale(texts: &[String]) -> Result<f64, Refusal> {
    let values = parameters::values(texts, &[&fill::SCALE])?;
    parameters::refuse_unknown(&values, &[&fill::SCALE])?;
    let completed = values.completed(&[fill::SCALE]).map_err(|error| {
        Refusal::request("scale", texts.join(" "), "scale=NUMBER, such as scale=0.001", error.to_string())
    })?;
    Ok(completed.number("scale"))
}

fn generate(name: &str, texts: &[String]) -> Result<Mesh, Refusal> {
    let entry = souple_mesh::GENERATORS
        .find(name)
        .map_err(|error| Refusal::request("unknown_generator", name, "a generator", error.to_string()))?;
    let known: Vec<&Parameter> = entry.parameters.iter().collect();
    let values = parameters::values(texts, &known)?;
    souple_mesh::generate(name, values).map_err(|error| {
        Refusal::request("generate", name, "parameters that `souple describe` prints", error.to_string())
    })
}

fn read(path: &Path) -> Result<(Mesh, Vec<String>), Refusal> {
    Ok(souple_io::read_mesh(path)?)
}

/// Writes a mesh in the format of that name, and tells what the file holds.
fn write(
    path: &Path,
    format: &str,
    output: &Output,
    notes: Vec<String>,
    as_json: bool,
) -> Result<End, Refusal> {
    let (written, notes) = written(path, format, output, notes)?;
    report(path, &written, &notes, as_json);
    Ok(End::Done)
}

/// Writes a mesh; what the file holds, which may be less, for a format may know surfaces alone, or no groups, and the notes with
/// what it did not take.
fn written(
    path: &Path,
    format: &str,
    output: &Output,
    mut notes: Vec<String>,
) -> Result<(Mesh, Vec<String>), Refusal> {
    let written = match souple_io::write_and_read_back(format, path, output)? {
        Some(dataset) => dataset.mesh,
        // a format that is only written, and for surfaces
        None => {
            surface_of(output.mesh).map_or_else(|| output.mesh.clone(), |surface| fill::mesh_of(&surface))
        }
    };
    notes.extend(souple_io::losses(format, output)?);
    Ok((written, notes))
}

/// Tells what a file holds.
fn report(path: &Path, mesh: &Mesh, notes: &[String], as_json: bool) {
    tell(path, &document_of(mesh, notes), as_json);
}

/// Cells, or triangles that are measured as a surface.
fn document_of(mesh: &Mesh, notes: &[String]) -> Json {
    match mesh.facet_surface().filter(|_| mesh.cell_count() == 0) {
        Some(surface) => of_surface(mesh, &surface, notes),
        None => of_cells(mesh, notes),
    }
}

fn tell(path: &Path, document: &Json, as_json: bool) {
    if as_json {
        print_json(document);
    } else {
        summary::sentences(&path.display().to_string(), document).iter().for_each(print_line);
    }
}

fn of_cells(mesh: &Mesh, notes: &[String]) -> Json {
    let found = mesh.conformity();
    let mut problems = found.problems(mesh);
    problems.extend(mesh.faces().conforming().err().map(|error| error.to_string()));
    let notes: Vec<&String> = notes.iter().chain(&problems[problems.len().min(1)..]).collect();
    let hinges = found.hinges();
    let notes: Vec<&String> = notes.into_iter().chain(&hinges).collect();
    let quality = mesh.quality();
    let bounds = mesh.bounds();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut volumes: BTreeMap<&str, f64> = BTreeMap::new();
    for block in &mesh.blocks {
        *counts.entry(block.kind.name()).or_default() += block.len();
    }
    for cell in mesh.cells() {
        *volumes.entry(cell.kind.name()).or_default() += mesh.cell_volume(cell);
    }
    let smallest = quality.iter().map(|cell| cell.scaled_jacobian).fold(f64::INFINITY, f64::min);
    let mut document = json!({
        "points": mesh.points.len(),
        "cells": counts,
        "facets": mesh.facet_count(),
        "groups": mesh.groups.keys().collect::<Vec<_>>(),
        "components": mesh.components().1,
        "volume": mesh.volume(),
        "volume_of_kinds": volumes,
        "bounds": [bounds.low.to_array(), bounds.high.to_array()],
        "smallest_scaled_jacobian": (!quality.is_empty()).then_some(smallest),
        "conforming": problems.is_empty(),
        "problem": problems.first(),
        "notes": notes,
    });
    if !quality.is_empty() {
        document["quality"] = shapes(mesh, &quality);
    }
    document
}

/// Triangles without cells: their shapes, and whether they enclose a volume.
fn of_surface(mesh: &Mesh, surface: &TriangleSurface, notes: &[String]) -> Json {
    let quality = surface.quality();
    let least = |pick: fn(&TriangleQuality) -> f64| quality.iter().map(pick).fold(f64::INFINITY, f64::min);
    let greatest = quality.iter().map(|triangle| triangle.largest_angle).fold(0.0, f64::max);
    let flat = quality.iter().filter(|triangle| triangle.area == 0.0).count();
    let open = surface.check_closed().err().map(|error| error.to_string());
    let bounds = surface.bounds();
    json!({
        "points": mesh.points.len(),
        "facets": mesh.facet_count(),
        "triangles": surface.triangles.len(),
        "groups": mesh.groups.keys().collect::<Vec<_>>(),
        "area": surface.area(),
        "bounds": [bounds.low.to_array(), bounds.high.to_array()],
        "closed": open.is_none(),
        // of an open surface there is none
        "enclosed_volume": open.is_none().then(|| surface.enclosed_volume()),
        "smallest_shape": least(|triangle| triangle.shape),
        "smallest_angle_degrees": least(|triangle| triangle.smallest_angle).to_degrees(),
        "largest_angle_degrees": greatest.to_degrees(),
        "triangles_without_area": flat,
        "problem": open,
        "faults": faults(surface),
        "notes": notes,
    })
}

/// Bins of ten degrees from 0 to 180.
const DIHEDRAL_BINS: usize = 18;

/// Angles, slenderness and volumes of cells.
fn shapes(mesh: &Mesh, quality: &[CellQuality]) -> Json {
    let histogram =
        |measure: fn(&CellQuality) -> f64| Histogram::of(&quality.iter().map(measure).collect::<Vec<_>>(), 1);
    let (least, greatest) = (
        histogram(|cell| cell.smallest_dihedral.to_degrees()),
        histogram(|cell| cell.largest_dihedral.to_degrees()),
    );
    let aspect = histogram(|cell| cell.aspect_ratio);
    let volume = histogram(|cell| cell.volume);
    let worst =
        (0..quality.len()).min_by(|a, b| quality[*a].scaled_jacobian.total_cmp(&quality[*b].scaled_jacobian));
    json!({
        "dihedral_degrees": {
            "min": least.low,
            "max": greatest.high,
            "histogram_0_to_180": mesh.dihedral_histogram(DIHEDRAL_BINS),
        },
        "aspect_ratio": { "best": aspect.low, "worst": aspect.high, "mean": aspect.mean },
        "cell_volume": { "min": volume.low, "max": volume.high, "mean": volume.mean },
        "inverted_cells": quality.iter().filter(|cell| cell.volume <= 0.0).count(),
        "worst_cell": worst,
    })
}

/// From so many triangles on a person is told what is waited for.
const MANY_TRIANGLES: usize = 200_000;

fn announce(surface: &TriangleSurface) {
    let count = surface.triangles.len();
    if count >= MANY_TRIANGLES {
        print_note(format_args!("looking for triangles that pass through each other, among {count} …"));
    }
}

/// What is wrong with a surface.
fn faults(surface: &TriangleSurface) -> Json {
    announce(surface);
    let diagnosis = diagnose(surface);
    json!({
        "simple": diagnosis.is_simple(),
        "components": diagnosis.component_count,
        "open_edges": diagnosis.open_edges.len(),
        "crowded_edges": diagnosis.crowded_edges.len(),
        "misoriented_edges": diagnosis.misoriented_edges.len(),
        "pinched_points": diagnosis.pinched_points.len(),
        "crossings": diagnosis.crossings.pairs.len(),
        "more_crossings": diagnosis.crossings.is_cut_off,
        "duplicate_points": diagnosis.duplicate_points,
        "flat_triangles": diagnosis.flat_triangles.len(),
        "doubled_triangles": diagnosis.doubled_triangles.len(),
        "messages": diagnosis.messages(),
    })
}
