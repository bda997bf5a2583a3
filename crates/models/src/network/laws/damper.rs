//! A linear damper.

use super::spring_damper::{DAMPING, SOURCE, SpringDamper};
use crate::network::kernel::InLanes;
use crate::network::law::LinkEntry;

pub const ENTRY: LinkEntry = LinkEntry {
    name: "damper",
    summary: "linear damper: resists changes of length, not rotation",
    source: SOURCE,
    parameters: &[DAMPING],
    build: |making| Ok(Box::new(InLanes(SpringDamper::made(making)))),
};
