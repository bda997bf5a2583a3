//! What a filling is told, as parameters by name.

use souple_formal::Formula;
use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values, in_number, readable};

use super::lattice::points_of;
use super::{Cells, FillError, Grading, Part, Reach, Size, fill, lost};
use crate::implicit::{Body, FormulaShape, Shape};
use crate::{BoundingBox, Cell, ElementKind, Mesh, MeshError, available_memory};

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
    Parameter::number(
        "growth",
        "",
        Range::closed(0.0, 10.0),
        "how much longer edges are for each length inward; neighbours differ by a factor of two at most",
    )
    .or(Value::Number(0.0)),
    Parameter::number("largest", "m", Range::NOT_NEGATIVE, "longest edge inside; 0: eight times the size")
        .or(Value::Number(0.0)),
    Parameter::text("size_inside", "longest edge inside as a formula of x, y, z [m]; empty: by growth")
        .or(Value::Text("")),
    Parameter::text(
        "size_everywhere",
        "longest edge as a formula of x, y, z [m], at the surface too; `size` is then the smallest; empty: none",
    )
    .or(Value::Text("")),
    Parameter::choice(
        "element",
        &["tet4", "hex_dominant", "voxels"],
        "tetrahedra, hexahedra where they fit, or equal cubes alone, whose surface is a stair",
    )
        .or(Value::Text("tet4")),
];

/// A filling as asked for.
#[derive(Clone, Debug)]
pub struct Options {
    wanted: Wanted,
    growth: f64,
    /// Relative to the size where `None`.
    largest: Option<f64>,
    field: Option<(Formula, Reach)>,
    pub cells: Cells,
    /// Of the lattice, in its cells.
    shift: Vec3,
}

/// A shape in a larger box, in whose middle the lattice lies.
struct Shifted<'a> {
    shape: &'a dyn Shape,
    /// Of the middle [m]; no component is below 0.
    by: Vec3,
}

impl Shape for Shifted<'_> {
    fn value(&self, point: Vec3) -> f64 {
        self.shape.value(point)
    }

    fn range(&self, within: BoundingBox) -> Option<[f64; 2]> {
        self.shape.range(within)
    }

    fn bounds(&self) -> BoundingBox {
        let BoundingBox { low, high } = self.shape.bounds();
        BoundingBox { low, high: high + self.by * 2.0 }
    }
}

