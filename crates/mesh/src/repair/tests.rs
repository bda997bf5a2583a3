//! What is wrong with a surface is found, mended where that is safe, and said.

use souple_table::{Value, Values};

use super::*;

fn unit_cube(cells: f64) -> TriangleSurface {
    let values = Values::new()
        .with("size", Value::Vector([1.0; 3]))
        .with("cells", Value::Vector([cells; 3]))
        .with("element", Value::Text("hex8"));
    crate::generate("box", values).unwrap().boundary_surface()
}

fn assert_cube(surface: &TriangleSurface) {
    let diagnosis = diagnose(surface);
    assert!(diagnosis.is_simple(), "{:?}", diagnosis.messages());
    assert_volume(surface, 1.0);
}

/// To the rounding of a sum over triangles of volumes below one.
fn assert_volume(surface: &TriangleSurface, expected: f64) {
    let bound = f64::EPSILON * surface.triangles.len() as f64;
    assert!((surface.enclosed_volume() - expected).abs() < bound, "{}", surface.enclosed_volume());
}

#[test]
fn a_good_surface_is_left_alone() {
    let cube = unit_cube(2.0);
    assert_eq!(diagnose(&cube), Diagnosis { component_count: 1, ..Diagnosis::default() });
    let (mended, repairs) = repair(&cube, RepairLimits::default());
    assert_eq!(repairs, SurfaceRepairs::default());
    assert_eq!(mended.triangles, cube.triangles);
}

/// Triangles with corners of their own, some turned, one doubled, one flat, one missing: all mended, all said.
#[test]
fn everything_at_once() {
    let cube = unit_cube(3.0);
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for triangle in 1..cube.triangles.len() as u32 {
        let start = points.len() as u32;
        points.extend(cube.corners(triangle));
        let mut corners = [start, start + 1, start + 2];
        if triangle % 3 == 0 {
            corners.swap(0, 1);
        }
        triangles.push(corners);
    }
    triangles.push([0, 1, 2]);
    points.extend([Vec3::ZERO, Vec3::X, Vec3::X * 0.5]);
    let last = points.len() as u32;
    triangles.push([last - 3, last - 2, last - 1]);
    let broken = TriangleSurface::new(points, triangles).unwrap();
    let diagnosis = diagnose(&broken);
    assert!(!diagnosis.is_simple() && diagnosis.component_count > 100);
    assert_eq!((diagnosis.flat_triangles.len(), diagnosis.doubled_triangles.len()), (1, 1));
    let (mended, repairs) = repair(&broken, RepairLimits { hole: 0.5, ..RepairLimits::default() });
    assert_cube(&mended);
    assert_eq!((repairs.flat_triangles, repairs.doubled_triangles, repairs.closed_holes), (1, 1, 1));
    assert_eq!(repairs.turned_triangles, 35);
    assert_eq!(repairs.messages().len(), 5);
}

/// What is left counts the holes and tells how large they are, in the measure of the limit.
#[test]
fn large_holes_stay_and_are_said() {
    let mut cube = unit_cube(2.0);
    cube.triangles.retain(|corners| corners.iter().any(|point| cube.points[*point as usize].x < 1.0));
    let (mended, repairs) = repair(&cube, RepairLimits::default());
    assert_eq!(repairs.closed_holes, 0);
    let diagnosis = diagnose(&mended);
    assert_eq!(diagnosis.open_edges.len(), 8);
    assert!(diagnosis.messages()[0].contains("holes"));
    // a side of the cube is √2 from corner to corner, and the cube √3
    let size = 2.0_f64.sqrt() / 3.0_f64.sqrt();
    let left = Left { holes: 1, smallest_hole: size, largest_hole: size, ..Left::default() };
    assert_eq!(repairs, SurfaceRepairs { left, ..SurfaceRepairs::default() });
    assert!(left.messages(RepairLimits::default())[0].contains("0.8165 of the surface's diagonal"));
}

