//! Laws that hold for any mesh and any bytes.

use proptest::prelude::*;
use souple_io::{FORMATS, Field, Output, read_dataset_bytes};
use souple_math::Vec3;
use souple_mesh::{ElementKind, Group, Mesh};

const KINDS: [ElementKind; 4] =
    [ElementKind::Tet4, ElementKind::Hex8, ElementKind::Prism6, ElementKind::Pyramid5];

/// Any mesh: coordinates of any size, cells of all kinds in any order, groups with odd names.
fn meshes() -> impl Strategy<Value = Mesh> {
    let coordinate =
        prop_oneof![-1e3..1e3, -1e-30..1e-30, Just(0.0), Just(-0.0), Just(f64::MAX), Just(5e-324)];
    let points = prop::collection::vec([coordinate.clone(), coordinate.clone(), coordinate], 8..20);
    let cells = prop::collection::vec((0usize..6, any::<u32>()), 0..12);
    let groups =
        prop::collection::btree_map("[a-zä%&<> _.-]{1,8}", prop::collection::vec(any::<u32>(), 0..6), 0..4);
    (points, cells, groups).prop_map(|(points, cells, groups)| {
        let count = points.len() as u32;
        let mut mesh = Mesh { points: points.into_iter().map(Vec3::from_array).collect(), ..Mesh::default() };
        for (kind, start) in cells {
            // node numbers that differ, wherever they begin
            let nodes = |kind: ElementKind| {
                (0..kind.node_count() as u32).map(|k| (start % count + k) % count).collect::<Vec<_>>()
            };
            match kind {
                4 => mesh.push_facet(ElementKind::Tri3, &nodes(ElementKind::Tri3)),
                5 => mesh.push_facet(ElementKind::Quad4, &nodes(ElementKind::Quad4)),
                kind => mesh.push_cell(KINDS[kind], &nodes(KINDS[kind])),
            }
        }
        let (cell_count, facet_count) = (mesh.cell_count() as u32, mesh.facet_count() as u32);
        for (name, members) in groups {
            let list = |count: u32, from: usize| {
                let mut list: Vec<u32> = members
                    .iter()
                    .skip(from)
                    .step_by(3)
                    .filter_map(|member| member.checked_rem(count))
                    .collect();
                list.sort_unstable();
                list.dedup();
                list
            };
            let group =
                Group { points: list(count, 0), cells: list(cell_count, 1), facets: list(facet_count, 2) };
            mesh.groups.insert(name, group);
        }
        mesh
    })
}

proptest! {
    /// What is written comes back as the same bits, numbers and names.
    #[test]
    fn any_mesh_round_trips(mesh in meshes()) {
        for format in ["gmsh", "gmsh_binary", "vtu", "vtk"] {
            let write = FORMATS.find(format).unwrap().build.write.unwrap();
            let mut bytes = Vec::new();
            write(&Output::new(&mesh), &mut bytes).unwrap();
            let back = read_dataset_bytes(format, &bytes).unwrap().mesh;
            let bits = |mesh: &Mesh| mesh.points.iter().flat_map(|p| p.to_array().map(f64::to_bits)).collect::<Vec<_>>();
            prop_assert_eq!(bits(&back), bits(&mesh), "{}", format);
            prop_assert_eq!(back, mesh.clone(), "{}", format);
        }
    }

    /// Fields of any name, width and value come back as the same bits.
    #[test]
    fn any_field_round_trips(name in "[^\u{0}]{0,12}", components in 1usize..5, seed in any::<u64>()) {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::from_array);
        let mesh = Mesh::new(points.to_vec(), ElementKind::Tet4, vec![0, 1, 2, 3]);
        let value = |index: usize| f64::from_bits(seed.rotate_left(index as u32 * 7));
        let finite = |value: f64| if value.is_nan() { 0.5 } else { value };
        let values = (0..4 * components).map(|index| finite(value(index))).collect();
        let fields = [Field::new(format!("x{name}"), components, values)];
        for format in ["vtu", "vtk"] {
            let write = FORMATS.find(format).unwrap().build.write.unwrap();
            let mut bytes = Vec::new();
            write(&Output { point_fields: &fields, ..Output::new(&mesh) }, &mut bytes).unwrap();
            let back = read_dataset_bytes(format, &bytes).unwrap();
            prop_assert_eq!(&back.point_fields[..], &fields[..], "{}", format);
        }
    }

    /// No bytes make a reader panic.
    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        for entry in FORMATS.entries {
            let _ = read_dataset_bytes(entry.name, &bytes);
        }
    }
}
