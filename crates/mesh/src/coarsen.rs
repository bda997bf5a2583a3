//! Coarser meshes of the same body: its surface filled anew with larger tetrahedra, of several sizes the best.
//!
//! A few tetrahedra more or less change the worst of them a lot (Debunne 2000, 5 §2.1). Of so few that the filling loses parts of the body, edges of a finer mesh
//! collapse instead (`decimate`), which keeps the surface nearer and makes worse tetrahedra.

use std::borrow::Cow;

use souple_math::Vec3;
use souple_table::{Value, Values};

use crate::decimate::{Plan, decimated, farthest, fit};
use crate::fill::{Options, PARAMETERS, carry_groups, fill_mesh};
use crate::repair::{RepairLimits, crossings};
use crate::{ElementKind, Mesh, MeshError, TriangleSurface};

/// Other sizes that are tried, relative to the one asked for.
const OTHERS: [f64; 6] = [0.98, 1.02, 0.96, 1.04, 0.94, 1.06];

/// Shapes of all tetrahedra of a mesh: three times the inscribed over the circumscribed radius, 1 for a regular one.
pub fn radius_ratios(mesh: &Mesh) -> Vec<f64> {
    mesh.cells()
        .filter(|cell| cell.kind == ElementKind::Tet4)
        .map(|cell| radius_ratio([0, 1, 2, 3].map(|corner: usize| mesh.points[cell.nodes[corner] as usize])))
        .collect()
}

/// How far two surfaces are from each other, the most that a point or the centre of a triangle of either is [m].
pub fn surfaces_apart(one: &TriangleSurface, other: &TriangleSurface) -> f64 {
    farthest(one, other).max(farthest(other, one))
}

pub(crate) fn radius_ratio([a, b, c, d]: [Vec3; 4]) -> f64 {
    let [u, v, w] = [b - a, c - a, d - a];
    let six_volumes = u.dot(v.cross(w)).abs();
    let twice_areas = [v.cross(w), w.cross(u), u.cross(v), (c - b).cross(d - b)];
    let twice_surface: f64 = twice_areas.iter().map(|area| area.length()).sum();
    if six_volumes == 0.0 {
        return 0.0;
    }
    // r = 3V/S and |u² v×w + v² w×u + w² u×v| = 12 V R
    let inscribed = six_volumes / twice_surface;
    let [vw, wu, uv, _] = twice_areas;
    let to_centre = vw * u.length_sq() + wu * v.length_sq() + uv * w.length_sq();
    3.0 * inscribed * 2.0 * six_volumes / to_centre.length()
}

/// The mesh of tetrahedra about as long as `size` [m] that fills the surface of a mesh, of those of nearly that size the
/// one whose worst tetrahedron is best; groups of points are carried along.
///
/// # Errors
/// None of the sizes can be filled: the last failure.
pub fn coarser(mesh: &Mesh, size: f64) -> Result<Mesh, MeshError> {
    let mut best = attempt(mesh, size, Vec3::ZERO);
    for factor in OTHERS {
        let other = attempt(mesh, factor * size, Vec3::ZERO);
        best = match (best, other) {
            (Ok(best), Ok(other)) if other.0 > best.0 => Ok(other),
            (Err(_), other) => other,
            (best, _) => best,
        };
    }
    best.map(|(_, mesh)| mesh)
}

/// Why there is no mesh of as many tetrahedra as are wanted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CoarsenError {
    #[error(transparent)]
    Mesh(#[from] MeshError),
    #[error("no mesh of about {wanted} tetrahedra was found; the nearest has {nearest}")]
    Count { wanted: usize, nearest: usize },
}

/// How far from the number of tetrahedra wanted a mesh may be, relatively.
const OFF_COUNT: f64 = 0.2;
/// Places of the lattice that are tried, in cells, until one has the count: of few tetrahedra a whole layer comes or goes with it.
const SHIFTS: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [0.5, 0.0, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.25, 0.25, 0.25],
    [0.75, 0.25, 0.25],
    [0.25, 0.75, 0.25],
    [0.25, 0.25, 0.75],
];
/// Sizes that are tried until the count is about right.
const ROUNDS: usize = 12;

/// How far the surface may be from that of the mesh, of its diagonal, before edges are collapsed (V-30).
const NEAR: f64 = 0.05;
/// The worst radius ratio that collapses may leave: the best that reaches the count.
const WORST: [f64; 3] = [0.3, 0.2, 0.12];
/// Of the number wanted, what is tried: a few more come nearer.
const MORE: [f64; 2] = [1.0, 1.18];
/// Of the fourth power of an edge what it costs, tried one after the other: which edges go first decides what can be reached.
const LENGTH_SHARES: [f64; 3] = [0.01, 0.001, 0.1];
/// Triangles of a surface that collapsed meshes are fitted to itself; of more, the surface of the mesh whose edges collapse.
const MOST_FITTED: usize = 20_000;
/// Tetrahedra of the mesh whose edges collapse, at least as many and at most a multiple of those wanted.
const START: [usize; 2] = [4_000, 16];

