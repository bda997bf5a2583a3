//! A hand as memory of the world: arm, port and tool move together, in the time of the world.
//!
//! The tool is a mass that the coupling draws to the device and that bodies push back. Where a person is at a device of flesh
//! and steel, the loop of that device leads it instead ([`Carrier::lead`]), and the same tool follows.

use std::sync::Arc;

use souple_engine::{Editable, InHand, Motion, ParameterError};
use souple_math::{Mat3, Vec3};
use souple_models::contact::{Carrier, Pressed};
use souple_models::loads::{Pose, RigidMotion};

use crate::TICK;
use crate::arm::{Arm, ArmState};
use crate::coupling::Moving;
use crate::port::{Port, PortState};

/// What a hand is beside its device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    pub port: Port,
    /// Of the tool [kg].
    pub mass: f64,
    /// A world period [s].
    pub period: f64,
    /// Whether the hand feels the tool where it was when the period began, or what it felt then.
    pub is_held: bool,
    pub weight: Weight,
}

/// What of the tool's mass the hand feels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// All of it: who speeds the tool up pulls at it.
    Felt,
    /// None: the tool is sped up as the device is, by as much as the device could draw it with.
    Unfelt,
}

/// A hand with a tool.
#[derive(Clone, Debug)]
pub struct HandCarrier {
    rest: Rest,
    /// The emulated arm; `None`: a device that only lives with its loop.
    arm: Option<Arm>,
    /// Where the loop of a device leads it to, as soon as it does [m].
    led: Option<Vec3>,
    /// Whether the loop has its device.
    is_held: bool,
    /// Where device and tool are at the start [m].
    start: Vec3,
}

/// All that evolves, but for what reflexes remember.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct HandState {
    arm: ArmState,
    tool: Moving,
    port: PortState,
    /// Since the last tick [s].
    since_tick: f64,
    /// Of what a force says of the body when the next one takes its place, at most so far [s].
    age: f64,
    /// Where the tool was when the period began [m]; of a tool that holds points, what it felt then [N].
    held: Vec3,
    /// Of the device, where it moved last [m/s²].
    acceleration: Vec3,
}

/// Numbers of a [`HandState`].
const LEN: usize = 31;
/// A tick that lacks this part of it is over: times are sums.
const ROUNDING: f64 = 1e-9;
/// So near to the beginning of a period it begins [s]: times are sums.
const AT_BEGINNING: f64 = 0.01 * TICK;
/// The name of the parameter that tells whether a device is there.
const HELD: &str = "held";

impl HandState {
    fn read(numbers: &[f64]) -> Self {
        let vector = |at: usize| Vec3::new(numbers[at], numbers[at + 1], numbers[at + 2]);
        let moving = |at: usize| Moving { place: vector(at), velocity: vector(at + 3) };
        Self {
            arm: ArmState { hand: moving(0), time: numbers[6], ticks: numbers[7] as u64 },
            tool: moving(8),
            port: PortState {
                place: vector(14),
                force: vector(17),
                energy: numbers[20],
                engaged: numbers[21],
                jump: numbers[22],
            },
            since_tick: numbers[23],
            age: numbers[24],
            held: vector(25),
            acceleration: vector(28),
        }
    }

    fn write(&self, numbers: &mut [f64]) {
        let mut at = 0;
        let mut put = |values: &[f64]| {
            numbers[at..at + values.len()].copy_from_slice(values);
            at += values.len();
        };
        let Self { arm, tool, port, since_tick, age, held, acceleration } = self;
        for moving in [arm.hand.place, arm.hand.velocity] {
            put(&moving.to_array());
        }
        put(&[arm.time, arm.ticks as f64]);
        for vector in [tool.place, tool.velocity, port.place, port.force] {
            put(&vector.to_array());
        }
        put(&[port.energy, port.engaged, port.jump, *since_tick, *age]);
        put(&held.to_array());
        put(&acceleration.to_array());
    }
}

impl HandCarrier {
    pub fn new(rest: Rest, arm: Option<Arm>) -> Self {
        Self { rest, arm, led: None, is_held: true, start: Vec3::ZERO }
    }

    /// With device and tool at a place, where the device stays until it is led elsewhere.
    pub fn starting_at(self, place: Vec3) -> Self {
        Self { led: Some(place), start: place, ..self }
    }

