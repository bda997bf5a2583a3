//! The page on adding an element shows the texts of the program.

use std::path::Path;

use souple_mesh::{ElementKind, NodePlace};

/// Every text in Rust on the page stands so in the file of the element or in the table's, and the elements it makes are
/// there.
#[test]
fn the_page_shows_what_is_compiled() {
    let read = |path: &str| {
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path))
            .expect("a file of the project")
    };
    let page = read("../../docs/how-to-add-an-element.md");
    let program: Vec<String> = [
        "src/element/quadrilateral.rs",
        "src/element/hexahedron.rs",
        "src/element/mod.rs",
        "../io/src/vtk/mod.rs",
        "../io/src/gmsh/element_type.rs",
    ]
    .map(read)
    .into();
    let blocks: Vec<&str> =
        page.split("```rust\n").skip(1).map(|rest| rest.split("```").next().unwrap_or_default()).collect();
    assert_eq!(blocks.len(), 7);
    for block in blocks {
        assert!(program.iter().any(|text| text.contains(block)), "not in the program:\n{block}");
    }
    let found = |name: &str| {
        let kind = ElementKind::from_name(name).unwrap();
        (kind.node_count(), kind.last_place(), kind.corners())
    };
    assert_eq!(found("quad9"), (9, NodePlace::Face, ElementKind::Quad4));
    assert_eq!(found("hex27"), (27, NodePlace::Inside, ElementKind::Hex8));
}
