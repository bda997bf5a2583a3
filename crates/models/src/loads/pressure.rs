//! Pressure on the faces of a body that follows them as they move and turn.
//!
//! For loads that keep their direction take a [`super::PointLoad`] with shares of area: a traction.

use std::any::Any;
use std::collections::HashMap;

use souple_engine::tangent::add_block;
use souple_engine::{Configuration, Declaration, Energy, Force, Pair, Scratch, TangentWeights};
use souple_formal::Formula;
use souple_math::{Mat3, Vec3};
use souple_mesh::ElementKind;
use souple_solve::BlockMatrix;

use super::{LoadError, finite};

/// The most nodes of a face: a quadrilateral with corners, middles of sides and its centre.
const NODES: usize = 9;

/// A face that is pressed: a triangle or quadrilateral of rows, linear or quadratic, counterclockwise seen from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PressedFace {
    rows: [u32; NODES],
    kind: ElementKind,
}

impl PressedFace {
    /// `None` unless it is a surface element with a row for each node.
    pub fn new(kind: ElementKind, rows: &[u32]) -> Option<Self> {
        if kind.dimension() != 2 || rows.len() != kind.node_count() || rows.len() > NODES {
            return None;
        }
        let mut nodes = [0; NODES];
        nodes[..rows.len()].copy_from_slice(rows);
        Some(Self { rows: nodes, kind })
    }

    /// Nodes: corners in order, then middles of sides, then the centre.
    pub fn rows(&self) -> &[u32] {
        &self.rows[..self.kind.node_count()]
    }
}

/// Quadrature of one kind of face: exact for a uniform pressure.
#[derive(Clone, Debug)]
struct Samples {
    /// Per point: weight, shape functions, and their derivatives by `ξ` and `η`.
    points: Vec<Sample>,
}

#[derive(Clone, Copy, Debug)]
struct Sample {
    weight: f64,
    shape: [f64; NODES],
    by_xi: [f64; NODES],
    by_eta: [f64; NODES],
}

impl Samples {
    fn of(kind: ElementKind) -> Self {
        // N (x_ξ × x_η) has no higher degree than that rule integrates: `uses_follow_from_the_data` in the room of the elements
        let rule = kind.mass_rule();
        let sample = |point: &souple_mesh::QuadraturePoint| {
            let (shape, gradients) = (kind.shape(point.position), kind.shape_gradients(point.position));
            let mut sample = Sample {
                weight: point.weight,
                shape: [0.0; NODES],
                by_xi: [0.0; NODES],
                by_eta: [0.0; NODES],
            };
            for corner in 0..kind.node_count() {
                sample.shape[corner] = shape[corner];
                sample.by_xi[corner] = gradients[corner].x;
                sample.by_eta[corner] = gradients[corner].y;
            }
            sample
        };
        Self { points: rule.points.iter().map(sample).collect() }
    }
}

/// Position and tangents of a face at a sample: `x`, `x_ξ`, `x_η`.
struct Placed {
    x: Vec3,
    by_xi: Vec3,
    by_eta: Vec3,
}

impl Placed {
    fn of(sample: &Sample, rows: &[u32], positions: &[Vec3]) -> Self {
        let mut placed = Self { x: Vec3::ZERO, by_xi: Vec3::ZERO, by_eta: Vec3::ZERO };
        for (corner, row) in rows.iter().enumerate() {
            let x = positions[*row as usize];
            placed.x += x * sample.shape[corner];
            placed.by_xi += x * sample.by_xi[corner];
            placed.by_eta += x * sample.by_eta[corner];
        }
        placed
    }

    /// `x_ξ × x_η`: outward normal times area per reference area.
    fn area_vector(&self) -> Vec3 {
        self.by_xi.cross(self.by_eta)
    }
}

/// `f_a = -∫ p(x, t) N_a n dA` over the faces as they are now.
///
/// Positive pressure pushes into the body. Over a closed surface, and for a pressure that is the same everywhere
/// on it, there is an energy `p V` with the enclosed volume `V`, and the tangent is symmetric; otherwise work
/// depends on the path and the tangent is not.
///
/// Source: Bonet & Wood 2008, §6.5.2 and §7.3 (linearisation of pressure).
#[derive(Clone, Debug)]
pub struct Pressure {
    name: String,
    faces: Vec<PressedFace>,
    /// Of [`super::VARIABLES`]: where the face is now, and the time [Pa].
    pressure: Formula,
    varies_with_place: bool,
    /// By kind of face, where there is one of it.
    samples: Vec<(ElementKind, Samples)>,
    is_closed: bool,
}

