//! Blood on a surface: it wells up where vessels are torn, runs down as a film, and dries.
//!
//! The film is thin, so that viscosity balances gravity across it. With the thickness `h`, of which `h₀` clings to the tissue and the
//! rest runs, the volume that crosses a line of unit length along the surface in unit time is (Nusselt 1916; Huppert 1982)
//!
//! ```text
//! q = ρ g_t r³ / (3 μ),   r = max(h - h₀, 0),   ∂h/∂t + ∇·q = rate o (1 - w) (1 - c) - h / τ_d
//! ```
//!
//! with gravity along the surface `g_t`. Vessels that were torn are open by `o`, which clots as `exp(-t/τ_c)`; where they are pressed
//! empty (`w`) or charred (`c`) nothing leaves them. Volumes about the nodes exchange what crosses the lines from the middles of edges to
//! those of triangles, from the node above with its thickness: first order, and no volume is made or lost. There is no surface tension
//! along the film: streaks are no narrower than the triangles. What hangs under a surface thicker than the capillary length falls off.

use souple_math::Vec3;

/// Of blood [kg/m³].
const DENSITY: f64 = 1060.0;
/// Surface tension of blood against air [N/m] (Rosina et al. 2007).
const SURFACE_TENSION: f64 = 0.056;
/// Volumes of nodes change by no more than this part of what runs at once: waves in the film are three times as fast as the film.
const MOST_MOVED: f64 = 1.0 / 3.0;
/// Most parts of a period; in longer ones the film runs slower than it would.
const MOST_PARTS: usize = 32;

/// How a surface bleeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BleedingLaw {
    /// Pressure at which vessels tear [Pa].
    pub pressure: f64,
    /// Of a wound that is open, by volume for each area [m/s].
    pub rate: f64,
    /// In which a wound closes, but for 1/e [s].
    pub clotting_time: f64,
    /// In which blood dries, but for 1/e [s].
    pub drying_time: f64,
    /// [Pa s]
    pub viscosity: f64,
    /// Thickness of what clings and does not run [m].
    pub clinging: f64,
}

impl BleedingLaw {
    /// What vessels that are open by a share let out in a time [s], by volume for each area [m]; they clot meanwhile.
    pub(super) fn let_out(&self, open: &mut f64, timestep: f64) -> f64 {
        let closing = -libm::expm1(-timestep / self.clotting_time);
        let volume = self.rate * *open * self.clotting_time * closing;
        *open -= *open * closing;
        volume
    }

    /// What is left of a film after a time [s].
    pub(super) fn dried(&self, film: f64, timestep: f64) -> f64 {
        film * libm::exp(-timestep / self.drying_time)
    }
}

/// A film on the nodes of a surface, by volume for each area at rest [m], with what it runs over as that stands.
pub(super) struct Film<'a> {
    pub film: &'a mut [f64],
    pub triangles: &'a [[u32; 3]],
    /// Half the cross product of two sides of each [m²].
    pub area_vectors: &'a [Vec3],
    /// Around each node, at rest and now [m²].
    pub areas: [&'a [f64]; 2],
    /// [m/s²]
    pub gravity: Vec3,
}

/// Scratch of a film that runs.
#[derive(Default)]
pub(super) struct Running {
    /// Of each triangle, over its sides 01, 12, 20: `ρ / (3 μ)` times gravity through the line between their nodes, on to the second
    /// [1/(m s)].
    pulls: Vec<[f64; 3]>,
    /// Of each node, the sum of those that leave it.
    leaving: Vec<f64>,
    /// Of each node, away from the body: the sum of the area vectors around it.
    outward: Vec<Vec3>,
    /// Volume that each node gains [m³].
    gained: Vec<f64>,
}

impl Running {
    pub fn new(node_count: usize, triangle_count: usize) -> Self {
        Self {
            pulls: vec![[0.0; 3]; triangle_count],
            leaving: vec![0.0; node_count],
            outward: vec![Vec3::ZERO; node_count],
            gained: vec![0.0; node_count],
        }
    }

    pub fn bytes(&self) -> usize {
        24 * (self.pulls.capacity() + self.outward.capacity())
            + 8 * (self.leaving.capacity() + self.gained.capacity())
    }
}

