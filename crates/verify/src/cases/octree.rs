//! Particles: how a cube of them swings by its number, a rod on an octree.

use crate::reading::Statistic;
use crate::{Case, Reading, Tolerance};

const CELLS_7: &str = "bodies.cube.mesh.cells=[7, 7, 7]";

const SWING: Case = Case {
    id: "",
    capabilities: &["DEB-6", "DEB-8"],
    what: "",
    scene: "particles_cube",
    settings: &[],
    reading: Reading::component("corner", 2).taking(Statistic::Frequency),
    refinement: None,
    reference: 4.88,
    tolerance: Tolerance::Relative(0.05),
    source: "specification, V-05: a spread of 10 % at most over the numbers of particles, about the mean of these two",
    mutation: "bodies.cube.material.density=1300",
};

/// By Newton's method on the finest particles, which knows no octree and no time.
const ROD: Case = Case {
    capabilities: &["DEB-9", "DEB-14"],
    scene: "octree_rod",
    reading: Reading::component("tip", 2),
    reference: -1.7770614e-3,
    source: "static equilibrium of the formulation `particles` on the same points",
    ..SWING
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "particles_4",
        what: "how often 4 x 4 x 4 particles swing, by the source's operators",
        ..SWING
    },
    Case { id: "particles_8", what: "the same, 8 x 8 x 8 particles", settings: &[CELLS_7], ..SWING },
    Case {
        id: "particles_energy_8",
        capabilities: &["DEB-7", "DEB-8"],
        what: "lowest frequency of 8 x 8 x 8 particles with an energy",
        settings: &[CELLS_7, r#"bodies.cube.formulation={ name = "particles", volumes = "uniform" }"#],
        reading: Reading::NaturalFrequency(1),
        reference: 4.701,
        source: "specification, 3.4: linear finite elements on K_M(12)",
        mutation: "bodies.cube.material.density=1200",
        ..SWING
    },
    Case {
        id: "octree_liver_rest",
        capabilities: &["DEB-9", "DEB-13", "DEB-18"],
        what: "particles at work in the liver when the tool has drawn back: the coarsest alone, and none finer",
        scene: "octree_liver",
        reading: Reading::last("active"),
        reference: 36.0,
        tolerance: Tolerance::Absolute(0.0),
        source: "the number of 52 mm cubes with a particle in them; V-08 has 34",
        mutation: "bodies.liver.octree.coarsen=0",
        ..SWING
    },
    Case {
        id: "octree_rod_finest",
        what: "sag of a rod of particles, the finest level of its octree alone",
        settings: &[r#"bodies.rod.octree.fixed="1""#],
        // critically damped at 25/s: (1 + 6.3) e^-6.3 of the way are left, and of the first overtones less
        tolerance: Tolerance::Relative(0.02),
        mutation: "world.gravity=[0, 0, -1.1]",
        ..ROD
    },
];
