//! Weights that know the shape and its stiffness: `div(c ∇w_i) = 0` on the cells of the shape, one at frame `i` and
//! zero at all others, with the stiffness as the conductivity `c`.
//!
//! Nothing flows across the boundary of the shape, so the two sides of a slit know nothing of each other but around its
//! end; where matter is stiff the weights are nearly constant, and it moves as one. The grid is the mesh of the body
//! itself: thin parts have cells as everything has, and there is nothing that a grid could miss. Between nodes weights
//! follow the shape functions, and so do their gradients.

use souple_math::{Mat3, Vec3};
use souple_mesh::MAX_NODES;
use souple_solve::precondition::Geometry;
use souple_solve::{BlockMatrix, Pattern, solvers};
use souple_table::{Parameter, Range, Value, Values};

use super::cells::{Cells, NOT_CARRIED, softest};
use super::ways::{Extent, Ground};
use super::weights::{Shape, Share, Weights, spacings};
use super::{Frame, FrameError};

pub const CORE: Parameter = Parameter::number(
    "core",
    "",
    Range::closed(0.0, 0.49),
    "points this close to a frame are all its own, in distances to its nearest neighbour",
)
.or(Value::Number(0.2));

pub const LEAST: Parameter = Parameter::number(
    "least",
    "",
    Range::closed(0.0, 0.2),
    "weight below which a frame has no part: taken off all weights, so that they end without a step",
)
.or(Value::Number(0.02));

/// Weights at the nodes of a mesh.
struct Harmonic<'a> {
    cells: Cells<'a>,
    /// Of each point of the mesh, by ascending frame.
    nodal: Vec<Vec<(u32, f64)>>,
}

pub fn build<'a>(values: &Values, shape: &Shape<'a>) -> Result<Box<dyn Weights + 'a>, FrameError> {
    let cells = Cells::new(shape.mesh);
    let owners = owners(shape, &cells.carriers(shape.frames)?, values.number("core"))?;
    let mut matrix = conductivity(shape)?;
    let points = shape.mesh.points.len();
    // what flows from the nodes of frames, before these are taken out
    let flows = matrix.clone();
    let held = |point: &usize| owners[*point].is_some();
    let scale = matrix.mean_diagonal();
    matrix
        .constrain_blocks((0..points).filter(held).map(|point| (point, Mat3::ZERO)), scale)
        .map_err(|error| FrameError::Unsolved(error.to_string()))?;
    let mut solver = solver(&matrix, &shape.mesh.points).map_err(FrameError::Unsolved)?;
    let mut nodal = vec![Vec::new(); points];
    let (mut known, mut flow, mut found) =
        (vec![Vec3::ZERO; points], vec![Vec3::ZERO; points], vec![Vec3::ZERO; points]);
    // three frames at a time: the components of a vector
    for first in (0..shape.frames.len()).step_by(3) {
        for (point, value) in known.iter_mut().enumerate() {
            let is_of = |component: usize| owners[point] == Some((first + component) as u32);
            *value = Vec3::from_array([0, 1, 2].map(|component| if is_of(component) { 1.0 } else { 0.0 }));
        }
        souple_solve::LinearOperator::apply(&flows, &known, &mut flow);
        for (point, flow) in flow.iter_mut().enumerate() {
            *flow = if owners[point].is_some() { Vec3::ZERO } else { -*flow };
        }
        found.fill(Vec3::ZERO);
        solver.solve(&matrix, &flow, &mut found).map_err(|error| FrameError::Unsolved(error.to_string()))?;
        for (point, weights) in nodal.iter_mut().enumerate() {
            let value = found[point] + known[point];
            let of_frames = (first..shape.frames.len().min(first + 3)).enumerate();
            weights.extend(of_frames.map(|(component, frame)| (frame as u32, value[component])));
        }
    }
    let least = values.number("least");
    nodal.iter_mut().for_each(|weights| cut(weights, least));
    Ok(Box::new(Harmonic { cells, nodal }))
}

/// Takes `least` off all weights, the greatest apart, drops what is nothing then, and makes the sum one.
fn cut(weights: &mut Vec<(u32, f64)>, least: f64) {
    let greatest = weights.iter().map(|(_, weight)| *weight).fold(0.0, f64::max);
    let least = least.min(0.5 * greatest);
    weights.iter_mut().for_each(|(_, weight)| *weight -= least);
    weights.retain(|(_, weight)| *weight > 0.0);
    let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
    weights.iter_mut().for_each(|(_, weight)| *weight /= sum);
}

