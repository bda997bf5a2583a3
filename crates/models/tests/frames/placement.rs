//! Where frames are placed, weights that know slits and stiffness, and what bodies of frames cannot be.

use souple_math::{Mat3, Vec3};
use souple_mesh::Mesh;
use souple_models::frames::{self, Carried, Frame, PLACEMENTS, POINTS, Sample, Shape, WEIGHTS};
use souple_table::{Value, Values};

use super::{SIZE, bar, weights_of};

/// A plate of 1 m by 0.4 m, slit along its middle from x = 0.5 to its end: two arms that meet at their root only.
fn slit_plate() -> Mesh {
    let whole = bar([1.0, 0.4, 0.1], [16.0, 8.0, 1.0], "hex8");
    let mut mesh = whole.clone();
    let mut twins = std::collections::BTreeMap::new();
    for (point, x) in whole.points.iter().enumerate() {
        if (x.y - 0.2).abs() < 1e-9 && x.x > 0.51 {
            twins.insert(point as u32, mesh.points.len() as u32);
            mesh.points.push(*x);
        }
    }
    let centres = whole.cell_centres();
    for (cell, nodes) in mesh.blocks[0].nodes.chunks_mut(8).enumerate() {
        if centres[cell].y > 0.2 {
            nodes.iter_mut().for_each(|node| *node = *twins.get(node).unwrap_or(node));
        }
    }
    mesh
}

fn frame_of_plate(x: f64, y: f64) -> Frame {
    Frame { origin: Vec3::new(x, y, 0.05), axes: Mat3::IDENTITY }
}

/// The sum of the weights of some frames at a point of a mesh of one material.
fn share(mesh: &Mesh, frames: &[Frame], weights: &str, of: &[u32], point: Vec3) -> f64 {
    let stiffness = vec![1.0; mesh.cell_count()];
    let shape = Shape { frames, mesh, stiffness_of_cell: &stiffness };
    let shares = weights_of(weights, &shape).shares(point);
    shares.iter().filter(|share| of.contains(&share.frame)).map(|share| share.weight).sum()
}

/// Harmonic weights do not cross a slit: two arms that meet at their root only, closer to each other than frames reach.
#[test]
fn harmonic_weights_keep_the_sides_of_a_slit_apart() {
    let mesh = slit_plate();
    let frames = [frame_of_plate(0.1, 0.2), frame_of_plate(0.9, 0.1), frame_of_plate(0.9, 0.3)];
    let share = |name: &str| share(&mesh, &frames, name, &[2], Vec3::new(0.85, 0.17, 0.05));
    // by way of the root: the arm is three times as long as it is wide
    assert!(share("harmonic") < 0.05, "{}", share("harmonic"));
    // 0.78 round the end of the slit, of supports of twice the 0.81 to the frame of the root: φ of 0.05, 0.48 and 0.47 are 0.98, 0.21
    // and 0.23
    assert!((share("geodesic") - 0.15).abs() < 0.01, "{}", share("geodesic"));
    // straight across: φ of 0.22, 0.35 and 0.47 are 0.71, 0.43 and 0.23
    assert!((share("wendland") - 0.31).abs() < 0.01, "{}", share("wendland"));
}

/// Frames close to a slit say as good as nothing on its other side, by ways within the shape; by distances in space those of the
/// other side have as much to say as those of the own one.
#[test]
fn geodesic_weights_part_the_sides_of_a_slit() {
    let mesh = slit_plate();
    let frames = [(0.1, 0.2), (0.6, 0.15), (0.6, 0.25), (0.9, 0.15), (0.9, 0.25)];
    let frames = frames.map(|(x, y)| frame_of_plate(x, y));
    for (y, others) in [(0.19, [2, 4]), (0.21, [1, 3])] {
        let share = |name: &str| share(&mesh, &frames, name, &others, Vec3::new(0.87, y, 0.05));
        assert!(share("wendland") > 0.3, "{}", share("wendland"));
        assert!(share("geodesic") < 0.5 * share("wendland"), "{} {}", share("geodesic"), share("wendland"));
        assert!(share("harmonic") < 0.1, "{}", share("harmonic"));
    }
}