const SIDES: [[usize; 3]; 3] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];

impl Film<'_> {
    /// Lets it run for a time [s], and drop where too much hangs; `place` tells where nodes are [m].
    pub fn run(
        &mut self,
        law: &BleedingLaw,
        timestep: f64,
        place: impl Fn(u32) -> Vec3,
        running: &mut Running,
    ) {
        if self.gravity == Vec3::ZERO || self.film.iter().all(|film| *film <= 0.0) {
            return;
        }
        self.look_downhill(law, place, running);
        let most = (0..self.film.len()).map(|node| self.share_leaving(node, law, timestep, running));
        let most = most.fold(0.0, f64::max);
        let parts = ((most / MOST_MOVED).ceil().max(1.0) as usize).min(MOST_PARTS);
        (0..parts).for_each(|_| self.run_part(law, timestep / parts as f64, running));
        self.drop_off(&running.outward);
    }

    /// Finds what gravity pulls through the line between the nodes of each side, and out of each node.
    fn look_downhill(&self, law: &BleedingLaw, place: impl Fn(u32) -> Vec3, running: &mut Running) {
        let mobility = DENSITY / (3.0 * law.viscosity);
        running.leaving.fill(0.0);
        running.outward.fill(Vec3::ZERO);
        for (triangle, corners) in self.triangles.iter().enumerate() {
            let pulls = &mut running.pulls[triangle];
            *pulls = [0.0; 3];
            let area_vector = self.area_vectors[triangle];
            corners.iter().for_each(|corner| running.outward[*corner as usize] += area_vector);
            let Some(normal) = area_vector.try_normalised() else { continue };
            let places = corners.map(&place);
            let middle = places.iter().copied().sum::<Vec3>() / 3.0;
            for (side, [from, to, _]) in SIDES.into_iter().enumerate() {
                // the line runs to the left of the way from one node to the other: its normal times its length points along it
                let line = middle - (places[from] + places[to]) * 0.5;
                let pull = mobility * self.gravity.dot(line.cross(normal));
                pulls[side] = pull;
                let above = corners[if pull > 0.0 { from } else { to }];
                running.leaving[above as usize] += pull.abs();
            }
        }
    }

    /// What of a film runs at a node [m]; none where nothing is around it.
    fn runs(&self, node: usize, law: &BleedingLaw) -> f64 {
        let [at_rest, now] = self.areas.map(|areas| areas[node]);
        if now > 0.0 { (self.film[node] * at_rest / now - law.clinging).max(0.0) } else { 0.0 }
    }

    /// The share of what runs at a node that leaves it in a time [s], were it as thick all the while.
    fn share_leaving(&self, node: usize, law: &BleedingLaw, timestep: f64, running: &Running) -> f64 {
        let now = self.areas[1][node];
        if now > 0.0 { timestep * running.leaving[node] * self.runs(node, law).powi(2) / now } else { 0.0 }
    }

    fn run_part(&mut self, law: &BleedingLaw, timestep: f64, running: &mut Running) {
        running.gained.fill(0.0);
        for (corners, pulls) in self.triangles.iter().zip(&running.pulls) {
            for ([from, to, _], pull) in SIDES.into_iter().zip(pulls) {
                let (above, below) = if *pull > 0.0 { (from, to) } else { (to, from) };
                let [above, below] = [corners[above] as usize, corners[below] as usize];
                let thick = self.runs(above, law);
                if thick > 0.0 {
                    let share = self.share_leaving(above, law, timestep, running);
                    let held_back = (MOST_MOVED / share).min(1.0);
                    let volume = timestep * pull.abs() * thick.powi(3) * held_back;
                    running.gained[above] -= volume;
                    running.gained[below] += volume;
                }
            }
        }
        for (node, gained) in running.gained.iter().enumerate().filter(|(_, gained)| **gained != 0.0) {
            // nothing flows to or from a node without an area; rounding takes no more than there is
            self.film[node] = (self.film[node] + gained / self.areas[0][node]).max(0.0);
        }
    }

    /// Takes off what hangs thicker than surface tension bears: `√(σ / (ρ g_n))`, with gravity `g_n` away from the surface.
    fn drop_off(&mut self, outward: &[Vec3]) {
        for (node, outward) in outward.iter().enumerate() {
            let away = outward.try_normalised().map_or(0.0, |normal| normal.dot(self.gravity));
            if away > 0.0 {
                let stretched = self.areas[1][node] / self.areas[0][node];
                let most = (SURFACE_TENSION / (DENSITY * away)).sqrt() * stretched;
                self.film[node] = self.film[node].min(most);
            }
        }
    }
}

