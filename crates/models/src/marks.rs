//! What tools leave on the surface of an organ: it whitens where it is pressed, and burns where something hot touches it
//! (Debunne 2000, 5 §5.1).
//!
//! Both are numbers of each node of the body's surface that evolve, a field of State. With `p` the normal force on a node over the
//! area around it at rest, what blood is pressed out of it follows by first-order kinetics,
//!
//! ```text
//! dw/dt = (w∞ - w) / τ,   w∞ = min(p / p_w, 1),   τ = τ_w where w < w∞, τ_r else
//! ```
//!
//! with the pressure `p_w` that empties the vessels, the time `τ_w` in which they empty and the time `τ_r` in which they fill again.
//! What is touched by something hot takes up its heat per area `q`, and keeps what that has done:
//!
//! ```text
//! dD/dt = q while touched,   c = 1 - exp(-D / D_c)
//! ```
//!
//! with the dose `D` [J/m²], and the share `c` that is charred. Both are solved exactly over a period, in which pressure and touch are
//! those of its end. Heat is not conducted along the surface or into the depth, and nothing heals.

use std::sync::Arc;

use souple_engine::{CommittedRows, Field, FieldState, FieldStep, Scratch, StepError};
use souple_mesh::TriangleSurface;

/// How a surface takes what is done to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkingLaw {
    /// Pressure at which it is wholly white [Pa].
    pub whitening_pressure: f64,
    /// In which it becomes white, but for 1/e [s].
    pub whitening_time: f64,
    /// In which blood comes back, but for 1/e [s].
    pub refill_time: f64,
    /// Heat per area that chars it, but for 1/e [J/m²].
    pub burn_dose: f64,
}

impl MarkingLaw {
    /// How white a node is after `timestep` [s] under a pressure [Pa].
    fn whitened(&self, whitening: f64, pressure: f64, timestep: f64) -> f64 {
        let end = (pressure / self.whitening_pressure).min(1.0);
        let time = if whitening < end { self.whitening_time } else { self.refill_time };
        end + (whitening - end) * libm::exp(-timestep / time)
    }

    /// The share that is charred by a dose [J/m²].
    pub fn charred(&self, dose: f64) -> f64 {
        -libm::expm1(-dose / self.burn_dose)
    }
}

/// A contact with something hot.
#[derive(Clone, Debug, PartialEq)]
pub struct Heat {
    pub contact: String,
    /// [W/m²]
    pub flux: f64,
}

/// The surface of a body that whitens and burns.
#[derive(Debug)]
pub struct Marks {
    name: String,
    /// Index of the body's system.
    system: usize,
    /// Row of the body's first point.
    first_row: usize,
    /// Point of the mesh that each node is, ascending or not.
    points: Vec<u32>,
    /// Of each point of the mesh the number of its node.
    node_of_point: Vec<Option<u32>>,
    /// Around each node, at rest [m²].
    areas: Vec<f64>,
    law: MarkingLaw,
    heats: Vec<Heat>,
}

/// What is done to nodes at the end of a period.
struct Done {
    /// Normal force [N].
    pressed: Vec<f64>,
    /// Greatest of what touches it [W/m²].
    heated: Vec<f64>,
}

impl Marks {
    /// Of the boundary of a mesh of `point_count` points, whose first is a row of a system (`[system, row]`), with the `areas` around
    /// its points at rest [m²].
    pub fn new(
        name: String,
        [system, first_row]: [usize; 2],
        (surface, point_count): (&TriangleSurface, usize),
        areas: Vec<f64>,
        law: MarkingLaw,
        heats: Vec<Heat>,
    ) -> Self {
        let mut node_of_point = vec![None; point_count];
        for (node, point) in surface.mesh_points.iter().enumerate() {
            node_of_point[*point as usize] = Some(node as u32);
        }
        let points = surface.mesh_points.clone();
        Self { name, system, first_row, points, node_of_point, areas, law, heats }
    }

    /// Untouched.
    pub fn start(&self) -> FieldState {
        FieldState { values: vec![0.0; 2 * self.points.len()], indices: Vec::new() }
    }

    /// Whether a point of the mesh is on the surface.
    pub fn is_marked(&self, point: usize) -> bool {
        self.node_of_point.get(point).is_some_and(Option::is_some)
    }

    /// Of a point of the mesh how white it is, 0 to 1, and its dose [J/m²]; `None` inside.
    pub fn marks_at(&self, point: usize, state: &FieldState) -> Option<(f64, f64)> {
        let node = (*self.node_of_point.get(point)?)? as usize;
        Some((state.values[node], state.values[self.points.len() + node]))
    }

    /// How a point of the mesh looks: 1 where it is white, 0 as it was, -1 where it is charred, which nothing whitens; 0 inside.
    pub fn look_at(&self, point: usize, state: &FieldState) -> f64 {
        let (whitening, dose) = self.marks_at(point, state).unwrap_or_default();
        let charred = self.law.charred(dose);
        whitening * (1.0 - charred) - charred
    }

    fn node_of_row(&self, row: u32) -> Option<usize> {
        let point = (row as usize).checked_sub(self.first_row)?;
        Some((*self.node_of_point.get(point)?)? as usize)
    }

    fn look(&self, rows: CommittedRows, done: &mut Done) {
        done.pressed.fill(0.0);
        done.heated.fill(0.0);
        rows.visit_contacts(self.system, &mut |contact, point| {
            let force = point.normal_force.length();
            if force == 0.0 {
                return;
            }
            let flux = self.heats.iter().find(|heat| heat.contact == contact).map_or(0.0, |heat| heat.flux);
            let mut touch = |row: u32, share: f64| {
                let Some(node) = self.node_of_row(row).filter(|_| share > 0.0) else { return };
                done.pressed[node] += force * share;
                done.heated[node] = flux.max(done.heated[node]);
            };
            touch(point.row, 1.0);
            point.against.iter().for_each(|(row, share)| touch(*row, *share));
        });
    }
}