/// Cores of harmonic weights and the points nearest to frames are of the side of a slit that the frame is on, though those of the other
/// side are as near, or nearer.
#[test]
fn nothing_is_owned_across_a_slit() {
    let mesh = slit_plate();
    let stiffness = vec![1.0; mesh.cell_count()];
    let share = |frames: &[Frame], core: f64, frame: u32, point: Vec3| {
        let shape = Shape { frames, mesh: &mesh, stiffness_of_cell: &stiffness };
        let entry = WEIGHTS.find("harmonic").unwrap();
        let values = entry.values(Values::new().with("core", Value::Number(core))).unwrap();
        let shares = (entry.build)(&values, &shape).unwrap().shares(point);
        shares.iter().find(|share| share.frame == frame).map_or(0.0, |share| share.weight)
    };
    // without a core the nearest point alone: at x = 0.875 on the slit, one of two at the same place
    for (y, other_side) in [(0.199, 0.201), (0.201, 0.199)] {
        let frames = [frame_of_plate(0.1, 0.2), frame_of_plate(0.874, y)];
        let across = share(&frames, 0.0, 1, Vec3::new(0.875, other_side, 0.0));
        let own = share(&frames, 0.0, 1, Vec3::new(0.875, y, 0.0));
        assert!(own > 0.95 && across < 0.7 * own, "{own} and {across}");
    }
    // a core of 0.45 of the 0.35 to the next frame reaches over the other arm
    let frames = [frame_of_plate(0.1, 0.2), frame_of_plate(0.55, 0.3), frame_of_plate(0.9, 0.19)];
    let across = share(&frames, 0.45, 2, Vec3::new(0.9, 0.26, 0.05));
    assert!(share(&frames, 0.45, 2, Vec3::new(0.9, 0.14, 0.05)) > 0.999 && across < 0.5, "{across}");
}

/// In a convex body of one material the way within is the straight one: `geodesic` weights are Wendland's, and their
/// gradients; the derivative of the weights is their gradient where ways bend, too.
#[test]
fn geodesic_weights_are_those_of_space_where_nothing_is_in_the_way() {
    let mesh = bar(SIZE, [12.0, 3.0, 3.0], "tet4");
    let frame = |x: f64, y: f64| Frame { origin: Vec3::new(x, y, 0.07), axes: Mat3::IDENTITY };
    let frames = [frame(0.0, 0.0), frame(0.33, 0.12), frame(0.7, 0.05), frame(1.0, 0.2)];
    let even = vec![1.0; mesh.cell_count()];
    let stiff: Vec<f64> =
        mesh.cell_centres().iter().map(|centre| if centre.x > 0.5 { 30.0 } else { 1.0 }).collect();
    let shape = Shape { frames: &frames, mesh: &mesh, stiffness_of_cell: &even };
    let (space, within) = (weights_of("wendland", &shape), weights_of("geodesic", &shape));
    // the first would lie on a border of cells and of materials, where slopes jump
    let points: Vec<Vec3> = (1..60)
        .map(|i| {
            let part = |k: usize| (0.5 + f64::from(i) * [0.618_034, 0.754_878, 0.569_840][k]).fract();
            Vec3::new(part(0) * SIZE[0], part(1) * SIZE[1], part(2) * SIZE[2])
        })
        .collect();
    for point in &points {
        let (a, b) = (space.shares(*point), within.shares(*point));
        assert_eq!(a.len(), b.len(), "{point:?}");
        for (a, b) in a.iter().zip(&b) {
            // slopes of shape functions of cells of a twelfth, times the rounding of distances
            assert!((a.weight - b.weight).abs() < 1e-12 && (a.gradient - b.gradient).length() < 1e-10);
        }
    }
    let shape = Shape { stiffness_of_cell: &stiff, ..shape };
    let bent = weights_of("geodesic", &shape);
    for point in &points {
        let step = 1e-6;
        let of = |point: Vec3, frame: u32| {
            bent.shares(point).iter().find(|share| share.frame == frame).map_or(0.0, |share| share.weight)
        };
        for share in bent.shares(*point) {
            for axis in 0..3 {
                let ahead = *point + Vec3::AXES[axis] * step;
                let behind = *point - Vec3::AXES[axis] * step;
                let slope = (of(ahead, share.frame) - of(behind, share.frame)) / (2.0 * step);
                // the error of the difference, of the square of the step over that of a cell, and rounding over the step
                assert!((slope - share.gradient[axis]).abs() < 1e-4 * (1.0 + slope.abs()), "{point:?}");
            }
        }
    }
}

