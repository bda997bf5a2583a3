//! Shapes of tissue between two surfaces: ligaments, sheets and pads that begin on one and end on the other.
//!
//! A ligament has a square section and goes from the middle of one patch to that of the other. A sheet is as wide as the
//! patches are across the way between them, and follows them where they turn. A pad fills the gap: every face of the
//! first patch is carried along the way between the two until it meets the second. Ends stand on the surfaces themselves,
//! so that what is attached there is in touch. A strap lies on outer faces of both, as a collateral ligament does on the sides of a joint: over all
//! of the first region, over what is between, and over all of the second.

use souple_math::{Mat3, Vec3, axes_along, eigen_symmetric};

use crate::{ElementKind, Group, Mesh, closest_point_on_triangle};

/// What joins two surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TissueForm {
    Ligament,
    Sheet,
    Pad,
    Strap,
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
    /// Of a ligament its sides, of a sheet or strap that of it, of a pad the widest gap that is filled [m].
    pub thickness: f64,
    /// Cells from one end to the other; of a strap shared out over its parts on the first body, between and on the second, one each at least.
    pub along: usize,
    /// Of all but a pad, over its width.
    pub across: usize,
    /// Of all but a pad, through its thickness.
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
    #[error(
        "the region at ({}, {}, {}) is {width:.3e} m wide there across the way to the other, and {thickness:.3e} m are wanted",
        .at.x, .at.y, .at.z
    )]
    TooThick { at: Vec3, width: f64, thickness: f64 },
    #[error(
        "the ends are {apart:.3e} m apart, less than {thickness:.3e} m, and neither region holds a whole face that would be as wide"
    )]
    ThickerThanLong { apart: f64, thickness: f64 },
    #[error("a {what} lies on faces, and the {which} region has none")]
    NoFaces { what: &'static str, which: &'static str },
    #[error("the faces of the {which} region look away from the other region, at ({}, {}, {}): the tissue would go through the body", .at.x, .at.y, .at.z)]
    FacesAway { which: &'static str, at: Vec3 },
    #[error(
        "the faces of the {which} region lie along the way to the other, at ({}, {}, {}), and do not look at it",
        .at.x, .at.y, .at.z
    )]
    FacesAcross { which: &'static str, at: Vec3 },
    #[error(
        "the faces of the {which} region look at the other, or look to no one side, at ({}, {}, {}): there is no side that a strap would lie on",
        .at.x, .at.y, .at.z
    )]
    NoSide { which: &'static str, at: Vec3 },
    #[error(
        "the regions overlap along the way between them by {by:.3e} m: a strap runs from one to the other"
    )]
    NoLength { by: f64 },
    #[error("the region is narrower at ({}, {}, {}) than elsewhere: a strap is as wide from one end to the other", .at.x, .at.y, .at.z)]
    Narrow { at: Vec3 },
    #[error("the faces of the second region, at ({}, {}, {}), look to another side than those of the first", .at.x, .at.y, .at.z)]
    OtherSide { at: Vec3 },
    #[error("no face of the first region has the second one before it{}", .nearest.map(|gap| format!(" within {thickness:.3e} m: the narrowest gap is {gap:.3e} m")).unwrap_or_default())]
    NoGap { thickness: f64, nearest: Option<f64> },
}

impl TissueError {
    /// What would be accepted.
    pub fn expected(&self) -> &'static str {
        match self {
            Self::NoWay { .. } => "regions of the two bodies that are apart",
            Self::NoWidth { .. } => "regions with points beside each other, or a ligament",
            Self::TooThick { .. } => "a smaller `thickness`, or a wider region",
            Self::ThickerThanLong { .. } => {
                "a `thickness` below the distance of the ends, or regions that hold whole faces"
            }
            Self::FacesAway { .. } => "faces of each body that look at the other",
            Self::FacesAcross { .. } => {
                "faces of each body that look at the other, or `tissue = \"strap\"`, which lies on such as these"
            }
            Self::NoSide { .. } => {
                "faces along the way, on one side of both bodies; or a ligament or sheet between faces that look at each other"
            }
            Self::OtherSide { .. } => "faces on one side of both bodies",
            Self::NoLength { .. } => "regions that are apart along the line between their middles",
            Self::Narrow { .. } => "a region with square ends, as a box cuts it out",
            Self::NoFaces { .. } => "a region that holds whole faces of the surface, or a ligament",
            Self::NoGap { .. } => "regions that face each other, or a greater `thickness`",
        }
    }
}

