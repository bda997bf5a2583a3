//! The surface of a grid that nothing else is known of, and its mean curvature.

use rayon::prelude::*;
use souple_math::Vec3;
use souple_mesh::{SignedDistance, TriangleSurface};

use crate::crossings::Crossings;
use crate::grid::{BAND, EDGE, Grid, Halo, Lattice, Neighbours, block_of, wide};
use crate::level_set::curvature_at;
use crate::marks::Marks;
use crate::polygons::{Polygons, normals, polygonise};

/// The surface of a grid.
pub fn surface_of(grid: Grid, lattice: &Lattice) -> (Polygons, Vec<Vec3>) {
    let (mut neighbours, mut marks, mut crossings) =
        (Neighbours::default(), Vec::new(), Crossings::default());
    neighbours.find(grid);
    Marks::find(grid, &mut marks);
    crossings.find(grid, &neighbours, &marks, lattice);
    let (mut triangles, mut directions) = (Vec::new(), Vec::new());
    polygonise(&neighbours, &marks, &crossings, &mut triangles);
    normals(grid, &neighbours, &crossings, lattice, &mut directions);
    (Polygons { points: crossings.points, triangles }, directions)
}

/// The greatest distance of points from the surface of a grid [m]; `None` where one of them is beyond its band.
pub(crate) fn farthest_within(points: &[Vec3], grid: Grid, lattice: &Lattice) -> Option<f64> {
    let distance = |point: &Vec3| {
        let (value, _) = grid.sample(lattice.to_voxels(*point));
        (value.abs() < BAND).then_some(value.abs() * lattice.voxel)
    };
    points.par_iter().map(distance).try_reduce(|| 0.0, |a, b| Some(f64::max(a, b)))
}

impl Polygons {
    pub(crate) fn into_surface(self) -> TriangleSurface {
        let Self { points, triangles } = self;
        TriangleSurface { points, triangles, ..TriangleSurface::default() }
    }

    /// The greatest distance of its points from another surface [m]; `None` where one of them has no points.
    pub fn farthest_from(&self, other: &Self) -> Option<f64> {
        let other = SignedDistance::new(other.clone().into_surface()).ok()?;
        self.points.par_iter().map(|point| other.distance(*point).abs()).reduce_with(f64::max)
    }
}

/// `κ = div n`, twice the mean curvature, averaged over the surface [1/m].
pub fn mean_curvature(grid: Grid, lattice: &Lattice) -> f64 {
    let (mut sum, mut weight) = (0.0, 0.0);
    visit_curvatures(grid, |_, curvature, share| {
        sum += share * curvature;
        weight += share;
    });
    if weight > 0.0 { sum / weight / lattice.voxel } else { 0.0 }
}

/// Calls `visit(place, κ, share of the area)` for the nodes beside the surface, all in voxels.
fn visit_curvatures(grid: Grid, mut visit: impl FnMut(Vec3, f64, f64)) {
    let mut neighbours = Neighbours::default();
    neighbours.find(grid);
    let mut halo = Halo::filled(0.0);
    for (block, key) in grid.keys.iter().enumerate() {
        if grid.block(block).iter().all(|f| f64::from(f.abs()) >= SMEARED) {
            continue;
        }
        halo.read(&grid.around(&neighbours, block), f64::from);
        let corner = block_of(*key).map(|c| (c * EDGE as i64) as f64);
        let near =
            grid.block(block).iter().map(|f| f64::from(*f)).enumerate().filter(|(_, f)| f.abs() < SMEARED);
        for (node, f) in near {
            let [x, y, z] = [node % EDGE, node / EDGE % EDGE, node / EDGE / EDGE];
            let (curvature, slope) = curvature_at(&halo.0, wide(x + 1, y + 1, z + 1));
            let place = Vec3::new(corner[0] + x as f64, corner[1] + y as f64, corner[2] + z as f64);
            // a hat on both sides of the surface in place of Dirac's function
            visit(place, curvature, (1.0 - f.abs() / SMEARED) * slope);
        }
    }
}

/// Nodes nearer than this take part in means over the surface [voxels].
const SMEARED: f64 = 1.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Skin;

    /// The greatest error of `κ` beside a surface given by its distance, relative to `1/r`, where `exact` knows it.
    fn greatest_error(
        voxel: f64,
        distance: impl Fn(Vec3) -> f64 + Sync,
        exact: impl Fn(Vec3) -> Option<f64>,
    ) -> f64 {
        let lattice = Lattice { origin: Vec3::new(0.37, 0.21, 0.43) * voxel, voxel };
        let skin = Skin {
            name: "skin".to_owned(),
            lattice,
            target: None,
            terms: Vec::new(),
            redistance: 0.0,
            reaction: None,
        };
        let corner = Vec3::new(1.6, 1.6, 1.6);
        let field = skin.start(-corner, corner, &|p| -distance(p), &mut skin.new_scratch()).unwrap();
        let mut greatest = 0.0_f64;
        visit_curvatures(skin.view(&field).grid, |place, curvature, _| {
            if let Some(exact) = exact(lattice.to_world(place)) {
                greatest = greatest.max((curvature / voxel - exact).abs() * TUBE);
            }
        });
        greatest
    }

    const TUBE: f64 = 0.4;

    /// Point by point to second order: on a cylinder away from its round ends, and on a torus, whose curvature changes along it.
    #[test]
    fn curvature_is_of_second_order_point_by_point() {
        let cylinder = |p: Vec3| Vec3::new((p.x.abs() - 1.0).max(0.0), p.y, p.z).length() - TUBE;
        let along = |p: Vec3| (p.x.abs() < 0.5).then_some(1.0 / TUBE);
        let across = |p: Vec3| p.x.hypot(p.y);
        let torus = |p: Vec3| (across(p) - 1.0).hypot(p.z) - TUBE;
        // κ = 1/r + cos θ/(R + r cos θ) at the nearest point of the surface
        let around = |p: Vec3| {
            let cosine = (across(p) - 1.0) / (across(p) - 1.0).hypot(p.z);
            Some(1.0 / TUBE + cosine / (1.0 + TUBE * cosine))
        };
        let voxels = [1.0 / 10.0, 1.0 / 20.0, 1.0 / 40.0];
        for errors in [
            voxels.map(|voxel| greatest_error(voxel, cylinder, along)),
            voxels.map(|voxel| greatest_error(voxel, torus, around)),
        ] {
            let order = 0.5 * (errors[0] / errors[2]).log2();
            assert!(order > 1.7, "order {order} of {errors:?}");
        }
    }
}
