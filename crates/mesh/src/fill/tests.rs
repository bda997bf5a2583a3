//! Fillings keep their promises: angles, volume, conformity, on smooth shapes, thin ones and surfaces with faults.

use souple_table::{Value, Values};

use super::*;
use crate::TriangleSurface;
use crate::implicit::{self, Solid};

fn ball(radius: f64) -> Solid {
    Solid::sphere(Vec3::new(0.01, -0.02, 0.03), radius)
}

/// Waves in a ball: bubbles, bridges and walls of every thickness.
struct Noise;
impl Shape for Noise {
    fn value(&self, p: Vec3) -> f64 {
        let wave = |k: f64, a: f64| {
            libm::sin(k * p.x + a) * libm::sin(k * 1.1 * p.y + 2.0 * a) * libm::sin(k * 0.9 * p.z)
        };
        let out = p.length() - 2.2;
        out.max(wave(7.3, 0.4) + 0.8 * wave(11.9, 1.7) + 0.6 * wave(23.0, 0.1))
    }
    fn bounds(&self) -> crate::BoundingBox {
        crate::BoundingBox::of([Vec3::ZERO]).grown(2.3)
    }
}

fn angles(mesh: &Mesh) -> [f64; 2] {
    let quality = mesh.quality();
    let least = quality.iter().map(|cell| cell.smallest_dihedral).fold(f64::INFINITY, f64::min);
    let greatest = quality.iter().map(|cell| cell.largest_dihedral).fold(0.0, f64::max);
    [least, greatest].map(f64::to_degrees)
}

/// Conforming, nothing inverted, nothing overlapping: cells add up to what the boundary encloses.
fn assert_sound(mesh: &mut Mesh) {
    mesh.faces().conforming().unwrap();
    let repairs = mesh.validate().unwrap();
    assert!(repairs.rewound_cells.is_empty() && repairs.loose_points.is_empty());
    let boundary = mesh.boundary_surface();
    boundary.check_closed().unwrap();
    let (inside, enclosed) = (mesh.volume(), boundary.enclosed_volume());
    // rounding of a sum over all cells; quadrilaterals on the boundary are curved, and cut in two here
    let curved = if mesh.count_of(ElementKind::Hex8) > 0 { 1e-3 } else { 0.0 };
    let bound = f64::EPSILON * mesh.cell_count() as f64 + curved;
    assert!((inside - enclosed).abs() < bound * inside, "{inside} {enclosed}");
}

/// What does not fit into the memory is refused with both figures; where the system tells none, nothing is.
#[test]
fn what_does_not_fit_is_refused() {
    let refused = |available| Cells::Tetrahedra.check_memory(5e7, available);
    assert!(refused(None).is_ok() && refused(Some(1 << 40)).is_ok());
    let message = refused(Some(8_000_000_000)).unwrap_err().to_string();
    assert!(
        message.contains("about 5.0e7 cells take 11.0 GB of memory to make, and 8.0 GB are available"),
        "{message}"
    );
}

/// The proven bounds hold for many shapes that lie to the lattice in every way.
#[test]
fn angles_of_uniform_fillings() {
    let mut worst = [180.0_f64, 0.0];
    for shift in 0..12 {
        let t = f64::from(shift) * 0.083;
        let turn = Vec3::new(1.0 + t, 2.3 * t, -0.7);
        let long = Solid::turned_ellipsoid(Vec3::new(t, t * t, 0.3), Vec3::new(0.5 + t, 0.41, 0.3), turn);
        let ring = Solid::Torus {
            centre: Vec3::new(0.3 * t, 0.2, t),
            axis: turn.try_normalised().unwrap(),
            ring: 0.6,
            tube: 0.23 + 0.1 * t,
        };
        for shape in [long, ring] {
            let mut mesh = fill(&shape, &Size::uniform(0.17), Cells::Tetrahedra, &[]).unwrap();
            assert_sound(&mut mesh);
            let [least, greatest] = angles(&mesh);
            worst = [worst[0].min(least), worst[1].max(greatest)];
        }
    }
    assert!(worst[0] > 10.7 && worst[1] < 164.8, "{worst:?}");
}

