//! Writes VTK XML unstructured grids: appended raw data, lengths of 8 bytes, little endian.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::xml::escape;
use super::{GROUP_PREFIX, cell_type_of};
use crate::IoError;
use crate::dataset::{Field, Output, Precision};
use crate::format::WriteError;

/// An array to write: where it stands, its head, its content.
struct Array<'a> {
    section: Section,
    name: String,
    type_name: &'static str,
    components: usize,
    byte_count: usize,
    content: Content<'a>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Section {
    PointData,
    CellData,
    Points,
    Cells,
}

type Content<'a> = Box<dyn Fn(&mut dyn Write) -> io::Result<()> + 'a>;

pub(super) fn write(output: &Output<'_>, out: &mut dyn Write) -> Result<(), WriteError> {
    let arrays = arrays(output)?;
    let (point_count, cell_count) = (output.mesh.points.len(), output.cell_count());
    writeln!(out, "<?xml version=\"1.0\"?>")?;
    writeln!(
        out,
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
    )?;
    writeln!(out, "  <UnstructuredGrid>")?;
    writeln!(out, "    <Piece NumberOfPoints=\"{point_count}\" NumberOfCells=\"{cell_count}\">")?;
    let mut offset = 0;
    for section in [Section::PointData, Section::CellData, Section::Points, Section::Cells] {
        let mut text = String::new();
        for array in arrays.iter().filter(|array| array.section == section) {
            let _ = writeln!(
                text,
                "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{offset}\"/>",
                array.type_name,
                escape(&array.name),
                array.components
            );
            offset += size_of::<u64>() + array.byte_count;
        }
        writeln!(out, "      <{section:?}>\n{text}      </{section:?}>")?;
    }
    write!(out, "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_")?;
    // the arrays are listed in the order of the sections
    for array in &arrays {
        out.write_all(&(array.byte_count as u64).to_le_bytes())?;
        (array.content)(out)?;
    }
    write!(out, "\n  </AppendedData>\n</VTKFile>\n")?;
    Ok(())
}

/// All arrays, section after section.
fn arrays<'a>(output: &Output<'a>) -> Result<Vec<Array<'a>>, IoError> {
    let mut arrays: Vec<Array<'a>> = Vec::new();
    for field in output.point_fields {
        arrays.push(field_array(Section::PointData, field, output.precision));
    }
    let (point_groups, cell_groups) = group_arrays(output)?;
    arrays.extend(point_groups);
    for field in output.cell_fields {
        arrays.push(field_array(Section::CellData, field, output.precision));
    }
    arrays.extend(cell_groups);

    let positions = output.positions();
    let coordinates = positions.iter().flat_map(|position| position.to_array());
    arrays.push(reals(Section::Points, "Points", 3, 3 * positions.len(), coordinates, output.precision));

    let blocks = output.blocks();
    let types = blocks
        .clone()
        .map(|block| {
            let number = cell_type_of(block.kind);
            let number =
                number.ok_or_else(|| IoError::request("an element", block.kind, "one that VTK has"))?;
            Ok((number, block.len()))
        })
        .collect::<Result<Vec<(u8, usize)>, IoError>>()?;
    let cell_count = output.cell_count();
    let cells = |name: &str, type_name, byte_count, content: Content<'a>| Array {
        section: Section::Cells,
        name: name.to_owned(),
        type_name,
        components: 1,
        byte_count,
        content,
    };
    let connectivity = blocks.clone();
    arrays.push(cells(
        "connectivity",
        "UInt32",
        4 * blocks.clone().map(|block| block.nodes.len()).sum::<usize>(),
        Box::new(move |out| {
            connectivity
                .clone()
                .flat_map(|block| &block.nodes)
                .try_for_each(|node| out.write_all(&node.to_le_bytes()))
        }),
    ));
    arrays.push(cells(
        "offsets",
        "UInt64",
        8 * cell_count,
        Box::new(move |out| {
            let mut end = 0u64;
            for (block, _) in blocks.clone().flat_map(|block| block.cells().map(move |cell| (block, cell))) {
                end += block.kind.node_count() as u64;
                out.write_all(&end.to_le_bytes())?;
            }
            Ok(())
        }),
    ));
    arrays.push(cells(
        "types",
        "UInt8",
        cell_count,
        Box::new(move |out| {
            types.iter().try_for_each(|(number, count)| out.write_all(&vec![*number; *count]))
        }),
    ));
    Ok(arrays)
}

fn field_array<'a>(section: Section, field: &'a Field, precision: Precision) -> Array<'a> {
    let values = field.values.iter().copied();
    reals(section, &field.name, field.components, field.values.len(), values, precision)
}

fn reals<'a>(
    section: Section,
    name: &str,
    components: usize,
    count: usize,
    values: impl Iterator<Item = f64> + Clone + 'a,
    precision: Precision,
) -> Array<'a> {
    let (type_name, width) = match precision {
        Precision::Single => ("Float32", 4),
        Precision::Double => ("Float64", 8),
    };
    let content: Content<'a> = Box::new(move |out| {
        values.clone().try_for_each(|value| match precision {
            Precision::Single => out.write_all(&(value as f32).to_le_bytes()),
            Precision::Double => out.write_all(&value.to_le_bytes()),
        })
    });
    Array { section, name: name.to_owned(), type_name, components, byte_count: width * count, content }
}

/// Arrays of 0 and 1: groups on the points, groups on the cells and facets.
fn group_arrays<'a>(output: &Output<'a>) -> Result<(Vec<Array<'a>>, Vec<Array<'a>>), IoError> {
    let (mut on_points, mut on_cells) = (Vec::new(), Vec::new());
    for marked in super::group_marks(output)? {
        on_points.extend(marked.on_points.map(|marks| mark_array(Section::PointData, marked.name, marks)));
        on_cells.extend(marked.on_cells.map(|marks| mark_array(Section::CellData, marked.name, marks)));
    }
    Ok((on_points, on_cells))
}

fn mark_array<'a>(section: Section, name: &str, marks: Vec<u8>) -> Array<'a> {
    Array {
        section,
        name: format!("{GROUP_PREFIX}{name}"),
        type_name: "UInt8",
        components: 1,
        byte_count: marks.len(),
        content: Box::new(move |out| out.write_all(&marks)),
    }
}
