//! `souple mesh fill` and `souple mesh simplify`.

use std::path::Path;

use souple_mesh::fill::{FillError, Options, PARAMETERS, fill_mesh, surface_of};
use souple_mesh::implicit::SHAPES;
use souple_mesh::repair::{RepairLimits, repair};
use souple_mesh::simplify::{Goal, simplify};
use souple_mesh::{ElementKind, Mesh, MeshError, TriangleSurface, gigabytes};
use souple_table::{Parameter, Range, Value, ValueError, Values, four_digits, in_number, nearest};

use super::{announce, parameters, read};
use crate::command::progress::Pulse;
use crate::command::{Refusal, print_note};

pub const SCALE: Parameter =
    Parameter::number("scale", "", Range::POSITIVE, "metres in one unit of the file").or(Value::Number(1.0));

/// What parameters a filling takes, as `--help` prints it.
pub fn parameters_help() -> String {
    parameters_in_words(PARAMETERS.iter().chain([&SCALE]))
}

pub fn parameters_in_words<'a>(parameters: impl IntoIterator<Item = &'a Parameter>) -> String {
    let mut text = "Parameters:\n".to_owned();
    for parameter in parameters {
        let default = parameter.default.map(|value| format!(", default {value}")).unwrap_or_default();
        text += &format!(
            "  {}: {}\n      {}{default}\n",
            parameter.name,
            parameter.summary,
            parameter.expected()
        );
    }
    text
}

/// Fills a file's surface, or a shape known by name.
pub fn fill(input: &str, texts: &[String], quiet: bool) -> Result<(Mesh, Vec<String>), Refusal> {
    let refuse = |error: MeshError| {
        // what would be accepted stands in a line of its own
        let (found, accepted) = error.in_two();
        let accepted = accepted.unwrap_or_else(|| match error {
            MeshError::Value(_) => "parameters as `souple mesh fill --help` names them".to_owned(),
            _ => "a shape that has an inside, and cells that fit in it".to_owned(),
        });
        let is_of_lengths = matches!(
            error,
            MeshError::Fill(
                FillError::TooManyPoints { .. } | FillError::TooManyCells { .. } | FillError::Nothing { .. }
            )
        );
        let hint = if is_of_lengths && Path::new(input).exists() {
            "; lengths are metres: a file in millimetres takes scale=0.001"
        } else {
            ""
        };
        let expected = format!("{accepted}{hint}");
        let message = format!("`{input}` cannot be filled: {found}");
        let of_parameter = match &error {
            MeshError::Parameter { name, value, expected } => Some((*name, value, expected)),
            MeshError::Value(ValueError::Unfit { name, value, expected }) => {
                Some((name.as_str(), value, expected))
            }
            _ => None,
        };
        match of_parameter {
            Some((name, value, expected)) => {
                let mut refusal = Refusal::request("fill", value, expected, message);
                refusal.errors[0]["path"] = name.into();
                refusal
            }
            None => Refusal::request("fill", input, expected, message),
        }
    };
    let shape = SHAPES.entries.iter().copied().find(|entry| entry.name == input);
    if shape.is_none() && !Path::new(input).exists() {
        let hint = nearest(input, SHAPES.names()).map(|near| format!(" (did you mean `{near}`?)"));
        let message = format!("`{input}` is neither a file nor a shape{}", hint.unwrap_or_default());
        let expected = format!("a surface file, or one of {}", SHAPES.names().collect::<Vec<_>>().join(", "));
        return Err(Refusal::request("unknown_shape", input, expected, message));
    }
    let own: &[Parameter] = shape.map_or(&[SCALE], |entry| entry.parameters);
    let known: Vec<&Parameter> = PARAMETERS.iter().chain(own).collect();
    let given = parameters::values(texts, &known)?;
    parameters::refuse_unknown(&given, &known)?;
    let (filling, others) = parameters::split(given, PARAMETERS);
    let options = filling.completed(PARAMETERS).map_err(MeshError::from);
    let options = options.and_then(|values| Options::from_values(&values)).map_err(refuse)?;
    let work = || {
        announce_filling(&options);
        Pulse::new("filling", quiet)
    };
    if let Some(entry) = shape {
        let _work = work();
        let body = entry.values(others).map_err(MeshError::from).and_then(|values| (entry.build)(&values));
        let filled = body.and_then(|body| options.fill_body(&body)).map_err(refuse)?;
        return Ok((filled.mesh, filled.notes));
    }
    let scale = others.completed(&[SCALE]).map_err(|error| refuse(error.into()))?.number("scale");
    let (mut mesh, mut notes) = read(Path::new(input))?;
    mesh.points.iter_mut().for_each(|point| *point = *point * scale);
    notes.extend(mesh.bounds_of_cells().doubt().map(|doubt| format!("the surface: {doubt}")));
    surface_of(&mesh).iter().for_each(announce);
    let _work = work();
    let filled = fill_mesh(&mesh, RepairLimits::default(), &options).map_err(refuse)?;
    notes.extend(filled.notes);
    Ok((filled.mesh, notes))
}

