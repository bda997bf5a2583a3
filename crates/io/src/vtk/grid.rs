//! An unstructured grid as VTK lists it, and the mesh with fields and groups that it becomes.

use std::collections::BTreeMap;

use souple_math::Vec3;
use souple_mesh::{Group, MAX_NODES, Mesh};

use super::{CELL_TYPES, EDGE_TYPES, GROUP_PREFIX, POLYGON, WITHOUT_VOLUME};
use crate::Dataset;
use crate::dataset::{Destination, Field, Sorter, tidy_groups};
use crate::error::{Fault, Place};

/// Arrays of whole numbers that mark parts of a mesh, as other programs call them.
const MARKS: &[&str] = &["gmsh:physical", "medit:ref", "MaterialID", "MaterialIds", "RegionId", "cell_tags"];

/// Most parts that such an array makes groups of; more are no marks but numbers of something else.
const MOST_PARTS: usize = 256;

/// The arrays of a file, and where the cells stand in it.
#[derive(Debug, Default)]
pub(super) struct Grid {
    /// Three for each point.
    pub coordinates: Vec<f64>,
    /// Point numbers of all cells in a row.
    pub connectivity: Vec<i64>,
    /// End of each cell in the connectivity.
    pub offsets: Vec<i64>,
    /// VTK type of each cell.
    pub types: Vec<i64>,
    pub point_fields: Vec<Field>,
    pub cell_fields: Vec<Field>,
}

impl Grid {
    /// Checks everything against everything else; faults are said to be at `place`.
    pub fn into_dataset(mut self, place: Place) -> Result<Dataset, Fault> {
        let mut dataset = Dataset::default();
        dataset.mesh.points = self.points(place)?;
        let destinations = self.sort_cells(place, &mut dataset)?;
        self.bound_fields(&mut dataset, &destinations);

        for field in self.point_fields {
            match field.name.strip_prefix(GROUP_PREFIX) {
                Some(name) => {
                    let members = members(&field).map(|point| point as u32);
                    group(&mut dataset.mesh, name).points.extend(members);
                }
                None => dataset.point_fields.push(field),
            }
        }
        for field in self.cell_fields {
            if let Some(name) = field.name.strip_prefix(GROUP_PREFIX) {
                assign(group(&mut dataset.mesh, name), &destinations, members(&field));
                continue;
            }
            if MARKS.contains(&field.name.as_str()) {
                groups_of_marks(&mut dataset, &field, &destinations);
            }
            dataset.cell_fields.push(sorted(field, &destinations));
        }
        // a group may stand in two arrays: its own and an array of marks
        tidy_groups(&mut dataset.mesh);
        Ok(dataset)
    }

    fn points(&self, place: Place) -> Result<Vec<Vec3>, Fault> {
        if self.coordinates.len() >= 3 * (u32::MAX as usize) {
            return Err(Fault::new(place, "the number of points", "2^32 or more", "fewer"));
        }
        if let Some(index) = self.coordinates.iter().position(|coordinate| !coordinate.is_finite()) {
            let (subject, found) = (format!("points[{}]", index / 3), self.coordinates[index].to_string());
            return Err(Fault::new(place, subject, found, "finite coordinates"));
        }
        Ok(self.coordinates.chunks_exact(3).map(|x| Vec3::new(x[0], x[1], x[2])).collect())
    }

