//! Elements of the mesh room as data for the derivation of laws on elements.

mod source;

use souple_formal::element::{ElementData, RestMap, Sample};
use souple_math::Vec3;
use souple_mesh::{ElementKind, QuadratureRule};

pub use source::{
    four_loop_operations, source_constant_count, source_fragment_counts, source_law_name, source_name,
};

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

/// What rounding leaves of a zero is a zero: a term that need not be computed.
fn tidy(gradient: Vec3) -> [f64; 3] {
    gradient.to_array().map(|number| if number.abs() < 1e-15 { 0.0 } else { number })
}
