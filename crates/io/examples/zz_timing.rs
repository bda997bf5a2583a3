use souple_io::{picture::*, *};
use souple_table::{Value, Values};
use std::time::Instant;
fn main() {
    let f = |c: f64| souple_mesh::generate("bar", Values::new().with("size", Value::Vector([1.0, 0.2, 0.2])).with("cells", Value::Vector([c * 5.0, c, c])).with("element", Value::Text("tet4"))).unwrap();
    let mesh = f(16.0);
    println!("{} points {} cells", mesh.points.len(), mesh.cell_count());
    let dir = std::env::temp_dir();
    for ext in ["vtu", "msh", "vtk"] {
        let p = dir.join(format!("timing-io.{ext}"));
        let t = Instant::now(); write_mesh(&p, &mesh).unwrap(); let w = t.elapsed();
        let t = Instant::now(); read_mesh(&p).unwrap(); println!("{ext}: write {w:?} read {:?} bytes {}", t.elapsed(), std::fs::metadata(&p).unwrap().len());
    }
    for s in [1, 2, 3] {
        let t = Instant::now();
        let of = MeshSurface::of(&mesh);
        let a = t.elapsed();
        let n = of.surface.triangles.len();
        let t = Instant::now();
        let i = Picture { surfaces: vec![of.surface], samples_per_pixel: s, ground: Some(Ground { point: mesh.bounds().low, normal: souple_math::Vec3::Y }), ..Picture::default() }.render().unwrap();
        let r = t.elapsed();
        let t = Instant::now(); i.write_png(&dir.join("timing-io.png")).unwrap();
        println!("surface {a:?}, {n} triangles, {s}x{s}: render {r:?}, png {:?}", t.elapsed());
    }
}
