//! The background of a filling: a body-centred cubic lattice, coarser inside where that is allowed.
//!
//! A grid of cubes with a point at each corner and one at each centre. A tetrahedron stands on every edge of a
//! face between two cubes and has their centres as its other corners. Coordinates are whole numbers, two units to
//! the edge of a smallest cube: corners are even, centres odd. Edges of the lattice are *long* (along an axis,
//! two units) or *short* (a corner to a centre, √3 units); the long edges of a tetrahedron are opposite.
//!
//! Cubes that the surface does not come near may be joined into cubes of twice the edge, and again: an octree
//! whose neighbours differ by one level at most, also across edges and corners. Between levels the coarse
//! tetrahedra are halved or quartered, and a pyramid on a small face is cut in two (Labelle & Shewchuk 2007, §4).

use rayon::prelude::*;
use souple_math::Vec3;

use super::{FillError, Grading, Reach, Size};
use crate::implicit::Shape;

/// Coordinates of a lattice point, in halves of the smallest cube's edge.
pub(super) type Place = [u32; 3];

/// Most lattice points that are looked at.
const MAX_POINTS: f64 = 1e8;

/// Deepest octree: cubes of 2⁶ smallest ones.
const MAX_LEVEL: u8 = 6;

/// On which side of the surface a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Inside,
    On,
    Outside,
}

impl Side {
    pub fn of(value: f64) -> Self {
        if value < 0.0 {
            Self::Inside
        } else if value > 0.0 {
            Self::Outside
        } else {
            Self::On
        }
    }
}

/// The lattice points and tetrahedra that matter: those with a corner inside.
#[derive(Clone)]
pub(super) struct Background {
    pub places: Vec<Place>,
    pub points: Vec<Vec3>,
    pub values: Vec<f64>,
    /// Positively oriented.
    pub tets: Vec<[u32; 4]>,
}

/// A cube of the octree: its lowest corner and its edge.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Leaf {
    pub low: Place,
    pub edge: u32,
    pub level: u8,
}

/// Values of a shape on the smallest cubes, and the cubes that are joined.
pub(super) struct Lattice {
    /// Numbers of smallest cubes along the axes.
    pub counts: [usize; 3],
    origin: Vec3,
    /// Half the edge of a smallest cube [m].
    half: f64,
    corners: Vec<f64>,
    centres: Vec<f64>,
    /// Level of the octree's leaf that holds each smallest cube.
    pub levels: Vec<u8>,
}

const FACES: [[i64; 3]; 6] = [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]];

impl Lattice {
    /// Looks at the shape on every lattice point within its bounds, and joins cubes.
    ///
    /// # Errors
    /// The size asks for too many points; the shape's value is not a number, or negative beyond its bounds.
    pub fn new(shape: &dyn Shape, size: &Size) -> Result<Self, FillError> {
        let bounds = shape.bounds();
        let extent = bounds.size();
        if !(size.smallest > 0.0 && size.smallest.is_finite()) {
            return Err(FillError::Size { size: size.smallest });
        }
        if !(extent.is_finite() && extent.largest_component() > 0.0) {
            return Err(FillError::Bounds { low: bounds.low.to_array(), high: bounds.high.to_array() });
        }
        let coarsest = size.coarsest_level(MAX_LEVEL);
        let unit = 1_usize << coarsest;
        let wanted = cubes_along(extent, size);
        let requested = points_of(shape, size);
        if requested > MAX_POINTS {
            let (size, extent) = (size.smallest, extent.to_array());
            return Err(FillError::TooManyPoints { size, extent, requested, limit: MAX_POINTS });
        }
        let counts = wanted.map(|count| (count as usize).next_multiple_of(unit));
        let whole = Vec3::from_array(counts.map(|count| count as f64 * size.smallest));
        let mut lattice = Self {
            counts,
            origin: bounds.centre() - whole * 0.5,
            half: 0.5 * size.smallest,
            corners: Vec::new(),
            centres: Vec::new(),
            levels: vec![0; counts.iter().product()],
        };
        let [nx, ny, nz] = counts;
        lattice.corners = lattice.evaluate(shape, [nx + 1, ny + 1, nz + 1], 0)?;
        lattice.centres = lattice.evaluate(shape, counts, 1)?;
        lattice.check_border()?;
        if coarsest > 0 {
            lattice.join(size, coarsest)?;
        }
        Ok(lattice)
    }

    /// How many leaves have their middle inside.
    pub fn inside_count(&self) -> usize {
        self.leaves().filter(|leaf| self.value(leaf.centre()) < 0.0).count()
    }

    /// The least value on its points.
    pub fn least_value(&self) -> f64 {
        self.corners.iter().chain(&self.centres).copied().fold(f64::INFINITY, f64::min)
    }

