//! Bars of several parts along their length, each of its own kind of cells: what mixed models are compared on.
//!
//! Parts share their points and not always their faces: where a quadrilateral meets two triangles, both have the same
//! four corners, and the gap between the bilinear face and the two flat ones is of the size of their warping. Bars of the
//! generator `bar` with `element = "mixed"` conform.

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values};

use super::cut::Cut;
use super::grid::Grid;
use super::{Build, GeneratorEntry};
use crate::{Mesh, MeshError};

static AXES: [&str; 3] = ["x", "y", "z"];
const FRACTION: Range = Range { high_included: true, ..Range::open(0.0, 1.0) };

pub(super) static BAR_OF_PARTS: GeneratorEntry = GeneratorEntry {
    name: "bar_of_parts",
    summary: "bar along x of several kinds of cells one behind the other, which share points; groups x_min, …",
    source: "Faure 2014, §5.3 and code 23",
    parameters: &[
        Parameter::vector("size", "m", "lengths along x, y, z"),
        Parameter::vector("cells", "", "numbers of cubes along x, y, z (whole numbers)"),
        Parameter::text(
            "elements",
            "kinds of cells from x_min on: tet4, hex8, prism6, pyramid5, in any order",
        ),
        Parameter::numbers("ends", "", FRACTION, "where each part ends, as a fraction of the length"),
        Parameter::choice("prism_axis", &AXES, "axis along which prisms lie, their triangles across it")
            .or(Value::Text("x")),
        Parameter::vector("origin", "m", "the corner of least x, y, z").or(Value::Vector([0.0; 3])),
    ],
    build: Build { size: |values| Ok(grid(values)?.size()), mesh: bar },
};

fn bar(values: &Values) -> Result<Mesh, MeshError> {
    let size = values.vector("size");
    if !size.iter().all(|length| *length > 0.0) {
        return Err(unfit("size", Value::Vector(size), "three lengths above 0 [m]"));
    }
    let (origin, size) = (Vec3::from_array(values.vector("origin")), Vec3::from_array(size));
    Ok(grid(values)?.mesh(|unit| origin + Vec3::new(size.x * unit.x, size.y * unit.y, size.z * unit.z)))
}

fn grid(values: &Values) -> Result<Grid, MeshError> {
    let (names, ends) = (values.text("elements"), values.numbers("ends"));
    let cut = |name: &str| match name {
        "tet4" => Ok(Cut::Tetrahedra),
        "hex8" => Ok(Cut::Hexahedra),
        "prism6" => Ok(Cut::Prisms),
        "pyramid5" => Ok(Cut::Pyramids),
        _ => Err(unfit("elements", Value::Text(name), "names among tet4, hex8, prism6, pyramid5")),
    };
    let cuts = names.split([' ', ',']).filter(|name| !name.is_empty()).map(cut);
    let cuts = cuts.collect::<Result<Vec<Cut>, _>>()?;
    let is_ascending = ends.windows(2).all(|pair| pair[0] < pair[1]);
    if cuts.len() != ends.len() || !is_ascending || ends.last() != Some(&1.0) {
        let expected = format!("{} ascending fractions, the last of them 1", cuts.len());
        return Err(unfit("ends", Value::Numbers(ends), &expected));
    }
    let parts: Vec<(Cut, f64)> = cuts.into_iter().zip(ends.iter().copied()).collect();
    let axis = AXES.iter().position(|axis| *axis == values.text("prism_axis")).unwrap_or(0);
    Ok(Grid::of_parts("cells", values.vector("cells"), &parts)?.with_prisms_along(axis))
}

fn unfit(name: &'static str, value: Value, expected: &str) -> MeshError {
    MeshError::Parameter { name, value: value.to_string(), expected: expected.to_owned() }
}
