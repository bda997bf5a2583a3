//! What an element computes at each step, in tensors: the same forces as [`super::derive`], not spelled out.
//!
//! At a sample `X = X_ξ⁻¹` is grouped into nine constants and the weight with the moduli into one each: of a tetrahedron the eleven
//! of the source; then `F = I + U_ξ X`, `H = -ω P(F) Xᵀ`,
//! `f_n = H ∂N_n/∂ξ`; the map of a box is three numbers, which scale columns. Spelled out the same takes fewer operations, by a fifth on a tetrahedron, because zeros and
//! ones of the shape functions go into them; in tensors it takes a few instructions in the place of hundreds, each of which has
//! to be looked at.

use std::collections::HashMap;

use super::derive::{Placing, SampleStress, Symbols, Term, WEIGHT, nodal_forces, terms};
use super::{Cut, ElementData, Fragment, RestMap};
use crate::graph::{Expr, Graph, OWN, Operations, Shape, Substitution};
use crate::hashing::Map;
use crate::law::EnergyLaw;

/// Steps of an element under one law.
#[derive(Clone, Debug)]
pub struct Steps {
    pub graph: Graph,
    pub symbols: Symbols,
    pub energies: Vec<Step>,
    pub forces: Vec<Step>,
    pub differentials: Vec<Step>,
}

/// An addend of the energy (one number), or of the forces or differentials (by node and direction).
#[derive(Clone, Debug)]
pub struct Step {
    /// Symbols of numbers that are computed once, and what from.
    pub constants: Vec<(Expr, Expr)>,
    /// Symbols of tensors that are computed on the way; later ones may use earlier ones.
    pub definitions: Vec<(Expr, Expr)>,
    pub outputs: Vec<Expr>,
}

impl Step {
    /// Operations of every step.
    pub fn operations(&self, graph: &Graph) -> Operations {
        let definitions = self.definitions.iter().map(|(_, definition)| *definition);
        let roots: Vec<Expr> = definitions.chain(self.outputs.iter().copied()).collect();
        graph.operations(&roots, |_| false)
    }
}

/// The symbols of one sample.
#[derive(Clone, Copy)]
struct Tensors {
    /// `X_ξ⁻¹`.
    inverse: Expr,
    deformation: Expr,
    variation: Expr,
    /// `-ω P X_ξ⁻ᵀ`, or its differential; without `X_ξ⁻ᵀ` where that is diagonal.
    spread: Expr,
}

/// What is computed of a law.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Quantity {
    Energy,
    Force,
    /// Of what varies at some nodes in some directions.
    Differential,
}

struct Stepping<'a> {
    graph: Graph,
    element: &'a ElementData,
    law: &'a EnergyLaw,
    symbols: Symbols,
    terms: Vec<Term>,
    /// `X_ξ⁻¹` and `det X_ξ`, by sample.
    rest_maps: Vec<(Vec<Expr>, Expr)>,
}

pub(super) fn steps(element: &ElementData, law: &EnergyLaw, cut: Cut) -> Steps {
    let mut graph = law.graph.clone();
    let symbols = Symbols::new(&mut graph, element, law);
    let terms = terms(&mut graph, law, cut);
    let mut stepping = Stepping { graph, element, law, symbols, terms, rest_maps: Vec::new() };
    let counts = (stepping.terms.len(), element.samples.len());
    let of_forces = Fragment::of_forces(cut, counts.0, counts.1);
    let of_differentials = Fragment::of_differentials(cut, counts, (element.node_count, element.dimension));
    let mut list = |quantity, fragments: &[Fragment]| -> Vec<Step> {
        fragments.iter().map(|fragment| stepping.step(quantity, *fragment)).collect()
    };
    let (energies, forces) = (list(Quantity::Energy, &of_forces), list(Quantity::Force, &of_forces));
    let differentials = list(Quantity::Differential, &of_differentials);
    Steps { graph: stepping.graph, symbols: stepping.symbols, energies, forces, differentials }
}

