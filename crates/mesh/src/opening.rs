//! The surface of a mesh whose cells go at dates, as when it is cut.
//!
//! A face between two cells is on the surface from when one of them goes until the other one does, and faces away from the one that is
//! left; a face of one cell until that goes. So each face that is ever on the surface is there for one span of time, from one side.

use souple_math::Vec3;

use crate::{Mesh, TriangleSurface};

/// From a date on, until another one [s].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    pub from: f64,
    pub until: f64,
}

impl Span {
    pub const ALWAYS: Self = Self { from: f64::NEG_INFINITY, until: f64::INFINITY };

    pub fn holds(self, time: f64) -> bool {
        self.from <= time && time < self.until
    }

    /// Of a face of two cells that go at dates, infinite where they stay: whether it faces away from the first one, and when it
    /// is seen; `None` where it never is.
    fn of_face(first: f64, second: f64) -> Option<(bool, Self)> {
        (first != second)
            .then(|| (first > second, Self { from: first.min(second), until: first.max(second) }))
    }
}

/// All triangles that are ever on a surface that opens.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OpeningSurface {
    /// They do not bound anything together.
    pub surface: TriangleSurface,
    /// Of each triangle; empty where all stay.
    pub spans: Vec<Span>,
}

impl From<TriangleSurface> for OpeningSurface {
    fn from(surface: TriangleSurface) -> Self {
        Self { surface, spans: Vec::new() }
    }
}

impl OpeningSurface {
    pub fn opens(&self) -> bool {
        !self.spans.is_empty()
    }

    /// When it changes, ascending [s].
    pub fn dates(&self) -> Vec<f64> {
        let ends = self.spans.iter().flat_map(|span| [span.from, span.until]);
        let mut dates: Vec<f64> = ends.filter(|date| date.is_finite()).collect();
        dates.sort_unstable_by(f64::total_cmp);
        dates.dedup();
        dates
    }

    /// When a triangle is on the surface.
    pub fn span(&self, triangle: usize) -> Span {
        self.spans.get(triangle).copied().unwrap_or(Span::ALWAYS)
    }

    /// Whether a triangle is on the surface at a time [s].
    pub fn has(&self, triangle: usize, time: f64) -> bool {
        self.span(triangle).holds(time)
    }

    /// The triangles that are on the surface at a time [s], ascending.
    pub fn at(&self, time: f64) -> impl Iterator<Item = usize> {
        (0..self.surface.triangles.len()).filter(move |triangle| self.has(*triangle, time))
    }

    /// Leaves triangles out, by their corners.
    pub fn retain(&mut self, is_kept: impl Fn(&[u32; 3]) -> bool) {
        let Self { surface, spans } = self;
        let kept: Vec<bool> = surface.triangles.iter().map(is_kept).collect();
        let mut of_span = kept.iter();
        spans.retain(|_| of_span.next() == Some(&true));
        let mut of_cell = kept.iter();
        surface.cells.retain(|_| of_cell.next() == Some(&true));
        let mut of_triangle = kept.iter();
        surface.triangles.retain(|_| of_triangle.next() == Some(&true));
    }

    /// The surface at a time [s], with the numbers its points have in the whole; a boundary of cells is closed at any time.
    pub fn part(&self, time: f64) -> (TriangleSurface, Vec<u32>) {
        let all = &self.surface;
        let of_cell = |triangle: usize| all.cells.get(triangle).copied();
        let triangles: Vec<[u32; 3]> = self.at(time).map(|triangle| all.triangles[triangle]).collect();
        let mut part =
            TriangleSurface::from_mesh(&all.points, &triangles, self.at(time).filter_map(of_cell).collect());
        let points = std::mem::take(&mut part.mesh_points);
        part.mesh_points =
            points.iter().filter_map(|point| all.mesh_points.get(*point as usize)).copied().collect();
        (part, points)
    }

    /// A third of the triangles around each point that are on the surface at a time [s]: the integral of its weight [m²].
    pub fn point_areas(&self, time: f64) -> Vec<f64> {
        let mut areas = vec![0.0; self.surface.points.len()];
        for triangle in self.at(time) {
            let third = self.surface.area_vector(triangle as u32).length() / 3.0;
            self.surface.triangles[triangle].iter().for_each(|corner| areas[*corner as usize] += third);
        }
        areas
    }

    /// The same when each point first is on the surface [m²].
    pub fn first_point_areas(&self) -> Vec<f64> {
        let mut areas = self.point_areas(f64::NEG_INFINITY);
        for date in self.dates() {
            let now = self.point_areas(date);
            areas.iter_mut().zip(now).filter(|(area, _)| **area == 0.0).for_each(|(area, now)| *area = now);
        }
        areas
    }
}

