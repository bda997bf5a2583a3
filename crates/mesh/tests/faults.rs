//! Faulty meshes: each is refused by name, repaired and said, or reported.

use souple_math::Vec3;
use souple_mesh::{CellBlock, ElementKind, Group, Mesh, MeshError, TriangleSurface, generate};
use souple_table::{Value, Values};

fn cube(cells: [f64; 3], element: &'static str) -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector(cells))
        .with("cells", Value::Vector(cells))
        .with("element", Value::Text(element));
    generate("box", values).unwrap()
}

/// The reference cell of a kind as a mesh.
fn single(kind: ElementKind) -> Mesh {
    let points = kind.element().nodes.iter().map(|node| Vec3::from_array(*node)).collect();
    Mesh::new(points, kind, (0..kind.node_count() as u32).collect())
}

fn volumes() -> impl Iterator<Item = ElementKind> {
    ElementKind::ALL.iter().copied().filter(|kind| kind.dimension() == 3)
}

/// An inverted cell is rewound, is said, and has then its positive volume.
#[test]
fn wrong_winding_is_repaired() {
    for kind in volumes() {
        let mut mesh = single(kind);
        let mirror = kind.mirrored();
        mesh.blocks[0].nodes = mirror.iter().map(|node| u32::from(*node)).collect();
        assert!(mesh.volume() < 0.0);
        let repairs = mesh.validate().unwrap();
        assert_eq!(repairs.rewound_cells, [0]);
        assert!(repairs.messages()[0].contains("cells[0]"));
        assert!((mesh.volume() - kind.element().measure).abs() < 1e-14, "{kind}");
        assert!(mesh.validate().unwrap().messages().is_empty());
    }
}

/// A wedge in the orientation that VTK's documentation draws is an inverted one.
#[test]
fn wedge_of_the_other_convention_is_repaired() {
    let mut mesh = single(ElementKind::Prism6);
    mesh.blocks[0].nodes = vec![0, 2, 1, 3, 5, 4];
    assert_eq!(mesh.validate().unwrap().rewound_cells, [0]);
    assert!(mesh.volume() > 0.0);
}

#[test]
fn flat_and_tangled_cells_are_refused() {
    for kind in volumes() {
        let mut flat = single(kind);
        for point in &mut flat.points {
            point.z = 0.5 * point.x;
        }
        assert!(matches!(flat.validate(), Err(MeshError::FlatCell { cell: 0, .. })), "{kind}");
        let mut point = single(kind);
        point.points.fill(Vec3::X);
        assert!(matches!(point.validate(), Err(MeshError::FlatCell { .. })), "{kind}");
        let mut huge = single(kind);
        for point in &mut huge.points {
            *point = *point * 1e200;
        }
        assert!(huge.validate().is_err(), "{kind}");
    }
    // the order of a voxel, not of a hexahedron
    let mut tangled = single(ElementKind::Hex8);
    tangled.blocks[0].nodes = vec![0, 1, 3, 2, 4, 5, 7, 6];
    let fault = tangled.validate().unwrap_err();
    assert!(matches!(fault, MeshError::TangledCell { .. } | MeshError::FlatCell { .. }), "{fault}");
}

