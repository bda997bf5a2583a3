//! Laws multiplied out: whether two texts are the same function of `F`, however they are written.
//!
//! An energy that is built of sums, products and whole powers, and of logarithms of what is above zero everywhere, is a polynomial in the entries
//! of `F`, the principal stretches and the logarithms. Two of them that have the same number before every term are the same function.
//! The converse is not asked: of energies that are no such polynomials nothing is said.

#![allow(non_snake_case)]

use std::collections::HashMap;

use super::read::{self, Read};
use super::{DEFORMATION, LawParameter, LawText, vocabulary};
use crate::Function;
use crate::arithmetic;
use crate::graph::{Expr, Graph, Node, Shape, arithmetic_power};
use crate::hashing::Map;
use crate::polynomial::{Arithmetic, CONSTANT, Coefficient, Polynomial, Powers, ROUNDING, VARIABLES};

/// Terms that may be made of a text: St. Venant-Kirchhoff's law by invariants takes some thousands.
const LARGEST_EXPANSION: usize = 200_000;
/// Entries of `F` come first among the variables, then the stretches, then logarithms as they are met.
const ENTRIES: usize = 9;
const NAMED: usize = ENTRIES + 3;
/// How far what cancels in a text may be above what is left of it: beyond, rounding could hide a term that is there.
const CANCELLED: f64 = 1e3;

/// What the variables of polynomials stand for; laws that are to be compared are multiplied out by one of them.
#[derive(Clone, Debug, Default)]
pub struct Expansion {
    /// The arguments of the logarithms, with a leading coefficient of size one.
    logarithms: Vec<Polynomial>,
}

/// An energy multiplied out.
#[derive(Clone, Debug)]
pub struct Expanded(Polynomial);

impl Expansion {
    /// The energy of a text with its numbers; `None` if it is no law, no such polynomial or a long one.
    pub fn of(&mut self, text: &LawText) -> Option<Expanded> {
        let Read { mut graph, energy, .. } = read::read(text).ok()?;
        let (given, variables) = named(&mut graph, energy, text);
        let [energy] = graph.components(energy, &given)[..] else { return None };
        let mut arithmetic = Arithmetic::allowing(LARGEST_EXPANSION);
        let mut made: Map<Expr, Option<Polynomial>> = Map::default();
        for expr in graph.reachable(&[energy]) {
            let polynomial = match graph.symbol_of(expr) {
                Some(symbol) => match variables.get(&expr) {
                    Some(variable) => Some(Polynomial::variable(*variable)),
                    None => number_of(text, &symbol.name).map(Polynomial::constant),
                },
                None => self.made_of(&graph, expr, &made, &mut arithmetic),
            };
            made.insert(expr, polynomial);
        }
        made.remove(&energy)?.map(Expanded)
    }