impl Mesh {
    /// All its points, and of its cells those that are kept.
    pub fn of_cells(&self, is_kept: impl Fn(usize) -> bool) -> Self {
        let mut part = Self { points: self.points.clone(), ..Self::default() };
        for (_, cell) in self.cells().enumerate().filter(|(cell, _)| is_kept(*cell)) {
            part.push_cell(cell.kind, cell.nodes);
        }
        part
    }

    /// Leaves out all points but some, which cells have, ascending. Facets and groups must not have others.
    pub fn keep_points(&mut self, kept: &[usize]) {
        let number = |node: u32| kept.partition_point(|point| *point < node as usize) as u32;
        for block in self.blocks.iter_mut().chain(&mut self.facet_blocks) {
            block.nodes.iter_mut().for_each(|node| *node = number(*node));
        }
        self.points = kept.iter().map(|point| self.points[*point]).collect();
    }

    /// What is ever on the surface while cells go, each at its date [s], infinite where it stays; dates that are left out are that.
    ///
    /// Where nothing goes it is [`Mesh::boundary_surface`]; else the triangles of that come first.
    pub fn opening_surface(&self, dates: &[f64]) -> OpeningSurface {
        let goes = |cell: u32| dates.get(cell as usize).copied().unwrap_or(f64::INFINITY);
        if dates.iter().all(|date| *date == f64::INFINITY) {
            return self.boundary_surface().into();
        }
        let (mut triangles, mut cells, mut spans) = (Vec::new(), Vec::new(), Vec::new());
        let mut take = |cell: u32, corners: Vec<[u32; 3]>, span: Span| {
            cells.extend(corners.iter().map(|_| cell));
            spans.extend(corners.iter().map(|_| span));
            triangles.extend(corners);
        };
        self.visit_boundary_triangles(&mut |cell, corners| {
            take(cell, corners, Span { until: goes(cell), ..Span::ALWAYS });
        });
        self.visit_inner_triangles(&mut |[first, second], corners| {
            let Some((is_of_first, span)) = Span::of_face(goes(first), goes(second)) else { return };
            if is_of_first {
                take(first, corners, span);
            } else {
                take(second, corners.into_iter().map(|[a, b, c]| [a, c, b]).collect(), span);
            }
        });
        OpeningSurface { surface: TriangleSurface::from_mesh(&self.points, &triangles, cells), spans }
    }
}

/// The triangle on the other side of each edge of each triangle of a closed surface, around the matter between them.
///
/// Bodies may touch along an edge, with several pairs of triangles: each triangle goes with the next one through what it bounds,
/// by the angle about the edge, so that what touches is kept apart.
pub(crate) fn opposite_triangles(surface: &TriangleSurface) -> Vec<[u32; 3]> {
    let mut edges: Vec<([u32; 2], bool, u32, usize)> = Vec::with_capacity(3 * surface.triangles.len());
    for (triangle, corners) in surface.triangles.iter().enumerate() {
        for edge in 0..3 {
            let (a, b) = (corners[edge], corners[(edge + 1) % 3]);
            edges.push(([a.min(b), a.max(b)], a < b, triangle as u32, edge));
        }
    }
    edges.sort_unstable();
    let mut opposite = vec![[0; 3]; surface.triangles.len()];
    for around in edges.chunk_by(|a, b| a.0 == b.0) {
        let (backward, forward) = around.split_at(around.partition_point(|(_, is_up, _, _)| !is_up));
        let mut left: Vec<_> = backward.iter().collect();
        for (ends, _, one, edge) in forward {
            let turned = |other: u32| angle_through(surface, *ends, [*one, other]);
            let nearest = (0..left.len()).min_by(|a, b| turned(left[*a].2).total_cmp(&turned(left[*b].2)));
            let Some(nearest) = nearest else { continue };
            let (_, _, other, its_edge) = *left.swap_remove(nearest);
            opposite[*one as usize][*edge] = other;
            opposite[other as usize][its_edge] = *one;
        }
    }
    opposite
}

