//! Files as other programs write them, in every version and encoding, and their faults.

use souple_mesh::{ElementKind, Mesh};

use super::*;
use crate::Output;
use crate::testing::{mixed_mesh, survives_faults};

const VERSION_1: &str = "$NOD\n5\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n50 1 1 1\n$ENDNOD\n$ELM\n3\n\
                         1 4 7 1 4 10 20 30 40\n2 4 0 1 4 20 30 40 50\n3 2 9 1 3 10 20 30\n$ENDELM\n";

const VERSION_2: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\nmade by hand $End\n$EndComments\n\
                         $PhysicalNames\n2\n2 9 \"the lid\"\n3 7 \"core\"\n$EndPhysicalNames\n\
                         $Nodes\n5\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n50 1 1 1\n$EndNodes\n\
                         $Elements\n5\n1 15 2 3 1 10\n2 1 2 3 1 10 20\n3 4 2 7 1 10 20 30 40\n4 4 3 7 1 0 20 30 40 50\n\
                         5 2 2 9 1 10 20 30\n$EndElements\n";

const VERSION_4: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 9 \"the lid\"\n3 7 \"core\"\n\
                         $EndPhysicalNames\n$Entities\n1 0 1 1\n1 0 0 0 1 3\n4 0 0 0 1 1 0 1 9 0\n5 0 0 0 1 1 1 1 7 1 4\n\
                         $EndEntities\n$Nodes\n2 5 10 50\n2 4 1 1\n10\n0 0 0 0.1 0.2\n3 5 0 4\n20\n30\n40\n50\n1 0 0\n\
                         0 1 0\n0 0 1\n1 1 1\n$EndNodes\n$Elements\n3 4 1 5\n0 1 15 1\n1 10\n3 5 4 2\n3 10 20 30 40\n\
                         4 20 30 40 50\n2 4 2 1\n5 10 20 30\n$EndElements\n";

fn names(mesh: &Mesh) -> Vec<&str> {
    mesh.groups.keys().map(String::as_str).collect()
}

#[test]
fn versions_by_hand() {
    let first = read(VERSION_1.as_bytes()).unwrap().mesh;
    assert_eq!(names(&first), ["surface_9", "volume_7"]);
    assert_eq!(first.groups["volume_7"].cells, [0]);
    let tets: Vec<_> = first.cells().map(|cell| cell.nodes.to_vec()).collect();
    assert_eq!(tets, [[0, 1, 2, 3], [1, 2, 3, 4]]);
    for text in [VERSION_2, VERSION_4] {
        let dataset = read(text.as_bytes()).unwrap();
        let mesh = dataset.mesh;
        assert!(dataset.notes.is_empty(), "{:?}", dataset.notes);
        assert_eq!(
            (&mesh.points, &mesh.blocks, &mesh.facet_blocks),
            (&first.points, &first.blocks, &first.facet_blocks)
        );
        assert_eq!(mesh.groups["core"].cells, [0, 1]);
        assert_eq!(mesh.groups["the lid"].facets, [0]);
        assert_eq!(mesh.groups["point_3"].points, [0]);
    }
}

#[test]
fn hand_made_files_survive_faults() {
    for text in [VERSION_1, VERSION_2, VERSION_4] {
        survives_faults("gmsh", text.as_bytes(), read);
    }
}

/// Fields, and the groups of partitioned files, stand in sections of their own: that they are not read is said.
#[test]
fn sections_left_out_are_told() {
    let data = "$NodeData\n1\n\"a\"\n1\n0\n3\n0\n1\n1\n10 0.5\n$EndNodeData\n";
    let periodic = "$Periodic\n0\n$EndPeriodic\n";
    let notes = |text: String| read(text.as_bytes()).unwrap().notes;
    assert!(notes(VERSION_2.to_owned()).is_empty());
    assert_eq!(
        notes(format!("{VERSION_2}{data}{periodic}{data}")),
        ["sections that are not read were left out: $NodeData (2 times), $Periodic"]
    );
    assert_eq!(
        notes(VERSION_4.replacen("$Nodes", "$PartitionedEntities\n0\n$EndPartitionedEntities\n$Nodes", 1)),
        ["sections that are not read were left out: $PartitionedEntities"]
    );
}

/// Lines without a group and curved facets are left out and said; curved cells are refused.
#[test]
fn elements_of_other_kinds() {
    let with = |element: &str| VERSION_2.replace("1 15 2 3 1 10", element);
    let dataset = read(with("1 8 2 0 1 10 20 30").as_bytes()).unwrap();
    assert_eq!(dataset.notes, ["1 element of type 8 (line of 3 nodes) was left out"]);
    let fault = read(with("1 14 2 0 1 10 20 30 40 50 10 20 30 40 50 10 20 30 40").as_bytes()).unwrap_err();
    assert_eq!(fault.found, "14, a pyramid of 14 nodes");
    assert!(read(with("1 99 2 0 1 10").as_bytes()).unwrap_err().expected.contains("4, 11 (tetrahedra)"));
}

