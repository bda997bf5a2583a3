//! How good the discrete operators of a mesh are: exactness of quadratic fields, symmetry, growth, and what cancels inside.

#![allow(non_snake_case)]

use std::collections::{BTreeMap, BTreeSet};

use souple_math::{Mat3, Vec3};
use souple_mesh::{ElementKind, Mesh, VoronoiCells};

use super::edge_tensors::{Stiffness, add, elastic, hybrid};
use super::gauss_voronoi::{self, Choices, Dual, Flux};
use super::pairs::PairSums;
use super::simplices::{LinearBody, Simplex};
use crate::materials::Lame;
use crate::solids::FlatCell;

/// What is told of an operator on a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct OperatorQuality {
    pub operator: &'static str,
    /// `|K - Kᵀ|/|K|`.
    pub asymmetry: f64,
    /// The same of `grad div` alone.
    pub grad_div_asymmetry: f64,
    /// At which a motion without any outer force grows in the end [1/s].
    pub growth_rate: f64,
    /// Greatest error of the Laplacian of a quadratic field at a point inside, over that of its greatest second derivative.
    pub laplacian_error: f64,
    /// The same of `grad div`.
    pub grad_div_error: f64,
    /// Greatest antisymmetric part of the Laplacian's matrices on inner edges [m].
    pub inner_cross_terms: f64,
    /// The same on edges of the surface [m].
    pub border_cross_terms: f64,
}

/// Why operators of a mesh are not told.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum QualityError {
    #[error("the mesh has {kind}; operators are told of tet4, and of tri3 in one plane")]
    Kind { kind: ElementKind },
    #[error(transparent)]
    Flat(#[from] FlatCell),
}

type Sums = fn(&Body, Lame) -> PairSums;

/// Operators by name.
const OPERATORS: [(&str, Sums); 4] = [
    ("edge_tensors", |body, moduli| body.assembled(moduli, elastic)),
    ("hybrid", |body, moduli| body.assembled(moduli, hybrid)),
    ("gauss_voronoi, dual = voronoi", |body, moduli| body.flows(moduli, Dual::Voronoi)),
    ("gauss_voronoi, dual = median", |body, moduli| body.flows(moduli, Dual::Median)),
];

struct Body<'a> {
    mesh: &'a Mesh,
    simplices: Vec<Simplex>,
}

impl Body<'_> {
    fn assembled(&self, moduli: Lame, stiffness: Stiffness) -> PairSums {
        let mut sums = PairSums::default();
        for simplex in &self.simplices {
            add(&mut sums, simplex, moduli, 1.0, stiffness, self.mesh.dimension());
        }
        sums
    }

    fn flows(&self, moduli: Lame, dual: Dual) -> PairSums {
        let body = LinearBody { simplices: self.simplices.clone(), moduli: vec![moduli], depth: 1.0 };
        let choices = Choices { dual, flux: Flux::Operators, parts: [1.0, 1.0] };
        gauss_voronoi::sums(self.mesh, &vec![0; self.simplices.len()], &body, &choices)
    }

    /// Equal parts of each simplex to its corners [m³].
    fn shares(&self) -> Vec<f64> {
        let mut shares = vec![0.0; self.mesh.points.len()];
        for simplex in &self.simplices {
            for node in &simplex.nodes {
                shares[*node as usize] += simplex.measure / simplex.nodes.len() as f64;
            }
        }
        shares
    }

    /// Edges of the surface; of a plane body those of its outline.
    fn border_edges(&self) -> BTreeSet<[u32; 2]> {
        let mut uses: BTreeMap<Vec<u32>, usize> = BTreeMap::new();
        for simplex in &self.simplices {
            for left_out in &simplex.nodes {
                let mut face: Vec<u32> =
                    simplex.nodes.iter().copied().filter(|node| node != left_out).collect();
                face.sort_unstable();
                *uses.entry(face).or_insert(0) += 1;
            }
        }
        let faces = uses.into_iter().filter(|(_, count)| *count == 1);
        let edges = faces.flat_map(|(face, _)| {
            let of = |at: usize, face: &[u32]| -> Vec<[u32; 2]> {
                face[at + 1..].iter().map(|other| [face[at], *other]).collect()
            };
            (0..face.len()).flat_map(|at| of(at, &face)).collect::<Vec<_>>()
        });
        edges.collect()
    }
}

/// The operators alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operator {
    Laplacian,
    GradDiv,
}

impl Operator {
    /// `μ Δ + (λ+μ) grad div` with one of the two alone.
    fn moduli(self) -> Lame {
        match self {
            Self::Laplacian => Lame { mu: 1.0, lambda: -1.0 },
            Self::GradDiv => Lame { mu: 0.0, lambda: 1.0 },
        }
    }

