//! The derivation itself.

use std::collections::HashMap;

use super::separable::Corners;
use super::{Cut, ElementData, Fragment, RestMap};
use crate::graph::{Expr, Graph, Grouped, Operations, Shape};
use crate::law::EnergyLaw;

/// Expressions of an element under one law.
#[derive(Clone, Debug)]
pub struct Derived {
    pub graph: Graph,
    /// `<law>` is not known here: `<element><cut>`, to be put behind the name of a law.
    pub name: String,
    pub cut: Cut,
    pub symbols: Symbols,
    pub energies: Vec<ElementExpressions>,
    pub forces: Vec<ElementExpressions>,
    pub differentials: Vec<ElementExpressions>,
}

/// One fragment: an addend of the energy (one expression), or of the forces or differentials (by node and direction).
#[derive(Clone, Debug)]
pub struct ElementExpressions {
    pub fragment: Fragment,
    /// In rest positions, material constants and displacements.
    pub raw: Vec<Expr>,
    pub grouped: Grouped,
}

impl ElementExpressions {
    /// Operands of the expressions and of the constants in them, each written out once.
    pub fn operands(&self, graph: &Graph) -> f64 {
        let (symbols, definitions): (Vec<Expr>, Vec<Expr>) = self.grouped.constants.iter().copied().unzip();
        let named = |expr: Expr| symbols.contains(&expr);
        graph.operands_written_out(&self.grouped.varying, named)
            + graph.operands_written_out(&definitions, named)
    }

    /// Operations per evaluation, and once.
    pub fn operations(&self, graph: &Graph) -> (Operations, Operations) {
        let definitions: Vec<Expr> =
            self.grouped.constants.iter().map(|(_, definition)| *definition).collect();
        (graph.operations(&self.grouped.varying, |_| false), graph.operations(&definitions, |_| false))
    }
}

/// The symbols that expressions of an element are made of.
#[derive(Clone, Debug)]
pub struct Symbols {
    /// Rest positions, by node and direction.
    pub rest: Vec<Vec<Expr>>,
    pub displacements: Vec<Vec<Expr>>,
    /// What the differential is multiplied with.
    pub variations: Vec<Vec<Expr>>,
    /// Material constants of one number.
    pub parameters: Vec<Expr>,
    /// Directions of the law and their entries, plain numbers of the code.
    pub(super) directions: Vec<(Expr, Vec<Expr>)>,
}

impl Symbols {
    pub(super) fn new(graph: &mut Graph, element: &ElementData, law: &EnergyLaw) -> Self {
        let axes = ["x", "y", "z"];
        let mut of_nodes = |letter: &str| -> Vec<Vec<Expr>> {
            (0..element.node_count)
                .map(|node| {
                    let of_axis = |axis: &&str| graph.own_symbol(&format!("{letter}{node}{axis}"));
                    axes[..element.dimension].iter().map(of_axis).collect()
                })
                .collect()
        };
        let (rest, displacements, variations) = (of_nodes("P"), of_nodes("U"), of_nodes("V"));
        let of_len = |length: usize| {
            law.parameters.iter().filter(move |(_, parameter)| parameter.numbers().len() == length)
        };
        let parameters = of_len(1).map(|(name, _)| graph.symbol(name, Shape::Scalar)).collect();
        let directions = of_len(3)
            .map(|(name, parameter)| {
                let symbol = graph.symbol(name, Shape::Vector);
                (symbol, parameter.numbers().iter().map(|number| graph.number(*number)).collect())
            })
            .collect();
        Self { rest, displacements, variations, parameters, directions }
    }
}

/// `ω Ψ` and its derivatives for one term of the law, `ω` being a symbol.
pub(crate) struct Term {
    pub energy: Expr,
    pub stress: Expr,
    pub differential: Expr,
}

/// What a sample adds: expressions of numbers.
struct AtSample {
    /// `X_ξ⁻¹`, by columns.
    inverse: Vec<Expr>,
    /// By term.
    energies: Vec<Expr>,
    /// `-ω P` by term and column.
    stresses: Vec<Vec<Expr>>,
    /// `-ω δP` by term, then by node and direction of what varies (all of them where not cut), then by column.
    differentials: Vec<Vec<Vec<Expr>>>,
}

/// Name of the weight `ω` while a law is differentiated.
pub(crate) const WEIGHT: &str = "weight";

