//! What tools leave on the surface of an organ: it whitens where it is pressed, burns where something hot touches it, and bleeds where
//! its vessels are torn (Debunne 2000, 5 §5.1).
//!
//! All are numbers of each node of the body's surface that evolve, a field of State. A force on a node is borne by the faces around it
//! that face it: `p = |f| / A` with `A = Σ max(-a_t · f/|f|, 0) / 3` over the area vectors `a_t` of the triangles around it as they stand,
//! of sheets `Σ |a_t · f/|f|| / 3`; sides that run along the force bear nothing of it. What blood is pressed out of a node follows by
//! first-order kinetics,
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
//! those of its end. Heat is not conducted along the surface or into the depth, and nothing heals. For blood see [`BleedingLaw`].

mod blood;

use std::iter::repeat;
use std::sync::Arc;

use souple_engine::{CommittedRows, Field, FieldState, FieldStep, Scratch, StepError};
use souple_math::Vec3;
use souple_mesh::{OpeningSurface, Span};

pub use blood::BleedingLaw;

use crate::loads::Gravity;
use blood::{Film, Running};

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
    /// `None` where nothing makes it bleed.
    pub bleeding: Option<BleedingLaw>,
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

/// A contact with something hot, or sharp.
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    pub contact: String,
    /// [W/m²]
    pub heat: f64,
    /// Pressure at which it tears vessels [Pa]; that of the law where `None`.
    pub tears_at: Option<f64>,
}

/// Points of a surface that are cut, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct Gash {
    /// [s]
    pub time: f64,
    /// Of the mesh; those inside are left out.
    pub points: Vec<u32>,
}

/// On which sides of its triangles a surface is pressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// That of a body of volumes.
    Outer,
    /// A sheet's.
    Both,
}

/// What is known of a surface beside how it takes what is done to it.
#[derive(Debug)]
pub struct MarkedSurface<'a> {
    /// System of the body, and row of its first point there.
    pub place: [usize; 2],
    /// What is ever on the boundary of its mesh.
    pub surface: &'a OpeningSurface,
    /// Of the mesh.
    pub point_count: usize,
    pub sides: Sides,
    pub tools: Vec<Tool>,
    pub gashes: Vec<Gash>,
}

/// What has been done to a point of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mark {
    /// From 0 to 1.
    pub whitening: f64,
    /// Heat per area that it has taken up [J/m²].
    pub dose: f64,
    /// Blood on it, by volume for each area at rest [m].
    pub blood: f64,
    /// The same about the point as a whole [m³].
    pub blood_volume: f64,
}

/// The surface of a body that whitens, burns and bleeds.
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
    /// Corners, which are nodes.
    triangles: Vec<[u32; 3]>,
    /// When each of them is on the surface; empty where all always are.
    spans: Vec<Span>,
    /// Triangles around each node: those of node `i` are `around[starts[i]..starts[i + 1]]`.
    around: Vec<u32>,
    starts: Vec<u32>,
    /// A third of the triangles around each node, at rest, when it first is on the surface [m²].
    areas: Vec<f64>,
    sides: Sides,
    law: MarkingLaw,
    tools: Vec<Tool>,
    gashes: Vec<Gash>,
}

/// What is done to nodes at the end of a period.
struct Done {
    /// [Pa]
    pressures: Vec<f64>,
    /// Greatest of what touches it [W/m²].
    heated: Vec<f64>,
    /// Pressure at which the sharpest of what touches it tears its vessels [Pa].
    tears_at: Vec<f64>,
    /// Whether something tears it.
    torn: Vec<bool>,
    /// Of each triangle, outward, as it stands [m²].
    area_vectors: Vec<Vec3>,
    /// Around each node as it stands [m²].
    areas: Vec<f64>,
    running: Running,
}

/// Numbers of each node, one list after the other: whitening and dose; of a surface that bleeds also the film of blood and the share of
/// the vessels that is open.
const LISTS: usize = 2;
const LISTS_OF_BLEEDING: usize = 4;

impl Marks {
    pub fn new(name: String, law: MarkingLaw, of: MarkedSurface) -> Self {
        let MarkedSurface { place: [system, first_row], surface, point_count, sides, tools, gashes } = of;
        let mut node_of_point = vec![None; point_count];
        let areas = surface.first_point_areas();
        let OpeningSurface { surface, spans } = surface;
        for (node, point) in surface.mesh_points.iter().enumerate() {
            node_of_point[*point as usize] = Some(node as u32);
        }
        let points = surface.mesh_points.clone();
        let triangles = surface.triangles.clone();
        let mut about: Vec<Vec<u32>> = vec![Vec::new(); points.len()];
        for (triangle, corners) in triangles.iter().enumerate() {
            corners.iter().for_each(|corner| about[*corner as usize].push(triangle as u32));
        }
        let ends = about.iter().scan(0, |end, list| {
            *end += list.len() as u32;
            Some(*end)
        });
        let starts = [0].into_iter().chain(ends).collect();
        let around = about.into_iter().flatten().collect();
        Self {
            name,
            system,
            first_row,
            points,
            node_of_point,
            triangles,
            spans: spans.clone(),
            around,
            starts,
            areas,
            sides,
            law,
            tools,
            gashes,
        }
    }