#[test]
fn faulty_lists_are_refused() {
    assert_eq!(Mesh::default().validate(), Err(MeshError::NoPoints));
    let empty = Mesh { points: vec![Vec3::ZERO], ..Mesh::default() };
    assert_eq!(empty.clone().validate(), Err(MeshError::NoCells));

    let good = single(ElementKind::Tet4);
    let with_nodes = |nodes: &[u32]| {
        let mut mesh = good.clone();
        mesh.blocks[0].nodes = nodes.to_vec();
        mesh.validate().unwrap_err()
    };
    let missing = with_nodes(&[0, 1, 2, 9]);
    assert_eq!(missing.to_string(), "cells[0] (tet4) refers to point 9, but the mesh has 4 points");
    assert!(matches!(with_nodes(&[0, 1, 1, 3]), MeshError::DuplicateNode { point: 1, .. }));
    assert!(matches!(with_nodes(&[0, 1, 2, 3, 0]), MeshError::BlockLength { count: 5, .. }));

    for coordinate in [f64::NAN, f64::INFINITY] {
        let mut mesh = good.clone();
        mesh.points[2].y = coordinate;
        assert!(matches!(mesh.validate(), Err(MeshError::PointNotFinite { point: 2, .. })));
    }
    let mut surface_only = good.clone();
    surface_only.blocks = vec![CellBlock { kind: ElementKind::Tri3, nodes: vec![0, 1, 2] }];
    assert_eq!(surface_only.validate().unwrap().loose_points, [3]);
    let mut of_both = good.clone();
    of_both.push_cell(ElementKind::Tri3, &[0, 1, 2]);
    assert!(matches!(of_both.validate(), Err(MeshError::WrongDimension { dimension: 3, .. })));
    let mut facet = good.clone();
    facet.push_facet(ElementKind::Tri3, &[0, 1, 7]);
    assert!(matches!(facet.validate(), Err(MeshError::MissingPoint { list: "facets", point: 7, .. })));

    for (list, group) in [
        ("points", Group { points: vec![4], ..Group::default() }),
        ("cells", Group { cells: vec![1], ..Group::default() }),
        ("facets", Group { facets: vec![0], ..Group::default() }),
    ] {
        let mut mesh = good.clone();
        mesh.groups.insert("clamp".to_owned(), group);
        let fault = mesh.validate().unwrap_err();
        assert!(matches!(&fault, MeshError::GroupOutOfRange { list: l, .. } if *l == list), "{fault}");
    }
}

/// Loose points are reported and can be removed; the groups follow.
#[test]
fn loose_points_are_reported_and_removed() {
    let mut mesh = cube([2.0, 1.0, 1.0], "hex8");
    let count = mesh.points.len() as u32;
    mesh.points.insert(0, Vec3::ZERO);
    mesh.points.push(Vec3::X);
    for node in &mut mesh.blocks[0].nodes {
        *node += 1;
    }
    mesh.groups = [("all".to_owned(), Group { points: (0..count + 2).collect(), ..Group::default() })].into();
    let repairs = mesh.validate().unwrap();
    assert_eq!(repairs.loose_points, [0, count + 1]);
    assert_eq!(repairs.component_count, 1);
    assert!(mesh.remove_loose_points().into_iter().eq(1..=count));
    assert_eq!(mesh.groups["all"].points, (0..count).collect::<Vec<_>>());
    assert!(mesh.validate().unwrap().messages().is_empty());
}

/// Parts are counted, numbered by their first cell.
#[test]
fn separate_parts_are_reported() {
    let mut mesh = cube([1.0, 1.0, 1.0], "hex8");
    let far: Vec<Vec3> = mesh.points.iter().map(|point| *point + Vec3::X * 5.0).collect();
    let shifted: Vec<u32> = mesh.blocks[0].nodes.iter().map(|node| node + 8).collect();
    mesh.points.extend(far);
    mesh.push_cell(ElementKind::Hex8, &shifted);
    let repairs = mesh.validate().unwrap();
    assert_eq!(repairs.component_count, 2);
    assert_eq!(mesh.components(), (vec![0, 1], 2));
    assert!(repairs.messages()[0].contains("2 parts"));
}

/// A hexahedron beside a cube of tetrahedra: the quadrilateral between them meets two triangles.
#[test]
fn quadrilateral_against_triangles_is_reported() {
    let mut mesh = cube([2.0, 1.0, 1.0], "tet4");
    // the first cube becomes a hexahedron: its six tetrahedra are the first six
    let nodes = mesh.blocks[0].nodes.split_off(24);
    let point = |i: u32, j: u32, k: u32| i + 3 * (j + 2 * k);
    let corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)];
    let hexahedron = corners.map(|(i, j, k)| point(i, j, k));
    mesh.blocks = Vec::new();
    mesh.push_cell(ElementKind::Hex8, &hexahedron);
    for tetrahedron in nodes.chunks(4) {
        mesh.push_cell(ElementKind::Tet4, tetrahedron);
    }
    mesh.validate().unwrap();
    let faces = mesh.faces();
    let [split] = faces.split[..] else { panic!("{:?}", faces.split) };
    assert_eq!(split.cell, 0);
    let fault = faces.conforming().unwrap_err();
    assert!(matches!(fault, MeshError::QuadrilateralMeetsTriangles { cell: 0, .. }), "{fault}");
}

