//! The functions of the fuzz targets of skins, of tables of numbers and of kept tapes, which the nightly compiler runs for hours, on a few hundred mutated contents.

#[path = "../../../fuzz/src/lib.rs"]
#[expect(dead_code, reason = "the readers of meshes, scenes and studies have tests of their own")]
mod targets;

#[path = "../../../fuzz/src/mutator.rs"]
mod mutator;

use mutator::{Mutator, guard, repeat};

fn words() -> Vec<Vec<u8>> {
    ["radius", "from", "until", "vx", "1e-3", "0.02", "inf", "nan", "blend", "union", "attraction", "tension"]
        .map(|word| word.as_bytes().to_vec())
        .into()
}

/// Tables of particles are dressed by closed surfaces, or refused.
#[test]
fn mutated_particles_are_dressed_or_refused() {
    let seeds: Vec<Vec<u8>> = [
        "x, y, z, radius, from\n0, 0, 0, 0.1, -1\n0.2, 0, 0, 0.1, 0\n",
        "x,y,z\n0,0,0\n0.2,0,0\n0.2,0.2,0\n0,0.2,0\n0,0,0.2\n0.2,0,0.2\n0.2,0.2,0.2\n0,0.2,0.2\n",
    ]
    .map(|text| text.as_bytes().to_vec())
    .into();
    repeat(600, |seed| {
        let content = Mutator::new(seed ^ (1 << 42), words()).mutated(&seeds);
        guard(seed, &content, 20.0, || targets::dress_particles(&content));
    });
}

/// Tables of numbers and plans are read whole, or refused.
#[test]
fn mutated_tables_are_read_or_refused() {
    let seeds: Vec<Vec<u8>> =
        ["time [s],n.drive [N],\"a, b\" [m]\n0,1,2\n0.01,-3,4e-5\n", "x [m],value\n0,inf\n\n1,2.5\n"]
            .map(|text| text.as_bytes().to_vec())
            .into();
    repeat(4000, |seed| {
        let content = Mutator::new(seed ^ (1 << 45), words()).mutated(&seeds);
        guard(seed, &content, 20.0, || targets::read_table(&content));
    });
}

/// Kept tapes whose bytes have changed are refused, or run within their memory.
#[test]
fn mutated_tapes_run_or_are_refused() {
    let seeds = targets::tape_seeds();
    repeat(2000, |seed| {
        let content = Mutator::new(seed ^ (1 << 44), Vec::new()).mutated(&seeds);
        guard(seed, &content, 20.0, || targets::run_tape(&content));
    });
}

/// Small skins step, or say why not.
#[test]
fn mutated_skins_step_or_are_refused() {
    let seed = "format = 1\n[skins.a]\ndomain = [[-1, -1, -1], [1, 1, 1]]\nvoxel = 0.25\n\
                parts = [{ part = \"point\", at = [0.2, 0, 0], radius = 0.5 }, { part = \"segment\", from = [0, 0, 0], \
                to = [0, 0.3, 0], radius = 0.3, combine = \"union\", warps = [{ warp = \"bend\", rate = 2 }] }]\n\
                terms = [{ term = \"attraction\", strength = 2 }, { term = \"tension\", strength = 0.01 }]\n";
    let seeds = vec![seed.as_bytes().to_vec()];
    repeat(200, |seed| {
        let content = Mutator::new(seed ^ (1 << 43), words()).mutated(&seeds);
        guard(seed, &content, 60.0, || targets::step_skins(&content));
    });
}
