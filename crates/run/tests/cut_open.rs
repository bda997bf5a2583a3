//! What is cut through is drawn and written open: the surface is that of the cells which are left.

use std::collections::BTreeMap;
use std::path::Path;

use souple_mesh::{Mesh, TriangleSurface};
use souple_run::show::Moment;
use souple_run::{Options, Session};

/// A bar of two meshes at rest. The upper half of a section goes after 20 ms, the lower half after 40 ms.
const BAR: &str = r#"
format = 1
[world]
period = "10 ms"
[systems.main]
stepper = { name = "staggered", halvings = 6 }
[bodies.bar]
mesh = { generate = "bar", size = [0.08, 0.02, 0.02], cells = [8, 2, 2], element = "tet4" }
material = { name = "linear", youngs_modulus = "20 kPa", poissons_ratio = 0.3, density = 1000 }
[bodies.bar.levels]
coarser = [{ mesh = { generate = "bar", size = [0.08, 0.02, 0.02], cells = [4, 1, 1], element = "tet4" } }]
cuts = [
    { region = { box = [[0.04, 0, 0.01], [0.05, 0.02, 0.02]] }, time = 0.02 },
    { region = { box = [[0.04, 0, 0], [0.05, 0.02, 0.01]] }, time = 0.04 },
]
[[bodies.bar.pins]]
region = "x_min"
"#;

/// Parts that hang together by triangles, and whether every edge is between two of them, run through once each way.
fn parts(surface: &TriangleSurface) -> (usize, bool) {
    let mut edges = BTreeMap::new();
    let mut part: Vec<usize> = (0..surface.points.len()).collect();
    for [a, b, c] in &surface.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((*from, *to)).or_insert(0) += 1;
            let (one, other) = (part[*from as usize], part[*to as usize]);
            part.iter_mut().filter(|of| **of == one).for_each(|of| *of = other);
        }
    }
    let is_closed =
        edges.iter().all(|((from, to), count)| *count == 1 && edges.get(&(*to, *from)) == Some(&1));
    part.sort_unstable();
    part.dedup();
    (part.len(), is_closed)
}

/// [m³]
fn volume(surface: &TriangleSurface) -> f64 {
    let tet = |[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| surface.points[*corner as usize]);
        a.dot(b.cross(c)) / 6.0
    };
    surface.triangles.iter().map(tet).sum()
}

/// The surface that is drawn is closed and in one part, with the notch once half of a section is cut, and in two once all of it is;
/// the whole mesh stays what it was.
#[test]
fn surfaces_open_where_cells_are_cut() {
    let scene = souple_scene::read_text("bar.toml", BAR, Path::new("."), &[]).unwrap();
    let mut session = Session::start(scene, &Options::default()).unwrap();
    let whole = 0.08 * 0.02 * 0.02;
    let section = 0.01 * 0.02 * 0.02;
    let drawn = |session: &Session| -> (Mesh, TriangleSurface) {
        let body = Moment::of_session(session).bodies.swap_remove(0);
        for field in &body.cell_fields {
            assert_eq!(field.values.len(), field.components * body.mesh.cell_count(), "{}", field.name);
        }
        let surface = body.mesh.boundary_surface();
        ((*body.mesh).clone(), surface)
    };
    let cells = session.bodies[0].mesh.cell_count();
    for (steps, left, count) in [(1, whole, 1), (1, whole - 0.5 * section, 1), (2, whole - section, 2)] {
        (0..steps).for_each(|_| session.world.step().unwrap());
        let (mesh, surface) = drawn(&session);
        assert_eq!(parts(&surface), (count, true), "{} s", session.world.time());
        assert!((volume(&surface) - left).abs() < 1e-12 * whole, "{} m³ for {left}", volume(&surface));
        assert_eq!(mesh.cell_count() as f64, cells as f64 * left / whole);
        assert_eq!(mesh.points.len(), session.bodies[0].mesh.points.len());
    }
}

/// Points that no cell has any more, which fall without end, are in no picture and no frame; nor is a body blown up whose points or parts fall far.
#[test]
fn what_falls_out_is_not_shown() {
    let text = BAR
        .replace("[world]", "[world]\ngravity = [0, 0, -9.81]")
        .replace("box = [[0.04, 0, 0.01], [0.05, 0.02, 0.02]]", "box = [[0.02, -1, -1], [0.06, 1, 1]]");
    let scene = souple_scene::read_text("bar.toml", &text, Path::new("."), &[]).unwrap();
    let mut session = Session::start(scene, &Options::default()).unwrap();
    let count = session.bodies[0].mesh.points.len();
    (0..3).for_each(|_| session.world.step().unwrap());
    let body = Moment::of_session(&session).bodies.swap_remove(0);
    // three of nine sections of nine points are of no cell any more
    assert_eq!(body.mesh.points.len(), count * 6 / 9);
    assert_eq!(body.positions.len(), body.mesh.points.len());
    for field in &body.point_fields {
        assert_eq!(field.values.len(), field.components * body.mesh.points.len(), "{}", field.name);
    }
    assert_eq!(parts(&body.mesh.boundary_surface()), (2, true));
    // 11 m in 1.5 s, of a bar of 8 cm
    (0..150).for_each(|_| session.world.step().unwrap());
    session.check_growth().unwrap();
}
