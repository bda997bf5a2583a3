//! Pictures of simple things cover what they must, and the same picture is the same bits.

use souple_mesh::{ElementKind, Mesh, generate};
use souple_table::{Value, Values};

use super::*;

fn ball(element: &str) -> Mesh {
    let values = Values::new()
        .with("radius", Value::Number(1.0))
        .with("cells", Value::Integer(6))
        .with("element", Value::Text(element));
    generate("sphere", values).unwrap()
}

fn cube() -> Mesh {
    let corner = |index: usize| [index & 1, index >> 1 & 1, index >> 2].map(|bit| bit as f64);
    let points = [0, 1, 3, 2, 4, 5, 7, 6].map(|index| Vec3::from_array(corner(index))).to_vec();
    Mesh::new(points, ElementKind::Hex8, (0..8).collect())
}

/// Pixels that differ from the same picture without its surfaces.
fn covered(picture: &Picture) -> usize {
    let empty = Picture { surfaces: Vec::new(), strokes: Vec::new(), ..picture.clone() };
    let (full, empty) = (picture.render().unwrap(), empty.render().unwrap());
    full.pixels.iter().zip(&empty.pixels).filter(|(a, b)| a != b).count()
}

/// A square seen straight from the front fills the square that fits the frame: side² pixels.
#[test]
fn a_square_covers_its_pixels() {
    let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec();
    let surface = Surface { points, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Surface::default() };
    let view = View { direction: -Vec3::Z, ..View::default() };
    for samples_per_pixel in [1, 2, 3] {
        let picture = Picture {
            surfaces: vec![surface.clone()],
            view,
            size: [300, 200],
            samples_per_pixel,
            ..Picture::default()
        };
        // the frame leaves 4.5 % of the height on either side
        let side = 200.0 * (1.0 - 2.0 * 0.045);
        // a row of pixels along each border may be covered in part
        let measured = covered(&picture) as f64;
        assert!((measured - side * side).abs() <= 4.0 * side + 4.0, "{measured} {}", side * side);
    }
}

/// A lamp on the right makes the right half of a ball brighter, one on the left the left half.
#[test]
fn the_lamp_stands_where_it_is_put() {
    let surface = MeshSurface::of(&ball("hex8")).surface;
    let halves = |light: Vec3| {
        let view = View { light: Some(light), ..View::along(-Vec3::Z, Vec3::Y) };
        let picture =
            Picture { surfaces: vec![surface.clone()], view, size: [200, 200], ..Picture::default() };
        let image = picture.render().unwrap();
        let mut sums = [0_u64; 2];
        for (index, pixel) in image.pixels.iter().enumerate() {
            sums[index % 200 / 100] += pixel.iter().map(|part| u64::from(*part)).sum::<u64>();
        }
        sums
    };
    let ([left, right], [left_2, right_2]) = (halves(-Vec3::X), halves(Vec3::X));
    assert!(right > left && left_2 > right_2, "{left} {right} {left_2} {right_2}");
}

/// A ball covers a disc: π/4 of the square around it. The silhouette of a ball in perspective is fitted by its
/// points, and its polygon is smaller than the disc by less than `(π/n)²/6` for `n` points around.
#[test]
fn a_ball_covers_a_disc() {
    let surface = MeshSurface::of(&ball("hex8")).surface;
    let picture = Picture { surfaces: vec![surface], size: [400, 400], ..Picture::default() };
    let side = 400.0 * (1.0 - 2.0 * 0.045);
    let expected = std::f64::consts::FRAC_PI_4 * side * side;
    let measured = covered(&picture) as f64;
    let polygon = (std::f64::consts::PI / 24.0).powi(2);
    assert!((measured / expected - 1.0).abs() < 2.0 * polygon + 4.0 / side, "{}", measured / expected);
}

#[test]
fn the_same_picture_is_the_same_bits() {
    let picture = Picture {
        surfaces: vec![MeshSurface::of(&cube()).surface],
        ground: Some(Ground { point: Vec3::ZERO, normal: Vec3::Y }),
        size: [160, 100],
        title: "A cube".to_owned(),
        ..Picture::default()
    };
    assert_eq!(picture.render().unwrap(), picture.render().unwrap());
}

/// A quadrilateral keeps its four edges, a cube its twelve: each of twelve triangles has one that is none.
#[test]
fn quadrilaterals_have_no_diagonal() {
    let of = MeshSurface::of(&cube());
    assert_eq!((of.surface.triangles.len(), of.points.len()), (12, 8));
    assert!(of.surface.edges.iter().all(|marks| marks.iter().filter(|mark| **mark).count() == 2));
    let triangles = MeshSurface::of(&ball("tet4")).surface;
    assert!(triangles.edges.iter().flatten().all(|mark| *mark));
}