/// Two cubes that touch along a side are one body: the triangles between them go in pairs, and what is left is closed.
#[test]
fn parts_that_touch_are_joined() {
    let mut surface = unit_cube(3.0);
    let other = surface.clone();
    let count = surface.points.len() as u32;
    surface.points.extend(other.points.iter().map(|p| *p + Vec3::X));
    surface.triangles.extend(other.triangles.iter().map(|corners| corners.map(|point| point + count)));
    let (mended, repairs) = repair(&surface, RepairLimits::default());
    // nine squares of two triangles, twice
    assert_eq!((repairs.facing_triangles, repairs.doubled_triangles), (36, 0));
    assert!(diagnose(&mended).is_simple(), "{:?}", diagnose(&mended).messages());
    assert_volume(&mended, 2.0);
}

/// The same surface with copies of some of its triangles, turned over, before and after them.
fn with_copies(surface: &TriangleSurface, is_copied: impl Fn(Vec3) -> bool) -> (TriangleSurface, usize) {
    let mut doubled = surface.clone();
    let copied = |triangle: &u32| surface.corners(*triangle).into_iter().all(&is_copied);
    let copies: Vec<[u32; 3]> = (0..surface.triangles.len() as u32)
        .filter(copied)
        .map(|triangle| surface.triangles[triangle as usize])
        .map(|[a, b, c]| [a, c, b])
        .collect();
    let (before, after) = copies.split_at(copies.len() / 2);
    doubled.triangles = [before, &surface.triangles, after].concat();
    (doubled, copies.len())
}

/// Copies that are turned over go, and what they are copies of stays: a corner of a side, a side, a side and what is around it, all.
#[test]
fn copies_that_are_turned_over_leave_no_hole() {
    let cube = unit_cube(4.0);
    let parts: [fn(Vec3) -> bool; 4] =
        [|x| x.x + x.y < 0.6 && x.z == 0.0, |x| x.x == 1.0, |x| x.x > 0.4, |_| true];
    for part in parts {
        let (doubled, count) = with_copies(&cube, part);
        assert!(count > 0 && !diagnose(&doubled).is_closed());
        let (mended, repairs) = repair(&doubled, RepairLimits { hole: 0.0, ..RepairLimits::default() });
        assert_eq!((repairs.doubled_triangles, repairs.facing_triangles), (count, 0));
        assert_cube(&mended);
    }
}

/// However many copies of whichever triangles, in any direction and order: the surface is closed again, and one of each is left.
#[test]
fn any_copies_leave_the_surface() {
    let cube = unit_cube(3.0);
    let mut noise = 12345_u64;
    let mut below = |count: u64| {
        noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (noise >> 33) % count
    };
    for _ in 0..40 {
        let mut doubled = cube.clone();
        for [a, b, c] in &cube.triangles {
            for _ in 0..below(4) {
                let place = below(doubled.triangles.len() as u64 + 1) as usize;
                let copy = [[*a, *b, *c], [*c, *a, *b], [*a, *c, *b], [*c, *b, *a]][below(4) as usize];
                doubled.triangles.insert(place, copy);
            }
        }
        let count = doubled.triangles.len() - cube.triangles.len();
        let (mended, repairs) = repair(&doubled, RepairLimits { hole: 0.0, ..RepairLimits::default() });
        assert_eq!((repairs.doubled_triangles, repairs.facing_triangles), (count, 0));
        assert_cube(&mended);
    }
}

/// A triangle whose corners lie on a line, where a corner stands on the edge of a larger triangle: what was closed stays closed,
/// and no triangle is without area.
#[test]
fn a_line_between_triangles_opens_nothing() {
    let mut cube = unit_cube(2.0);
    let [a, b, c] = cube.triangles[0];
    let middle = cube.points.len() as u32;
    cube.points.push((cube.points[a as usize] + cube.points[b as usize]) * 0.5);
    cube.triangles[0] = [a, middle, c];
    cube.triangles.extend([[middle, b, c], [a, b, middle]]);
    assert!(diagnose(&cube).is_closed() && diagnose(&cube).flat_triangles.len() == 1);
    let (mended, repairs) = repair(&cube, RepairLimits { hole: 0.0, ..RepairLimits::default() });
    assert_eq!((repairs.flat_triangles, repairs.joined_triangles, repairs.closed_holes), (0, 1, 0));
    assert_cube(&mended);
}