/// Random signs: the surface cuts edges anywhere, which no smooth shape does.
#[test]
fn angles_of_wild_fillings() {
    let mut mesh = fill(&Noise, &Size::uniform(0.2), Cells::Tetrahedra, &[]).unwrap();
    assert_sound(&mut mesh);
    let [least, greatest] = angles(&mesh);
    assert!(least > 10.7 && greatest < 164.8, "{least} {greatest}");
}

/// Volume and surface of a ball converge with the square of the size.
#[test]
fn a_ball_converges() {
    let exact = 4.0 / 3.0 * std::f64::consts::PI;
    let error = |size: f64| {
        let mesh = fill(&ball(1.0), &Size::uniform(size), Cells::Tetrahedra, &[]).unwrap();
        (mesh.volume() / exact - 1.0).abs()
    };
    let (coarse, fine) = (error(0.3), error(0.15));
    let rate = (coarse / fine).log2();
    assert!((1.7..2.5).contains(&rate), "{coarse} {fine}: {rate}");
}

/// Graded fillings are as well shaped as uniform ones, with fewer cells.
#[test]
fn graded_fillings() {
    let uniform = fill(&ball(1.0), &Size::uniform(0.07), Cells::Tetrahedra, &[]).unwrap();
    let graded = Size { smallest: 0.07, grading: Grading::Inward { growth: 0.6, largest: 0.6 } };
    let fine = Vec3::new(0.3, 0.0, 0.0);
    let size = Box::new(move |x: Vec3| 0.05 + 0.7 * (x - fine).length());
    let field = Grading::Field { size, largest: 0.6, reach: Reach::Inside };
    for size in [graded, Size { smallest: 0.07, grading: field }] {
        let mut mesh = fill(&ball(1.0), &size, Cells::Tetrahedra, &[]).unwrap();
        assert_sound(&mut mesh);
        // four cubes in fourteen from the surface to the centre stay small: two thirds of the volume
        assert!(mesh.cell_count() < uniform.cell_count() * 4 / 5, "{}", mesh.cell_count());
        let [least, greatest] = angles(&mesh);
        assert!(least > 10.7 && greatest < 164.8, "{least} {greatest}");
        // what does not touch the surface was not moved: halves, quarters, half pyramids
        let on_surface = |node: &u32| mesh.groups["surface"].points.binary_search(node).is_ok();
        let inner = mesh.cells().zip(mesh.quality()).filter(|(cell, _)| !cell.nodes.iter().any(on_surface));
        for (_, cell) in inner {
            assert!(cell.smallest_dihedral.to_degrees() > 45.0 - 1e-9, "{cell:?}");
            assert!(cell.largest_dihedral.to_degrees() < 120.0 + 1e-9, "{cell:?}");
        }
        // the surface is that of the uniform filling
        assert!(
            (mesh.volume() - uniform.volume()).abs()
                < f64::EPSILON * uniform.cell_count() as f64 * uniform.volume()
        );
    }
}

/// Where a size is asked for at the surface too, cells there are of that size: a shape that lies to the lattice in every way
/// conforms and is sound, cells at its fine end are as long as asked, and those at its coarse end longer.
#[test]
fn fillings_graded_at_the_surface() {
    let mut worst = [180.0_f64, 0.0];
    for shift in 0..8 {
        let t = f64::from(shift) * 0.083;
        let turn = Vec3::new(1.0 + t, 2.3 * t, -0.7);
        let shape = Solid::turned_ellipsoid(Vec3::new(t, t * t, 0.3), Vec3::new(0.9 + t, 0.71, 0.6), turn);
        let low = shape.bounds().low.x;
        let size = Box::new(move |x: Vec3| 0.06 + 0.25 * (x.x - low));
        let grading = Grading::Field { size, largest: 1.0, reach: Reach::Everywhere };
        let graded = Size { smallest: 0.06, grading };
        for cells in [Cells::Tetrahedra, Cells::HexDominant] {
            let mut mesh = fill(&shape, &graded, cells, &[]).unwrap();
            assert_sound(&mut mesh);
            let uniform = fill(&shape, &Size::uniform(0.06), cells, &[]).unwrap();
            assert!(mesh.cell_count() < uniform.cell_count() / 3, "{}", mesh.cell_count());
            // coarse cells cut off more: their size squared over eight radii of 0.6, half as much in volume
            let lost = 1.0 - mesh.volume() / uniform.volume();
            assert!(lost > -0.01 && lost < 0.06, "{lost}");
            if cells == Cells::Tetrahedra {
                let [least, greatest] = angles(&mesh);
                worst = [worst[0].min(least), worst[1].max(greatest)];
            }
        }
    }
    assert!(worst[0] > 10.0 && worst[1] < 160.0, "{worst:?}");
}