/// A quadrilateral with a corner that points inward is cut within, and keeps its four edges.
#[test]
fn darts_are_cut_within() {
    let points =
        [[2.0, -1.0, 0.0], [0.0, 3.0, 0.0], [-2.0, -1.0, 0.0], [0.0, 0.0, 0.0]].map(Vec3::from_array);
    let mut dart = Mesh { points: points.to_vec(), ..Mesh::default() };
    dart.push_facet(ElementKind::Quad4, &[0, 1, 2, 3]);
    let surface = MeshSurface::of(&dart).surface;
    assert!(surface.edges.iter().all(|marks| marks.iter().filter(|mark| **mark).count() == 2));
    let heights = surface.triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(|corner| surface.points[corner as usize]);
        (b - a).cross(c - a).z
    });
    let twice: Vec<f64> = heights.collect();
    assert!(twice.iter().all(|area| *area > 0.0) && twice.iter().sum::<f64>() == 12.0, "{twice:?}");
}

/// Normals of a box stand on its faces, those of a ball along its radius.
#[test]
fn normals_keep_creases_and_round_balls() {
    let cube = MeshSurface::of(&cube()).surface;
    for (corners, normals) in cube.triangles.iter().zip(cube.corner_normals()) {
        let [a, b, c] = corners.map(|corner| cube.points[corner as usize]);
        let face = (b - a).cross(c - a);
        assert!(normals.iter().all(|normal| (*normal - face).length() < 1e-12));
    }
    let ball = MeshSurface::of(&ball("tet4")).surface;
    for (corners, normals) in ball.triangles.iter().zip(ball.corner_normals()) {
        for (corner, normal) in corners.iter().zip(normals) {
            // 10 degrees: a third of the angle between neighbouring triangles
            assert!(ball.points[*corner as usize].dot(normal) > 0.985);
        }
    }
}

/// A stroke before a surface is seen whole, one behind it shines through.
#[test]
fn strokes_are_hidden_by_what_is_before_them() {
    let red = Colour([1.0, 0.0, 0.0]);
    let pixel_of = |z: f64| {
        let dot = Stroke {
            shape: StrokeShape::Dot(Vec3::new(0.5, 0.5, z)),
            colour: red,
            width: 9.0,
            through: Stroke::FAINTLY,
        };
        let picture = Picture {
            surfaces: vec![MeshSurface::of(&cube()).surface],
            strokes: vec![dot],
            view: View { direction: -Vec3::Z, ..View::default() },
            size: [101, 101],
            ..Picture::default()
        };
        picture.render().unwrap().pixels[50 * 101 + 50]
    };
    assert_eq!(pixel_of(1.0), [255, 0, 0]);
    assert!(pixel_of(0.5)[1] > 60);
}

/// Values on a scale of powers of ten have the colours that their logarithms have on a linear one, zero that of the first power, and
/// what is below zero none.
#[test]
fn powers_of_ten_have_the_colours_of_their_logarithms() {
    let strip = |values: Vec<f64>| {
        let points = (0..8).map(|k| Vec3::new(f64::from(k / 2), f64::from(k % 2), 0.0)).collect();
        let triangles =
            (0..3).flat_map(|k| [[2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1]]).collect();
        Surface { points, triangles, paint: Paint::PointScalar(values), ..Surface::default() }
    };
    let picture = |values: [f64; 4], scale: ColourScale, range: (f64, f64)| {
        let legend = Legend { range: Some(range), place: LegendPlace::Apart, ..Legend::default() };
        Picture {
            surfaces: vec![strip(values.iter().flat_map(|value| [*value; 2]).collect())],
            view: View { direction: -Vec3::Z, ..View::default() },
            size: [120, 60],
            legend: Some(legend),
            scale,
            ..Picture::default()
        }
        .render()
        .unwrap()
        .pixels
    };
    let by_powers = |values| picture(values, ColourScale::Logarithmic, (1.0, 1e3));
    let by_logarithms = |values| picture(values, ColourScale::Linear, (0.0, 3.0));
    // rounding may turn a part of a colour by one
    let is_same = |a: &[[u8; 3]], b: &[[u8; 3]]| {
        a.iter().zip(b).all(|(a, b)| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 1))
    };
    let powers = by_powers([1.0, 1e3, 10.0, 100.0]);
    assert!(is_same(&powers, &by_logarithms([0.0, 3.0, 1.0, 2.0])));
    assert!(!is_same(&powers, &by_logarithms([0.0, 3.0, 1.0, 1.0])));
    assert_eq!(by_powers([0.0, 1e3, 10.0, 100.0]), powers);
    // of three cells the first has a corner without a colour
    let grey = by_powers([-1.0, 1e3, 10.0, 100.0]);
    let differs: Vec<usize> =
        (0..120).filter(|x| (0..60).any(|y| grey[y * 120 + x] != powers[y * 120 + x])).collect();
    assert!(!differs.is_empty() && differs.iter().all(|x| *x < 48), "{differs:?}");
}