    fn sort_cells(&self, place: Place, dataset: &mut Dataset) -> Result<Vec<Destination>, Fault> {
        let mesh = &mut dataset.mesh;
        if self.types.len() != self.offsets.len() {
            let found = format!("{}, but there are {} offsets", self.types.len(), self.offsets.len());
            return Err(Fault::new(place, "the number of cell types", found, "one for each cell"));
        }
        let count = mesh.points.len();
        let point = |cell: usize, node: i64| {
            u32::try_from(node).ok().filter(|node| (*node as usize) < count).ok_or_else(|| {
                let expected = format!("a point, of which there are {count}");
                Fault::new(place, format!("a node of cell {cell}"), node.to_string(), expected)
            })
        };
        let mut sorter = Sorter::default();
        let is_edge = |number: &i64| EDGE_TYPES.iter().any(|edge| edge.number == *number);
        let is_of_edges = self.types.iter().all(is_edge);
        let mut skipped: BTreeMap<i64, usize> = BTreeMap::new();
        let mut destinations = Vec::with_capacity(self.types.len());
        let mut corners = Vec::new();
        let mut start = 0;
        for (cell, (number, end)) in self.types.iter().zip(&self.offsets).enumerate() {
            let most = self.connectivity.len();
            let end =
                usize::try_from(*end).ok().filter(|end| (start..=most).contains(end)).ok_or_else(|| {
                    Fault::new(
                        place,
                        format!("offsets[{cell}]"),
                        end.to_string(),
                        format!("{start} to {most}"),
                    )
                })?;
            let listed = &self.connectivity[start..end];
            start = end;
            if *number == POLYGON && listed.len() > 2 {
                corners.clear();
                for node in listed {
                    corners.push(point(cell, *node)?);
                }
                destinations.push(sorter.push_polygon(mesh, &corners));
                continue;
            }
            let edge = EDGE_TYPES.iter().find(|edge| is_of_edges && edge.number == *number);
            let Some(cell_type) = CELL_TYPES.iter().find(|cell| cell.number == *number).or(edge) else {
                if !WITHOUT_VOLUME.contains(number) {
                    let expected = "5, 7, 8, 9, 22, 23, 28 (facets), 10, 24 (tets), 11, 12, 25, 29 (hexes), 13, 26 (wedges) or 14, 27 (pyramids)";
                    return Err(Fault::new(place, format!("types[{cell}]"), number.to_string(), expected));
                }
                *skipped.entry(*number).or_default() += 1;
                destinations.push(Destination::Skipped);
                continue;
            };
            if listed.len() != cell_type.order.len() {
                let expected = format!("{} for a cell of type {number}", cell_type.order.len());
                let subject = format!("the number of nodes of cell {cell}");
                return Err(Fault::new(place, subject, listed.len().to_string(), expected));
            }
            let mut nodes = [0; MAX_NODES];
            for (slot, source) in nodes.iter_mut().zip(cell_type.order) {
                *slot = point(cell, listed[*source])?;
            }
            destinations.push(sorter.push(mesh, cell_type.kind, &nodes[..cell_type.order.len()]));
        }
        if start != self.connectivity.len() {
            let found = format!("{}, but the cells use {start}", self.connectivity.len());
            return Err(Fault::new(place, "the length of the connectivity", found, "the last offset"));
        }
        dataset.notes.extend(sorter.notes());
        for (number, count) in skipped {
            let [cells, were] = if count == 1 { ["cell", "was"] } else { ["cells", "were"] };
            let kind = format!("of VTK type {number} (no volume, no facet)");
            dataset.notes.push(format!("{count} {cells} {kind} {were} left out"));
        }
        Ok(destinations)
    }

    /// Drops the values of cells, their groups among them, where polygons of very many corners would multiply them beyond what a
    /// file may ask for.
    fn bound_fields(&mut self, dataset: &mut Dataset, destinations: &[Destination]) {
        const ALWAYS: usize = 1 << 24;
        const MOST_PER_VALUE: usize = 16;
        let elements: usize = destinations.iter().map(Destination::count).sum();
        let of_each: usize = self.cell_fields.iter().map(|field| field.components).sum();
        let given: usize = self.cell_fields.iter().map(|field| field.values.len()).sum();
        if of_each.saturating_mul(elements) > given.saturating_mul(MOST_PER_VALUE).max(ALWAYS) {
            self.cell_fields.clear();
            let note = format!(
                "the values and groups of {} cells were left out: their polygons became {elements} facets",
                destinations.len()
            );
            dataset.notes.push(note);
        }
    }
}

fn group<'a>(mesh: &'a mut Mesh, name: &str) -> &'a mut Group {
    mesh.groups.entry(name.to_owned()).or_default()
}

/// Tuples that are not zero.
fn members(field: &Field) -> impl Iterator<Item = usize> + '_ {
    let tuples = field.values.chunks_exact(field.components.max(1)).enumerate();
    tuples.filter(|(_, tuple)| tuple[0] != 0.0).map(|(index, _)| index)
}

/// Cells and facets of a list of cells of the file, which ascends.
fn assign(group: &mut Group, destinations: &[Destination], cells: impl Iterator<Item = usize>) {
    for cell in cells {
        match destinations[cell] {
            Destination::Cell(cell) => group.cells.push(cell),
            Destination::Facets { first, count } => group.facets.extend(first..first + count),
            Destination::Skipped => {}
        }
    }
}

/// `name=value` for each value of an array of marks.
fn groups_of_marks(dataset: &mut Dataset, field: &Field, destinations: &[Destination]) {
    let whole = |value: &f64| value.fract() == 0.0 && value.abs() < 9e15;
    if field.components != 1 || !field.values.iter().all(whole) {
        return;
    }
    let mut parts: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for (cell, value) in field.values.iter().enumerate() {
        parts.entry(*value as i64).or_default().push(cell);
        if parts.len() > MOST_PARTS {
            let note = format!(
                "`{}` has more than {MOST_PARTS} values: taken as numbers, not as groups",
                field.name
            );
            dataset.notes.push(note);
            return;
        }
    }
    for (value, cells) in parts {
        assign(group(&mut dataset.mesh, &format!("{}={value}", field.name)), destinations, cells.into_iter());
    }
}

/// Tuples of volume cells first, then those of facets, each of which has that of the cell it is of.
fn sorted(field: Field, destinations: &[Destination]) -> Field {
    let tuples = || field.values.chunks_exact(field.components).zip(destinations);
    let cells = tuples().filter(|(_, to)| matches!(to, Destination::Cell(_))).map(|(tuple, _)| tuple);
    let of_facets = tuples().filter(|(_, to)| matches!(to, Destination::Facets { .. }));
    let facets = of_facets.flat_map(|(tuple, to)| std::iter::repeat_n(tuple, to.count()));
    let values = cells.chain(facets).flatten().copied().collect();
    Field { values, ..field }
}
