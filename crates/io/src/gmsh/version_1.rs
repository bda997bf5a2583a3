//! Version 1: `$NOD` and `$ELM`, always text. Old, but many meshes are kept in it.

use souple_math::Vec3;

use super::assembly::Assembly;
use crate::cursor::Cursor;
use crate::error::Fault;

pub(super) fn read_section(
    cursor: &mut Cursor<'_>,
    section: &[u8],
    assembly: &mut Assembly,
) -> Result<(), Fault> {
    if section == b"NOD" {
        let count = cursor.size(8, format_args!("the number of nodes"))?;
        cursor.check_count(count, 8, format_args!("the number of nodes"))?;
        for index in 0..count {
            super::version_2::read_node(cursor, index, assembly)?;
        }
        assembly.has_nodes = true;
    } else {
        let count = cursor.size(8, format_args!("the number of elements"))?;
        cursor.check_count(count, 10, format_args!("the number of elements"))?;
        for index in 0..count {
            read_element(cursor, index, assembly)?;
        }
        assembly.has_elements = true;
    }
    Ok(())
}

/// `number type physical elementary node-count nodes…`
fn read_element(cursor: &mut Cursor<'_>, index: u64, assembly: &mut Assembly) -> Result<(), Fault> {
    let tag = cursor.size(8, format_args!("the number of element {index}"))?;
    let number = cursor.int(format_args!("the type of element {tag}"))?;
    let element = assembly.element_type(cursor, number)?;
    let physical = cursor.int(format_args!("the physical region of element {tag}"))?;
    cursor.int(format_args!("the elementary region of element {tag}"))?;
    let node_count = cursor.int(format_args!("the number of nodes of element {tag}"))?;
    if node_count != element.node_count as i64 {
        let expected = format!("{} for a {}", element.node_count, element.name);
        return Err(cursor.fault(
            format!("the number of nodes of element {tag}"),
            node_count.to_string(),
            expected,
        ));
    }
    let mut nodes = [0; super::version_2::MOST_NODES];
    let nodes = &mut nodes[..element.node_count];
    for node in nodes.iter_mut() {
        *node = cursor.size(8, format_args!("a node of element {tag}"))?;
    }
    let groups: &[i64] = if physical == 0 { &[] } else { &[physical] };
    assembly.element(cursor, tag, element, nodes, groups)
}

/// Three finite coordinates.
pub(super) fn read_position(cursor: &mut Cursor<'_>, tag: u64) -> Result<Vec3, Fault> {
    let mut position = [0.0; 3];
    for (axis, coordinate) in ["x", "y", "z"].iter().zip(&mut position) {
        *coordinate = cursor.finite(format_args!("{axis} of node {tag}"))?;
    }
    Ok(Vec3::from_array(position))
}
