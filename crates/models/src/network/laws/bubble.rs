//! A bubble: a hollow that nothing leaves.

use super::stop::{PARAMETERS, SOURCE, Stop, Zone};
use crate::network::kernel::InLanes;
use crate::network::law::LinkEntry;

pub const ENTRY: LinkEntry = LinkEntry {
    name: "bubble",
    summary: "pulls while further than the threshold: a hollow that nothing leaves",
    source: SOURCE,
    parameters: PARAMETERS,
    build: |making| Ok(Box::new(InLanes(Stop::made(making, Zone::Outside)))),
};