    /// Untouched.
    pub fn start(&self) -> FieldState {
        FieldState { values: vec![0.0; self.lists() * self.points.len()], indices: Vec::new() }
    }

    /// Whether its vessels can be torn.
    pub fn bleeds(&self) -> bool {
        self.law.bleeding.is_some()
    }

    fn lists(&self) -> usize {
        if self.bleeds() { LISTS_OF_BLEEDING } else { LISTS }
    }

    /// Whether a point of the mesh is on the surface.
    pub fn is_marked(&self, point: usize) -> bool {
        self.node_of_point.get(point).is_some_and(Option::is_some)
    }

    /// What has been done to a point of the mesh; `None` inside.
    pub fn mark_at(&self, point: usize, state: &FieldState) -> Option<Mark> {
        let node = (*self.node_of_point.get(point)?)? as usize;
        let number = |list: usize| state.values.get(list * self.points.len() + node).copied().unwrap_or(0.0);
        let blood = number(2);
        Some(Mark { whitening: number(0), dose: number(1), blood, blood_volume: blood * self.areas[node] })
    }

    /// How a point of the mesh looks beneath its blood: 1 where it is white, 0 as it was, -1 where it is charred, which nothing whitens;
    /// 0 inside.
    pub fn look_at(&self, point: usize, state: &FieldState) -> f64 {
        let Mark { whitening, dose, .. } = self.mark_at(point, state).unwrap_or_default();
        let charred = self.law.charred(dose);
        whitening * (1.0 - charred) - charred
    }

    fn node_of_row(&self, row: u32) -> Option<usize> {
        let point = (row as usize).checked_sub(self.first_row)?;
        Some((*self.node_of_point.get(point)?)? as usize)
    }

    fn place(&self, node: u32, positions: &[Vec3]) -> Vec3 {
        positions[self.first_row + self.points[node as usize] as usize]
    }

    /// Finds how the triangles stand that are on the surface at a time [s], and the area around each node; others have none.
    fn measure(&self, positions: &[Vec3], time: f64, done: &mut Done) {
        done.areas.fill(0.0);
        let spans = self.spans.iter().copied().chain(repeat(Span::ALWAYS));
        for ((corners, area_vector), span) in self.triangles.iter().zip(&mut done.area_vectors).zip(spans) {
            *area_vector = Vec3::ZERO;
            if !span.holds(time) {
                continue;
            }
            let [a, b, c] = corners.map(|node| self.place(node, positions));
            *area_vector = (b - a).cross(c - a) * 0.5;
            let third = area_vector.length() / 3.0;
            corners.iter().for_each(|corner| done.areas[*corner as usize] += third);
        }
    }

    /// The area around a node that faces a force along a direction [m²].
    fn facing(&self, node: usize, direction: Vec3, area_vectors: &[Vec3]) -> f64 {
        let around = &self.around[self.starts[node] as usize..self.starts[node + 1] as usize];
        let facing = |triangle: &u32| {
            let along = -area_vectors[*triangle as usize].dot(direction);
            if self.sides == Sides::Both { along.abs() } else { along.max(0.0) }
        };
        around.iter().map(facing).sum::<f64>() / 3.0
    }

    fn look(&self, rows: CommittedRows, time: f64, done: &mut Done) {
        self.measure(&rows.of(self.system).positions, time, done);
        done.pressures.fill(0.0);
        done.heated.fill(0.0);
        done.tears_at.fill(f64::INFINITY);
        let usual = self.law.bleeding.map_or(f64::INFINITY, |law| law.pressure);
        rows.visit_contacts(self.system, &mut |contact, point| {
            let tool = self.tools.iter().find(|tool| tool.contact == contact);
            let heat = tool.map_or(0.0, |tool| tool.heat);
            let tears_at = tool.and_then(|tool| tool.tears_at).unwrap_or(usual);
            let mut touch = |row: u32, force: Vec3| {
                let Some(node) = self.node_of_row(row) else { return };
                let Some(direction) = force.try_normalised() else { return };
                let facing = self.facing(node, direction, &done.area_vectors);
                // what touches it from behind all of its faces presses none of them
                let pressure = if facing > 0.0 { force.length() / facing } else { 0.0 };
                done.pressures[node] += pressure;
                done.heated[node] = heat.max(done.heated[node]);
                done.tears_at[node] = tears_at.min(done.tears_at[node]);
            };
            touch(point.row, point.normal_force);
            point.against.iter().for_each(|(row, share)| touch(*row, -point.normal_force * *share));
        });
        // all that presses it drives the sharpest in
        let reached =
            done.pressures.iter().zip(&done.tears_at).map(|(pressure, tears_at)| pressure >= tears_at);
        done.torn.iter_mut().zip(reached).for_each(|(torn, reached)| *torn = self.bleeds() && reached);
    }

