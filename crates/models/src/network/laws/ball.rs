//! A ball: points with a volume that nothing enters.

use super::stop::{PARAMETERS, SOURCE, Stop, Zone};
use crate::network::kernel::InLanes;
use crate::network::law::LinkEntry;

pub const ENTRY: LinkEntry = LinkEntry {
    name: "ball",
    summary: "pushes while closer than the threshold: points with a volume that nothing enters",
    source: SOURCE,
    parameters: PARAMETERS,
    build: |making| Ok(Box::new(InLanes(Stop::made(making, Zone::Inside)))),
};