    /// Whether somebody is at the device.
    fn has_device(&self, state: &HandState) -> bool {
        let led = self.led.is_some() && self.is_held;
        led || (self.led.is_none() && self.arm.as_ref().is_some_and(|arm| !arm.is_lost(state.arm.time)))
    }

    /// Whether a time is the first of a period, to rounding.
    fn begins_period(&self, time: f64) -> bool {
        let (into, period) = (time / self.rest.period, self.rest.period);
        (into - into.round()).abs() * period < AT_BEGINNING
    }

    /// The device moves on: led evenly to where it is to be at the end of the period, or held by the arm.
    fn move_device(&self, h: f64, history: &[f64], state: &mut HandState) {
        let before = state.arm.hand.velocity;
        if let Some(place) = self.led {
            let period = self.rest.period;
            let into = state.arm.time / period;
            let left = (into.floor() + 1.0 - into) * period;
            // times are sums: less than half a step before its end the next period is meant
            let left = if left < 0.5 * h { period } else { left };
            let velocity = (place - state.arm.hand.place) / left.max(h);
            state.arm.hand = Moving { place: state.arm.hand.place + velocity * h, velocity };
            state.arm.time += h;
        } else if let Some(arm) = &self.arm {
            let force = if arm.is_lost(state.arm.time) { Vec3::ZERO } else { state.port.force };
            arm.advance(force, h, history, &mut state.arm);
        } else {
            state.arm.time += h;
        }
        state.acceleration = (state.arm.hand.velocity - before) / h;
    }

    /// The tool moves on between what presses on it and what draws it: implicit in both, along its own motion.
    fn move_tool(&self, h: f64, pressed: &Pressed, state: &mut HandState) {
        let (coupling, engaged) = (self.rest.port.coupling, state.port.engaged);
        let Moving { place, velocity } = state.tool;
        let pull = match self.rest.weight {
            Weight::Felt => coupling.pull(state.arm.hand, state.tool),
            // sped up as the device is, and drawn to where that will be when the tool has moved, as fast as it will be: the spring does neither
            Weight::Unfelt => {
                let Moving { place, velocity } = state.arm.hand;
                let velocity = velocity + state.acceleration * h;
                let ahead = Moving { place: place + velocity * h, velocity };
                coupling.pull(ahead, state.tool) + state.acceleration * self.rest.mass
            }
        };
        let pull = pull * engaged;
        let mut carried = self.rest.mass + h * h * pressed.stiffness;
        let mut impulse = velocity * self.rest.mass + pressed.force * h;
        if !self.has_device(state) {
            // let go of, it is braked as the coupling would brake it, and rests wherever it comes to lie
            carried += h * coupling.damping;
        } else if pull.length() > coupling.limit {
            impulse += coupling.limited(pull) * h;
        } else {
            carried += h * engaged * (coupling.damping + h * coupling.stiffness);
            impulse += (pull + velocity * (coupling.damping * engaged)) * h;
        }
        let velocity = impulse / carried;
        state.tool = Moving { place: place + velocity * h, velocity };
    }
}

/// What the device is told at a tick.
enum Feeling {
    /// Where its tool is, to which it is coupled.
    Tool(Moving),
    /// The force itself [N].
    Force(Vec3),
}

impl HandCarrier {
    /// Moves arm and tool on in parts of a tick at most, and tells the device at each tick what it feels.
    fn tick_through(
        &self,
        told: f64,
        timestep: f64,
        memory: &mut [f64],
        move_on: &mut dyn FnMut(f64, &mut [f64], &mut HandState) -> Feeling,
    ) {
        let mut left = timestep;
        while left > ROUNDING * TICK {
            let mut state = HandState::read(memory);
            let h = left.min(TICK - state.since_tick);
            let feeling = move_on(h, memory, &mut state);
            state.since_tick += h;
            left -= h;
            if state.since_tick >= TICK * (1.0 - ROUNDING) {
                state.since_tick = 0.0;
                let device = self.has_device(&state).then_some(state.arm.hand.place);
                match feeling {
                    Feeling::Tool(tool) => self.rest.port.tick(&mut state.port, device, TICK, tool),
                    Feeling::Force(force) => {
                        self.rest.port.tick_with(&mut state.port, device, TICK, force);
                    }
                }
                // what an implicit step tells is of its own end
                state.age = state.age.max((state.arm.time - told).max(0.0) + TICK);
                if let Some(arm) = &self.arm {
                    arm.tick(&mut memory[LEN..], &mut state.arm);
                }
            }
            state.write(&mut memory[..LEN]);
        }
    }
}