#[cfg(test)]
pub(super) mod testing {
    use super::BleedingLaw;

    pub const LAW: BleedingLaw = BleedingLaw {
        pressure: 1e4,
        rate: 1e-4,
        clotting_time: 2.0,
        drying_time: 30.0,
        viscosity: 3.5e-3,
        clinging: 0.0,
    };
}

#[cfg(test)]
mod tests {
    use super::testing::LAW;
    use super::*;

    const G: f64 = 9.81;

    /// A strip that hangs down, two cells wide, as many long as are told.
    struct Plate {
        points: Vec<Vec3>,
        triangles: Vec<[u32; 3]>,
        area_vectors: Vec<Vec3>,
        areas: Vec<f64>,
        running: Running,
    }

    impl Plate {
        /// Down along -y from zero.
        fn new(length: f64, width: f64, cells: u32) -> Self {
            let point = |index: u32| {
                let (row, column) = (f64::from(index / 3), f64::from(index % 3));
                Vec3::new(0.5 * width * column, -length * row / f64::from(cells), 0.0)
            };
            let points: Vec<Vec3> = (0..3 * (cells + 1)).map(point).collect();
            let cell = |at: u32| {
                let a = 3 * (at / 2) + at % 2;
                // diagonals alternate
                if (at / 2 + at).is_multiple_of(2) {
                    [[a, a + 3, a + 1], [a + 1, a + 3, a + 4]]
                } else {
                    [[a, a + 3, a + 4], [a, a + 4, a + 1]]
                }
            };
            let triangles: Vec<[u32; 3]> = (0..2 * cells).flat_map(cell).collect();
            let mut areas = vec![0.0; points.len()];
            let vector = |corners: &[u32; 3]| {
                let [a, b, c] = corners.map(|corner| points[corner as usize]);
                (b - a).cross(c - a) * 0.5
            };
            let area_vectors: Vec<Vec3> = triangles.iter().map(vector).collect();
            for (corners, vector) in triangles.iter().zip(&area_vectors) {
                corners.iter().for_each(|corner| areas[*corner as usize] += vector.length() / 3.0);
            }
            let running = Running::new(points.len(), triangles.len());
            Self { points, triangles, area_vectors, areas, running }
        }

        fn run(&mut self, film: &mut [f64], law: &BleedingLaw, gravity: Vec3, timestep: f64) {
            let Self { points, triangles, area_vectors, areas, running } = self;
            let areas = [&areas[..], &areas[..]];
            let mut film = Film { film, triangles, area_vectors, areas, gravity };
            film.run(law, timestep, |node| points[node as usize], running);
        }

        fn volume(&self, film: &[f64]) -> f64 {
            film.iter().zip(&self.areas).map(|(film, area)| film * area).sum()
        }

        /// How far down the blood is, in the mean [m].
        fn depth(&self, film: &[f64]) -> f64 {
            let moments = film.iter().zip(&self.areas).zip(&self.points);
            let moment: f64 = moments.map(|((film, area), point)| -film * area * point.y).sum();
            moment / self.volume(film)
        }
    }

    /// A film on a wall spreads down by `h = √(μ x / (ρ g t))` to where all of its volume is, in the mean at 3/5 of
    /// `(9 A² ρ g t / (4 μ))^{1/3}` with the volume `A` for each width (Huppert 1982): the nearer the finer the triangles are.
    #[test]
    fn films_run_down_walls() {
        let (length, width) = (0.2, 0.01);
        let started = 0.02;
        let thickness = 2e-4;
        let off = |cells: u32| {
            let mut plate = Plate::new(length, width, cells);
            let start = |point: &Vec3| if -point.y <= started { thickness } else { 0.0 };
            let mut film: Vec<f64> = plate.points.iter().map(start).collect();
            let volume = plate.volume(&film);
            let (step, steps) = (2e-3, 1000);
            (0..steps).for_each(|_| plate.run(&mut film, &LAW, -Vec3::Y * G, step));
            assert!((plate.volume(&film) / volume - 1.0).abs() < 1e-12);
            let time = step * f64::from(steps);
            let across = volume / width;
            let front = libm::cbrt(2.25 * across * across * DENSITY * G * time / LAW.viscosity);
            assert!(front < length);
            plate.depth(&film) / (0.6 * front) - 1.0
        };
        let errors = [40, 80, 160].map(off);
        // upwind is first order, but for a logarithm where the film begins
        assert!(errors.windows(2).all(|pair| (0.5..0.67).contains(&(pair[1] / pair[0]))), "{errors:?}");
        assert!(errors[2].abs() < 0.04, "{errors:?}");
    }

