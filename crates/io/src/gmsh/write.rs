//! Writes Gmsh 4.1 and 2.2, as text or binary.
//!
//! Cells keep their order: a block of elements is a run of cells of one kind in the same groups. Points of
//! groups are written as elements of one node.

use std::collections::BTreeMap;
use std::io::Write;

use souple_mesh::{BoundingBox, CellBlock, Mesh};

use super::element_type::{self, POINT};
use crate::IoError;
use crate::cursor::{Encoding, Endian};
use crate::dataset::{Facets, Output};
use crate::format::WriteError;

/// One element with the groups it is in.
struct Item<'a> {
    element_type: i64,
    dimension: u8,
    nodes: &'a [u32],
    /// Number of the set of groups, in `Grouping::sets`.
    set: usize,
}

/// All elements in the order of writing, and the distinct sets of groups of each dimension.
struct Grouping<'a> {
    items: Vec<Item<'a>>,
    /// Sets of group numbers (from 1), each dimension with its own.
    sets: Vec<(u8, Vec<usize>)>,
    names: Vec<(u8, usize, &'a str)>,
}

/// Writes version 4.1.
pub(super) fn version_4(
    output: &Output<'_>,
    encoding: Encoding,
    out: &mut dyn Write,
) -> Result<(), WriteError> {
    let grouping = Grouping::of(output)?;
    let mut sink = Sink { out, encoding, column: 0 };
    sink.head("4.1")?;
    sink.names(&grouping.names)?;
    write_entities(&mut sink, &grouping, output)?;

    sink.line("$Nodes")?;
    let count = output.mesh.points.len();
    let entity = (0..4u8).rev().find(|dimension| grouping.sets.iter().any(|set| set.0 == *dimension));
    let entity = entity.map_or((0, 1), |dimension| (dimension, grouping.entity_of(dimension)));
    sink.sizes(&[1, count, usize::from(count > 0), count])?;
    sink.ints(&[i64::from(entity.0), entity.1, 0])?;
    sink.sizes(&[count])?;
    for tag in 1..=count {
        sink.sizes(&[tag])?;
    }
    for position in output.positions() {
        sink.doubles(&position.to_array())?;
    }
    sink.line("$EndNodes")?;

    sink.line("$Elements")?;
    let runs = || grouping.items.chunk_by(|a, b| (a.element_type, a.set) == (b.element_type, b.set));
    let count = grouping.items.len();
    sink.sizes(&[runs().count(), count, usize::from(count > 0), count])?;
    let mut tag = 0;
    for run in runs() {
        sink.ints(&[i64::from(run[0].dimension), run[0].set as i64 + 1, run[0].element_type])?;
        sink.sizes(&[run.len()])?;
        for item in run {
            tag += 1;
            sink.size(tag)?;
            for node in element_type::listed(item.element_type, item.nodes) {
                sink.size(node as usize + 1)?;
            }
            sink.end_line()?;
        }
    }
    sink.line("$EndElements")?;
    Ok(())
}

/// An entity for each set of groups; its number is that of the set plus one.
///
/// Where some cells have groups, those without have group 0, as version 2 writes it: Gmsh would drop cells without any when
/// it saves the file, and readers that make a list of groups want one for each block.
fn write_entities(
    sink: &mut Sink<'_>,
    grouping: &Grouping<'_>,
    output: &Output<'_>,
) -> Result<(), WriteError> {
    sink.line("$Entities")?;
    let of_dimension =
        |dimension: u8| grouping.sets.iter().enumerate().filter(move |(_, set)| set.0 == dimension);
    sink.sizes(&[0, 1, 2, 3].map(|dimension| of_dimension(dimension).count()))?;
    let bounds = match output.positions() {
        [] => BoundingBox { low: souple_math::Vec3::default(), high: souple_math::Vec3::default() },
        positions => BoundingBox::of(positions.iter().copied()),
    };
    for dimension in 0..4 {
        for (index, (_, groups)) in of_dimension(dimension) {
            sink.int(index as i64 + 1)?;
            for coordinate in bounds.low.to_array() {
                sink.double(coordinate)?;
            }
            if dimension > 0 {
                for coordinate in bounds.high.to_array() {
                    sink.double(coordinate)?;
                }
            }
            let ungrouped: &[usize] = if grouping.names.is_empty() { &[] } else { &[0] };
            let groups = if groups.is_empty() { ungrouped } else { groups };
            sink.size(groups.len())?;
            for group in groups {
                sink.int(*group as i64)?;
            }
            if dimension > 0 {
                sink.size(0)?;
            }
            sink.end_line()?;
        }
    }
    Ok(sink.line("$EndEntities")?)
}

