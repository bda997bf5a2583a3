//! Cylinders and cylindrical shells: a ring of columns around a core of squares, layer on layer along an axis.

use std::f64::consts::{FRAC_PI_4, TAU};

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values};

use super::cut::{Blocks, CORNERS, Cut, in_order, middle, on_arc, size_in_order};
use super::{Build, GeneratorEntry, MeshSize};
use crate::{ElementKind, Group, MAX_CELLS, Mesh, MeshError};

const ELEMENTS: &[&str] =
    &["tet4", "hex8", "prism6", "pyramid5", "tet10", "hex20", "hex27", "prism15", "pyramid13"];
const ELEMENT: Parameter = Parameter::choice("element", ELEMENTS, "kind of cells").or(Value::Text("tet4"));
const ORIGIN: Parameter =
    Parameter::vector("origin", "m", "middle of the end of least x").or(Value::Vector([0.0; 3]));

pub(super) static CYLINDER: GeneratorEntry = GeneratorEntry {
    name: "cylinder",
    summary: "cylinder along x; groups x_min, x_max, `side`",
    source: "square core in a ring, the plane section of the cubed sphere",
    parameters: &[
        Parameter::number("length", "m", Range::POSITIVE, "along x"),
        Parameter::number("radius", "m", Range::POSITIVE, "radius of the circle"),
        Parameter::integer("cells", Range::at_least(3.0), "number of cells along the diameter"),
        Parameter::integer("cells_along", Range::at_least(1.0), "number of cells along x"),
        ELEMENT,
        ORIGIN,
    ],
    build: Build { size: cylinder_size, mesh: cylinder },
};

pub(super) static SHELL: GeneratorEntry = GeneratorEntry {
    name: "shell",
    summary: "cylindrical shell along x, a whole tube or a slab of it; groups x_min, x_max, `inner`, `outer`",
    source: "own",
    parameters: &[
        Parameter::number("length", "m", Range::POSITIVE, "along x"),
        Parameter::number("radius", "m", Range::POSITIVE, "outer radius"),
        Parameter::number("thickness", "m", Range::POSITIVE, "of the wall, below the radius"),
        Parameter::number(
            "angle",
            "rad",
            Range { high_included: true, ..Range::open(0.0, TAU) },
            "of the arc, from the y axis to z",
        )
        .or(Value::Number(TAU)),
        Parameter::integer("cells_around", Range::at_least(1.0), "number of cells around"),
        Parameter::integer("cells_through", Range::at_least(1.0), "number of cells through the wall")
            .or(Value::Integer(1)),
        Parameter::integer("cells_along", Range::at_least(1.0), "number of cells along x"),
        ELEMENT,
        ORIGIN,
    ],
    build: Build { size: shell_size, mesh: shell },
};

/// A plane section: points of `y, z`, quadrilaterals, and rings of points by name.
#[derive(Default)]
struct Section {
    points: Vec<[f64; 2]>,
    /// Counterclockwise seen from greater x.
    quads: Vec<[u32; 4]>,
    rings: Vec<(&'static str, Vec<u32>)>,
}

/// Half the edge of the core relative to the radius, and how far it bulges towards a circle, as in the ball.
const CORE: f64 = 0.5;
const BULGE: f64 = 0.5;

impl Section {
    fn disc(radius: f64, cells: usize) -> Self {
        let layers = (cells / 4).max(1);
        let n = cells - 2 * layers;
        let mut section = Self::default();
        let core = |y: f64, z: f64| {
            let on_disc = [y * (1.0 - 0.5 * z * z).sqrt(), z * (1.0 - 0.5 * y * y).sqrt()];
            [0, 1].map(|i| CORE * ((1.0 - BULGE) * [y, z][i] + BULGE * on_disc[i]))
        };
        let unit = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
        for k in 0..=n {
            section.points.extend((0..=n).map(|j| core(unit(j), unit(k)).map(|c| c * radius)));
        }
        let at = |j: usize, k: usize| (j + (n + 1) * k) as u32;
        for k in 0..n {
            section.quads.extend((0..n).map(|j| [at(j, k), at(j + 1, k), at(j + 1, k + 1), at(j, k + 1)]));
        }
        // around the core, counterclockwise from its lowest corner
        let around: Vec<[usize; 2]> = (0..n)
            .map(|j| [j, 0])
            .chain((0..n).map(|k| [n, k]))
            .chain((0..n).map(|j| [n - j, n]))
            .chain((0..n).map(|k| [0, n - k]))
            .collect();
        let mut ring: Vec<u32> = around.iter().map(|[j, k]| at(*j, *k)).collect();
        for layer in 1..=layers {
            let share = layer as f64 / layers as f64;
            let first = section.points.len() as u32;
            for [j, k] in &around {
                let (y, z) = (unit(*j), unit(*k));
                let ray = [libm::tan(FRAC_PI_4 * y), libm::tan(FRAC_PI_4 * z)];
                let length = libm::hypot(ray[0], ray[1]);
                let inner = core(y, z);
                section
                    .points
                    .push([0, 1].map(|i| radius * (inner[i] * (1.0 - share) + ray[i] / length * share)));
            }
            let next: Vec<u32> = (first..first + around.len() as u32).collect();
            section.quads.extend(between(&ring, &next, Turn::Closed));
            ring = next;
        }
        section.rings.push(("side", ring));
        section
    }

