//! Draws a few pictures into a folder, to look at: `cargo run --release -p souple-io --example gallery -- FOLDER`.

use std::path::Path;

use souple_io::picture::{
    Colour, EdgeStyle, Ground, Legend, MeshSurface, Picture, Stroke, StrokeShape, Theme, View,
};
use souple_io::plot::{Axis, Curve, Plot};
use souple_math::Vec3;
use souple_mesh::{Mesh, generate};
use souple_table::{Value, Values};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("expected a folder for the pictures")?;
    let folder = Path::new(&folder);
    bent_bar()?.render()?.write_png(&folder.join("bar.png"))?;
    ball_on_ground()?.render()?.write_png(&folder.join("ball.png"))?;
    probe_plot().write_svg(&folder.join("probes.svg"))?;
    if let Some(file) = std::env::args().nth(2) {
        let (mesh, notes) = souple_io::read_mesh(Path::new(&file))?;
        notes.iter().for_each(|note| println!("{note}"));
        file_in_the_dark(&mesh, &file).render()?.write_png(&folder.join("file.png"))?;
    }
    Ok(())
}

/// A bar bent under its weight, coloured by how far it went, with its pins and its load.
fn bent_bar() -> Result<Picture, Box<dyn std::error::Error>> {
    let values = Values::new()
        .with("size", Value::Vector([1.0, 0.2, 0.2]))
        .with("cells", Value::Vector([20.0, 4.0, 4.0]))
        .with("element", Value::Text("hex8"));
    let mesh = generate("bar", values)?;
    let bend = |p: Vec3| Vec3::new(p.x - 0.5 * p.x * p.x * p.y, p.y - 0.3 * p.x * p.x, p.z);
    let positions: Vec<Vec3> = mesh.points.iter().map(|point| bend(*point)).collect();
    let moved: Vec<f64> =
        positions.iter().zip(&mesh.points).map(|(now, rest)| (*now - *rest).length()).collect();
    let mut of = MeshSurface::of(&mesh);
    of.move_to(&positions);
    of.paint_points(&moved);
    of.surface.edge_style = EdgeStyle::Drawn;
    let pinned = mesh.points.iter().filter(|point| point.x == 0.0);
    let mut strokes: Vec<Stroke> = pinned
        .map(|point| Stroke {
            shape: StrokeShape::Dot(*point),
            colour: Colour::from_screen([40, 60, 90]),
            width: 9.0,
            through: Stroke::FAINTLY,
        })
        .collect();
    let tip = bend(Vec3::new(1.0, 0.0, 0.1));
    strokes.push(Stroke {
        shape: StrokeShape::Arrow(tip, tip - Vec3::Y * 0.18),
        colour: Colour::from_screen([200, 40, 40]),
        width: 4.0,
        through: Stroke::FAINTLY,
    });
    let legend = Legend { title: "displacement".to_owned(), unit: "m".to_owned(), ..Legend::default() };
    Ok(Picture {
        surfaces: vec![of.surface],
        strokes,
        legend: Some(legend),
        title: "A clamped bar".to_owned(),
        subtitle: "t = 0.42 s, 320 hex8, E = 10 kPa, ν = 0.3".to_owned(),
        ..Picture::default()
    })
}

fn ball_on_ground() -> Result<Picture, Box<dyn std::error::Error>> {
    let values = Values::new()
        .with("radius", Value::Number(0.5))
        .with("cells", Value::Integer(10))
        .with("element", Value::Text("tet4"))
        .with("centre", Value::Vector([0.0, 0.42, 0.0]));
    let mesh = generate("sphere", values)?;
    let mut of = MeshSurface::of(&mesh);
    // pressed flat where it touches the ground
    of.surface.points.iter_mut().for_each(|point| point.y = point.y.max(0.0));
    Ok(Picture {
        surfaces: vec![of.surface],
        ground: Some(Ground { point: Vec3::ZERO, normal: Vec3::Y }),
        title: "A soft ball at rest".to_owned(),
        ..Picture::default()
    })
}

/// Two probes of a swinging tip.
fn probe_plot() -> Plot {
    let time: Vec<f64> = (0..400).map(|index| f64::from(index) * 5e-3).collect();
    let swing =
        |damping: f64| time.iter().map(|t| -2e-3 * (1.0 - (-damping * t).exp() * (9.0 * t).cos())).collect();
    Plot {
        title: "Tip of a clamped bar".to_owned(),
        x: Axis::new("time", "s"),
        y: Axis::new("displacement", "m"),
        curves: vec![
            Curve::new("tip.y", time.clone(), swing(1.5)),
            Curve::new("tip.y, damped", time.clone(), swing(6.0)),
        ],
        ..Plot::default()
    }
}

fn file_in_the_dark(mesh: &Mesh, name: &str) -> Picture {
    let mut of = MeshSurface::of(mesh);
    of.surface.edge_style = EdgeStyle::Drawn;
    let low = mesh.bounds().low;
    Picture {
        surfaces: vec![of.surface],
        ground: Some(Ground { point: low, normal: Vec3::Y }),
        theme: Theme::Dark,
        view: View { direction: Vec3::new(0.6, -0.3, -1.0), ..View::default() },
        title: Path::new(name).file_name().unwrap_or_default().to_string_lossy().into_owned(),
        ..Picture::default()
    }
}
