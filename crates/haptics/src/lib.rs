//! Hands that feel: what stands between a person's hand and a tool in the world.
//!
//! The device and the tool are two things, joined by a spring and a damper ([`Coupling`]): the hand feels that spring, whatever
//! the world does and however seldom it steps. Every millisecond the [`Port`] gives the device a force, and watches that no more
//! energy comes out of it than went in. An [`Arm`] stands for a person where there is no device; it is memory of the world then,
//! and its runs repeat bit for bit. [`DEVICES`] lists what may be at the other end.

mod arm;
mod carrier;
mod coupling;
mod device;
mod emulated;
mod exchange;
mod freshness;
pub mod osc;
mod pace;
mod port;
mod service;
mod smoothing;
mod toolbox;

pub use arm::{Arm, ArmState};
pub use carrier::{HandCarrier, Rest, Weight};
pub use coupling::{Coupling, Moving};
pub use device::{ChooseDevice, DEVICES, Device, DeviceChoice, Devices};
pub use emulated::EmulatedHand;
pub use exchange::Latest;
pub use freshness::{Ages, Freshness};
pub use pace::{Histogram, Hurry, Pace, Rank, hurry};
pub use port::{Port, PortState};
pub use service::{DeviceNow, Feels, Served, Service, ServiceError, Station, Tick, Told, Toll};
pub use smoothing::{BETWEEN, Between, ForceSmoothing, Smoothing};
pub use toolbox::HandTools;

/// Seconds between two forces that a device is given.
pub const TICK: f64 = 1e-3;