impl Carrier for HandCarrier {
    fn memory_len(&self) -> usize {
        LEN + self.arm.as_ref().map_or(0, Arm::history_len)
    }

    fn initial_memory(&self, memory: &mut [f64]) {
        memory.fill(0.0);
        let still = Moving { place: self.start, velocity: Vec3::ZERO };
        let state = HandState {
            arm: ArmState { hand: still, ..ArmState::default() },
            tool: still,
            port: PortState { place: self.start, ..Port::start() },
            ..HandState::default()
        };
        state.write(&mut memory[..LEN]);
    }

    fn pose(&self, memory: &[f64]) -> Pose {
        let Moving { place, velocity } = HandState::read(memory).tool;
        Pose {
            origin: place,
            turn: Mat3::IDENTITY,
            pivot: Vec3::ZERO,
            velocity,
            angular_velocity: Vec3::ZERO,
        }
    }

    fn advance(&self, pressed: &dyn Fn(&Pose) -> Pressed, told: f64, timestep: f64, memory: &mut [f64]) {
        self.tick_through(told, timestep, memory, &mut |h, memory, state| {
            if self.begins_period(state.arm.time) {
                state.held = state.tool.place;
            }
            let pressed = pressed(&self.pose(memory));
            self.move_tool(h, &pressed, state);
            self.move_device(h, &memory[LEN..], state);
            Feeling::Tool(if self.rest.is_held {
                Moving { place: state.held, velocity: Vec3::ZERO }
            } else {
                state.tool
            })
        });
    }

    fn advance_held(&self, felt: Vec3, told: f64, timestep: f64, memory: &mut [f64]) {
        self.tick_through(told, timestep, memory, &mut |h, memory, state| {
            if self.begins_period(state.arm.time) {
                state.held = felt;
            }
            self.move_device(h, &memory[LEN..], state);
            // a device that is lost leaves its tool where it was
            if self.has_device(state) {
                state.tool = state.arm.hand;
            } else {
                state.tool.velocity = Vec3::ZERO;
            }
            Feeling::Force(if self.rest.is_held { state.held } else { felt })
        });
    }

    fn lead(&mut self, place: Vec3) {
        self.led = Some(place);
    }

    fn planned(&self) -> Option<Arc<dyn Motion>> {
        match (&self.arm, self.led) {
            (Some(arm), _) => Some(arm.intent.clone()),
            (None, led) => Some(Arc::new(RigidMotion::at(led?))),
        }
    }

    fn in_hand(&self, memory: &[f64]) -> InHand {
        let HandState { arm, tool, port, age, .. } = HandState::read(memory);
        InHand {
            device: arm.hand.place,
            tool: tool.place,
            tool_velocity: tool.velocity,
            felt: Vec3::ZERO,
            force: port.force,
            energy: port.energy,
            jump: port.jump,
            age,
        }
    }

    fn editable(&self) -> Vec<Editable> {
        vec![Editable { name: HELD, unit: "", value: f64::from(u8::from(self.is_held)) }]
    }