    /// A component of what it makes of a field of component `k` alone with these second derivatives.
    fn exact(self, row: usize, k: usize, second: &Mat3) -> f64 {
        match self {
            Self::Laplacian if row == k => second.trace(),
            Self::Laplacian => 0.0,
            Self::GradDiv => second.entry(row, k),
        }
    }
}

/// Of the operators of this room, on a mesh of linear simplices.
///
/// # Errors
/// The mesh has other cells, or flat ones.
pub fn operator_quality(
    mesh: &Mesh,
    moduli: Lame,
    density: f64,
) -> Result<Vec<OperatorQuality>, QualityError> {
    let wanted = if mesh.dimension() == 2 { ElementKind::Tri3 } else { ElementKind::Tet4 };
    if let Some(cell) = mesh.cells().find(|cell| cell.kind != wanted) {
        return Err(QualityError::Kind { kind: cell.kind });
    }
    let body = Body { mesh, simplices: Simplex::all(mesh)? };
    let shares = body.shares();
    let cells = VoronoiCells::of(mesh).map_or_else(|| shares.clone(), |cells| cells.volumes);
    let border = body.border_edges();
    let of = |(name, sums): (&'static str, Sums)| {
        let volumes = if name.ends_with("voronoi") { &cells } else { &shares };
        let whole = sums(&body, moduli);
        let masses: Vec<f64> = shares.iter().map(|share| share * density).collect();
        let laplacian = sums(&body, Operator::Laplacian.moduli());
        let grad_div = sums(&body, Operator::GradDiv.moduli());
        let [inner_cross_terms, border_cross_terms] = cross_terms(&laplacian, &border);
        OperatorQuality {
            operator: name,
            asymmetry: whole.asymmetry(),
            grad_div_asymmetry: grad_div.asymmetry(),
            growth_rate: growth_rate(&whole, &masses),
            laplacian_error: error(&body, &laplacian, volumes, &border, Operator::Laplacian),
            grad_div_error: error(&body, &grad_div, volumes, &border, Operator::GradDiv),
            inner_cross_terms,
            border_cross_terms,
        }
    };
    Ok(OPERATORS.into_iter().map(of).collect())
}

/// Greatest entry of the antisymmetric part of both blocks of a pair, inside and on the border.
fn cross_terms(sums: &PairSums, border: &BTreeSet<[u32; 2]>) -> [f64; 2] {
    let mut greatest = [0.0_f64; 2];
    for (ends, blocks) in sums.iter() {
        let at = usize::from(border.contains(&ends));
        for block in blocks {
            let part = (block - block.transpose()) * 0.5;
            greatest[at] = greatest[at].max(part.largest_entry());
        }
    }
    greatest
}

/// Greatest error at points inside, over all quadratic fields `u_k = x_a x_b`, of what an operator makes of them over a volume.
fn error(
    body: &Body,
    sums: &PairSums,
    volumes: &[f64],
    border: &BTreeSet<[u32; 2]>,
    operator: Operator,
) -> f64 {
    let (points, dimension) = (&body.mesh.points, body.mesh.dimension());
    let is_border: BTreeSet<u32> = border.iter().flatten().copied().collect();
    let mut greatest = 0.0_f64;
    for a in 0..dimension {
        for b in a..dimension {
            let mut second = [[0.0; 3]; 3];
            second[a][b] += 1.0;
            second[b][a] += 1.0;
            let second = Mat3::from_rows(second);
            let size = if a == b { 2.0 } else { 1.0 };
            for k in 0..dimension {
                let field = |point: u32| {
                    let x = points[point as usize].to_array();
                    Vec3::AXES[k] * (x[a] * x[b])
                };
                let mut forces = vec![Vec3::ZERO; points.len()];
                for ([i, j], [forth, back]) in sums.iter() {
                    let d = field(j) - field(i);
                    forces[i as usize] += forth * d;
                    forces[j as usize] -= back * d;
                }
                for (point, force) in forces.iter().enumerate() {
                    if is_border.contains(&(point as u32)) || volumes[point] == 0.0 {
                        continue;
                    }
                    for row in 0..dimension {
                        let measured = force.to_array()[row] / volumes[point];
                        greatest = greatest.max((measured - operator.exact(row, k, &second)).abs() / size);
                    }
                }
            }
        }
    }
    greatest
}

/// Steps of a motion of its own, by which growth is told.
const STEPS: usize = 20_000;