    /// Tears the vessels of what is cut in a period, from its start to before its end [s].
    fn cut(&self, step: &FieldStep, done: &mut Done) {
        // what rounding leaves between two periods belongs to both: torn twice is torn
        let from = step.start - 1e-9 * step.timestep;
        let due = self.gashes.iter().filter(|gash| (from..step.start + step.timestep).contains(&gash.time));
        for point in due.flat_map(|gash| &gash.points) {
            if let Some(Some(node)) = self.node_of_point.get(*point as usize) {
                done.torn[*node as usize] = true;
            }
        }
    }

    /// Wells up, runs and dries.
    fn bleed(
        &self,
        law: &BleedingLaw,
        rows: CommittedRows,
        step: &FieldStep,
        values: &mut [f64],
        done: &mut Done,
    ) {
        let count = self.points.len();
        let (marks, blood) = values.split_at_mut(LISTS * count);
        let (film, open) = blood.split_at_mut(count);
        self.cut(step, done);
        for (node, (film, open)) in film.iter_mut().zip(open.iter_mut()).enumerate() {
            if done.areas[node] <= 0.0 {
                // its last triangle has gone, and with it what lay there
                (*film, *open) = (0.0, 0.0);
                continue;
            }
            if done.torn[node] {
                *open = 1.0;
            }
            // vessels that are pressed empty or charred have none to give
            let [whitening, dose] = [marks[node], marks[count + node]];
            let flows = (1.0 - whitening) * (1.0 - self.law.charred(dose));
            *film = law.dried(*film, step.timestep) + flows * law.let_out(open, step.timestep);
        }
        let gravity =
            rows.forces(self.system).iter().find_map(|force| force.as_any().downcast_ref::<Gravity>());
        let gravity = gravity.map_or(Vec3::ZERO, |gravity| gravity.at(step.start + step.timestep));
        let positions = &rows.of(self.system).positions;
        let Done { area_vectors, areas, running, .. } = done;
        let areas = [&self.areas[..], &areas[..]];
        Film { film, triangles: &self.triangles, area_vectors, areas, gravity }.run(
            law,
            step.timestep,
            |node| self.place(node, positions),
            running,
        );
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
        let most = [1.0, f64::MAX, f64::MAX, 1.0];
        let lists = field.values.chunks_exact(self.0.points.len().max(1)).zip(most);
        let mut lists = lists.map(|(list, most)| list.iter().all(|value| (0.0..=most).contains(value)));
        has_size && lists.all(|is_within| is_within)
    }

    fn new_scratch(&self) -> Scratch {
        let marks = &*self.0;
        let (nodes, triangles) = (marks.points.len(), marks.triangles.len());
        Box::new(Done {
            pressures: vec![0.0; nodes],
            heated: vec![0.0; nodes],
            tears_at: vec![f64::INFINITY; nodes],
            torn: vec![false; nodes],
            area_vectors: vec![Vec3::ZERO; triangles],
            areas: vec![0.0; nodes],
            running: if marks.bleeds() { Running::new(nodes, triangles) } else { Running::default() },
        })
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
        marks.look(rows, step.start + step.timestep, done);
        let (whitening, others) = field.values.split_at_mut(marks.points.len());
        for (node, (whitening, dose)) in whitening.iter_mut().zip(others).enumerate() {
            *whitening = marks.law.whitened(*whitening, done.pressures[node], step.timestep);
            *dose += done.heated[node] * step.timestep;
        }
        if let Some(law) = &marks.law.bleeding {
            marks.bleed(law, rows, step, &mut field.values, done);
        }
        Ok(())
    }

    fn bytes(&self, scratch: &Scratch) -> usize {
        let Marks { points, node_of_point, triangles, spans, around, starts, areas, .. } = &*self.0;
        let gashes: usize = self.0.gashes.iter().map(|gash| 4 * gash.points.capacity()).sum();
        let constant = gashes
            + 4 * (points.capacity() + around.capacity() + starts.capacity())
            + 8 * (node_of_point.capacity() + areas.capacity())
            + 12 * triangles.capacity()
            + size_of::<Span>() * spans.capacity();
        let of_scratch = scratch.downcast_ref::<Done>().map_or(0, |done| {
            33 * done.pressures.capacity() + 24 * done.area_vectors.capacity() + done.running.bytes()
        });
        constant + of_scratch
    }
}