    fn made_of(
        &mut self,
        graph: &Graph,
        expr: Expr,
        made: &Map<Expr, Option<Polynomial>>,
        arithmetic: &mut Arithmetic,
    ) -> Option<Polynomial> {
        let of = |operand: &Expr| made[operand].as_ref();
        match graph.node(expr) {
            Node::Number(bits) => Some(Polynomial::constant(bits.value())),
            Node::Sum(terms) => {
                terms.iter().try_fold(Polynomial::default(), |sum, term| arithmetic.add(sum, of(term)?))
            }
            Node::Product(factors) => {
                factors.iter().try_fold(Polynomial::constant(1.0), |product, factor| {
                    arithmetic.multiply(&product, of(factor)?)
                })
            }
            Node::Power(base, exponent) => {
                let (base, exponent) = (of(base)?, of(exponent)?.value()?);
                match base.value() {
                    Some(base) => constant(arithmetic_power(base, exponent)),
                    None => arithmetic.power(base, whole(exponent)?),
                }
            }
            Node::Function(function, argument) => {
                match (function, of(argument).and_then(Polynomial::value)) {
                    (function, Some(argument)) => constant(arithmetic::of_one(*function, argument)),
                    (Function::Ln, None) => self.logarithm(graph, *argument, made, arithmetic),
                    (Function::Log10, None) => {
                        let natural = self.logarithm(graph, *argument, made, arithmetic)?;
                        Some(natural.scaled(std::f64::consts::LOG10_E))
                    }
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// `ln Π bⁿ = Σ n ln b`, of what is above zero for every `F`.
    fn logarithm(
        &mut self,
        graph: &Graph,
        argument: Expr,
        made: &Map<Expr, Option<Polynomial>>,
        arithmetic: &mut Arithmetic,
    ) -> Option<Polynomial> {
        let factors = match graph.node(argument) {
            Node::Product(factors) => &factors[..],
            _ => &[argument],
        };
        factors.iter().try_fold(Polynomial::default(), |sum, factor| {
            let (base, exponent) = match graph.node(*factor) {
                Node::Power(base, exponent) => (*base, made[exponent].as_ref()?.value()?),
                _ => (*factor, 1.0),
            };
            let logarithm = self.logarithm_of_positive(made[&base].as_ref()?, arithmetic)?;
            arithmetic.add(sum, &logarithm.scaled(exponent))
        })
    }

    /// `ln c p = ln c + ln p` with the leading coefficient `c`.
    fn logarithm_of_positive(&mut self, of: &Polynomial, arithmetic: &mut Arithmetic) -> Option<Polynomial> {
        if !of.is_positive() {
            return None;
        }
        let (leading, of) = of.split_leading()?;
        let natural = Polynomial::constant(libm::log(leading));
        if of.value().is_some() {
            return Some(natural);
        }
        let position = self.logarithms.iter().position(|known| known.is_same(&of));
        let position = match position {
            Some(position) => position,
            None if NAMED + self.logarithms.len() < VARIABLES => {
                self.logarithms.push(of);
                self.logarithms.len() - 1
            }
            None => return None,
        };
        arithmetic.add(natural, &Polynomial::variable(NAMED + position))
    }
}

impl Expanded {
    /// The numbers with which this is the sum of both parts, but for an offset, which has no physics; `None` if it is not.
    ///
    /// They are those of least squares, each term in proportion to the rounding of its number; then every term is held against them.
    pub fn as_sum_of(&self, parts: [&Self; 2]) -> Option<[f64; 2]> {
        let both = || parts.iter().flat_map(|part| part.0.terms());
        let mut powers: Vec<&Powers> = self.0.terms().chain(both()).map(|(powers, _)| powers).collect();
        powers.retain(|powers| **powers != CONSTANT);
        powers.sort_unstable();
        powers.dedup();
        let rows: Vec<(Coefficient, [Coefficient; 2])> = powers
            .into_iter()
            .map(|powers| (self.0.coefficient(powers), parts.map(|part| part.0.coefficient(powers))))
            .collect();
        let largest = rows.iter().fold(0.0, |most: f64, (of_self, _)| most.max(of_self.value.abs()));
        if rows.iter().any(|(of_self, _)| of_self.size > CANCELLED * largest) {
            return None;
        }
        // a term that the text does not have
        let size_of = |of_self: &Coefficient| if of_self.size > 0.0 { of_self.size } else { largest };
        // normal equations of `a p + b q = t`
        let (mut pp, mut pq, mut qq, mut pt, mut qt) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (of_self, of_parts) in &rows {
            let size = size_of(of_self);
            let ([p, q], t) = (of_parts.map(|part| part.value / size), of_self.value / size);
            pp += p * p;
            pq += p * q;
            qq += q * q;
            pt += p * t;
            qt += q * t;
        }
        let determinant = pp * qq - pq * pq;
        let (a, b) = ((pt * qq - qt * pq) / determinant, (qt * pp - pt * pq) / determinant);
        let is_sum = rows.iter().all(|(of_self, [p, q])| {
            let size = size_of(of_self) + a.abs() * p.size + b.abs() * q.size;
            (of_self.value - a * p.value - b * q.value).abs() <= ROUNDING * size
        });
        // what is nothing but rounding is zero
        let least = ROUNDING * (a.abs() + b.abs());
        is_sum.then(|| [a, b].map(|number| if number.abs() <= least { 0.0 } else { number }))
    }
}

/// What stands for tensors in numbers, and which of those is which variable. Of a law of stretches invariants are functions of the
/// stretches too.
fn named(
    graph: &mut Graph,
    energy: Expr,
    text: &LawText,
) -> (HashMap<Expr, Vec<Expr>>, HashMap<Expr, usize>) {
    let deformation = graph.symbol(DEFORMATION, Shape::Matrix);
    let entries: Vec<Expr> =
        (0..ENTRIES).map(|index| graph.own_symbol(&format!("F_{}{}", index % 3, index / 3))).collect();
    let stretches = [1, 2, 3].map(|index| graph.own_symbol(&format!("l{index}")));
    let variables = entries.iter().chain(&stretches).copied().zip(0..).collect();
    let mut given = HashMap::from([(deformation, entries)]);
    for (name, parameter) in &text.parameters {
        if let LawParameter::Direction(direction) = parameter {
            let components = direction.map(|component| graph.number(component)).to_vec();
            given.insert(graph.symbol(name, Shape::Vector), components);
        }
    }
    let decomposition = graph.decompose(deformation);
    if graph.reachable(&[energy]).contains(&decomposition) {
        // energies name the stretches alone, none of the axes
        given.insert(decomposition, Vec::new());
        for (index, stretch) in stretches.into_iter().enumerate() {
            given.insert(graph.stretch(decomposition, index as u8), vec![stretch]);
        }
        let mut sum_of_powers = |power: f64| {
            let powers = stretches.map(|stretch| graph.power_number(stretch, power));
            graph.sum(&powers)
        };
        let (squares, fourths) = (sum_of_powers(2.0), sum_of_powers(4.0));
        let volume = graph.product(&stretches);
        let [C, B] = ["C", "B"].map(|name| vocabulary::quantity(graph, name));
        for tensor in [C, B].into_iter().flatten() {
            given.insert(graph.dot(tensor, tensor), vec![fourths]);
        }
        given.insert(graph.dot(deformation, deformation), vec![squares]);
        given.insert(graph.determinant(deformation), vec![volume]);
    }
    (given, variables)
}

fn number_of(text: &LawText, name: &str) -> Option<f64> {
    text.parameters.iter().find_map(|(known, parameter)| match parameter {
        LawParameter::Number { value, .. } if known == name => Some(*value),
        _ => None,
    })
}

fn constant(value: f64) -> Option<Polynomial> {
    value.is_finite().then(|| Polynomial::constant(value))
}

fn whole(exponent: f64) -> Option<u8> {
    let is_whole = exponent.fract() == 0.0 && (0.0..=f64::from(u8::MAX)).contains(&exponent);
    is_whole.then_some(exponent as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a text has of the parts, each a text too.
    fn sum(energy: &str, parts: [&str; 2]) -> Option<[f64; 2]> {
        let mut expansion = Expansion::default();
        let mut expanded = |energy: &str| {
            let number = |(name, value): (&str, f64)| {
                (name.to_owned(), LawParameter::Number { value, dimension: None })
            };
            let parameters = [("a", 3.0), ("b", 5.0), ("zero", 0.0)].map(number).to_vec();
            let text = LawText { energy: energy.to_owned(), definitions: Vec::new(), parameters };
            assert!(read::read(&text).is_ok(), "{energy}");
            expansion.of(&text)
        };
        let parts = parts.map(|part| expanded(part).unwrap());
        expanded(energy)?.as_sum_of([&parts[0], &parts[1]])
    }

    fn assert_near(energy: &str, parts: [&str; 2], [a, b]: [f64; 2]) {
        let found = sum(energy, parts);
        let is_near =
            found.is_some_and(|[x, y]| (x - a).abs().max((y - b).abs()) <= 1e-13 * (a.abs() + b.abs()));
        assert!(is_near, "{energy}: {found:?}");
    }

    const STRETCHES: [&str; 2] = ["a/3*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2)", "b/5*(l1 + l2 + l3 - 3)^2"];
    const LOGARITHM: [&str; 2] = ["a*(I1 - log(I1 + 1))", "b*(J - 1)^2"];

    /// By stretches, by invariants of them, and with logarithms of products and powers; a part may be missing.
    #[test]
    fn wording_does_not_matter() {
        assert_near(
            "b*(3 - l3 - l1 - l2)^2 + a*((l3 - 1)^2 + (l1 - 1)^2 + (l2 - 1)^2)",
            STRETCHES,
            [3.0, 5.0],
        );
        assert_near("a*(tr(C) - 2*l1 - 2*l2 - 2*l3) + zero*(l1 + l2 + l3 - 3)^2", STRETCHES, [3.0, 0.0]);
        assert_near("1e-9*a*(I1 - 2*(l1 + l2 + l3)) + b*(l1 + l2 + l3 - 3)^2", STRETCHES, [3e-9, 5.0]);
        assert_near("b*I3 + a*I1 - 2*b*J + 2*a*log(3/sqrt(4*I1 + 4))", LOGARITHM, [1.0, 1.0]);
        assert_near("2*a*(I1 - log10((2 + 2*tr(B))^7)/7*log(10))", LOGARITHM, [2.0, 0.0]);
    }

    /// One stretch missing, another power, another number, a term that is tiny, a value that is not everywhere.
    #[test]
    fn what_differs_is_no_sum() {
        for energy in [
            "a*((l1 - 1)^2 + (l2 - 1)^2)",
            "a*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2) + b*(l1 + l2 - 2)^2",
            "a*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2) + b*(l1 + l2 + l3 - 3)^4",
            "a*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2) + b*(l1 + l2 + l3 - 2.99999999)^2",
            "a*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2) + 1e-30*a*l1^2*l2",
            "a*((l1 - 1)^2 + (l2 - 1)^2 + (l3 - 1)^2) + exp(l1)*1e-30*a",
        ] {
            assert_eq!(sum(energy, STRETCHES), None, "{energy}");
        }
        for energy in [
            "a*(I1 - log(I1 + 1.0000001))",
            "a*(I1 - 1.0000001*log(I1 + 1))",
            "a*(I1 - log(I1 + 1)) + 1e-30*a*I1^2",
            "a*(I1 - log(I1 + 1)) + a*(J*log(J) - (J - 1)*log(J) - log(J))",
            "a*(I1 - log(I1 + 1)) + 1e9*a*(I1^2 - tr(C)*(I1 + 1e-12))",
        ] {
            assert_eq!(sum(energy, LOGARITHM), None, "{energy}");
        }
    }
}
