//! Speed of links on a cubic lattice: `cargo run --release --example link_speed`.
use std::time::Instant;

use souple_engine::steppers::TABLE;
use souple_engine::{Kinematics, Mass, Model, State, System, UnknownKind};
use souple_math::Vec3;
use souple_models::network::laws::LINKS;
use souple_models::network::{Account, LinkDescription, Links, Making, Span};
use souple_table::{Value, Values};

/// CPU seconds of this thread, where the system tells.
fn thread_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|number| number.parse::<f64>().ok()).map_or(f64::NAN, |ns| ns * 1e-9)
}

fn main() {
    for n in [30, 32, 70] {
        let place = |i: usize| Vec3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64);
        let points: Vec<Vec3> = (0..n * n * n).map(place).collect();
        let mut ends = Vec::new();
        for i in 0..points.len() {
            let steps = [1, n, n * n].into_iter().zip(points[i].to_array());
            ends.extend(
                steps.filter(|(_, at)| *at < (n - 1) as f64).map(|(step, _)| [i as u32, (i + step) as u32]),
            );
        }
        let timestep = 1e-3;
        let entry = LINKS.find("spring_damper").unwrap();
        let values =
            Values::new().with("stiffness", Value::Number(1000.0)).with("damping", Value::Number(0.1));
        let values = entry.values(values).unwrap();
        let law =
            (entry.build)(&Making { values: &values, timestep, span: Span::Distance, driven: &[] }).unwrap();
        let force = Links::new(LinkDescription {
            name: "lattice".into(),
            law: law.into(),
            ends: &ends,
            span: Span::Distance,
            rest_lengths: &vec![1.0; ends.len()],
            lengths: &vec![1.0; ends.len()],
            timestep,
            account: Account::None,
        });
        let mut kinematics = Kinematics::default();
        kinematics.add_unknowns(UnknownKind::Point, points.len());
        let mut mass = Mass::new(points.len());
        mass.diagonal.fill(1.0);
        let stepper = TABLE.find("t_simulation").unwrap();
        let system = System {
            name: "main".into(),
            kinematics,
            mass,
            forces: vec![Box::new(force)],
            constraints: vec![],
            stepper: (stepper.build)(&stepper.values(Values::new()).unwrap()),
            steps_per_period: 10,
        };
        let wave = |x: &Vec3| *x + Vec3::new(0.1 * x.y.sin(), 0.1 * x.z.sin(), 0.1 * x.x.sin());
        let state = system.initial_state(points.iter().map(wave).collect());
        let model = Model { period: 10.0 * timestep, systems: vec![system], ..Model::default() };
        let mut world = model.start(State { systems: vec![state], ..State::default() });
        world.step().unwrap();
        let (mut best, mut best_cpu) = (f64::INFINITY, f64::INFINITY);
        let before = world.stages();
        for _ in 0..10 {
            let (clock, cpu) = (Instant::now(), thread_seconds());
            world.step().unwrap();
            best = best.min(clock.elapsed().as_secs_f64() / 10.0);
            best_cpu = best_cpu.min((thread_seconds() - cpu) / 10.0);
        }
        let after = world.stages();
        println!(
            "{} links: {:.1} M links/s ({:.1} by CPU time of one thread), {:.3} ms a step; forces {:.3}, rest {:.3} ms",
            ends.len(),
            1e-6 * ends.len() as f64 / best,
            1e-6 * ends.len() as f64 / best_cpu,
            1e3 * best,
            10.0 * (after.forces - before.forces),
            10.0 * (after.advance - before.advance)
        );
    }
}