/// A hollow that another part fills exactly is none: both of its sides go, whichever comes first.
#[test]
fn a_filled_hollow_is_solid() {
    let outer = unit_cube(2.0);
    let shift = outer.points.len() as u32;
    let mut points = outer.points.clone();
    points.extend(outer.points.iter().map(|p| *p * 0.5 + Vec3::new(0.25, 0.25, 0.25)));
    let inner: Vec<[u32; 3]> = outer.triangles.iter().map(|corners| corners.map(|p| p + shift)).collect();
    let hollow: Vec<[u32; 3]> = inner.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    for sides in [[&inner, &hollow], [&hollow, &inner]] {
        let triangles = [&outer.triangles, sides[0], sides[1]].into_iter().flatten().copied().collect();
        let surface = TriangleSurface::new(points.clone(), triangles).unwrap();
        let (mended, repairs) = repair(&surface, RepairLimits::default());
        assert_eq!(repairs.facing_triangles, 2 * inner.len());
        assert_cube(&mended);
    }
}

/// A fin of two sides on a body holds nothing, and goes; the body stays closed.
#[test]
fn a_fin_of_two_sides_goes() {
    let mut cube = unit_cube(2.0);
    let at = |surface: &TriangleSurface, x: Vec3| surface.points.iter().position(|p| *p == x).unwrap() as u32;
    let [a, b] = [Vec3::new(0.5, 0.5, 1.0), Vec3::new(0.5, 1.0, 1.0)].map(|x| at(&cube, x));
    let c = cube.points.len() as u32;
    cube.points.push(Vec3::new(0.5, 0.5, 2.0));
    cube.points.push(Vec3::new(0.5, 1.0, 2.0));
    cube.triangles.extend([[a, b, c], [b, c + 1, c], [a, c, b], [b, c, c + 1]]);
    let (mended, repairs) = repair(&cube, RepairLimits::default());
    assert_eq!(repairs.facing_triangles, 4);
    assert_cube(&mended);
}

/// A part that is inside out is turned; a hollow within it stays a hollow.
#[test]
fn parts_face_outward_and_hollows_stay() {
    let mut surface = unit_cube(2.0);
    let inner = surface.clone();
    let shift = surface.points.len() as u32;
    surface.points.extend(inner.points.iter().map(|p| *p * 0.5 + Vec3::new(0.25, 0.25, 0.25)));
    surface.triangles.extend(inner.triangles.iter().map(|[a, b, c]| [a + shift, c + shift, b + shift]));
    let volume = 1.0 - 0.125;
    assert_volume(&surface, volume);
    let mut inverted = surface.clone();
    inverted.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
    assert!(diagnose(&inverted).is_inside_out);
    for (given, turned) in [(surface, 0), (inverted, 2)] {
        let (mended, repairs) = repair(&given, RepairLimits::default());
        assert_volume(&mended, volume);
        assert_eq!(repairs.turned_parts, turned);
    }
}

/// Triangles with corners of their own that nothing welds, and a lid, have no inside: they face where they did.
#[test]
fn open_parts_face_where_they_did() {
    let cube = unit_cube(3.0);
    let mut soup = TriangleSurface::default();
    for triangle in 0..cube.triangles.len() as u32 {
        let start = soup.points.len() as u32;
        // smaller by a hundredth, so that no corners meet
        let corners = cube.corners(triangle);
        let middle = corners.into_iter().sum::<Vec3>() / 3.0;
        soup.points.extend(corners.map(|corner| middle + (corner - middle) * 0.99));
        soup.triangles.push([start, start + 1, start + 2]);
    }
    let mut lid = cube.clone();
    lid.triangles.retain(|corners| corners.iter().all(|point| cube.points[*point as usize].z > 0.5));
    for given in [soup, lid] {
        let mut turned_over = given.clone();
        turned_over.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        for surface in [given, turned_over] {
            let (mended, repairs) = repair(&surface, RepairLimits { hole: 0.0, ..RepairLimits::default() });
            assert_eq!(repairs.messages(), [""; 0]);
            let areas = |surface: &TriangleSurface| -> Vec<Vec3> {
                (0..surface.triangles.len() as u32).map(|triangle| surface.area_vector(triangle)).collect()
            };
            assert_eq!(areas(&mended), areas(&surface));
        }
    }
}