/// Groups of the ends of tissue.
pub const ENDS: [&str; 2] = ["from_end", "to_end"];

/// Lengths below this part of the size of the patches count as nothing: rounding of coordinates.
const NOTHING: f64 = 1e-9;
/// Cosine of the angle to the way below which a normal counts as across it.
const ALONG: f64 = 0.1;

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

    /// How far from a point its faces that look towards it are along a direction of length one.
    fn distance_along(&self, point: Vec3, direction: Vec3) -> Option<f64> {
        let facing = self.triangles().filter(|corners| normal(corners).dot(direction) < 0.0);
        facing.filter_map(|corners| ray_meets(point, direction, corners)).min_by(f64::total_cmp)
    }

    /// How far from a point of a line, before it or behind, the line meets its faces.
    fn distances_on_line(&self, point: Vec3, direction: Vec3) -> impl Iterator<Item = f64> + '_ {
        self.triangles().flat_map(move |corners| {
            let before = ray_meets(point, direction, corners);
            let behind = ray_meets(point, -direction, corners).map(|distance| -distance);
            before.into_iter().chain(behind)
        })
    }

    /// Where a line leaves it towards a side, at the last of its faces.
    fn left_along(&self, point: Vec3, towards: Vec3) -> Option<Vec3> {
        let last = self.distances_on_line(point, towards).max_by(f64::total_cmp);
        last.map(|distance| point + towards * distance)
    }

    /// Those of its faces that look to a side, by themselves.
    fn facing(&self, towards: Vec3) -> Self {
        let looks = |face: &&Vec<Vec3>| {
            let normal = normal(&[face[0], face[1], face[2]]);
            normal.dot(towards) > NOTHING * normal.length()
        };
        Self { points: Vec::new(), faces: self.faces.iter().filter(looks).cloned().collect() }
    }

    /// Where all its faces lie along the way, within a tenth: a place on one.
    fn along(&self, direction: Vec3) -> Option<Vec3> {
        let lies_along = |corners: [Vec3; 3]| {
            let normal = normal(&corners);
            normal.dot(direction).abs() <= ALONG * normal.length()
        };
        let first = self.triangles().next()?;
        self.triangles().all(lies_along).then_some(first[0])
    }

    /// The side that its faces look to, of length one; `None` where they look to no one side.
    fn side(&self) -> Option<Vec3> {
        let (sum, area) = self.triangles().fold((Vec3::ZERO, 0.0), |(sum, area), corners| {
            let normal = normal(&corners);
            (sum + normal, area + normal.length())
        });
        // two sides of an edge keep 0.71 of their area, a cap of fifty degrees 0.82
        (sum.length() > 0.8 * area).then(|| sum / sum.length())
    }

    /// Where it begins and ends along a direction, from a place [m].
    fn extent(&self, place: Vec3, direction: Vec3) -> [f64; 2] {
        let along = self.points.iter().map(|point| (*point - place).dot(direction));
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }

    /// Where all its faces look the other way, if there are any: a place on one. Faces along the way look at nothing.
    fn away_from(&self, direction: Vec3) -> Option<Vec3> {
        let looks_away = |corners: &[Vec3; 3]| {
            let normal = normal(corners);
            normal.dot(direction) < -NOTHING * normal.length()
        };
        let first = self.triangles().next()?;
        self.triangles().all(|corners| looks_away(&corners)).then_some(first[0])
    }

    /// How it spreads about its middle.
    fn spread(&self) -> Mat3 {
        let middle = self.middle();
        self.points.iter().fold(Mat3::ZERO, |sum, point| sum + (*point - middle).outer(*point - middle))
    }
}

