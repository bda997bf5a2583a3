//! Cells of points in the plane and in space: Voronoi's, the median ones of finite elements, and what flows through both.

use crate::reading::Statistic;
use crate::{Case, Limit, OperatorNumber, Reading, Refinement, Tolerance, Variant};

const PLANE: Case = Case {
    id: "plane_duals_alike",
    capabilities: &["DEB-19", "DEB-22"],
    what: "farthest apart that a point is by fluxes through Voronoi's cells and by finite elements, of acute triangles moved at random",
    scene: "equal_duals",
    settings: &["bodies.cells.mesh.disorder=0.1", "bodies.elements.mesh.disorder=0.1"],
    reading: Reading::last("apart"),
    refinement: None,
    reference: 0.0,
    // of displacements up to 9 cm
    tolerance: Tolerance::Absolute(1e-13),
    source: "V-13: equal to 1e-12",
    mutation: "bodies.cells.formulation.part=\"laplacian\"",
};

/// The exact field, which equilateral triangles have.
const EXACT: Case = Case {
    capabilities: &["DEB-19", "DEB-26"],
    settings: &[],
    tolerance: Tolerance::Absolute(1e-11),
    source: "V-14: quadratic fields are exact on equilateral lattices, to 1e-10 of them",
    ..PLANE
};

/// Half as much disorder, half the error, up to what is of second order in it: a tenth of the order at a hundredth of an edge.
const REGULAR: Refinement = Refinement {
    size_of: "disorder [edge]",
    runs: &[
        Variant { size: 0.02, settings: &["bodies.cells.mesh.disorder=0.02"] },
        Variant { size: 0.01, settings: &["bodies.cells.mesh.disorder=0.01"] },
        Variant { size: 0.005, settings: &["bodies.cells.mesh.disorder=0.005"] },
    ],
    limit: Limit::Known(0.0),
};

const CUBE: Case = Case {
    id: "nine_points_centre",
    capabilities: &["DEB-20"],
    what: "mass of the middle one of nine points of a cube of a kilogram: a truncated octahedron of half the volume",
    scene: "nine_points",
    settings: &[],
    reading: Reading::last("centre").after(1),
    refinement: None,
    reference: 0.5,
    tolerance: Tolerance::Absolute(1e-12),
    source: "V-15: planes half way between the centre and the corners",
    mutation: "bodies.cube.mass=\"lumped\"",
};

/// What grows as `e^(r t)` has a kinetic energy of `e^(2 r t)`, but for its swing: its order in `e^(2 t)` is the rate `r`.
const GROWTH: Refinement = Refinement {
    size_of: "e^(2 t / 1 s)",
    runs: &[
        Variant { size: 2_980.957_987_041_728, settings: &["run.duration=\"4 s\""] },
        Variant { size: 54.598_150_033_144_236, settings: &["run.duration=\"2 s\""] },
    ],
    limit: Limit::Known(0.0),
};

/// The same for what grows sooner.
const FASTER: Refinement = Refinement {
    runs: &[
        Variant { size: 403.428_793_492_735_1, settings: &["run.duration=\"3 s\""] },
        Variant { size: 20.085_536_923_187_668, settings: &["run.duration=\"1.5 s\""] },
    ],
    ..GROWTH
};

/// So little at first that it is below its own size in the end.
const LIGHT: &str = "world.gravity=[0, 0, -9.81e-5]";
const VORONOI: &str = r#"bodies.cube.formulation={ name = "gauss_voronoi", dual = "voronoi" }"#;

const DRIFT: Case = Case {
    id: "voronoi_drifts",
    capabilities: &["DEB-21", "DEB-22"],
    what: "rate [1/s] at which the cube's motion grows with Voronoi's cells, K_S(2), left alone without friction",
    scene: "swinging_cube",
    settings: &[VORONOI, LIGHT],
    reading: Reading::last("kinetic").taking(Statistic::Max),
    refinement: Some(GROWTH),
    reference: 4.819_8,
    // two within a tenth of it are within a fifth of each other
    tolerance: Tolerance::Relative(0.1),
    source: "V-20: growth at a rate that is within 20 % when the step is halved; the imaginary part of the frequencies of M⁻¹K by an independent program",
    mutation: "bodies.cube.formulation.dual=\"median\"",
};

