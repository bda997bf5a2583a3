//! (g) A field steps its own grid in State and pushes points through an ordinary force.

use std::any::Any;

use souple_engine::state::Pair;
use souple_engine::{
    CommittedRows, Configuration, Declaration, Energy, Field, FieldState, FieldStep, Force, Model, Scratch,
    State, StepError, TangentWeights, World,
};
use souple_math::Vec3;
use souple_solve::BlockMatrix;

use super::{points, stepper};

/// A pressure on three cells along x that rises where the point is.
struct Pressure;

impl Field for Pressure {
    fn name(&self) -> &str {
        "pressure"
    }
    fn step(
        &self,
        rows: CommittedRows,
        step: &FieldStep,
        field: &mut FieldState,
        _: &mut Scratch,
    ) -> Result<(), StepError> {
        let cell = (rows.of(0).positions[0].x.clamp(0.0, 2.0)) as usize;
        field.values[cell] += step.timestep;
        field.indices[0] = cell as u64;
        Ok(())
    }
}

/// Pushes the point by the pressure of its cell, as committed.
struct Follow;

impl Force for Follow {
    fn name(&self) -> &str {
        "follow"
    }
    fn declaration(&self) -> Declaration {
        Declaration { conservative: false, ..Declaration::LOAD }
    }
    fn energy(&self, _: &Configuration, _: &mut Scratch) -> Energy {
        Energy::default()
    }
    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        out[0].x += at.fields[0].values[at.fields[0].indices[0] as usize];
    }
    fn add_differential(
        &self,
        _: &Configuration,
        _: TangentWeights,
        _: &[Vec3],
        _: &mut Scratch,
        _: &mut [Vec3],
    ) {
    }
    fn visit_cliques(&self, _: &[Pair], _: &mut dyn FnMut(&[u32])) {}
    fn add_blocks(&self, _: &Configuration, _: TangentWeights, _: &mut Scratch, _: &mut BlockMatrix) {}
    fn as_any(&self) -> &dyn Any {
        self
    }
}

fn start() -> World {
    let (system, q) = points(&[Vec3::ZERO], &[1.0], vec![Box::new(Follow)], stepper("symplectic_euler"));
    let field = FieldState { values: vec![0.0; 3], indices: vec![0] };
    let state = State { systems: vec![system.initial_state(q)], fields: vec![field], ..State::default() };
    Model { period: 0.1, systems: vec![system], fields: vec![Box::new(Pressure)], ..Model::default() }
        .start(state)
}

/// The point feels the pressure of the last commit: `v_n = h Σ p_k` with `p_k = k h`, so `v_n = h² n(n-1)/2`
/// while it stays in its cell; the field's part of State is saved and resumed with the rest.
#[test]
fn a_field_pushes_points() {
    let mut world = start();
    (0..10).for_each(|_| world.step().unwrap());
    let v = world.state().systems[0].v[0].x;
    assert!((v - 0.01 * 45.0).abs() < 1e-15, "{v}");
    let saved = world.state().to_bytes();
    (0..20).for_each(|_| world.step().unwrap());
    let mut resumed = start();
    resumed.resume(State::from_bytes(&saved).unwrap()).unwrap();
    (0..20).for_each(|_| resumed.step().unwrap());
    assert_eq!(resumed.state().hash(), world.state().hash());
}

/// A field of other sizes than the model's own is refused by name.
#[test]
fn foreign_fields_are_refused() {
    let (system, q) = points(&[Vec3::ZERO], &[1.0], vec![Box::new(Follow)], stepper("symplectic_euler"));
    let field = FieldState { values: vec![0.0; 3], indices: vec![0] };
    let state = State { systems: vec![system.initial_state(q)], fields: vec![field], ..State::default() };
    let model =
        Model { period: 0.1, systems: vec![system], fields: vec![Box::new(Pressure)], ..Model::default() };
    let mut world = model.start(state.clone());
    let mut short = state.clone();
    short.fields[0].values.pop();
    let error = world.resume(short).unwrap_err().to_string();
    assert!(error.contains("fields[0]") && error.contains("`pressure`"), "{error}");
    let mut none = state;
    none.fields.clear();
    let error = world.resume(none).unwrap_err().to_string();
    assert!(error.contains("0 fields"), "{error}");
}