/// Outward, as long as twice its area.
fn normal([a, b, c]: &[Vec3; 3]) -> Vec3 {
    (*b - *a).cross(*c - *a)
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
    if wanted.form != TissueForm::Strap {
        looks_over([from, to], direction)?;
    }
    match wanted.form {
        TissueForm::Strap => strap([from, to], direction, wanted),
        TissueForm::Pad => pad(from, to, direction, wanted),
        TissueForm::Ligament => {
            // any direction across will do for a square
            let across = direction.any_orthogonal();
            let half = 0.5 * wanted.thickness;
            let ends = [from, to].map(|patch| End { patch, axis: across, ends: [-half, half] });
            loft(ends, direction, wanted)
        }
        TissueForm::Sheet => {
            let first = widest(from, direction, None, size)?;
            let second = widest(to, direction, Some(first.axis), size)?;
            let ends = [first, second].map(|end| end.within_its_faces(direction, wanted.thickness));
            loft(ends, direction, wanted)
        }
    }
}

/// Whether each of two patches looks at the other, with some of its faces.
///
/// # Errors
/// One that does not.
fn looks_over([from, to]: [&Patch; 2], direction: Vec3) -> Result<(), TissueError> {
    for (which, patch, towards) in [("first", from, direction), ("second", to, -direction)] {
        if let Some(at) = patch.away_from(towards) {
            return Err(TissueError::FacesAway { which, at });
        }
        if let Some(at) = patch.along(direction) {
            return Err(TissueError::FacesAcross { which, at });
        }
    }
    Ok(())
}

/// Where tissue of one width ends: the direction of that, and where it begins and ends along it [m].
#[derive(Clone, Copy)]
struct End<'a> {
    patch: &'a Patch,
    axis: Vec3,
    ends: [f64; 2],
}

/// Halvings between a place that is within a region and one that is not.
const HALVES: usize = 40;

impl End<'_> {
    /// No wider than its faces are at least as wide across it as the tissue is thick: round regions end in tips.
    fn within_its_faces(self, direction: Vec3, thickness: f64) -> Self {
        let normal = direction.cross(self.axis);
        let normal = normal / normal.length();
        let fits = |u: f64| {
            [-0.5, 0.5].into_iter().all(|half| {
                let corner = self.patch.middle() + self.axis * u + normal * (half * thickness);
                self.patch.distances_on_line(corner, direction).next().is_some()
            })
        };
        // where the middle does not fit either, that is told as what it is
        if self.patch.faces.is_empty() || !fits(0.0) {
            return self;
        }
        let ends = self.ends.map(|end| {
            if fits(end) {
                return end;
            }
            let (mut inside, mut outside) = (0.0, end);
            for _ in 0..HALVES {
                let middle = 0.5 * (inside + outside);
                *(if fits(middle) { &mut inside } else { &mut outside }) = middle;
            }
            inside
        });
        Self { ends, ..self }
    }
}

/// Spreads that differ by less than this part are as wide one way as the other: of squares and discs whose points are not in rows they differ
/// by some percent, in a direction that the mesh alone knows.
const AS_WIDE: f64 = 0.05;

/// The direction in which a patch is widest across the way, on the side of `like`; of a patch that is as wide in all directions, that of
/// `like` itself, or across the way and an axis.
fn widest<'a>(
    patch: &'a Patch,
    direction: Vec3,
    like: Option<Vec3>,
    size: f64,
) -> Result<End<'a>, TissueError> {
    let middle = patch.middle();
    let flat = Mat3::IDENTITY - direction.outer(direction);
    let eigen = eigen_symmetric(&(flat * patch.spread() * flat));
    let values = eigen.values.to_array();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
    let is_square = values[order[0]] - values[order[1]] <= AS_WIDE * values[order[0]];
    let mut axis = if is_square {
        like.unwrap_or_else(|| direction.any_orthogonal())
    } else {
        eigen.vectors.columns[order[0]]
    };
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
    Ok(End { patch, axis, ends })
}

/// Part of a thickness that a section may lose where its corners pass a region by, as at the round ends of a width.
const CUT: f64 = 0.1;