pub(super) fn derive(element: &ElementData, law: &EnergyLaw, cut: Cut) -> Derived {
    let mut graph = law.graph.clone();
    let symbols = Symbols::new(&mut graph, element, law);
    let Symbols { rest, displacements, variations, directions, .. } = &symbols;
    let terms = terms(&mut graph, law, cut);
    let cut_variations = cut.has(super::Axis::Nodes) || cut.has(super::Axis::Dimension);
    let mut samples = Vec::with_capacity(element.samples.len());
    for sample in 0..element.samples.len() {
        let mut at = Placing { graph: &mut graph, element, law, sample, rest, directions };
        samples.push(at.expressions(&terms, displacements, variations, cut_variations));
    }
    let variables: Vec<Expr> = displacements.iter().chain(variations).flatten().copied().collect();
    let counts = (terms.len(), samples.len());
    let all_terms = |fragment: Fragment| fragment.term.map_or(0..counts.0, |term| term..term + 1);
    let of_samples = |fragment: Fragment| fragment.sample.map_or(0..counts.1, |sample| sample..sample + 1);
    let width = element.node_count * element.dimension;
    let (mut energies, mut forces, mut differentials) = (Vec::new(), Vec::new(), Vec::new());
    // what the samples of a fragment hold of stress, by its nodes
    let to_nodes = |graph: &mut Graph, fragment, addends: &dyn Fn(&AtSample) -> Vec<Vec<Expr>>| {
        let stresses: Vec<SampleStress> = of_samples(fragment)
            .map(|sample| {
                let at = &samples[sample];
                SampleStress {
                    sample,
                    inverse: at.inverse.clone(),
                    stress: entrywise_sum(graph, &addends(at)),
                }
            })
            .collect();
        nodal_forces(graph, element, &stresses)
    };
    for fragment in Fragment::of_forces(cut, counts.0, counts.1) {
        let of_energy: Vec<Expr> =
            of_samples(fragment).flat_map(|q| samples[q].energies[all_terms(fragment)].to_vec()).collect();
        let of_energy = graph.sum(&of_energy);
        energies.push((fragment, vec![of_energy]));
        let of_forces = to_nodes(&mut graph, fragment, &|at| at.stresses[all_terms(fragment)].to_vec());
        forces.push((fragment, of_forces));
    }
    for fragment in Fragment::of_differentials(cut, counts, (element.node_count, element.dimension)) {
        let is_wanted = |varied: usize| {
            let (node, direction) = (varied / element.dimension, varied % element.dimension);
            fragment.node.is_none_or(|wanted| wanted == node)
                && fragment.direction.is_none_or(|wanted| wanted == direction)
        };
        let varied: Vec<usize> =
            if cut_variations { (0..width).filter(|varied| is_wanted(*varied)).collect() } else { vec![0] };
        let addends = |at: &AtSample| {
            let of_term = |term: usize| varied.iter().map(move |varied| (term, *varied));
            let stress = |(term, varied): (usize, usize)| at.differentials[term][varied].clone();
            all_terms(fragment).flat_map(of_term).map(stress).collect()
        };
        let of_differentials = to_nodes(&mut graph, fragment, &addends);
        differentials.push((fragment, of_differentials));
    }
    // grouped when all are there: what grouping makes is no part of other fragments, and stands behind them
    let mut grouped = |list: Vec<(Fragment, Vec<Expr>)>| -> Vec<ElementExpressions> {
        let of_fragment = |(fragment, raw): (Fragment, Vec<Expr>)| {
            let mut grouped = graph.group_constants(&raw, &variables);
            grouped.varying = graph.shared(&grouped.varying);
            ElementExpressions { fragment, raw, grouped }
        };
        list.into_iter().map(of_fragment).collect()
    };
    let (energies, forces, differentials) = (grouped(energies), grouped(forces), grouped(differentials));
    let name = format!("{}{cut}", element.name);
    Derived { graph, name, cut, symbols, energies, forces, differentials }
}