/// A stiff inclusion moves as one: harmonic and geodesic weights are nearly constant in it, and not without its stiffness.
#[test]
fn harmonic_weights_are_flat_where_matter_is_stiff() {
    let mesh = bar([1.0, 0.1, 0.1], [40.0, 2.0, 2.0], "hex8");
    let frames = [0.0, 1.0].map(|x| Frame { origin: Vec3::new(x, 0.05, 0.05), axes: Mat3::IDENTITY });
    let range = |name: &str, contrast: f64| {
        let stiff = |centre: &Vec3| if (0.3..0.7).contains(&centre.x) { contrast } else { 1.0 };
        let stiffness: Vec<f64> = mesh.cell_centres().iter().map(stiff).collect();
        let shape = Shape { frames: &frames, mesh: &mesh, stiffness_of_cell: &stiffness };
        let weights = weights_of(name, &shape);
        let at = |x: f64| weights.shares(Vec3::new(x, 0.05, 0.05))[0].weight;
        at(0.32) - at(0.68)
    };
    // between cores of 0.2: resistances 0.2 / (0.6 - 0.4 + 0.4 / contrast) of the whole, 0.36/0.6 and about 0.0036/0.2036
    assert!(range("harmonic", 1.0) > 0.5 && range("harmonic", 100.0) < 0.03);
    // (1-u)⁴ (4u+1) over twice the distance of the frames: at 0.16 and 0.34 of it, 0.646 and 0.354; with the inclusion both points
    // are as far from both frames, to a hundredth
    assert!((range("geodesic", 1.0) - 0.2916).abs() < 1e-3 && range("geodesic", 100.0) < 0.03);
}

/// Placements give what they are asked for: as many frames, inside or near the matter, all apart; Lloyd's by compliance
/// puts more of them where matter is soft.
#[test]
fn placements_spread() {
    let mesh = bar(SIZE, [20.0, 4.0, 4.0], "tet4");
    let entry = POINTS.find("cells").unwrap();
    let samples = (entry.build)(&entry.values(Values::new()).unwrap(), &mesh, &vec![0; mesh.cell_count()]);
    let stiffness: Vec<f64> =
        samples.iter().map(|sample| if sample.position.x > 0.5 { 100.0 } else { 1.0 }).collect();
    let matter = frames::Matter { samples: &samples, stiffness: &stiffness, bounds: mesh.bounds() };
    let place = |name: &str, by: &'static str| {
        let entry = PLACEMENTS.find(name).unwrap();
        let mut values = Values::new().with("count", Value::Integer(12));
        if !by.is_empty() {
            values.set("by", Value::Text(by));
        }
        (entry.build)(&entry.values(values).unwrap(), &matter).unwrap()
    };
    for (name, by) in [("farthest_point", ""), ("lloyd", "volume")] {
        let frames = place(name, by);
        assert_eq!(frames.len(), 12);
        let unit = vec![1.0; mesh.cell_count()];
        let shape = Shape { frames: &frames, mesh: &mesh, stiffness_of_cell: &unit };
        // twelve in a bar of 0.04 m³ have some 0.1 m each
        assert!(frames::spacings(&shape).iter().all(|spacing| *spacing > 0.05), "{name}");
    }
    // those that are kept come first and stand still, and count
    let kept = [0.5, 0.1, 0.1, 0.51, 0.1, 0.1];
    for name in ["farthest_point", "lloyd"] {
        let entry = PLACEMENTS.find(name).unwrap();
        let values = Values::new().with("count", Value::Integer(12)).with("kept", Value::Numbers(&kept));
        let frames = (entry.build)(&entry.values(values).unwrap(), &matter).unwrap();
        assert_eq!(frames.len(), 12);
        assert_eq!(frames[1].origin, Vec3::new(0.51, 0.1, 0.1));
    }
    // more that are kept than there shall be, and more work than can be waited for
    let refused = |name: &str, values: Values, matter: &frames::Matter| {
        let entry = PLACEMENTS.find(name).unwrap();
        (entry.build)(&entry.values(values).unwrap(), matter).unwrap_err().to_string()
    };
    for name in ["farthest_point", "lloyd"] {
        let values = Values::new().with("count", Value::Integer(1)).with("kept", Value::Numbers(&kept));
        let error = refused(name, values, &matter);
        assert!(error.contains("`kept` lists 2 frames") && error.contains("`count` is 1"), "{error}");
    }
    let error = refused("grid", Values::new().with("counts", Value::Vector([1000.0; 3])), &matter);
    assert!(error.contains("1000000000 places; at most 1000000"), "{error}");
    let many = vec![samples[0]; 4000];
    let matter_of_many = frames::Matter { samples: &many, ..matter };
    let values = Values::new().with("count", Value::Integer(4000)).with("iterations", Value::Integer(1000));
    let error = refused("lloyd", values, &matter_of_many);
    assert!(error.contains("are 1.6e10 distances, and at most 1e10"), "{error}");
    let soft = place("lloyd", "compliance").iter().filter(|frame| frame.origin.x < 0.5).count();
    assert!(soft >= 8, "{soft} of 12 in the soft half");
}

