//! Criteria of all cells of a chunk at once, in lanes: the same numbers as of [`super::criteria`] cell by cell.

use pulp::{Arch, Simd, WithSimd};
use souple_math::{Lanes, Padded, Real, Vec3};
use souple_mesh::{ElementKind, MAX_NODES};

use super::criteria::{Criterion, shape_factor};
use crate::solids::geometry::{AnyElement, Geometry};
use crate::solids::group::{Group, for_each_group};
use crate::solids::layout::{Chunk, LANES};

/// The cells of a chunk, at rest and as they stand.
pub struct Measured<'a> {
    pub kind: ElementKind,
    pub chunk: &'a Chunk,
    /// `∂N_a/∂ξ`, sample after sample.
    pub reference: &'a [Vec3],
    /// Of the chunk's own rows.
    pub rest: &'a [Padded],
    pub now: &'a [Padded],
}

impl Measured<'_> {
    /// Raises `excess` of each cell of the chunk, in its order, to a criterion over its threshold where that is more. What has
    /// no number any more is over any.
    pub fn raise(&self, criterion: Criterion, threshold: f64, excess: &mut [f64]) {
        Arch::new().dispatch(Raise { of: self, criterion, threshold, excess });
    }
}

struct Raise<'a> {
    of: &'a Measured<'a>,
    criterion: Criterion,
    threshold: f64,
    excess: &'a mut [f64],
}

impl WithSimd for Raise<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { of, criterion, threshold, excess } = self;
        let Measured { kind, chunk, reference, rest, now } = *of;
        let (nodes, blocks) = (kind.node_count(), chunk.block_count());
        let samples = reference.len() / nodes;
        for_each_group!(simd, chunk, nodes, samples, 0..blocks, MAX_NODES, |group| {
            let x = group.gather(now);
            let measured = match criterion {
                Criterion::Volume => volume(&group, &x, reference),
                Criterion::Length => length(kind, &group.gather(rest), &x),
                Criterion::Shape => shape(kind, &group.gather(rest), &x),
                Criterion::Force => unreachable!("its law is asked cell by cell"),
            };
            for (offset, number) in measured.as_slice().iter().enumerate() {
                // lane `l` of block `b` holds cell `l · blocks + b`
                if let Some(excess) = excess.get_mut((group.lane + offset) * blocks + group.block) {
                    let over = number / threshold;
                    *excess = if over.is_nan() { f64::INFINITY } else { excess.max(over) };
                }
            }
        });
    }
}

// |Σ ω det F / Σ ω - 1|
#[inline(always)]
fn volume<S: Simd>(
    group: &Group<'_, S, MAX_NODES>,
    x: &[Vec3<Lanes<S>>; MAX_NODES],
    reference: &[Vec3],
) -> Lanes<S> {
    let nodes = group.nodes;
    let zero = Lanes::constant(group.simd, 0.0);
    let (mut now, mut rest) = (zero, zero);
    for sample in 0..group.samples {
        let (inverse, volume) = group.sample(sample);
        let J = AnyElement::gradient(&x[..nodes], &reference[sample * nodes..(sample + 1) * nodes]);
        now += volume * (J.determinant() * inverse.determinant());
        rest += volume;
    }
    (now / rest - 1.0).abs()
}

#[inline(always)]
fn length<R: Real>(kind: ElementKind, rest: &[Vec3<R>], now: &[Vec3<R>]) -> R {
    let mut most = rest[0].x.zero();
    for [a, b] in kind.edges() {
        let (a, b) = (usize::from(*a), usize::from(*b));
        let (length, at_rest) = ((now[b] - now[a]).length(), (rest[b] - rest[a]).length());
        most = most.max((length / at_rest - 1.0).abs());
    }
    most
}

#[inline(always)]
fn shape<R: Real>(kind: ElementKind, rest: &[Vec3<R>], now: &[Vec3<R>]) -> R {
    let mut most = rest[0].x.zero();
    for face in kind.faces() {
        let corners = &face.nodes[..face.kind.corner_count()];
        for at in 0..corners.len() {
            let (a, b, c) = (
                usize::from(corners[at]),
                usize::from(corners[(at + 1) % corners.len()]),
                usize::from(corners[(at + 2) % corners.len()]),
            );
            let growth = shape_factor([now[a], now[b], now[c]]) / shape_factor([rest[a], rest[b], rest[c]]);
            most = most.max(growth - 1.0);
        }
    }
    most
}
