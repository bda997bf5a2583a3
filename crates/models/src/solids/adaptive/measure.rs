//! Criteria of all cells of a chunk at once, in lanes: to rounding the numbers of [`super::criteria`] cell by cell.

use pulp::{Arch, Simd, WithSimd};
use souple_math::{Lanes, Padded, Real, Vec3};
use souple_mesh::{ElementKind, MAX_NODES};

use super::criteria::{Criterion, faces, shape_factor};
use crate::solids::geometry::{AnyElement, Geometry};
use crate::solids::group::{Group, for_each_group};
use crate::solids::layout::{Chunk, LANES, LaneBlock};

/// Nodes of a hexahedron, and of all smaller elements of first order.
const FEW_NODES: usize = 8;

/// The cells of a chunk at rest.
pub struct AtRest {
    /// Of the chunk's own rows.
    positions: Vec<Padded>,
    /// `1/l₀²` by block and edge, where lengths are measured: a division takes longer than the rest of an edge.
    per_square: Vec<LaneBlock>,
}

impl AtRest {
    pub fn new(kind: ElementKind, chunk: &Chunk, positions: Vec<Padded>, measures_lengths: bool) -> Self {
        let nodes = kind.node_count();
        let of_edge = |block: usize, [a, b]: [u8; 2]| {
            LaneBlock(std::array::from_fn(|lane| {
                let [a, b] = [a, b].map(|node| {
                    let local = chunk.connectivity[(block * nodes + usize::from(node)) * LANES + lane];
                    Vec3::from(positions[usize::from(local)])
                });
                1.0 / (b - a).length_sq()
            }))
        };
        let of_block = |block| kind.edges().iter().map(move |edge| of_edge(block, *edge));
        let per_square =
            if measures_lengths { (0..chunk.block_count()).flat_map(of_block).collect() } else { Vec::new() };
        Self { positions, per_square }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.positions.as_slice()) + size_of_val(self.per_square.as_slice())
    }
}

/// The cells of a chunk, at rest and as they stand.
pub struct Measured<'a> {
    pub kind: ElementKind,
    pub chunk: &'a Chunk,
    /// `∂N_a/∂ξ`, sample after sample.
    pub reference: &'a [Vec3],
    pub rest: &'a AtRest,
    /// Of the chunk's own rows.
    pub now: &'a [Padded],
    /// In a plane of constant z, where areas have a sign.
    pub is_plane: bool,
}

impl Measured<'_> {
    /// Raises `excess` of each cell of the chunk, in its order, to a criterion over its threshold where that is more. What has
    /// no number any more is over any.
    pub fn raise(&self, criterion: Criterion, threshold: f64, excess: &mut [f64]) {
        // arrays for all nodes that an element may have take longer to clear than a hexahedron to measure
        if self.kind.node_count() <= FEW_NODES {
            Arch::new().dispatch(Raise::<FEW_NODES> { of: self, criterion, threshold, excess });
        } else {
            Arch::new().dispatch(Raise::<MAX_NODES> { of: self, criterion, threshold, excess });
        }
    }
}

/// Of elements of at most `N` nodes.
struct Raise<'a, const N: usize> {
    of: &'a Measured<'a>,
    criterion: Criterion,
    threshold: f64,
    excess: &'a mut [f64],
}

