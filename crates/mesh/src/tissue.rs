//! Shapes of tissue between two surfaces: ligaments, sheets and pads that begin on one and end on the other.
//!
//! A ligament has a square section and goes from the middle of one patch to that of the other. A sheet is as wide as the
//! patches are across the way between them, and follows them where they turn. A pad fills the gap: every face of the
//! first patch is carried along the way between the two until it meets the second. Ends stand on the surfaces themselves,
//! so that what is attached there is in touch.

use souple_math::{Mat3, Vec3, eigen_symmetric};

use crate::{ElementKind, Group, Mesh, closest_point_on_triangle};

/// What joins two surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TissueForm {
    Ligament,
    Sheet,
    Pad,
}

/// A part of a surface that tissue ends on.
#[derive(Clone, Debug, Default)]
pub struct Patch {
    /// All that are in it [m].
    pub points: Vec<Vec3>,
    /// Corners of its faces, three or four, the normal outward; none where a body has no surface.
    pub faces: Vec<Vec<Vec3>>,
}

/// Tissue to be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tissue {
    pub form: TissueForm,
    /// Of a ligament its sides, of a sheet that of it, of a pad the widest gap that is filled [m].
    pub thickness: f64,
    /// Cells from one end to the other.
    pub along: usize,
    /// Of a ligament or sheet, over its width.
    pub across: usize,
    /// Of a ligament or sheet, through its thickness.
    pub through: usize,
}

/// Tissue that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TissueError {
    #[error("the two regions have their middles at one place, ({}, {}, {}): there is no way between them", .at.x, .at.y, .at.z)]
    NoWay { at: Vec3 },
    #[error(
        "the region at ({}, {}, {}) is no wider than {width:.3e} m across the way to the other: a sheet has no width there",
        .at.x, .at.y, .at.z
    )]
    NoWidth { at: Vec3, width: f64 },
    #[error("a pad begins on faces, and the first region has none")]
    NoFaces,
    #[error("no face of the first region has the second one before it{}", .nearest.map(|gap| format!(" within {thickness:.3e} m: the narrowest gap is {gap:.3e} m")).unwrap_or_default())]
    NoGap { thickness: f64, nearest: Option<f64> },
}

impl TissueError {
    /// What would be accepted.
    pub fn expected(&self) -> &'static str {
        match self {
            Self::NoWay { .. } => "regions of the two bodies that are apart",
            Self::NoWidth { .. } => "regions with points beside each other, or a ligament",
            Self::NoFaces => "a region that holds whole faces of the surface, or a ligament",
            Self::NoGap { .. } => "regions that face each other, or a greater `thickness`",
        }
    }
}

/// Groups of the ends of tissue.
pub const ENDS: [&str; 2] = ["from_end", "to_end"];

/// Lengths below this part of the size of the patches count as nothing: rounding of coordinates.
const NOTHING: f64 = 1e-9;

impl Patch {
    fn middle(&self) -> Vec3 {
        self.points.iter().copied().sum::<Vec3>() / self.points.len().max(1) as f64
    }

    fn triangles(&self) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        self.faces.iter().flat_map(|face| (2..face.len()).map(|k| [face[0], face[k - 1], face[k]]))
    }

    /// The nearest place on its faces; the point itself where it has none.
    fn nearest(&self, point: Vec3) -> Vec3 {
        let places = self.triangles().map(|corners| {
            let (weights, _) = closest_point_on_triangle(point, corners);
            corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]
        });
        places.min_by(|a, b| (*a - point).length_sq().total_cmp(&(*b - point).length_sq())).unwrap_or(point)
    }

    /// How far from a point its faces are along a direction of length one.
    fn distance_along(&self, point: Vec3, direction: Vec3) -> Option<f64> {
        self.triangles().filter_map(|corners| ray_meets(point, direction, corners)).min_by(f64::total_cmp)
    }

    /// How it spreads about its middle.
    fn spread(&self) -> Mat3 {
        let middle = self.middle();
        self.points.iter().fold(Mat3::ZERO, |sum, point| sum + (*point - middle).outer(*point - middle))
    }
}

