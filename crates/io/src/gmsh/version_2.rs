//! Versions 2.0 to 2.2: one physical group for each element, nodes and elements with numbers of their own.

use super::assembly::Assembly;
use super::version_1::read_position;
use crate::cursor::{Cursor, Encoding};
use crate::error::Fault;

/// Most nodes of any element type that is read.
pub(super) const MOST_NODES: usize = 27;

/// Most tags of an element: partitions of a very large machine.
const MOST_TAGS: i64 = 1 << 20;

pub(super) fn read_section(
    cursor: &mut Cursor<'_>,
    section: &[u8],
    assembly: &mut Assembly,
) -> Result<(), Fault> {
    match section {
        b"Nodes" => {
            let count = read_count(cursor, 8, "nodes")?;
            for index in 0..count {
                read_node(cursor, index, assembly)?;
            }
            assembly.has_nodes = true;
        }
        b"Elements" => {
            let count = read_count(cursor, 6, "elements")?;
            match cursor.encoding {
                Encoding::Text => (0..count).try_for_each(|index| read_element(cursor, index, assembly))?,
                Encoding::Binary(_) => read_element_runs(cursor, count, assembly)?,
            }
            assembly.has_elements = true;
        }
        other => super::skip_section(cursor, other, assembly)?,
    }
    Ok(())
}

/// The count is text even in binary files, alone on its line.
fn read_count(cursor: &mut Cursor<'_>, least_bytes: usize, what: &str) -> Result<u64, Fault> {
    let encoding = cursor.encoding;
    cursor.encoding = Encoding::Text;
    let count = cursor.size(8, format_args!("the number of {what}"))?;
    cursor.check_count(count, least_bytes, format_args!("the number of {what}"))?;
    cursor.line();
    cursor.encoding = encoding;
    Ok(count)
}

pub(super) fn read_node(cursor: &mut Cursor<'_>, index: u64, assembly: &mut Assembly) -> Result<(), Fault> {
    let tag = cursor.size(4, format_args!("the number of node {index}"))?;
    let position = read_position(cursor, tag)?;
    assembly.node(cursor, tag, position)
}

/// `number type tag-count tags… nodes…`
fn read_element(cursor: &mut Cursor<'_>, index: u64, assembly: &mut Assembly) -> Result<(), Fault> {
    let tag = cursor.size(4, format_args!("the number of element {index}"))?;
    let number = cursor.int(format_args!("the type of element {tag}"))?;
    let element = assembly.element_type(cursor, number)?;
    let tag_count = cursor.int(format_args!("the number of tags of element {tag}"))?;
    read_tail(cursor, tag, element, tag_count, assembly)
}

/// Runs of elements of one type: `type count tag-count`, then `number tags… nodes…` for each.
fn read_element_runs(cursor: &mut Cursor<'_>, count: u64, assembly: &mut Assembly) -> Result<(), Fault> {
    let mut done = 0;
    while done < count {
        let number = cursor.int(format_args!("the type of a run of elements"))?;
        let element = assembly.element_type(cursor, number)?;
        let length = cursor.int(format_args!("the length of a run of elements"))?;
        let tag_count = cursor.int(format_args!("the number of tags of a run of elements"))?;
        let left = count - done;
        let length =
            u64::try_from(length).ok().filter(|length| (1..=left).contains(length)).ok_or_else(|| {
                let expected = format!("1 to {left}, the number of elements left");
                cursor.fault("the length of a run of elements", length.to_string(), expected)
            })?;
        for _ in 0..length {
            let tag = cursor.size(4, format_args!("the number of an element"))?;
            read_tail(cursor, tag, element, tag_count, assembly)?;
        }
        done += length;
    }
    Ok(())
}

/// Tags and nodes. The first tag is the physical group, the others are geometry and partitions.
fn read_tail(
    cursor: &mut Cursor<'_>,
    tag: u64,
    element: super::element_type::ElementType,
    tag_count: i64,
    assembly: &mut Assembly,
) -> Result<(), Fault> {
    if !(0..=MOST_TAGS).contains(&tag_count) {
        let subject = format!("the number of tags of element {tag}");
        return Err(cursor.fault(subject, tag_count.to_string(), format!("0 to {MOST_TAGS}")));
    }
    let mut physical = 0;
    for index in 0..tag_count {
        let value = cursor.int(format_args!("tag {index} of element {tag}"))?;
        if index == 0 {
            physical = value;
        }
    }
    let mut nodes = [0; MOST_NODES];
    let nodes = &mut nodes[..element.node_count];
    for node in nodes.iter_mut() {
        *node = cursor.size(4, format_args!("a node of element {tag}"))?;
    }
    let groups: &[i64] = if physical == 0 { &[] } else { &[physical] };
    assembly.element(cursor, tag, element, nodes, groups)
}
