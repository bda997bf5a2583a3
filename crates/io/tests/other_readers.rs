//! What we write is read by others: Python's `meshio` and `vtk`, the readers of ParaView.
//!
//! Runs where `SOUPLE_PYTHON` names a Python that has them; elsewhere says so and passes.

use std::path::Path;
use std::process::Command;

use souple_io::{FORMATS, Field, Output, Series, write_dataset_as};
use souple_math::Vec3;
use souple_mesh::{ElementKind, Group, Mesh, generate};
use souple_table::{Value, Values};

fn tetrahedra() -> Mesh {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
    let mut mesh = Mesh { points: points.map(Vec3::from_array).to_vec(), ..Mesh::default() };
    mesh.push_cell(ElementKind::Tet4, &[0, 1, 2, 3]);
    mesh.push_cell(ElementKind::Tet4, &[1, 2, 3, 4]);
    // one cell has a group and one has none: readers that list the group of each block want one of all
    mesh.groups.insert("first".to_owned(), Group { cells: vec![0], ..Group::default() });
    mesh
}

/// Four cubes of cells of several kinds, linear or quadratic.
fn of_kinds(element: &'static str) -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector([2.0, 1.0, 0.5]))
        .with("cells", Value::Vector([4.0, 1.0, 1.0]))
        .with("element", Value::Text(element));
    let mut mesh = generate("box", values).expect("a box");
    // cells alone: other programs count facets among them
    mesh.facet_blocks.clear();
    mesh.groups.clear();
    mesh
}

/// Reads every file it is given and prints `name points cells volume`, the volume as VTK has it, who knows the order of nodes.
const SCRIPT: &str = r#"
import sys
import meshio
import vtk

VTK_READERS = {
    "vtu": vtk.vtkXMLUnstructuredGridReader, "vtk": vtk.vtkUnstructuredGridReader, "ply": vtk.vtkPLYReader,
    "obj": vtk.vtkOBJReader, "stl": vtk.vtkSTLReader, "glb": vtk.vtkGLTFReader,
}
def volume(data, of_cell=lambda volume: volume):
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(data)
    sizes.Update()
    volumes = sizes.GetOutput().GetCellData().GetArray("Volume")
    return sum(of_cell(volumes.GetValue(cell)) for cell in range(volumes.GetNumberOfTuples()))

for path in sys.argv[1:]:
    extension = path.rsplit(".", 1)[1]
    if extension in VTK_READERS:
        reader = VTK_READERS[extension]()
        reader.SetFileName(path)
        reader.Update()
        data = reader.GetOutput()
        if extension == "glb":
            while data.IsA("vtkMultiBlockDataSet"):
                data = data.GetBlock(0)
        print(path, data.GetNumberOfPoints(), data.GetNumberOfCells(), volume(data))
    else:
        mesh = meshio.read(path)
        meshio.write(path + ".again.vtu", meshio.Mesh(mesh.points, mesh.cells))
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(path + ".again.vtu")
        reader.Update()
        # wedges of Gmsh are those of VTK in a mirror, and meshio writes them as they are
        cells = sum(len(block.data) for block in mesh.cells)
        print(path, len(mesh.points), cells, volume(reader.GetOutput(), abs))
"#;

#[test]
fn other_programs_read_what_we_write() {
    let Some(python) = std::env::var_os("SOUPLE_PYTHON") else {
        println!("SOUPLE_PYTHON is not set: not checked");
        return;
    };
    let folder = std::env::temp_dir().join(format!("souple-io-others-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder of temporary files");
    let mesh = tetrahedra();
    let fields = [Field::new("speed", 1, vec![0.0, 1.0, 2.0, 3.0, 4.0])];
    let mut files = Vec::new();
    for entry in FORMATS.entries {
        // TetGen and Gmsh have several names of one extension each
        let extension = match entry.name {
            "tetgen" => "ele",
            "gmsh_2" | "gmsh_binary" => "msh",
            "ply_text" => "ply",
            "stl_text" => "stl",
            _ => entry.build.extensions[0],
        };
        let path = folder.join(format!("{}.{extension}", entry.name));
        let fields: &[Field] = if entry.name.starts_with("gmsh") { &[] } else { &fields };
        let output = Output { point_fields: fields, ..Output::new(&mesh) };
        write_dataset_as(entry.name, &path, &output).expect("the file is written");
        // the boundary of two tetrahedra that share a face: six triangles of five points
        let cells = if entry.build.holds.is_surface() { 6 } else { 2 };
        files.push((path.clone(), [5, cells]));
        // what holds several kinds of cells, or middles of edges
        for element in ["mixed", "tet10", "hex20", "hex27", "prism15", "pyramid13", "mixed_quadratic"] {
            // meshio 5.3 has the order of nodes of quadratic wedges and pyramids and not their dimension: no file with one can be read
            if extension == "msh" && ["prism15", "pyramid13", "mixed_quadratic"].contains(&element) {
                continue;
            }
            let mesh = of_kinds(element);
            let path = folder.join(format!("{}_{element}.{extension}", entry.name));
            if entry.build.holds.is_surface()
                || write_dataset_as(entry.name, &path, &Output::new(&mesh)).is_err()
            {
                // a format of tetrahedra alone
                assert!(entry.build.holds.is_surface() || entry.name == "tetgen", "{} {element}", entry.name);
                continue;
            }
            files.push((path, [mesh.points.len(), mesh.cell_count()]));
        }
    }
    let mut series = Series::new(&folder, "series");
    series.push(0.0, &Output::new(&mesh)).expect("a frame");
    files.push((folder.join("series_0000.vtu"), [5, 2]));
    let output = Command::new(python).arg("-c").arg(SCRIPT).args(files.iter().map(|file| &file.0)).output();
    let output = output.expect("the Python of SOUPLE_PYTHON runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{text}\n{}", String::from_utf8_lossy(&output.stderr));
    for (path, cells) in &files {
        let line = text.lines().find(|line| line.starts_with(&path.display().to_string()));
        let numbers: Vec<f64> =
            line.unwrap_or_default().split_whitespace().skip(1).filter_map(|n| n.parse().ok()).collect();
        let counts = cells.map(|count| count as f64);
        assert_eq!(numbers.get(..2), Some(&counts[..]), "{}\n{text}", name(path));
        // the box: an order of nodes that is another turns cells inside out, or bends their straight edges
        if counts[0] > 5.0 {
            assert!((numbers[2] - 1.0).abs() < 1e-9, "{}: {numbers:?}", name(path));
        }
    }
    // what cannot be removed from a folder of temporary files does no harm
    let _ = std::fs::remove_dir_all(&folder);
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