/// Where a ray meets a triangle, its edges included [m]: Möller & Trumbore 1997, for points behind by no more than
/// rounding too.
fn ray_meets(point: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> Option<f64> {
    let (ab, ac, from) = (b - a, c - a, point - a);
    let normal = direction.cross(ac);
    let scale = ab.dot(normal);
    let size = ab.length() * ac.length();
    if scale.abs() <= NOTHING * size {
        return None;
    }
    let u = from.dot(normal) / scale;
    let around = from.cross(ab);
    let v = direction.dot(around) / scale;
    let distance = ac.dot(around) / scale;
    let is_inside = u >= -NOTHING && v >= -NOTHING && u + v <= 1.0 + NOTHING;
    (is_inside && distance >= -NOTHING * size.sqrt()).then_some(distance)
}

/// The mesh of tissue from one patch to another, with groups of its [`ENDS`]; hexahedra, and prisms over triangles.
///
/// # Errors
/// The patches leave no room for it, in words.
pub fn tissue(from: &Patch, to: &Patch, wanted: &Tissue) -> Result<Mesh, TissueError> {
    let (start, end) = (from.middle(), to.middle());
    let size = (end - start).length() + from.spread().trace().sqrt() + to.spread().trace().sqrt();
    let way = end - start;
    if way.length() <= NOTHING * size {
        return Err(TissueError::NoWay { at: start });
    }
    let direction = way / way.length();
    match wanted.form {
        TissueForm::Pad => pad(from, to, direction, wanted),
        TissueForm::Ligament => {
            // any direction across will do for a square
            let least = direction.to_array().map(f64::abs);
            let axis = (0..3).min_by(|a, b| least[*a].total_cmp(&least[*b])).unwrap_or(0);
            let across = direction.cross(Vec3::AXES[axis]);
            let across = across / across.length();
            let half = 0.5 * wanted.thickness;
            let ends = [from, to].map(|patch| (patch, across, [-half, half]));
            Ok(loft(ends, direction, wanted))
        }
        TissueForm::Sheet => {
            let first = width(from, direction, None, size)?;
            let second = width(to, direction, Some(first.0), size)?;
            Ok(loft([(from, first.0, first.1), (to, second.0, second.1)], direction, wanted))
        }
    }
}

/// The direction in which a patch is widest across the way, and where it begins and ends along it [m]; on the side of
/// `like`.
fn width(
    patch: &Patch,
    direction: Vec3,
    like: Option<Vec3>,
    size: f64,
) -> Result<(Vec3, [f64; 2]), TissueError> {
    let middle = patch.middle();
    let flat = Mat3::IDENTITY - direction.outer(direction);
    let eigen = eigen_symmetric(&(flat * patch.spread() * flat));
    let values = eigen.values.to_array();
    let widest = (0..3).max_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap_or(0);
    let mut axis = eigen.vectors.columns[widest];
    // of two signs the one that does not twist the sheet, or the one along the axes
    let reference = like.unwrap_or(Vec3::new(1.0, 1e-3, 1e-6));
    if axis.dot(reference) < 0.0 {
        axis = -axis;
    }
    let along = patch.points.iter().map(|point| (*point - middle).dot(axis));
    let ends = along.fold([0.0_f64; 2], |[low, high], x| [low.min(x), high.max(x)]);
    if ends[1] - ends[0] <= NOTHING * size {
        return Err(TissueError::NoWidth { at: middle, width: ends[1] - ends[0] });
    }
    Ok((axis, ends))
}

/// Hexahedra between two sections, each of a patch, the direction of its width and the ends of that.
fn loft(ends: [(&Patch, Vec3, [f64; 2]); 2], direction: Vec3, wanted: &Tissue) -> Mesh {
    let Tissue { along, across, through, thickness, .. } = *wanted;
    let section = |(patch, axis, [low, high]): (&Patch, Vec3, [f64; 2])| -> Vec<Vec3> {
        let normal = direction.cross(axis);
        let normal = normal / normal.length();
        let place = |j: usize, k: usize| {
            let u = low + (high - low) * j as f64 / across as f64;
            let v = thickness * (k as f64 / through as f64 - 0.5);
            patch.nearest(patch.middle() + axis * u + normal * v)
        };
        (0..=through).flat_map(|k| (0..=across).map(move |j| (j, k))).map(|(j, k)| place(j, k)).collect()
    };
    let [first, last] = ends.map(section);
    let mut points = Vec::new();
    for layer in 0..=along {
        let part = layer as f64 / along as f64;
        points.extend(first.iter().zip(&last).map(|(a, b)| *a * (1.0 - part) + *b * part));
    }
    let number = |i: usize, j: usize, k: usize| (i * first.len() + k * (across + 1) + j) as u32;
    let mut mesh = Mesh { points, ..Mesh::default() };
    for i in 0..along {
        for k in 0..through {
            for j in 0..across {
                let ring = |i: usize| {
                    [number(i, j, k), number(i, j + 1, k), number(i, j + 1, k + 1), number(i, j, k + 1)]
                };
                let [near, far] = [ring(i), ring(i + 1)];
                mesh.push_cell(ElementKind::Hex8, &[near, far].concat());
            }
        }
    }
    name_ends(&mut mesh, first.len());
    mesh
}

/// Cells between faces of a patch and where they meet the other.
fn pad(from: &Patch, to: &Patch, direction: Vec3, wanted: &Tissue) -> Result<Mesh, TissueError> {
    if from.faces.is_empty() {
        return Err(TissueError::NoFaces);
    }
    let Tissue { along, thickness, .. } = *wanted;
    let mut narrowest: Option<f64> = None;
    let mut feet: Vec<(Vec3, f64)> = Vec::new();
    let mut known = std::collections::HashMap::new();
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for face in &from.faces {
        let gaps: Vec<Option<f64>> =
            face.iter().map(|corner| to.distance_along(*corner, direction)).collect();
        for gap in gaps.iter().flatten() {
            narrowest = Some(narrowest.map_or(*gap, |least| least.min(*gap)));
        }
        let fits = |gap: &Option<f64>| gap.is_some_and(|gap| gap <= thickness && gap > 1e-6 * thickness);
        if !gaps.iter().all(fits) {
            continue;
        }
        let corners = face.iter().zip(&gaps).map(|(corner, gap)| {
            let key = corner.to_array().map(f64::to_bits);
            *known.entry(key).or_insert_with(|| {
                feet.push((*corner, gap.unwrap_or(0.0)));
                feet.len() as u32 - 1
            })
        });
        faces.push(corners.collect());
    }
    if faces.is_empty() {
        return Err(TissueError::NoGap { thickness, nearest: narrowest });
    }
    let mut mesh = Mesh::default();
    for layer in 0..=along {
        let part = layer as f64 / along as f64;
        mesh.points.extend(feet.iter().map(|(foot, gap)| *foot + direction * (*gap * part)));
    }
    let count = feet.len() as u32;
    for kind in [ElementKind::Hex8, ElementKind::Prism6] {
        let corners = kind.node_count() / 2;
        for layer in 0..along as u32 {
            for face in faces.iter().filter(|face| face.len() == corners) {
                let near = face.iter().map(|corner| layer * count + corner);
                let far = face.iter().map(|corner| (layer + 1) * count + corner);
                mesh.push_cell(kind, &near.chain(far).collect::<Vec<u32>>());
            }
        }
    }
    name_ends(&mut mesh, feet.len());
    Ok(mesh)
}

/// Groups of the first and the last so many points.
fn name_ends(mesh: &mut Mesh, of_end: usize) {
    let (all, of_end) = (mesh.points.len() as u32, of_end as u32);
    for (name, points) in ENDS.into_iter().zip([0..of_end, all - of_end..all]) {
        mesh.groups.insert(name.to_owned(), Group { points: points.collect(), ..Group::default() });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of so many faces in the plane of a height, from `low` to `high` in x and z.
    fn square(low: f64, high: f64, height: impl Fn(f64) -> f64, faces: usize) -> Patch {
        let at = |i: usize| low + (high - low) * i as f64 / faces as f64;
        let corner = |i: usize, j: usize| Vec3::new(at(i), height(at(i)), at(j));
        let all = |n: usize| (0..n).flat_map(move |i| (0..n).map(move |j| (i, j)));
        Patch {
            points: all(faces + 1).map(|(i, j)| corner(i, j)).collect(),
            faces: all(faces)
                .map(|(i, j)| vec![corner(i, j), corner(i, j + 1), corner(i + 1, j + 1), corner(i + 1, j)])
                .collect(),
        }
    }

    fn volume(mesh: &mut Mesh) -> f64 {
        mesh.validate().expect("a mesh that can be computed on");
        mesh.volume()
    }

    const PAD: Tissue = Tissue { form: TissueForm::Pad, thickness: 2.0, along: 3, across: 2, through: 1 };

    /// A pad fills what lies between two surfaces where they face each other, and no more.
    #[test]
    fn pads_fill_gaps() {
        let (floor, slope) = (square(0.0, 4.0, |_| 0.0, 4), square(1.0, 3.0, |x| 1.0 + 0.1 * (x - 2.0), 3));
        let mut pad = tissue(&floor, &slope, &PAD).unwrap();
        // two by two under a slope of mean height one
        assert!((volume(&mut pad) - 4.0).abs() < 1e-12);
        assert_eq!(pad.groups[ENDS[0]].points.len(), 9);
        for point in &pad.groups[ENDS[1]].points {
            let x = pad.points[*point as usize];
            assert!((x.y - 1.0 - 0.1 * (x.x - 2.0)).abs() < 1e-12, "{x:?}");
        }
        let far = Tissue { thickness: 0.5, ..PAD };
        assert!(matches!(tissue(&floor, &slope, &far), Err(TissueError::NoGap { nearest: Some(_), .. })));
        assert!(matches!(tissue(&floor, &floor, &PAD), Err(TissueError::NoWay { .. })));
    }

    /// Ligaments and sheets begin and end on the surfaces, with the section that was asked for.
    #[test]
    fn ligaments_and_sheets_reach_from_one_to_the_other() {
        let (floor, roof) = (square(0.0, 4.0, |_| 0.0, 4), square(0.0, 4.0, |_| 3.0, 4));
        let ligament = Tissue { form: TissueForm::Ligament, thickness: 0.5, ..PAD };
        let mut mesh = tissue(&floor, &roof, &ligament).unwrap();
        assert!((volume(&mut mesh) - 3.0 * 0.25).abs() < 1e-12);
        // a line of points has no faces, and a width
        let edge = |height: f64| Patch {
            points: (0..5).map(|i| Vec3::new(f64::from(i), height, 2.0)).collect(),
            faces: Vec::new(),
        };
        let sheet = Tissue { form: TissueForm::Sheet, thickness: 0.5, ..PAD };
        let mut mesh = tissue(&edge(0.0), &edge(3.0), &sheet).unwrap();
        assert!((volume(&mut mesh) - 3.0 * 4.0 * 0.5).abs() < 1e-12);
        let point = Patch { points: vec![Vec3::new(2.0, 3.0, 2.0)], faces: Vec::new() };
        assert!(matches!(tissue(&edge(0.0), &point, &sheet), Err(TissueError::NoWidth { .. })));
    }
}