/// From so many cells on a person is told what is waited for.
const MANY_CELLS: f64 = 1e6;

fn announce_filling(options: &Options) {
    if let Some(count) = options.count().filter(|count| *count >= MANY_CELLS) {
        let memory = gigabytes(options.cells.memory(count));
        print_note(format_args!("making about {count:e} cells takes {memory} of memory and some minutes …"));
    }
}

const SIMPLIFY: &[Parameter] = &[
    Parameter::number(
        "distance",
        "m",
        Range::NOT_NEGATIVE,
        "largest distance from the given surface; 0: by count",
    )
    .or(Value::Number(0.0)),
    Parameter::integer("triangles", Range::NOT_NEGATIVE, "least number of triangles").or(Value::Integer(0)),
];

/// A wanted number of triangles is told where it is missed by more than this.
const MET_TRIANGLES: f64 = 1.05;

/// A surface of fewer triangles, and what was done.
pub fn simplified(input: &Path, texts: &[String], quiet: bool) -> Result<(Mesh, Vec<String>), Refusal> {
    let name = input.display().to_string();
    let refuse = |error: MeshError| {
        let message = format!("`{name}` cannot be simplified: {error}");
        Refusal::request("simplify", name.clone(), "distance=LENGTH or triangles=COUNT", message)
    };
    let known: Vec<&Parameter> = SIMPLIFY.iter().collect();
    let values: Values = parameters::values(texts, &known)?;
    parameters::refuse_unknown(&values, &known)?;
    let values = values.completed(SIMPLIFY).map_err(|error| refuse(error.into()))?;
    let (distance, triangles) = (values.number("distance"), values.integer("triangles") as usize);
    let goal = match (distance > 0.0, triangles > 0) {
        (false, false) => {
            let value = "0, or missing".to_owned();
            let expected = "a largest distance above 0 [m], or a number of `triangles`".to_owned();
            return Err(refuse(MeshError::Parameter { name: "distance", value, expected }));
        }
        (true, _) => Goal { distance, triangles },
        (false, true) => Goal { distance: f64::INFINITY, triangles },
    };
    let (mesh, mut notes) = read(input)?;
    let surface = surface_of(&mesh).ok_or(MeshError::NoCells).map_err(refuse)?;
    let (mended, repairs) = repair(&surface, RepairLimits { hole: 0.0, ..RepairLimits::default() });
    notes.extend(repairs.messages());
    let work = Pulse::new("simplifying", quiet);
    let simple = simplify(&mended, goal).map_err(refuse)?;
    drop(work);
    notes.push(format!(
        "{} of {} triangles are left, within {} m of the given surface",
        simple.surface.triangles.len(),
        surface.triangles.len(),
        four_digits(simple.distance)
    ));
    let left = simple.surface.triangles.len();
    if distance <= 0.0 && left as f64 > MET_TRIANGLES * triangles as f64 {
        notes.push(format!(
            "{left} are more than the {triangles} asked for: the rest cannot be joined without turning a triangle over or tearing the surface"
        ));
    }
    if simple.crossings > 0 {
        let pairs = in_number(simple.crossings, "pair of triangles passes", "pairs of triangles pass");
        notes.push(format!("{pairs} through each other, as in the given surface"));
    }
    if simple.may_have_more_crossings {
        notes.push(
            "triangles lie within each other so densely that not all pairs of them were looked at: more may pass through each other"
                .to_owned(),
        );
    }
    Ok((mesh_of(&simple.surface), notes))
}

/// A mesh of facets alone.
pub fn mesh_of(surface: &TriangleSurface) -> Mesh {
    let mut mesh = Mesh { points: surface.points.clone(), ..Mesh::default() };
    surface.triangles.iter().for_each(|corners| mesh.push_facet(ElementKind::Tri3, corners));
    mesh
}
