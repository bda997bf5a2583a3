//! Weights by distance within the shape: Shepard's over the way that matter leaves open, shorter through what is stiff.
//!
//! Where a frame is seen in a straight line the distance is that of space, and weights are those of `wendland`, as smooth as they
//! are. Round a corner and past the end of a slit the way bends at points of the mesh; so it does at borders between materials, within
//! which a length counts by `softest / stiffness`: stiff matter is small, and moves as one.

use souple_math::Vec3;
use souple_table::Values;

use super::cells::{Cells, NOT_CARRIED, softest};
use super::ways::{Extent, Ground, Source};
use super::weights::{Kernel, SUPPORT, Shape, Share, Weights, too_far};
use super::{Frame, FrameError};

/// What a frame is to a point of the mesh.
#[derive(Clone, Copy, Debug)]
struct Way {
    frame: u32,
    distance: f64,
    source: Source,
}

struct Geodesic<'a> {
    cells: Cells<'a>,
    ground: Ground<'a>,
    /// Of each point of the mesh, by ascending frame.
    ways: Vec<Vec<Way>>,
    /// The cell that carries each frame.
    carriers: Vec<u32>,
    /// How far each frame reaches, as ways count [m].
    supports: Vec<f64>,
    /// In distances to the nearest neighbour.
    support: f64,
}

pub fn build<'a>(values: &Values, shape: &Shape<'a>) -> Result<Box<dyn Weights + 'a>, FrameError> {
    let mesh = shape.mesh;
    let softest = softest(shape.stiffness_of_cell.iter().copied().enumerate())?;
    let costs = shape.stiffness_of_cell.iter().map(|stiffness| softest / stiffness).collect();
    let (cells, ground) = (Cells::new(mesh), Ground::new(mesh, costs));
    let carriers = cells.carriers(shape.frames)?;
    let support = values.number("support");
    let (mut ways, mut supports) = (vec![Vec::new(); mesh.points.len()], Vec::new());
    for (index, frame) in shape.frames.iter().enumerate() {
        let stands = carriers.iter().copied().zip(shape.frames.iter().map(|frame| frame.origin));
        let others: Vec<(u32, Vec3)> =
            stands.enumerate().filter(|(other, _)| *other != index).map(|(_, stand)| stand).collect();
        let extent = Extent::Support { others: &others, support };
        let found = ground.ways_from(frame.origin, carriers[index], &extent);
        let nearest = others.iter().filter_map(|(cell, place)| ground.distance(&found, *cell, *place));
        let size = found.iter().flatten().map(|way| way.0).fold(0.0, f64::max);
        let spacing = nearest.reduce(f64::min).unwrap_or(size);
        supports.push(support * spacing);
        for (ways, way) in ways.iter_mut().zip(found) {
            ways.extend(way.map(|(distance, source)| Way { frame: index as u32, distance, source }));
        }
    }
    Ok(Box::new(Geodesic { cells, ground, ways, carriers, supports, support }))
}

impl Weights for Geodesic<'_> {
    fn shares(&self, point: Vec3) -> Vec<Share> {
        let Some(spot) = self.cells.spot(point) else { return Vec::new() };
        let cost = self.ground.cost(spot.cell);
        let (mut shares, mut sum, mut sum_gradient) = (Vec::new(), 0.0, Vec3::ZERO);
        'frames: for first in &self.ways[spot.nodes[0] as usize] {
            // Σ N_n d_n(P), with the distance that point n sees
            let (mut distance, mut gradient) = (0.0, Vec3::ZERO);
            for ((node, value), slope) in spot.nodes.iter().zip(spot.values.iter()).zip(&spot.gradients) {
                let ways = &self.ways[*node as usize];
                let Ok(place) = ways.binary_search_by_key(&first.frame, |way| way.frame) else {
                    continue 'frames;
                };
                let Way { source, distance: at_node, .. } = &ways[place];
                let arm = point - source.place;
                let (seen, rate) = if source.cost == cost {
                    let length = arm.length();
                    let along = if length > 0.0 { arm * (cost / length) } else { Vec3::ZERO };
                    (source.offset + cost * length, along)
                } else {
                    (*at_node, Vec3::ZERO)
                };
                distance += value * seen;
                gradient += *slope * seen + rate * *value;
            }
            let support = self.supports[first.frame as usize];
            let u = distance.max(0.0) / support;
            let Some((value, slope_over_u)) = Kernel::Wendland.at(u) else { continue };
            let gradient = gradient * (slope_over_u * u / support);
            shares.push(Share { frame: first.frame, weight: value, gradient });
            sum += value;
            sum_gradient += gradient;
        }
        if sum <= 0.0 {
            return Vec::new();
        }
        for share in &mut shares {
            share.weight /= sum;
            share.gradient = (share.gradient - sum_gradient * share.weight) / sum;
        }
        shares
    }

    fn out_of_reach(&self, point: Vec3, frames: &[Frame]) -> String {
        let Some(spot) = self.cells.spot(point) else { return NOT_CARRIED.to_owned() };
        let found = self.ground.ways_from(point, spot.cell, &Extent::Way(f64::INFINITY));
        let way = |(index, frame): (usize, &Frame)| {
            Some((index, self.ground.distance(&found, self.carriers[index], frame.origin)?))
        };
        let nearest = frames.iter().enumerate().filter_map(way).min_by(|a, b| a.1.total_cmp(&b.1));
        let (frame, distance) =
            nearest.unwrap_or_else(|| unreachable!("every part of the mesh holds a frame"));
        let words = too_far(frame, distance, self.supports[frame], self.support);
        format!("by ways within the shape, shorter through what is stiff, {words}")
    }
}

/// The parameter of these weights.
pub const PARAMETERS: &[souple_table::Parameter] = &[SUPPORT];