#[test]
fn faults_name_line_value_and_range() {
    let fault = |text: &str, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        read(text.replace(from, to).as_bytes()).unwrap_err().to_string()
    };
    let two = VERSION_2;
    assert_eq!(
        fault(two, "2.2 0 8", "4.0 0 8"),
        "line 2: the version of the Gmsh format is 4; expected 1, 2.0 to 2.2, or 4.1"
    );
    assert_eq!(fault(two, "30 0 1 0\n", "30 0 x 0\n"), "line 16: y of node 30 is \"x\"; expected a number");
    assert_eq!(
        fault(two, "30 0 1 0\n", "30 0 inf 0\n"),
        "line 16: y of node 30 is inf; expected a finite number"
    );
    assert_eq!(
        fault(two, "30 0 1 0\n", "20 0 1 0\n"),
        "line 16: node 20 is given twice; expected a different number for each node"
    );
    assert!(fault(two, "10 20 30 40\n", "10 20 30 41\n").contains("a node of element 3 is 41"));
    assert!(fault(two, "$Nodes\n5\n", "$Nodes\n99999999999\n").contains("the rest of the file has room for"));
    assert!(fault(two, "$EndNodes", "$EndNode").contains("expected $EndNodes"));
    assert!(fault(two, "2.2 0 8", "2.2 2 8").contains("0 (text) or 1 (binary)"));
    assert!(
        fault(VERSION_1, "4 10 20 30 40", "5 10 20 30 40")
            .contains("expected 4 for a tetrahedron of 4 nodes")
    );
    assert!(fault(VERSION_4, "2 5 10 50", "2 6 10 50").contains("but the blocks hold 5"));
    assert!(fault(VERSION_4, "$Elements\n3 4 1 5", "$Elements\n3 5 1 5").contains("but the blocks hold 4"));
    let start = VERSION_2.find("$Nodes").unwrap();
    assert!(read(&VERSION_2.as_bytes()[start..]).unwrap_err().expected.contains("$MeshFormat before"));
    let end = VERSION_2.find("$Elements").unwrap();
    assert_eq!(read(&VERSION_2.as_bytes()[..end]).unwrap_err().subject, "the section $Elements");
}

/// Both versions as binary, in both orders of bytes, with runs of elements in version 2.
#[test]
fn binary_in_both_orders() {
    let mesh = mixed_mesh();
    for endian in [Endian::Little, Endian::Big] {
        let mut bytes = Vec::new();
        write::version_4(&Output::new(&mesh), Encoding::Binary(endian), &mut bytes).unwrap();
        assert_eq!(read(&bytes).unwrap().mesh, mesh, "version 4, {endian:?}");
        bytes.clear();
        write::version_2(&Output::new(&mesh), Encoding::Binary(endian), &mut bytes).unwrap();
        assert_eq!(read(&bytes).unwrap().mesh, mesh, "version 2, {endian:?}");
        survives_faults("gmsh 2 binary", &bytes, read);
    }
}

/// A run of two tetrahedra with one head, as Gmsh writes version 2.2.
#[test]
fn binary_runs_of_version_2() {
    let mut bytes = b"$MeshFormat\n2.2 1 8\n".to_vec();
    bytes.extend(1i32.to_le_bytes());
    bytes.extend(b"\n$EndMeshFormat\n$Nodes\n5\n");
    for (tag, point) in
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]].iter().enumerate()
    {
        bytes.extend((tag as i32 + 1).to_le_bytes());
        bytes.extend(point.iter().flat_map(|coordinate: &f64| coordinate.to_le_bytes()));
    }
    bytes.extend(b"\n$EndNodes\n$Elements\n2\n");
    let numbers = [4, 2, 2, 1, 7, 1, 1, 2, 3, 4, 2, 7, 1, 2, 3, 4, 5i32];
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    bytes.extend(b"\n$EndElements\n");
    let mesh = read(&bytes).unwrap().mesh;
    assert_eq!(mesh.count_of(ElementKind::Tet4), 2);
    assert_eq!(mesh.groups["volume_7"].cells, [0, 1]);
    let broken = bytes.len() - 15 - 4;
    assert!(matches!(read(&bytes[..broken]).unwrap_err().place, crate::Place::Byte(_)));
}
