//! Version 4.1: nodes and elements in blocks by entity; entities carry any number of physical groups.

use super::assembly::Assembly;
use super::version_1::read_position;
use super::version_2::MOST_NODES;
use crate::cursor::{Cursor, Encoding};
use crate::error::Fault;

/// Most physical groups of one entity; each of its elements is listed in all of them.
const MOST_GROUPS: usize = 64;

/// `width`: bytes of a binary count.
pub(super) fn read_section(
    cursor: &mut Cursor<'_>,
    section: &[u8],
    width: usize,
    assembly: &mut Assembly,
) -> Result<(), Fault> {
    match section {
        b"Entities" => read_entities(cursor, width, assembly),
        b"Nodes" => {
            assembly.has_nodes = true;
            read_nodes(cursor, width, assembly)
        }
        _ => {
            assembly.has_elements = true;
            read_elements(cursor, width, assembly)
        }
    }
}

/// Fewest bytes of one number: a digit and a space, or a binary integer.
fn least_bytes(cursor: &Cursor<'_>) -> usize {
    match cursor.encoding {
        Encoding::Text => 2,
        Encoding::Binary(_) => 4,
    }
}

/// Points: `tag x y z`; others: `tag box`; then physical groups; then, but for points, the bounding entities.
fn read_entities(cursor: &mut Cursor<'_>, width: usize, assembly: &mut Assembly) -> Result<(), Fault> {
    let mut counts = [0; 4];
    for (count, kind) in counts.iter_mut().zip(["points", "curves", "surfaces", "volumes"]) {
        *count = cursor.size(width, format_args!("the number of {kind}"))?;
    }
    for (dimension, count) in counts.into_iter().enumerate() {
        cursor.check_count(count, 5 * least_bytes(cursor), format_args!("the number of entities"))?;
        for _ in 0..count {
            let tag = cursor.int(format_args!("the number of an entity"))?;
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                cursor.double(format_args!("the extent of entity {tag}"))?;
            }
            let mut physical =
                read_int_list(cursor, width, format_args!("the physical groups of entity {tag}"))?;
            if physical.len() > MOST_GROUPS {
                let subject = format!("the number of physical groups of entity {tag}");
                return Err(cursor.fault(
                    subject,
                    physical.len().to_string(),
                    format!("at most {MOST_GROUPS}"),
                ));
            }
            // 0 stands for no group
            physical.retain(|group| *group != 0);
            if dimension > 0 {
                read_int_list(cursor, width, format_args!("the boundary of entity {tag}"))?;
            }
            if assembly.entities.insert((dimension as u8, tag), physical).is_some() {
                let subject = format!("entity {tag} of dimension {dimension}");
                return Err(cursor.fault(subject, "given twice", "a different number for each entity"));
            }
        }
    }
    Ok(())
}

fn read_int_list(
    cursor: &mut Cursor<'_>,
    width: usize,
    subject: std::fmt::Arguments<'_>,
) -> Result<Vec<i64>, Fault> {
    let count = cursor.size(width, subject)?;
    cursor.check_count(count, least_bytes(cursor), subject)?;
    (0..count).map(|_| cursor.int(subject)).collect()
}

/// `block-count count min max`, the head of nodes and of elements: block count and count.
fn read_head(cursor: &mut Cursor<'_>, width: usize, what: &str) -> Result<(u64, u64), Fault> {
    let blocks = cursor.size(width, format_args!("the number of blocks of {what}"))?;
    let count = cursor.size(width, format_args!("the number of {what}"))?;
    cursor.size(width, format_args!("the lowest number of {what}"))?;
    cursor.size(width, format_args!("the highest number of {what}"))?;
    cursor.check_count(blocks, 4 * least_bytes(cursor), format_args!("the number of blocks of {what}"))?;
    cursor.check_count(count, 2 * least_bytes(cursor), format_args!("the number of {what}"))?;
    Ok((blocks, count))
}

fn check_total(cursor: &Cursor<'_>, what: &str, announced: u64, read: u64) -> Result<(), Fault> {
    if announced == read {
        return Ok(());
    }
    let found = format!("{announced}, but the blocks hold {read}");
    Err(cursor.fault(format!("the number of {what}"), found, "the sum over the blocks"))
}

/// Blocks of `dimension entity parametric count`, all tags, then all positions.
fn read_nodes(cursor: &mut Cursor<'_>, width: usize, assembly: &mut Assembly) -> Result<(), Fault> {
    let (blocks, announced) = read_head(cursor, width, "nodes")?;
    let mut total = 0;
    for _ in 0..blocks {
        let dimension = cursor.int(format_args!("the dimension of a block of nodes"))?;
        cursor.int(format_args!("the entity of a block of nodes"))?;
        let parametric = cursor.int(format_args!("the parametric flag of a block of nodes"))?;
        let parameter_count = match (parametric, dimension) {
            (0, _) => 0,
            (1, 0..=3) => dimension,
            _ => {
                let found = format!("{parametric} in dimension {dimension}");
                return Err(cursor.fault(
                    "the parametric flag of a block of nodes",
                    found,
                    "0 or 1 in dimension 0 to 3",
                ));
            }
        };
        let count = cursor.size(width, format_args!("the number of nodes of a block"))?;
        cursor.check_count(count, 4 * least_bytes(cursor), format_args!("the number of nodes of a block"))?;
        let tags = (0..count)
            .map(|index| cursor.size(width, format_args!("the number of node {index} of a block")))
            .collect::<Result<Vec<u64>, Fault>>()?;
        for tag in tags {
            let position = read_position(cursor, tag)?;
            for _ in 0..parameter_count {
                cursor.double(format_args!("a parameter of node {tag}"))?;
            }
            assembly.node(cursor, tag, position)?;
        }
        total += count;
    }
    check_total(cursor, "nodes", announced, total)
}

/// Blocks of `dimension entity type count`, then `number nodes…` for each element.
fn read_elements(cursor: &mut Cursor<'_>, width: usize, assembly: &mut Assembly) -> Result<(), Fault> {
    let (blocks, announced) = read_head(cursor, width, "elements")?;
    let mut total = 0;
    for _ in 0..blocks {
        cursor.int(format_args!("the dimension of a block of elements"))?;
        let entity = cursor.int(format_args!("the entity of a block of elements"))?;
        let number = cursor.int(format_args!("the type of a block of elements"))?;
        let element = assembly.element_type(cursor, number)?;
        let count = cursor.size(width, format_args!("the number of elements of a block"))?;
        cursor.check_count(
            count,
            2 * least_bytes(cursor),
            format_args!("the number of elements of a block"),
        )?;
        let physical = assembly.entities.get(&(element.dimension, entity)).cloned().unwrap_or_default();
        let mut nodes = [0; MOST_NODES];
        let nodes = &mut nodes[..element.node_count];
        for index in 0..count {
            let tag = cursor.size(width, format_args!("the number of element {index} of a block"))?;
            for node in nodes.iter_mut() {
                *node = cursor.size(width, format_args!("a node of element {tag}"))?;
            }
            assembly.element(cursor, tag, element, nodes, &physical)?;
        }
        total += count;
    }
    check_total(cursor, "elements", announced, total)
}
