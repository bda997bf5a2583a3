//! Bodies of frames: the reference bar against converged answers, a ligament, a bar that spins freely, tied organs.

use super::bar::{N4, N6, N8};
use crate::{Case, Limit, Reading, Refinement, Statistic, Tolerance, Variant};

const BAR: Case = Case {
    id: "",
    capabilities: &["BOS-4"],
    what: "",
    scene: "frames_cantilever",
    settings: &[],
    reading: Reading::component("tip", 1),
    refinement: None,
    reference: TIP_STVK,
    tolerance: Tolerance::Relative(0.02),
    source: "FEniCSx, quadratic hexahedra, fitted limit",
    mutation: r#"bodies.bar.material.youngs_modulus="9.5 MPa""#,
};

// of reference/solids.json, limits of quadratic hexahedra by FEniCSx

/// Tip of the reference bar in equilibrium [m]: `beam_gravity_fenicsx.stvk.tip_uy.limit`.
const TIP_STVK: f64 = -0.144_982_917_950_976_7;
/// `beam_gravity_fenicsx.nh_ln.tip_uy.limit`.
const TIP_NEO_HOOKEAN: f64 = -0.144_978_258_526_270_25;
/// Its first natural frequency of torsion [Hz]: `modal_fenicsx.extrapolated[4].limit`.
const TORSION: f64 = 14.262_434_014_307_647;

/// The axis of the bar held across: in torsion it is at rest, by symmetry, and no frequency of torsion changes, while bending is
/// gone. The lowest mode left is the first of torsion, the next one that of stretch, wherever bending was among them.
const AXIS_HELD: &str = r#"bodies.bar.pins=[{ region = "x_min" }, { region = { formula = "abs(y - 0.05) + abs(z - 0.05) < 1e-6" }, axes = "yz" }]"#;

/// Frames as far apart along the bar as across, and points, halved together: eight points between two frames.
const HALVED: Refinement = Refinement {
    size_of: "distance of frames [m]",
    runs: &[
        Variant { size: 0.1, settings: &["bodies.bar.frames.placement.counts=[11, 2, 2]", N4] },
        Variant { size: 0.05, settings: &["bodies.bar.frames.placement.counts=[21, 3, 3]", N8] },
    ],
    // springs as stiff as a layer of a five-thousandth of the length turn the root by q L²/2 L/(5000 E I): of the tip q L⁴/(8 E I)
    // that is 4/5000
    limit: Limit::Known(TIP_STVK * (1.0 + 8e-4)),
};

const ORDER: Case = Case {
    refinement: Some(HALVED),
    // an energy, of strains that affine fields represent to the first order, 2; of the singularity along the edges of the clamp, where
    // displacements go as r^0.71 (a free side at a right angle, nu = 0.3), 1.42
    reference: 1.71,
    tolerance: Tolerance::Absolute(0.29),
    source: "Strang & Fix 1973, §2.2; Williams 1952",
    // frames that hardly reach each other
    mutation: r#"bodies.bar.frames.weights={ name = "wendland", support = 1.1 }"#,
    ..BAR
};

const RIGID: &str = r#"bodies.bar.frames.kind="rigid""#;

const LIGAMENT: Case = Case {
    capabilities: &["BOS-3"],
    scene: "ligament",
    reading: Reading::component("end", 1),
    reference: -0.01,
    // its springs give way by as much as a layer of a five-thousandth of its length strains, if that were by one
    tolerance: Tolerance::Absolute(2e-5),
    source: "the motion of the pin",
    mutation: r#"bodies.ligament.pins[1].rotation.offsets[2]=["170 deg", 0, 0]"#,
    ..BAR
};

/// Without what leads the end of the ligament, five frames on a line.
const FIVE: Case = Case { settings: &[FIVE_FRAMES, UNTURNED], ..LIGAMENT };
const FIVE_FRAMES: &str = "bodies.ligament.frames.placement.count=5";
const UNTURNED: &str = "bodies.ligament.pins[1].rotation.offsets[2]=[0, 0, 0]";

