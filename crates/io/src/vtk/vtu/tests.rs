//! Files as other programs write them: every encoding of the same two tetrahedra and a voxel.

use std::io::Write;

use souple_math::Vec3;
use souple_mesh::{ElementKind, Mesh};

use super::*;
use crate::testing::survives_faults;
use crate::vtk::base64::tests::encode;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Text,
    Inline,
    AppendedRaw,
    AppendedBase64,
}

#[derive(Clone, Copy, Debug)]
struct Style {
    form: Form,
    big: bool,
    wide_header: bool,
    zlib: bool,
    /// The length encoded apart from the data.
    header_apart: bool,
}

/// Numbers of the given width in the given order.
fn bytes_of(values: &[i64], width: usize, big: bool) -> Vec<u8> {
    let number = |value: &i64| {
        let mut bytes = value.to_le_bytes()[..width].to_vec();
        if big {
            bytes.reverse();
        }
        bytes
    };
    values.iter().flat_map(number).collect()
}

/// Header and data of one array.
fn packed(data: &[u8], style: Style) -> (Vec<u8>, Vec<u8>) {
    let width = if style.wide_header { 8 } else { 4 };
    if !style.zlib {
        return (bytes_of(&[data.len() as i64], width, style.big), data.to_vec());
    }
    // blocks of 32 bytes, the last one shorter
    let (mut header, mut packed) = (Vec::new(), Vec::new());
    let blocks: Vec<&[u8]> = data.chunks(32).collect();
    header.extend([blocks.len() as i64, 32, (data.len() % 32) as i64]);
    for block in blocks {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(block).unwrap();
        let block = encoder.finish().unwrap();
        header.push(block.len() as i64);
        packed.extend(block);
    }
    (bytes_of(&header, width, style.big), packed)
}

fn file(style: Style) -> Vec<u8> {
    let coordinates: [f32; 39] = [
        0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 1., 1., 1., // tetrahedra
        2., 0., 0., 3., 0., 0., 2., 1., 0., 3., 1., 0., 2., 0., 1., 3., 0., 1., 2., 1., 1., 3., 1., 1.,
    ];
    let coordinate_bytes = {
        let bits: Vec<i64> = coordinates.iter().map(|coordinate| i64::from(coordinate.to_bits())).collect();
        bytes_of(&bits, 4, style.big)
    };
    let connectivity = [0, 1, 2, 3, 1, 2, 3, 4, 0, 1, 5, 6, 7, 8, 9, 10, 11, 12];
    let offsets = [4, 8, 10, 18];
    let types = [10, 10, 3, 11];
    let material = [7, 8, 0, 8];
    let text = |values: &[i64]| values.iter().map(|value| format!("{value} ")).collect::<String>();
    let coordinate_text = coordinates.iter().map(|coordinate| format!("{coordinate} ")).collect::<String>();
    let integers = |values: &[i64], width| (text(values), bytes_of(values, width, style.big));
    let arrays = [
        ("Points", "Float32", "", 3, (coordinate_text, coordinate_bytes)),
        ("Cells", "Int64", "connectivity", 1, integers(&connectivity, 8)),
        ("Cells", "Int32", "offsets", 1, integers(&offsets, 4)),
        ("Cells", "UInt8", "types", 1, integers(&types, 1)),
        ("CellData", "Int16", "MaterialID", 1, integers(&material, 2)),
    ];
    let (mut sections, mut appended) = (std::collections::BTreeMap::<&str, String>::new(), Vec::new());
    for (section, type_name, name, components, (text, data)) in arrays {
        let (header, data) = packed(&data, style);
        let base64 = if style.header_apart || style.zlib {
            encode(&header) + &encode(&data)
        } else {
            encode(&[header.clone(), data.clone()].concat())
        };
        let head = format!("<DataArray type='{type_name}' Name='{name}' NumberOfComponents='{components}'");
        let entry = match style.form {
            Form::Text => format!("{head} format='ascii'>\n{text}\n</DataArray>\n"),
            Form::Inline => format!("{head} format='binary'>\n  {base64}\n</DataArray>\n"),
            Form::AppendedRaw | Form::AppendedBase64 => {
                let entry = format!("{head} format='appended' offset='{}'/>\n", appended.len());
                match style.form {
                    Form::AppendedRaw => appended.extend([header, data].concat()),
                    _ => appended.extend(base64.bytes()),
                }
                entry
            }
        };
        sections.entry(section).or_default().push_str(&entry);
    }
    let order = if style.big { "BigEndian" } else { "LittleEndian" };
    let header = if style.wide_header { "header_type='UInt64'" } else { "" };
    let compressor = if style.zlib { "compressor='vtkZLibDataCompressor'" } else { "" };
    let body: String =
        sections.iter().map(|(name, content)| format!("<{name}>\n{content}</{name}>\n")).collect();
    let mut bytes = format!(
        "<?xml version='1.0'?>\n<VTKFile type='UnstructuredGrid' version='1.0' byte_order='{order}' {header} \
         {compressor}>\n<UnstructuredGrid>\n<Piece NumberOfPoints='13' NumberOfCells='4'>\n{body}</Piece>\n\
         </UnstructuredGrid>\n"
    )
    .into_bytes();
    if matches!(style.form, Form::AppendedRaw | Form::AppendedBase64) {
        let encoding = if style.form == Form::AppendedRaw { "raw" } else { "base64" };
        bytes.extend(format!("<AppendedData encoding='{encoding}'>\n _").bytes());
        bytes.extend(appended);
        bytes.extend(b"\n</AppendedData>\n");
    }
    bytes.extend(b"</VTKFile>\n");
    bytes
}

