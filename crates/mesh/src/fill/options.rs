//! What a filling is told, as parameters by name.

use souple_formal::Formula;
use souple_table::{Parameter, Range, Value, Values};

use super::{Cells, Interior, Part, Size, fill};
use crate::implicit::{Body, FormulaShape, Shape};
use crate::{Mesh, MeshError};

/// Parameters of every filling.
pub const PARAMETERS: &[Parameter] = &[
    Parameter::number(
        "size",
        "m",
        Range::NOT_NEGATIVE,
        "longest edge of a tetrahedron, edge of a hexahedron",
    )
    .or(Value::Number(0.0)),
    Parameter::integer("count", Range::closed(0.0, 5e7), "about how many cells, in place of a size")
        .or(Value::Integer(0)),
    Parameter::number("growth", "", Range::NOT_NEGATIVE, "how much longer edges are for each length inward")
        .or(Value::Number(0.0)),
    Parameter::number("largest", "m", Range::NOT_NEGATIVE, "longest edge inside; 0: eight times the size")
        .or(Value::Number(0.0)),
    Parameter::text("size_inside", "longest edge inside as a formula of x, y, z [m]; empty: by growth")
        .or(Value::Text("")),
    Parameter::choice("element", &["tet4", "hex_dominant"], "tetrahedra, or hexahedra where they fit")
        .or(Value::Text("tet4")),
];

/// A filling as asked for.
#[derive(Clone, Debug)]
pub struct Options {
    wanted: Wanted,
    growth: f64,
    /// Relative to the size where `None`.
    largest: Option<f64>,
    size_inside: Option<Formula>,
    pub cells: Cells,
}

#[derive(Clone, Copy, Debug)]
enum Wanted {
    Size(f64),
    Count(f64),
}

/// Cells inside are at most this much larger than at the surface, where nothing else is said.
const LARGEST: f64 = 8.0;

/// A count is met to this, relative, or as well as so many fillings do.
const COUNT_TOLERANCE: f64 = 0.03;
const MOST_FILLINGS: usize = 6;
/// Below this, a layer of cells more or less is a large part of all.
const FEW: f64 = 5000.0;
/// Sizes around the best one that are looked at for few cells, and how far they are apart.
const LOOKED_AT: usize = 24;
const STRIDE: f64 = 0.02;

impl Options {
    /// From completed values of [`PARAMETERS`].
    ///
    /// # Errors
    /// Neither size nor count is given, or both; the formula is none.
    pub fn from_values(values: &Values) -> Result<Self, MeshError> {
        let (size, count) = (values.number("size"), values.integer("count"));
        let wanted = match (size > 0.0, count > 0) {
            (true, false) => Wanted::Size(size),
            (false, true) => Wanted::Count(count as f64),
            (both, _) => {
                let value =
                    if both { format!("{size} m, and `count` is {count}") } else { "missing".to_owned() };
                let expected = "a length above 0 [m], or a `count` of cells above 0 in its place".to_owned();
                return Err(MeshError::Parameter { name: "size", value, expected });
            }
        };
        let text = values.text("size_inside");
        let compile = || Formula::compile(text, FormulaShape::VARIABLES);
        let size_inside = if text.trim().is_empty() { Ok(None) } else { compile().map(Some) };
        let size_inside = size_inside.map_err(|error| MeshError::Parameter {
            name: "size_inside",
            value: format!("\"{text}\""),
            expected: format!("a formula of x, y, z: {error}"),
        })?;
        let largest = Some(values.number("largest")).filter(|largest| *largest > 0.0);
        let cells =
            if values.text("element") == "hex_dominant" { Cells::HexDominant } else { Cells::Tetrahedra };
        Ok(Self { wanted, growth: values.number("growth"), largest, size_inside, cells })
    }

    fn size(&self, surface: f64) -> Size {
        let largest = self.largest.unwrap_or(LARGEST * surface);
        let interior = match &self.size_inside {
            Some(formula) => {
                let formula = formula.clone();
                Interior::Field { size: Box::new(move |x| formula.evaluate(&x.to_array())), largest }
            }
            None if self.growth > 0.0 => Interior::Graded { growth: self.growth, largest },
            None => Interior::Uniform,
        };
        Size { surface, interior }
    }

    /// Cells inside are not smaller than at the surface.
    fn check_largest(&self, size: f64) -> Result<(), MeshError> {
        match self.largest {
            Some(largest) if largest < size => {
                let expected =
                    format!("at least the size of cells at the surface, {size} m; or 0 for eight times that");
                Err(MeshError::Parameter { name: "largest", value: format!("{largest} m"), expected })
            }
            _ => Ok(()),
        }
    }

    /// Fills a shape.
    ///
    /// # Errors
    /// As [`fill`].
    pub fn fill(&self, shape: &dyn Shape, parts: &[Part<'_>]) -> Result<Mesh, MeshError> {
        match self.wanted {
            Wanted::Size(size) => {
                self.check_largest(size)?;
                Ok(fill(shape, &self.size(size), self.cells, parts)?)
            }
            Wanted::Count(count) => self.fill_by_count(shape, parts, count),
        }
    }

    /// Fills a shape known by name, its parts as groups.
    ///
    /// # Errors
    /// As [`fill`].
    pub fn fill_body(&self, body: &Body) -> Result<Mesh, MeshError> {
        let parts: Vec<Part> =
            body.parts.iter().map(|(name, shape)| Part { name, shape: &**shape }).collect();
        self.fill(&*body.shape, &parts)
    }

    /// Cells go with the cube of the inverse size: a size, what it gave, a better size. Few cells come in jumps, by
    /// whole layers at once: then sizes around the best one are looked at, too.
    fn fill_by_count(&self, shape: &dyn Shape, parts: &[Part<'_>], count: f64) -> Result<Mesh, MeshError> {
        let extent = shape.bounds().size();
        let mut size = Size::for_count(extent.x * extent.y * extent.z, count);
        let mut best: Option<Attempt> = None;
        let attempts = if count < FEW { MOST_FILLINGS + LOOKED_AT } else { MOST_FILLINGS };
        for attempt in 0..attempts {
            let mesh = match fill(shape, &self.size(size), self.cells, parts) {
                Ok(mesh) => mesh,
                // nothing was hit: look closer
                Err(super::FillError::Nothing { .. }) => {
                    size *= 0.5;
                    continue;
                }
                Err(error) => return Err(error.into()),
            };
            let ratio = mesh.cell_count() as f64 / count;
            let error = ratio.ln().abs();
            if best.as_ref().is_none_or(|best| error < best.error) {
                best = Some(Attempt { size, error, mesh });
            }
            if (ratio - 1.0).abs() < COUNT_TOLERANCE {
                break;
            }
            size = match &best {
                Some(best) if attempt + 1 >= MOST_FILLINGS => {
                    // in turn above and below the best, farther and farther
                    let step = (attempt + 1 - MOST_FILLINGS) / 2 + 1;
                    let factor = 1.0 + STRIDE * step as f64;
                    if attempt % 2 == 0 { best.size * factor } else { best.size / factor }
                }
                _ => size * ratio.cbrt(),
            };
        }
        let Some(best) = best else {
            return Err(super::FillError::Nothing { size, extent: extent.to_array() }.into());
        };
        self.check_largest(best.size)?;
        Ok(best.mesh)
    }
}

/// A filling, and by how much it misses the wanted count: the logarithm of the ratio.
struct Attempt {
    size: f64,
    error: f64,
    mesh: Mesh,
}
