//! What is in a person's hand: a place comes in, a force goes out. Adding a device is an entry of [`DEVICES`].

use std::sync::Arc;

use souple_engine::Motion;
use souple_math::Vec3;
use souple_table::{Entry, Parameter, Range, Table, Value, Values};

use crate::arm::Arm;
use crate::emulated::EmulatedHand;
use crate::osc::OscDevice;

/// A device in use.
pub trait Device: Send {
    /// Where it is at the end of the tick that it has lived through, under the force that it was given last, from where it started [m];
    /// `None` while it is lost. It does not wait.
    fn place(&mut self) -> Option<Vec3>;

    /// Gives the device a force [N] for the tick that begins, and for those after it until it is given another. It does not wait.
    fn give(&mut self, force: Vec3);

    /// What it has said so far that made no sense.
    fn refused(&self) -> u64 {
        0
    }
}

/// A device as a scene names it.
#[derive(Clone, Debug)]
pub enum DeviceChoice {
    Emulated(Arm),
    /// Heard on a port of this machine, enlarged; lost after so many seconds of silence.
    Osc {
        port: u16,
        scale: f64,
        patience: f64,
    },
}

impl DeviceChoice {
    /// The arm that stands for a person in runs without a clock.
    pub fn arm(&self) -> Option<&Arm> {
        match self {
            Self::Emulated(arm) => Some(arm),
            Self::Osc { .. } => None,
        }
    }

    /// Opens the device.
    ///
    /// # Errors
    /// It is not there; says why.
    pub fn open(&self) -> Result<Box<dyn Device>, String> {
        match self {
            Self::Emulated(arm) => Ok(Box::new(EmulatedHand::new(arm.clone()))),
            Self::Osc { port, scale, patience } => {
                let device = OscDevice::open(*port, *scale, *patience);
                let device = device.map_err(|error| format!("port {port} of this machine: {error}"))?;
                Ok(Box::new(device))
            }
        }
    }
}

/// Makes a choice of completed values and of what the hand means to do.
pub type ChooseDevice = fn(&Values, Arc<dyn Motion>) -> DeviceChoice;

pub type Devices = Table<ChooseDevice>;

/// All devices.
pub static DEVICES: Devices = Table { kind: "device", entries: &[&EMULATED, &OSC] };

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
        Parameter::number(
            "lost_at",
            "s",
            Range::NOT_NEGATIVE,
            "when the device is lost; 0 with `lost_for`: from the start, without it never",
        )
        .or(Value::Number(0.0)),
        Parameter::number(
            "lost_for",
            "s",
            Range::NOT_NEGATIVE,
            "for how long it is lost; 0 with `lost_at`: to the end",
        )
        .or(Value::Number(0.0)),
    ],
    build: |values, intent| {
        DeviceChoice::Emulated(Arm {
            mass: values.number("mass"),
            stiffness: values.number("stiffness"),
            damping: values.number("damping"),
            reflex: values.number("reflex"),
            delay: values.number("delay"),
            lost: lost(values.number("lost_at"), values.number("lost_for")),
            intent,
        })
    },
};

/// From when the device is lost, and for how long [s]: who says when alone means from then on.
fn lost(at: f64, duration: f64) -> (f64, f64) {
    (at, if at > 0.0 && duration == 0.0 { f64::INFINITY } else { duration })
}

static OSC: Entry<ChooseDevice> = Entry {
    name: "osc",
    summary: "Open Sound Control over UDP on this machine: places come in, forces go out; for drivers of real devices",
    source: "Wright 2002, Open Sound Control 1.0",
    parameters: &[
        Parameter::integer("port", Range::closed(1.0, 65535.0), "where it is heard").or(Value::Integer(7879)),
        Parameter::number("scale", "", Range::POSITIVE, "motion in the world over motion of the device")
            .or(Value::Number(1.0)),
        Parameter::number("patience", "s", Range::POSITIVE, "silence after which the device is lost")
            .or(Value::Number(0.1)),
    ],
    build: |values, _| DeviceChoice::Osc {
        port: values.integer("port") as u16,
        scale: values.number("scale"),
        patience: values.number("patience"),
    },
};