/// The angle about an edge from a triangle that runs along it to another one, through what the first one bounds [rad, 0 to 2π].
fn angle_through(surface: &TriangleSurface, [a, b]: [u32; 2], [one, other]: [u32; 2]) -> f64 {
    let at = |point: u32| surface.points[point as usize];
    let away = |triangle: u32| {
        let third = surface.triangles[triangle as usize].into_iter().find(|point| *point != a && *point != b);
        at(third.unwrap_or(a)) - at(a)
    };
    let along = (at(b) - at(a)).try_normalised().unwrap_or(Vec3::ZERO);
    let across = |v: Vec3| v - along * v.dot(along);
    let (u, v) = (across(away(one)), across(away(other)));
    // outward is along × u, so matter is reached by turning against it
    let angle = libm::atan2(-along.cross(u).dot(v), u.dot(v));
    if angle < 0.0 { angle + std::f64::consts::TAU } else { angle }
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;
    use crate::{SignedDistance, generate};

    fn cubes(element: &'static str) -> Mesh {
        let values = Values::new()
            .with("size", Value::Vector([2.0, 2.0, 1.0]))
            .with("cells", Value::Vector([2.0, 2.0, 1.0]))
            .with("element", Value::Text(element));
        generate("box", values).unwrap()
    }

    fn centre(mesh: &Mesh, cell: usize) -> Vec3 {
        let nodes: Vec<u32> = mesh.cells().nth(cell).unwrap().nodes.to_vec();
        nodes.iter().map(|node| mesh.points[*node as usize]).sum::<Vec3>() * (1.0 / nodes.len() as f64)
    }

    /// At any time the triangles of that time are the boundary of the cells that are left: closed, outward, of their volume.
    #[test]
    fn parts_bound_what_is_left() {
        for element in ["tet4", "hex8", "prism6"] {
            let mesh = cubes(element);
            // the first quarter goes at 1 s, the one across at 2 s, the third at 2 s, the last one stays
            let date = |cell| match centre(&mesh, cell) {
                c if c.x < 1.0 && c.y < 1.0 => 1.0,
                c if c.x > 1.0 && c.y > 1.0 => 2.0,
                c if c.x < 1.0 => 2.0,
                _ => f64::INFINITY,
            };
            let dates: Vec<f64> = (0..mesh.cell_count()).map(date).collect();
            let opening = mesh.opening_surface(&dates);
            assert_eq!(opening.dates(), [1.0, 2.0]);
            for (time, volume, area) in
                [(0.0, 4.0, 16.0), (1.0, 3.0, 14.0), (1.9, 3.0, 14.0), (2.0, 1.0, 6.0)]
            {
                let (part, points) = opening.part(time);
                part.check_closed().unwrap();
                assert!((part.enclosed_volume() - volume).abs() < 1e-12, "{element} {time}");
                assert!((part.area() - area).abs() < 1e-12, "{element} {time}");
                assert!((opening.point_areas(time).iter().sum::<f64>() - area).abs() < 1e-12);
                let of_part =
                    |(point, place): (&u32, &Vec3)| opening.surface.points[*point as usize] == *place;
                assert!(points.iter().zip(&part.points).all(of_part));
            }
            let never = mesh.opening_surface(&vec![f64::INFINITY; dates.len()]);
            assert_eq!((never.opens(), &never.surface), (false, &mesh.boundary_surface()));
        }
    }

    /// Nothing is left of cells that all go; what is there from the start is open then.
    #[test]
    fn all_or_at_once() {
        let mesh = cubes("tet4");
        let all = mesh.opening_surface(&vec![0.5; mesh.cell_count()]);
        assert_eq!((all.at(0.4).count(), all.at(0.5).count()), (all.surface.triangles.len(), 0));
        let mut dates = vec![f64::INFINITY; mesh.cell_count()];
        dates[0] = 0.0;
        let (open, _) = mesh.opening_surface(&dates).part(0.0);
        let cell = mesh.cells().next().unwrap();
        let corner =
            |place: usize| mesh.points[cell.nodes[place] as usize] - mesh.points[cell.nodes[0] as usize];
        let volume = corner(1).dot(corner(2).cross(corner(3))).abs() / 6.0;
        assert!((open.enclosed_volume() - (4.0 - volume)).abs() < 1e-12);
    }

    /// Two columns that touch along an edge alone are kept apart: from each side of that edge the nearest face is that of the column
    /// there, and what is between them is outside.
    #[test]
    fn columns_that_touch_along_an_edge() {
        for element in ["tet4", "hex8"] {
            let mesh = cubes(element);
            let is_left = |c: Vec3| (c.x < 1.0) == (c.y < 1.0);
            let date = |cell| if is_left(centre(&mesh, cell)) { f64::INFINITY } else { 0.0 };
            let dates: Vec<f64> = (0..mesh.cell_count()).map(date).collect();
            let (surface, _) = mesh.opening_surface(&dates).part(0.0);
            assert!(SignedDistance::new(surface.clone()).is_err());
            let distance = SignedDistance::of_boundary(surface).unwrap();
            for (x, y) in [(0.9, 0.8), (1.1, 1.2), (0.8, 1.1), (1.2, 0.9), (0.99, 1.02), (1.3, 1.1)] {
                let d = distance.distance(Vec3::new(x, y, 0.5));
                let expected = f64::min((x - 1.0_f64).abs(), (y - 1.0_f64).abs());
                let expected = if is_left(Vec3::new(x, y, 0.5)) { -expected } else { expected };
                assert!((d - expected).abs() < 1e-12, "{element} {x} {y}: {d} for {expected}");
            }
        }
    }
}