#[test]
fn faulty_pictures_are_refused_and_strange_ones_drawn() {
    let surface = MeshSurface::of(&cube()).surface;
    let refused = |picture: Picture| picture.render().unwrap_err().to_string();
    let plain = Picture { size: [40, 30], ..Picture::default() };
    assert!(refused(Picture { size: [0, 30], ..plain.clone() }).contains("width"));
    assert!(refused(Picture { samples_per_pixel: 0, ..plain.clone() }).contains("samples"));
    let paint = Paint::PointScalar(vec![0.0; 3]);
    let short = Surface { paint, ..surface.clone() };
    assert!(refused(Picture { surfaces: vec![short], ..plain.clone() }).contains("one for each point"));
    let far = Surface { triangles: vec![[0, 1, 99]], ..Surface { edges: Vec::new(), ..surface.clone() } };
    assert!(refused(Picture { surfaces: vec![far], ..plain.clone() }).contains("a number below 8"));

    let mut broken = surface.clone();
    broken.points[0] = Vec3::new(f64::NAN, 0.0, 0.0);
    broken.points[1] = Vec3::new(f64::INFINITY, 0.0, 1e300);
    broken.paint = Paint::PointScalar(vec![f64::NAN; 8]);
    let flat = Surface { points: vec![Vec3::X; 3], triangles: vec![[0, 1, 2]], ..Surface::default() };
    for surfaces in [vec![], vec![broken], vec![flat]] {
        let legend = Some(Legend { range: Some((f64::NAN, 1.0)), ..Legend::default() });
        let ground = Some(Ground { point: Vec3::ZERO, normal: Vec3::ZERO });
        for size in [[40, 30], [1, 1], [1, 300], [300, 1]] {
            Picture { surfaces: surfaces.clone(), legend: legend.clone(), ground, size, ..plain.clone() }
                .render()
                .unwrap();
        }
    }
}

/// What a cut leaves of warped cells is closed: neighbours cut the quadrilateral between them along one diagonal, and what is left of
/// the outside meets the section.
#[test]
fn sections_of_warped_cells_close() {
    let curved = ["hex20", "hex27", "prism15", "pyramid13", "tet10"];
    for element in ["hex8", "prism6", "pyramid5", "tet4"].into_iter().chain(curved) {
        let values = Values::new()
            .with("size", Value::Vector([1.0; 3]))
            .with("cells", Value::Vector([4.0; 3]))
            .with("element", Value::Text(element));
        let mut mesh = generate("box", values).unwrap();
        // a fifth as far where points lie half as far apart and more: cells stay such that all of their faces are seen from within
        let far = if curved.contains(&element) { 0.008 } else { 0.04 };
        for (number, point) in mesh.points.iter_mut().enumerate() {
            let k = number as f64;
            *point += Vec3::new((12.9 * k).sin(), (78.2 * k).sin(), (37.7 * k).sin()) * far;
        }
        for normal in [Vec3::new(0.3, 0.2, 1.0), Vec3::Z, Vec3::new(1.0, -1.0, 0.1)] {
            let cut = Cut { point: Vec3::new(0.51, 0.47, 0.49), normal };
            let left = MeshSurface::cut(&mesh, &mesh.points, cut).surface;
            let surface = souple_mesh::TriangleSurface::new(left.points, left.triangles).unwrap();
            let open = surface.edge_uses().into_iter().filter(|(_, forward, backward)| forward != backward);
            assert_eq!(open.count(), 0, "{element} {normal:?}");
        }
    }
}

/// On one colour the ground goes over into it: its border is the background, whatever stands on it and wherever shadows fall, so
/// that pictures that stand side by side have no seam; and what a sheet leaves free has the same colour.
#[test]
fn grounds_fade_into_one_colour() {
    let surface = MeshSurface::of(&ball("hex8")).surface;
    for backdrop in [Backdrop::Plain, Backdrop::White] {
        let picture = Picture {
            surfaces: vec![surface.clone()],
            ground: Some(Ground { point: -Vec3::Y, normal: Vec3::Y }),
            backdrop,
            size: [160, 120],
            ..Picture::default()
        };
        let image = picture.render().unwrap();
        let near = |pixel: [u8; 3]| pixel.iter().zip(picture.background()).all(|(a, b)| a.abs_diff(b) <= 1);
        for (index, pixel) in image.pixels.iter().enumerate() {
            let (column, row) = (index % 160, index / 160);
            let is_border = column == 0 || column == 159 || row == 0 || row == 119;
            assert!(!is_border || near(*pixel), "{backdrop:?} {column} {row} {pixel:?}");
        }
        assert!(image.pixels.iter().any(|pixel| !near(*pixel)));
        let sheet =
            Image::sheet(&vec![image; 3], 2, picture.background()).grown([330, 250], picture.background());
        for (index, pixel) in sheet.pixels.iter().enumerate() {
            let (column, row) = (index % 330, index / 330);
            let is_free = (column >= 160 && row >= 120) || column >= 320 || row >= 240;
            assert!(!is_free || *pixel == picture.background(), "{column} {row}");
        }
    }
}