/// Which constants of an element hold the same, for all steps together.
#[derive(Clone, Debug)]
pub struct ConstantPlaces {
    /// Constants of an element.
    pub count: usize,
    /// Of each step's constants, by step: their places among those of the element.
    pub energies: Vec<Vec<usize>>,
    pub forces: Vec<Vec<usize>>,
    pub differentials: Vec<Vec<usize>>,
}

impl Steps {
    /// Energy, forces and differential hold much the same constants: each has one place.
    pub fn constant_places(&self) -> ConstantPlaces {
        let mut graph = self.graph.clone();
        let mut place_of: Map<Expr, usize> = Map::default();
        let mut of_step = |step: &Step| {
            let mut whole = Substitution::default();
            let of_constant = |(symbol, definition): &(Expr, Expr)| {
                let definition = graph.substituted(*definition, &mut whole);
                whole.replace(*symbol, definition, false);
                let next = place_of.len();
                *place_of.entry(definition).or_insert(next)
            };
            step.constants.iter().map(of_constant).collect::<Vec<usize>>()
        };
        let mut of_steps = |steps: &[Step]| steps.iter().map(&mut of_step).collect::<Vec<_>>();
        let (energies, forces) = (of_steps(&self.energies), of_steps(&self.forces));
        let differentials = of_steps(&self.differentials);
        ConstantPlaces { count: place_of.len(), energies, forces, differentials }
    }
}

