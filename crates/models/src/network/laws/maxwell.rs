//! Maxwell's fluid: Bingham's paste without thresholds.

use super::bingham::{Bingham, STIFFNESS, VISCOSITY};
use crate::network::kernel::InLanes;
use crate::network::law::LinkEntry;

pub const ENTRY: LinkEntry = LinkEntry {
    name: "maxwell",
    summary: "spring and damper in series: bounces when struck, flows when pulled slowly",
    source: "Jimenez 1993, P2-V.3.2.A",
    parameters: &[STIFFNESS, VISCOSITY],
    build: |making| {
        Ok(Box::new(InLanes(Bingham {
            stiffness: making.values.number("stiffness"),
            viscosity: making.values.number("viscosity"),
            yields: [0.0; 2],
            timestep: making.timestep,
        })))
    },
};
