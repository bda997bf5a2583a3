//! Balls, solid and hollow: a core of n³ cubes and a shell of layers around it, six blocks of n² columns each.
//!
//! A cube mapped to a ball would flatten the cells at its edges and corners on the sphere; here three blocks meet
//! along the edges of the core, and no cell has a corner flatter than those between three blocks.
//!
//! Points: the core's (of a hollow ball, only those on its outside, on the inner sphere) `i + (n+1)(j + (n+1)k)`, then layer after layer the points on its outside in that order,
//! then centres of cubes where a cut needs them.

use std::f64::consts::FRAC_PI_4;

use souple_math::Vec3;
use souple_table::{Parameter, Range, Value, Values};

use super::cut::{
    BASE_X_MAX, BASE_X_MIN, BASE_Z_MAX, Blocks, CORNERS, Cut, in_order, middle, on_arc, size_in_order,
};
use super::{Build, GeneratorEntry};
use crate::{ElementKind, Group, MAX_CELLS, Mesh, MeshError, MeshSize};

pub(super) static SPHERE: GeneratorEntry = GeneratorEntry {
    name: "sphere",
    summary: "solid ball; group `surface` holds the points on the sphere",
    source: "Ronchi, Iacono & Paolucci 1996 (equiangular cubed sphere)",
    parameters: &[
        Parameter::number("radius", "m", Range::POSITIVE, "radius of the ball"),
        Parameter::integer(
            "cells",
            Range::at_least(3.0),
            "number of cubes along the diameter; `mixed` takes 8 or more",
        ),
        Cut::PARAMETER,
        Parameter::vector("centre", "m", "centre of the ball").or(Value::Vector([0.0; 3])),
    ],
    build: Build { size, mesh: ball },
};

pub(super) static HOLLOW_SPHERE: GeneratorEntry = GeneratorEntry {
    name: "hollow_sphere",
    summary: "ball with a concentric hollow; groups `surface` and `inner` hold the points on the two spheres",
    source: "Ronchi, Iacono & Paolucci 1996 (equiangular cubed sphere)",
    parameters: &[
        Parameter::number("radius", "m", Range::POSITIVE, "radius of the outer sphere"),
        Parameter::number("inner_radius", "m", Range::POSITIVE, "radius of the hollow"),
        Parameter::integer(
            "cells",
            Range::at_least(1.0),
            "number of cubes along a quarter of a great circle",
        ),
        Parameter::integer(
            "layers",
            Range::at_least(1.0),
            "number of cubes through the wall; `mixed` takes 3 or more",
        ),
        Cut::PARAMETER,
        Parameter::vector("centre", "m", "centre of the ball").or(Value::Vector([0.0; 3])),
    ],
    build: Build { size: hollow_size, mesh: hollow_ball },
};

/// Half the edge of the core, relative to the radius: cells of core and shell are then of like size.
const CORE: f64 = 0.5;
/// How far the core bulges from a cube towards a ball.
const BULGE: f64 = 0.5;

/// Layers that a mixed ball needs: pyramids, tetrahedra, prisms.
const MIXED_LAYERS: usize = 3;

/// Cubes along the edge of the core, and layers of the shell around it.
fn core_and_layers(values: &Values) -> Result<(usize, usize), MeshError> {
    let (cells, cut) = (values.integer("cells"), Cut::from_values(values));
    let requested = (cells as f64).powi(3) * cut.cells_per_cube() as f64;
    if requested > MAX_CELLS as f64 {
        return Err(MeshError::TooManyCells { requested, limit: MAX_CELLS });
    }
    let cells = cells as usize;
    // a quarter of the diameter on either side is shell
    let mut layers = (cells / 4).max(1);
    if cut == Cut::Mixed {
        layers = layers.max(MIXED_LAYERS);
        if cells < 2 * MIXED_LAYERS + 2 {
            let expected = format!("at least {} cubes along the diameter for `mixed`", 2 * MIXED_LAYERS + 2);
            return Err(MeshError::Parameter { name: "cells", value: cells.to_string(), expected });
        }
    }
    Ok((cells - 2 * layers, layers))
}