/// The rate at which the velocities of a body without any outer force grow [1/s], by modified Euler within its stable steps.
///
/// The velocities of the second half of the time against those of the first; a body that only swings gives what beats make of
/// that, far below one over the time.
pub fn growth_rate(sums: &PairSums, masses: &[f64]) -> f64 {
    growth_with_step(sums, masses, stable_step(sums, masses), STEPS)
}

/// `1/√(Σ_j 2 |B_ij|/m_i)` at most: half of what is stable by Gershgorin's bound [s].
fn stable_step(sums: &PairSums, masses: &[f64]) -> f64 {
    let mut bounds = vec![0.0; masses.len()];
    for ([i, j], blocks) in sums.iter() {
        for (end, block) in [i, j].into_iter().zip(blocks) {
            bounds[end as usize] += 2.0 * block.dot(&block).sqrt() / masses[end as usize];
        }
    }
    let bound = bounds.into_iter().filter(|bound| bound.is_finite()).fold(0.0, f64::max);
    if bound > 0.0 { 1.0 / bound.sqrt() } else { 0.0 }
}

fn growth_with_step(sums: &PairSums, masses: &[f64], timestep: f64, steps: usize) -> f64 {
    let number = |i: usize, salt: f64| ((i as f64 + salt) * 12.9898).sin();
    let mut u: Vec<Vec3> =
        (0..masses.len()).map(|i| Vec3::new(number(i, 0.1), number(i, 0.2), number(i, 0.3))).collect();
    let mut v = vec![Vec3::ZERO; u.len()];
    let pairs: Vec<_> = sums.iter().collect();
    let mut halves = [0.0_f64; 2];
    for step in 0..steps {
        for ([i, j], [forth, back]) in &pairs {
            let (i, j) = (*i as usize, *j as usize);
            let d = (u[j] - u[i]) * timestep;
            v[i] += *forth * d / masses[i];
            v[j] += -(*back * d) / masses[j];
        }
        u.iter_mut().zip(&v).for_each(|(u, v)| *u += *v * timestep);
        let speed = v.iter().map(|v| v.length_sq()).sum::<f64>().sqrt();
        // the first tenth finds its shape
        if step >= steps / 10 {
            let half = &mut halves[usize::from(step >= steps / 2)];
            *half = half.max(speed);
        }
        if !speed.is_finite() {
            return f64::INFINITY;
        }
    }
    if halves[0] == 0.0 {
        return 0.0;
    }
    (halves[1] / halves[0]).ln() / (timestep * (steps / 2) as f64)
}

#[cfg(test)]
mod tests {
    use souple_table::{Value, Values};

    use super::*;

    /// V-01's: 7 and 20 kPa, a tonne to the cubic metre.
    const MODULI: Lame = Lame { mu: 7000.0, lambda: 20000.0 };

    fn cube(cells: f64) -> Mesh {
        let values = Values::new()
            .with("size", Value::Vector([0.1; 3]))
            .with("cells", Value::Vector([cells; 3]))
            .with("element", Value::Text("tet4"));
        souple_mesh::generate("box", values).unwrap()
    }

    fn crooked() -> Mesh {
        let mut mesh = cube(4.0);
        for p in &mut mesh.points {
            let s = *p * 90.0;
            if p.to_array().iter().all(|x| *x > 0.001 && *x < 0.099) {
                *p += Vec3::new((7.0 * s.y + s.z).sin(), (5.0 * s.x).cos(), (3.0 * s.x - s.y).sin()) * 0.005;
            }
        }
        mesh
    }

    /// Triangles of a lattice, with two shears; `lean` moves its rows.
    fn lattice(lean: f64) -> Mesh {
        let (columns, rows) = (6, 6);
        let height = 3.0_f64.sqrt() / 2.0;
        let mut points = Vec::new();
        for row in 0..=rows {
            for column in 0..=columns {
                let at = |salt: f64| lean * ((row * 7 + column) as f64 * 3.1 + salt).sin();
                let x = column as f64 + 0.5 * row as f64 + at(0.2);
                points.push(Vec3::new(x, height * row as f64 + at(1.3), 0.0));
            }
        }
        let mut nodes = Vec::new();
        for row in 0..rows {
            for column in 0..columns {
                let a = row * (columns + 1) + column;
                let b = a + columns + 1;
                nodes.extend([a, a + 1, b, a + 1, b + 1, b]);
            }
        }
        Mesh::new(points, ElementKind::Tri3, nodes)
    }