#[cfg(test)]
mod tests {
    use souple_mesh::TriangleSurface;

    use super::*;

    const LAW: MarkingLaw = MarkingLaw {
        whitening_pressure: 2e3,
        whitening_time: 0.2,
        refill_time: 1.0,
        burn_dose: 3e4,
        bleeding: None,
    };

    /// Of a surface without tools, whose first point is row 5 of its system.
    fn marks_of(surface: &TriangleSurface, law: MarkingLaw) -> Marks {
        let point_count = surface.mesh_points.iter().max().map_or(0, |most| *most as usize + 1);
        let (tools, gashes) = (Vec::new(), Vec::new());
        let surface = &OpeningSurface::from(surface.clone());
        let of = MarkedSurface { place: [0, 5], surface, point_count, sides: Sides::Outer, tools, gashes };
        Marks::new("marks".to_owned(), law, of)
    }

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
        let surface = TriangleSurface {
            points: vec![Vec3::ZERO; 2],
            mesh_points: vec![3, 1],
            ..TriangleSurface::default()
        };
        let marks = marks_of(&surface, LAW);
        assert_eq!(
            [4, 5, 6, 7, 8, 9].map(|row| marks.node_of_row(row)),
            [None, None, Some(1), None, Some(0), None]
        );
        let look = |white: f64, dose: f64| {
            let state = FieldState { values: vec![0.0, white, 0.0, dose], indices: Vec::new() };
            let mark = Mark { whitening: white, dose, ..Mark::default() };
            assert_eq!(marks.mark_at(1, &state), Some(mark));
            assert_eq!((marks.mark_at(0, &state), marks.look_at(0, &state)), (None, 0.0));
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
        let surface =
            TriangleSurface { points: vec![Vec3::ZERO], mesh_points: vec![0], ..TriangleSurface::default() };
        let accepts = |law: MarkingLaw, values: &[f64]| {
            let marks = marks_of(&surface, law);
            let current = marks.start();
            let field = FieldState { values: values.to_vec(), indices: Vec::new() };
            Kept(Arc::new(marks)).accepts(&field, &current)
        };
        assert!(accepts(LAW, &[0.5, 1e4]));
        for bad in [&[0.5][..], &[f64::NAN, 0.0], &[0.5, -1.0], &[1.5, 0.0], &[0.5, 1e4, 0.0, 0.0]] {
            assert!(!accepts(LAW, bad), "{bad:?}");
        }
        let bleeding = MarkingLaw { bleeding: Some(blood::testing::LAW), ..LAW };
        assert!(accepts(bleeding, &[0.5, 1e4, 1e-4, 1.0]));
        for bad in [[0.5, 1e4, -1e-4, 1.0], [0.5, 1e4, 1e-4, 1.5], [0.5, 1e4, f64::INFINITY, 1.0]] {
            assert!(!accepts(bleeding, &bad), "{bad:?}");
        }
    }

    /// On an edge of a block the faces that face a force bear it, and not those along it: a corner of a unit cube has a third of the
    /// triangles of its lower side there, or two thirds of them by how the square is cut, and one pressed askew bears by what it faces.
    #[test]
    fn faces_bear_what_they_face() {
        let values = souple_table::Values::new()
            .with("size", souple_table::Value::Vector([1.0; 3]))
            .with("cells", souple_table::Value::Vector([1.0; 3]))
            .with("element", souple_table::Value::Text("hex8"));
        let mesh = souple_mesh::generate("box", values).unwrap();
        let surface = mesh.boundary_surface();
        let marks = marks_of(&surface, LAW);
        let vectors: Vec<Vec3> =
            (0..surface.triangles.len()).map(|triangle| surface.area_vector(triangle as u32)).collect();
        let below: Vec<usize> = (0..8).filter(|node| surface.points[*node].y < 1e-9).collect();
        let facing =
            |direction: Vec3| below.iter().map(|node| marks.facing(*node, direction, &vectors)).sum::<f64>();
        assert_eq!(below.len(), 4);
        // the whole lower side, while the areas around these nodes have two thirds of the sides in them as well
        assert!((facing(Vec3::Y) - 1.0).abs() < 1e-15, "{}", facing(Vec3::Y));
        assert!(below.iter().map(|node| marks.areas[*node]).sum::<f64>() > 2.5);
        // from above nothing of them is faced
        assert_eq!(facing(-Vec3::Y), 0.0);
        let askew = Vec3::new(0.6, 0.8, 0.0);
        let half: f64 = below.iter().map(|node| marks.facing(*node, Vec3::X, &vectors)).sum();
        assert!((facing(askew) - 0.8 - 0.6 * half).abs() < 1e-15);
    }
}