/// The terms of the energy times `ω`, or their sum where the law is not cut. The weight is multiplied in before differentiation,
/// so that it meets the material constants and is grouped with them.
pub(crate) fn terms(graph: &mut Graph, law: &EnergyLaw, cut: Cut) -> Vec<Term> {
    let weight = graph.own_symbol(WEIGHT);
    let seeds = HashMap::from([(law.deformation, law.variation)]);
    let mut energies = Vec::new();
    for (index, term) in law.terms().into_iter().enumerate() {
        // what makes the energy zero at rest belongs to one of them
        let term = match law.offset() {
            Some(offset) if index == 0 => graph.sum(&[term, offset]),
            _ => term,
        };
        energies.push(graph.product(&[weight, term]));
    }
    if !cut.has(super::Axis::Law) {
        energies = vec![graph.sum(&energies)];
    }
    let of_energy = |energy: Expr| {
        let stress = graph.gradient(energy, law.deformation);
        let differential = graph.differential(stress, &seeds);
        let [stress, differential] =
            [stress, differential].map(|derivative| graph.factored(&[derivative])[0]);
        Term { energy, stress, differential }
    };
    energies.into_iter().map(of_energy).collect()
}

/// The expressions at one sample.
pub(super) struct Placing<'a> {
    pub graph: &'a mut Graph,
    pub element: &'a ElementData,
    pub law: &'a EnergyLaw,
    pub sample: usize,
    pub rest: &'a [Vec<Expr>],
    pub directions: &'a [(Expr, Vec<Expr>)],
}

impl Placing<'_> {
    fn expressions(
        &mut self,
        terms: &[Term],
        displacements: &[Vec<Expr>],
        variations: &[Vec<Expr>],
        cut_variations: bool,
    ) -> AtSample {
        let dimension = self.element.dimension;
        let (inverse, determinant) = self.rest_map();
        let weight = self.graph.times_number(self.element.samples[self.sample].weight, determinant);
        let mut deformation = self.gradient(displacements, &inverse);
        let one = self.graph.number(1.0);
        for diagonal in [0, 4, 8] {
            deformation[diagonal] = self.graph.sum(&[deformation[diagonal], one]);
        }
        let symbol = self.graph.own_symbol(WEIGHT);
        let mut given = HashMap::from([(symbol, vec![weight]), (self.law.deformation, deformation)]);
        given.extend(self.directions.iter().cloned());
        let (mut energies, mut stresses, mut differentials) = (Vec::new(), Vec::new(), Vec::new());
        let every: Vec<Option<(usize, usize)>> = if cut_variations {
            (0..displacements.len()).flat_map(|n| (0..dimension).map(move |k| Some((n, k)))).collect()
        } else {
            vec![None]
        };
        for term in terms {
            energies.push(self.graph.components(term.energy, &given)[0]);
            let negative = self.graph.negate(term.stress);
            stresses.push(self.graph.components(negative, &given));
            let mut of_term = Vec::new();
            for varied in &every {
                let zero = self.graph.number(0.0);
                let masked: Vec<Vec<Expr>> = variations
                    .iter()
                    .enumerate()
                    .map(|(node, of_node)| {
                        let keep = |k: usize| varied.is_none_or(|wanted| wanted == (node, k));
                        of_node.iter().enumerate().map(|(k, v)| if keep(k) { *v } else { zero }).collect()
                    })
                    .collect();
                let variation = self.gradient(&masked, &inverse);
                given.insert(self.law.variation, variation);
                let negative = self.graph.negate(term.differential);
                of_term.push(self.graph.components(negative, &given));
            }
            differentials.push(of_term);
        }
        AtSample { inverse, energies, stresses, differentials }
    }

    /// `X_ξ⁻¹`, by columns, and `det X_ξ`.
    pub fn rest_map(&mut self) -> (Vec<Expr>, Expr) {
        let (zero, one) = (self.graph.number(0.0), self.graph.number(1.0));
        let dimension = self.element.dimension;
        if let RestMap::Box { low, high } = self.element.map {
            let mut inverse = vec![zero; 9];
            let mut edges = Vec::new();
            for axis in 0..3 {
                inverse[4 * axis] = one;
                if axis < dimension {
                    let edge = self.graph.subtract(self.rest[high][axis], self.rest[low][axis]);
                    let half = self.graph.times_number(0.5, edge);
                    inverse[4 * axis] = self.graph.power_number(half, -1.0);
                    edges.push(half);
                }
            }
            return (inverse, self.graph.product(&edges));
        }
        let mut jacobian = self.reference_gradient(self.rest);
        if dimension == 2 {
            jacobian[8] = one;
        }
        let packed = self.graph.pack(&jacobian);
        let inverse = self.graph.inverse(packed);
        let determinant = self.graph.determinant(packed);
        let components = |graph: &mut Graph, expr| graph.components(expr, &HashMap::new());
        let inverse = components(self.graph, inverse);
        let determinant = components(self.graph, determinant);
        (inverse, determinant[0])
    }

    /// `Σ values_n ⊗ ∂N_n/∂ξ`, by columns.
    pub fn reference_gradient(&mut self, values: &[Vec<Expr>]) -> Vec<Expr> {
        let sample = &self.element.samples[self.sample];
        let (dimension, corners) = (self.element.dimension, Corners::of(self.element));
        let mut of_entry = |index: usize| {
            let (row, column) = (index % 3, index / 3);
            if row >= dimension || column >= dimension {
                return self.graph.number(0.0);
            }
            let field: Vec<Expr> = values.iter().map(|value| value[row]).collect();
            if let Some(corners) = &corners {
                return corners.derivative(self.graph, &field, column, &sample.position);
            }
            let terms: Vec<Expr> = field
                .iter()
                .zip(&sample.gradients)
                .map(|(value, gradient)| self.graph.times_number(gradient[column], *value))
                .collect();
            self.graph.sum(&terms)
        };
        (0..9).map(&mut of_entry).collect()
    }

    /// `∂(values)/∂X`, by columns.
    fn gradient(&mut self, values: &[Vec<Expr>], inverse: &[Expr]) -> Vec<Expr> {
        let reference = self.reference_gradient(values);
        (0..9)
            .map(|index| {
                let (row, column) = (index % 3, index / 3);
                let products: Vec<Expr> = (0..3)
                    .map(|k| self.graph.product(&[reference[3 * k + row], inverse[3 * column + k]]))
                    .collect();
                self.graph.sum(&products)
            })
            .collect()
    }
}

