//! Elements of the mesh room as data for the derivation of laws on elements.

mod kernels;
mod source;

use souple_formal::element::{ElementData, RestMap, Sample};
use souple_math::Vec3;
use souple_mesh::{ElementKind, QuadratureRule};

pub use kernels::{element_kernel, law_kernel};
pub use source::{
    four_loop_operations, source_constant_count, source_fragment_counts, source_law_name, source_name,
};

/// Why an element cannot be derived so.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{kind} has no box map; {boxes} have one", kind = .0, boxes = with_box())]
pub struct NoBox(pub ElementKind);

/// Names of the elements that can be boxes.
fn with_box() -> String {
    let boxes = ElementKind::ALL.iter().filter(|kind| kind.box_corners().is_some());
    boxes.map(|kind| kind.name()).collect::<Vec<_>>().join(" and ")
}

/// How the rest shape is mapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapKind {
    /// By the shape functions: any shape.
    General,
    /// A box along the axes of the world.
    Box,
}

/// The data of an element under a rule of quadrature.
///
/// # Errors
/// The element can be no box.
pub fn element_data(kind: ElementKind, rule: &QuadratureRule, map: MapKind) -> Result<ElementData, NoBox> {
    let samples = rule.points.iter().map(|point| {
        let gradients = kind.shape_gradients(point.position).iter().map(|gradient| tidy(*gradient)).collect();
        Sample { position: point.position.to_array(), weight: point.weight, gradients }
    });
    let map = match map {
        MapKind::General => RestMap::Nodes,
        MapKind::Box => {
            let [low, high] = kind.box_corners().ok_or(NoBox(kind))?;
            RestMap::Box { low, high }
        }
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

/// What rounding leaves of a zero is a zero: a term that need not be computed.
fn tidy(gradient: Vec3) -> [f64; 3] {
    gradient.to_array().map(|number| if number.abs() < 1e-15 { 0.0 } else { number })
}