fn styles() -> Vec<Style> {
    let mut styles = Vec::new();
    for form in [Form::Text, Form::Inline, Form::AppendedRaw, Form::AppendedBase64] {
        for number in 0..16 {
            let bit = |bit: u32| number >> bit & 1 == 1;
            styles.push(Style { form, big: bit(0), wide_header: bit(1), zlib: bit(2), header_apart: bit(3) });
        }
    }
    styles
}

/// All forms of the same file are the same mesh.
#[test]
fn every_encoding_reads_the_same() {
    let expected = read(&file(styles()[0])).unwrap();
    let mesh = &expected.mesh;
    assert_eq!(
        (mesh.points.len(), mesh.count_of(ElementKind::Tet4), mesh.count_of(ElementKind::Hex8)),
        (13, 2, 1)
    );
    let hexahedron = mesh.cell(2).unwrap();
    assert_eq!(hexahedron.nodes, [5, 6, 8, 7, 9, 10, 12, 11]);
    assert!((mesh.cell_volume(hexahedron) - 1.0).abs() < 1e-14);
    assert_eq!(mesh.groups["MaterialID=8"].cells, [1, 2]);
    assert_eq!(expected.cell_fields[0].values, [7.0, 8.0, 8.0]);
    assert_eq!(expected.notes, ["1 cell of VTK type 3 (no volume, no facet) was left out"]);
    for style in styles() {
        assert_eq!(read(&file(style)).as_ref(), Ok(&expected), "{style:?}");
    }
}

/// A mesh whose groups came from marks is the same after writing and reading: the marks and the group agree.
#[test]
fn groups_of_marks_round_trip() {
    let dataset = read(&file(styles()[0])).unwrap();
    let output = crate::Output { cell_fields: &dataset.cell_fields, ..crate::Output::new(&dataset.mesh) };
    let mut bytes = Vec::new();
    vtu_write::write(&output, &mut bytes).unwrap();
    assert_eq!(read(&bytes).unwrap(), crate::Dataset { notes: Vec::new(), ..dataset });
}

#[test]
fn no_fault_panics_in_any_encoding() {
    for style in styles().into_iter().step_by(5) {
        survives_faults(&format!("{style:?}"), &file(style), read);
    }
}

#[test]
fn faults_name_place_value_and_range() {
    let text = String::from_utf8(file(styles()[0])).unwrap();
    let fault = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        read(text.replacen(from, to, 1).as_bytes()).unwrap_err().to_string()
    };
    assert!(fault("type='UnstructuredGrid'", "type='ImageData'").contains("expected UnstructuredGrid"));
    assert!(
        fault("9 10 11 12", "9 10 11 12 0")
            .contains("the number of values of the array `connectivity` is 19; expected 18 x 1")
    );
    assert!(fault("4 8 10 18", "4 8 7 18").contains("offsets[2] is 7; expected 8 to 18"));
    assert!(fault("10 10 3 11", "10 42 3 11").contains("types[1] is 42"));
    assert!(fault("10 10 3 11", "10 14 3 11").contains("the number of nodes of cell 1 is 4; expected 5"));
    assert!(
        fault("0 1 2 3 1", "0 1 2 13 1")
            .contains("a node of cell 0 is 13; expected a point, of which there are 13")
    );
    assert!(fault("0 1 2 3 1", "0 1 2 -1 1").contains("a node of cell 0 is -1"));
    assert!(fault("0 1 2 3 1", "0 1 2 3x 1").contains("a value of the array `connectivity` is \"3x\""));
    assert!(fault("NumberOfPoints='13'", "NumberOfPoints='14'").contains("is 39; expected 14 x 3"));
    assert!(fault("NumberOfPoints='13'", "NumberOfPoints='9999999999999999999'").contains("is 39; expected"));
    assert!(fault("Name='types'", "Name='kinds'").contains("the array `types` of the cells is missing"));
    assert!(fault("0 0 0 1", "0 0 nan 1").contains("points[0] is NaN"));
    assert!(fault("</Piece>", "</Piece><Piece/>").contains("expected one <Piece>"));
}

