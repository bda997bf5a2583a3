//! The files that a scene is read from, and the hash over them.

use std::fs;
use std::path::{Path, PathBuf};

use souple_mesh::ElementKind;
use souple_scene::{Scene, read_file};

/// A folder of its own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("souple_{name}_{}", std::process::id()));
        fs::create_dir_all(path.join("parts")).expect("a folder");
        Self(path)
    }

    fn write(&self, name: &str, content: &str) {
        fs::write(self.0.join(name), content).expect("a file");
    }

    fn scene(&self) -> Scene {
        read_file(&self.0.join("scene.toml"), &[]).unwrap_or_else(|errors| panic!("{errors}"))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // what cannot be removed from a temporary folder does no harm
        let _ = fs::remove_dir_all(&self.0);
    }
}

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

const SCENE: &str = r#"
format = 1
include = ["parts/world.toml"]
[bodies.bar]
mesh = "bar.msh"
material = { name = "neo_hookean", youngs_modulus = "10 kPa", poissons_ratio = 0.3, density = 1000 }
[shapes.rock]
shape = { name = "closed_surface", surface = "rock.obj" }
[[contacts]]
name = "left"
body = "bar"
region = "x_min"
shape = "rock"
[[contacts]]
name = "right"
body = "bar"
region = "x_max"
shape = "rock"
"#;

fn write_bar(path: &Path) {
    let values = souple_table::Values::new()
        .with("size", souple_table::Value::Vector([1.0, 1.0, 1.0]))
        .with("cells", souple_table::Value::Vector([1.0, 1.0, 1.0]))
        .with("element", souple_table::Value::Text(ElementKind::Hex8.name()));
    let mesh = souple_mesh::generate("bar", values).expect("a bar");
    souple_io::write_mesh(path, &mesh).expect("a mesh file");
}

/// Every file is listed once, in the order it was read, and a change in any of them changes the hash of the scene.
#[test]
fn all_files_are_listed_and_hashed() {
    let folder = Folder::new("files");
    folder.write("scene.toml", SCENE);
    folder.write("parts/world.toml", "[world]\nperiod = \"10 ms\"\n");
    folder.write("rock.obj", TETRAHEDRON);
    write_bar(&folder.0.join("bar.msh"));
    let scene = folder.scene();
    let texts = scene.inputs.texts.iter().map(|text| PathBuf::from(&text.name));
    let listed: Vec<PathBuf> = texts.chain(scene.inputs.files.iter().map(|file| file.path.clone())).collect();
    let expected = ["scene.toml", "parts/world.toml", "bar.msh", "rock.obj"];
    assert_eq!(listed, expected.map(|name| folder.0.join(name)));
    assert!(scene.inputs.files.iter().all(|file| file.sha256.len() == 64));
    assert_eq!(scene.scene_sha256, folder.scene().scene_sha256);
    let mut hashes = vec![scene.scene_sha256];
    for (name, content) in [
        ("parts/world.toml", "[world]\nperiod = \"20 ms\"\n".to_owned()),
        ("rock.obj", TETRAHEDRON.replace("v 0 0 1", "v 0 0 2")),
        ("scene.toml", SCENE.replace("10 kPa", "20 kPa")),
    ] {
        folder.write(name, &content);
        hashes.push(folder.scene().scene_sha256);
    }
    let count = hashes.len();
    hashes.sort();
    hashes.dedup();
    assert_eq!(hashes.len(), count, "{hashes:?}");
}

/// A tool in millimetres is told, and scaled is not; one that passes through itself is told.
#[test]
fn tools_of_files_are_looked_at() {
    let folder = Folder::new("tools");
    folder.write("parts/world.toml", "[world]\nperiod = \"10 ms\"\n");
    write_bar(&folder.0.join("bar.msh"));
    let crossed =
        "v 0.2 0.2 0.2\nv 2 0.2 0.2\nv 0.2 2 0.2\nv 0.2 0.2 2\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n";
    let said = |rock: &str, scale: &str| {
        folder.write("scene.toml", &SCENE.replace("\"rock.obj\"", &format!("\"rock.obj\"{scale}")));
        folder.write("rock.obj", rock);
        let warnings = folder.scene().warnings;
        // it is in the bar, which is no matter of files
        let of_file = |text: &String| text.contains("shape `rock`") && !text.contains("starts inside");
        warnings.into_iter().filter(of_file).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(said(TETRAHEDRON, ""), "");
    let millimetres = TETRAHEDRON.replace("v 1 ", "v 100 ");
    assert!(said(&millimetres, "").contains("scale=0.001"));
    assert_eq!(said(&millimetres, ", scale = 0.01"), "");
    assert!(said(&format!("{TETRAHEDRON}{crossed}"), "").contains("pass through each other"));
}

/// A mesh kept in several files is listed with all of them, and a change in any changes the hash of the scene.
#[test]
fn all_parts_of_a_mesh_are_listed() {
    let folder = Folder::new("parts");
    let body = "mesh = \"bar.node\"\nmaterial = { name = \"neo_hookean\", youngs_modulus = \"10 kPa\", poissons_ratio = 0.3, density = 1000 }";
    folder.write("scene.toml", &format!("format = 1\n[world]\nperiod = \"10 ms\"\n[bodies.bar]\n{body}\n"));
    let [node, ele] = ["4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", "1 4 0\n1 1 2 3 4\n"];
    folder.write("bar.node", node);
    folder.write("bar.ele", ele);
    let scene = folder.scene();
    let listed: Vec<PathBuf> = scene.inputs.files.iter().map(|file| file.path.clone()).collect();
    assert_eq!(listed, ["bar.node", "bar.ele"].map(|name| folder.0.join(name)));
    folder.write("bar.ele", &format!("# the same mesh in another file\n{ele}"));
    assert_ne!(folder.scene().scene_sha256, scene.scene_sha256);
    folder.write("bar.face", "0 0\n");
    assert_eq!(folder.scene().inputs.files.len(), 3);
}

/// Points of cells that are split have the numbers after all those of the file, of points too that no cell has.
#[test]
fn points_of_split_cells_are_numbered_after_the_file() {
    let folder = Folder::new("split");
    let body = "mesh = \"bar.node\"\nsplit = {}\nmaterial = { name = \"neo_hookean\", youngs_modulus = \"10 kPa\", poissons_ratio = 0.3, density = 1000 }";
    folder.write("scene.toml", &format!("format = 1\n[world]\nperiod = \"10 ms\"\n[bodies.bar]\n{body}\n"));
    folder.write("bar.node", "5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 2 2 2\n");
    folder.write("bar.ele", "1 4 0\n1 1 2 3 4\n");
    assert_eq!(folder.scene().bodies[0].mesh.points.len(), 10);
    let pinned = |number: u32| {
        let pin = format!("bodies.bar.pins=[{{ region = {{ points = [{number}] }} }}]");
        read_file(&folder.0.join("scene.toml"), &[pin]).is_ok()
    };
    // four corners, one that is loose, and six middles
    assert_eq!([3, 4, 5, 10, 11].map(pinned), [true, false, true, true, false]);
}