impl Pressure {
    /// `pressure` [Pa] is a formula of [`super::VARIABLES`]: where the face is now, and the time.
    ///
    /// # Errors
    /// No faces, or a constant that is not finite.
    pub fn new(
        name: impl Into<String>,
        faces: Vec<PressedFace>,
        pressure: Formula,
    ) -> Result<Self, LoadError> {
        if faces.is_empty() {
            return Err(LoadError::Empty { field: "faces", expected: "face that is pressed" });
        }
        let depends_on =
            |variables: std::ops::Range<usize>| variables.into_iter().any(|v| pressure.depends_on(v));
        let (varies_with_place, is_constant) = (depends_on(0..3), !depends_on(0..super::VARIABLES.len()));
        if is_constant {
            finite("pressure", pressure.evaluate(&[0.0; super::VARIABLES.len()]))?;
        }
        let is_closed = is_closed(&faces);
        let mut samples: Vec<(ElementKind, Samples)> = Vec::new();
        for face in &faces {
            if samples.iter().all(|(kind, _)| *kind != face.kind) {
                samples.push((face.kind, Samples::of(face.kind)));
            }
        }
        Ok(Self { name: name.into(), faces, pressure, varies_with_place, samples, is_closed })
    }

    fn has_energy(&self) -> bool {
        self.is_closed && !self.varies_with_place
    }

    fn value(&self, x: Vec3, time: f64) -> f64 {
        self.pressure.evaluate(&[x.x, x.y, x.z, time])
    }

    fn gradient(&self, x: Vec3, time: f64) -> Vec3 {
        if !self.varies_with_place {
            return Vec3::ZERO;
        }
        let by = |axis: usize| self.pressure.differentiate(&[x.x, x.y, x.z, time], axis).derivative;
        Vec3::from_array([0, 1, 2].map(by))
    }

    /// Calls `visit(face, sample, placed)` for every sample in order.
    fn for_samples(&self, positions: &[Vec3], mut visit: impl FnMut(&PressedFace, &Sample, &Placed)) {
        for face in &self.faces {
            let of_kind = self.samples.iter().find(|(kind, _)| *kind == face.kind);
            for sample in of_kind.iter().flat_map(|(_, samples)| &samples.points) {
                visit(face, sample, &Placed::of(sample, face.rows(), positions));
            }
        }
    }

    /// Calls `add(a, b, block)` with `∂f_a/∂x_b`.
    ///
    /// `δf_a = -N_a w (p (δx_ξ × x_η + x_ξ × δx_η) + (∇p·δx) x_ξ × x_η)`.
    fn for_blocks(&self, at: &Configuration, mut add: impl FnMut(u32, u32, Mat3)) {
        self.for_samples(at.positions, |face, sample, placed| {
            let p = self.value(placed.x, at.time);
            let (xi, eta) = (placed.by_xi.cross_matrix() * p, placed.by_eta.cross_matrix() * p);
            let steepening = placed.area_vector().outer(self.gradient(placed.x, at.time));
            for (a, row_a) in face.rows().iter().enumerate() {
                let weight = -at.load * sample.weight * sample.shape[a];
                for (b, row_b) in face.rows().iter().enumerate() {
                    let turning = xi * sample.by_eta[b] - eta * sample.by_xi[b];
                    add(*row_a, *row_b, (turning + steepening * sample.shape[b]) * weight);
                }
            }
        });
    }
}

/// Whether every side is met by another in the opposite direction.
fn is_closed(faces: &[PressedFace]) -> bool {
    let mut sides: HashMap<(u32, u32), i32> = HashMap::new();
    for face in faces {
        let rows = &face.rows()[..face.kind.corner_count()];
        for (corner, &from) in rows.iter().enumerate() {
            let to = rows[(corner + 1) % rows.len()];
            let turn = if from < to { 1 } else { -1 };
            *sides.entry((from.min(to), from.max(to))).or_default() += turn;
        }
    }
    sides.values().all(|balance| *balance == 0)
}

impl Force for Pressure {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        let has_energy = self.has_energy();
        Declaration { conservative: has_energy, symmetric_tangent: has_energy, ..Declaration::LOAD }
    }

    // E = p V,  V = 1/3 ∮ x·n dA
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        if !self.has_energy() {
            return Energy::default();
        }
        let mut stored = 0.0;
        self.for_samples(at.positions, |_, sample, placed| {
            let p = self.value(placed.x, at.time);
            stored += at.load * p * sample.weight * placed.x.dot(placed.area_vector()) / 3.0;
        });
        Energy { stored, dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        self.for_samples(at.positions, |face, sample, placed| {
            let p = self.value(placed.x, at.time);
            let push = placed.area_vector() * (-at.load * p * sample.weight);
            for (corner, row) in face.rows().iter().enumerate() {
                out[*row as usize] += push * sample.shape[corner];
            }
        });
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.for_blocks(at, |a, b, block| {
            out[a as usize] += block * delta[b as usize] * weights.position;
        });
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.faces.iter().for_each(|face| visit(face.rows()));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.for_blocks(at, |a, b, block| {
            add_block(matrix, a as usize, b as usize, &(block * weights.position));
        });
    }

    // (K + Kᵀ)/2
    fn add_symmetric_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.for_blocks(at, |a, b, block| {
            let half = block * (0.5 * weights.position);
            add_block(matrix, a as usize, b as usize, &half);
            add_block(matrix, b as usize, a as usize, &half.transpose());
        });
    }

    fn bytes(&self) -> usize {
        size_of_val(self.faces.as_slice())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
