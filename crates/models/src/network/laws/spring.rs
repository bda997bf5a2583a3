//! A linear spring.

use super::spring_damper::{SOURCE, STIFFNESS, SpringDamper};
use crate::network::kernel::InLanes;
use crate::network::law::LinkEntry;

pub const ENTRY: LinkEntry = LinkEntry {
    name: "spring",
    summary: "linear spring: keeps energy",
    source: SOURCE,
    parameters: &[STIFFNESS],
    build: |making| Ok(Box::new(InLanes(SpringDamper::made(making)))),
};