/// Numbers of the operators on the mesh of a body.
const OPERATORS: Case = Case {
    id: "",
    capabilities: &["DEB-26"],
    what: "",
    scene: "swinging_cube",
    settings: &[CROOKED, "bodies.cube.pins=[]", "expect=[]"],
    reading: Reading::Operator { operator: ELEMENTS, number: OperatorNumber::Asymmetry },
    refinement: None,
    reference: 0.0,
    // sums of some tens of terms in the other order
    tolerance: Tolerance::Absolute(1e-14),
    source: "specification, V-17",
    mutation: "",
};

const ELEMENTS: &str = "edge_tensors";
const CELLS: &str = "gauss_voronoi, dual = voronoi";
/// Tetrahedra of no pattern, which fill a ball.
const CROOKED: &str =
    r#"bodies.cube.mesh={ shape = "ellipsoid", size = 0.025, semi_axes = [0.05, 0.05, 0.05] }"#;

/// Frequencies of the cube that nobody holds, K_S(2).
const FREE: Case = Case {
    capabilities: &["DEB-2", "DEB-26"],
    settings: &["bodies.cube.pins=[]", r#"bodies.cube.formulation={ name = "edge_tensors" }"#],
    reading: Reading::FreeFrequency(6),
    // roots of rounding: 1e-16 of the highest, 130 Hz squared, and a hundred times that
    tolerance: Tolerance::Absolute(1e-5),
    source: "specification, V-17: eigenvalue count on K(2), six zeros of Cauchy's, three of the hybrid operator",
    ..OPERATORS
};

/// A coarse block under the ball of a scene, which presses it by 6.5 mm and goes, with much friction.
macro_rules! sideways {
    ($formulation:literal) => {
        &[
            r#"probes={ dent = { body = "block", region = { nearest = [0.06, 0.06, 0.06] }, quantity = "displacement" }, side = { body = "block", region = { nearest = [0.12, 0.06, 0.045] }, quantity = "displacement" }, kinetic = { body = "block", quantity = "kinetic_energy" } }"#,
            "expect=[]",
            "bodies.block.levels=",
            "systems.main.stepper=\"symplectic_euler\"",
            "systems.main.steps_per_period=40",
            "bodies.block.mesh.cells=[6, 6, 3]",
            "bodies.block.material.name=\"linear\"",
            concat!("bodies.block.formulation=", $formulation),
            "bodies.block.damping={ rayleigh_mass = 400 }",
            "shapes.ball.motion.offsets=[[0, 0, 0], [0, 0, 0], [0, 0, -0.0085], [0, 0, -0.0085], [0, 0, 0]]",
        ]
    };
}

const SIDEWAYS: Case = Case {
    capabilities: &["DEB-21"],
    scene: "pressed_block",
    source: "specification, V-21: sideways rightly; after the release slow divergence, where Cauchy's strain settles in the same conditions",
    ..OPERATORS
};

pub(super) const CASES: &[Case] = &[
    PLANE,
    Case {
        id: "free_cauchy_sixth",
        what: "the sixth lowest frequency of a free cube by Cauchy's strain: zero, as the five before it",
        mutation: r#"bodies.cube.formulation={ name = "hybrid" }"#,
        ..FREE
    },
    Case {
        id: "free_cauchy_seventh",
        what: "the seventh: it is none of a rigid motion",
        reading: Reading::FreeFrequency(7),
        reference: 1.0,
        tolerance: Tolerance::Above,
        mutation: "bodies.cube.material.youngs_modulus=1",
        ..FREE
    },
    Case {
        id: "free_hybrid_third",
        capabilities: &["DEB-23", "DEB-26"],
        what: "the third lowest frequency of a free cube by the hybrid operator: zero",
        settings: &["bodies.cube.pins=[]"],
        reading: Reading::FreeFrequency(3),
        mutation: "bodies.cube.pins=[{ region = \"x_min\" }]",
        ..FREE
    },
    Case {
        id: "free_hybrid_fourth",
        capabilities: &["DEB-23", "DEB-26"],
        what: "the fourth, a turn, which it resists",
        settings: &["bodies.cube.pins=[]"],
        reading: Reading::FreeFrequency(4),
        reference: 1.0,
        tolerance: Tolerance::Above,
        mutation: r#"bodies.cube.formulation={ name = "edge_tensors" }"#,
        ..FREE
    },
    Case {
        id: "operators_asymmetric",
        capabilities: &["DEB-21", "DEB-22", "DEB-26"],
        what: "how far `grad div` of Voronoi's cells alone is from that on the cube of 27 points: by more than a fifth of its size, by which it drifts",
        settings: &[],
        reading: Reading::Operator { operator: CELLS, number: OperatorNumber::GradDivAsymmetry },
        reference: 0.2,
        tolerance: Tolerance::AtLeast,
        source: "specification, V-21: reported by a diagnostic; 2.8.5: 0.32 to 0.44 of other cubes as a whole",
        mutation: "bodies.cube.mesh.cells=[8, 1, 1]",
        ..OPERATORS
    },
    Case {
        id: "operators_inner_cross_terms",
        capabilities: &["DEB-23", "DEB-26"],
        what: "the greatest antisymmetric part of Cauchy's Laplacian on an edge inside a ball of 10 cm, filled without a pattern [m]: they cancel",
        reading: Reading::Operator { operator: ELEMENTS, number: OperatorNumber::InnerCrossTerms },
        // of terms of 5 mm
        tolerance: Tolerance::Absolute(1e-16),
        source: "specification, V-17: zero on interior edges",
        // of a ball of 10 km rounding alone is more
        mutation: r#"bodies.cube.mesh={ shape = "ellipsoid", size = 2500, semi_axes = [5000, 5000, 5000] }"#,
        ..OPERATORS
    },
    Case {
        id: "operators_border_cross_terms",
        capabilities: &["DEB-23", "DEB-26"],
        what: "the same on an edge of the surface of the cube of 27 points, where they do not [m]: that is all by which the hybrid operator differs",
        settings: &[],
        reading: Reading::Operator { operator: ELEMENTS, number: OperatorNumber::BorderCrossTerms },
        // a third of an edge of 5 cm
        reference: 0.05 / 3.0,
        tolerance: Tolerance::Relative(1e-12),
        source: "specification, 2.11: 0.0167 m on boundary edges of K(2)",
        mutation: "bodies.cube.mesh.cells=[3, 3, 3]",
        ..OPERATORS
    },
    Case {
        id: "grad_div_pushes_sideways",
        what: "how far a side of a block comes out by `grad div` of Voronoi's cells alone while a ball presses it from above by 6.5 mm: a hundredth of that and more",
        settings: sideways!("{ name = \"gauss_voronoi\", dual = \"voronoi\", part = \"grad_div\" }"),
        reading: Reading::component("side", 0).after(60),
        reference: 6.5e-5,
        tolerance: Tolerance::AtLeast,
        mutation: "bodies.block.formulation={ name = \"gauss_voronoi\", dual = \"voronoi\", part = \"laplacian\" }",
        ..SIDEWAYS
    },
    Case {
        id: "grad_div_diverges",
        what: "how many times as fast as at the release the block moves two seconds later, friction or not: a hundred times and more in its energy",
        settings: sideways!("{ name = \"gauss_voronoi\", dual = \"voronoi\", part = \"grad_div\" }"),
        reading: Reading::last("kinetic").taking(Statistic::LastOver(130)).after(330),
        reference: 100.0,
        tolerance: Tolerance::Above,
        mutation: "bodies.block.formulation={ name = \"edge_tensors\" }",
        ..SIDEWAYS
    },
    Case {
        id: "cauchy_settles",
        capabilities: &["DEB-2"],
        what: "dent of the same block by Cauchy's strain then: less than a thousandth of what it was pressed by",
        settings: sideways!("{ name = \"edge_tensors\" }"),
        reading: Reading::component("dent", 2).after(330),
        tolerance: Tolerance::Absolute(6.5e-6),
        mutation: "bodies.block.formulation={ name = \"gauss_voronoi\", dual = \"voronoi\", part = \"grad_div\" }",
        ..SIDEWAYS
    },
    Case {
        id: "plane_duals_exact",
        what: "farthest that a point is from a field of the second degree, by fluxes through Voronoi's cells of an equilateral lattice",
        reading: Reading::last("off"),
        mutation: "bodies.cells.mesh.disorder=0.01",
        ..EXACT
    },
    Case {
        id: "plane_elements_exact",
        what: "the same by finite elements with a scalar Laplacian",
        reading: Reading::last("off_elements"),
        mutation: "bodies.elements.mesh.disorder=0.01",
        ..EXACT
    },
    Case {
        id: "plane_duals_regular",
        what: "order at which the first of these falls as the lattice gets regular",
        reading: Reading::last("off"),
        refinement: Some(REGULAR),
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.1),
        source: "V-14: decreasing with regularity; of the first order in how far points are moved",
        // moves that do not get smaller
        mutation: "bodies.cells.mesh.disorder=0.1",
        ..EXACT
    },
    CUBE,
    Case {
        id: "nine_points_all",
        what: "mass of all nine: cells fill the cube",
        reading: Reading::last("cube").after(1),
        reference: 1.0,
        tolerance: Tolerance::Absolute(1e-10),
        source: "V-15: clipped volumes sum to the body's to 1e-10",
        mutation: "bodies.cube.material.density=1001",
        ..CUBE
    },
    Case {
        id: "voronoi_cells_fill_organ",
        what: "mass of the organ by Voronoi's cells over that by quarters of its tetrahedra",
        settings: &["run.duration=\"10 ms\""],
        reading: Reading::Ratio { of: "organ", to: "quarters", component: 0 },
        reference: 1.0,
        tolerance: Tolerance::Absolute(1e-10),
        source: "V-15: clipped volumes sum to the body's to 1e-10, of an irregular organ too",
        mutation: "bodies.organ.material.density=1061",
        ..CUBE
    },
    Case {
        id: "voronoi_corner",
        capabilities: &["DEB-21"],
        what: "what the gradient of the divergence does to a cube's corner of six tetrahedra, through Voronoi's cells over that of finite elements",
        scene: "voronoi_corner",
        reading: Reading::Ratio { of: "voronoi", to: "elements", component: 2 },
        reference: 0.75,
        tolerance: Tolerance::Absolute(1e-12),
        source: "V-16: walls of h²/4 against h²/3 along each axis",
        mutation: "bodies.voronoi.formulation.dual=\"median\"",
        ..CUBE
    },
    DRIFT,
    Case {
        id: "voronoi_drifts_in_half_steps",
        what: "the same in steps half as long: they do not help",
        settings: &[VORONOI, LIGHT, "systems.main.steps_per_period=16"],
        ..DRIFT
    },
    Case {
        id: "median_stays",
        what: "how far the corner swings within 60 s with median cells, without any growth",
        settings: &[
            r#"bodies.cube.formulation={ name = "gauss_voronoi", dual = "median" }"#,
            "run.duration=\"60 s\"",
        ],
        reading: Reading::component("corner", 2).taking(Statistic::Span),
        refinement: None,
        // -35.8 to 1.1 mm within 6 s; two modes 0.1 % apart add what they had apart
        reference: 36.9e-3,
        tolerance: Tolerance::Absolute(0.9e-3),
        source: "V-20: symmetric repair, no growth over 60 s; 3.4: the first 6 s",
        mutation: "bodies.cube.formulation.dual=\"voronoi\"",
        ..DRIFT
    },
    Case {
        id: "voronoi_drifts_sooner",
        what: "the same on K_S(4): the sooner the more points",
        settings: &[VORONOI, LIGHT, "bodies.cube.mesh.cells=[4, 4, 4]", "systems.main.steps_per_period=16"],
        refinement: Some(FASTER),
        reference: 7.216_9,
        ..DRIFT
    },
    Case {
        id: "character_waits",
        capabilities: &["DEB-56"],
        what: "how far a hand of the shaken figure is 16 ms after its belly began to move, a tenth of a metre away",
        scene: "shaken_character",
        reading: Reading::last("far").after(8),
        // a thousandth of how far the belly goes
        reference: 5e-6,
        tolerance: Tolerance::AtMost,
        source: "V-39: finite speed, √((λ + 2μ)/ρ) = 5.7 m/s over 0.0995 m: 17.6 ms; a thousandth is ours, for what steps of a mesh carry ahead of it",
        // twice as fast
        mutation: "bodies.figure.material.youngs_modulus=\"60 kPa\"",
        ..CUBE
    },
    Case {
        id: "character_swings",
        capabilities: &["DEB-56", "DEB-28"],
        what: "how far it is at most within one swing of the belly by 5 mm: a fifth of that at least",
        scene: "shaken_character",
        reading: Reading::last("far").taking(Statistic::Max).after(100),
        reference: 1e-3,
        tolerance: Tolerance::AtLeast,
        source: "V-39: a shake of one part comes to another, and arms swing slightly; a fifth is ours",
        mutation: "bodies.figure.pins[1].motion.formula=[0, 0, 0]",
        ..CUBE
    },
];