/// Sheets have outlines and no holes, however small they are: nothing is laid back to back with them, nor closed by a fold.
#[test]
fn sheets_are_not_closed() {
    let cube = unit_cube(2.0);
    let stray = |corners: &[[f64; 3]], triangles: &[[u32; 3]]| {
        let shift = cube.points.len() as u32;
        let points = corners.iter().map(|[x, y, z]| Vec3::new(3.0 + 0.01 * x, 0.01 * y, 0.01 * z));
        let mut surface = cube.clone();
        surface.points.extend(points);
        surface.triangles.extend(triangles.iter().map(|corners| corners.map(|point| point + shift)));
        surface
    };
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 0.01]];
    let fold = [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0]];
    for surface in [
        stray(&square[..3], &[[0, 1, 2]]),
        stray(&fold, &[[0, 1, 2], [0, 2, 3]]),
        stray(&square, &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]),
    ] {
        let (mended, repairs) = repair(&surface, RepairLimits { hole: 1.0, ..RepairLimits::default() });
        assert_eq!(mended.triangles, surface.triangles);
        assert_eq!((repairs.messages().len(), repairs.left.outlines), (0, 1));
    }
}

/// Flat boxes without their lids, and bands, are no sheets: their rings are holes, whatever share of their area these have.
#[test]
fn flat_boxes_and_bands_are_closed() {
    for (height, is_band) in [(0.01, false), (0.3, true)] {
        let mut surface = unit_cube(2.0);
        let points = surface.points.clone();
        let is_at = |corners: &[u32; 3], z: f64| corners.iter().all(|point| points[*point as usize].z == z);
        surface.triangles.retain(|corners| !(is_at(corners, 1.0) || is_band && is_at(corners, 0.0)));
        surface.points.iter_mut().for_each(|point| point.z *= height);
        let limits = RepairLimits { hole: f64::INFINITY, ..RepairLimits::default() };
        let (mended, repairs) = repair(&surface, limits);
        assert_eq!((repairs.closed_holes, repairs.left.outlines), (1 + usize::from(is_band), 0), "{height}");
        assert!((mended.enclosed_volume() / height - 1.0).abs() < 1e-12);
    }
}

/// The cube without the squares of its top in a pattern of four by four.
fn without_squares(pattern: [&[u8; 4]; 4]) -> TriangleSurface {
    let mut cube = unit_cube(4.0);
    let points = cube.points.clone();
    cube.triangles.retain(|corners| {
        let middle = corners.iter().map(|point| points[*point as usize]).sum::<Vec3>() / 3.0;
        let [row, column] = [middle.y, middle.x].map(|at| (4.0 * at) as usize);
        middle.z < 0.999 || pattern[row][column] == b'.'
    });
    cube
}

/// A hole is closed within its rim, whatever its form: the cube is whole again, and its sides have their area.
#[test]
fn holes_are_closed_within_their_rim() {
    let patterns: [[&[u8; 4]; 4]; 5] = [
        [b"....", b".##.", b"..#.", b"...."],
        [b"....", b".#..", b".##.", b"...."],
        [b"#...", b"#...", b"###.", b"...."],
        [b"#.##", b"#..#", b"####", b"...."],
        [b"....", b"####", b"....", b"...."],
    ];
    for pattern in patterns {
        let surface = without_squares(pattern);
        let (mended, repairs) = repair(&surface, RepairLimits { hole: 1.0, ..RepairLimits::default() });
        assert_eq!((repairs.closed_holes, repairs.folded_holes), (1, 0));
        assert_cube(&mended);
        assert!((mended.area() - 6.0).abs() < 1e-13, "{}", mended.area());
        assert_eq!(repair(&mended, RepairLimits::default()), (mended, SurfaceRepairs::default()));
    }
}

