//! Hyperelastic laws as text: an energy density of the deformation gradient, from which stress and tangent are derived.
//!
//! The text is read into a [`Graph`] with what the law language knows beside numbers (`C`, `I1`, `J`, fibre
//! directions, …, see `vocabulary.rs`), with units checked on the way; then `P = ∂Ψ/∂F` and `δP = ∂P/∂F : δF` are derived.
//! Before a law is handed out it has been tried: a value, no stress and a slope at rest, objectivity.

mod block;
mod calls;
mod check;
mod continued;
mod domain;
mod error;
mod evaluate;
mod expanded;
mod operators;
mod read;
mod value;
mod vocabulary;

pub use block::Block;
pub use continued::SMALLEST_VOLUME;
pub use error::{LawError, LawProblem, UnitClash, WantedUnits};
pub use expanded::{Expanded, Expansion};
pub use vocabulary::{LAW_FUNCTIONS, QUANTITIES, Word};

use crate::graph::{Expr, Graph, Grouped, Node, Shape};
use crate::{Dimension, Expression, NodeKind};

/// A law as written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LawText {
    /// `Ψ`, energy per volume of the rest shape [J/m³ = Pa].
    pub energy: String,
    /// Names for parts of the energy, in any order.
    pub definitions: Vec<(String, String)>,
    pub parameters: Vec<(String, LawParameter)>,
}

impl LawText {
    /// Whether it may tell directions apart: it names some, or single entries of tensors.
    pub fn names_directions(&self) -> bool {
        let is_direction = |name: &str| {
            let has_name = |(known, parameter): &(String, LawParameter)| {
                known == name && matches!(parameter, LawParameter::Direction(_))
            };
            vocabulary::entry_of(name).is_some() || self.parameters.iter().any(has_name)
        };
        let names_one = |text: &String| {
            let nodes = Expression::parse(text).map(|expression| expression.nodes().to_vec());
            nodes.unwrap_or_default().iter().any(|node| match &node.kind {
                NodeKind::Name(name) => is_direction(name),
                // directions may be written out
                NodeKind::Vector(_) => true,
                _ => false,
            })
        };
        self.definitions.iter().map(|(_, text)| text).chain([&self.energy]).any(names_one)
    }
}

/// A material constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LawParameter {
    /// In SI units; a number without unit is taken as it is wanted.
    Number { value: f64, dimension: Option<Dimension> },
    /// A direction in the rest shape, of length one.
    Direction([f64; 3]),
}

impl LawParameter {
    pub(crate) fn numbers(&self) -> &[f64] {
        match self {
            Self::Number { value, .. } => std::slice::from_ref(value),
            Self::Direction(direction) => direction,
        }
    }

    pub(crate) fn shape(&self) -> Shape {
        match self {
            Self::Number { .. } => Shape::Scalar,
            Self::Direction(_) => Shape::Vector,
        }
    }
}

/// Which strain a law sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strain {
    /// A rotation changes no energy.
    Finite,
    /// The law is written with `eps`: a rotation counts as strain.
    Small,
}

/// A law with its derivatives.
#[derive(Clone, Debug)]
pub struct EnergyLaw {
    pub graph: Graph,
    /// The deformation gradient, a symbol.
    pub deformation: Expr,
    /// Its differential, a symbol.
    pub variation: Expr,
    /// `Ψ`, zero at rest.
    pub energy: Expr,
    /// `P = ∂Ψ/∂F`.
    pub stress: Expr,
    /// `δP = ∂P/∂F : δF`.
    pub differential: Expr,
    pub parameters: Vec<(String, LawParameter)>,
    pub strain: Strain,
    /// What is legal and doubtful.
    pub warnings: Vec<String>,
    /// `∂P/∂F` at rest, entry `9 a + b` for the entries `a` of `P` and `b` of `F`, both by columns [Pa].
    pub stiffness: Box<[f64; 81]>,
}

/// Names of the symbols that stand for the deformation.
pub(crate) const DEFORMATION: &str = "F";
pub(crate) const VARIATION: &str = "dF";

/// Operands in the derivatives of a law at most; those of the laws that ship have a few hundred.
const LARGEST_DERIVATIVES: usize = 200_000;

/// `P = ∂Ψ/∂F` and `δP = ∂P/∂F : δF`.
fn derivatives(graph: &mut Graph, energy: Expr, [deformation, variation]: [Expr; 2]) -> (Expr, Expr) {
    let stress = graph.gradient(energy, deformation);
    let seeds = std::collections::HashMap::from([(deformation, variation)]);
    (stress, graph.differential(stress, &seeds))
}

/// Mean stress over relative change of volume at rest, `C_iijj / 9` [Pa].
pub fn bulk_modulus(stiffness: &[f64; 81]) -> f64 {
    let diagonal = [0, 4, 8];
    let entries = diagonal.iter().flat_map(|a| diagonal.iter().map(move |b| 9 * a + b));
    entries.map(|entry| stiffness[entry]).sum::<f64>() / 9.0
}