    fn arc([inner, outer]: [f64; 2], angle: f64, around: usize, through: usize) -> Self {
        let mut section = Self::default();
        let mut rings: Vec<Vec<u32>> = Vec::new();
        // a whole turn ends where it began
        let turn = if angle < TAU { Turn::Open } else { Turn::Closed };
        let count = around + usize::from(turn == Turn::Open);
        for layer in 0..=through {
            let radius = inner + (outer - inner) * layer as f64 / through as f64;
            let first = section.points.len() as u32;
            section.points.extend((0..count).map(|step| {
                let angle = angle * step as f64 / around as f64;
                [radius * libm::cos(angle), radius * libm::sin(angle)]
            }));
            rings.push((first..first + count as u32).collect());
        }
        for pair in rings.windows(2) {
            section.quads.extend(between(&pair[0], &pair[1], turn));
        }
        let [first, last] = [rings.remove(0), rings.pop().unwrap_or_default()];
        section.rings = vec![("inner", first), ("outer", last)];
        section
    }

    /// What [`Self::swept`] will make.
    fn size(&self, layers: usize, cut: Cut) -> MeshSize {
        let cubes = (self.quads.len() * layers) as u64;
        let centres = if matches!(cut, Cut::Pyramids | Cut::Centred) { cubes } else { 0 };
        let points = (self.points.len() * (layers + 1)) as u64 + centres;
        MeshSize { points, cells: cubes * cut.cells_per_cube() }
    }