/// A stress times its weight at a sample, by columns, with `X_ξ⁻¹` there.
pub(super) struct SampleStress {
    pub sample: usize,
    pub inverse: Vec<Expr>,
    pub stress: Vec<Expr>,
}

/// `Σ_q P_q X_ξ⁻ᵀ ∂N_n/∂ξ`, by node and direction.
pub(super) fn nodal_forces(graph: &mut Graph, element: &ElementData, stresses: &[SampleStress]) -> Vec<Expr> {
    let dimension = element.dimension;
    let mut addends: Vec<Vec<Expr>> = vec![Vec::new(); element.node_count * dimension];
    if let Some(corners) = Corners::of(element) {
        for (row, axis) in (0..dimension).flat_map(|row| (0..dimension).map(move |axis| (row, axis))) {
            let along_axis: Vec<([f64; 3], Expr)> = stresses
                .iter()
                .map(|at| (element.samples[at.sample].position, at.stress[3 * axis + row]))
                .collect();
            let forces = corners.spread(graph, &along_axis, axis);
            for (node, force) in forces.into_iter().enumerate() {
                // the map of a box is the same at all samples
                addends[node * dimension + row].push(graph.product(&[force, stresses[0].inverse[4 * axis]]));
            }
        }
    } else {
        for SampleStress { sample, inverse, stress } in stresses {
            let mut in_reference = Vec::with_capacity(9);
            for index in 0..9 {
                let (row, column) = (index % 3, index / 3);
                // (P X_ξ⁻ᵀ)(row, column) = Σ P(row, k) X_ξ⁻¹(column, k)
                let products: Vec<Expr> =
                    (0..3).map(|k| graph.product(&[stress[3 * k + row], inverse[3 * k + column]])).collect();
                in_reference.push(graph.sum(&products));
            }
            for (node, gradient) in element.samples[*sample].gradients.iter().enumerate() {
                for row in 0..dimension {
                    let terms = (0..dimension)
                        .map(|axis| graph.times_number(gradient[axis], in_reference[3 * axis + row]));
                    addends[node * dimension + row].extend(terms);
                }
            }
        }
    }
    addends.iter().map(|addends| graph.sum(addends)).collect()
}

/// Sum of lists of one length, entry by entry.
fn entrywise_sum(graph: &mut Graph, lists: &[Vec<Expr>]) -> Vec<Expr> {
    (0..lists[0].len())
        .map(|index| {
            let addends: Vec<Expr> = lists.iter().map(|list| list[index]).collect();
            graph.sum(&addends)
        })
        .collect()
}