/// Writes version 2.2.
pub(super) fn version_2(
    output: &Output<'_>,
    encoding: Encoding,
    out: &mut dyn Write,
) -> Result<(), WriteError> {
    let grouping = Grouping::of(output)?;
    if let Some((_, groups)) =
        grouping.sets.iter().find(|(dimension, groups)| *dimension > 0 && groups.len() > 1)
    {
        let name =
            |group: usize| grouping.names.iter().find(|name| name.1 == group).map_or("", |name| name.2);
        let value = format!("in the groups `{}` and `{}`", name(groups[0]), name(groups[1]));
        let expected = "one group for each cell in Gmsh 2.2 (the format `gmsh` takes several)";
        return Err(IoError::request("a cell", value, expected).into());
    }
    let mut sink = Sink { out, encoding, column: 0 };
    sink.head("2.2")?;
    sink.names(&grouping.names)?;
    sink.line("$Nodes")?;
    sink.line(&output.mesh.points.len().to_string())?;
    for (index, position) in output.positions().iter().enumerate() {
        sink.int(index as i64 + 1)?;
        sink.doubles(&position.to_array())?;
    }
    sink.line("$EndNodes")?;

    sink.line("$Elements")?;
    // a point in several groups is written once for each
    let groups_of = |item: &Item<'_>| match grouping.sets[item.set].1.as_slice() {
        [] => vec![0],
        groups => groups.to_vec(),
    };
    let count: usize = grouping.items.iter().map(|item| groups_of(item).len()).sum();
    sink.line(&count.to_string())?;
    let mut tag = 0;
    for item in &grouping.items {
        for group in groups_of(item) {
            tag += 1;
            match encoding {
                Encoding::Text => sink.ints(&[tag, item.element_type, 2])?,
                Encoding::Binary(_) => sink.ints(&[item.element_type, 1, 2, tag])?,
            }
            sink.ints(&[group as i64, item.set as i64 + 1])?;
            for node in element_type::listed(item.element_type, item.nodes) {
                sink.int(i64::from(node) + 1)?;
            }
            sink.end_line()?;
        }
    }
    sink.line("$EndElements")?;
    Ok(())
}

impl<'a> Grouping<'a> {
    fn of(output: &Output<'a>) -> Result<Self, IoError> {
        let mesh = output.mesh;
        let facets: &[CellBlock] = match output.facets {
            Facets::Written => &mesh.facet_blocks,
            Facets::LeftOut => &[],
        };
        let mut grouping = Self { items: Vec::new(), sets: Vec::new(), names: names(mesh, output.facets)? };
        let (mut cells, mut facet_groups, mut points) =
            (vec![Vec::new(); mesh.cell_count()], vec![Vec::new(); mesh.facet_count()], BTreeMap::new());
        for (index, group) in mesh.groups.values().enumerate() {
            for (list, members) in [(&mut cells, &group.cells), (&mut facet_groups, &group.facets)] {
                for member in members {
                    let count = list.len();
                    let slot = list.get_mut(*member as usize).ok_or_else(|| {
                        IoError::request("a member of a group", member, format!("a number below {count}"))
                    })?;
                    slot.push(index + 1);
                }
            }
            for point in &group.points {
                points.entry(point).or_insert_with(Vec::new).push(index + 1);
            }
        }
        let mut known = BTreeMap::new();
        for (point, groups) in points {
            if *point as usize >= mesh.points.len() {
                let expected = format!("a point of the mesh, which has {}", mesh.points.len());
                return Err(IoError::request("a point of a group", point, expected));
            }
            grouping.push(&mut known, POINT, 0, std::slice::from_ref(point), groups);
        }
        for (blocks, lists, dimension) in
            [(facets, facet_groups, 2), (&mesh.blocks[..], cells, mesh.dimension() as u8)]
        {
            let mut lists = lists.into_iter();
            for block in blocks {
                let number = element_type::number_of(block.kind).ok_or_else(|| {
                    IoError::request("an element", block.kind, "one that Gmsh has a type for")
                })?;
                for nodes in block.cells() {
                    grouping.push(&mut known, number, dimension, nodes, lists.next().unwrap_or_default());
                }
            }
        }
        Ok(grouping)
    }

    fn push(
        &mut self,
        known: &mut BTreeMap<(u8, Vec<usize>), usize>,
        element_type: i64,
        dimension: u8,
        nodes: &'a [u32],
        groups: Vec<usize>,
    ) {
        let next = self.sets.len();
        let set = *known.entry((dimension, groups)).or_insert_with_key(|key| {
            self.sets.push(key.clone());
            next
        });
        self.items.push(Item { element_type, dimension, nodes, set });
    }

