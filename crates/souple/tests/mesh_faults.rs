//! Faulty mesh files of every format through the program: cut off, garbage, not finite, flat, tangled, absurd.

use serde_json::Value;

use crate::common::{CUBE, Folder, assert_errors, souple_in};

/// Extensions of the formats that hold volumes and can be written.
const VOLUMES: &[&str] = &["msh", "msh2", "vtu", "vtk"];

/// A mesh file measured by `mesh quality`: the document of a success, or the message of a refusal.
#[track_caller]
fn quality(folder: &Folder, file: &str) -> Result<Value, String> {
    let answer = souple_in(folder.path(), ["mesh", "quality", file, "--json"]);
    assert!(!answer.stderr.contains("panicked"), "{answer:#?}");
    match answer.status {
        Some(0) => Ok(answer.json()),
        Some(2) => {
            assert_errors(&answer.json());
            Err(answer.stderr)
        }
        _ => panic!("{answer:#?}"),
    }
}

fn generate(folder: &Folder, file: &str) -> Vec<u8> {
    let call = ["mesh", "generate", "box", file, "size=1,1,1", "cells=4,1,1", "element=mixed"];
    souple_in(folder.path(), call).ends(0);
    std::fs::read(folder.path().join(file)).expect("the mesh just made")
}

/// A file of any format, cut anywhere, is an error and no smaller mesh.
#[test]
fn cut_off_files_are_refused() {
    let folder = Folder::new("cut");
    let mut accepted = Vec::new();
    for format in VOLUMES {
        let whole = format!("whole.{format}");
        let content = generate(&folder, &whole);
        quality(&folder, &whole).expect("the whole file");
        let length = content.trim_ascii_end().len();
        for part in 0..40 {
            let end = length * part / 40;
            let name = format!("cut.{format}");
            folder.write(&name, &content[..end]);
            match quality(&folder, &name) {
                Ok(mesh) => {
                    accepted.push(format!("{format} cut at {end} of {length}: {} points", mesh["points"]))
                }
                Err(message) => assert!(message.contains(&name), "{message}"),
            }
        }
        // legacy VTK has no end mark: that a cut went through its last number cannot be seen, that the number is
        // missing can
        let last = if *format == "vtk" {
            content[..length].iter().rposition(u8::is_ascii_whitespace).unwrap_or(0)
        } else {
            length - 1
        };
        folder.write(&format!("cut.{format}"), &content[..last]);
        if quality(&folder, &format!("cut.{format}")).is_ok() {
            accepted.push(format!("{format} without its end"));
        }
    }
    assert!(accepted.is_empty(), "{}", accepted.join("\n"));
}