impl Stepping<'_> {
    fn step(&mut self, quantity: Quantity, fragment: Fragment) -> Step {
        let samples = fragment.sample.map_or(0..self.element.samples.len(), |sample| sample..sample + 1);
        let varied = self.varied(fragment);
        let mut definitions = Vec::new();
        let (mut energies, mut stresses) = (Vec::new(), Vec::new());
        for sample in samples {
            let tensors = self.tensors(sample);
            let (weight, inverse) = self.deform(sample, tensors, &varied, quantity, &mut definitions);
            let of_law = self.of_law(quantity, fragment, weight, tensors);
            if quantity == Quantity::Energy {
                energies.push(of_law);
                continue;
            }
            let graph = &mut self.graph;
            let spread = match inverse {
                Some(_) => of_law,
                None => {
                    let transposed = graph.transpose(tensors.inverse);
                    graph.multiply(of_law, transposed)
                }
            };
            definitions.push((tensors.spread, spread));
            let stress = (0..9).map(|index| graph.entry(tensors.spread, index)).collect();
            let one = |graph: &mut Graph| {
                (0..9).map(|index| graph.number(f64::from(u8::from(index % 4 == 0)))).collect()
            };
            let inverse = inverse.unwrap_or_else(|| one(graph));
            stresses.push(SampleStress { sample, inverse, stress });
        }
        let outputs = match quantity {
            Quantity::Energy => vec![self.graph.sum(&energies)],
            Quantity::Force | Quantity::Differential => {
                nodal_forces(&mut self.graph, self.element, &stresses)
            }
        };
        self.group(definitions, outputs)
    }

    /// What varies in a fragment, zero elsewhere.
    fn varied(&mut self, fragment: Fragment) -> Vec<Vec<Expr>> {
        let zero = self.graph.number(0.0);
        let keeps = |wanted: Option<usize>, index: usize| wanted.is_none_or(|wanted| wanted == index);
        let of_node = |(node, variations): (usize, &Vec<Expr>)| {
            let of_axis = |(axis, variation): (usize, &Expr)| {
                let is_kept = keeps(fragment.node, node) && keeps(fragment.direction, axis);
                if is_kept { *variation } else { zero }
            };
            variations.iter().enumerate().map(of_axis).collect()
        };
        self.symbols.variations.iter().enumerate().map(of_node).collect()
    }

    fn tensors(&mut self, sample: usize) -> Tensors {
        let mut symbol = |letter: &str| self.graph.symbol(&format!("{OWN}{letter}{sample}"), Shape::Matrix);
        Tensors {
            inverse: symbol("X"),
            deformation: symbol("F"),
            variation: symbol("dF"),
            spread: symbol("H"),
        }
    }

    /// Defines `F` at a sample, and `δF` where it is wanted; gives `ω`, and `X_ξ⁻¹` where it is diagonal. Elsewhere that is defined
    /// too.
    fn deform(
        &mut self,
        sample: usize,
        tensors: Tensors,
        varied: &[Vec<Expr>],
        quantity: Quantity,
        definitions: &mut Vec<(Expr, Expr)>,
    ) -> (Expr, Option<Vec<Expr>>) {
        let Symbols { rest, displacements, directions, .. } = &self.symbols;
        let (element, law) = (self.element, self.law);
        let mut at = Placing { graph: &mut self.graph, element, law, sample, rest, directions };
        if self.rest_maps.len() <= sample {
            self.rest_maps.push(at.rest_map());
        }
        let (inverse, determinant) = self.rest_maps[sample].clone();
        let mut rates = vec![(tensors.deformation, at.reference_gradient(displacements))];
        if quantity == Quantity::Differential {
            rates.push((tensors.variation, at.reference_gradient(varied)));
        }
        let graph = &mut self.graph;
        let is_diagonal = matches!(element.map, RestMap::Box { .. });
        if !is_diagonal {
            definitions.push((tensors.inverse, graph.pack(&inverse)));
        }
        for (symbol, rate) in rates {
            let gradient = if is_diagonal {
                let entries: Vec<Expr> =
                    (0..9).map(|i| graph.product(&[rate[i], inverse[4 * (i / 3)]])).collect();
                graph.pack(&entries)
            } else {
                let rate = graph.pack(&rate);
                graph.multiply(rate, tensors.inverse)
            };
            let identity = graph.identity();
            let value = if symbol == tensors.deformation { graph.add(identity, gradient) } else { gradient };
            definitions.push((symbol, value));
        }
        let weight = graph.times_number(element.samples[sample].weight, determinant);
        (weight, is_diagonal.then_some(inverse))
    }

    /// `ω Ψ`, `-ω P` or `-ω δP` of the terms of a fragment.
    fn of_law(&mut self, quantity: Quantity, fragment: Fragment, weight: Expr, tensors: Tensors) -> Expr {
        let terms = fragment.term.map_or(&self.terms[..], |term| &self.terms[term..=term]);
        let addends: Vec<Expr> = terms
            .iter()
            .map(|term| match quantity {
                Quantity::Energy => term.energy,
                Quantity::Force => term.stress,
                Quantity::Differential => term.differential,
            })
            .collect();
        let sum = self.graph.sum(&addends);
        let signed = if quantity == Quantity::Energy { weight } else { self.graph.negate(weight) };
        let symbol = self.graph.own_symbol(WEIGHT);
        let at_sample = HashMap::from([
            (symbol, signed),
            (self.law.deformation, tensors.deformation),
            (self.law.variation, tensors.variation),
        ]);
        self.graph.substitute(sum, &at_sample)
    }

    /// Takes the constants out.
    fn group(&mut self, definitions: Vec<(Expr, Expr)>, outputs: Vec<Expr>) -> Step {
        let (symbols, tensors): (Vec<Expr>, Vec<Expr>) = definitions.into_iter().unzip();
        let Symbols { displacements, variations, .. } = &self.symbols;
        let variables = displacements.iter().chain(variations).flatten().chain(&symbols).copied();
        let variables: Vec<Expr> = variables.collect();
        let roots: Vec<Expr> = tensors.iter().chain(&outputs).copied().collect();
        let grouped = self.graph.group_constants(&roots, &variables);
        let mut grouped = self.graph.without_multiples(grouped);
        grouped.varying = self.graph.shared(&grouped.varying);
        let outputs = grouped.varying.split_off(symbols.len());
        let definitions = symbols.into_iter().zip(grouped.varying).collect();
        Step { constants: grouped.constants, definitions, outputs }
    }
}
