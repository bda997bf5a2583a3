//! What derived kernels of boxes along the axes are made of: `F` by columns that samples share.
//!
//! A column `∂x/∂X_i` of a hexahedron of eight samples is the same at two of them, so that twelve columns serve where twenty-four would.
//! Of a law of `C = FᵀF` alone, whose first Piola stress is `P = F S(C)`, a column's square and what multiplies the column itself are
//! shared as well: sums of `S_ii` over the samples of a column meet it once.

use souple_math::{Mat3, Real, Vec3};

/// Weights of the four modes of a column along each axis: what the map of a box, the diagonal of `X_ξ⁻¹`, makes of theirs.
#[inline(always)]
pub(super) fn along<R: Real>(X: &Mat3<R>, weights: [f64; 3]) -> [[R; 3]; 3] {
    let [none, one, both] = weights;
    let (xi, eta, zeta) = (X.columns[0].x, X.columns[1].y, X.columns[2].z);
    // written out: a closure that is not inlined is not compiled for the processor's instructions
    [
        [xi * none, xi * one, xi * both],
        [eta * none, eta * one, eta * both],
        [zeta * none, zeta * one, zeta * both],
    ]
}

/// A bilinear function where both coordinates are `-g` or `g`, the first running faster, from its modes: constant, along the first, along
/// the second, along both; `weights` are those of none, one and two.
#[inline(always)]
pub(super) fn bilinear<R: Real>([none, a, b, both]: [Vec3<R>; 4], weights: &[R; 3]) -> [Vec3<R>; 4] {
    let [of_none, of_one, of_both] = *weights;
    let (below, above) = both_ways(none * of_none, a, of_one);
    let (less, more) = both_ways(b * of_one, both, of_both);
    [below - less, above - more, below + less, above + more]
}

/// `a - weight b` and `a + weight b`.
#[inline(always)]
fn both_ways<R: Real>(a: Vec3<R>, b: Vec3<R>, weight: R) -> (Vec3<R>, Vec3<R>) {
    (add_scaled(a, b, -weight), add_scaled(a, b, weight))
}

/// `a + weight b`.
#[inline(always)]
pub(super) fn add_scaled<R: Real>(a: Vec3<R>, b: Vec3<R>, weight: R) -> Vec3<R> {
    Vec3::new(b.x.mul_add(weight, a.x), b.y.mul_add(weight, a.y), b.z.mul_add(weight, a.z))
}

/// Minus the transpose of [`bilinear`]: forces on modes, against what stretches them, from stresses.
#[inline(always)]
pub(super) fn forces_of_modes<R: Real>(values: [Vec3<R>; 4], weights: &[R; 3]) -> [Vec3<R>; 4] {
    let (below, above) = (values[0] + values[2], values[1] + values[3]);
    let (less, more) = (values[2] - values[0], values[3] - values[1]);
    let [of_none, of_one, of_both] = [-weights[0], -weights[1], -weights[2]];
    [(below + above) * of_none, (above - below) * of_one, (less + more) * of_one, (more - less) * of_both]
}

/// `C = FᵀF` of three columns whose squares are known.
#[inline(always)]
pub(super) fn metric<R: Real>([a, b, c]: [Vec3<R>; 3], squares: [R; 3]) -> Mat3<R> {
    symmetric(squares, [a.dot(b), a.dot(c), b.dot(c)])
}

/// `δC = δFᵀF + FᵀδF` of three columns with their differentials, of which `halves` are the products.
#[inline(always)]
pub(super) fn metric_differential<R: Real>(
    [a, b, c]: [Vec3<R>; 3],
    [da, db, dc]: [Vec3<R>; 3],
    [aa, bb, cc]: [R; 3],
) -> Mat3<R> {
    let of = |a: Vec3<R>, da: Vec3<R>, b: Vec3<R>, db: Vec3<R>| {
        da.z.mul_add(b.z, da.y.mul_add(b.y, da.x.mul_add(b.x, a.dot(db))))
    };
    symmetric([aa + aa, bb + bb, cc + cc], [of(a, da, b, db), of(a, da, c, dc), of(b, db, c, dc)])
}

/// A symmetric matrix of its diagonal and its entries 12, 13 and 23.
#[inline(always)]
fn symmetric<R: Real>([a, b, c]: [R; 3], [ab, ac, bc]: [R; 3]) -> Mat3<R> {
    Mat3::from_columns(Vec3::new(a, ab, ac), Vec3::new(ab, b, bc), Vec3::new(ac, bc, c))
}

/// Adds the columns of `F S` to `sums`, but for what the diagonal of `S` makes of each.
#[inline(always)]
pub(super) fn add_across<R: Real>(sums: [Vec3<R>; 3], [a, b, c]: [Vec3<R>; 3], S: &Mat3<R>) -> [Vec3<R>; 3] {
    let (ab, ac, bc) = (S.columns[1].x, S.columns[2].x, S.columns[2].y);
    [
        add_scaled(add_scaled(sums[0], b, ab), c, ac),
        add_scaled(add_scaled(sums[1], a, ab), c, bc),
        add_scaled(add_scaled(sums[2], a, ac), b, bc),
    ]
}