fn size(values: &Values) -> Result<MeshSize, MeshError> {
    let (n, layers) = core_and_layers(values)?;
    let (n, layers, cut) = (n as u64, layers as u64, Cut::from_values(values));
    let cubes = n.pow(3) + 6 * n.pow(2) * layers;
    // the outside of the core, once for each layer: 6 n² + 2 points
    let corners = (n + 1).pow(3) + layers * (6 * n.pow(2) + 2);
    let centres = match cut {
        Cut::Pyramids | Cut::Centred => cubes,
        Cut::Mixed => 6 * n.pow(2),
        _ => 0,
    };
    let size = MeshSize { points: corners + centres, cells: cubes * cut.cells_per_cube() };
    Ok(size_in_order(values, size))
}

fn ball(values: &Values) -> Result<Mesh, MeshError> {
    let (radius, centre) = (values.number("radius"), Vec3::from_array(values.vector("centre")));
    let (n, layers) = core_and_layers(values)?;
    let mut mesh = Shells::new(n, layers, Core::Solid).mesh(Cut::from_values(values));
    for point in &mut mesh.points {
        *point = centre + *point * radius;
    }
    // only the surface is round: the layers inside change from a cube to it
    let on_sphere = |end: Vec3| ((end - centre).length() - radius).abs() < 1e-9 * radius;
    let round = |ends: [Vec3; 2]| {
        if ends.into_iter().all(on_sphere) { on_arc(ends, centre) } else { middle(ends) }
    };
    Ok(in_order(values, mesh, round))
}

/// The relative radius of the hollow, cubes along a quarter and through the wall, or why there are none.
fn wall(values: &Values) -> Result<(f64, usize, usize), MeshError> {
    let (radius, inner) = (values.number("radius"), values.number("inner_radius"));
    let (cells, layers) = (values.integer("cells"), values.integer("layers"));
    if inner >= radius {
        let expected = format!("less than the radius, {radius} m");
        return Err(MeshError::Parameter { name: "inner_radius", value: inner.to_string(), expected });
    }
    let cut = Cut::from_values(values);
    if cut == Cut::Mixed && layers < MIXED_LAYERS as i64 {
        let expected = format!("at least {MIXED_LAYERS} for `mixed`");
        return Err(MeshError::Parameter { name: "layers", value: layers.to_string(), expected });
    }
    let requested = 6.0 * (cells as f64).powi(2) * layers as f64 * cut.cells_per_cube() as f64;
    if requested > MAX_CELLS as f64 {
        return Err(MeshError::TooManyCells { requested, limit: MAX_CELLS });
    }
    Ok((inner / radius, cells as usize, layers as usize))
}

fn hollow_size(values: &Values) -> Result<MeshSize, MeshError> {
    let (_, n, layers) = wall(values)?;
    let (n, layers, cut) = (n as u64, layers as u64, Cut::from_values(values));
    let cubes = 6 * n.pow(2) * layers;
    let centres = match cut {
        Cut::Pyramids | Cut::Centred => cubes,
        Cut::Mixed => 6 * n.pow(2),
        _ => 0,
    };
    let points = (layers + 1) * (6 * n.pow(2) + 2) + centres;
    Ok(size_in_order(values, MeshSize { points, cells: cubes * cut.cells_per_cube() }))
}

fn hollow_ball(values: &Values) -> Result<Mesh, MeshError> {
    let (inner, n, layers) = wall(values)?;
    let (radius, centre) = (values.number("radius"), Vec3::from_array(values.vector("centre")));
    let mut mesh = Shells::new(n, layers, Core::Hollow { radius: inner }).mesh(Cut::from_values(values));
    for point in &mut mesh.points {
        *point = centre + *point * radius;
    }
    Ok(in_order(values, mesh, |ends| on_arc(ends, centre)))
}

/// What is inside the shell of a unit ball.
#[derive(Clone, Copy, PartialEq)]
enum Core {
    Solid,
    Hollow { radius: f64 },
}

