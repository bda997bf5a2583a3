//! Mass of a body of frames from that of its points.

use souple_engine::Mass;
use souple_math::{Mat3, Vec3, eigen_symmetric};

use super::{Carried, Frame, FrameError, ROWS_OF_FRAME, Sample};

/// Adds `Σ_s m_s W_sa W_sb` over the rows of frames: the kinetic energy of the points, exactly. Call [`Mass::seal`] when
/// all bodies are in.
pub fn consistent_mass(carried: &[Carried], masses: &[f64], row_of_frame: &[u32], mass: &mut Mass) {
    // entries are summed before they are listed: points share few pairs of frames
    let mut sums = std::collections::BTreeMap::new();
    for (point, m) in carried.iter().zip(masses) {
        for (i, a) in point.frames.iter().zip(&point.rows) {
            for (j, b) in point.frames.iter().zip(&point.rows) {
                let sum = sums.entry((*i, *j)).or_insert([[0.0; ROWS_OF_FRAME]; ROWS_OF_FRAME]);
                for (sums, (weight_a, _)) in sum.iter_mut().zip(a) {
                    for (sum, (weight_b, _)) in sums.iter_mut().zip(b) {
                        *sum += m * weight_a * weight_b;
                    }
                }
            }
        }
    }
    for ((i, j), sums) in sums {
        add(mass, [row_of_frame[i as usize], row_of_frame[j as usize]], &sums);
    }
}

/// Adds to each frame the matter around it, `Σ_s m_s w_s (1, l_s) ⊗ (1, l_s)`: mass, static moment and second moments of
/// its share of every point. That is the sum of each frame's lines of [`consistent_mass`] as rigid and affine motions see
/// them, and couples no two frames; energy and momenta of those motions are exact.
pub fn lumped_mass(
    frames: &[Frame],
    samples: &[Sample],
    carried: &[Carried],
    masses: &[f64],
    row_of_frame: &[u32],
    mass: &mut Mass,
) {
    let mut sums = vec![[[0.0; ROWS_OF_FRAME]; ROWS_OF_FRAME]; frames.len()];
    for ((sample, point), m) in samples.iter().zip(carried).zip(masses) {
        for (frame, rows) in point.frames.iter().zip(&point.rows) {
            let Frame { origin, axes } = &frames[*frame as usize];
            let local = axes.transpose_apply(sample.position - *origin).to_array();
            let arms = [1.0, local[0], local[1], local[2]];
            for (sums, a) in sums[*frame as usize].iter_mut().zip(arms) {
                for (sum, b) in sums.iter_mut().zip(arms) {
                    *sum += m * rows[0].0 * a * b;
                }
            }
        }
    }
    for (row, sums) in row_of_frame.iter().zip(&sums) {
        add(mass, [*row, *row], sums);
    }
}

fn add(mass: &mut Mass, [i, j]: [u32; 2], sums: &[[f64; ROWS_OF_FRAME]; ROWS_OF_FRAME]) {
    for (a, line) in (i..).zip(sums) {
        for (b, sum) in (j..).zip(line) {
            mass.add(a, b, *sum);
        }
    }
}

/// Volume, static moment and second moments of the matter of a frame, about the frame.
#[derive(Clone, Copy, Debug)]
pub struct Moments {
    /// [m³]
    pub volume: f64,
    first: Vec3,
    second: Mat3,
}

impl Moments {
    const ZERO: Self = Self { volume: 0.0, first: Vec3::ZERO, second: Mat3::ZERO };

    /// Of every frame: each has its share of each point.
    pub fn of_frames(frames: &[Frame], samples: &[Sample], carried: &[Carried]) -> Vec<Self> {
        let mut moments = vec![Self::ZERO; frames.len()];
        for (sample, point) in samples.iter().zip(carried) {
            for (frame, rows) in point.frames.iter().zip(&point.rows) {
                let arm = sample.position - frames[*frame as usize].origin;
                let volume = sample.volume * rows[0].0;
                let sums = &mut moments[*frame as usize];
                sums.volume += volume;
                sums.first += arm * volume;
                sums.second += arm.outer(arm) * volume;
            }
        }
        moments
    }

    /// Second moments about the middle of the matter along its own axes, ascending [m⁵].
    pub fn principal(&self) -> [f64; 3] {
        let spread = self.second - self.first.outer(self.first) * (1.0 / self.volume);
        let mut values = eigen_symmetric(&spread).values.to_array();
        values.sort_by(f64::total_cmp);
        values
    }
}

/// Second moments below this part of the largest count as nothing: rounding of coordinates, squared.
const FLAT: f64 = 1e-12;

/// Whether the matter of every frame can resist every motion that the frame is free to make: turns of a rigid frame,
/// stretches of an affine one.
///
/// # Errors
/// The first frame whose matter cannot.
pub fn check_inertia(
    frames: &[Frame],
    samples: &[Sample],
    carried: &[Carried],
    is_affine: bool,
) -> Result<(), FrameError> {
    let moments = Moments::of_frames(frames, samples, carried);
    for (index, (frame, moments)) in frames.iter().zip(moments).enumerate() {
        let at = frame.origin;
        if moments.volume <= 0.0 {
            return Err(FrameError::NoMatter { frame: index, at });
        }
        let [least, middle, most] = moments.principal();
        let scale = most.max(moments.second.trace());
        let is_nothing = |moment: f64| moment <= FLAT * scale;
        let lies_on = |shape, motions| Err(FrameError::NoInertia { frame: index, at, shape, motions });
        if is_nothing(most) {
            return lies_on("point", "turns");
        }
        if is_nothing(middle) {
            return lies_on("line", "turns about it");
        }
        if is_affine && is_nothing(least) {
            return lies_on("plane", "stretches across it");
        }
    }
    Ok(())
}