    fn set_parameter(&mut self, force: &str, name: &str, value: f64) -> Result<(), ParameterError> {
        let (force, name) = (force.to_owned(), name.to_owned());
        if name != HELD {
            return Err(ParameterError::Unknown { force, name, known: vec![HELD.to_owned()] });
        }
        if value != 0.0 && value != 1.0 {
            let expected = "0 of a device that is lost, 1 of one that is there".to_owned();
            return Err(ParameterError::Unfit { force, name, value, expected });
        }
        self.is_held = value == 1.0;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coupling::Coupling;

    const PERIOD: f64 = 1e-3;
    const SWING: f64 = 0.03;
    const OMEGA: f64 = std::f64::consts::TAU / 0.6;

    /// The most that a hand feels which swings a tool in the air for two seconds, from rest, and in the second of these [N].
    fn felt_in_the_air(mass: f64, weight: Weight) -> [f64; 2] {
        let port = Port { coupling: Coupling::DEFAULT, passive: false };
        let rest = Rest { port, mass, period: PERIOD, is_held: false, weight };
        let mut carrier = HandCarrier::new(rest, None).starting_at(Vec3::Y);
        let mut memory = vec![0.0; carrier.memory_len()];
        carrier.initial_memory(&mut memory);
        let mut most = [0.0_f64; 2];
        for period in 1..=2000 {
            let end = f64::from(period) * PERIOD;
            carrier.lead(Vec3::Y + Vec3::X * (SWING * (1.0 - (OMEGA * end).cos())));
            carrier.advance(&|_| Pressed::default(), end - PERIOD, PERIOD, &mut memory);
            let force = carrier.in_hand(&memory).force.length();
            most = [most[0].max(force), if period > 1000 { most[1].max(force) } else { 0.0 }];
        }
        let [tool, device] = [carrier.in_hand(&memory).tool, carrier.in_hand(&memory).device];
        assert!((tool - device).length() < 1e-3, "{tool:?} {device:?}");
        most
    }

    /// Who swings a tool in the air feels `m a`, the drag `k T v` of a spring that is a tick behind, and more until what the start set swinging is damped; one whose mass is not felt feels what a
    /// tick's delay of the acceleration comes to: a speed `a T` that spring and damper stop, with `(√(k m) + c) a T` at most.
    #[test]
    fn masses_may_be_unfelt() {
        let acceleration = SWING * OMEGA * OMEGA;
        for mass in [0.05, 0.005] {
            let [felt, _] = felt_in_the_air(mass, Weight::Felt);
            let drag = Coupling::DEFAULT.stiffness * TICK * SWING * OMEGA;
            assert!(felt >= mass * acceleration && felt < 2.0 * mass * acceleration + drag, "{mass}: {felt}");
            let impedance = (Coupling::DEFAULT.stiffness * mass).sqrt() + Coupling::DEFAULT.damping;
            let [unfelt, later] = felt_in_the_air(mass, Weight::Unfelt);
            assert!(unfelt <= impedance * acceleration * TICK, "{mass}: {unfelt}");
            // then what the acceleration gains in the tick for which it is taken, of the mass and of what the damper takes for one
            let taken = mass + Coupling::DEFAULT.damping * TICK;
            assert!(later <= 2.0 * taken * acceleration * OMEGA * TICK, "{mass}: {later}");
        }
    }

    /// Led evenly the device moves evenly, however long it has been: its time is a sum, and the beginnings of periods are not to be
    /// missed.
    #[test]
    fn devices_are_led_evenly() {
        const PERIOD: f64 = 1e-2;
        const SPEED: f64 = 0.4;
        let port = Port { coupling: Coupling::DEFAULT, passive: true };
        let rest = Rest { port, mass: 0.05, period: PERIOD, is_held: false, weight: Weight::Felt };
        // as steps of a world of one rate, and in ticks of bodies with levels
        for steps in [1, 256] {
            let mut carrier = HandCarrier::new(rest, None).starting_at(Vec3::ZERO);
            let mut memory = vec![0.0; carrier.memory_len()];
            carrier.initial_memory(&mut memory);
            for period in 1..=12_000 {
                carrier.lead(Vec3::X * (SPEED * PERIOD * f64::from(period)));
                for step in 0..steps {
                    let told = PERIOD * (f64::from(period - 1) + f64::from(step) / f64::from(steps));
                    carrier.advance(&|_| Pressed::default(), told, PERIOD / f64::from(steps), &mut memory);
                    let velocity = HandState::read(&memory).arm.hand.velocity.x;
                    // three million steps: the rounding of their sum over 120 s is a thousandth of one
                    assert!((velocity - SPEED).abs() < 1e-3 * SPEED, "{steps}, period {period}: {velocity}");
                }
            }
        }
    }

    /// A device that leaps draws its tool with no more than it gives, whether the mass is felt or not.
    #[test]
    fn leaps_are_limited() {
        for weight in [Weight::Felt, Weight::Unfelt] {
            let port = Port { coupling: Coupling::DEFAULT, passive: true };
            let rest = Rest { port, mass: 0.05, period: PERIOD, is_held: false, weight };
            let mut carrier = HandCarrier::new(rest, None).starting_at(Vec3::ZERO);
            let mut memory = vec![0.0; carrier.memory_len()];
            carrier.initial_memory(&mut memory);
            carrier.lead(Vec3::X);
            for period in 0..10 {
                let before = carrier.in_hand(&memory).tool_velocity;
                carrier.advance(&|_| Pressed::default(), f64::from(period) * PERIOD, PERIOD, &mut memory);
                let gained = (carrier.in_hand(&memory).tool_velocity - before).length();
                assert!(
                    gained <= Coupling::DEFAULT.limit * PERIOD / 0.05 * (1.0 + 1e-9),
                    "{weight:?} {gained}"
                );
            }
        }
    }
}