struct Shells {
    /// Cubes along the edge of the core.
    n: usize,
    layers: usize,
    core: Core,
    /// Points on the outside of the core, in the order of the core's points.
    outside: Vec<[usize; 3]>,
}

/// The corners of a cube and, in the shell, its layer and the face turned outward.
struct Cube {
    corners: [u32; 8],
    shell: Option<(usize, usize)>,
}

impl Shells {
    fn new(n: usize, layers: usize, core: Core) -> Self {
        let mut outside = Vec::with_capacity(6 * n * n + 2);
        for k in 0..=n {
            for j in 0..=n {
                let is_inner = [j, k].iter().all(|index| *index > 0 && *index < n);
                // of a row through the inside only its ends
                outside.extend((0..=n).step_by(if is_inner { n } else { 1 }).map(|i| [i, j, k]));
            }
        }
        Self { n, layers, core, outside }
    }

    /// Place in `outside` of a point of the core that is there.
    fn rank(&self, [i, j, k]: [usize; 3]) -> usize {
        let n = self.n;
        // whole planes at the ends, and between them rings: two whole rows and the ends of the others
        if k == 0 || k == n {
            let before = if k == 0 { 0 } else { (n + 1).pow(2) + 4 * n * (n - 1) };
            return before + i + (n + 1) * j;
        }
        let in_ring = match j {
            0 => i,
            j if j == n => (n + 1) + 2 * (n - 1) + i,
            _ => (n + 1) + 2 * (j - 1) + i / n,
        };
        (n + 1).pow(2) + 4 * n * (k - 1) + in_ring
    }

    fn core_count(&self) -> usize {
        (self.n + 1).pow(3)
    }

    /// Point of the core (layer 0) or above its outside.
    fn point(&self, place: [usize; 3], layer: usize) -> u32 {
        let [i, j, k] = place;
        match (self.core, layer) {
            (Core::Solid, 0) => (i + (self.n + 1) * (j + (self.n + 1) * k)) as u32,
            _ => self.first_of(layer) + self.rank(place) as u32,
        }
    }

    /// Number of the first point of a layer; layer 0 only where there is a hollow.
    fn first_of(&self, layer: usize) -> u32 {
        let before = match self.core {
            Core::Solid => self.core_count() + (layer - 1) * self.outside.len(),
            Core::Hollow { .. } => layer * self.outside.len(),
        };
        before as u32
    }

    /// Positions in the unit ball, in the order of `point`.
    fn points(&self) -> Vec<Vec3> {
        let n = self.n as f64;
        let unit = |index: [usize; 3]| {
            let [x, y, z] = index.map(|i| 2.0 * i as f64 / n - 1.0);
            Vec3::new(x, y, z)
        };
        let mut points = Vec::new();
        let first_layer = match self.core {
            Core::Hollow { .. } => 0,
            Core::Solid => {
                points.reserve(self.core_count());
                for k in 0..=self.n {
                    for j in 0..=self.n {
                        points.extend((0..=self.n).map(|i| core_position(unit([i, j, k]))));
                    }
                }
                1
            }
        };
        for layer in first_layer..=self.layers {
            let share = layer as f64 / self.layers as f64;
            for index in &self.outside {
                let cube = unit(*index);
                // equal angles between the columns
                let tangent = |c: f64| libm::tan(FRAC_PI_4 * c);
                let ray = Vec3::new(tangent(cube.x), tangent(cube.y), tangent(cube.z));
                let sphere = ray / ray.length();
                points.push(match self.core {
                    Core::Solid => core_position(cube) * (1.0 - share) + sphere * share,
                    Core::Hollow { radius } => sphere * (radius + (1.0 - radius) * share),
                });
            }
        }
        points
    }