/// A header that promises more than there are points for, or more than a file of its length may become, is refused by the header
/// alone: the data behind it are no zlib data, which would be said if they were looked at.
#[test]
fn promises_are_refused_before_they_are_unpacked() {
    let style = Style { form: Form::Inline, big: false, wide_header: true, zlib: true, header_apart: true };
    let text = String::from_utf8(file(style)).unwrap();
    // blocks of 16 MiB, of 4 bytes each in the file
    let array = |blocks: i64| {
        let sizes = std::iter::repeat_n(4, blocks as usize);
        let header: Vec<i64> = [blocks, 1 << 24, 0].into_iter().chain(sizes).collect();
        let data = encode(&bytes_of(&header, 8, false)) + &encode(&b"rest".repeat(blocks as usize));
        format!("<DataArray type='Int8' Name='bomb' format='binary'>{data}</DataArray>")
    };
    let with = |text: &str, array: &str| {
        let changed = text.replace("</CellData>", &format!("</CellData><PointData>{array}</PointData>"));
        read(changed.as_bytes()).unwrap_err().to_string()
    };
    let fault = with(&text, &array(64));
    assert!(
        fault.contains("the number of values of the array `bomb` is 1073741824; expected 13 x 1"),
        "{fault}"
    );
    // a file that says itself to be so large
    let points = format!(
        "<DataArray type='Int8' Name='Points' {}",
        &array(192)["<DataArray type='Int8' Name='bomb' ".len()..]
    );
    let start = text.find("<Points>").unwrap() + "<Points>".len();
    let end = text.find("</Points>").unwrap();
    let large = format!("{}{points}{}", &text[..start], &text[end..])
        .replace("NumberOfPoints='13'", &format!("NumberOfPoints='{}'", 1 << 30));
    let fault = read(large.as_bytes()).unwrap_err().to_string();
    assert!(
        fault.contains(
            "the size of the array `Points` is 25769803776 bytes in memory; expected at most 1073741824"
        ),
        "{fault}"
    );
}

/// Arrays that all claim the same appended bytes are refused before they fill the memory.
#[test]
fn overlapping_appended_arrays_are_refused() {
    let style =
        Style { form: Form::AppendedRaw, big: false, wide_header: true, zlib: false, header_apart: false };
    let bytes = file(style);
    let head_end = bytes.windows(10).position(|window| window == b"</CellData").unwrap();
    let mut more = bytes[..head_end].to_vec();
    let array = "<DataArray type='Float32' Name='x' NumberOfComponents='3' format='appended' offset='0'/>";
    for _ in 0..8 {
        more.extend(array.bytes());
    }
    more.extend(&bytes[head_end..]);
    assert!(read(&more).unwrap_err().found.contains("other arrays have already"));
}

/// A mesh of nothing but edges is one of cells; beside other cells edges are left out, as before.
#[test]
fn meshes_of_edges_come_back() {
    let folder = crate::testing::TemporaryFolder::new("edges");
    let points: Vec<Vec3> = (0..5).map(|k| Vec3::new(f64::from(k), 0.5, 0.0)).collect();
    for (kind, nodes) in
        [(ElementKind::Edge2, vec![0, 1, 1, 4]), (ElementKind::Edge3, vec![0, 2, 1, 2, 4, 3])]
    {
        let mesh = Mesh::new(points.clone(), kind, nodes);
        for name in ["edges.vtu", "edges.vtk"] {
            let path = folder.path(name);
            crate::write_mesh(&path, &mesh).unwrap();
            let (read, notes) = crate::read_mesh(&path).unwrap();
            assert_eq!((&read.blocks, &read.points), (&mesh.blocks, &mesh.points), "{name}: {notes:?}");
        }
    }
}
