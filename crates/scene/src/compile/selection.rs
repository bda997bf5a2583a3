//! Which points and cells of a mesh a region holds.

use std::collections::HashSet;

use souple_math::Vec3;
use souple_mesh::{ElementKind, Mesh};
use souple_models::solids::Section;

use crate::diagnostic::{Code, Log, Site};
use crate::keys::did_you_mean;
use crate::spec::region::{Region, RegionKind};

/// A placed mesh and what messages call it.
#[derive(Clone, Copy)]
pub struct Selector<'a> {
    pub body: &'a str,
    pub mesh: &'a Mesh,
    /// The number that each point had in its file, ascending.
    pub point_numbers: &'a [u32],
    /// What the cells are sections of.
    pub section: Section,
    pub log: &'a Log,
}

impl Selector<'_> {
    /// Points of a region, ascending; an empty region is refused, with how far the nearest point is.
    pub fn points(&self, region: &Region) -> Vec<u32> {
        let Some(mask) = self.point_mask(region) else { return Vec::new() };
        let found = indices(&mask);
        if found.is_empty() {
            self.refuse_empty(region, "point", &self.mesh.points);
        }
        found
    }

    /// The same of a mesh that need have none there.
    pub fn points_if_any(&self, region: &Region) -> Vec<u32> {
        self.point_mask(region).map_or_else(Vec::new, |mask| indices(&mask))
    }

    /// Cells of a region, ascending; an empty region is refused.
    pub fn cells(&self, region: &Region) -> Vec<u32> {
        let centres = self.mesh.cell_centres();
        let Some(mask) = self.cell_mask(region, &centres) else { return Vec::new() };
        let found = indices(&mask);
        if found.is_empty() {
            self.refuse_empty(region, "cell", &centres);
        }
        found
    }

    /// Faces of the boundary of which all nodes are in a region, as points in order with the normal outward; a
    /// group of facets holds just its facets. Those of a plane body are its sides, those of a membrane its cells. A
    /// region without one is refused.
    pub fn faces(&self, region: &Region) -> Vec<(ElementKind, Vec<u32>)> {
        let (faces, centres_of_others) = self.faces_in_and_out(region);
        if faces.is_empty() {
            self.refuse_empty(region, "face", &centres_of_others);
        }
        faces
    }

    /// The same, a region without one being none to complain about.
    pub fn whole_faces(&self, region: &Region) -> Vec<(ElementKind, Vec<u32>)> {
        self.faces_in_and_out(region).0
    }

    /// Faces in a region, and the middles of those that are not.
    fn faces_in_and_out(&self, region: &Region) -> (Vec<(ElementKind, Vec<u32>)>, Vec<Vec3>) {
        let Some(mask) = self.point_mask(region) else { return Default::default() };
        let listed = self.facets_of_group(region);
        let mut faces = Vec::new();
        let mut centres = Vec::new();
        for (kind, face) in self.all_faces() {
            let is_inside = match &listed {
                Some(facets) => facets.contains(&ascending(&face)),
                None => face.iter().all(|point| mask[*point as usize]),
            };
            if is_inside {
                faces.push((kind, face));
            } else {
                let sum: Vec3 = face.iter().map(|point| self.mesh.points[*point as usize]).sum();
                centres.push(sum * (1.0 / face.len() as f64));
            }
        }
        (faces, centres)
    }

    /// Faces of the surface; of a membrane its cells.
    pub fn all_faces(&self) -> Vec<(ElementKind, Vec<u32>)> {
        if matches!(self.section, Section::Membrane { .. }) {
            return self.mesh.cells().map(|cell| (cell.kind, cell.nodes.to_vec())).collect();
        }
        let face = |boundary: souple_mesh::BoundaryFace| {
            let cell = self.mesh.cell(boundary.cell)?;
            let (kind, nodes) = cell.face_nodes(boundary.face.into());
            let nodes: Vec<u32> = nodes.collect();
            Some((kind, nodes))
        };
        self.mesh.faces().boundary.into_iter().filter_map(face).collect()
    }

    /// Points of each facet of the group that a region names; `None` where it names none with facets.
    fn facets_of_group(&self, region: &Region) -> Option<HashSet<Vec<u32>>> {
        let RegionKind::Group(name) = &region.kind else { return None };
        let facets = &self.mesh.groups.get(name)?.facets;
        let listed = |facet: &usize| facets.binary_search(&(*facet as u32)).is_ok();
        let views = self.mesh.facets().enumerate().filter(|(facet, _)| listed(facet));
        let corners: HashSet<Vec<u32>> = views.map(|(_, view)| ascending(view.nodes)).collect();
        (!corners.is_empty()).then_some(corners)
    }

    fn refuse_empty(&self, region: &Region, what: &str, positions: &[Vec3]) {
        let distance = |x: &Vec3| distance_to(&region.kind, *x);
        let nearest = positions
            .iter()
            .enumerate()
            .filter_map(|(index, x)| distance(x).map(|distance| (index, distance)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        let hint = nearest.map_or_else(String::new, |(index, distance)| {
            let x = positions[index];
            format!(
                "; the nearest, {what} {index} at ({}, {}, {}), is {distance:.3e} m away from it",
                x.x, x.y, x.z
            )
        });
        let message = format!("this region holds no {what} of body `{}`{hint}", self.body);
        let bounds = self.mesh.bounds();
        let (low, high) = (bounds.low, bounds.high);
        let expected = format!(
            "a region within the body's box from ({}, {}, {}) to ({}, {}, {})",
            low.x, low.y, low.z, high.x, high.y, high.z
        );
        self.log.add(Code::EmptyRegion, &region.site, message, expected);
    }

    /// Per point; `None` where the region was refused.
    fn point_mask(&self, region: &Region) -> Option<Vec<bool>> {
        let points = &self.mesh.points;
        let of_cells = |cells: &[u32], mask: &mut Vec<bool>| {
            for view in cells.iter().filter_map(|cell| self.mesh.cell(*cell)) {
                view.nodes.iter().for_each(|node| mask[*node as usize] = true);
            }
        };
        let mut mask = vec![false; points.len()];
        match &region.kind {
            RegionKind::Group(name) => {
                let group = self.group(name, &region.site)?;
                group.points.iter().for_each(|point| mask[*point as usize] = true);
                of_cells(&group.cells, &mut mask);
                let in_group = |facet: &usize| group.facets.binary_search(&(*facet as u32)).is_ok();
                for (_, view) in self.mesh.facets().enumerate().filter(|(facet, _)| in_group(facet)) {
                    view.nodes.iter().for_each(|node| mask[*node as usize] = true);
                }
            }
            RegionKind::Nearest(target) => {
                let nearest = nearest(points, *target);
                nearest.into_iter().for_each(|point| mask[point] = true);
            }
            RegionKind::Points(listed) => {
                for number in listed {
                    match self.point_numbers.binary_search(number) {
                        Ok(point) => mask[point] = true,
                        Err(_) => {
                            return self.refuse_number(
                                "point",
                                *number,
                                self.point_numbers.len(),
                                &region.site,
                            );
                        }
                    }
                }
            }
            RegionKind::Cells(listed) => {
                self.check_cells(listed, &region.site)?;
                of_cells(listed, &mut mask);
            }
            RegionKind::Union(parts) => {
                return combined(parts, |part| self.point_mask(part), mask, |a, b| a || b);
            }
            RegionKind::Intersection(parts) => {
                mask.fill(true);
                return combined(parts, |part| self.point_mask(part), mask, |a, b| a && b);
            }
            RegionKind::Not(part) => {
                return Some(self.point_mask(part)?.iter().map(|inside| !inside).collect());
            }
            kind => return Some(points.iter().map(|point| holds(kind, *point)).collect()),
        }
        Some(mask)
    }

    /// Per cell: by its centre, or by its number or group.
    fn cell_mask(&self, region: &Region, centres: &[Vec3]) -> Option<Vec<bool>> {
        let mut mask = vec![false; centres.len()];
        match &region.kind {
            RegionKind::Group(name) => {
                let group = self.group(name, &region.site)?;
                if group.cells.is_empty() {
                    let points = self.point_mask(region)?;
                    return Some(self.cells_within(&points));
                }
                group.cells.iter().for_each(|cell| mask[*cell as usize] = true);
            }
            RegionKind::Points(_) => return Some(self.cells_within(&self.point_mask(region)?)),
            RegionKind::Cells(listed) => {
                self.check_cells(listed, &region.site)?;
                listed.iter().for_each(|cell| mask[*cell as usize] = true);
            }
            RegionKind::Nearest(target) => {
                nearest(centres, *target).into_iter().for_each(|cell| mask[cell] = true)
            }
            RegionKind::Union(parts) => {
                return combined(parts, |part| self.cell_mask(part, centres), mask, |a, b| a || b);
            }
            RegionKind::Intersection(parts) => {
                mask.fill(true);
                return combined(parts, |part| self.cell_mask(part, centres), mask, |a, b| a && b);
            }
            RegionKind::Not(part) => {
                return Some(self.cell_mask(part, centres)?.iter().map(|inside| !inside).collect());
            }
            kind => return Some(centres.iter().map(|centre| holds(kind, *centre)).collect()),
        }
        Some(mask)
    }

    /// Cells of which all nodes are in a mask.
    fn cells_within(&self, points: &[bool]) -> Vec<bool> {
        self.mesh.cells().map(|cell| cell.nodes.iter().all(|node| points[*node as usize])).collect()
    }

    fn group(&self, name: &str, site: &Site) -> Option<&souple_mesh::Group> {
        let group = self.mesh.groups.get(name);
        if group.is_none() {
            let known: Vec<&str> = self.mesh.groups.keys().map(String::as_str).collect();
            let message = format!(
                "the mesh of body `{}` has no group `{name}`{}",
                self.body,
                did_you_mean(name, known.iter().copied())
            );
            let expected = if known.is_empty() {
                "a region by shape: the mesh has no groups".to_owned()
            } else {
                format!("one of {}", known.join(", "))
            };
            self.log.add(Code::UnknownName, site, message, expected);
        }
        group
    }

    fn check_cells(&self, cells: &[u32], site: &Site) -> Option<()> {
        let count = self.mesh.cell_count();
        match cells.iter().find(|cell| **cell as usize >= count) {
            Some(&cell) => self.refuse_number("cell", cell, count, site),
            None => Some(()),
        }
    }

    fn refuse_number<T>(&self, what: &str, number: u32, count: usize, site: &Site) -> Option<T> {
        let message = format!("the mesh of body `{}` has no {what} {number}; it has {count}", self.body);
        self.log.add(Code::OutOfRange, site, message, format!("numbers of {what}s of the mesh"));
        None
    }
}

fn ascending(points: &[u32]) -> Vec<u32> {
    let mut points = points.to_vec();
    points.sort_unstable();
    points
}

/// The masks of all parts joined one after the other to `start`. All parts are looked at, so that each refused one is
/// reported.
fn combined(
    parts: &[Region],
    mask_of: impl Fn(&Region) -> Option<Vec<bool>>,
    start: Vec<bool>,
    join: fn(bool, bool) -> bool,
) -> Option<Vec<bool>> {
    let masks: Vec<Option<Vec<bool>>> = parts.iter().map(mask_of).collect();
    masks.into_iter().try_fold(start, |joined, mask| {
        Some(joined.into_iter().zip(mask?).map(|(joined, inside)| join(joined, inside)).collect())
    })
}

fn indices(mask: &[bool]) -> Vec<u32> {
    (0..mask.len() as u32).filter(|index| mask[*index as usize]).collect()
}

/// The first of the closest.
fn nearest(positions: &[Vec3], target: Vec3) -> Option<usize> {
    let distance = |index: &usize| (positions[*index] - target).length_sq();
    (0..positions.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

fn holds(kind: &RegionKind, x: Vec3) -> bool {
    match kind {
        RegionKind::All => true,
        RegionKind::Formula(condition) => condition.holds(&[x.x, x.y, x.z]),
        kind => distance_to(kind, x).is_some_and(|distance| distance <= 0.0),
    }
}

/// How far a position is from a region that is a shape, zero or less inside [m].
fn distance_to(kind: &RegionKind, x: Vec3) -> Option<f64> {
    match kind {
        RegionKind::Box { low, high } => {
            Some(souple_mesh::BoundingBox { low: *low, high: *high }.distance_sq(x).sqrt())
        }
        RegionKind::Sphere { centre, radius } => Some((x - *centre).length() - radius),
        RegionKind::HalfSpace { point, normal } => Some((x - *point).dot(*normal)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;

    fn select(text: &str) -> (Vec<u32>, Vec<u32>, bool) {
        let values = Values::new()
            .with("size", Value::Vector([2.0, 1.0, 1.0]))
            .with("cells", Value::Vector([2.0, 1.0, 1.0]))
            .with("element", Value::Text("hex8"));
        let mesh = souple_mesh::generate("bar", values).expect("a bar");
        let numbers: Vec<u32> = (0..mesh.points.len() as u32).collect();
        let log = Log::default();
        let mut sources = crate::source::Sources::default();
        let source =
            crate::source::Source { name: String::new(), folder: Default::default(), text: text.to_owned() };
        let source = sources.add(source);
        let document = crate::document::parse(&sources, source, &log);
        let node = document.get("r").expect("a region");
        let reading = crate::values::Reading { node, path: String::new(), log: &log };
        let region = Region::from_reading(&reading, 0).expect("a region");
        let selector = Selector {
            body: "bar",
            mesh: &mesh,
            point_numbers: &numbers,
            section: Section::Solid,
            log: &log,
        };
        let result = (selector.points(&region), selector.cells(&region));
        (result.0, result.1, log.is_empty())
    }

    /// Twelve corners of two cubes, `i + 3 (j + 2 k)`; each kind of region holds what its words say.
    #[test]
    fn regions_hold_what_they_say() {
        let ends = vec![0, 3, 6, 9];
        assert_eq!(select("r = \"x_min\"").0, ends);
        assert_eq!(select("r = { box = [[0, 1, 1], [0.5, 0, 0]] }"), (ends.clone(), vec![0], true));
        assert_eq!(select("r = { half_space = { point = [0.1, 0, 0], normal = [2, 0, 0] } }").0, ends);
        assert_eq!(select("r = { sphere = { centre = [0, 0, 0], radius = 1 } }").0, [0, 1, 3, 6]);
        assert_eq!(select("r = { formula = \"x < 0.6 and y >= 0\" }"), (ends, vec![0], true));
        assert_eq!(select("r = { nearest = [9, 0, 0.1] }"), (vec![2], vec![1], true));
        assert_eq!(select("r = { points = [4, 4] }").0, [4]);
        assert_eq!(select("r = { cells = [1] }").0, [1, 2, 4, 5, 7, 8, 10, 11]);
        assert_eq!(select("r = { all = true }").1, [0, 1]);
        assert_eq!(select("r = { not = { cells = [0] } }").1, [1]);
        assert_eq!(select("r = { union = [{ cells = [0] }, { cells = [1] }] }").1, [0, 1]);
        assert_eq!(select("r = { intersection = [{ cells = [0] }, { cells = [1] }] }").0, [1, 4, 7, 10]);
    }

    /// What holds nothing, or asks for what is not there, is refused.
    #[test]
    fn empty_regions_are_refused() {
        for text in [
            "{ box = [[5, 5, 5], [6, 6, 6]] }",
            "{ points = [12] }",
            "{ cells = [2] }",
            "\"x_mim\"",
            "{ points = [] }",
        ] {
            assert!(!select(&format!("r = {text}")).2, "{text}");
        }
    }
}
