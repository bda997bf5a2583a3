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
    /// Along which of the axes it is held.
    pub axes: [bool; 3],
    /// How it is led; `None`: it stays.
    pub motion: Option<Arc<dyn Motion>>,
}

/// `f = -k S (x - x_led(t))` with the projector `S` onto the held axes.
#[derive(Clone, Debug)]
pub struct Hold {
    name: String,
    points: Vec<HeldPoint>,
}

/// Thickness of the layer that holds a body, as a part of the depth of the body behind it.
const LAYER: f64 = 2e-4;

/// Stiffness per area of a layer that is a five-thousandth as thick as the body behind it is deep [N/m³].
///
/// A bar of length `d` that hangs on the layer is longer by one part in 5,000. Under a moment `M` the end of a clamped one sags by
/// `M d²/(2 EI)`, and by `M d²/(5000 EI)` more since its root turns: two parts in 5,000, under its weight four. Neither depends on how thin
/// it is. A layer in proportion to the least size would hold a thin body so much more stiffly than it resists bending that a turn of its
/// end, which moves held points by its square, would dwarf all other forces; one much thicker would be seen in tables of convergence.
pub fn layer_stiffness(modulus: f64, depth: f64) -> f64 {
    modulus / (LAYER * depth)
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
        let [x, y, z] = point.axes.map(|is_held| if is_held { 1.0 } else { 0.0 });
        Mat3::from_diagonal(Vec3::new(x, y, z))
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
