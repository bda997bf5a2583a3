//! Examples of the documentation, compiled and run as documentation tests.

/// A page of `docs/` as the documentation of an empty module.
macro_rules! page {
    ($name:ident, $file:literal) => {
        #[doc = include_str!(concat!("../../docs/", $file))]
        pub mod $name {}
    };
}

page!(how_to_add_a_law, "how-to-add-a-law.md");