/// Bodies of frames that cannot be say so, with what to change.
#[test]
fn faults_are_said_in_words() {
    let mesh = bar(SIZE, [8.0, 1.0, 1.0], "tet4");
    let unit = vec![1.0; mesh.cell_count()];
    let frame = |x: f64| Frame { origin: Vec3::new(x, 0.1, 0.1), axes: Mat3::IDENTITY };
    let said = |frames: &[Frame]| {
        let shape = Shape { frames, mesh: &mesh, stiffness_of_cell: &unit };
        if let Err(error) = frames::check_apart(&shape) {
            return error.to_string();
        }
        let weights = weights_of("wendland", &shape);
        match frames::check_reach(&shape, weights.as_ref(), mesh.points.iter().copied()) {
            Err(error) => error.to_string(),
            Ok(()) => String::new(),
        }
    };
    assert!(said(&[]).contains("there are no frames"));
    assert!(said(&[frame(0.2), frame(0.2)]).contains("frames 0 and 1 are on top of each other"));
    assert!(said(&[frame(0.0), frame(0.1)]).contains("a `support` above"));
    let shape = Shape { frames: &[frame(0.5), frame(0.51)], mesh: &mesh, stiffness_of_cell: &unit };
    let entry = WEIGHTS.find("harmonic").unwrap();
    let error = (entry.build)(&entry.values(Values::new()).unwrap(), &shape).err().unwrap().to_string();
    assert!(error.contains("finer mesh"), "{error}");
    // one sample of all the body: nothing resists a turn
    let frames = [frame(0.5)];
    let sample = Sample { position: Vec3::new(0.5, 0.1, 0.1), volume: 0.04, cell: 0 };
    let shares = [frames::Share { frame: 0, weight: 1.0, gradient: Vec3::ZERO }];
    let carried = [Carried::new(&frames, &shares, sample.position)];
    let error = frames::check_inertia(&frames, &[sample], &carried, false).unwrap_err().to_string();
    assert!(error.contains("lies on a point"), "{error}");
    // points that no way reaches far enough for: how far the way is, of what reach
    let unit = vec![1.0; mesh.cell_count()];
    let said = |name: &str, mesh: &Mesh, stiffness: &[f64], frames: &[Frame]| {
        let shape = Shape { frames, mesh, stiffness_of_cell: stiffness };
        let entry = WEIGHTS.find(name).unwrap();
        let reach = (entry.build)(&entry.values(Values::new()).unwrap(), &shape)
            .and_then(|weights| frames::check_reach(&shape, weights.as_ref(), mesh.points.iter().copied()));
        reach.map_or_else(|error| error.to_string(), |()| String::new())
    };
    let error = said("geodesic", &mesh, &unit, &[frame(0.0), frame(0.1)]);
    assert!(error.contains("by ways within the shape") && error.contains("frame, 1, is"), "{error}");
    assert!(error.contains("reaches 2.000e-1 m; place frames there, or take a `support` above"), "{error}");
    assert_eq!(said("inverse_distance", &mesh, &unit, &[frame(0.0), frame(0.1)]), "");
    // by ways within the shape, and solved on its cells: all of these ask for a mesh that carries frames
    let mut parts = mesh.clone();
    let other: Vec<Vec3> = mesh.points.iter().map(|point| *point + Vec3::X * 2.0).collect();
    parts.points.extend(other);
    let nodes: Vec<u32> = mesh.blocks[0].nodes.iter().map(|node| node + mesh.points.len() as u32).collect();
    parts.blocks[0].nodes.extend(nodes);
    let mut soft = unit.clone();
    soft[3] = 0.0;
    let nowhere = Frame { origin: Vec3::new(f64::NAN, 0.0, 0.0), axes: Mat3::IDENTITY };
    for name in ["geodesic", "harmonic"] {
        let two = [frame(0.2), frame(0.8)];
        let error = said(name, &parts, &[&unit[..], &unit].concat(), &two);
        assert!(error.contains("no frame is in the part of the mesh with a cell at (2."), "{name}: {error}");
        let error = said(name, &mesh, &soft, &two);
        assert!(error.contains("cell 3 has a Young's modulus of 0 Pa"), "{name}: {error}");
        let error = said(name, &mesh, &unit, &[frame(0.2), nowhere]);
        assert!(error.contains("no cell of the mesh carries frame 1"), "{name}: {error}");
    }
    // a cell pressed flat
    let mut flat = mesh.clone();
    let middle = flat.points[flat.blocks[0].nodes[0] as usize];
    let [first, .., last] = [0, 1, 2, 3].map(|k: usize| mesh.blocks[0].nodes[k] as usize);
    flat.points[last] = middle + (flat.points[mesh.blocks[0].nodes[1] as usize] - flat.points[first]) * 0.5;
    let error = said("harmonic", &flat, &unit, &[frame(0.6), frame(0.9)]);
    assert!(error.contains("cell 0 of the mesh is flat"), "{error}");
}