/// Three cells on one face.
#[test]
fn face_of_three_cells_is_reported() {
    let mut mesh = single(ElementKind::Tet4);
    mesh.points.extend([Vec3::new(0.0, 0.0, -1.0), Vec3::new(0.1, 0.1, -2.0)]);
    mesh.push_cell(ElementKind::Tet4, &[0, 2, 1, 4]);
    mesh.push_cell(ElementKind::Tet4, &[0, 2, 1, 5]);
    mesh.validate().unwrap();
    let fault = mesh.faces().conforming().unwrap_err();
    assert_eq!(fault, MeshError::FaceUsedTooOften { cells: vec![0, 1, 2], nodes: vec![0, 1, 2] });
}

/// The boundary knows the cells and points of the mesh that it belongs to, and its normals point outward.
#[test]
fn boundary_refers_to_the_mesh() {
    let mesh = cube([2.0, 2.0, 2.0], "pyramid5");
    let surface = mesh.boundary_surface();
    assert_eq!((surface.points.len(), surface.triangles.len()), (26, 48));
    for (point, mesh_point) in surface.points.iter().zip(&surface.mesh_points) {
        assert_eq!(*point, mesh.points[*mesh_point as usize]);
    }
    let middle = mesh.centroid();
    for (triangle, cell) in surface.triangles.iter().zip(&surface.cells) {
        let nodes = mesh.cell(*cell).unwrap().nodes;
        assert!(triangle.iter().all(|point| nodes.contains(&surface.mesh_points[*point as usize])));
    }
    for (point, normal) in surface.points.iter().zip(surface.vertex_normals()) {
        assert!((normal.length() - 1.0).abs() < 1e-15);
        assert!(normal.dot(*point - middle) > 0.0);
    }
    // a corner of the cube, however its faces are cut
    let corner = surface.points.iter().position(|point| *point == Vec3::ZERO).unwrap();
    let expected = Vec3::new(-1.0, -1.0, -1.0) / 3.0_f64.sqrt();
    assert!((surface.vertex_normals()[corner] - expected).length() < 1e-15);
}

#[test]
fn faulty_surfaces_are_refused() {
    let points = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let surface = |triangle| TriangleSurface::new(points.clone(), vec![triangle]);
    assert!(matches!(surface([0, 1, 3]), Err(MeshError::MissingPoint { list: "triangles", .. })));
    assert!(matches!(surface([0, 1, 1]), Err(MeshError::DuplicateNode { .. })));
    assert!(matches!(surface([0, 1, 2]).unwrap().check_closed(), Err(MeshError::OpenSurface { .. })));
    let nan = TriangleSurface::new(vec![Vec3::new(f64::NAN, 0.0, 0.0)], Vec::new());
    assert!(matches!(nan, Err(MeshError::PointNotFinite { .. })));
    assert_eq!(TriangleSurface::new(Vec::new(), Vec::new()), Err(MeshError::NoPoints));
}

/// Edges of elements are those of the faces, without what cuts faces into triangles: of a cube of 2 x 2 x 2 cells six faces
/// of 12 edges, of which those on the 12 sides of the cube, two each, belong to two faces. Curved edges are two pieces.
#[test]
fn edges_are_those_of_elements() {
    for (element, count) in [("hex8", 48), ("hex20", 96), ("tet4", 48 + 24)] {
        let mesh = cube([2.0; 3], element);
        let edges = mesh.boundary_edges();
        assert_eq!(edges.len(), count, "{element}");
        let surface = mesh.boundary_surface();
        assert!(edges.iter().flatten().all(|point| surface.mesh_points.contains(point)), "{element}");
    }
}