/// Voxels are cubes of one size that fill about the volume of a ball, conforming and in one piece.
#[test]
fn voxels_are_equal_cubes() {
    let mesh = fill(&ball(1.0), &Size::uniform(0.1), Cells::Voxels, &[]).unwrap();
    assert_eq!(mesh.count_of(ElementKind::Hex8), mesh.cell_count());
    assert!(mesh.faces().conforming().is_ok() && mesh.components().1 == 1);
    let exact = 4.0 / 3.0 * std::f64::consts::PI;
    // half of the cubes that the surface cuts are in, half are not
    assert!((mesh.volume() / exact - 1.0).abs() < 0.03, "{}", mesh.volume());
    assert!((mesh.volume() - 1e-3 * mesh.cell_count() as f64).abs() < 1e-9);
}

/// A size that is nothing somewhere inside is refused with the place; one that is too fine for a count, in words.
#[test]
fn sizes_that_cannot_be() {
    let size = Box::new(|x: Vec3| x.x);
    let grading = Grading::Field { size, largest: 1.0, reach: Reach::Everywhere };
    let error = fill(&ball(0.5), &Size { smallest: 0.1, grading }, Cells::Tetrahedra, &[]).unwrap_err();
    assert!(matches!(error, FillError::SizeAt { size, .. } if size <= 0.0), "{error}");
    let plate = Solid::turned_ellipsoid(Vec3::ZERO, Vec3::new(1.0, 1.0, 5e-4), Vec3::new(0.3, 0.2, 0.1));
    let values = Values::new().with("count", Value::Integer(1000)).completed(PARAMETERS).unwrap();
    let error = Options::from_values(&values).unwrap().fill(&plate, &[]).unwrap_err();
    assert!(error.to_string().contains("1000 cells cannot be had"), "{error}");
}

/// Every shape of the table is filled in one piece, with the volume of a finer filling, and its parts have cells.
#[test]
fn every_named_shape() {
    for entry in implicit::SHAPES.entries.iter().filter(|entry| entry.name != "formula") {
        let body = implicit::body(entry.name, Values::new()).unwrap();
        let extent = body.shape.bounds().size().largest_component();
        let parts: Vec<Part> =
            body.parts.iter().map(|(name, shape)| Part { name, shape: &**shape }).collect();
        let make =
            |n: f64| fill(&*body.shape, &Size::uniform(extent / n), Cells::Tetrahedra, &parts).unwrap();
        let (mut mesh, fine) = (make(20.0), make(30.0));
        assert_sound(&mut mesh);
        assert_eq!(mesh.components().1, 1, "{}", entry.name);
        let difference = (mesh.volume() / fine.volume() - 1.0).abs();
        assert!(difference < 0.03, "{}: {difference}", entry.name);
        for (name, _) in &body.parts {
            assert!(!mesh.groups[*name].cells.is_empty(), "{} has an empty {name}", entry.name);
        }
    }
}