/// Hexahedra between two sections.
///
/// # Errors
/// A region is narrower than the tissue is thick.
fn loft(ends: [End; 2], direction: Vec3, wanted: &Tissue) -> Result<Mesh, TissueError> {
    let Tissue { along, across, through, thickness, .. } = *wanted;
    let apart = (ends[1].patch.middle() - ends[0].patch.middle()).length();
    if ends.iter().all(|end| end.patch.faces.is_empty()) && thickness > apart {
        return Err(TissueError::ThickerThanLong { apart, thickness });
    }
    let section = |End { patch, axis, ends: [low, high] }: End,
                   towards: Vec3|
     -> Result<Vec<Vec3>, TissueError> {
        let normal = direction.cross(axis);
        let normal = normal / normal.length();
        let facing = patch.facing(towards);
        let place = |j: usize, k: usize| {
            let u = low + (high - low) * j as f64 / across as f64;
            let v = thickness * (k as f64 / through as f64 - 0.5);
            let at = patch.middle() + axis * u + normal * v;
            facing.left_along(at, towards).unwrap_or_else(|| patch.nearest(at))
        };
        for j in 0..=across {
            let (below, above) = (place(j, 0), place(j, through));
            let width = (above - below).dot(normal);
            if width < (1.0 - CUT) * thickness {
                return Err(TissueError::TooThick { at: (below + above) * 0.5, width, thickness });
            }
        }
        Ok((0..=through).flat_map(|k| (0..=across).map(move |j| (j, k))).map(|(j, k)| place(j, k)).collect())
    };
    let [first, last] = ends;
    let (first, last) = (section(first, direction)?, section(last, -direction)?);
    let sections = (0..=along).map(|layer| part_way([&first, &last], layer as f64 / along as f64));
    let mut mesh = between(&sections.collect::<Vec<_>>(), [across, through]);
    name_ends(&mut mesh, first.len());
    Ok(mesh)
}

/// The section at a part of the way between two.
fn part_way([from, to]: [&[Vec3]; 2], part: f64) -> Vec<Vec3> {
    from.iter().zip(to).map(|(a, b)| *a * (1.0 - part) + *b * part).collect()
}

/// Hexahedra between sections, one after the other, each of points over its width, layer upon layer.
fn between(sections: &[Vec<Vec3>], [across, through]: [usize; 2]) -> Mesh {
    let of_section = (across + 1) * (through + 1);
    let number = |i: usize, j: usize, k: usize| (i * of_section + k * (across + 1) + j) as u32;
    let mut mesh = Mesh { points: sections.concat(), ..Mesh::default() };
    for i in 0..sections.len() - 1 {
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
    mesh
}

/// Hexahedra that lie on both patches and go straight between them; ends are what lies on each.
///
/// # Errors
/// The patches have no side in common, or are not one behind the other.
fn strap(patches: [&Patch; 2], direction: Vec3, wanted: &Tissue) -> Result<Mesh, TissueError> {
    let Tissue { across, through, thickness, .. } = *wanted;
    let side = |patch: &Patch, which: &'static str| -> Result<Vec3, TissueError> {
        if patch.faces.is_empty() {
            return Err(TissueError::NoFaces { what: "strap", which });
        }
        let side = patch.side().map(|side| side - direction * side.dot(direction));
        // a side that looks at the other, or away from it, has little left across the way
        let side = side.filter(|side| side.length() > 0.5);
        side.and_then(Vec3::try_normalised).ok_or(TissueError::NoSide { which, at: patch.middle() })
    };
    let sides = [side(patches[0], "first")?, side(patches[1], "second")?];
    if sides[0].dot(sides[1]) <= 0.0 {
        return Err(TissueError::OtherSide { at: patches[1].middle() });
    }
    let start = patches[0].middle();
    let [[begin, leave], [meet, end]] = patches.map(|patch| patch.extent(start, direction));
    if leave >= meet {
        return Err(TissueError::NoLength { by: leave - meet });
    }
    let parts = [leave - begin, meet - leave, end - meet];
    let counts = parts.map(|part| {
        let share = wanted.along as f64 * part / (end - begin);
        share.round().max(1.0) as usize
    });
    let lying = [0, 1].map(|which: usize| patches[which].facing(sides[which]));
    // a section at a place along the way, on a patch
    let section = |which: usize, u: f64| -> Result<Vec<Vec3>, TissueError> {
        let (patch, side) = (&lying[which], sides[which]);
        let beside = side.cross(direction);
        let [low, high] = patches[which].extent(start, beside);
        let foot = |j: usize| {
            let v = low + (high - low) * j as f64 / across as f64;
            let at = start + direction * u + beside * v;
            patch.left_along(at, side).ok_or_else(|| TissueError::Narrow { at: patch.nearest(at) })
        };
        let feet = (0..=across).map(foot).collect::<Result<Vec<Vec3>, _>>()?;
        let layer = |k: usize| side * (thickness * k as f64 / through as f64);
        Ok((0..=through).flat_map(|k| feet.iter().map(move |foot| *foot + layer(k))).collect())
    };
    let at = |which: usize, [low, high]: [f64; 2], count: usize| -> Result<Vec<Vec<Vec3>>, TissueError> {
        (0..=count).map(|i| section(which, low + (high - low) * i as f64 / count as f64)).collect()
    };
    let (first, last) = (at(0, [begin, leave], counts[0])?, at(1, [meet, end], counts[2])?);
    let (edge, other) = (&first[counts[0]], &last[0]);
    let bridge = (1..counts[1]).map(|i| part_way([edge, other], i as f64 / counts[1] as f64));
    let sections: Vec<Vec<Vec3>> = first.iter().cloned().chain(bridge).chain(last.iter().cloned()).collect();
    let mut mesh = between(&sections, [across, through]);
    let of_section = sections[0].len();
    let feet = |sections: std::ops::Range<usize>| -> Vec<u32> {
        sections.flat_map(|i| (0..=across).map(move |j| (i * of_section + j) as u32)).collect()
    };
    let ends = [feet(0..first.len()), feet(sections.len() - last.len()..sections.len())];
    for (name, points) in ENDS.into_iter().zip(ends) {
        mesh.groups.insert(name.to_owned(), Group { points, ..Group::default() });
    }
    Ok(mesh)
}