/// A filled shape.
#[derive(Clone, Debug)]
pub struct Filled {
    pub mesh: Mesh,
    /// One line for each thing that a user should know.
    pub notes: Vec<String>,
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
/// A count that is missed by more than this part of it is told.
const MET: f64 = 0.1;
/// A formula that is the size itself may differ from it by the rounding of its terms.
const ROUNDED: f64 = 1e-9;
/// Below this, a layer of cells more or less is a large part of all.
const FEW: f64 = 5000.0;
/// Sizes around the best one that are looked at for few cells, and how far they are apart.
const LOOKED_AT: usize = 24;
const STRIDE: f64 = 0.02;

/// A lattice that is looked at for a count has at most so many points, or so many for each cell: a solid body has one or two
/// for a cell, one of a hundredth of its box a hundred.
const MOST_POINTS: f64 = 3e5;
const MOST_POINTS_OF_A_CELL: f64 = 200.0;

/// The formula of a parameter, `None` where it is empty.
fn field(values: &Values, name: &'static str) -> Result<Option<Formula>, MeshError> {
    let text = values.text(name);
    if text.trim().is_empty() {
        return Ok(None);
    }
    Formula::compile(text, FormulaShape::VARIABLES).map(Some).map_err(|error| MeshError::Parameter {
        name,
        value: format!("\"{text}\""),
        expected: format!("a formula of x, y, z: {error}"),
    })
}

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
                let value = if both {
                    format!("{size} m, and `count` is {count}")
                } else {
                    "missing or 0, and so is `count`".to_owned()
                };
                let expected = "one of them above 0: a length [m], or a number of cells".to_owned();
                return Err(MeshError::Parameter { name: "size", value, expected });
            }
        };
        let (inside, everywhere) = (field(values, "size_inside")?, field(values, "size_everywhere")?);
        let field = match (inside, everywhere) {
            (Some(_), Some(everywhere)) => {
                return Err(MeshError::Parameter {
                    name: "size_inside",
                    value: format!("there beside `size_everywhere`, \"{}\"", everywhere.text()),
                    expected: "one of them".to_owned(),
                });
            }
            (Some(inside), None) => Some((inside, Reach::Inside)),
            (None, everywhere) => everywhere.map(|formula| (formula, Reach::Everywhere)),
        };
        let largest = Some(values.number("largest")).filter(|largest| *largest > 0.0);
        let growth = values.number("growth");
        if let (Some((formula, _)), true) = (&field, growth > 0.0) {
            return Err(MeshError::Parameter {
                name: "growth",
                value: format!("{growth}, and sizes follow \"{}\"", formula.text()),
                expected: "one of them".to_owned(),
            });
        }
        if let (Some(largest), None, true) = (largest, &field, growth == 0.0) {
            return Err(MeshError::Parameter {
                name: "largest",
                value: format!("{largest} m, and all cells have one size"),
                expected: "`growth` above 0, `size_inside` or `size_everywhere` with it".to_owned(),
            });
        }
        let cells = match values.text("element") {
            "hex_dominant" => Cells::HexDominant,
            "voxels" => Cells::Voxels,
            _ => Cells::Tetrahedra,
        };
        Ok(Self { wanted, growth, largest, field, cells, shift: Vec3::ZERO })
    }

    fn size(&self, smallest: f64) -> Size {
        let largest = self.largest.unwrap_or(LARGEST * smallest);
        let grading = match &self.field {
            Some((formula, reach)) => {
                let formula = formula.clone();
                let size = Box::new(move |x: Vec3| formula.evaluate(&x.to_array()));
                Grading::Field { size, largest, reach: *reach }
            }
            None if self.growth > 0.0 => Grading::Inward { growth: self.growth, largest },
            None => Grading::Uniform,
        };
        Size { smallest, grading }
    }

    /// How many cells are asked for; `None` where a size is.
    pub fn count(&self) -> Option<f64> {
        match self.wanted {
            Wanted::Count(count) => Some(count),
            Wanted::Size(_) => None,
        }
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

    /// Fills a shape, and says what of it is lost and which wishes came to nothing.
    ///
    /// # Errors
    /// As [`fill`].
    pub fn fill(&self, shape: &dyn Shape, parts: &[Part<'_>]) -> Result<Filled, MeshError> {
        let (mesh, size) = self.cells_of(shape, parts)?;
        let mut notes = lost::of_shape(shape, &size, &mesh);
        notes.extend(self.unmet(&size, &mesh));
        Ok(Filled { mesh, notes })
    }

    /// With the lattice moved by so many of its cells, none below 0; of a size, not of a count.
    pub fn shifted(self, shift: Vec3) -> Self {
        Self { shift, ..self }
    }

    /// The cells alone, and their size.
    pub(super) fn cells_of(&self, shape: &dyn Shape, parts: &[Part<'_>]) -> Result<(Mesh, Size), MeshError> {
        match self.wanted {
            Wanted::Size(size) => {
                self.check_largest(size)?;
                let size = self.size(size);
                let shifted = Shifted { shape, by: self.shift * size.smallest };
                let shape = if self.shift == Vec3::ZERO { shape } else { &shifted };
                Ok((fill(shape, &size, self.cells, parts)?, size))
            }
            Wanted::Count(count) => self.fill_by_count(shape, parts, count),
        }
    }

    /// Wishes that came to nothing, one line for each.
    pub(super) fn unmet(&self, size: &Size, mesh: &Mesh) -> Vec<String> {
        let mut notes = Vec::new();
        if let Wanted::Count(wanted) = self.wanted {
            let cells = mesh.cell_count();
            if (cells as f64 / wanted - 1.0).abs() > MET {
                let few = if wanted < FEW { ": of few cells, whole layers come and go at once" } else { "" };
                let cells = in_number(cells, "cell is", "cells are");
                notes.push(format!("{cells} as near to {wanted} as was found{few}"));
            }
        }
        if self.cells == Cells::HexDominant && mesh.count_of(ElementKind::Hex8) == 0 {
            notes.push(format!(
                "`element`: there are no hexahedra, for no cube of {} m fits into the shape; take a smaller size",
                readable(size.smallest)
            ));
        }
        let is_graded = longest_edge(mesh) > GRADED * size.smallest;
        let smallest = readable(size.smallest);
        match (&self.field, is_graded) {
            (None, false) if self.growth > 0.0 => notes.push(format!(
                "`growth`: all cells have one size, {smallest} m at the surface: no cube of twice that fits where edges may be as \
                 long; take a smaller size or more growth, and `largest` not below twice the size"
            )),
            (Some((formula, _)), false) => notes.push(format!(
                "all cells have one size, {smallest} m: nowhere does a cube of twice that fit where \"{}\" and `largest` allow it",
                formula.text()
            )),
            _ => {}
        }
        if let Some((formula, _)) = &self.field {
            let wanted = mesh.cell_centres().into_iter().map(|x| (formula.evaluate(&x.to_array()), x));
            let least = wanted.min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((least, x)) = least.filter(|(least, _)| *least < size.smallest * (1.0 - ROUNDED)) {
                notes.push(format!(
                    "\"{}\" is {} m at ({:.4}, {:.4}, {:.4}), and no cell is smaller than `size`, {smallest} m",
                    formula.text(),
                    readable(least),
                    x.x,
                    x.y,
                    x.z
                ));
            }
        }
        notes
    }

    /// Fills a shape known by name, its parts as groups.
    ///
    /// # Errors
    /// As [`fill`].
    pub fn fill_body(&self, body: &Body) -> Result<Filled, MeshError> {
        let parts: Vec<Part> =
            body.parts.iter().map(|(name, shape)| Part { name, shape: &**shape }).collect();
        self.fill(&*body.shape, &parts)
    }

    /// Cells go with the cube of the inverse size: a size, what it gave, a better size. Few cells come in jumps, by
    /// whole layers at once: then sizes around the best one are looked at, too.
    fn fill_by_count(
        &self,
        shape: &dyn Shape,
        parts: &[Part<'_>],
        count: f64,
    ) -> Result<(Mesh, Size), MeshError> {
        self.cells.check_memory(count, available_memory())?;
        let extent = shape.bounds().size();
        let mut size = Size::for_count(extent.x * extent.y * extent.z, count);
        let mut best: Option<Attempt> = None;
        let attempts = if count < FEW { MOST_FILLINGS + LOOKED_AT } else { MOST_FILLINGS };
        let mut least = f64::NAN;
        for attempt in 0..attempts {
            let requested = points_of(shape, &self.size(size));
            if requested > MOST_POINTS.max(MOST_POINTS_OF_A_CELL * count) {
                if best.is_some() {
                    break;
                }
                return Err(FillError::Thin { count, size, extent: extent.to_array(), requested }.into());
            }
            let mesh = match fill(shape, &self.size(size), self.cells, parts) {
                Ok(mesh) => mesh,
                // nothing was hit: look closer
                Err(FillError::Nothing { least: found, .. }) => {
                    least = found;
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
            return Err(FillError::Nothing { size, extent: extent.to_array(), least }.into());
        };
        self.check_largest(best.size)?;
        Ok((best.mesh, self.size(best.size)))
    }
}

/// Edges of one size, moved at both ends by a quarter, are up to one and a half of it long; a cube of twice the size has some of
/// `√3` of it, from its centre to its corners.
const GRADED: f64 = 1.6;

fn longest_edge(mesh: &Mesh) -> f64 {
    let at = |cell: &Cell<'_>, node: u8| mesh.points[cell.nodes[usize::from(node)] as usize];
    let edges = mesh.cells().flat_map(|cell| {
        cell.kind.edges().iter().map(move |[a, b]| (at(&cell, *a) - at(&cell, *b)).length())
    });
    edges.fold(0.0, f64::max)
}

/// A filling, and by how much it misses the wanted count: the logarithm of the ratio.
struct Attempt {
    size: f64,
    error: f64,
    mesh: Mesh,
}