/// A ball is drawn the same wherever it stands: the centre is a power of two, to which its coordinates are rounded by `2⁻²⁶` of its
/// size at most, which turns a normal by less than a step of a colour.
#[test]
fn pictures_do_not_depend_on_the_place() {
    let drawn = |by: Vec3| {
        let mut surface = MeshSurface::of(&ball("hex8")).surface;
        surface.points.iter_mut().for_each(|point| *point += by);
        let ground = Some(Ground { point: by - Vec3::Y, normal: Vec3::Y });
        Picture { surfaces: vec![surface], ground, size: [200, 150], ..Picture::default() }.render().unwrap()
    };
    let near = drawn(Vec3::ZERO);
    let far = drawn(Vec3::new(f64::from(1 << 20), -f64::from(1 << 26), 0.0));
    let steps = |a: &[u8; 3], b: &[u8; 3]| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
    // a sample at the outline may fall on the other side of it
    let off = near.pixels.iter().zip(&far.pixels).filter(|(a, b)| steps(a, b) > 2).count();
    assert!(off < near.pixels.len() / 1000, "{off} pixels differ");
}

/// A texture goes with the matter: a ball that has moved away has the same picture; a tissue that is charred shows none of it, and blood
/// hides it.
#[test]
fn textures_stick_to_matter() {
    let mesh = ball("hex8");
    let colours = [[30, 40, 200], [220, 220, 60]].map(Colour::from_screen);
    let figure = TextureFigure::Pattern(Pattern::Spots, colours);
    let texture = std::sync::Arc::new(Texture { figure, size: 0.3 });
    let drawn = |shift: Vec3, value: Option<f64>, film: f64| {
        let mut of = MeshSurface::of(&mesh);
        let count = mesh.points.len();
        if let Some(value) = value {
            of.paint_points(&vec![value; count]);
        }
        of.texture(&texture, &mesh.points);
        of.cover(&vec![film; count]);
        of.move_to(&mesh.points.iter().map(|point| *point + shift).collect::<Vec<_>>());
        let picture = Picture {
            surfaces: vec![of.surface],
            colours: ColourMap::Tissue,
            legend: None,
            view: View::along(-Vec3::Z, Vec3::Y),
            size: [160, 160],
            ..Picture::default()
        };
        picture.render().unwrap()
    };
    let whole = drawn(Vec3::ZERO, None, 0.0);
    let count =
        |image: &Image, is: fn([u8; 3]) -> bool| image.pixels.iter().filter(|pixel| is(**pixel)).count();
    let [blue, yellow, red]: [fn([u8; 3]) -> bool; 3] = [
        |[red, _, blue]| blue > red.saturating_add(60),
        |[red, _, blue]| red > blue.saturating_add(60),
        |[red, green, _]| red > 60 && red > green.saturating_mul(3),
    ];
    assert!(
        count(&whole, blue) > 2000 && count(&whole, yellow) > 400,
        "{} {}",
        count(&whole, blue),
        count(&whole, yellow)
    );
    let moved = drawn(Vec3::new(3.0, -1.0, 2.0), None, 0.0);
    let apart = |a: &[u8; 3], b: &[u8; 3]| (0..3).any(|k| a[k].abs_diff(b[k]) > 8);
    let differing = whole.pixels.iter().zip(&moved.pixels).filter(|(a, b)| apart(a, b)).count();
    // a pixel of the outline here and there
    assert!(differing < 160, "{differing}");
    assert_eq!(drawn(Vec3::ZERO, Some(0.0), 0.0).pixels, whole.pixels);
    let charred = drawn(Vec3::ZERO, Some(-1.0), 0.0);
    assert!(count(&charred, blue) + count(&charred, yellow) < 100);
    let bloody = drawn(Vec3::ZERO, None, 5e-3);
    assert!(count(&bloody, red) > 8000 && count(&bloody, blue) < 100, "{}", count(&bloody, red));
}
