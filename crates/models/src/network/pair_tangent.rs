//! Tangents of what acts between two masses and on nothing else: the block of one end, and its opposites.

use souple_engine::tangent::add_block;
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

/// `δf_a = K (δ_a - δ_b)`, and the opposite on `b`.
pub fn add_change(ends: [u32; 2], block: &Mat3, delta: &[Vec3], out: &mut [Vec3]) {
    let [a, b] = ends.map(|end| end as usize);
    let change = *block * (delta[a] - delta[b]);
    out[a] += change;
    out[b] -= change;
}

/// `K` on both diagonal blocks, `-K` between the two.
pub fn add_pair_blocks(ends: [u32; 2], block: &Mat3, matrix: &mut BlockMatrix) {
    let [a, b] = ends.map(|end| end as usize);
    add_block(matrix, a, a, block);
    add_block(matrix, b, b, block);
    add_block(matrix, a, b, &-*block);
    add_block(matrix, b, a, &-*block);
}
