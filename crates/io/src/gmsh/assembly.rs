//! What the sections of a Gmsh file add up to: nodes by tag, elements, physical groups.

use std::collections::{BTreeMap, HashMap};

use souple_math::Vec3;
use souple_mesh::{ElementKind, Group, MAX_NODES};

use super::element_type::{self, ElementType};
use crate::Dataset;
use crate::cursor::Cursor;
use crate::dataset::{Destination, Sorter, tidy_groups};
use crate::error::Fault;

/// A physical group: dimension and number.
type PhysicalTag = (u8, i64);

/// An edge of a file.
#[derive(Debug)]
struct Edge {
    element: ElementType,
    /// As many as its type has.
    nodes: [u32; 3],
    physical: Vec<i64>,
}

#[derive(Debug, Default)]
pub(super) struct Assembly {
    dataset: Dataset,
    sorter: Sorter,
    /// Point of each node tag.
    points: HashMap<u64, u32>,
    groups: BTreeMap<PhysicalTag, Group>,
    names: BTreeMap<PhysicalTag, String>,
    /// Physical groups of each entity (version 4).
    pub entities: HashMap<PhysicalTag, Vec<i64>>,
    /// Edges of the file: what they are shows when all other elements are known.
    edges: Vec<Edge>,
    /// Whether the file has elements of more dimensions than edges.
    is_more_than_edges: bool,
    skipped: BTreeMap<i64, usize>,
    /// Sections that were left out, by name.
    skipped_sections: BTreeMap<Vec<u8>, usize>,
    pub has_nodes: bool,
    pub has_elements: bool,
}

impl Assembly {
    pub fn name_group(&mut self, dimension: u8, tag: i64, name: &str) {
        self.names.insert((dimension, tag), name.to_owned());
    }

    pub fn node(&mut self, cursor: &Cursor<'_>, tag: u64, position: Vec3) -> Result<(), Fault> {
        let point = self.dataset.mesh.points.len();
        if point >= u32::MAX as usize {
            return Err(cursor.fault("the number of nodes", point.to_string(), "fewer than 2^32"));
        }
        if self.points.insert(tag, point as u32).is_some() {
            return Err(cursor.fault(
                format!("node {tag}"),
                "given twice",
                "a different number for each node",
            ));
        }
        self.dataset.mesh.points.push(position);
        Ok(())
    }

    /// Notes a section that is not read; remarks say nothing about the mesh.
    pub fn leave_out(&mut self, section: &[u8]) {
        if section != b"Comments" {
            *self.skipped_sections.entry(section.to_vec()).or_default() += 1;
        }
    }

    /// The type of a number, refused if its elements cannot be used.
    pub fn element_type(&self, cursor: &Cursor<'_>, number: i64) -> Result<ElementType, Fault> {
        let Some(element) = element_type::find(number) else {
            let expected = "4, 11 (tetrahedra), 5, 12, 17 (hexahedra), 6, 18 (prisms), 7, 19 (pyramids), \
                            2, 3, 9, 10, 16 (facets) or 1, 8 (edges)";
            return Err(cursor.fault("the element type", number.to_string(), expected));
        };
        if element.dimension == 3 && element.kind.is_none() {
            let expected = "elements of the first order (in Gmsh: SetOrder 1), or incomplete ones of the second \
                            (Mesh.SecondOrderIncomplete = 1, SetOrder 2)";
            return Err(cursor.fault("the element type", format!("{number}, a {}", element.name), expected));
        }
        Ok(element)
    }

    pub fn element(
        &mut self,
        cursor: &Cursor<'_>,
        tag: u64,
        element: ElementType,
        node_tags: &[u64],
        physical: &[i64],
    ) -> Result<(), Fault> {
        let mut nodes = [0; MAX_NODES];
        for (slot, node_tag) in nodes.iter_mut().zip(node_tags) {
            *slot = *self.points.get(node_tag).ok_or_else(|| {
                let subject = format!("a node of element {tag}");
                cursor.fault(subject, node_tag.to_string(), "the number of a node of $Nodes")
            })?;
        }
        self.is_more_than_edges |= element.dimension > 1;
        if element.dimension == 1 && element.kind.is_some() {
            let [start, end, middle, ..] = nodes;
            self.edges.push(Edge { element, nodes: [start, end, middle], physical: physical.to_vec() });
        } else {
            self.take(element, element.kind, &nodes[..node_tags.len()], physical);
        }
        Ok(())
    }

