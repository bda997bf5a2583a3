//! The surface of a grid that nothing else is known of, and its mean curvature.

use rayon::prelude::*;
use souple_math::Vec3;
use souple_mesh::{SignedDistance, TriangleSurface};

use crate::crossings::Crossings;
use crate::grid::{BAND, Grid, Halo, Lattice, Neighbours, wide};
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
    let mut neighbours = Neighbours::default();
    neighbours.find(grid);
    let mut halo = Halo::filled(0.0);
    let (mut sum, mut weight) = (0.0, 0.0);
    for block in 0..grid.keys.len() {
        if grid.block(block).iter().all(|f| f64::from(f.abs()) >= SMEARED) {
            continue;
        }
        halo.read(&grid.around(&neighbours, block), f64::from);
        let near =
            grid.block(block).iter().map(|f| f64::from(*f)).enumerate().filter(|(_, f)| f.abs() < SMEARED);
        for (node, f) in near {
            let at = wide(node % 8 + 1, node / 8 % 8 + 1, node / 64 + 1);
            let (curvature, slope) = curvature_at(&halo.0, at);
            // a hat on both sides of the surface in place of Dirac's function
            let share = (1.0 - f.abs() / SMEARED) * slope;
            sum += share * curvature;
            weight += share;
        }
    }
    if weight > 0.0 { sum / weight / lattice.voxel } else { 0.0 }
}

/// Nodes nearer than this take part in means over the surface [voxels].
const SMEARED: f64 = 1.0;