    /// Values on the points `2 index + offset`, plane by plane.
    fn evaluate(
        &self,
        shape: &dyn Shape,
        [nx, ny, nz]: [usize; 3],
        offset: u32,
    ) -> Result<Vec<f64>, FillError> {
        let mut values = vec![0.0; nx * ny * nz];
        values.par_chunks_mut(nx * ny).enumerate().try_for_each(|(k, plane)| {
            for (index, value) in plane.iter_mut().enumerate() {
                let place = [index % nx, index / nx, k].map(|i| 2 * i as u32 + offset);
                let position = self.position(place);
                *value = shape.value(position);
                if value.is_nan() {
                    return Err(FillError::NotANumber { position: position.to_array() });
                }
            }
            Ok(())
        })?;
        Ok(values)
    }

    /// The outermost corners must be outside, or the body would be cut off without a word.
    fn check_border(&self) -> Result<(), FillError> {
        let [nx, ny, nz] = self.counts;
        for k in 0..=nz {
            for j in 0..=ny {
                for i in 0..=nx {
                    let is_border = i == 0 || j == 0 || k == 0 || i == nx || j == ny || k == nz;
                    if is_border && self.corners[self.corner([i, j, k])] < 0.0 {
                        let position = self.position([i, j, k].map(|i| 2 * i as u32)).to_array();
                        return Err(FillError::BeyondBounds { position });
                    }
                }
            }
        }
        Ok(())
    }

    pub fn position(&self, place: Place) -> Vec3 {
        let [x, y, z] = place.map(f64::from);
        self.origin + Vec3::new(x, y, z) * self.half
    }

    fn corner(&self, [i, j, k]: [usize; 3]) -> usize {
        i + (self.counts[0] + 1) * (j + (self.counts[1] + 1) * k)
    }

    pub fn cube(&self, [i, j, k]: [usize; 3]) -> usize {
        i + self.counts[0] * (j + self.counts[1] * k)
    }

    pub fn cubes(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [nx, ny, nz] = self.counts;
        (0..nx * ny * nz).map(move |index| [index % nx, index / nx % ny, index / (nx * ny)])
    }

    /// The cube beside another, or none beyond the border.
    pub fn beside(&self, cube: [usize; 3], step: [i64; 3]) -> Option<[usize; 3]> {
        let mut moved = [0; 3];
        for axis in 0..3 {
            let index = cube[axis] as i64 + step[axis];
            if index < 0 || index >= self.counts[axis] as i64 {
                return None;
            }
            moved[axis] = index as usize;
        }
        Some(moved)
    }

    /// All leaves of the octree.
    pub fn leaves(&self) -> impl Iterator<Item = Leaf> {
        self.cubes().map(|cube| (cube, self.levels[self.cube(cube)])).filter_map(|(cube, level)| {
            let is_first = cube.iter().all(|index| index.is_multiple_of(1 << level));
            is_first.then(|| Leaf { low: cube.map(|i| 2 * i as u32), edge: 2 << level, level })
        })
    }

    /// The leaf that holds a smallest cube.
    pub fn leaf_of(&self, cube: [usize; 3]) -> Leaf {
        let level = self.levels[self.cube(cube)];
        Leaf { low: cube.map(|i| 2 * (i >> level << level) as u32), edge: 2 << level, level }
    }

    /// The leaf across a face, at the face's lowest corner; none beyond the border.
    pub fn across(&self, leaf: &Leaf, step: [i64; 3]) -> Option<Leaf> {
        let own = leaf.low.map(|c| (c / 2) as usize);
        let width = i64::from(leaf.edge / 2);
        let cube = self.beside(own, step.map(|s| if s > 0 { s * width } else { s }))?;
        Some(self.leaf_of(cube))
    }

    /// The value on a lattice point of the smallest cubes.
    pub fn value(&self, place: Place) -> f64 {
        let index = place.map(|c| (c / 2) as usize);
        if place[0].is_multiple_of(2) {
            self.corners[self.corner(index)]
        } else {
            self.centres[self.cube(index)]
        }
    }

    /// Whether a tetrahedron around the centre of the cube may have corners on both sides.
    pub fn is_near_surface(&self, cube: [usize; 3]) -> bool {
        let own = Side::of(self.centres[self.cube(cube)]);
        if own == Side::On {
            return true;
        }
        let corners =
            (0..8).map(|c| self.corners[self.corner([0, 1, 2].map(|axis| cube[axis] + (c >> axis & 1)))]);
        let beside =
            FACES.iter().filter_map(|step| self.beside(cube, *step)).map(|at| self.centres[self.cube(at)]);
        corners.chain(beside).any(|value| Side::of(value) != own)
    }

    /// Joins cubes into the largest leaves that the sizes inside allow.
    fn join(&mut self, size: &Size, coarsest: u8) -> Result<(), FillError> {
        let allowed = self.allowed_levels(size, coarsest)?;
        let mut levels = vec![0_u8; allowed.len()];
        for level in (1..=coarsest).rev() {
            self.for_each_block(level, |block| {
                if levels[self.cube(block[0])] == 0
                    && block.iter().all(|cube| allowed[self.cube(*cube)] >= level)
                {
                    block.iter().for_each(|cube| levels[self.cube(*cube)] = level);
                }
            });
        }
        self.levels = levels;
        while self.split_unbalanced(coarsest) {}
        Ok(())
    }

