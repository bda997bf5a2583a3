//! Elements of the mesh room as data for the derivation of laws on elements.

use souple_formal::element::{ElementData, RestMap, Sample};
use souple_math::Vec3;
use souple_mesh::{ElementKind, QuadratureRule};

use crate::solids::four_loop_count;

/// Why an element cannot be derived so.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0} has no box map; hex8 and quad4 have one")]
pub struct NoBox(pub ElementKind);

/// How the rest shape is mapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapKind {
    /// By the shape functions: any shape.
    General,
    /// A box along the axes of the world.
    Box,
}

/// The data of an element under a rule of quadrature.
///
/// # Errors
/// Only hexahedra and quadrilaterals can be boxes.
pub fn element_data(kind: ElementKind, rule: &QuadratureRule, map: MapKind) -> Result<ElementData, NoBox> {
    let samples = rule.points.iter().map(|point| {
        let gradients = kind.shape_gradients(point.position).iter().map(|gradient| tidy(*gradient)).collect();
        Sample { position: point.position.to_array(), weight: point.weight, gradients }
    });
    let map = match (map, kind) {
        (MapKind::General, _) => RestMap::Nodes,
        (MapKind::Box, ElementKind::Hex8 | ElementKind::Quad4) => {
            let flat = if kind.dimension() == 2 { 0.0 } else { 1.0 };
            let node_at = |c: f64| {
                let values = kind.shape(Vec3::new(c, c, c * flat));
                values.iter().position(|value| (value - 1.0).abs() < 1e-12).unwrap_or_default()
            };
            RestMap::Box { low: node_at(-1.0), high: node_at(1.0) }
        }
        (MapKind::Box, _) => return Err(NoBox(kind)),
    };
    Ok(ElementData {
        name: source_name(kind).to_owned(),
        dimension: kind.dimension(),
        node_count: kind.node_count(),
        shapes: kind.shape_polynomials(),
        samples: samples.collect(),
        map,
    })
}

/// The rule that a derivation takes where none is named: the source integrates triangles with constant strain by one sample.
pub fn usual_rule(kind: ElementKind) -> &'static QuadratureRule {
    if kind == ElementKind::Tri3 { &kind.rules()[0] } else { kind.default_rule() }
}

/// Operations of the tensor-mass method as it stands in its equations, four loops over the nodes: forces and differential. For the
/// source's two laws on tetrahedra.
pub fn four_loop_operations(kind: ElementKind, law: &str) -> Option<[usize; 2]> {
    match (kind, law) {
        (ElementKind::Tet4, "linear") => Some(four_loop_count(false)),
        (ElementKind::Tet4, "st_venant_kirchhoff") => Some(four_loop_count(true)),
        _ => None,
    }
}

/// What rounding leaves of a zero is a zero: a term that need not be computed.
fn tidy(gradient: Vec3) -> [f64; 3] {
    gradient.to_array().map(|number| if number.abs() < 1e-15 { 0.0 } else { number })
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
