//! What is derived from a law: its energy, its stress and the differential of that, written out and counted.

use serde_json::{Value, json};
use souple_formal::emit::{Text, write};
use souple_formal::graph::{Expr, Graph};
use souple_formal::law::{Block, EnergyLaw};

/// One expression of a law.
pub struct Step {
    what: &'static str,
    symbol: &'static str,
    /// Lines that name parts of the result, in order.
    parts: Vec<String>,
    result: String,
    operations: usize,
}

impl Step {
    /// Energy, stress, differential.
    pub fn all(law: &EnergyLaw) -> [Self; 3] {
        [
            ("energy", "Psi", law.energy),
            ("stress, dPsi/dF", "P", law.stress),
            ("its differential along dF", "dP", law.differential),
        ]
        .map(|(what, symbol, expr)| Self::of(&law.graph, what, symbol, expr))
    }

    /// The stiffness between two nodes, of laws of tensors.
    pub fn block(law: &EnergyLaw) -> Option<Self> {
        let Block { graph, stiffness, .. } = law.block()?;
        let what = "stiffness between nodes whose shape functions have the gradients g_a and g_b, K u = (dP/dF : u g_b') g_a";
        Some(Self::of(&graph, what, "K", stiffness))
    }

    fn of(graph: &Graph, what: &'static str, symbol: &'static str, expr: Expr) -> Self {
        let (parts, mut roots) = write(graph, &[expr], &Text);
        let operations = graph.operations(&[expr], |_| false).total();
        Self { what, symbol, parts, result: roots.remove(0), operations }
    }

    pub fn to_text(&self) -> String {
        let parts: String = self.parts.iter().map(|part| format!("    {part}\n")).collect();
        format!(
            "{} ({} operations)\n{parts}  {} = {}\n",
            self.what, self.operations, self.symbol, self.result
        )
    }

    pub fn to_json(&self) -> Value {
        json!({ "parts": self.parts, "result": self.result, "operations": self.operations })
    }
}
