//! Legacy files as other programs write them.

use souple_mesh::ElementKind;

use super::*;
use crate::testing::survives_faults;

const TEXT: &str = "# vtk DataFile Version 3.0\ntwo cells\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0\n\
                    0 1 0 0 0 1 1 1 1\nCELLS 3 14\n4 0 1 2 3\n4 1 2 3 4\n3 0 1 2\nCELL_TYPES 3\n10\n10\n5\n\
                    POINT_DATA 5\nSCALARS heat%20flux double\nLOOKUP_TABLE default\n1 2 3 4 5\nVECTORS v float\n\
                    0 0 0 1 1 1 2 2 2 3 3 3 4 4 4\nMETADATA\nINFORMATION 0\n\nCELL_DATA 3\nFIELD all 2\n\
                    density 1 3 float\n10 20 30\npair 2 3 int\n1 2 3 4 5 6\n";

#[test]
fn text_with_fields() {
    let dataset = read(TEXT.as_bytes()).unwrap();
    assert_eq!((dataset.mesh.count_of(ElementKind::Tet4), dataset.mesh.facet_count()), (2, 1));
    let fields: Vec<_> = dataset.point_fields.iter().chain(&dataset.cell_fields).collect();
    let heads: Vec<_> = fields.iter().map(|field| (field.name.as_str(), field.components)).collect();
    assert_eq!(heads, [("heat flux", 1), ("v", 3), ("density", 1), ("pair", 2)]);
    assert_eq!(dataset.cell_fields[1].values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
}

/// The same in binary (big endian), and as version 5.1 writes it.
fn binary(version_5: bool) -> Vec<u8> {
    let mut bytes = b"# vtk DataFile Version 5.1\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nFIELD FieldData 1\nTIME 1 1 double\n".to_vec();
    bytes.extend(0.5f64.to_be_bytes());
    bytes.extend(b"\nPOINTS 5 double\n");
    let coordinates = [0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 1., 1., 1f64];
    bytes.extend(coordinates.iter().flat_map(|coordinate| coordinate.to_be_bytes()));
    if version_5 {
        bytes.extend(b"\nCELLS 4 11\nOFFSETS vtktypeint64\n");
        bytes.extend([0, 4, 8, 11i64].iter().flat_map(|offset| offset.to_be_bytes()));
        bytes.extend(b"\nCONNECTIVITY vtktypeint64\n");
        bytes.extend([0, 1, 2, 3, 1, 2, 3, 4, 0, 1, 2i64].iter().flat_map(|node| node.to_be_bytes()));
    } else {
        bytes.extend(b"\nCELLS 3 14\n");
        bytes
            .extend([4, 0, 1, 2, 3, 4, 1, 2, 3, 4, 3, 0, 1, 2i32].iter().flat_map(|node| node.to_be_bytes()));
    }
    bytes.extend(b"\nCELL_TYPES 3\n");
    bytes.extend([10, 10, 5i32].iter().flat_map(|number| number.to_be_bytes()));
    bytes.extend(b"\nCELL_DATA 3\nSCALARS stiffness short 1\nLOOKUP_TABLE default\n");
    bytes.extend([1, -2, 3i16].iter().flat_map(|number| number.to_be_bytes()));
    bytes.push(b'\n');
    bytes
}

#[test]
fn binary_of_both_versions() {
    let expected = read(TEXT.as_bytes()).unwrap().mesh;
    for version_5 in [false, true] {
        let dataset = read(&binary(version_5)).unwrap();
        assert_eq!(dataset.mesh, expected);
        assert_eq!(dataset.cell_fields, [Field::new("stiffness", 1, vec![1.0, -2.0, 3.0])]);
    }
}

#[test]
fn polygons() {
    let text = "# vtk DataFile Version 2.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n\
                POLYGONS 2 9\n4 0 1 2 3\n3 0 1 2\n";
    let mesh = read(text.as_bytes()).unwrap().mesh;
    let kinds: Vec<_> = mesh.facets().map(|facet| facet.kind).collect();
    assert_eq!(kinds, [ElementKind::Quad4, ElementKind::Tri3]);
}

#[test]
fn no_fault_panics() {
    survives_faults("text", TEXT.as_bytes(), read);
    survives_faults("binary", &binary(false), read);
    survives_faults("binary 5.1", &binary(true), read);
}

#[test]
fn faults_name_place_value_and_range() {
    let fault = |from: &str, to: &str| {
        assert!(TEXT.contains(from), "{from}");
        read(TEXT.replacen(from, to, 1).as_bytes()).unwrap_err().to_string()
    };
    assert_eq!(
        fault("UNSTRUCTURED_GRID", "RECTILINEAR_GRID"),
        "line 4: the kind of data set is \"RECTILINEAR_GRID\"; expected UNSTRUCTURED_GRID or POLYDATA"
    );
    assert!(fault("ASCII", "TEXT").contains("line 3: the encoding is \"TEXT\"; expected ASCII or BINARY"));
    assert!(fault("float\n0", "half\n0").contains("the type of the points is \"half\""));
    assert!(fault("CELLS 3 14", "CELLS 2 14").contains("the number of cells in the list is 3; expected 2"));
    assert!(fault("CELLS 3 14", "CELLS 3 15").contains("the list of cells is \"CELL_TYPES\""));
    assert!(fault("POINT_DATA 5", "POINT_DATA 6").contains("the number of tuples is 6; expected 5"));
    assert!(fault("POINTS 5 float", "POINTS 5000000 float").contains("room for"));
    assert!(fault("CELL_TYPES 3\n10\n10\n5\n", "").contains("the section CELL_TYPES is missing"));
    assert!(fault("VECTORS", "VECTOR").contains("the section is \"VECTOR\""));
    assert_eq!(encoded_name("a b%"), "a%20b%25");
    assert_eq!(decoded_name(&encoded_name("ä b%")), "ä b%");
}