impl<const N: usize> WithSimd for Raise<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { of, criterion, threshold, excess } = self;
        let Measured { kind, chunk, reference, rest, now, is_plane } = *of;
        let (nodes, blocks) = (kind.node_count(), chunk.block_count());
        let samples = reference.len() / nodes;
        for_each_group!(simd, chunk, nodes, samples, 0..blocks, N, |group| {
            let x = group.gather(now);
            let measured = match criterion {
                Criterion::Volume => {
                    let rest = group.gather(&rest.positions);
                    volume(kind, &group, [&rest, &x], reference, is_plane)
                }
                Criterion::Length => {
                    let edges = kind.edges().len();
                    length(kind, &group, &rest.per_square[group.block * edges..][..edges], &x)
                }
                Criterion::Shape => shape(kind, &group.gather(&rest.positions), &x),
                Criterion::Force => unreachable!("its law is asked cell by cell"),
            };
            for (offset, number) in measured.as_slice().iter().enumerate() {
                // lane `l` of block `b` holds cell `l · blocks + b`
                if let Some(excess) = excess.get_mut((group.lane + offset) * blocks + group.block) {
                    // turned inside out
                    let is_over = criterion == Criterion::Volume && *number <= -1.0;
                    let over = if is_over { f64::INFINITY } else { number.abs() / threshold };
                    *excess = if over.is_nan() { f64::INFINITY } else { excess.max(over) };
                }
            }
        });
    }
}

// Σ ω det F / Σ ω - 1, where of a surface element det F is the ratio of areas
#[inline(always)]
fn volume<S: Simd, const N: usize>(
    kind: ElementKind,
    group: &Group<'_, S, N>,
    [at_rest, x]: [&[Vec3<Lanes<S>>; N]; 2],
    reference: &[Vec3],
    is_plane: bool,
) -> Lanes<S> {
    let nodes = group.nodes;
    let zero = Lanes::constant(group.simd, 0.0);
    let (mut now, mut rest) = (zero, zero);
    for sample in 0..group.samples {
        let (inverse, volume) = group.sample(sample);
        let reference = &reference[sample * nodes..(sample + 1) * nodes];
        let J = AnyElement::gradient(&x[..nodes], reference);
        let of_now = match kind.dimension() {
            2 if is_plane => {
                // a cell may be wound either way round
                let J0 = AnyElement::gradient(&at_rest[..nodes], reference);
                let [now, rest] = [J, J0].map(|J| J.columns[0].cross(J.columns[1]).z);
                now * (rest / rest.abs())
            }
            2 => J.columns[0].cross(J.columns[1]).length(),
            _ => J.determinant(),
        };
        now += volume * (of_now * inverse.determinant());
        rest += volume;
    }
    now / rest - 1.0
}

// the longest and the shortest by squares, and one root of each
#[inline(always)]
fn length<S: Simd, const N: usize>(
    kind: ElementKind,
    group: &Group<'_, S, N>,
    per_square: &[LaneBlock],
    now: &[Vec3<Lanes<S>>; N],
) -> Lanes<S> {
    let like = now[0].x;
    let (mut longest, mut shortest, mut sum) = (like.one(), like.one(), like.zero());
    for ([a, b], per_square) in kind.edges().iter().zip(per_square) {
        let square = (now[usize::from(*b)] - now[usize::from(*a)]).length_sq() * group.load(per_square);
        longest = longest.max(square);
        shortest = shortest.min(square);
        sum += square;
    }
    (longest.sqrt() - 1.0).max(like.one() - shortest.sqrt()) + no_number(sum)
}

/// Zero, or no number where `sum` is none: comparisons lose it.
#[inline(always)]
fn no_number<R: Real>(sum: R) -> R {
    sum * 0.0
}

#[inline(always)]
fn shape<R: Real>(kind: ElementKind, rest: &[Vec3<R>], now: &[Vec3<R>]) -> R {
    let (mut most, mut sum) = (rest[0].x.zero(), rest[0].x.zero());
    for corners in faces(kind) {
        for at in 0..corners.len() {
            let (a, b, c) = (
                usize::from(corners[at]),
                usize::from(corners[(at + 1) % corners.len()]),
                usize::from(corners[(at + 2) % corners.len()]),
            );
            let growth = shape_factor([now[a], now[b], now[c]]) / shape_factor([rest[a], rest[b], rest[c]]);
            most = most.max(growth - 1.0);
            sum += growth;
        }
    }
    most + no_number(sum)
}