    fn named<'a>(all: &'a [OperatorQuality], name: &str) -> &'a OperatorQuality {
        all.iter().find(|quality| quality.operator == name).unwrap()
    }

    /// V-17, V-20, V-21: finite elements, the hybrid and the median dual are symmetric and grow by nothing; Voronoi's dual is
    /// neither, at a rate that half the step leaves as it is. Cross terms cancel inside and stand on the surface.
    #[test]
    fn voronoi_drifts_and_its_repair_does_not() {
        let mesh = crooked();
        let found = operator_quality(&mesh, MODULI, 1000.0).unwrap();
        for name in ["edge_tensors", "hybrid", "gauss_voronoi, dual = median"] {
            let quality = named(&found, name);
            assert!(quality.asymmetry < 1e-14 && quality.growth_rate.abs() < 0.1, "{quality:?}");
        }
        let drifting = named(&found, "gauss_voronoi, dual = voronoi");
        assert!(drifting.asymmetry > 0.05 && drifting.growth_rate > 1.0, "{drifting:?}");
        let elastic = named(&found, "edge_tensors");
        assert!(elastic.inner_cross_terms < 1e-15 && elastic.border_cross_terms > 0.004, "{elastic:?}");
        let body = Body { mesh: &mesh, simplices: Simplex::all(&mesh).unwrap() };
        let sums = body.flows(MODULI, Dual::Voronoi);
        let masses: Vec<f64> = body.shares().iter().map(|share| share * 1000.0).collect();
        let step = stable_step(&sums, &masses);
        let halved = growth_with_step(&sums, &masses, 0.5 * step, 2 * STEPS);
        assert!((halved / drifting.growth_rate - 1.0).abs() < 0.2, "{halved} {}", drifting.growth_rate);
    }

    /// Gauss on median cells is linear finite elements with the scalar Laplacian, to rounding; with stresses it is Hooke's law.
    #[test]
    fn median_cells_are_finite_elements() {
        let mesh = crooked();
        let body = Body { mesh: &mesh, simplices: Simplex::all(&mesh).unwrap() };
        let linear = LinearBody { simplices: body.simplices.clone(), moduli: vec![MODULI], depth: 1.0 };
        for (flux, stiffness) in [(Flux::Operators, hybrid as Stiffness), (Flux::Stress, elastic)] {
            let choices = Choices { dual: Dual::Median, flux, parts: [1.0, 1.0] };
            let gauss = gauss_voronoi::sums(&mesh, &vec![0; body.simplices.len()], &linear, &choices);
            let elements = body.assembled(MODULI, stiffness);
            let size = elements
                .iter()
                .flat_map(|(_, blocks)| blocks)
                .fold(0.0, |a: f64, b| a.max(b.largest_entry()));
            for ((ends, gauss), (other, elements)) in gauss.iter().zip(elements.iter()) {
                assert_eq!(ends, other);
                for (a, b) in gauss.iter().zip(elements) {
                    assert!((*a - b).largest_entry() <= 1e-14 * size, "{ends:?}");
                }
            }
        }
    }

    /// V-13, V-14: in the plane Voronoi's dual is linear finite elements on acute triangles; exact of quadratic fields on the
    /// equilateral lattice, and not off it.
    #[test]
    fn in_the_plane_duals_are_one() {
        for (lean, is_exact) in [(0.0, true), (0.05, false)] {
            let mesh = lattice(lean);
            let body = Body { mesh: &mesh, simplices: Simplex::all(&mesh).unwrap() };
            let (gauss, elements) = (body.flows(MODULI, Dual::Voronoi), body.assembled(MODULI, hybrid));
            let border: BTreeSet<u32> = body.border_edges().iter().flatten().copied().collect();
            let mut compared = 0;
            let gauss: std::collections::BTreeMap<_, _> = gauss.iter().collect();
            for (ends, of_elements) in
                elements.iter().filter(|(ends, _)| ends.iter().all(|end| !border.contains(end)))
            {
                for (a, b) in gauss[&ends].iter().zip(of_elements) {
                    assert!((*a - b).largest_entry() < 1e-12 * MODULI.lambda, "{lean} {ends:?} {a:?} {b:?}");
                    compared += 1;
                }
            }
            assert!(compared > 50);
            let found = operator_quality(&mesh, MODULI, 1000.0).unwrap();
            // cross terms of a triangle are 1/2 on each of its edges, which the next one takes away
            let elastic = named(&found, "edge_tensors");
            assert!(elastic.inner_cross_terms < 1e-14, "{elastic:?}");
            assert!((elastic.border_cross_terms - 0.5).abs() < 1e-14, "{elastic:?}");
            for name in ["hybrid", "gauss_voronoi, dual = voronoi"] {
                let OperatorQuality { laplacian_error, grad_div_error, .. } = *named(&found, name);
                let is_small = |error: f64| error < 1e-10;
                assert_eq!(
                    [is_small(laplacian_error), is_small(grad_div_error)],
                    [is_exact; 2],
                    "{lean} {found:?}"
                );
            }
        }
    }
}