/// The marks of a body that others hold too, as a field of the world.
pub struct Kept(pub Arc<Marks>);

impl Field for Kept {
    fn name(&self) -> &str {
        &self.0.name
    }

    fn kind(&self) -> &'static str {
        "marks"
    }

    fn accepts(&self, field: &FieldState, current: &FieldState) -> bool {
        let has_size =
            (field.values.len(), field.indices.len()) == (current.values.len(), current.indices.len());
        let within = |values: &[f64], most: f64| values.iter().all(|value| (0.0..=most).contains(value));
        let (whitening, doses) = field.values.split_at(field.values.len() / 2);
        has_size && within(whitening, 1.0) && within(doses, f64::MAX)
    }

    fn new_scratch(&self) -> Scratch {
        let zeros = || vec![0.0; self.0.points.len()];
        Box::new(Done { pressed: zeros(), heated: zeros() })
    }

    fn step(
        &self,
        rows: CommittedRows,
        step: &FieldStep,
        field: &mut FieldState,
        scratch: &mut Scratch,
    ) -> Result<(), StepError> {
        let marks = &*self.0;
        let Some(done) = scratch.downcast_mut::<Done>() else { unreachable!("its own scratch") };
        marks.look(rows, done);
        let (whitening, doses) = field.values.split_at_mut(marks.points.len());
        for (node, (whitening, dose)) in whitening.iter_mut().zip(doses).enumerate() {
            let pressure = done.pressed[node] / marks.areas[node];
            *whitening = marks.law.whitened(*whitening, pressure, step.timestep);
            *dose += done.heated[node] * step.timestep;
        }
        Ok(())
    }

    fn bytes(&self, _scratch: &Scratch) -> usize {
        let Marks { points, node_of_point, areas, .. } = &*self.0;
        4 * points.capacity() + 8 * node_of_point.capacity() + 8 * areas.capacity() + 16 * points.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: MarkingLaw =
        MarkingLaw { whitening_pressure: 2e3, whitening_time: 0.2, refill_time: 1.0, burn_dose: 3e4 };

    /// Under a pressure that is held, whatever the steps: `w = w∞ (1 - exp(-t/τ_w))`, and after it `w₀ exp(-t/τ_r)`.
    #[test]
    fn whitening_follows_exponentials() {
        for (pressure, end) in [(1e3, 0.5), (2e3, 1.0), (9e3, 1.0)] {
            for steps in [1, 7, 100] {
                let step = 0.3 / f64::from(steps);
                let pressed = (0..steps).fold(0.0, |w, _| LAW.whitened(w, pressure, step));
                let released = (0..steps).fold(pressed, |w, _| LAW.whitened(w, 0.0, step));
                let expected = end * (1.0 - libm::exp(-1.5));
                assert!((pressed - expected).abs() < 1e-13, "{pressed} {expected}");
                assert!((released - expected * libm::exp(-0.3)).abs() < 1e-13, "{released}");
            }
        }
        // pressed less than it was, it fills again at the other rate
        assert!((LAW.whitened(1.0, 1e3, 0.5) - (0.5 + 0.5 * libm::exp(-0.5))).abs() < 1e-15);
    }

    /// The look goes from white through what it was to charred, and stays within.
    #[test]
    fn burns_hide_whitening() {
        let surface = TriangleSurface { mesh_points: vec![3, 1], ..TriangleSurface::default() };
        let marks = Marks::new("marks".to_owned(), [0, 5], (&surface, 4), vec![1e-4; 2], LAW, Vec::new());
        assert_eq!(
            [4, 5, 6, 7, 8, 9].map(|row| marks.node_of_row(row)),
            [None, None, Some(1), None, Some(0), None]
        );
        let look = |white: f64, dose: f64| {
            let state = FieldState { values: vec![0.0, white, 0.0, dose], indices: Vec::new() };
            assert_eq!(marks.marks_at(1, &state), Some((white, dose)));
            assert_eq!((marks.marks_at(0, &state), marks.look_at(0, &state)), (None, 0.0));
            marks.look_at(1, &state)
        };
        assert_eq!([look(0.0, 0.0), look(1.0, 0.0)], [0.0, 1.0]);
        let charred = 1.0 - libm::exp(-1.0);
        assert!((look(1.0, 3e4) - (1.0 - 2.0 * charred)).abs() < 1e-15);
        assert_eq!(look(0.7, 1e9), -1.0);
    }

    /// Numbers read from a file that are no marks are refused.
    #[test]
    fn only_marks_are_accepted() {
        let surface = TriangleSurface { mesh_points: vec![0], ..TriangleSurface::default() };
        let marks = Marks::new("marks".to_owned(), [0, 0], (&surface, 1), vec![1.0], LAW, Vec::new());
        let (field, current) =
            (Kept(Arc::new(marks)), FieldState { values: vec![0.0; 2], indices: Vec::new() });
        let accepts = |values: &[f64]| {
            field.accepts(&FieldState { values: values.to_vec(), indices: Vec::new() }, &current)
        };
        assert!(accepts(&[0.5, 1e4]));
        assert!(
            !accepts(&[0.5]) && !accepts(&[f64::NAN, 0.0]) && !accepts(&[0.5, -1.0]) && !accepts(&[1.5, 0.0])
        );
    }
}
