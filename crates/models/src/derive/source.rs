//! What the source of the formal method (Faure 2014) calls elements and laws, and what it counted of them.

use souple_mesh::ElementKind;

use super::MapKind;
use crate::solids::four_loop_count;

/// Operations of the tensor-mass method as it stands in its equations, four loops over the nodes: forces and differential. For the
/// source's two laws on tetrahedra.
pub fn four_loop_operations(kind: ElementKind, law: &str) -> Option<[usize; 2]> {
    match (kind, law) {
        (ElementKind::Tet4, "linear") => Some(four_loop_count(false)),
        (ElementKind::Tet4, "st_venant_kirchhoff") => Some(four_loop_count(true)),
        _ => None,
    }
}

/// The element's name in the source's associations of law, element and cut.
pub fn source_name(kind: ElementKind) -> &'static str {
    match kind {
        ElementKind::Tri3 => "Triangle",
        ElementKind::Quad4 => "Quad",
        ElementKind::Tet4 => "Tetra",
        ElementKind::Hex8 => "Hexa8I",
        ElementKind::Prism6 => "Prism6I",
        ElementKind::Pyramid5 => "Pyramid5I",
        other => other.name(),
    }
}

/// The law's name there: the source has two, others are written in its manner.
pub fn source_law_name(name: &str) -> String {
    match name {
        "linear" => "Hooke".to_owned(),
        "st_venant_kirchhoff" => "SaintVenant".to_owned(),
        other => other
            .split('_')
            .map(|word| {
                word.chars()
                    .next()
                    .map_or(String::new(), |first| first.to_uppercase().chain(word.chars().skip(1)).collect())
            })
            .collect(),
    }
}

/// Grouped constants of an element in the source's tables, uncut, the same for both of its laws.
pub fn source_constant_count(kind: ElementKind, map: MapKind) -> Option<usize> {
    match (kind, map) {
        (ElementKind::Tri3, _) => Some(6),
        (ElementKind::Tet4, _) => Some(11),
        (ElementKind::Hex8, MapKind::Box) => Some(40),
        (ElementKind::Prism6, _) => Some(77),
        (ElementKind::Pyramid5, _) => Some(71),
        _ => None,
    }
}

/// Grouped constants of each fragment of the energy in the source's tables 3.6 and 3.7, cut along law and Gauss points;
/// hexahedra, which are boxes there, along Gauss points alone.
pub fn source_fragment_counts(kind: ElementKind, map: MapKind, law: &str) -> Option<&'static [usize]> {
    match (kind, map, law) {
        (ElementKind::Tri3, _, "linear") => Some(&[5, 7]),
        (ElementKind::Tri3, _, "st_venant_kirchhoff") => Some(&[5, 5]),
        (ElementKind::Tet4, _, "linear") => Some(&[10, 16]),
        (ElementKind::Tet4, _, "st_venant_kirchhoff") => Some(&[10, 10]),
        (ElementKind::Pyramid5, _, "linear") => Some(&[17, 23, 15, 21, 17, 23, 15, 21, 12, 18]),
        (ElementKind::Pyramid5, _, "st_venant_kirchhoff") => Some(&[17, 17, 15, 15, 17, 17, 15, 15, 12, 12]),
        (ElementKind::Prism6, _, "linear") => Some(&[16, 22, 16, 22, 16, 22, 16, 22, 16, 22, 16, 22]),
        (ElementKind::Prism6, _, "st_venant_kirchhoff") => Some(&[16; 12]),
        (ElementKind::Hex8, MapKind::Box, "linear" | "st_venant_kirchhoff") => {
            Some(&[8, 13, 13, 12, 12, 13, 13, 8])
        }
        _ => None,
    }
}