/// Corners on the sides of larger triangles leave slits: they are closed, and nothing without area is left.
#[test]
fn slits_are_closed_without_flat_triangles() {
    for inner in 1..5 {
        let mut cube = unit_cube(2.0);
        let [a, b, c] = cube.triangles[0];
        let first = cube.points.len() as u32;
        let [from, to] = [a, b].map(|point| cube.points[point as usize]);
        cube.points.extend((1..=inner).map(|k| from + (to - from) * (f64::from(k) / f64::from(inner + 1))));
        let side: Vec<u32> = [a].into_iter().chain(first..first + inner).chain([b]).collect();
        cube.triangles[0] = [side[0], side[1], c];
        cube.triangles.extend(side[1..].windows(2).map(|pair| [pair[0], pair[1], c]));
        let (mended, repairs) = repair(&cube, RepairLimits { hole: 1.0, ..RepairLimits::default() });
        assert_eq!((repairs.closed_holes, repairs.joined_triangles), (1, inner as usize));
        assert_cube(&mended);
        assert_eq!(repair(&mended, RepairLimits::default()), (mended, SurfaceRepairs::default()));
    }
}

/// Two surfaces as one.
fn both(a: &TriangleSurface, b: &TriangleSurface) -> TriangleSurface {
    let shift = a.points.len() as u32;
    let moved = b.triangles.iter().map(|corners| corners.map(|point| point + shift));
    TriangleSurface::new(
        a.points.iter().chain(&b.points).copied().collect(),
        a.triangles.iter().copied().chain(moved).collect(),
    )
    .unwrap()
}

/// Boxes that overlap where no triangle passes through another, and walls that cross where their diagonals do, are told; a hollow and
/// boxes apart are in order.
#[test]
fn overlaps_without_crossings_are_found() {
    let cube = unit_cube(1.0);
    let moved = |scale: f64, shift: Vec3| {
        let mut moved = cube.clone();
        moved.points.iter_mut().for_each(|point| *point = *point * scale + shift);
        moved
    };
    let mut hollow = moved(0.5, Vec3::new(0.25, 0.25, 0.25));
    hollow.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
    // over a quadrilateral whose sides cross
    let mut bow = cube.clone();
    for point in &mut bow.points {
        point.x = if point.y > 0.5 { 1.0 - point.x } else { point.x };
    }
    for (surface, overlaps) in [
        (both(&cube, &moved(1.0, Vec3::X * 0.5)), true),
        (both(&cube, &moved(0.5, Vec3::new(0.25, 0.25, 0.25))), true),
        (bow, true),
        // few triangles within many
        (both(&unit_cube(12.0), &moved(0.1, Vec3::new(0.41, 0.42, 0.43))), true),
        (both(&cube, &hollow), false),
        (both(&cube, &moved(1.0, Vec3::X * 1.0005)), false),
        (both(&cube, &moved(1.0, Vec3::X * 1.5)), false),
    ] {
        let diagnosis = diagnose(&surface);
        assert!(diagnosis.crossings.pairs.is_empty(), "{:?}", diagnosis.crossings);
        assert_eq!(
            (diagnosis.overlaps, diagnosis.is_simple()),
            (overlaps, !overlaps),
            "{:?}",
            diagnosis.messages()
        );
    }
}

