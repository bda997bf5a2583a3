//! Collision with a skin by one look-up of its potential, whatever its shape; a point deeper than the band of values around it
//! looks for the way out.

use souple_math::{Mat3, Vec3};

use crate::grid::{BAND, Grid, Lattice};

/// What a point sees of a skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// To the surface, negative inside [m]; where the values around the skin are distances.
    pub distance: f64,
    /// Unit, outward.
    pub normal: Vec3,
    /// `∂normal/∂x` across the normal [1/m].
    pub curvature: Mat3,
}

/// Between the nodes around a point, without kinks, over which what rests on the skin would come to no rest; `None` outside of the band
/// of voxels around the skin, where no value changes.
pub fn look_up(grid: Grid, lattice: &Lattice, point: Vec3) -> Option<Seen> {
    let place = lattice.to_voxels(point);
    let (value, _) = grid.sample(place);
    if value >= BAND {
        let (depth, normal) = way_out(grid, place)?;
        return Some(Seen { distance: -depth * lattice.voxel, normal, curvature: Mat3::ZERO });
    }
    if value <= -BAND {
        return None;
    }
    let (value, gradient, bend) = grid.smooth(place)?;
    let normal = (-gradient).try_normalised()?;
    // n = −∇f/|∇f|:  ∂n/∂x = −(I − n nᵀ) ∇∇f/|∇f|
    let across = Mat3::IDENTITY - normal.outer(normal);
    let curvature = across * bend * across * (-1.0 / (gradient.length() * lattice.voxel));
    Some(Seen { distance: -value * lattice.voxel, normal, curvature })
}

/// Steps of a way along an axis, at most: through 131,072 voxels. Longer ways are left to the other five.
const FARTHEST_STEPS: i32 = 1 << 16;

/// Depth [voxels] and outward normal where the nearest of the six ways along the axes comes to the band.
fn way_out(grid: Grid, place: Vec3) -> Option<(f64, Vec3)> {
    let along = |axis: Vec3| {
        let mut way = 0.0;
        for _ in 0..FARTHEST_STEPS {
            let (value, gradient) = grid.sample(place + axis * way);
            if value < 0.5 * BAND {
                // a plane's depth along its normal, whatever the axis
                let normal = (-gradient).try_normalised()?;
                return Some((value + way * axis.dot(normal), normal));
            }
            // slopes are of the surface in the inner half of the band
            way += if value >= BAND { 0.5 * BAND } else { 0.25 * BAND };
        }
        None
    };
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let ways = axes.into_iter().flat_map(|axis| [axis, -axis]).filter_map(along);
    ways.min_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Skin;

    /// Distance, normal and curvature of a ball to the order of its voxels; beyond the band there is no answer.
    #[test]
    fn a_ball_is_seen() {
        let (radius, voxel) = (1.0, 1.0 / 16.0);
        let skin = Skin {
            name: "ball".to_owned(),
            lattice: Lattice { origin: Vec3::new(0.01, 0.02, 0.03), voxel },
            target: None,
            terms: Vec::new(),
            redistance: 0.25,
            reaction: None,
        };
        let corner = Vec3::new(1.1, 1.1, 1.1);
        let field = skin.start(-corner, corner, &|p| radius - p.length(), &mut skin.new_scratch()).unwrap();
        let grid = skin.view(&field).grid;
        for direction in [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.5, -0.7, 0.3), Vec3::new(-0.2, 0.4, 0.9)] {
            let n = direction.try_normalised().unwrap();
            for depth in [-1.5, 0.0, 1.5] {
                let seen = look_up(grid, &skin.lattice, n * (radius - depth * voxel)).unwrap();
                // a spline is h²/4R deeper, of a level at R
                assert!((seen.distance + depth * voxel).abs() < voxel * voxel, "{seen:?} at {depth}");
                // its slope to first order, which turns by a voxel over the radius in a cell
                assert!((seen.normal - n).length() < 2.0 * voxel, "{seen:?} at {depth}");
            }
        }
        // deep inside along an axis, and at the middle, where all ways are as long
        for x in [0.0, 0.3, -0.5] {
            let seen = look_up(grid, &skin.lattice, Vec3::X * x).unwrap();
            // what it sees at the end of its way lies within the band, aside by less than a voxel
            assert!((seen.distance + radius - x.abs()).abs() < voxel, "{seen:?} at {x}");
            assert!(x == 0.0 || seen.normal.x * x > 0.9 * x.abs(), "{seen:?} at {x}");
        }
        assert_eq!(look_up(grid, &skin.lattice, Vec3::new(2.0, 0.0, 0.0)), None);
        assert_eq!(look_up(grid, &skin.lattice, Vec3::new(f64::NAN, 0.0, 0.0)), None);
    }

    /// Where cells meet, normals are as on both sides.
    #[test]
    fn normals_have_no_kinks() {
        let keys = [crate::grid::key_of([0, 0, 0])];
        let values: Vec<f32> = (0..crate::grid::NODES)
            .map(|node| {
                ((node % 8) as f32 - 3.5).hypot((node / 8 % 8) as f32 - 3.2).hypot((node / 64) as f32 - 3.1)
            })
            .map(|distance| 2.5 - distance)
            .collect();
        let grid = Grid { keys: &keys, values: &values };
        let lattice = Lattice { origin: Vec3::ZERO, voxel: 1.0 };
        let step = 1e-9;
        for at in [
            Vec3::new(5.0, 4.0, 4.0),
            Vec3::new(5.5, 4.5, 3.5),
            Vec3::new(3.5, 3.0, 5.5),
            Vec3::new(2.0, 2.0, 2.5),
        ] {
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let [before, after] =
                    [-step, step].map(|step| look_up(grid, &lattice, at + axis * step).unwrap());
                assert!((after.normal - before.normal).length() < 4.0 * step, "{before:?} {after:?}");
                assert!((after.distance - before.distance).abs() < 4.0 * step, "{before:?} {after:?}");
            }
        }
    }

    /// Within a cell normals turn, for steps across them, by the curvature that is told.
    #[test]
    fn normals_turn_by_their_curvature() {
        let keys = [crate::grid::key_of([0, 0, 0])];
        let values: Vec<f32> = (0..crate::grid::NODES)
            .map(|node| {
                let (x, y, z) = ((node % 8) as f64, (node / 8 % 8) as f64, (node / 64) as f64);
                (2.0 - 0.3 * x - 0.2 * y - 0.1 * z + 0.05 * x * y - 0.03 * y * z) as f32
            })
            .collect();
        let grid = Grid { keys: &keys, values: &values };
        let lattice = Lattice { origin: Vec3::ZERO, voxel: 0.5 };
        let at = Vec3::new(1.7, 1.8, 1.9);
        let seen = look_up(grid, &lattice, at).unwrap();
        let step = 1e-5;
        let u = seen.normal.any_orthogonal();
        let side = |sign: f64| look_up(grid, &lattice, at + u * (sign * step)).unwrap().normal;
        let turn = (side(1.0) - side(-1.0)) * (0.5 / step);
        // second differences of a step of 1e-5 on numbers of order one
        assert!((turn - seen.curvature * u).length() < 1e-8, "{turn:?} {:?}", seen.curvature * u);
    }
}