    /// Calls with the cubes of each aligned block of `2^level` cubes along the axes.
    fn for_each_block(&self, level: u8, mut visit: impl FnMut(&[[usize; 3]])) {
        let unit = 1_usize << level;
        let mut block = Vec::with_capacity(unit.pow(3));
        for k in (0..self.counts[2]).step_by(unit) {
            for j in (0..self.counts[1]).step_by(unit) {
                for i in (0..self.counts[0]).step_by(unit) {
                    block.clear();
                    block.extend(
                        (0..unit.pow(3)).map(|c| [i + c % unit, j + c / unit % unit, k + c / (unit * unit)]),
                    );
                    visit(&block);
                }
            }
        }
    }

    /// The greatest level of a leaf that may hold each cube: zero near the surface and around that, but for a field that holds
    /// everywhere.
    fn allowed_levels(&self, size: &Size, coarsest: u8) -> Result<Vec<u8>, FillError> {
        let level_of = |ratio: f64| (ratio.max(1.0).log2().floor() as u8).min(coarsest);
        let by_field = |field: &dyn Fn(Vec3) -> f64, cube: [usize; 3]| {
            let position = self.position(cube.map(|i| 2 * i as u32 + 1));
            let length = field(position);
            // beyond the shape a formula may say anything
            if self.centres[self.cube(cube)] < 0.0 && (length.is_nan() || length <= 0.0) {
                return Err(FillError::SizeAt { size: length, position: position.to_array() });
            }
            Ok(level_of(length / size.smallest * (1.0 + 1e-12)))
        };
        if let Grading::Field { size: field, reach: Reach::Everywhere, .. } = &size.grading {
            return self.cubes().map(|cube| by_field(field, cube)).collect();
        }
        // steps of a cube from the nearest one that touches a cube near the surface
        let steps = self.steps_from_surface();
        self.cubes()
            .zip(steps)
            .map(|(cube, steps)| match (steps, &size.grading) {
                (_, Grading::Uniform) => Ok(0),
                // asked at the surface too: a formula that gives no length is said wherever that is
                (steps, Grading::Field { size: field, .. }) => {
                    by_field(field, cube).map(|level| if steps == 0 { 0 } else { level })
                }
                (0, _) => Ok(0),
                (steps, Grading::Inward { growth, .. }) => Ok(level_of(1.0 + growth * f64::from(steps))),
            })
            .collect()
    }

    /// Layers between each cube and the surface: 0 for cubes near it and those that touch them.
    fn steps_from_surface(&self) -> Vec<u32> {
        let mut steps = vec![u32::MAX; self.levels.len()];
        let mut layer: Vec<[usize; 3]> = self.cubes().filter(|cube| self.is_near_surface(*cube)).collect();
        layer.iter().for_each(|cube| steps[self.cube(*cube)] = 0);
        let mut depth = 0;
        let mut is_first = true;
        while !layer.is_empty() {
            // the first layer around belongs to the surface: no tetrahedron of another size touches a moved point
            depth += u32::from(!is_first);
            is_first = false;
            let mut next = Vec::new();
            for cube in &layer {
                for step in around() {
                    if let Some(other) = self.beside(*cube, step)
                        && steps[self.cube(other)] == u32::MAX
                    {
                        steps[self.cube(other)] = depth;
                        next.push(other);
                    }
                }
            }
            layer = next;
        }
        steps
    }

    /// Splits leaves that touch one of less than half their edge; whether there was any.
    fn split_unbalanced(&mut self, coarsest: u8) -> bool {
        let mut has_split = false;
        for level in 2..=coarsest {
            let mut split = Vec::new();
            self.for_each_block(level, |block| {
                if self.levels[self.cube(block[0])] != level {
                    return;
                }
                let [low, high] = [block[0], block[block.len() - 1]];
                let is_small = |cube: &[usize; 3]| self.levels[self.cube(*cube)] < level - 1;
                let touches = block
                    .iter()
                    .filter(|cube| (0..3).any(|axis| cube[axis] == low[axis] || cube[axis] == high[axis]))
                    .flat_map(|cube| around().filter_map(|step| self.beside(*cube, step)))
                    .any(|cube| is_small(&cube));
                if touches {
                    split.extend_from_slice(block);
                }
            });
            for cube in &split {
                let index = self.cube(*cube);
                self.levels[index] = level - 1;
            }
            has_split |= !split.is_empty();
        }
        has_split
    }
}

/// Cubes along the axes that a lattice has at least: one around everything, so that the outermost corners are outside.
fn cubes_along(extent: Vec3, size: &Size) -> [f64; 3] {
    extent.to_array().map(|length| (length / size.smallest).ceil() + 2.0)
}

/// How many points a lattice would have.
pub(super) fn points_of(shape: &dyn Shape, size: &Size) -> f64 {
    let unit = f64::from(1_u32 << size.coarsest_level(MAX_LEVEL));
    cubes_along(shape.bounds().size(), size).iter().map(|count| count + unit).product::<f64>() * 2.0
}

/// The 26 steps to the cubes that touch one.
fn around() -> impl Iterator<Item = [i64; 3]> {
    (0..27_i64).map(|c| [c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1]).filter(|step| *step != [0; 3])
}