/// A formula is a shape; what cannot be filled is refused with the place.
#[test]
fn formulas_and_refusals() {
    let formula = |text: &'static str| {
        let corner = |c: f64| Value::Vector([c; 3]);
        let values = Values::new()
            .with("formula", Value::Text(text))
            .with("low", corner(-0.5))
            .with("high", corner(0.5));
        implicit::body("formula", values).map(|body| body.shape)
    };
    let size = Size::uniform(0.1);
    let fill = |text: &'static str| fill(&*formula(text).unwrap(), &size, Cells::Tetrahedra, &[]);
    let mesh = fill("x^2 + y^2 + 4*z^2 - 0.16").unwrap();
    let exact = 4.0 / 3.0 * std::f64::consts::PI * 0.4 * 0.4 * 0.2;
    // chords of length s under curvature k sink by k s²/8, here over a third of the flat semi-axis
    assert!((mesh.volume() / exact - 1.0).abs() < 0.05, "{}", mesh.volume() / exact);
    assert!(matches!(fill("x - 10"), Err(FillError::BeyondBounds { .. })));
    assert!(matches!(fill("x^2 + 1"), Err(FillError::Nothing { .. })));
    assert!(matches!(fill("sqrt(x)"), Err(FillError::NotANumber { .. })));
    assert!(formula("x + w").is_err());
    for surface in [0.0, -1.0, f64::NAN, 1e-9] {
        let error = super::fill(&ball(1.0), &Size::uniform(surface), Cells::Tetrahedra, &[]).unwrap_err();
        assert!(matches!(error, FillError::Size { .. } | FillError::TooManyPoints { .. }), "{error}");
    }
}

/// Hexahedra inside, tetrahedra at the surface, prisms and pyramids between: conforming, with positive Jacobians, and most of
/// the volume in hexahedra.
#[test]
fn hex_dominant_fillings() {
    for (name, count) in [("ellipsoid", 24.0), ("liver", 30.0), ("bunny", 24.0), ("torus", 30.0)] {
        let body = implicit::body(name, Values::new()).unwrap();
        let extent = body.shape.bounds().size().largest_component();
        let mut mesh = fill(&*body.shape, &Size::uniform(extent / count), Cells::HexDominant, &[]).unwrap();
        assert_sound(&mut mesh);
        let volumes = mesh.cell_volumes();
        let in_hexes: f64 =
            mesh.cells().zip(&volumes).filter(|(c, _)| c.kind == ElementKind::Hex8).map(|(_, v)| v).sum();
        let share = in_hexes / mesh.volume();
        let worst = mesh.quality().iter().map(|cell| cell.scaled_jacobian).fold(1.0, f64::min);
        let tets = fill(&*body.shape, &Size::uniform(extent / count), Cells::Tetrahedra, &[]).unwrap();
        let prisms = mesh.count_of(ElementKind::Prism6);
        println!(
            "{name}: {prisms} prisms of {} cells, hexahedra {share:.3}, worst {worst:.3}",
            mesh.cell_count()
        );
        assert!(worst > 0.0, "{name}: {worst}");
        assert!(share > 0.5, "{name}: {share} of {} cells", mesh.cell_count());
        assert!(prisms * 200 > mesh.cell_count(), "{name}: {prisms} prisms");
        // another triangulation of nearly the same surface
        let difference = (mesh.volume() / tets.volume() - 1.0).abs();
        assert!(difference < 0.01, "{name}: {difference}");
    }
}

/// Mixed fillings are sound however a shape lies to the lattice, and where it has edges and thin walls.
#[test]
fn mixed_fillings_lie_any_way() {
    let mut prisms = 0;
    for shift in 0..8 {
        let t = f64::from(shift) * 0.117;
        let turn = Vec3::new(1.0 + t, 2.3 * t, -0.7);
        let long = Solid::turned_ellipsoid(Vec3::new(t, t * t, 0.3), Vec3::new(0.5 + t, 0.41, 0.3), turn);
        let axis = turn.try_normalised().unwrap();
        let ring = Solid::Torus { centre: Vec3::new(0.3 * t, 0.2, t), axis, ring: 0.6, tube: 0.2 + 0.1 * t };
        for (shape, size) in [(&long as &dyn Shape, 0.08), (&ring, 0.08), (&Noise, 0.2)] {
            let mut mesh = fill(shape, &Size::uniform(size + 0.01 * t), Cells::HexDominant, &[]).unwrap();
            assert_sound(&mut mesh);
            let worst = mesh.quality().iter().map(|cell| cell.scaled_jacobian).fold(1.0, f64::min);
            println!(
                "{shift}: {} prisms of {} cells, worst {worst:.3}",
                mesh.count_of(ElementKind::Prism6),
                mesh.cell_count()
            );
            assert!(worst > 0.0, "{worst}");
            prisms += mesh.count_of(ElementKind::Prism6);
        }
    }
    assert!(prisms > 0);
}

