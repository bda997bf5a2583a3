//! What the operators of the formulations make of a mesh.

use serde_json::{Value as Json, json};
use souple_mesh::Mesh;
use souple_models::materials::Lame;
use souple_models::solids::{OperatorQuality, operator_quality};
use souple_table::{Parameter, Range, Value};

use super::parameters;
use crate::command::{Refusal, print_line};

/// V-01's cube.
pub static PARAMETERS: [Parameter; 3] = [
    Parameter::number("mu", "Pa", Range::POSITIVE, "shear modulus").or(Value::Number(7000.0)),
    Parameter::number("lambda", "Pa", Range::NOT_NEGATIVE, "first Lamé parameter").or(Value::Number(20000.0)),
    Parameter::number("density", "kg/m³", Range::POSITIVE, "of the matter").or(Value::Number(1000.0)),
];

pub fn of(mesh: &Mesh, texts: &[String]) -> Result<Vec<OperatorQuality>, Refusal> {
    let known: Vec<&Parameter> = PARAMETERS.iter().collect();
    let values = parameters::values(texts, &known)?;
    parameters::refuse_unknown(&values, &known)?;
    let values = values.completed(&PARAMETERS).map_err(|error| {
        Refusal::request("operators", texts.join(" "), "mu, lambda and density", error.to_string())
    })?;
    let moduli = Lame { mu: values.number("mu"), lambda: values.number("lambda") };
    operator_quality(mesh, moduli, values.number("density")).map_err(|error| {
        Refusal::request("operators", "the mesh", "tet4, or tri3 in one plane", error.to_string())
    })
}

pub fn to_json(found: &[OperatorQuality]) -> Json {
    found
        .iter()
        .map(|quality| {
            json!({
                "operator": quality.operator,
                "asymmetry": quality.asymmetry,
                "grad_div_asymmetry": quality.grad_div_asymmetry,
                "growth_rate": quality.growth_rate,
                "laplacian_error": quality.laplacian_error,
                "grad_div_error": quality.grad_div_error,
                "inner_cross_terms": quality.inner_cross_terms,
                "border_cross_terms": quality.border_cross_terms,
            })
        })
        .collect()
}

pub fn print(found: &[OperatorQuality]) {
    for quality in found {
        print_line(quality.operator);
        let OperatorQuality { asymmetry, growth_rate, laplacian_error, grad_div_error, .. } = quality;
        print_line(format_args!("  |K - Kᵀ|/|K|                       {asymmetry:.3e}"));
        let alone = quality.grad_div_asymmetry;
        print_line(format_args!("  |K - Kᵀ|/|K| of grad div alone     {alone:.3e}"));
        print_line(format_args!("  growth of what is left alone       {growth_rate:.3} 1/s"));
        print_line(format_args!("  error of quadratic fields, Δ       {laplacian_error:.3e}"));
        print_line(format_args!("  error of quadratic fields, grad div {grad_div_error:.3e}"));
        let OperatorQuality { inner_cross_terms, border_cross_terms, .. } = quality;
        print_line(format_args!(
            "  cross terms of Δ, inside and border {inner_cross_terms:.3e} m, {border_cross_terms:.3e} m"
        ));
    }
}