const SPINNING: Case = Case {
    capabilities: &["BOS-6"],
    scene: "frames_spinning",
    reading: Reading::component("spin", 2),
    // m (L² + w²)/12 ω = 5 kg (0.25 + 0.01) m²/12 · 6/s
    reference: 0.65,
    tolerance: Tolerance::Relative(1e-9),
    source: "angular momentum of a block about its middle, which nothing changes",
    // a drag
    mutation: "bodies.bar.damping={ rayleigh_mass = 1e-4 }",
    ..BAR
};

/// A rigid motion of all frames.
const LED: Case = Case {
    capabilities: &["BOS-1"],
    scene: "frames_led",
    reading: Reading::last("strain").taking(Statistic::Max),
    reference: 0.0,
    // strains of 1e-14, rounding of positions over cells, squared, times a modulus of 1 MPa and 0.005 m³, is 5e-25 J
    tolerance: Tolerance::Absolute(1e-22),
    source: "F is a rotation for any weights that sum to one",
    mutation: "bodies.bar.frames.bones[0].frames=[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10]",
    ..BAR
};

const STRAPS: Case = Case {
    capabilities: &["BOS-9"],
    scene: "collateral",
    settings: &[r#"run.duration="0.45 s""#],
    reading: Reading::last("pull"),
    ..BAR
};

const MEMBRANE: Case = Case {
    capabilities: &["BOS-3"],
    scene: "membrane",
    reference: 0.01,
    // springs as a layer of a five-thousandth of its length
    tolerance: Tolerance::Absolute(2e-5),
    source: "symmetry: the middle goes half of the way, and turns by half",
    ..BAR
};

const CONDITION: Case = Case {
    capabilities: &["BOS-3"],
    reading: Reading::MomentCondition("sheet"),
    // 1/epsilon where an eigenvalue is nothing, with the eigenvalues' own rounding
    reference: 4.503_599_627_370_496e15,
    tolerance: Tolerance::Absolute(3.6e15),
    source: "points in a plane have no moment across it",
    ..BAR
};

/// Energy of a spinning bar, `m v²/2 + ω·Jω/2` of a block of 5 kg [J].
const SPINNING_ENERGY: f64 = 1.988_541_666_666_666_7;

/// A pad of 3 kPa with fibres of 6 kPa along its own x.
const FIBRES: &str = r#"bodies.pad.material={ name = "hyperelastic", energy = "mu*dot(eps, eps) + c/2*dot(a, eps*a)^2", parameters = { mu = "1.5 kPa", c = "6 kPa", a = [1, 0, 0] }, density = 920 }"#;

const TISSUES: Case = Case { capabilities: &["BOS-9"], scene: "tissues", ..BAR };

/// Halves of one mesh, the second of which hangs on the first.
const JOINED: Case = Case {
    capabilities: &["BOS-9"],
    scene: "joined_halves",
    settings: &[
        r#"bodies.held.mesh={ generate = "bar", size = [0.5, 0.1, 0.1], cells = [15, 3, 3], element = "tet4" }"#,
        r#"bodies.free.mesh={ generate = "bar", size = [0.5, 0.1, 0.1], cells = [15, 3, 3], element = "tet4" }"#,
    ],
    // of the mesh of 30 x 3 x 3 cubes in one piece
    reference: -0.100_512_440_298_482_87,
    tolerance: Tolerance::Relative(1e-7),
    source: "the bar in one piece, FEniCSx, to ten digits; reference/solids.json, beam_gravity_P1_kuhn_fenicsx.stvk_n3",
    mutation: r#"attachments[0].hold="springs""#,
    ..BAR
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "joined_halves_are_one_bar",
        what: "tip of a clamped bar of two halves whose points hang on each other, 1,620 tetrahedra",
        ..JOINED
    },
    Case {
        id: "joined_halves_hold",
        what: "what holds the bar whose finer half hangs on the coarser one: the weight of both",
        settings: &[],
        reading: Reading::component("hold", 1),
        reference: 98.1,
        tolerance: Tolerance::Relative(1e-9),
        source: "1000 kg/m3 of 0.01 m3",
        mutation: "bodies.free.material.density=1001",
        ..JOINED
    },
    Case {
        id: "frames_bar_affine",
        what: "tip of the clamped bar, 44 affine frames, St. Venant-Kirchhoff",
        ..BAR
    },
    Case {
        id: "frames_bar_affine_neo_hookean",
        what: "tip of the clamped bar, 44 affine frames, neo-Hookean",
        settings: &[r#"bodies.bar.material.name="neo_hookean""#],
        reference: TIP_NEO_HOOKEAN,
        ..BAR
    },
    Case {
        id: "frames_bar_affine_fine",
        what: "the same, 189 affine frames, three by three across",
        settings: &["bodies.bar.frames.placement.counts=[21, 3, 3]"],
        tolerance: Tolerance::Relative(2e-3),
        ..BAR
    },
    Case {
        id: "frames_bar_affine_order",
        what: "order at which the error of the tip falls with the distance of affine frames and of points",
        ..ORDER
    },
    Case {
        id: "frames_bar_torsion_order",
        what: "the same of the first frequency of torsion",
        settings: &[AXIS_HELD],
        reading: Reading::NaturalFrequency(1),
        refinement: Some(Refinement { limit: Limit::Known(TORSION), ..HALVED }),
        ..ORDER
    },
    Case {
        id: "frames_bar_rigid_order",
        what: "the same of rigid frames: of the layer along the surface where frames stand on one side alone",
        settings: &[RIGID],
        refinement: Some(Refinement {
            runs: &[
                Variant { size: 0.05, settings: &["bodies.bar.frames.placement.counts=[21, 3, 3]", N4] },
                Variant {
                    size: 1.0 / 30.0,
                    settings: &["bodies.bar.frames.placement.counts=[31, 4, 4]", N6],
                },
            ],
            // in the middle of a lattice strains ripple by 1 - ∇Σ w X, which makes it stiffer by 0.05 % however fine it is
            limit: Limit::Known(TIP_STVK * (1.0 + 8e-4) / 1.000_493),
            ..HALVED
        }),
        // Σ w X is off by the distance of frames within a support of the surface: strains by a part of themselves, in a volume that
        // falls as the distance
        reference: 1.0,
        tolerance: Tolerance::Absolute(0.5),
        source: "own: Shepard's weights at the side of a lattice; nearer to one than to two",
        mutation: r#"bodies.bar.frames.weights={ name = "wendland", support = 1.5 }"#,
        ..ORDER
    },
    Case {
        id: "frames_bar_rigid_floor",
        what: "tip of the clamped bar, 496 rigid frames that reach one and a half distances: no nearer to the answer than 16 %",
        settings: &[
            RIGID,
            "bodies.bar.frames.placement.counts=[31, 4, 4]",
            N6,
            r#"bodies.bar.frames.weights={ name = "wendland", support = 1.5 }"#,
        ],
        // never softer than in the middle of a lattice, where the energy of a stretch along it is 1.194 times that of the matter, by
        // cubature of ∇Σ w X over a cell, nu = 0.3, and its sides free
        reference: TIP_STVK * (1.0 + 8e-4) / 1.194,
        tolerance: Tolerance::AtLeast,
        source: "own: what Shepard's weights of a cubic lattice make of a linear field",
        mutation: r#"bodies.bar.frames.weights={ name = "wendland", support = 2 }"#,
        ..BAR
    },
    Case {
        id: "frames_bar_reaction",
        what: "what holds the bar: its weight",
        reading: Reading::component("hold", 1),
        reference: 98.1,
        tolerance: Tolerance::Relative(1e-6),
        source: "1000 kg/m3 of 0.01 m3",
        // another hand that bears a part of it
        mutation: r#"bodies.bar.springs=[{ region = "x_max", stiffness = "1 N/m" }]"#,
        ..BAR
    },
    Case {
        id: "frames_bar_torsion",
        what: "first natural frequency of torsion of the clamped bar, 44 affine frames: the lowest where its axis cannot bend",
        settings: &[AXIS_HELD],
        reading: Reading::NaturalFrequency(1),
        reference: TORSION,
        source: "FEniCSx, linear, consistent mass, fitted limit",
        mutation: r#"bodies.bar.material.youngs_modulus="9 MPa""#,
        ..BAR
    },
    Case {
        id: "frames_ligament_turned",
        what: "corner of the led end of a ligament after half a turn",
        ..LIGAMENT
    },
    Case {
        id: "frames_ligament_long_steps",
        capabilities: &["BOS-3", "BOS-5"],
        what: "the same with steps of 20 ms",
        settings: &[r#"world.period="20 ms""#],
        ..LIGAMENT
    },
    Case {
        id: "frames_ligament_explodes",
        capabilities: &["BOS-5"],
        what: "steps of 20 ms that an explicit stepper comes through, of a hundred",
        settings: &[r#"world.period="20 ms""#, r#"systems.main.stepper="symplectic_euler""#],
        reading: Reading::Steps,
        // the highest frequency, 1.18e5 rad/s, makes (h ω)² = 5.6e6 of every error in a step: from rounding to nonsense in three
        reference: 6.0,
        tolerance: Tolerance::AtMost,
        source: "stability of explicit steps, h ω < 2",
        mutation: r#"systems.main.stepper="backward_euler""#,
        ..LIGAMENT
    },
    Case {
        id: "frames_ligament_short_steps",
        capabilities: &["BOS-5"],
        what: "steps of half the longest that is stable that the same stepper comes through, of a thousand",
        settings: &[
            // the highest frequency is 1.18e5 rad/s, and 2/ω 17 us
            r#"world.period="8.5 us""#,
            "run.duration=0.0085",
            r#"systems.main.stepper="symplectic_euler""#,
        ],
        reading: Reading::Steps,
        reference: 1000.0,
        tolerance: Tolerance::AtLeast,
        source: "stability of explicit steps, h ω < 2",
        // ω four times as high
        mutation: r#"bodies.ligament.material.youngs_modulus="3.2 MPa""#,
        ..LIGAMENT
    },
    Case {
        id: "frames_newton_is_quadratic",
        capabilities: &["BOS-5"],
        what: "Newton iterations of a step of 20 ms down to 1e-10 of the residual, in the mean",
        settings: &[
            r#"world.period="20 ms""#,
            r#"systems.main.stepper={ name = "backward_euler", newton_tolerance = 1e-10 }"#,
        ],
        reading: Reading::NewtonIterations,
        // of one right digit after the first there are 2, 4, 8 and 16 after the next
        reference: 5.0,
        tolerance: Tolerance::AtMost,
        source: "quadratic convergence of Newton's method with the full tangent",
        mutation: r#"bodies.ligament.frames.tangent="material""#,
        ..LIGAMENT
    },
    Case {
        id: "frames_ligament_middle",
        what: "side of its middle, turned by a quarter without weight",
        settings: &["world.gravity=[0, 0, 0]"],
        reading: Reading::component("middle", 1),
        reference: -0.005,
        // the side of the middle goes to where the back was, by symmetry; what Newton's method leaves of a motion of 1 cm
        tolerance: Tolerance::Absolute(1e-8),
        source: "symmetry: half of the turn in the middle",
        mutation: r#"bodies.ligament.pins[1].rotation.offsets[2]=["90 deg", 0, 0]"#,
        ..LIGAMENT
    },
    Case {
        id: "frames_spin_kept",
        what: "angular momentum of a free bar of affine frames after 1000 symplectic steps",
        ..SPINNING
    },
    Case {
        id: "frames_momentum_kept",
        what: "its momentum",
        reading: Reading::component("momentum", 0),
        reference: 0.5,
        source: "5 kg at 0.1 m/s",
        // a force from outside, of a ten-thousandth of its momentum a second
        mutation: "bodies.bar.damping={ rayleigh_mass = 1e-4 }",
        ..SPINNING
    },
    Case {
        id: "frames_tissue_carries",
        capabilities: &["BOS-9"],
        what: "what holds an organ from which another hangs by tissue: the weight of all three",
        scene: "tied_organs",
        settings: &[
            "bodies.lower.springs=[]",
            "bodies.lower.mesh.cells=[4, 2, 4]",
            "bodies.upper.mesh.cells=[4, 2, 4]",
            "bodies.tissue.mesh.cells=[3, 2, 3]",
            "run.duration=3",
        ],
        reading: Reading::component("pull", 1),
        // (0.4 + 0.4 + 0.072) kg · 9.81 m/s²
        reference: 8.55432,
        tolerance: Tolerance::Relative(1e-3),
        source: "equilibrium: what is left of the swing after three seconds is the tolerance",
        mutation: "bodies.tissue.material.density=1200",
        ..BAR
    },
    Case {
        id: "frames_rigid_motion",
        what: "energy of strain of a bar whose frames turn as one, Wendland's weights",
        ..LED
    },
    Case {
        id: "frames_rigid_motion_gaussian",
        what: "the same, Gauss's",
        settings: &[r#"bodies.bar.frames.weights="gaussian""#],
        ..LED
    },
    Case {
        id: "frames_rigid_motion_inverse",
        what: "the same, by inverse distance",
        settings: &[r#"bodies.bar.frames.weights="inverse_distance""#],
        ..LED
    },
    Case {
        id: "frames_rigid_motion_harmonic",
        what: "the same, harmonic, affine frames, points in voxels",
        settings: &[
            r#"bodies.bar.frames.weights="harmonic""#,
            r#"bodies.bar.frames.kind="affine""#,
            r#"bodies.bar.frames.points={ name = "voxels", size = "4 cm" }"#,
        ],
        ..LED
    },
    Case {
        id: "frames_rigid_motion_geodesic",
        what: "the same, by the way within the shape",
        settings: &[r#"bodies.bar.frames.weights="geodesic""#],
        ..LED
    },
    Case {
        id: "frames_energy_order",
        capabilities: &["BOS-2", "BOS-6"],
        what: "order at which the energy drifts by Runge and Kutta's steps: forces that are not its gradient would leave a rest",
        scene: "frames_spinning",
        settings: &[r#"systems.main.stepper="rk4""#, "run.duration=0.4"],
        reading: Reading::last("energy"),
        refinement: Some(Refinement {
            size_of: "step [s]",
            runs: &[
                Variant { size: 1e-3, settings: &[r#"world.period="1 ms""#] },
                Variant { size: 5e-4, settings: &[r#"world.period="0.5 ms""#] },
            ],
            limit: Limit::Known(SPINNING_ENERGY),
        }),
        // of each vibration a step loses (ωh)⁶/72; the next term is of the seventh order, and ωh about 0.2
        reference: 5.0,
        tolerance: Tolerance::Absolute(0.5),
        source: "Hairer, Nørsett & Wanner 1993, II",
        // a force without an energy
        mutation: "bodies.bar.damping={ rayleigh_mass = 1e-3 }",
    },
    Case {
        id: "frames_ligament_of_five",
        what: "corner of the led end of a ligament of five frames on a line after half a turn",
        settings: &[FIVE_FRAMES],
        ..LIGAMENT
    },
    Case {
        id: "frames_line_held",
        what: "half the weight of the same, held at both ends",
        settings: &[FIVE_FRAMES, UNTURNED, "bodies.ligament.pins[1].motion.offsets[1]=[0, 0, 0]"],
        reading: Reading::component("pull", 1),
        // 1100 kg/m³ of 10 cm³, 9.81 m/s², by symmetry
        reference: 0.053_955,
        tolerance: Tolerance::Relative(1e-5),
        source: "equilibrium, at the tolerance of Newton's method and the end of the swing",
        mutation: "bodies.ligament.material.density=1101",
        ..FIVE
    },
    Case {
        id: "frames_line_stretched",
        what: "middle of the same, drawn out by a tenth",
        reading: Reading::component("middle", 0),
        reference: 0.005,
        tolerance: Tolerance::Relative(1e-5),
        source: "symmetry: the middle goes half of the way",
        mutation: r#"bodies.ligament.pins[1].motion.offsets[1]=["10.1 mm", 0, 0]"#,
        ..FIVE
    },
    Case {
        id: "frames_line_bent",
        what: "side of its middle, bent by a quarter turn without weight: on the arc of a circle",
        settings: &[
            FIVE_FRAMES,
            "world.gravity=[0, 0, 0]",
            r#"bodies.ligament.pins[1].rotation.offsets[2]=[0, 0, "90 deg"]"#,
            // to the end of an arc of a length of 0.1 m, R = 0.2/π m: R (1, 1) - (0.1, 0)
            "bodies.ligament.pins[1].motion={ times = [0, 0.5, 1.5], offsets = [[0, 0, 0], [0, 0, 0], [-0.036338, 0.063662, 0]] }",
        ],
        reading: Reading::component("middle", 1),
        // R (1 - cos 45°) + 5 mm (cos 45° - 1)
        reference: 0.017_181_7,
        // between two of five frames a strip may leave the arc by its sagitta, R (1 - cos(π/16))
        tolerance: Tolerance::Absolute(1.2e-3),
        source: "a strip that bending neither stretches nor shortens",
        mutation: "bodies.ligament.pins[1].motion.offsets[2]=[-0.036338, 0.055, 0]",
        ..LIGAMENT
    },
    Case {
        id: "frames_line_condition",
        what: "least condition of what moving least squares would invert over five frames on a line",
        scene: "ligament",
        settings: &[FIVE_FRAMES],
        reading: Reading::MomentCondition("ligament"),
        mutation: r#"bodies.ligament.frames.placement={ name = "grid", counts = [5, 2, 2] }"#,
        ..CONDITION
    },
    Case {
        id: "frames_plane_condition",
        what: "the same over the twelve frames of a membrane",
        scene: "membrane",
        mutation: r#"bodies.sheet.frames.placement={ name = "farthest_point", count = 24 }"#,
        ..CONDITION
    },
    Case {
        id: "frames_membrane_stretched",
        what: "middle of a membrane of twelve frames in a plane, drawn out by a tenth and twisted by a quarter turn",
        reading: Reading::component("centre", 0),
        mutation: r#"parameters.stretch="1.8 cm""#,
        ..MEMBRANE
    },
    Case {
        id: "frames_membrane_twisted",
        what: "side of its middle, twisted by a quarter turn without stretch",
        settings: &[r#"parameters.stretch="0 cm""#],
        reading: Reading::component("middle", 1),
        // 0.05 m sin 45°
        reference: -0.035_355_339_059_327_38,
        // its sides draw it in: by what the length of the led edge's helix is over its middle, (0.05·π/2)²/(2·0.2²), a twelfth
        tolerance: Tolerance::Relative(0.04),
        mutation: r#"parameters.twist="80 deg""#,
        ..MEMBRANE
    },
    Case {
        id: "frames_membrane_bent",
        what: "middle of the same, bent by a quarter turn: on the arc of a circle",
        settings: &[
            r#"parameters.stretch="0 cm""#,
            r#"parameters.twist="0 deg""#,
            r#"parameters.bend="90 deg""#,
        ],
        reading: Reading::component("centre", 1),
        // 0.2 m/(π/2) (1 - cos 45°)
        reference: 0.037_292_322_857_805_656,
        // the arc of the middle, with its thickness over its radius squared and the sides that it turns up
        tolerance: Tolerance::Relative(0.03),
        source: "a strip that bending neither stretches nor shortens",
        mutation: r#"parameters.bend="60 deg""#,
        ..MEMBRANE
    },
    Case {
        id: "frames_in_real_time",
        capabilities: &["BOS-7"],
        what: "a step of 52 rigid frames and 1,024 points, neo-Hookean, one solve, one thread, in less than a sixtieth of a second",
        settings: &[
            "bodies.bar.mesh.cells=[32, 2, 2]",
            "bodies.bar.frames.placement.counts=[13, 2, 2]",
            r#"bodies.bar.frames.kind="rigid""#,
            r#"bodies.bar.material.name="neo_hookean""#,
            r#"systems.main.stepper={ name = "backward_euler", newton = "one" }"#,
            "run.duration=1",
        ],
        reading: Reading::StepMilliseconds,
        reference: 1000.0 / 60.0,
        tolerance: Tolerance::AtMost,
        source: "60 steps a second; a figure of the machine, of which it takes a tenth",
        mutation: "bodies.bar.mesh.cells=[200, 12, 12]",
        ..BAR
    },
    Case {
        id: "frames_tissues_follow",
        what: "how far an organ follows another through a pad, a ligament and a sheet, with nothing else that holds it",
        settings: &["bodies.lower.springs=[]", "world.gravity=[0, 0, 0]", "run.duration=3"],
        reading: Reading::component("lower", 1),
        reference: 0.02,
        tolerance: Tolerance::Relative(1e-3),
        source: "what is free goes all of the way: what is left of the swing after three seconds is the tolerance",
        mutation: r#"bodies.upper.pins[0].motion.offsets[1]=[0, "1.9 cm", 0]"#,
        ..TISSUES
    },
    Case {
        id: "frames_tissues_carry",
        what: "what holds an organ from which another hangs by a pad, a ligament and a sheet: the weight of all five",
        settings: &["bodies.lower.springs=[]", "run.duration=3"],
        reading: Reading::component("pull", 1),
        // 0.4 + 0.4 kg, a pad of (0.1/3)² 0.02 m³ of 920 kg/m³, 6 by 6 by 20 mm of 1100, 2 by 100 by 20 mm of 1050; 9.81 m/s²
        reference: 8.097_531_52,
        tolerance: Tolerance::Relative(1e-3),
        source: "equilibrium: what is left of the swing after three seconds is the tolerance",
        mutation: r#"bodies.pad.mesh.from_region={ box = [[0.01, 0.039, 0.03], [0.07, 0.041, 0.07]] }"#,
        ..TISSUES
    },
    Case {
        id: "frames_tissues_slip",
        what: "how far the ends of a pad slip on two organs, of which one is drawn away by 20 micrometres",
        scene: "tissue_layers",
        reading: Reading::last("slip"),
        // 20 µm over compliances in line, 2 · 0.04/10e3 + 0.02/3e3 + 2/k m³/N, over k = E/(0.02/5000), E = 2/(1/10e3 + 1/3e3)
        reference: 1.181_678_528_901_130_1e-9,
        // what is subtracted stands at 0.1 m, of which 2e-17 m is rounding
        tolerance: Tolerance::Relative(1e-6),
        source: "springs in line: stress over the stiffness of a layer",
        mutation: r#"bodies.pad.material.youngs_modulus="2.9 kPa""#,
        ..TISSUES
    },
    Case {
        id: "frames_tissue_fibres",
        what: "what draws at a pad whose fibres run from end to end, twice as stiff as its matter",
        scene: "tissue_layers",
        settings: &[FIBRES],
        reading: Reading::component("pull", 1),
        // as of the slip, with 9 kPa in the pad; of the layers, by the mean modulus, a thousandth of what is left out here counts
        reference: 0.01 * 2e-5 / (0.08 / 10e3 + 0.02 / 9e3),
        tolerance: Tolerance::Relative(1e-3),
        source: "springs in line",
        mutation: "bodies.pad.material.parameters.a=[0, 1, 0]",
        ..TISSUES
    },
    Case {
        id: "frames_bone_force",
        capabilities: &["BOS-8"],
        what: "the greatest force of a bone that swings a bar across",
        scene: "frames_led",
        reading: Reading::component("force", 1).taking(Statistic::Max),
        // 5 kg · 0.2 m (2π/s)²
        reference: 39.478_417_604_357_43,
        // accelerations are means over a step: (2π 0.01)²/24
        tolerance: Tolerance::Relative(1.7e-4),
        source: "mass times acceleration",
        mutation: "bodies.bar.material.density=999",
        ..LED
    },
    Case {
        id: "frames_bone_torque",
        capabilities: &["BOS-8"],
        what: "the torque of a bone that turns a bar about an axis at a slant",
        scene: "frames_led",
        settings: &[
            r#"bones.hand.motion={ formula = "[0, 0, 0]" }"#,
            r#"world.period="1 ms""#,
            r#"run.duration="0.1 s""#,
        ],
        reading: Reading::last("torque"),
        // ω × I ω with ω = (4π, π, 0)/s: 4π² · 5 kg (0.5² - 0.1²) m²/12
        reference: 3.947_841_760_435_743,
        // accelerations of origins are means over a step, (13 · 0.001)²/24 short, and these have a tenth more of the moment than the whole
        tolerance: Tolerance::Relative(1e-5),
        source: "Euler's equations: the torque turns with the bar, and is as long at any time",
        mutation: r#"bones.hand.rotation={ formula = "[4*pi*t, 1.001*pi*t, 0]" }"#,
        ..LED
    },
    Case {
        id: "fibres_around_tube",
        capabilities: &["DEB-55"],
        what: "how far the middle of a tube's wall goes out that has fibres of four times its own modulus around it",
        scene: "fibre_tube",
        reading: Reading::last("widening"),
        reference: 9.469_381_896_415_232e-6,
        // axes are those of the middle of a cell, 1.9 degrees from its ends: 4 mean(sin²) = 1.4e-3 of the fibres
        tolerance: Tolerance::Relative(2e-3),
        source: "u'' + u'/r - 5 u/r² = 0 with the pressure inside",
        mutation: "bodies.tube.material_axes.x=[0, 0, 1]",
        ..TISSUES
    },
    Case {
        id: "frames_fork_bent",
        capabilities: &["BOS-8"],
        what: "how far one prong of a fork moves over how far the other one is bent, ten frames, by the way within the shape",
        scene: "fork",
        reading: Reading::Ratio { of: "other", to: "bent", component: 2 },
        reference: 0.345_886_186_398_851_77,
        // frames 0.1 m apart know the slit's end to half of that: of two beams of 0.25 m on one of 0.15 m a third of the ratio
        tolerance: Tolerance::Relative(0.3),
        source: "the fork's own 18,603 tetrahedra in place of frames",
        mutation: r#"bodies.fork.frames.weights={ name = "wendland", support = 2 }"#,
        ..BAR
    },
    Case {
        id: "frames_bar_geodesic",
        capabilities: &["BOS-4", "BOS-8"],
        what: "tip of the clamped bar, 44 affine frames, weights by the way within the shape",
        settings: &[r#"bodies.bar.frames.weights={ name = "geodesic", support = 2 }"#],
        ..BAR
    },
    Case {
        id: "frames_bar_placed",
        capabilities: &["BOS-4", "BOS-8"],
        what: "tip of the clamped bar, 100 affine frames by Lloyd's placement, 640 points in voxels",
        settings: &[
            r#"bodies.bar.frames.placement={ name = "lloyd", count = 100 }"#,
            r#"bodies.bar.frames.points={ name = "voxels", size = "2.5 cm" }"#,
        ],
        ..BAR
    },
    Case {
        id: "frames_bar_spread",
        capabilities: &["BOS-4", "BOS-8"],
        what: "the same, 60 frames as far apart as they can be",
        settings: &[
            r#"bodies.bar.frames.placement={ name = "farthest_point", count = 60 }"#,
            r#"bodies.bar.frames.points={ name = "voxels", size = "2.5 cm" }"#,
        ],
        ..BAR
    },
    Case {
        id: "frames_straps_pull",
        what: "what two straps on the sides of a joint are drawn with by the bone that leads its upper part up",
        // E A d/L of both, 2 · 1 MPa · 15 mm · 2 mm · 1.5 mm over the 30 mm between the regions: their ends give way, too
        reference: 3.0,
        tolerance: Tolerance::AtMost,
        source: "bars in tension, a bound from above; the law softens",
        mutation: r#"bodies.left.material.youngs_modulus="1.3 MPa""#,
        ..STRAPS
    },
    Case {
        id: "frames_straps_hold",
        what: "the same from below",
        // over 38 mm, two thicknesses more at each end, beyond which nothing of it is felt, and a twentieth less at a strain of a twentieth
        reference: 2.25,
        tolerance: Tolerance::AtLeast,
        source: "bars in tension; St. Venant's principle",
        mutation: r#"bodies.left.material.youngs_modulus="0.3 MPa""#,
        ..STRAPS
    },
    Case {
        id: "frames_tissue_gains_nothing",
        capabilities: &["BOS-9", "BOS-6"],
        what: "the greatest energy of two tied organs of which one is thrown, over what they begin with",
        scene: "tied_organs",
        settings: &[
            "bodies.upper.pins=[]",
            "bodies.upper.velocity=[0.1, 0, 0]",
            "world.gravity=[0, 0, 0]",
            "run.duration=1",
        ],
        reading: Reading::last("energy").taking(Statistic::Max),
        // 0.4 kg at 0.1 m/s
        reference: 0.002,
        tolerance: Tolerance::Relative(1e-9),
        source: "backward Euler takes energy and makes none",
        mutation: r#"systems.main.stepper="explicit_euler""#,
        ..BAR
    },
    Case {
        id: "frames_fascia_torn",
        capabilities: &["BOS-9"],
        what: "springs by which a sheet had grown to a bump, all torn when it is drawn off; none are where nobody draws",
        scene: "fascia_torn",
        reading: Reading::last("torn"),
        // eleven by seven points over the bump
        reference: 77.0,
        tolerance: Tolerance::Absolute(0.5),
        source: "points of its underside that lie on the bump",
        mutation: "bodies.sheet.pins[0].motion.offsets[2]=[0, 0, 0]",
        ..BAR
    },
];
