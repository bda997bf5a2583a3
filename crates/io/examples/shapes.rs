//! Draws every shape known by name, filled with tetrahedra, into a folder:
//! `cargo run --release -p souple-io --example shapes -- FOLDER [NAME]`.

use std::path::Path;

use souple_io::picture::{Colour, EdgeStyle, MeshSurface, Paint, Picture, View};
use souple_math::Vec3;
use souple_mesh::fill::{Cells, Part, Size, fill};
use souple_mesh::implicit::{SHAPES, body};
use souple_table::Values;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).ok_or("expected a folder for the pictures")?;
    let only = std::env::args().nth(2);
    let views = [
        ("front", Vec3::new(-0.15, -0.25, -1.0)),
        ("back", Vec3::new(0.2, 0.45, 1.0)),
        ("below", Vec3::new(0.1, 1.0, -0.5)),
    ];
    for name in
        SHAPES.names().filter(|name| *name != "formula" && only.as_ref().is_none_or(|only| only == name))
    {
        let body = body(name, Values::new())?;
        let parts: Vec<Part> =
            body.parts.iter().map(|(name, shape)| Part { name, shape: &**shape }).collect();
        let size = Size::uniform(body.shape.bounds().size().largest_component() / 70.0);
        let mesh = fill(&*body.shape, &size, Cells::Tetrahedra, &parts)?;
        println!("{name}: {} tetrahedra, {:.3e} m³", mesh.cell_count(), mesh.volume());
        for (view, direction) in views {
            let mut of = MeshSurface::of(&mesh);
            of.surface.edge_style = EdgeStyle::Hidden;
            of.surface.paint = Paint::Plain(Colour::from_screen([150, 62, 52]));
            let picture = Picture {
                surfaces: vec![of.surface],
                view: View { direction, ..View::default() },
                size: [900, 700],
                title: format!("{name}, {view}"),
                ..Picture::default()
            };
            picture.render()?.write_png(&Path::new(&folder).join(format!("{name}_{view}.png")))?;
        }
    }
    Ok(())
}
