//! (e) Two systems at 1:17 that exchange impulses over a coupling spring.

use souple_engine::coupling::{CouplingSpring, DRIVEN_LEN};
use souple_engine::{Model, State};
use souple_math::Vec3;

use super::{points, stepper};

/// Momentum is exchanged exactly, one period late: at every meeting the two momenta and the impulse still
/// to be delivered sum to nothing.
#[test]
fn impulses_are_exchanged_exactly() {
    let period = 17e-3;
    let spring = CouplingSpring {
        name: "tie".into(),
        fast_system: 0,
        fast_row: 0,
        slow_system: 1,
        slow_row: 0,
        stiffness: 40.0,
        damping: 2.0,
        driven: 0,
    };
    assert!(spring.forecast(period).is_none(), "2 N s/m outweigh k H / 2 = 0.34");
    assert!(spring.forecast(1.0).is_some());
    let (mut fast, fast_q) =
        points(&[Vec3::ZERO], &[0.2], vec![spring.fast_end()], stepper("symplectic_euler"));
    let (slow, slow_q) = points(&[Vec3::X], &[1.0], vec![spring.slow_end()], stepper("backward_euler"));
    fast.steps_per_period = 17;
    let systems = vec![fast.initial_state(fast_q), slow.initial_state(slow_q)];
    let state = State { systems, driven: vec![0.0; DRIVEN_LEN], ..State::default() };
    let model = Model { period, systems: vec![fast, slow], couplings: vec![spring], ..Model::default() };
    let mut world = model.start(state);
    let start = 0.5 * 40.0; // k |x|²/2 of the spring stretched by 1 m
    let mut largest_energy: f64 = 0.0;
    for _ in 0..600 {
        world.step().unwrap();
        let driven = &world.state().driven;
        let (momentum, _) = world.momentum();
        let pending = Vec3::new(driven[7], driven[8], driven[9]) * period;
        // ten thousand additions of impulses of at most 1 N s
        assert!((momentum + pending).length() < 1e-12, "{momentum:?} {pending:?}");
        largest_energy = largest_energy.max(world.energy().total());
    }
    let end = world.energy().total();
    assert!(
        largest_energy < 1.01 * start && end < 0.05 * start,
        "{start} J, at most {largest_energy} J, {end} J left"
    );
    let fast = world.rows(0).positions[0];
    let made = world.model().couplings[0].energy_made(world.state(), fast, world.time());
    let reported = &world.energy().made_by_coupling;
    assert!(matches!(&reported[..], [(_, energy)] if *energy == made), "{reported:?} for {made}");
    // the delay feeds k H / 2 = 0.34 N s/m against a damping of 2: a sixth of what is dissipated at most
    assert!(made > 0.0 && made < start * 0.34 / 2.0, "energy made by the delay: {made} J of {start} J");
}