    /// Number of the first entity of a dimension.
    fn entity_of(&self, dimension: u8) -> i64 {
        self.sets.iter().position(|set| set.0 == dimension).map_or(1, |index| index as i64 + 1)
    }
}

/// Dimension, number (from 1) and name of each group, in each dimension that it has members of.
fn names(mesh: &Mesh, facets: Facets) -> Result<Vec<(u8, usize, &str)>, IoError> {
    let mut names = Vec::new();
    for (index, (name, group)) in mesh.groups.iter().enumerate() {
        if name.is_empty() || name.contains(['"', '\n', '\r']) {
            return Err(IoError::request(
                "the name of a group",
                format!("{name:?}"),
                "text without quotes, on one line",
            ));
        }
        let facet_members = if facets == Facets::Written { group.facets.as_slice() } else { &[] };
        let lists = [(2, facet_members), (mesh.dimension() as u8, group.cells.as_slice())];
        let mut dimensions: Vec<u8> =
            lists.iter().filter(|list| !list.1.is_empty()).map(|list| list.0).collect();
        // a group of nothing is kept by its name
        if !group.points.is_empty() || dimensions.is_empty() {
            dimensions.push(0);
        }
        names.extend(dimensions.into_iter().map(|dimension| (dimension, index + 1, name.as_str())));
    }
    Ok(names)
}

/// Numbers as text with spaces and lines, or as binary.
struct Sink<'a> {
    out: &'a mut dyn Write,
    encoding: Encoding,
    /// Numbers on this line so far.
    column: usize,
}

impl Sink<'_> {
    fn head(&mut self, version: &str) -> std::io::Result<()> {
        self.line("$MeshFormat")?;
        self.line(&format!("{version} {} 8", u8::from(self.encoding != Encoding::Text)))?;
        if self.encoding != Encoding::Text {
            self.int(1)?;
        }
        self.line("$EndMeshFormat")
    }

    fn names(&mut self, names: &[(u8, usize, &str)]) -> std::io::Result<()> {
        if names.is_empty() {
            return Ok(());
        }
        self.line("$PhysicalNames")?;
        self.line(&names.len().to_string())?;
        for (dimension, number, name) in names {
            self.line(&format!("{dimension} {number} \"{name}\""))?;
        }
        self.line("$EndPhysicalNames")
    }

    /// A line of text; keywords stand on lines of their own also between binary data.
    fn line(&mut self, text: &str) -> std::io::Result<()> {
        if self.encoding != Encoding::Text && text.starts_with("$End") {
            writeln!(self.out)?;
        }
        writeln!(self.out, "{text}")
    }

    fn end_line(&mut self) -> std::io::Result<()> {
        self.column = 0;
        if self.encoding == Encoding::Text { writeln!(self.out) } else { Ok(()) }
    }

    /// Text as `text` gives it, or `N` bytes in the order of the file, given in little order.
    fn number<const N: usize>(
        &mut self,
        text: impl std::fmt::Display,
        mut bytes: [u8; N],
    ) -> std::io::Result<()> {
        match self.encoding {
            Encoding::Text => {
                self.column += 1;
                let space = if self.column > 1 { " " } else { "" };
                write!(self.out, "{space}{text}")
            }
            Encoding::Binary(endian) => {
                if endian == Endian::Big {
                    bytes.reverse();
                }
                self.out.write_all(&bytes)
            }
        }
    }

    fn int(&mut self, value: i64) -> std::io::Result<()> {
        let narrow = i32::try_from(value).map_err(std::io::Error::other)?;
        self.number(value, narrow.to_le_bytes())
    }

    fn size(&mut self, value: usize) -> std::io::Result<()> {
        self.number(value, (value as u64).to_le_bytes())
    }

    /// The shortest text that reads back as the same bits.
    fn double(&mut self, value: f64) -> std::io::Result<()> {
        self.number(format_args!("{value:?}"), value.to_le_bytes())
    }

    /// Integers on an open line: more numbers follow.
    fn ints(&mut self, values: &[i64]) -> std::io::Result<()> {
        values.iter().try_for_each(|value| self.int(*value))
    }

    fn sizes(&mut self, values: &[usize]) -> std::io::Result<()> {
        values.iter().try_for_each(|value| self.size(*value))?;
        self.end_line()
    }

    fn doubles(&mut self, values: &[f64]) -> std::io::Result<()> {
        values.iter().try_for_each(|value| self.double(*value))?;
        self.end_line()
    }
}