/// The mesh of about `wanted` tetrahedra in the place of a mesh, within a fifth of them: the surface filled with tetrahedra of that size, of those
/// of nearly that size the mesh whose worst one is best; where its surface is farther away than a twentieth of the diagonal, one whose edges have
/// collapsed, if that is nearer.
///
/// # Errors
/// No size gives as many, or none can be filled.
pub fn coarser_of_count(mesh: &Mesh, wanted: usize) -> Result<Mesh, CoarsenError> {
    let (outside, bound) = (mesh.boundary_surface(), NEAR * mesh.bounds().diagonal());
    let apart = |coarse: &Mesh| {
        let surface = coarse.boundary_surface();
        surfaces_apart(&outside, &surface)
    };
    let filled = filled_of_count(mesh, wanted);
    let mut nearest = filled.as_ref().map_or(f64::INFINITY, apart);
    if nearest <= bound {
        return filled;
    }
    let mut best = None;
    let Ok(start) = collapsible(mesh, wanted) else { return filled };
    // a scan has more triangles than are worth fitting to
    let goal =
        if outside.triangles.len() <= MOST_FITTED { outside.clone() } else { start.boundary_surface() };
    let plans = WORST.into_iter().flat_map(|worst| {
        MORE.into_iter().flat_map(move |more| {
            let wanted = (more * wanted as f64) as usize;
            LENGTH_SHARES.map(|length_share| Plan { wanted, worst, length_share })
        })
    });
    for plan in plans {
        let mut collapsed = decimated(&start, plan);
        if (collapsed.cell_count() as f64 / wanted as f64 - 1.0).abs() > OFF_COUNT {
            continue;
        }
        fit(&mut collapsed, &goal, plan.worst);
        let distance = apart(&collapsed);
        // lobes that come through each other are no body
        if distance < nearest && crossings(&collapsed.boundary_surface(), 1).pairs.is_empty() {
            (nearest, best) = (distance, Some(collapsed));
        }
        if nearest <= bound {
            break;
        }
    }
    match best {
        Some(mut collapsed) => {
            carry_groups(mesh, &mut collapsed);
            Ok(collapsed)
        }
        None => filled,
    }
}

/// A mesh of tetrahedra of the same body, many times finer than what is wanted but no finer than that needs.
fn collapsible(mesh: &Mesh, wanted: usize) -> Result<Cow<'_, Mesh>, MeshError> {
    let [least, times] = START;
    let most = least.max(times * wanted);
    if mesh.cell_count() <= most && mesh.cells().all(|cell| cell.kind == ElementKind::Tet4) {
        return Ok(Cow::Borrowed(mesh));
    }
    let size = (72.0_f64.sqrt() * mesh.volume() / most as f64).cbrt();
    attempt(mesh, size, Vec3::ZERO).map(|(_, filled)| Cow::Owned(filled))
}

/// The same by filling alone.
fn filled_of_count(mesh: &Mesh, wanted: usize) -> Result<Mesh, CoarsenError> {
    let mut failure = CoarsenError::Count { wanted, nearest: 0 };
    for shift in SHIFTS {
        match of_count(mesh, wanted, Vec3::from_array(shift)) {
            Ok(found) => return Ok(found),
            // what came nearest is told
            Err(CoarsenError::Count { nearest, .. }) => match &mut failure {
                CoarsenError::Count { nearest: known, .. } if off(*known, wanted) <= off(nearest, wanted) => {
                }
                failure => *failure = CoarsenError::Count { wanted, nearest },
            },
            Err(error) if matches!(failure, CoarsenError::Count { nearest: 0, .. }) => failure = error,
            Err(_) => {}
        }
    }
    Err(failure)
}

/// How far a number of tetrahedra is from the one wanted.
fn off(count: usize, wanted: usize) -> f64 {
    (count as f64 / wanted as f64).ln().abs()
}

/// The mesh of about `wanted` tetrahedra from a lattice that is moved by so many cells.
fn of_count(mesh: &Mesh, wanted: usize, shift: Vec3) -> Result<Mesh, CoarsenError> {
    let fits = |mesh: &Mesh| (mesh.cell_count() as f64 / wanted as f64 - 1.0).abs() <= OFF_COUNT;
    let off = |mesh: &Mesh| off(mesh.cell_count(), wanted);
    // of regular tetrahedra, V = N a³/(6 √2)
    let mut size = (72.0_f64.sqrt() * mesh.volume() / wanted.max(1) as f64).cbrt();
    let mut nearest: Option<(f64, Mesh)> = None;
    let mut failure = None;
    for _ in 0..ROUNDS {
        let tried = size;
        match attempt(mesh, size, shift) {
            Ok((_, filled)) => {
                size *= (filled.cell_count() as f64 / wanted as f64).cbrt();
                if nearest.as_ref().is_none_or(|(_, nearest)| off(&filled) < off(nearest)) {
                    nearest = Some((tried, filled));
                }
            }
            // too coarse for the shape
            Err(error) => {
                failure = Some(error);
                size *= 0.9;
            }
        }
        if (size / tried - 1.0).abs() < 0.02 {
            break;
        }
    }
    let Some((size, found)) = nearest else {
        return Err(failure.map_or(CoarsenError::Count { wanted, nearest: 0 }, CoarsenError::Mesh));
    };
    let mut best: Option<([f64; 2], Mesh)> = None;
    for factor in std::iter::once(1.0).chain(OTHERS) {
        let Ok(other) = attempt(mesh, factor * size, shift) else { continue };
        if fits(&other.1) && best.as_ref().is_none_or(|best| other.0 > best.0) {
            best = Some(other);
        }
    }
    best.map(|(_, mesh)| mesh).ok_or(CoarsenError::Count { wanted, nearest: found.cell_count() })
}