/// Hexahedra of several sizes meet through pyramids: conforming, sound, and most of the volume in them; with fewer cells
/// than of one size where the body is thick.
#[test]
fn graded_hex_dominant_fillings() {
    for name in ["ellipsoid", "liver"] {
        let body = implicit::body(name, Values::new()).unwrap();
        let surface = body.shape.bounds().size().largest_component() / 48.0;
        let of = |grading: Grading| {
            fill(&*body.shape, &Size { smallest: surface, grading }, Cells::HexDominant, &[]).unwrap()
        };
        let uniform = of(Grading::Uniform);
        let mut mesh = of(Grading::Inward { growth: 0.6, largest: 4.0 * surface });
        assert_sound(&mut mesh);
        let sizes: std::collections::BTreeSet<i64> = mesh
            .cells()
            .zip(mesh.cell_volumes())
            .filter(|(cell, _)| cell.kind == ElementKind::Hex8)
            .map(|(_, volume)| (volume.cbrt() / surface).log2().round() as i64)
            .collect();
        let volume = |kind: ElementKind| {
            let of_kind = mesh.cells().zip(mesh.cell_volumes()).filter(|(cell, _)| cell.kind == kind);
            of_kind.map(|(_, volume)| volume).sum::<f64>()
        };
        let share = volume(ElementKind::Hex8) / mesh.volume();
        assert!(sizes.len() > 1, "{name}: {sizes:?}");
        assert!(name != "ellipsoid" || mesh.cell_count() < uniform.cell_count(), "{}", mesh.cell_count());
        assert!(share > 0.5, "{name}: {share}");
        let worst = mesh.quality().iter().map(|cell| cell.scaled_jacobian).fold(1.0, f64::min);
        assert!(worst > 0.0, "{name}: {worst}");
        // the surface is that of the filling of one size
        assert!((mesh.volume() / uniform.volume() - 1.0).abs() < 1e-3, "{name}");
    }
}

/// Any number of threads gives the same points in the same order.
#[test]
fn threads_change_nothing() {
    let body = implicit::body("liver", Values::new()).unwrap();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| fill(&*body.shape, &Size::uniform(0.012), Cells::Tetrahedra, &[]).unwrap())
    };
    assert!(with(1) == with(3));
}

/// A surface is filled like the shape that it came from; a hole too large to be closed changes little and is said.
#[test]
fn surfaces_are_filled() {
    let values = Values::new().with("radius", Value::Number(1.0)).with("cells", Value::Integer(12));
    let mut surface = crate::generate("sphere", values).unwrap().boundary_surface();
    let options =
        Options::from_values(&Values::new().with("size", Value::Number(0.2)).completed(PARAMETERS).unwrap())
            .unwrap();
    let whole = fill_surface(&surface, Default::default(), &options).unwrap();
    assert!(whole.notes.is_empty());
    assert!((whole.mesh.volume() / surface.enclosed_volume() - 1.0).abs() < 0.03);
    let points = surface.points.clone();
    surface.triangles.retain(|corners| corners.iter().any(|point| points[*point as usize].z < 0.8));
    let open = fill_surface(&surface, Default::default(), &options).unwrap();
    assert!(open.notes.iter().any(|note| note.contains("holes")), "{:?}", open.notes);
    // the cap of height 0.2 has 2.8 % of the ball's volume
    assert!((open.mesh.volume() / whole.mesh.volume() - 1.0).abs() < 0.06);
    // which way an open surface faces is left as it is, but of one that is to be filled it is known
    surface.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    let turned = fill_surface(&surface, Default::default(), &options).unwrap();
    assert!(turned.notes.iter().any(|note| note.contains("faced inward")), "{:?}", turned.notes);
    // a closed part beside it stays as it is, though it is the smaller one
    let small = whole.mesh.boundary_surface();
    let shift = surface.points.len() as u32;
    surface.points.extend(small.points.iter().map(|point| *point * 0.5 + Vec3::X * 3.0));
    surface.triangles.extend(small.triangles.iter().map(|corners| corners.map(|point| point + shift)));
    let both = fill_surface(&surface, Default::default(), &options).unwrap();
    assert!(both.mesh.volume() > 1.05 * turned.mesh.volume(), "{}", both.mesh.volume());
    assert!((turned.mesh.volume() / open.mesh.volume() - 1.0).abs() < 0.01);
}