    /// What clings stays, and what runs on it at the upper edge, where nothing comes from above, thins by `dr/dt = -C r³`: `1/r²` grows
    /// evenly. What hangs falls off beyond the capillary length of 2.3 mm.
    #[test]
    fn films_cling_and_drop() {
        let law = BleedingLaw { clinging: 5e-5, ..LAW };
        let mut plate = Plate::new(0.02, 0.01, 8);
        let mut film = vec![1e-4; plate.points.len()];
        let volume = plate.volume(&film);
        let thinned = |film: &[f64]| (film[1] - 5e-5).powi(-2) - 5e-5_f64.powi(-2);
        (0..1000).for_each(|_| plate.run(&mut film, &law, -Vec3::Y * G, 5e-3));
        let early = thinned(&film);
        (0..3000).for_each(|_| plate.run(&mut film, &law, -Vec3::Y * G, 5e-3));
        // steps that begin with the thickest film thin it too fast by less than a third of what they move of it, at the start alone
        assert!((thinned(&film) / early / 4.0 - 1.0).abs() < 0.01, "{}", thinned(&film) / early);
        assert!(film.iter().all(|film| *film >= 5e-5), "{film:?}");
        assert!((plate.volume(&film) / volume - 1.0).abs() < 1e-12);
        // level, and turned over
        let flat = film.clone();
        plate.run(&mut film, &law, Vec3::Z * -G, 1e-2);
        assert_eq!(film, flat);
        let mut thick = vec![5e-3; film.len()];
        plate.run(&mut thick, &law, Vec3::Z * G, 1e-2);
        let most = (SURFACE_TENSION / (DENSITY * G)).sqrt();
        assert!(thick.iter().all(|film| (film - most).abs() < 1e-15), "{thick:?}");
        assert!((most - 2.32e-3).abs() < 1e-5);
    }

    /// What a wound gives in all is `rate o τ_c`, and until then `1 - exp(-t/τ_c)` of it, in however many steps; what lies there dries
    /// as `exp(-t/τ_d)`.
    #[test]
    fn wounds_clot_and_blood_dries() {
        for steps in [1, 10, 300] {
            let (mut open, step) = (1.0, 3.0 / f64::from(steps));
            let volume: f64 = (0..steps).map(|_| LAW.let_out(&mut open, step)).sum();
            let clotted = 1.0 - libm::exp(-1.5);
            assert!((volume / (1e-4 * 2.0 * clotted) - 1.0).abs() < 1e-12, "{volume}");
            assert!((open - libm::exp(-1.5)).abs() < 1e-13);
            let dried = (0..steps).fold(1e-4, |film, _| LAW.dried(film, step));
            assert!((dried / (1e-4 * libm::exp(-0.1)) - 1.0).abs() < 1e-12);
        }
    }

    /// In steps as long as one may think of nothing is lost from a surface that faces up, and nothing goes below zero.
    #[test]
    fn long_steps_lose_nothing() {
        let mut plate = Plate::new(0.1, 0.01, 30);
        let mut film: Vec<f64> = (0..plate.points.len()).map(|node| 1e-3 * ((node * 7) % 5) as f64).collect();
        let volume = plate.volume(&film);
        for _ in 0..50 {
            plate.run(&mut film, &LAW, Vec3::new(3.0, -9.0, -1.0), 10.0);
            assert!(film.iter().all(|film| *film >= 0.0));
        }
        assert!((plate.volume(&film) / volume - 1.0).abs() < 1e-12);
    }
}