/// The least and the mean radius ratio of a filling, and the filling.
fn attempt(mesh: &Mesh, size: f64, shift: Vec3) -> Result<([f64; 2], Mesh), MeshError> {
    let values = Values::new().with("size", Value::Number(size)).completed(PARAMETERS);
    let options =
        Options::from_values(&values.unwrap_or_else(|error| unreachable!("{error}")))?.shifted(shift);
    let filled = fill_mesh(mesh, RepairLimits::default(), &options)?.mesh;
    let ratios = radius_ratios(&filled);
    let worst = ratios.iter().copied().fold(f64::INFINITY, f64::min);
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    Ok(([worst, mean], filled))
}

/// Mean length of the edges of all cells, each counted once for each of its cells [m].
pub fn mean_edge(mesh: &Mesh) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for cell in mesh.cells() {
        for [a, b] in cell.kind.edges() {
            let at = |node: &u8| mesh.points[cell.nodes[usize::from(*node)] as usize];
            sum += (at(a) - at(b)).length();
            count += 1;
        }
    }
    sum / f64::from(count.max(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::implicit::SHAPES;

    /// Regular: 1. A flat one: 0. A corner of a cube: `r = 3V/S`, `R = √3/2`.
    #[test]
    fn radius_ratios_are_known() {
        let regular = ElementKind::Tet4.regular();
        let ratio = radius_ratio([regular[0], regular[1], regular[2], regular[3]]);
        assert!((ratio - 1.0).abs() < 1e-14);
        let corner = radius_ratio([Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z]);
        let expected = 3.0 * (0.5 / (1.5 + 0.5 * 3.0_f64.sqrt())) / (0.5 * 3.0_f64.sqrt());
        assert!((corner - expected).abs() < 1e-14, "{corner} {expected}");
        assert_eq!(radius_ratio([Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y]), 0.0);
    }

    /// V-30: a liver of 1874, 172 and 28 tetrahedra, each number within a fifth, none flat, and no surface farther away than a
    /// twentieth of the diagonal.
    #[test]
    fn families_have_the_counts_asked_for() {
        let entry = SHAPES.find("liver").unwrap();
        let values = entry.values(Values::new()).unwrap();
        let size = Values::new().with("size", Value::Number(0.012)).completed(PARAMETERS).unwrap();
        let options = Options::from_values(&size).unwrap();
        let fine = options.fill_body(&(entry.build)(&values).unwrap()).unwrap().mesh;
        let outside = fine.boundary_surface();
        for wanted in [1874, 172, 28] {
            let mesh = coarser_of_count(&fine, wanted).unwrap();
            let count = mesh.cell_count();
            assert!((count as f64 / wanted as f64 - 1.0).abs() <= OFF_COUNT, "{wanted}: {count}");
            let worst = radius_ratios(&mesh).into_iter().fold(f64::INFINITY, f64::min);
            assert!(worst > 0.1, "{wanted}: {worst}");
            let surface = mesh.boundary_surface();
            let apart = surfaces_apart(&outside, &surface);
            let diagonal = fine.bounds().diagonal();
            assert!(apart < NEAR * diagonal, "{wanted}: {apart} m of {diagonal} m");
            // what is smaller than a cell too
            assert!(!mesh.groups["ligament"].points.is_empty(), "{wanted}");
        }
    }

    /// The coarser mesh of a ball fills it, with good tetrahedra about as long as asked.
    #[test]
    fn coarser_meshes_are_good() {
        let entry = SHAPES.find("ellipsoid").unwrap();
        let values = entry.values(Values::new().with("semi_axes", Value::Vector([1.0; 3]))).unwrap();
        let size = Values::new().with("size", Value::Number(0.15)).completed(PARAMETERS).unwrap();
        let options = Options::from_values(&size).unwrap();
        let fine = options.fill_body(&(entry.build)(&values).unwrap()).unwrap().mesh;
        for size in [0.3, 0.6] {
            let mesh = coarser(&fine, size).unwrap();
            assert!(radius_ratios(&mesh).into_iter().all(|ratio| ratio > 0.1), "{size}");
            let volume = mesh.volume() / fine.volume();
            // chords of length l cut off (l/2)²/(2 R) of the radius at most
            assert!((1.0 - 3.0 * size * size / 8.0..1.001).contains(&volume), "{size}: {volume}");
            assert!((mean_edge(&mesh) / size - 0.87).abs() < 0.15, "{size}: {}", mean_edge(&mesh));
        }
    }
}