/// Surfaces cut within a line or before their triangles are refused as the shape of a contact.
#[test]
fn cut_off_surfaces_are_refused() {
    let folder = Folder::new("cut_surface");
    let obj = String::from_utf8(generate(&folder, "box.obj")).expect("a text");
    let stl = "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid t\n";
    let scene = |file: &str| {
        let shape = format!(
            "[shapes.wall]\nshape = {{ name = \"closed_surface\", surface = \"{file}\" }}\n[[contacts]]\nbody = \"cube\"\nshape = \"wall\"\n[probes.place]"
        );
        CUBE.replace("[probes.place]", &shape)
    };
    let first_face = obj.find("\nf ").expect("a face") + 1;
    let second_line = obj.find("\nv ").expect("a vertex") + 5;
    let cases: &[(&str, &[u8], &str)] = &[
        ("no_faces.obj", &obj.as_bytes()[..first_face], "no_faces.obj"),
        ("half_vertex.obj", &obj.as_bytes()[..second_line], "half_vertex.obj"),
        ("half_face.obj", &obj.as_bytes()[..first_face + 3], "half_face.obj"),
        ("empty.obj", b"", "empty.obj"),
        ("not_finite.obj", b"v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", "not_finite.obj"),
        ("range.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "range.obj"),
        ("zero.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "zero.obj"),
        ("open.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "open.obj"),
        ("half.stl", &stl.as_bytes()[..stl.len() / 2], "half.stl"),
        ("open.stl", stl.as_bytes(), "open.stl"),
        ("binary.stl", &[0; 84], "binary.stl"),
        ("absurd.stl", &[0xff; 84], "absurd.stl"),
        ("word.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n", "\"zero\"; expected a number"),
        ("loop.stl", b"solid a\nfacet normal 0 0 1\ninner loop\n", "expected outer"),
        ("head.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n", "expected a line end_header"),
        ("encoding.ply", b"ply\nformat morse 1.0\nend_header\n", "\"morse\"; expected ascii"),
        ("type.ply", b"ply\nformat ascii 1.0\nelement vertex 1\nproperty bool x\nend_header\n1\n", "\"bool\""),
        ("no_x.ply", b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float y\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n1\n3 0 0 0\n", "the property x of vertex is missing"),
        ("absurd.ply", b"ply\nformat binary_little_endian 1.0\nelement vertex 99999999999\nproperty double x\nproperty double y\nproperty double z\nelement face 1\nproperty list uint uint vertex_indices\nend_header\n", "99999999999; expected at most"),
        ("list.ply", b"ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty char x\nproperty char y\nproperty char z\nelement face 1\nproperty list uint uint vertex_indices\nend_header\nabc\xff\xff\xff\xff", "4294967295; expected at most"),
        ("no_faces.ply", b"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n", "the number of facets is 0"),
        ("open.ply", b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "open.ply"),
        ("kind.off", b"4OFF\n1 1 0\n", "\"4OFF\"; expected OFF"),
        ("counts.off", b"OFF\n0\n", "the number of facets"),
        ("absurd.off", b"OFF\n99999999999999 1 0\n", "99999999999999; expected at most"),
        ("short.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n", "point 2 of 3 is missing"),
        ("range.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "line 6: a corner of facet 0 is \"3\""),
        ("not_finite.off", b"OFF\n3 1 0\n0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "line 4: z of point 1 is \"inf\""),
        ("line.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "expected 3 or more"),
        ("open.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "open.off"),
        ("model.glb", b"glTF\x02\0\0\0", "is gltf, which cannot be read"),
    ];
    let mut failures = Vec::new();
    for (file, content, words) in cases {
        folder.write(file, content);
        folder.write("scene.toml", scene(file));
        let answer = souple_in(folder.path(), ["run", "scene.toml", "--out", "out"]);
        if answer.status != Some(2) || answer.stderr.contains("panicked") || !answer.stderr.contains(words) {
            failures.push(format!("{file}: {answer:#?}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(!folder.path().join("out").exists());
}

/// Garbage, nothing, a folder, a file that is not there, a name that says nothing: errors for every extension.
#[test]
fn garbage_is_refused() {
    let folder = Folder::new("garbage");
    let mut state = 88_172_645_u32;
    let mut byte = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    let noise: Vec<u8> = (0..500).map(|_| byte()).collect();
    for format in ["msh", "msh2", "vtu", "vtk", "obj", "stl", "ply", "off", "node", "ele"] {
        let contents: [(&str, &[u8]); 5] = [
            ("noise", &noise),
            ("empty", b""),
            ("zeros", &[0; 200]),
            ("prose", b"It was a dark and stormy night; the rain fell in torrents.\n"),
            ("lines", b"\n\n\n\n\n"),
        ];
        for (name, content) in contents {
            let file = format!("{name}.{format}");
            folder.write(&file, content);
            let message = quality(&folder, &file).expect_err(&file);
            // TetGen's reader asks for the points first
            let asked = file.replace(".ele", ".node");
            assert!(
                message.contains(&file) || message.contains(&asked) || message.contains("no cells"),
                "{message}"
            );
        }
        let missing = format!("missing.{format}");
        let asked = missing.replace(".ele", ".node");
        assert!(quality(&folder, &missing).expect_err("a missing file").contains(&asked));
        std::fs::create_dir(folder.path().join(format!("folder.{format}"))).expect("a folder");
        quality(&folder, &format!("folder.{format}")).expect_err("a folder");
    }
    folder.write("mesh.xyz", "1 2 3\n");
    assert!(quality(&folder, "mesh.xyz").expect_err("an unknown extension").contains("xyz"));
    folder.write("mesh", "1 2 3\n");
    quality(&folder, "mesh").expect_err("no extension");
}

/// TetGen's files: each fault with the file, the line, the value.
#[test]
fn faulty_tetgen_files() {
    let folder = Folder::new("tetgen");
    const NODE: &str = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
    const ELE: &str = "1 4 0\n1 1 2 3 4\n";
    let cases: &[(&str, &str, &str)] = &[
        ("4 3 0 0\n1 0 0 0\n", ELE, "line 1 of the .node file: the number of points is 4; expected at most"),
        ("4 2 0 0\n1 0 0\n2 0 1\n3 1 0\n4 1 1\n", ELE, "line 1 of the .node file: the dimension is 2"),
        ("99999999999 3 0 0\n", ELE, "99999999999; expected at most"),
        ("-4 3 0 0\n", ELE, "\"-4\"; expected a whole number of at least 0"),
        ("4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 nan\n", ELE, "line 5 of the .node file: z of point 4"),
        ("4 3 0 0\n1 0 0 0\n2 1 0 0\n2 0 1 0\n4 0 0 1\n", ELE, "the number of a point is 2; expected 3"),
        ("4 3 0 0\n7 0 0 0\n8 1 0 0\n9 0 1 0\n10 0 0 1\n", ELE, "numbered on from 0 or 1"),
        (NODE, "", "the number of tetrahedra is missing"),
        (NODE, "2 4 0\n1 1 2 3 4\n", "tetrahedron 1 of 2 is missing"),
        (NODE, "1 8 0\n1 1 2 3 4\n", "the number of nodes of a tetrahedron is 8; expected 4 or 10"),
        (NODE, "1 4 0\n1 1 2 3 5\n", "line 2 of the .ele file: a corner of tetrahedron 1 is 5"),
        (NODE, "1 4 0\n1 1 2 3 0\n", "is 0; expected a point: 1 to 4"),
        (NODE, "1 4 1\n1 1 2 3 4 x\n", "the region of a tetrahedron is \"x\""),
        (NODE, "1 4 0\n1 1 2 3 3\n", "point 2 twice"),
        ("4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n", ELE, "flat"),
    ];
    for (node, ele, words) in cases {
        folder.write("a.node", node);
        folder.write("a.ele", ele);
        let message = quality(&folder, "a.node").expect_err(words);
        assert!(message.contains(words), "`{words}` is not in {message}");
    }
    folder.write("a.node", NODE);
    folder.write("a.ele", ELE);
    folder.write("a.face", "1 1\n1 1 2 9 1\n");
    assert!(
        quality(&folder, "a.ele")
            .expect_err("a face")
            .contains("line 2 of the .face file: a corner of triangle 1")
    );
    std::fs::remove_file(folder.path().join("a.face")).expect("the file just written");
    assert_eq!(quality(&folder, "a.ele").expect("a good mesh")["points"], 4);
}

/// What a format has no room for is told by `mesh convert`, or refused, and nothing is left behind.
#[test]
fn conversions_tell_what_they_lose() {
    let folder = Folder::new("convert");
    generate(&folder, "mixed.vtu");
    let call = ["mesh", "generate", "box", "tets.vtu", "size=1,1,1", "cells=2,2,2", "element=tet4"];
    souple_in(folder.path(), call).ends(0);
    for (from, to, words) in [
        ("mixed.vtu", "a.stl", "cells: "),
        ("mixed.vtu", "a.ply", "groups"),
        ("mixed.vtu", "a.off", "cells: "),
        ("mixed.vtu", "a.glb", "cells: "),
        ("tets.vtu", "a.node", "groups by name"),
    ] {
        let answer = souple_in(folder.path(), ["mesh", "convert", from, to, "--json"]).ends(0).json();
        assert!(answer["notes"].to_string().contains(words), "{to}: {answer:#}");
    }
    let before = folder.files();
    for (from, to, words) in [
        ("mixed.vtu", "b.ele", "is hex8; expected tet4"),
        ("a.stl", "b.xyz", "no format has the extension `xyz`"),
        ("a.glb", "b.stl", "is gltf, which cannot be read"),
        ("a.stl", "no/such/folder.ply", "its folder is missing"),
    ] {
        let answer = souple_in(folder.path(), ["mesh", "convert", from, to, "--json"]);
        assert!(matches!(answer.status, Some(1 | 2)) && answer.stderr.contains(words), "{answer:#?}");
    }
    assert_eq!(folder.files(), before);
    // a tetrahedral mesh through every format of volumes and back
    let original = quality(&folder, "tets.vtu").expect("a good mesh");
    for file in ["t.msh", "t.msh2", "t.vtk", "t.node"] {
        souple_in(folder.path(), ["mesh", "convert", "tets.vtu", file]).ends(0);
        let mesh = quality(&folder, file).unwrap_or_else(|message| panic!("{message}"));
        for key in ["points", "cells", "volume", "bounds"] {
            assert_eq!(mesh[key], original[key], "{file}: {key}");
        }
    }
}

/// No command writes over what it reads, however the file is named, and be it one of several of its mesh.
#[test]
fn inputs_are_kept() {
    let folder = Folder::new("kept");
    generate(&folder, "mixed.vtu");
    let call = ["mesh", "generate", "box", "tets.node", "size=1,1,1", "cells=2,2,2", "element=tet4"];
    souple_in(folder.path(), call).ends(0);
    std::os::unix::fs::symlink("mixed.vtu", folder.path().join("link.vtu")).expect("a link");
    let read = |file: &str| std::fs::read(folder.path().join(file)).expect("a file");
    let (mixed, ele) = (read("mixed.vtu"), read("tets.ele"));
    for (command, from, to, named) in [
        ("convert", "mixed.vtu", "./mixed.vtu", "mixed.vtu"),
        ("convert", "link.vtu", "mixed.vtu", "mixed.vtu"),
        ("convert", "tets.node", "tets.ele", "tets.ele"),
        ("convert", "tets.ele", "tets.node", "tets.node"),
        ("fill", "mixed.vtu", "link.vtu", "vtu"),
        ("simplify", "mixed.vtu", "mixed.vtu", "mixed.vtu"),
    ] {
        let answer = souple_in(folder.path(), ["mesh", command, from, to]).ends(2);
        assert!(
            answer.stderr.contains("is the file that is read") && answer.stderr.contains(named),
            "{answer:#?}"
        );
    }
    assert!(read("mixed.vtu") == mixed && read("tets.ele") == ele);
}

/// A surface with a hole needs seven points and so 14 triangles, however few are asked for: what is left is told, and so is why.
#[test]
fn simplification_tells_what_it_cannot_do() {
    let folder = Folder::new("simplified");
    souple_in(folder.path(), ["mesh", "fill", "torus", "torus.vtu", "size=0.05"]).ends(0);
    let answer =
        souple_in(folder.path(), ["mesh", "simplify", "torus.vtu", "few.ply", "triangles=4", "--json"])
            .ends(0);
    let answer = answer.json();
    let told = answer["notes"].to_string();
    let left: usize = told
        .split_once(" are more than the 4 asked for: the rest cannot be joined")
        .expect(&told)
        .0
        .rsplit(['"', ' '])
        .next()
        .expect("a number")
        .parse()
        .expect("a number");
    assert!((14..100).contains(&left), "{told}");
    let whole = quality(&folder, "few.ply").expect("a closed surface");
    assert_eq!(whole["facets"], left, "{whole:#}");
    let many =
        souple_in(folder.path(), ["mesh", "simplify", "torus.vtu", "many.ply", "triangles=200", "--json"])
            .ends(0);
    assert!(!many.json()["notes"].to_string().contains("asked for"));
}

/// A legacy VTK text of these points and cells.
fn vtk(points: &[&str], cells: &str, types: &str) -> String {
    let count = types.split_whitespace().count();
    let size = cells.split_whitespace().count();
    let points_text = points.join("\n");
    format!(
        "# vtk DataFile Version 3.0\ntest\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n{points_text}\nCELLS {count} {size}\n{cells}\nCELL_TYPES {count}\n{types}\n",
        points.len()
    )
}

const TET: [&str; 4] = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"];
const HEX: [&str; 8] = ["0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"];

/// Meshes that cannot be computed on are refused in words, by `mesh quality` and in a scene alike.
#[test]
fn meshes_that_cannot_be_computed_on() {
    let folder = Folder::new("meshes");
    let with = |index: usize, point: &'static str| {
        let mut points = TET;
        points[index] = point;
        points
    };
    let good = vtk(&TET, "4 0 1 2 3", "10");
    let msh2 = |nodes: &str, elements: &str| {
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}$EndNodes\n$Elements\n{elements}$EndElements\n"
        )
    };
    let four = "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
    let vtu = |points: &str, cells: &str, coordinates: &str, connectivity: &str, types: &str| {
        format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n<UnstructuredGrid><Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">{coordinates}</DataArray></Points>\n<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">{connectivity}</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">{types}</DataArray></Cells>\n</Piece></UnstructuredGrid></VTKFile>\n"
        )
    };
    let corners = "0 0 0 1 0 0 0 1 0 0 0 1";
    let tangled = ["0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "0.2 0.2 -1", "0 1 1"];
    let cases: Vec<(&str, String, &str)> = vec![
        ("nan.vtk", vtk(&with(1, "nan 0 0"), "4 0 1 2 3", "10"), "finite"),
        ("inf.vtk", vtk(&with(1, "inf 0 0"), "4 0 1 2 3", "10"), "finite"),
        ("word.vtk", vtk(&with(1, "one 0 0"), "4 0 1 2 3", "10"), "one"),
        ("flat.vtk", vtk(&with(3, "1 1 0"), "4 0 1 2 3", "10"), "flat"),
        ("tangled.vtk", vtk(&tangled, "8 0 1 2 3 4 5 6 7", "12"), "cells[0] (hex8)"),
        ("crossed.vtk", vtk(&HEX, "8 0 2 1 3 4 5 6 7", "12"), "cells[0] (hex8)"),
        ("twice.vtk", vtk(&TET, "4 0 1 2 2", "10"), "point 2 twice"),
        ("coincident.vtk", vtk(&with(3, "0 0 0"), "4 0 1 2 3", "10"), "flat"),
        ("range.vtk", vtk(&TET, "4 0 1 2 4", "10"), "4"),
        ("negative.vtk", vtk(&TET, "4 0 1 2 -3", "10"), "-3"),
        ("kind.vtk", vtk(&TET, "4 0 1 2 3", "99"), "99"),
        ("count.vtk", vtk(&TET, "5 0 1 2 3 0", "10"), "5"),
        ("surface.vtk", vtk(&TET, "3 0 1 2", "5"), "no cells"),
        (
            "no_cells.vtk",
            good.replace("CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n", "CELLS 0 0\n\nCELL_TYPES 0\n\n"),
            "no cells",
        ),
        ("absurd_points.vtk", good.replace("POINTS 4", "POINTS 99999999999999"), "line"),
        ("absurd_cells.vtk", good.replace("CELLS 1 5", "CELLS 99999999999999 99999999999999"), "line"),
        ("negative_points.vtk", good.replace("POINTS 4", "POINTS -4"), "-4"),
        ("nan.msh", msh2(&four.replace("2 1 0 0", "2 1 nan 0"), "1\n1 4 2 0 1 1 2 3 4\n"), "nan"),
        ("flat.msh", msh2(&four.replace("4 0 0 1", "4 1 1 0"), "1\n1 4 2 0 1 1 2 3 4\n"), "flat"),
        ("missing_node.msh", msh2(four, "1\n1 4 2 0 1 1 2 3 9\n"), "9"),
        ("same_node.msh", msh2(&four.replace("4 0 0 1", "3 0 0 1"), "1\n1 4 2 0 1 1 2 3 3\n"), "3"),
        ("kind.msh", msh2(four, "1\n1 99 2 0 1 1 2 3 4\n"), "99"),
        ("absurd.msh", msh2(&four.replacen('4', "99999999999999", 1), "1\n1 4 2 0 1 1 2 3 4\n"), "line"),
        ("version.msh", msh2(four, "1\n1 4 2 0 1 1 2 3 4\n").replace("2.2 0 8", "7.7 0 8"), "7.7"),
        ("tags.msh", msh2(four, "1\n1 4 99999999 0 1 1 2 3 4\n"), "line"),
        ("nan.vtu", vtu("4", "1", "0 0 0 1 nan 0 0 1 0 0 0 1", "0 1 2 3", "10"), "nan"),
        ("range.vtu", vtu("4", "1", corners, "0 1 2 9", "10"), "9"),
        ("kind.vtu", vtu("4", "1", corners, "0 1 2 3", "77"), "77"),
        ("short.vtu", vtu("4", "1", "0 0 0 1 0 0 0 1 0", "0 1 2 3", "10"), "short.vtu"),
        ("absurd.vtu", vtu("99999999999999", "1", corners, "0 1 2 3", "10"), "absurd.vtu"),
        ("absurd_cells.vtu", vtu("4", "99999999999999", corners, "0 1 2 3", "10"), "absurd_cells.vtu"),
        ("overflow.vtu", vtu("18446744073709551615", "1", corners, "0 1 2 3", "10"), "overflow.vtu"),
        ("xml.vtu", vtu("4", "1", corners, "0 1 2 3", "10").replace("</Points>", "</Point>"), "xml.vtu"),
        ("piece.vtu", vtu("4", "1", corners, "0 1 2 3", "10").replace("Piece", "Peace"), "piece.vtu"),
    ];
    assert!(quality(&folder, "nothing.vtk").is_err());
    folder.write("good.vtk", good);
    folder.write("good.msh", msh2(four, "1\n1 4 2 0 1 1 2 3 4\n"));
    folder.write("good.vtu", vtu("4", "1", corners, "0 1 2 3", "10"));
    for file in ["good.vtk", "good.msh", "good.vtu"] {
        let mesh = quality(&folder, file).unwrap_or_else(|message| panic!("{file}: {message}"));
        assert_eq!((&mesh["points"], &mesh["cells"]["tet4"]), (&4.into(), &1.into()), "{file}");
    }
    let mut failures = Vec::new();
    let generated = "generate = \"box\", size = [1, 1, 1], cells = [2, 2, 2], element = \"hex8\"";
    for (file, content, words) in &cases {
        folder.write(file, content);
        match quality(&folder, file) {
            // triangles alone have a quality, and make no body
            Ok(mesh) if *file == "surface.vtk" && mesh["triangles"] == 1 => {}
            Ok(mesh) => failures.push(format!("{file}: accepted: {mesh}")),
            Err(message) if !message.contains(words) => {
                failures.push(format!("{file}: no `{words}` in {message}"))
            }
            Err(_) => {}
        }
        folder.write("scene.toml", CUBE.replace(generated, &format!("file = \"{file}\"")));
        let answer = souple_in(folder.path(), ["run", "scene.toml", "--out", "out"]);
        if answer.status != Some(2) || !answer.stderr.contains(words) || answer.stderr.contains("panicked") {
            failures.push(format!("{file} in a scene: {answer:#?}"));
        }
    }
    assert!(failures.is_empty(), "{} of {}:\n{}", failures.len(), cases.len(), failures.join("\n"));
    assert!(!folder.path().join("out").exists());
}

/// What can be repaired is, and is said: inverted cells are rewound, loose points and separate parts told.
#[test]
fn repairs_are_told() {
    let folder = Folder::new("repairs");
    let second = ["5 0 0", "6 0 0", "5 1 0", "5 0 1"];
    folder.write("inverted.vtk", vtk(&TET, "4 0 2 1 3", "10"));
    folder.write("loose.vtk", vtk(&[&TET[..], &["9 9 9"]].concat(), "4 0 1 2 3", "10"));
    folder.write("parts.vtk", vtk(&[&TET[..], &second].concat(), "4 0 1 2 3\n4 4 5 6 7", "10 10"));
    for (file, words) in
        [("inverted.vtk", "inverted"), ("loose.vtk", "belongs to no cell"), ("parts.vtk", "2 parts")]
    {
        let mesh = quality(&folder, file).unwrap_or_else(|message| panic!("{file}: {message}"));
        assert!(mesh["notes"].to_string().contains(words), "{file}: {mesh:#}");
        assert!(mesh["volume"].as_f64().is_some_and(|volume| volume > 0.0), "{file}: {mesh:#}");
        let generated = "generate = \"box\", size = [1, 1, 1], cells = [2, 2, 2], element = \"hex8\"";
        folder.write("scene.toml", CUBE.replace(generated, &format!("file = \"{file}\"")));
        let answer = souple_in(folder.path(), ["run", "scene.toml", "--json"]).ends(0);
        let report = answer.json();
        assert!(report["warnings"].to_string().contains(words), "{file}: {report:#}");
        // a loose point has no mass and would fall through every law: it is left out
        let points = if file == "parts.vtk" { 8 } else { 4 };
        assert_eq!(report["counts"]["points"], points, "{file}");
    }
}

/// Three cells on one face overlap: `quality` says which, and that the mesh does not conform.
#[test]
fn overlapping_cells_are_told() {
    let folder = Folder::new("overlap");
    let points = ["0 0 0", "1 0 0", "0 1 0", "0 0 1", "0 0 2", "0 0 3"];
    folder.write("thrice.vtk", vtk(&points, "4 0 1 2 3\n4 0 1 2 4\n4 0 1 2 5", "10 10 10"));
    let mesh = quality(&folder, "thrice.vtk").unwrap_or_else(|message| panic!("{message}"));
    assert_eq!(mesh["conforming"], false);
    assert!(mesh["problem"].to_string().contains("cells[0] and cells[1] overlap"), "{mesh:#}");
    assert!(mesh["notes"].to_string().contains("is used 3 times"), "{mesh:#}");
}

/// Meshes that do not conform: overlapping cells are refused by scenes, cracks and hanging points are told.
#[test]
fn meshes_that_do_not_conform() {
    let folder = Folder::new("conformity");
    let generated = "generate = \"box\", size = [1, 1, 1], cells = [2, 2, 2], element = \"hex8\"";
    let scene = |file: &str| {
        folder.write("scene.toml", CUBE.replace(generated, &format!("file = \"{file}\"")));
        souple_in(folder.path(), ["check", "scene.toml"])
    };
    // the fifth point stands on the wrong side of the common face
    let through = ["0 0 0", "1 0 0", "0 1 0", "0 0 1", "0.1 0.1 0.5"];
    folder.write("inverted.vtk", vtk(&through, "4 0 1 2 3\n4 0 2 1 4", "10 10"));
    let answer = scene("inverted.vtk").ends(2);
    assert!(
        answer.stderr.contains("overlap") && answer.stderr.contains("cells[1] is inverted"),
        "{answer:#?}"
    );
    // two tetrahedra face to face whose three common points are there twice
    let twice = ["0 0 0", "1 0 0", "0 1 0", "0 0 1", "0 0 0", "1 0 0", "0 1 0", "0 0 -1"];
    folder.write("crack.vtk", vtk(&twice, "4 0 1 2 3\n4 4 6 5 7", "10 10"));
    let answer = scene("crack.vtk").ends(0);
    assert!(answer.stderr.contains("3 pairs of points coincide"), "{answer:#?}");
    let sliver = ["0 0 0", "1 0 0", "0 1 0", "0.3 0.3 1e-5"];
    folder.write("sliver.vtk", vtk(&sliver, "4 0 1 2 3", "10"));
    assert!(scene("sliver.vtk").stderr.contains("nearly no volume"));
}

/// A mesh with any byte changed is accepted or refused, never a panic.
#[test]
fn damaged_files_do_not_panic() {
    let folder = Folder::new("damaged_meshes");
    for format in VOLUMES {
        let content = generate(&folder, &format!("whole.{format}"));
        let file = format!("damaged.{format}");
        for part in 0..60 {
            let at = content.len() * part / 60;
            for byte in [b'9', b'-', b'<', 0xff] {
                let mut damaged = content.clone();
                damaged[at] = byte;
                folder.write(&file, damaged);
                // refusals and successes are both in order; `quality` itself asserts that nothing else happens
                let _ = quality(&folder, &file);
            }
        }
    }
}