    /// All cubes. The first axis of each is the axis of its prisms: x through the core and the blocks beyond its
    /// ends, around x in the four blocks between; prisms then meet prisms by triangles and quadrilaterals alike.
    fn cubes(&self) -> Vec<Cube> {
        let n = self.n;
        let mut cubes = Vec::new();
        let core_cubes = if self.core == Core::Solid { n } else { 0 };
        for k in 0..core_cubes {
            for j in 0..n {
                for i in 0..n {
                    let corners = CORNERS.map(|[a, b, c]| self.point([i + a, j + b, k + c], 0));
                    cubes.push(Cube { corners, shell: None });
                }
            }
        }
        for layer in 0..self.layers {
            for v in 0..n {
                for u in 0..n {
                    let mut push = |outward: usize, at: &dyn Fn([usize; 3]) -> u32| {
                        cubes.push(Cube { corners: CORNERS.map(at), shell: Some((layer, outward)) });
                    };
                    // beyond the ends: axes x, y, z
                    push(BASE_X_MIN, &|[a, b, c]| self.point([0, u + b, v + c], layer + 1 - a));
                    push(BASE_X_MAX, &|[a, b, c]| self.point([n, u + b, v + c], layer + a));
                    // between: axes around x, along x, outward
                    push(BASE_Z_MAX, &|[a, b, c]| self.point([u + b, n, v + a], layer + c));
                    push(BASE_Z_MAX, &|[a, b, c]| self.point([u + b, n - v - a, n], layer + c));
                    push(BASE_Z_MAX, &|[a, b, c]| self.point([u + b, 0, n - v - a], layer + c));
                    push(BASE_Z_MAX, &|[a, b, c]| self.point([u + b, v + a, 0], layer + c));
                }
            }
        }
        cubes
    }

    fn mesh(&self, cut: Cut) -> Mesh {
        let mut points = self.points();
        let first_outer = points.len() as u32 - self.outside.len() as u32;
        let surface = (first_outer..points.len() as u32).collect();
        let mut blocks = Blocks::default();
        for Cube { corners, shell } in self.cubes() {
            let mut centre = || {
                let mean = corners.iter().map(|node| points[*node as usize]).sum::<Vec3>() / 8.0;
                points.push(mean);
                points.len() as u32 - 1
            };
            match (cut, shell) {
                (Cut::Hexahedra, _) | (Cut::Mixed, None) => blocks.push(ElementKind::Hex8, &corners),
                (Cut::Prisms, _) => blocks.prisms(corners),
                (Cut::Pyramids, _) => blocks.pyramids(corners, centre(), None),
                (Cut::Centred, _) => blocks.centred_tetrahedra(corners, centre()),
                (Cut::Tetrahedra, _) => blocks.numbered_tetrahedra(corners),
                // from inside: hexahedra, pyramids that meet tetrahedra outward, tetrahedra, prisms
                (Cut::Mixed, Some((0, outward))) => blocks.pyramids(corners, centre(), Some(outward)),
                (Cut::Mixed, Some((layer, outward))) if layer + 1 == self.layers => {
                    blocks.prisms_towards(corners, outward);
                }
                (Cut::Mixed, Some(_)) => blocks.numbered_tetrahedra(corners),
            }
        }
        let of_points = |points| Group { points, ..Group::default() };
        let mut groups = std::collections::BTreeMap::from([("surface".to_owned(), of_points(surface))]);
        if let Core::Hollow { .. } = self.core {
            groups.insert("inner".to_owned(), of_points((0..self.outside.len() as u32).collect()));
        }
        Mesh { points, blocks: blocks.list(), facet_blocks: Vec::new(), groups }
    }
}

/// Maps `[-1, 1]³` to the core: between the cube and `x' = x √(1 - y²/2 - z²/2 + y²z²/3)`, which makes it a ball.
fn core_position(p: Vec3) -> Vec3 {
    let factor = |a: f64, b: f64| (1.0 - 0.5 * a * a - 0.5 * b * b + a * a * b * b / 3.0).sqrt();
    let ball = Vec3::new(p.x * factor(p.y, p.z), p.y * factor(p.z, p.x), p.z * factor(p.x, p.y));
    (p * (1.0 - BULGE) + ball * BULGE) * CORE
}