/// What encloses nothing is refused by its cause: a flat sheet, a strip with a twist, half a ball, triangles here and there.
#[test]
fn surfaces_that_enclose_nothing() {
    let options = |name: &'static str, value: Value<'static>| {
        Options::from_values(&Values::new().with(name, value).completed(PARAMETERS).unwrap()).unwrap()
    };
    let refusal = |surface: &TriangleSurface| {
        let by_size = options("size", Value::Number(0.1));
        let by_count = options("count", Value::Integer(1000));
        let errors = [&by_size, &by_count].map(|options| {
            fill_surface(surface, Default::default(), options).map(|_| ()).unwrap_err().to_string()
        });
        assert_eq!(errors[0], errors[1]);
        errors[0].clone()
    };
    let strip = |count: u32, twist: f64| {
        let mut points = Vec::new();
        let mut triangles = Vec::new();
        for k in 0..count {
            let angle = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
            let (half, out) = (twist * angle, Vec3::new(angle.cos(), angle.sin(), 0.0));
            let across = (out * half.cos() + Vec3::Z * half.sin()) * 0.3;
            points.extend([out - across, out + across]);
            let (a, b) = (2 * k, 2 * k + 1);
            let [c, d] = match (k + 1 == count, twist != 0.0) {
                (false, _) => [a + 2, b + 2],
                (true, true) => [1, 0],
                (true, false) => [0, 1],
            };
            triangles.extend([[a, b, c], [b, d, c]]);
        }
        TriangleSurface::new(points, triangles).unwrap()
    };
    assert!(refusal(&strip(40, 0.0)).contains("the surface is flat, it measures 2.6"));
    let twisted = refusal(&strip(40, 0.5));
    assert!(twisted.contains("encloses nothing that is certain"), "{twisted}");
    assert!(twisted.contains("opposite orientation") && twisted.contains("one triangle only"), "{twisted}");
    let values = Values::new().with("radius", Value::Number(1.0)).with("cells", Value::Integer(8));
    let mut half = crate::generate("sphere", values).unwrap().boundary_surface();
    let points = half.points.clone();
    half.triangles.retain(|corners| corners.iter().all(|point| points[*point as usize].z < 1e-9));
    let half = refusal(&half);
    assert!(half.contains("encloses nothing that is certain") && half.contains("holes"), "{half}");
    let noise = |k: f64| (12.9898 * k).sin();
    let points: Vec<Vec3> = (0..300)
        .map(|k| Vec3::new(noise(k.into()), noise(f64::from(k) + 0.4), noise(f64::from(k) + 0.7)))
        .collect();
    let soup = (0..100).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let soup = refusal(&TriangleSurface::new(points, soup).unwrap());
    assert!(soup.contains("encloses nothing that is certain"), "{soup}");
}