    /// The section swept along x; the axis of prisms is x.
    fn swept(&self, length: f64, layers: usize, origin: Vec3, cut: Cut) -> Mesh {
        let count = self.points.len() as u32;
        let mut points = Vec::with_capacity(self.points.len() * (layers + 1));
        for layer in 0..=layers {
            let x = length * layer as f64 / layers as f64;
            points.extend(self.points.iter().map(|[y, z]| origin + Vec3::new(x, *y, *z)));
        }
        let mut blocks = Blocks::default();
        for layer in 0..layers as u32 {
            for [a, b, c, d] in &self.quads {
                // axes of the cube: x, then along and across the section
                let corners = CORNERS.map(|[i, j, k]| {
                    let around = [[*a, *d], [*b, *c]][j][k];
                    around + count * (layer + i as u32)
                });
                match cut {
                    Cut::Hexahedra => blocks.push(ElementKind::Hex8, &corners),
                    Cut::Prisms => blocks.prisms(corners),
                    Cut::Tetrahedra | Cut::Mixed => blocks.numbered_tetrahedra(corners),
                    Cut::Pyramids | Cut::Centred => {
                        let middle = corners.iter().map(|node| points[*node as usize]).sum::<Vec3>() / 8.0;
                        points.push(middle);
                        let centre = points.len() as u32 - 1;
                        if cut == Cut::Centred {
                            blocks.centred_tetrahedra(corners, centre);
                        } else {
                            blocks.pyramids(corners, centre, None);
                        }
                    }
                }
            }
        }
        let group = |points: Vec<u32>| Group { points, ..Group::default() };
        let mut groups = std::collections::BTreeMap::new();
        groups.insert("x_min".to_owned(), group((0..count).collect()));
        groups.insert(
            "x_max".to_owned(),
            group((count * layers as u32..count * (layers as u32 + 1)).collect()),
        );
        for (name, ring) in &self.rings {
            let mut all: Vec<u32> =
                (0..=layers as u32).flat_map(|layer| ring.iter().map(move |p| p + count * layer)).collect();
            all.sort_unstable();
            groups.insert((*name).to_owned(), group(all));
        }
        Mesh { points, blocks: blocks.list(), facet_blocks: Vec::new(), groups }
    }
}

/// Whether a ring of points ends where it began.
#[derive(Clone, Copy, PartialEq)]
enum Turn {
    Closed,
    Open,
}

/// Quadrilaterals between a ring and the next one outside.
fn between<'a>(inner: &'a [u32], outer: &'a [u32], turn: Turn) -> impl Iterator<Item = [u32; 4]> + 'a {
    let n = inner.len();
    (0..n - usize::from(turn == Turn::Open))
        .map(move |i| [inner[i], outer[i], outer[(i + 1) % n], inner[(i + 1) % n]])
}

fn check_count(cells: f64, cut: Cut) -> Result<(), MeshError> {
    let requested = cells * cut.cells_per_cube() as f64;
    if requested > MAX_CELLS as f64 {
        Err(MeshError::TooManyCells { requested, limit: MAX_CELLS })
    } else {
        Ok(())
    }
}

/// Section, layers and cut of a cylinder.
fn cylinder_parts(values: &Values) -> Result<(Section, usize, Cut), MeshError> {
    let (cells, along, cut) =
        (values.integer("cells"), values.integer("cells_along"), Cut::from_values(values));
    check_count((cells as f64).powi(2) * along as f64, cut)?;
    Ok((Section::disc(values.number("radius"), cells as usize), along as usize, cut))
}

fn cylinder_size(values: &Values) -> Result<MeshSize, MeshError> {
    let (section, along, cut) = cylinder_parts(values)?;
    Ok(size_in_order(values, section.size(along, cut)))
}

fn cylinder(values: &Values) -> Result<Mesh, MeshError> {
    let (section, along, cut) = cylinder_parts(values)?;
    let origin = Vec3::from_array(values.vector("origin"));
    let radius = values.number("radius");
    let round = |ends: [Vec3; 2]| {
        // only the side is round: the rings inside change from squares to circles
        let is_side =
            |end: Vec3| (libm::hypot(end.y - origin.y, end.z - origin.z) - radius).abs() < 1e-9 * radius;
        if ends.into_iter().all(is_side) { around_axis(ends, origin) } else { middle(ends) }
    };
    Ok(in_order(values, section.swept(values.number("length"), along, origin, cut), round))
}

/// The middle of an edge, on the arc around the axis where both ends are as far from it.
fn around_axis(ends: [Vec3; 2], origin: Vec3) -> Vec3 {
    let x = middle(ends).x;
    let across = ends.map(|end| Vec3::new(x, end.y, end.z));
    on_arc(across, Vec3::new(x, origin.y, origin.z))
}

/// Section, layers and cut of a shell.
fn shell_parts(values: &Values) -> Result<(Section, usize, Cut), MeshError> {
    let (radius, thickness) = (values.number("radius"), values.number("thickness"));
    if thickness >= radius {
        let expected = format!("a thickness below the radius, {radius} [m]");
        return Err(MeshError::Parameter { name: "thickness", value: thickness.to_string(), expected });
    }
    let [around, through, along] =
        ["cells_around", "cells_through", "cells_along"].map(|name| values.integer(name));
    let cut = Cut::from_values(values);
    let angle = values.number("angle");
    if angle == TAU && around < 3 {
        let expected = "at least 3 around a whole turn".to_owned();
        return Err(MeshError::Parameter { name: "cells_around", value: around.to_string(), expected });
    }
    check_count(around as f64 * through as f64 * along as f64, cut)?;
    let section = Section::arc([radius - thickness, radius], angle, around as usize, through as usize);
    Ok((section, along as usize, cut))
}

fn shell_size(values: &Values) -> Result<MeshSize, MeshError> {
    let (section, along, cut) = shell_parts(values)?;
    Ok(size_in_order(values, section.size(along, cut)))
}

fn shell(values: &Values) -> Result<Mesh, MeshError> {
    let (section, along, cut) = shell_parts(values)?;
    let origin = Vec3::from_array(values.vector("origin"));
    let mesh = section.swept(values.number("length"), along, origin, cut);
    Ok(in_order(values, mesh, |ends| around_axis(ends, origin)))
}