/// Closed parts that touch at a point or along an edge stay several surfaces, as indexed triangles and as triangles with corners of
/// their own; a second repair has nothing to do.
#[test]
fn parts_that_touch_at_an_edge_stay_apart() {
    for (shift, places) in [(Vec3::new(1.0, 1.0, 0.0), 2), (Vec3::new(1.0, 1.0, 1.0), 1)] {
        let mut indexed = unit_cube(1.0);
        let other = indexed.clone();
        let count = indexed.points.len() as u32;
        indexed.points.extend(other.points.iter().map(|p| *p + shift));
        indexed.triangles.extend(other.triangles.iter().map(|corners| corners.map(|point| point + count)));
        let (mended, repairs) = repair(&indexed, RepairLimits::default());
        assert_eq!((repairs.messages().len(), repairs.left.touching_points), (0, places));
        assert_eq!((&mended.points, &mended.triangles), (&indexed.points, &indexed.triangles));

        let soup = TriangleSurface::new(
            (0..indexed.triangles.len() as u32).flat_map(|triangle| indexed.corners(triangle)).collect(),
            (0..indexed.triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect(),
        );
        let (mended, repairs) = repair(&soup.unwrap(), RepairLimits::default());
        assert_eq!((mended.points.len(), repairs.left.touching_points), (16, places));
        assert!(diagnose(&mended).is_simple() && diagnose(&mended).component_count == 2);
        let (again, repairs) = repair(&mended, RepairLimits::default());
        assert!(again == mended && repairs.messages().is_empty());
    }
}

/// A closed plate as thin as what is welded stays closed, alone, beside others and given as triangles with corners of their own; its
/// points are told to be left, and how far others have moved.
#[test]
fn thin_parts_stay_closed() {
    let plate = {
        let mut plate = unit_cube(3.0);
        plate.points.iter_mut().for_each(|point| point.z *= 1e-4);
        plate
    };
    let limits = RepairLimits { weld: 1e-3, ..RepairLimits::default() };
    let (mended, repairs) = repair(&plate, limits);
    assert_eq!((repairs.left.thin_parts, mended.triangles), (1, plate.triangles.clone()));
    // beside it an open box, of which two corners are a little apart
    let mut both = plate.clone();
    let (mut open, shift) = (unit_cube(1.0), plate.points.len() as u32);
    let apart = open.points[open.triangles[0][0] as usize] + Vec3::X * 1e-4;
    open.triangles[0][0] = open.points.len() as u32;
    open.points.push(apart);
    both.points.extend(open.points.iter().map(|point| *point + Vec3::X * 2.0));
    both.triangles.extend(open.triangles.iter().map(|corners| corners.map(|point| point + shift)));
    let (mended, repairs) = repair(&both, limits);
    assert_eq!((repairs.left.thin_parts, repairs.welded_points), (1, 1));
    assert!((repairs.longest_weld - 1e-4).abs() < 1e-15);
    assert!(
        repairs.messages()[0].contains("welded to another, up to 0.0001 m away"),
        "{:?}",
        repairs.messages()
    );
    assert!(diagnose(&mended).is_simple());
    assert_volume(&mended, 1.0 + 1e-4);
}

/// A strip with a twist has one side: it is left as it is, and that is said; cut open it has two, and is turned to agree.
#[test]
fn a_strip_with_a_twist_is_left() {
    let count = 20;
    let point = |k: u32| {
        let around = std::f64::consts::TAU * f64::from(k / 2) / f64::from(count);
        let across = (f64::from(k % 2) - 0.5) * Vec3::new((0.5 * around).cos(), 0.0, (0.5 * around).sin());
        let radius = 1.0 + across.x;
        Vec3::new(radius * around.cos(), radius * around.sin(), across.z)
    };
    let points: Vec<Vec3> = (0..2 * count).map(point).collect();
    let square = |k: u32| {
        let corners = [2 * k, 2 * k + 1, 2 * k + 2, 2 * k + 3];
        // the end meets the start turned over
        let [a, b, c, d] = if k + 1 == count { [2 * k, 2 * k + 1, 1, 0] } else { corners };
        [[a, b, c], [b, d, c]]
    };
    let strip = TriangleSurface::new(points.clone(), (0..count).flat_map(square).collect()).unwrap();
    let (mended, repairs) = repair(&strip, RepairLimits { hole: 0.0, ..RepairLimits::default() });
    assert_eq!((repairs.messages().len(), repairs.left.one_sided_parts), (0, 1));
    assert_eq!(mended, strip);
    let mut open: Vec<[u32; 3]> = (0..count - 1).flat_map(square).collect();
    open[7].swap(0, 1);
    let open = TriangleSurface::new(points, open).unwrap();
    let (_, repairs) = repair(&open, RepairLimits { hole: 0.0, ..RepairLimits::default() });
    assert_eq!((repairs.turned_triangles, repairs.left.one_sided_parts), (1, 0));
}

/// Parts within others are told where what they enclose counts twice, and not where they are hollows.
#[test]
fn nested_parts_are_told() {
    let outer = unit_cube(2.0);
    let shift = outer.points.len() as u32;
    let mut nested = outer.clone();
    nested.points.extend(outer.points.iter().map(|p| *p * 0.5 + Vec3::new(0.25, 0.25, 0.25)));
    let mut hollow = nested.clone();
    nested.triangles.extend(outer.triangles.iter().map(|corners| corners.map(|point| point + shift)));
    hollow.triangles.extend(outer.triangles.iter().map(|[a, b, c]| [a + shift, c + shift, b + shift]));
    for (surface, told) in [(nested, 1), (hollow, 0)] {
        let (_, repairs) = repair(&surface, RepairLimits::default());
        assert_eq!((repairs.messages().len(), repairs.left.nested_parts), (0, told));
    }
}

/// A point of two cubes is no manifold, and told.
#[test]
fn pinched_points_are_told() {
    let mut pinched = unit_cube(1.0);
    let last = pinched.points.iter().position(|p| *p == Vec3::new(1.0, 1.0, 1.0)).unwrap() as u32;
    let first = pinched.points.iter().position(|p| *p == Vec3::ZERO).unwrap() as u32;
    let (other, shift) = (pinched.clone(), pinched.points.len() as u32);
    pinched.points.extend(other.points.iter().map(|p| *p + Vec3::new(1.0, 1.0, 1.0)));
    let joined = |point: u32| if point == first { last } else { point + shift };
    pinched.triangles.extend(other.triangles.iter().map(|corners| corners.map(joined)));
    let (mended, repairs) = repair(&pinched, RepairLimits::default());
    // the first point of the second cube is no longer used
    assert_eq!((repairs.welded_points, repairs.left), (1, Left::default()));
    let diagnosis = diagnose(&mended);
    assert_eq!(diagnosis.pinched_points, [last]);
    assert!(diagnosis.messages()[0].contains("1 point joins triangles"), "{:?}", diagnosis.messages());
}

/// Two cubes shifted into each other cross; cubes side by side do not.
#[test]
fn crossings_are_found() {
    for (shift, expected) in [(Vec3::new(0.31, 0.27, 0.23), true), (Vec3::X * 1.5, false)] {
        let mut surface = unit_cube(1.0);
        let other = surface.clone();
        let count = surface.points.len() as u32;
        surface.points.extend(other.points.iter().map(|p| *p + shift));
        surface.triangles.extend(other.triangles.iter().map(|corners| corners.map(|point| point + count)));
        let diagnosis = diagnose(&surface);
        assert_eq!(!diagnosis.crossings.pairs.is_empty(), expected);
        assert!(!diagnosis.crossings.is_cut_off);
        assert_eq!(diagnosis.component_count, 2);
    }
}

/// Of a surface that crosses itself everywhere the first pairs are told, and that there are more.
#[test]
fn the_search_for_crossings_ends() {
    let noise = |k: f64| (12.9898 * k).sin();
    let corner = |k: u32| {
        let s = f64::from(k) + 0.1;
        Vec3::new(noise(s), noise(2.3 * s), noise(3.7 * s))
    };
    let triangles = (0..1000).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let wild = diagnose(&TriangleSurface::new((0..3000).map(corner).collect(), triangles).unwrap());
    assert_eq!(wild.crossings.pairs.len(), MOST_CROSSINGS);
    assert!(wild.crossings.pairs.is_sorted());
    assert!(
        wild.messages().iter().any(|line| line.contains("after the first 1000 such pairs")),
        "{:?}",
        wild.messages()
    );
}