/// A wanted number of cells is met; size and count together, or neither, are refused.
#[test]
fn fillings_by_count() {
    let options = |size: f64, count: i64| {
        let values = Values::new().with("size", Value::Number(size)).with("count", Value::Integer(count));
        Options::from_values(&values.completed(PARAMETERS).unwrap())
    };
    // of the fewest cells, whole shells come and go at once
    for (count, tolerance) in [(200, 0.5), (300, 0.5), (500, 0.25), (800, 0.2), (1000, 0.2), (5000, 0.1)] {
        let mesh = options(0.0, count).unwrap().fill(&ball(0.1), &[]).unwrap().mesh;
        let ratio = mesh.cell_count() as f64 / count as f64;
        println!("{} of {count}", mesh.cell_count());
        assert!((ratio - 1.0).abs() < tolerance, "{ratio} of {count}");
    }
    assert!(options(0.1, 10).is_err() && options(0.0, 0).is_err());
    let edge = Size::for_count(0.3, 5000.0);
    assert!((Size::count_for(0.3, edge) / 5000.0 - 1.0).abs() < 1e-14);
}

/// Groups of a surface come onto its filling: the two ends of a box and its half of cells keep their areas and volume to
/// what the lattice cuts off edges; a group too small for any face is told.
#[test]
fn groups_of_a_surface_are_carried() {
    let values = Values::new().with("cells", Value::Vector([4.0, 2.0, 2.0]));
    let values = values.with("size", Value::Vector([1.0, 0.5, 0.5]));
    let bar = crate::generate::generate("bar", values).unwrap();
    let surface = bar.boundary_surface();
    let mut shell = Mesh { points: bar.points.clone(), ..Mesh::default() };
    for corners in &surface.triangles {
        shell.push_facet(ElementKind::Tri3, &corners.map(|corner| surface.mesh_points[corner as usize]));
    }
    let facets_where = |keep: &dyn Fn(Vec3) -> bool| {
        let all = |triangle: &u32| surface.corners(*triangle).into_iter().all(keep);
        Group { facets: (0..surface.triangles.len() as u32).filter(all).collect(), ..Group::default() }
    };
    shell.groups.insert("left".to_owned(), facets_where(&|p| p.x < 1e-9));
    shell.groups.insert("right".to_owned(), facets_where(&|p| p.x > 1.0 - 1e-9));
    shell.groups.insert("nowhere".to_owned(), Group::default());
    let values = Values::new().with("size", Value::Number(0.05)).completed(PARAMETERS).unwrap();
    let options = Options::from_values(&values).unwrap();
    let filled = fill_mesh(&shell, Default::default(), &options).unwrap();
    assert!(filled.notes.iter().any(|note| note.contains("`nowhere` reaches no face")), "{:?}", filled.notes);
    // the same from a shell that is inside out
    let mut turned = shell.clone();
    for block in &mut turned.facet_blocks {
        block.nodes.chunks_exact_mut(3).for_each(|corners| corners.swap(1, 2));
    }
    let again = fill_mesh(&turned, Default::default(), &options).unwrap();
    assert!(again.mesh.groups["left"].points == filled.mesh.groups["left"].points);
    for (name, end) in [("left", 0.0), ("right", 1.0)] {
        let group = &filled.mesh.groups[name];
        let far = |point: &u32| (filled.mesh.points[*point as usize].x - end).abs();
        // bevels of the edges are within a size of the end
        assert!(group.points.iter().map(far).fold(0.0, f64::max) < 0.05, "{name}");
        let facets: Vec<_> = filled.mesh.facets().collect();
        let area = |facet: &u32| {
            let [a, b, c] = [0, 1, 2].map(|k| filled.mesh.points[facets[*facet as usize].nodes[k] as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        let total: f64 = group.facets.iter().map(area).sum();
        assert!((total / 0.25 - 1.0).abs() < 0.15, "{name}: {total}");
    }
    // a volume with a group of cells
    let mut bar = bar;
    let half =
        (0..bar.cell_count() as u32).filter(|cell| bar.cell_centres()[*cell as usize].x < 0.5).collect();
    bar.groups.insert("half".to_owned(), Group { cells: half, ..Group::default() });
    let filled = fill_mesh(&bar, Default::default(), &options).unwrap();
    let part = filled.mesh.groups["half"].cells.len() as f64 / filled.mesh.cell_count() as f64;
    assert!((part - 0.5).abs() < 0.02, "{part}");
}