/// The frame that each point of the mesh belongs to, where it belongs to one: those in its core, and the nearest. Both by ways
/// within the shape from the cell that carries the frame, so that nothing is owned across a slit.
fn owners(shape: &Shape, carriers: &[u32], core: f64) -> Result<Vec<Option<u32>>, FrameError> {
    let mut owners: Vec<Option<u32>> = vec![None; shape.mesh.points.len()];
    let ground = Ground::new(shape.mesh, vec![1.0; shape.mesh.cell_count()]);
    let spacings = spacings(shape);
    for (index, frame) in shape.frames.iter().enumerate() {
        // one frame alone has no neighbour to give a distance
        let radius = if shape.frames.len() == 1 { 0.0 } else { core * spacings[index] };
        let found = ground.ways_from(frame.origin, carriers[index], &Extent::Way(radius));
        let ways = || found.iter().enumerate().filter_map(|(point, way)| Some((point, way.as_ref()?.0)));
        let nearest = ways().min_by(|a, b| a.1.total_cmp(&b.1)).map(|way| way.0);
        let is_own = |way: &(usize, f64)| way.1 <= radius || Some(way.0) == nearest;
        for (point, _) in ways().filter(is_own) {
            if let Some(other) = owners[point].replace(index as u32) {
                return Err(FrameError::OneNode {
                    frames: [other, index as u32],
                    at: shape.mesh.points[point],
                });
            }
        }
    }
    Ok(owners)
}

/// `∫ c ∇N_a · ∇N_b dV`, three times side by side; stiffness relative to the softest.
fn conductivity(shape: &Shape) -> Result<BlockMatrix, FrameError> {
    let mesh = shape.mesh;
    let softest = softest(shape.stiffness_of_cell.iter().copied().enumerate())?;
    let cells: Vec<&[u32]> = mesh.cells().map(|cell| cell.nodes).collect();
    let unsolved = |error: souple_solve::SolveError| FrameError::Unsolved(error.to_string());
    let pattern = Pattern::from_cliques(mesh.points.len(), cells).map_err(unsolved)?;
    let mut matrix = BlockMatrix::zeros(std::sync::Arc::new(pattern));
    let mut buffer = [Vec3::ZERO; MAX_NODES];
    for (index, cell) in mesh.cells().enumerate() {
        let conductivity = shape.stiffness_of_cell[index] / softest;
        let corners = mesh.positions_into(cell.nodes, &mut buffer);
        for point in &cell.kind.default_rule().points {
            let jacobian = cell.kind.jacobian(corners, point.position);
            let is_flat =
                || FrameError::FlatCell { cell: index, at: cell.kind.position(corners, point.position) };
            let inverse = jacobian.try_inverse().ok_or_else(is_flat)?;
            let volume = jacobian.determinant() * point.weight * conductivity;
            let gradients = cell.kind.shape_gradients(point.position);
            let gradients: Vec<Vec3> = gradients.iter().map(|g| inverse.transpose_apply(*g)).collect();
            for (a, g_a) in cell.nodes.iter().zip(&gradients) {
                for (b, g_b) in cell.nodes.iter().zip(&gradients) {
                    let block = Mat3::IDENTITY * (volume * g_a.dot(*g_b));
                    matrix.add(*a as usize, *b as usize, &block).map_err(unsolved)?;
                }
            }
        }
    }
    Ok(matrix)
}

fn solver(matrix: &BlockMatrix, points: &[Vec3]) -> Result<Box<dyn solvers::LinearSolver>, String> {
    let entry = solvers::TABLE.find("cg").map_err(|error| error.to_string())?;
    let wanted = Values::new()
        .with("tolerance", Value::Number(1e-10))
        .with("preconditioner", Value::Text("incomplete_cholesky"));
    let values = entry.values(wanted).map_err(|error| error.to_string())?;
    (entry.build.build)(&values, matrix, Geometry::points(points)).map_err(|error| error.to_string())
}

impl Weights for Harmonic<'_> {
    fn shares(&self, point: Vec3) -> Vec<Share> {
        let Some(spot) = self.cells.spot(point) else { return Vec::new() };
        let mut shares: Vec<Share> = Vec::new();
        for ((node, value), gradient) in spot.nodes.iter().zip(spot.values.iter()).zip(&spot.gradients) {
            for &(frame, weight) in &self.nodal[*node as usize] {
                let at = shares.binary_search_by_key(&frame, |share| share.frame).unwrap_or_else(|at| {
                    shares.insert(at, Share { frame, weight: 0.0, gradient: Vec3::ZERO });
                    at
                });
                shares[at].weight += value * weight;
                shares[at].gradient += *gradient * weight;
            }
        }
        shares
    }

    // every part of the mesh holds a frame, and each of its points has a weight
    fn out_of_reach(&self, _: Vec3, _: &[Frame]) -> String {
        NOT_CARRIED.to_owned()
    }
}