/// Cells between faces of a patch and where they meet the other.
fn pad(from: &Patch, to: &Patch, direction: Vec3, wanted: &Tissue) -> Result<Mesh, TissueError> {
    if from.faces.is_empty() {
        return Err(TissueError::NoFaces { what: "pad", which: "first" });
    }
    let Tissue { along, thickness, .. } = *wanted;
    let mut narrowest: Option<f64> = None;
    let mut feet: Vec<(Vec3, f64)> = Vec::new();
    let mut known = std::collections::HashMap::new();
    let mut faces: Vec<Vec<u32>> = Vec::new();
    let looks_there = |face: &&Vec<Vec3>| normal(&[face[0], face[1], face[2]]).dot(direction) > 0.0;
    for face in from.faces.iter().filter(looks_there) {
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

/// The axes of each cell of tissue, as columns: from the first end to the second, across that along the width, and through the
/// thickness. A pad, which has no width, has one direction across for all of its cells.
pub fn cell_axes(mesh: &Mesh, form: TissueForm) -> Vec<Mat3> {
    let along = |cell: &crate::Cell| {
        let half = cell.kind.corner_count() / 2;
        let at = |node: usize| mesh.points[cell.nodes[node] as usize];
        (0..half).map(|node| at(half + node) - at(node)).sum::<Vec3>()
    };
    let whole = mesh.cells().map(|cell| along(&cell)).sum::<Vec3>();
    let beside = |cell: &crate::Cell| {
        let half = cell.kind.corner_count() / 2;
        let at = |node: usize| mesh.points[cell.nodes[node] as usize];
        match form {
            TissueForm::Pad => whole.any_orthogonal(),
            // the first edge of both ends
            TissueForm::Ligament | TissueForm::Sheet | TissueForm::Strap => {
                at(1) - at(0) + at(half + 1) - at(half)
            }
        }
    };
    let of = |cell: crate::Cell| axes_along(along(&cell), beside(&cell));
    mesh.cells().map(|cell| of(cell).unwrap_or(Mat3::IDENTITY)).collect()
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

    /// A square of so many faces that look up, at a height, from `low` to `high` in x and z.
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

    /// The same from below.
    fn from_below(patch: Patch) -> Patch {
        let turned = |face: Vec<Vec3>| face.into_iter().rev().collect();
        Patch { faces: patch.faces.into_iter().map(turned).collect(), ..patch }
    }

    fn volume(mesh: &mut Mesh) -> f64 {
        mesh.validate().expect("a mesh that can be computed on");
        mesh.volume()
    }

    const PAD: Tissue = Tissue { form: TissueForm::Pad, thickness: 2.0, along: 3, across: 2, through: 1 };

    /// A pad fills what lies between two surfaces where they face each other, and no more.
    #[test]
    fn pads_fill_gaps() {
        let floor = square(0.0, 4.0, |_| 0.0, 4);
        let slope = from_below(square(1.0, 3.0, |x| 1.0 + 0.1 * (x - 2.0), 3));
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
        // through the matter below the floor, or above the slope
        let below = from_below(floor.clone());
        assert!(matches!(tissue(&below, &slope, &PAD), Err(TissueError::FacesAway { which: "first", .. })));
        let above = from_below(slope);
        assert!(matches!(tissue(&floor, &above, &PAD), Err(TissueError::FacesAway { which: "second", .. })));
    }

    /// Axes run from the first end to the second, the second one along the width; of triangles too.
    #[test]
    fn axes_run_from_end_to_end() {
        let (floor, roof) =
            (square(0.0, 4.0, |_| 0.0, 2), from_below(square(0.0, 4.0, |x| 1.0 + 0.1 * x, 2)));
        let halves = |patch: &Patch| {
            let faces = patch.faces.iter();
            let cut = faces.flat_map(|f| [vec![f[0], f[1], f[2]], vec![f[0], f[2], f[3]]]).collect();
            Patch { faces: cut, ..patch.clone() }
        };
        let sheet = Tissue { form: TissueForm::Sheet, thickness: 0.5, ..PAD };
        for (from, wanted) in [(&floor, PAD), (&halves(&floor), PAD), (&floor, sheet)] {
            let mut mesh = tissue(from, &roof, &wanted).unwrap();
            mesh.validate().unwrap();
            let all = cell_axes(&mesh, wanted.form);
            assert_eq!(all.len(), mesh.cell_count());
            let leans = Vec3::new(0.0, 1.2, 0.0).try_normalised().unwrap();
            for axes in all {
                assert!((axes.columns[0] - leans).length() < 1e-12, "{axes:?}");
                // a width along z, a thickness along x; a pad takes what is across the way and x
                assert!((axes.columns[1].z.abs() - 1.0).abs() < 1e-12, "{axes:?}");
                assert!((axes.determinant() - 1.0).abs() < 1e-12);
            }
        }
    }

    /// On round regions a sheet is as thick as it was asked for where it ends, too.
    #[test]
    fn sheets_on_round_regions_are_of_one_thickness() {
        let disc = |height: f64| {
            let corner = |i: usize| {
                let angle = i as f64 / 24.0 * std::f64::consts::TAU;
                Vec3::new(angle.cos(), height, -angle.sin())
            };
            let middle = Vec3::new(0.0, height, 0.0);
            Patch {
                points: (0..24).map(corner).chain([middle]).collect(),
                faces: (0..24).map(|i| vec![middle, corner(i), corner(i + 1)]).collect(),
            }
        };
        let sheet = Tissue { form: TissueForm::Sheet, thickness: 0.5, ..PAD };
        let mut mesh = tissue(&disc(0.0), &from_below(disc(3.0)), &sheet).unwrap();
        // as wide as two chords half a thickness from the middle are, of a polygon
        let width = volume(&mut mesh) / (3.0 * 0.5);
        let of_circle = 2.0 * (1.0_f64 - 0.0625).sqrt();
        assert!(width < of_circle && width > 0.98 * of_circle, "{width} of {of_circle}");
    }

    /// A strap lies on both of two faces beside each other, over all of each and what is between; faces that look at each other have no side, and
    /// what goes from face to face does not begin on such as lie along the way.
    #[test]
    fn straps_lie_along_faces() {
        let floor = square(0.0, 1.0, |_| 0.0, 2);
        let beside = |by: f64| {
            let moved = |points: &[Vec3]| points.iter().map(|point| *point + Vec3::X * by).collect();
            Patch {
                points: moved(&floor.points),
                faces: floor.faces.iter().map(|face| moved(face)).collect(),
            }
        };
        let wanted = Tissue { form: TissueForm::Strap, thickness: 0.5, along: 8, across: 2, through: 2 };
        let mut mesh = tissue(&floor, &beside(3.0), &wanted).unwrap();
        assert!((volume(&mut mesh) - 4.0 * 0.5).abs() < 1e-12);
        assert_eq!(mesh.cell_count(), 8 * 2 * 2);
        for (end, [low, high]) in ENDS.into_iter().zip([[0.0, 1.0], [3.0, 4.0]]) {
            let points = &mesh.groups[end].points;
            assert_eq!(points.len(), 3 * 3);
            for point in points {
                let x = mesh.points[*point as usize];
                assert!(x.y.abs() < 1e-12 && x.x > low - 1e-12 && x.x < high + 1e-12, "{x:?}");
            }
        }
        let axes = cell_axes(&mesh, TissueForm::Strap);
        assert!(axes.iter().all(|axes| (axes.columns[0] - Vec3::X).length() < 1e-12));
        let refused = |to: &Patch, wanted: &Tissue| tissue(&floor, to, wanted).unwrap_err();
        assert!(matches!(refused(&beside(0.5), &wanted), TissueError::NoLength { .. }));
        let corner = |a: f64| Vec3::new(4.0 + a.cos(), 0.0, 0.5 - a.sin());
        let round = Patch {
            points: (0..24).map(|i| corner(f64::from(i) / 24.0 * std::f64::consts::TAU)).collect(),
            faces: (1..23)
                .map(|i| [0, i, i + 1].map(|i| corner(f64::from(i) / 24.0 * std::f64::consts::TAU)).to_vec())
                .collect(),
        };
        assert!(matches!(refused(&round, &wanted), TissueError::Narrow { .. }));
        let roof = from_below(square(0.0, 1.0, |_| 3.0, 2));
        assert!(matches!(refused(&roof, &wanted), TissueError::NoSide { which: "first", .. }));
        let point = Patch { points: vec![Vec3::new(3.0, 0.0, 0.5)], faces: Vec::new() };
        assert!(matches!(refused(&point, &wanted), TissueError::NoFaces { which: "second", .. }));
        let ligament = Tissue { form: TissueForm::Ligament, ..wanted };
        assert!(matches!(refused(&beside(3.0), &ligament), TissueError::FacesAcross { which: "first", .. }));
    }

    /// A region that goes all round a body ends where that looks at the other: no tissue goes through.
    #[test]
    fn tissue_of_whole_bodies_stays_outside() {
        // a cube of 2 m about the origin, faces outward
        let corner = |i: usize| {
            let side = |bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
            Vec3::new(side(0), side(1), side(2))
        };
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let cube = |by: Vec3| Patch {
            points: (0..8).map(|i| corner(i) + by).collect(),
            faces: sides.iter().map(|side| side.iter().map(|i| corner(*i) + by).collect()).collect(),
        };
        let wanted = Tissue { form: TissueForm::Ligament, thickness: 0.5, ..PAD };
        let mut mesh = tissue(&cube(Vec3::ZERO), &cube(Vec3::X * 5.0), &wanted).unwrap();
        assert!((volume(&mut mesh) - 3.0 * 0.25).abs() < 1e-12, "from face to face");
    }

    /// Ligaments and sheets begin and end on the surfaces, with the section that was asked for.
    #[test]
    fn ligaments_and_sheets_reach_from_one_to_the_other() {
        let (floor, roof) = (square(0.0, 4.0, |_| 0.0, 4), from_below(square(0.0, 4.0, |_| 3.0, 4)));
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
        // on squares it runs along a side, and not along the diagonal
        let mut mesh = tissue(&floor, &roof, &sheet).unwrap();
        assert!((volume(&mut mesh) - 3.0 * 4.0 * 0.5).abs() < 1e-12);
        let thick = Tissue { thickness: 4.5, ..ligament };
        assert!(matches!(tissue(&floor, &roof, &thick), Err(TissueError::TooThick { .. })));
        let point = Patch { points: vec![Vec3::new(2.0, 3.0, 2.0)], faces: Vec::new() };
        let other = Patch { points: vec![Vec3::new(2.0, 0.0, 2.0)], faces: Vec::new() };
        assert!(matches!(tissue(&other, &point, &thick), Err(TissueError::ThickerThanLong { .. })));
        assert!(matches!(tissue(&edge(0.0), &point, &sheet), Err(TissueError::NoWidth { .. })));
    }
}
