//! What is in a person's hand: a place comes in, a force goes out. Adding a device is an entry of [`DEVICES`].

use std::sync::Arc;

use souple_engine::Motion;
use souple_math::Vec3;
use souple_table::{Entry, Parameter, Range, Table, Value, Values};

use crate::arm::Arm;
use crate::emulated::EmulatedHand;

/// A device in use.
pub trait Device: Send {
    /// Gives the device a force [N] for the tick that begins, and tells where it is, from where it started [m]; `None` while it
    /// is lost. It does not wait.
    fn exchange(&mut self, force: Vec3) -> Option<Vec3>;
}

/// A device as a scene names it.
#[derive(Clone, Debug)]
pub enum DeviceChoice {
    Emulated(Arm),
}

impl DeviceChoice {
    /// The arm that stands for a person in runs without a clock.
    pub fn arm(&self) -> Option<&Arm> {
        match self {
            Self::Emulated(arm) => Some(arm),
        }
    }

    /// Opens the device.
    ///
    /// # Errors
    /// It is not there; says why.
    pub fn open(&self) -> Result<Box<dyn Device>, String> {
        match self {
            Self::Emulated(arm) => Ok(Box::new(EmulatedHand::new(arm.clone()))),
        }
    }
}

/// Makes a choice of completed values and of what the hand means to do.
pub type ChooseDevice = fn(&Values, Arc<dyn Motion>) -> DeviceChoice;

pub type Devices = Table<ChooseDevice>;

/// All devices.
pub static DEVICES: Devices = Table { kind: "device", entries: &[&EMULATED] };

static EMULATED: Entry<ChooseDevice> = Entry {
    name: "emulated",
    summary: "a person's arm as mass, spring, damper and late reflexes, which means to move as `motion` says",
    source: "Hogan 1985",
    parameters: &[
        Parameter::number("mass", "kg", Range::POSITIVE, "of hand and device at the grip")
            .or(Value::Number(0.4)),
        Parameter::number("stiffness", "N/m", Range::NOT_NEGATIVE, "of tensed muscles")
            .or(Value::Number(300.0)),
        Parameter::number("damping", "N s/m", Range::NOT_NEGATIVE, "of the arm").or(Value::Number(8.0)),
        Parameter::number("reflex", "N/m", Range::NOT_NEGATIVE, "stiffness that reflexes add, late")
            .or(Value::Number(50.0)),
        Parameter::number("delay", "s", Range::closed(1e-3, 1.0), "after which reflexes act")
            .or(Value::Number(0.06)),
        Parameter::number("lost_at", "s", Range::NOT_NEGATIVE, "when the device is lost")
            .or(Value::Number(0.0)),
        Parameter::number("lost_for", "s", Range::NOT_NEGATIVE, "for how long it is lost")
            .or(Value::Number(0.0)),
    ],
    build: |values, intent| {
        DeviceChoice::Emulated(Arm {
            mass: values.number("mass"),
            stiffness: values.number("stiffness"),
            damping: values.number("damping"),
            reflex: values.number("reflex"),
            delay: values.number("delay"),
            lost: (values.number("lost_at"), values.number("lost_for")),
            intent,
        })
    },
};
