//! The page on adding an element shows the texts of the program.

use std::path::Path;

use souple_mesh::{ElementKind, NodePlace};

/// Every text in Rust on the page stands so in the file of the element or in the table's, and the element it makes is
/// there.
#[test]
fn the_page_shows_what_is_compiled() {
    let read = |path: &str| {
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path))
            .expect("a file of the project")
    };
    let page = read("../../docs/how-to-add-an-element.md");
    let (element, table) = (read("src/element/triangle.rs"), read("src/element/mod.rs"));
    let blocks: Vec<&str> =
        page.split("```rust\n").skip(1).map(|rest| rest.split("```").next().unwrap_or_default()).collect();
    assert_eq!(blocks.len(), 5);
    for block in blocks {
        assert!(element.contains(block) || table.contains(block), "not in the program:\n{block}");
    }
    let triangle = ElementKind::from_name("tri6").unwrap();
    let found = (triangle.node_count(), triangle.last_place(), triangle.corners());
    assert_eq!(found, (6, NodePlace::Edge, ElementKind::Tri3));
}
