//! Points of a body held or led by stiff springs: what pins become where a point is no unknown.
//!
//! A pinned point of a mesh is taken out of the unknowns; a point that frames carry cannot be. A spring of the stiffness
//! of a thin layer of the material holds it instead, along the pinned axes, and what it gives way is small next to what
//! the body does: see [`layer_stiffness`].

use std::any::Any;
use std::sync::Arc;

use souple_engine::tangent::add_block;
use souple_engine::{Configuration, Declaration, Energy, Force, Motion, Pair, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

/// A held point.
#[derive(Clone, Debug)]
pub struct HeldPoint {
    pub row: u32,
    /// [N/m]
    pub stiffness: f64,
    /// Where it starts [m].
    pub start: Vec3,
    /// 1 along held axes, 0 along free ones.
    pub axes: Vec3,
    /// How it is led; `None`: it stays.
    pub motion: Option<Arc<dyn Motion>>,
}

/// `f = -k S (x - x_led(t))` with the projector `S` onto the held axes.
#[derive(Clone, Debug)]
pub struct Hold {
    name: String,
    points: Vec<HeldPoint>,
}

/// A layer that gives way holds like this part of the body's own size across.
const LAYER: f64 = 1e-3;

/// Stiffness per area of a layer of thickness `size/1000` [N/m³]: where the body strains by `ε`, the layer gives way by
/// `ε size/1000`.
pub fn layer_stiffness(modulus: f64, size: f64) -> f64 {
    modulus / (LAYER * size)
}

impl Hold {
    pub fn new(name: impl Into<String>, points: Vec<HeldPoint>) -> Self {
        Self { name: name.into(), points }
    }

    pub fn points(&self) -> &[HeldPoint] {
        &self.points
    }

    /// What holds a point, on the point [N].
    pub fn pull(point: &HeldPoint, at: &Configuration) -> Vec3 {
        Self::apart(point, at) * -point.stiffness
    }

    /// `S (x - x_led)`
    fn apart(point: &HeldPoint, at: &Configuration) -> Vec3 {
        let target =
            point.motion.as_ref().map_or(Vec3::ZERO, |motion| motion.offset(point.start, at.time) * at.load);
        Self::projector(point) * (at.positions[point.row as usize] - point.start - target)
    }

    fn projector(point: &HeldPoint) -> Mat3 {
        Mat3::from_diagonal(point.axes)
    }
}

impl Force for Hold {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration::LOAD
    }

    // E = Σ k/2 |S (x - x_led)|²
    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let of = |point: &HeldPoint| 0.5 * point.stiffness * Self::apart(point, at).length_sq();
        Energy { stored: self.points.iter().map(of).sum(), dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        for point in &self.points {
            out[point.row as usize] += Self::pull(point, at);
        }
    }

    fn add_differential(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        for point in &self.points {
            let row = point.row as usize;
            out[row] -= Self::projector(point) * (delta[row] * (point.stiffness * weights.position));
        }
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.points.iter().for_each(|point| visit(&[point.row]));
    }

    fn reads_cliques_alone(&self) -> bool {
        true
    }

    fn add_blocks(
        &self,
        _: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for point in &self.points {
            let row = point.row as usize;
            let block = Self::projector(point) * -(point.stiffness * weights.position);
            add_block(matrix, row, row, &block);
        }
    }

    fn bytes(&self) -> usize {
        size_of_val(self.points.as_slice())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
