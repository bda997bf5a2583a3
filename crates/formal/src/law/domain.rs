//! Where an energy ends and its stress does not: `Ψ = -µ ln J` has no value beyond `J = 0`, and `P = -µ F⁻ᵀ` has one. What runs
//! with the stress alone would go on there with forces of no energy.

use std::collections::{HashMap, HashSet};

use super::EnergyLaw;
use crate::Function;
use crate::graph::{Comparison, Expr, Node};

impl EnergyLaw {
    /// The stress, which is no number where the energy is none: `P + g I` with `g = 0` where all logarithms of the energy have
    /// a value, for those that the stress does not hold itself. Branches of conditions count where they are taken.
    pub fn guarded_stress(&mut self) -> Expr {
        let graph = &mut self.graph;
        let in_stress: HashSet<Expr> = graph.reachable(&[self.stress]).into_iter().collect();
        let zero = graph.number(0.0);
        // of each part of the energy: zero where it has a value, else no number
        let mut guards: HashMap<Expr, Expr> = HashMap::new();
        for expr in graph.reachable(&[self.energy]) {
            let node = graph.node(expr).clone();
            let mut addends: Vec<Expr> = match &node {
                Node::Select(condition, value, otherwise) => {
                    vec![guards[condition], graph.select(*condition, guards[value], guards[otherwise])]
                }
                _ => node.operands().map(|operand| guards[&operand]).collect(),
            };
            if let Node::Function(Function::Ln | Function::Log10, argument) = node
                && !in_stress.contains(&expr)
            {
                // at zero itself the stress is infinite
                let is_beyond = graph.compare(Comparison::Less, argument, zero);
                let none = graph.power_number(argument, 0.5);
                addends.push(graph.select(is_beyond, none, zero));
            }
            addends.retain(|addend| !graph.is_zero(*addend));
            addends.sort_unstable();
            addends.dedup();
            let guard = if addends.is_empty() { zero } else { graph.sum(&addends) };
            guards.insert(expr, guard);
        }
        let guard = guards[&self.energy];
        if graph.is_zero(guard) {
            return self.stress;
        }
        let identity = graph.identity();
        let ended = graph.scale(guard, identity);
        graph.add(self.stress, ended)
    }
}
