//! Surfaces of random and of smooth grids are closed manifolds.

use super::*;
use crate::grid::{BAND, key_of};

/// A grid of `n³` blocks whose nodes have the values of a function of their coordinates, outside at the border.
fn grid_of(n: i64, f: impl Fn([i64; 3]) -> f64) -> (Vec<u64>, Vec<f32>) {
    let mut keys: Vec<u64> = (0..n * n * n).map(|i| key_of([i % n, i / n % n, i / (n * n)])).collect();
    keys.sort_unstable();
    let last = n * EDGE as i64 - 1;
    let values = keys.iter().flat_map(|key| {
        let [bx, by, bz] = block_of(*key).map(|c| c * EDGE as i64);
        let f = &f;
        (0..NODES as i64).map(move |i| {
            let node = [bx + i % 8, by + i / 8 % 8, bz + i / 64];
            if node.iter().any(|c| *c == 0 || *c == last) { -BAND } else { f(node).clamp(-BAND, BAND) }
        })
    });
    let values = values.map(|value| value as f32).collect();
    (keys, values)
}

fn surface(keys: &[u64], values: &[f32]) -> Polygons {
    let grid = Grid { keys, values };
    let mut neighbours = Neighbours::default();
    neighbours.find(grid);
    let (mut marks, mut crossings) = (Vec::new(), Crossings::default());
    Marks::find(grid, &mut marks);
    crossings.find(grid, &neighbours, &marks, &Lattice { origin: Vec3::ZERO, voxel: 1.0 });
    let mut triangles = Vec::new();
    polygonise(&neighbours, &marks, &crossings, &mut triangles);
    Polygons { points: crossings.points, triangles }
}

/// However the signs stand, ambiguous faces and cells among them, the surface is closed, oriented and a manifold.
#[test]
fn surfaces_of_noise_are_manifold() {
    let mut audit = Audit::default();
    for seed in 0..40_u64 {
        let noise = |[x, y, z]: [i64; 3]| {
            let mut h = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (x + 64 * y + 4096 * z) as u64;
            h = (h ^ h >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            h = (h ^ h >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
            // few and many nodes inside
            ((h ^ h >> 31) % 1000) as f64 / 1000.0 - 0.1 - 0.02 * seed as f64
        };
        let (keys, values) = grid_of(3, noise);
        let surface = surface(&keys, &values);
        assert!(surface.triangles.len() > 1000);
        audit.check(surface.points.len(), &surface.triangles).unwrap();
        // the very surface that the mesh room holds to be closed
        let mesh = souple_mesh::TriangleSurface::new(surface.points, surface.triangles).unwrap();
        mesh.check_closed().unwrap();
    }
}

/// Area and volume of a ball to second order, one component, Euler characteristic 2; a torus has 0, two balls 4.
#[test]
fn balls_and_tori_are_measured() {
    let mut audit = Audit::default();
    let centre = Vec3::new(19.7, 20.1, 19.9);
    let ball = |radius: f64| {
        move |[x, y, z]: [i64; 3]| radius - (Vec3::new(x as f64, y as f64, z as f64) - centre).length()
    };
    let mut errors = Vec::new();
    for radius in [7.0, 14.0] {
        let (keys, values) = grid_of(5, ball(radius));
        let surface = surface(&keys, &values);
        let (area, volume) = area_and_volume(&surface.points, &surface.triangles);
        assert_eq!(audit.check(surface.points.len(), &surface.triangles).unwrap(), (2, 1));
        let pi = std::f64::consts::PI;
        errors.push((
            area / (4.0 * pi * radius * radius) - 1.0,
            volume / (4.0 / 3.0 * pi * radius.powi(3)) - 1.0,
        ));
    }
    // chords fall short by a few (h/R)²/10; half the voxels, a quarter of the error
    assert!(errors[0].0 < 0.0 && errors[0].0 > -0.5 / 49.0, "{errors:?}");
    assert!(
        (errors[1].0 / errors[0].0 - 0.25).abs() < 0.05 && (errors[1].1 / errors[0].1 - 0.25).abs() < 0.05
    );
    let torus = |[x, y, z]: [i64; 3]| {
        let p = Vec3::new(x as f64, y as f64, z as f64) - centre;
        4.0 - ((p.x.hypot(p.y) - 10.0).powi(2) + p.z * p.z).sqrt()
    };
    let (keys, values) = grid_of(5, torus);
    let ring = surface(&keys, &values);
    assert_eq!(audit.check(ring.points.len(), &ring.triangles).unwrap(), (0, 1));
    let two = |[x, y, z]: [i64; 3]| {
        let p = Vec3::new(x as f64, y as f64, z as f64) - centre;
        (6.0 - (p - Vec3::X * 8.0).length()).max(6.0 - (p + Vec3::X * 8.0).length())
    };
    let (keys, values) = grid_of(5, two);
    let pair = surface(&keys, &values);
    assert_eq!(audit.check(pair.points.len(), &pair.triangles).unwrap(), (4, 2));
}

/// A triangle missing, or turned, is found.
#[test]
fn what_is_torn_is_found() {
    let mut audit = Audit::default();
    let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    assert_eq!(audit.check(4, &tetrahedron).unwrap(), (2, 1));
    assert!(audit.check(4, &tetrahedron[..3]).is_err());
    let mut turned = tetrahedron;
    turned[3] = [0, 2, 3];
    assert!(audit.check(4, &turned).is_err());
    // two tetrahedra that share a point
    let two: Vec<[u32; 3]> = tetrahedron.into_iter().chain(tetrahedron.map(|t| t.map(|p| p + 3))).collect();
    assert_eq!(audit.check(7, &two), Err(Torn::Pinched { point: 3 }));
}