/// Shear modulus at rest, its mean over all directions, `(C_ijij - C_iijj / 3) / 10` (Voigt 1928) [Pa].
pub fn mean_shear_modulus(stiffness: &[f64; 81]) -> f64 {
    let trace: f64 = (0..9).map(|a| stiffness[9 * a + a]).sum();
    (trace - 3.0 * bulk_modulus(stiffness)) / 10.0
}

impl EnergyLaw {
    /// Reads, derives and tries a law.
    ///
    /// # Errors
    /// The part, the place and what would be accepted: syntax, unknown names, wrong units, an energy that is no number,
    /// definitions that need each other, derivatives without end, no value or slope at rest, stress at rest or none anywhere, an
    /// energy that rotations change.
    pub fn compile(text: &LawText) -> Result<Self, LawError> {
        let mut read = read::read(text)?;
        read.graph.allow(Some(LARGEST_DERIVATIVES));
        let deformation = read.graph.symbol(DEFORMATION, Shape::Matrix);
        let variation = read.graph.symbol(VARIATION, Shape::Matrix);
        let (stress, differential) = derivatives(&mut read.graph, read.energy, [deformation, variation]);
        if read.graph.is_exhausted() {
            return Err(check::too_long(&read));
        }
        read.graph.allow(None);
        let [stress, differential] =
            [stress, differential].map(|derivative| read.graph.factored(&[derivative])[0]);
        let mut law = Self {
            deformation,
            variation,
            energy: read.energy,
            stress,
            differential,
            parameters: text.parameters.clone(),
            strain: if read.uses_small_strain { Strain::Small } else { Strain::Finite },
            warnings: std::mem::take(&mut read.warnings),
            stiffness: Box::new([0.0; 81]),
            graph: std::mem::take(&mut read.graph),
        };
        check::check(&mut law, &read)?;
        Ok(law)
    }

    /// Derives stress and differential of the energy anew.
    fn derive(&mut self) {
        let by = [self.deformation, self.variation];
        let (stress, differential) = derivatives(&mut self.graph, self.energy, by);
        [self.stress, self.differential] =
            [stress, differential].map(|derivative| self.graph.factored(&[derivative])[0]);
    }

    /// The addends of the energy; an offset, which makes no force, is none.
    pub fn terms(&self) -> Vec<Expr> {
        self.addends().filter(|term| self.graph.value(*term).is_none()).collect()
    }

    /// Whether it is written in principal stretches, which have no formula.
    pub fn uses_stretches(&self) -> bool {
        let is_spectral = |expr: &Expr| matches!(self.graph.node(*expr), Node::Decompose(_));
        self.graph.reachable(&[self.energy]).iter().any(is_spectral)
    }

    /// Whether its stress is linear in `F - I`: the stiffness is the same at every `F`, and [`Self::compile`] takes no law with stress at
    /// rest.
    pub fn is_linear(&self) -> bool {
        !self.graph.depends(&[self.differential], &[self.deformation])[self.differential.index()]
    }

    /// The number among the addends of the energy.
    pub fn offset(&self) -> Option<Expr> {
        self.addends().find(|term| self.graph.value(*term).is_some())
    }

    fn addends(&self) -> impl Iterator<Item = Expr> {
        match self.graph.node(self.energy) {
            Node::Sum(terms) => terms.iter(),
            _ => std::slice::from_ref(&self.energy).iter(),
        }
        .copied()
    }

    /// The numbers of a parameter.
    pub fn parameter(&self, name: &str) -> Option<&LawParameter> {
        self.parameters.iter().find(|(known, _)| known == name).map(|(_, parameter)| parameter)
    }
}

/// A formula whose constants are grouped: every name in it is a number, and those of `variables` vary.
///
/// # Errors
/// As a law's: the place and what would be accepted; also a variable that is not in the formula.
pub fn group_constants(formula: &str, variables: &[String]) -> Result<(Graph, Grouped), LawError> {
    let read::Numbers { mut graph, value: root, symbols } = read::read_formula(formula)?;
    let symbol_of = |variable: &String| match symbols.iter().find(|(name, _)| name == variable) {
        Some((_, symbol)) => Ok(*symbol),
        None => {
            let known: Vec<String> = symbols.iter().map(|(name, _)| name.clone()).collect();
            let nearest =
                souple_table::nearest(variable, known.iter().map(String::as_str)).map(str::to_owned);
            let problem = LawProblem::NotInFormula { name: read::short(variable), nearest, known };
            Err(LawError::new("varying", None, problem))
        }
    };
    let variables = variables.iter().map(symbol_of).collect::<Result<Vec<Expr>, _>>()?;
    let grouped = graph.group_constants(&[root], &variables);
    Ok((graph, grouped))
}

#[cfg(test)]
mod tests;