    /// Puts an element among the cells or the facets, or its points into its groups where it is none of ours.
    fn take(&mut self, element: ElementType, kind: Option<ElementKind>, nodes: &[u32], physical: &[i64]) {
        let destination = match kind {
            Some(kind) => {
                let mut ours = [0; MAX_NODES];
                for (slot, theirs) in ours.iter_mut().zip(element_type::order(kind)) {
                    *slot = nodes[usize::from(*theirs)];
                }
                self.sorter.push(&mut self.dataset.mesh, kind, &ours[..nodes.len()])
            }
            None => Destination::Skipped,
        };
        if destination == Destination::Skipped && (element.dimension == 2 || physical.is_empty()) {
            *self.skipped.entry(element.number).or_default() += 1;
        }
        for tag in physical {
            // a negative number is the same group with its orientation reversed
            let group = self.groups.entry((element.dimension, tag.saturating_abs())).or_default();
            match destination {
                Destination::Cell(cell) => group.cells.push(cell),
                Destination::Facets { first, count } => group.facets.extend(first..first + count),
                Destination::Skipped => group.points.extend_from_slice(nodes),
            }
        }
    }

    /// Edges are cells where a file has nothing else, and the curves around what it meshes beside other elements.
    fn take_edges(&mut self) {
        for Edge { element, nodes, physical } in std::mem::take(&mut self.edges) {
            let kind = element.kind.filter(|_| !self.is_more_than_edges);
            self.take(element, kind, &nodes[..element.node_count], &physical);
        }
    }

    pub fn finish(mut self, cursor: &Cursor<'_>) -> Result<Dataset, Fault> {
        for (present, section) in [(self.has_nodes, "$Nodes"), (self.has_elements, "$Elements")] {
            if !present {
                return Err(Fault::cut_off(
                    cursor.place(),
                    format!("the section {section}"),
                    "nodes and elements",
                ));
            }
        }
        self.take_edges();
        for (tag, name) in &self.names {
            self.groups.entry(*tag).or_default();
            if name.is_empty() {
                self.dataset.notes.push(format!("the physical group {} has an empty name", tag.1));
            }
        }
        for ((dimension, tag), mut group) in std::mem::take(&mut self.groups) {
            let kind = ["point", "curve", "surface", "volume"][usize::from(dimension)];
            let name = match self.names.remove(&(dimension, tag)) {
                Some(name) if !name.is_empty() => name,
                _ => format!("{kind}_{tag}"),
            };
            // one name may stand for groups of several dimensions
            let whole = self.dataset.mesh.groups.entry(name).or_default();
            whole.points.append(&mut group.points);
            whole.cells.append(&mut group.cells);
            whole.facets.append(&mut group.facets);
        }
        tidy_groups(&mut self.dataset.mesh);
        for (number, count) in self.skipped {
            let name = element_type::find(number).map_or("element", |element| element.name);
            let [elements, were] = if count == 1 { ["element", "was"] } else { ["elements", "were"] };
            let note = format!("{count} {elements} of type {number} ({name}) {were} left out");
            self.dataset.notes.push(note);
        }
        if !self.skipped_sections.is_empty() {
            let names: Vec<String> = self
                .skipped_sections
                .iter()
                .map(|(name, count)| match count {
                    1 => format!("${}", name.escape_ascii()),
                    count => format!("${} ({count} times)", name.escape_ascii()),
                })
                .collect();
            self.dataset
                .notes
                .push(format!("sections that are not read were left out: {}", names.join(", ")));
        }
        Ok(self.dataset)
    }
}
