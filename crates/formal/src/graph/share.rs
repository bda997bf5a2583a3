//! Common parts of sums and products: pairs of addends or factors that stand in several of them are computed once.
//!
//! Sums and products are flat, so that equal ones are one expression; what two of them have in common is no expression then.
//! Here the pair that most of them share is taken out first, then the next, until all pairs are single. What comes out nests
//! sums in sums and products in products: it is meant to be evaluated, and simplifying it again would flatten it.

use std::cmp::Reverse;
use std::collections::{BTreeSet, HashMap};

use super::{Expr, Graph, Node, Shape};

/// What a list is of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Sum,
    Product,
}

/// An addend or factor: one of those that were written, or a pair that was taken out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Part {
    Written(Expr),
    Pair(usize),
}

/// Two parts in ascending order, and whether their signs differ.
type Pair = (Part, Part, bool);

/// A sum or product as its parts with their signs; a product has one for all, before it.
#[derive(Clone, Debug, Default)]
struct List {
    is_negative: bool,
    parts: Vec<(bool, Part)>,
}

/// The pairs of all lists, and those that several have, those that most have first.
#[derive(Default)]
struct Counts {
    lists_of: HashMap<Pair, Vec<usize>>,
    by_count: BTreeSet<(Reverse<usize>, Pair)>,
}

impl Counts {
    fn change(&mut self, pair: Pair, list: usize, is_there: bool) {
        let lists = self.lists_of.entry(pair).or_default();
        if lists.len() > 1 {
            self.by_count.remove(&(Reverse(lists.len()), pair));
        }
        if is_there {
            lists.push(list);
        } else {
            lists.retain(|other| *other != list);
        }
        if lists.len() > 1 {
            self.by_count.insert((Reverse(lists.len()), pair));
        }
    }

    /// The pair that most lists have, the first of several, and which lists.
    fn most_frequent(&self) -> Option<(Pair, Vec<usize>)> {
        let (_, pair) = *self.by_count.first()?;
        let mut lists = self.lists_of[&pair].clone();
        lists.sort_unstable();
        Some((pair, lists))
    }
}

fn pair_of((a_sign, a): (bool, Part), (b_sign, b): (bool, Part)) -> Pair {
    (a.min(b), a.max(b), a_sign != b_sign)
}

impl Graph {
    /// Expressions of numbers in which what sums or products have in common is one expression.
    pub fn shared(&mut self, roots: &[Expr]) -> Vec<Expr> {
        let products = self.shared_of(Kind::Product, roots);
        self.shared_of(Kind::Sum, &products)
    }

    fn shared_of(&mut self, kind: Kind, roots: &[Expr]) -> Vec<Expr> {
        let reachable = self.reachable(roots);
        let mut lists: Vec<List> = Vec::new();
        let mut list_of: HashMap<Expr, usize> = HashMap::new();
        for expr in &reachable {
            if let Some(list) = self.list_of(kind, *expr) {
                list_of.insert(*expr, lists.len());
                lists.push(list);
            }
        }
        let pairs = take_out(&mut lists);
        let mut made: HashMap<Expr, Expr> = HashMap::new();
        let mut made_pairs: Vec<Option<Expr>> = vec![None; pairs.len()];
        for expr in reachable {
            let new = match list_of.get(&expr) {
                Some(index) => {
                    let List { is_negative, parts } = &lists[*index];
                    let parts: Vec<(bool, Expr)> = parts
                        .iter()
                        .map(|(sign, part)| (*sign, self.build(kind, *part, &pairs, &made, &mut made_pairs)))
                        .collect();
                    self.nested(kind, *is_negative, &parts)
                }
                None if matches!(self.node(expr), Node::Sum(_) | Node::Product(_)) => {
                    let node = self.node(expr).clone();
                    let operands: Vec<Expr> = node.operands().map(|operand| made[&operand]).collect();
                    let shape = self.shape(expr);
                    self.flat(matches!(node, Node::Sum(_)), operands, shape)
                }
                None => self.rebuild(expr, &|operand| made[&operand]),
            };
            made.insert(expr, new);
        }
        roots.iter().map(|root| made[root]).collect()
    }

    /// A sum or product of numbers as its parts.
    fn list_of(&mut self, kind: Kind, expr: Expr) -> Option<List> {
        let node = self.node(expr).clone();
        match (kind, node) {
            (Kind::Sum, Node::Sum(terms)) if self.shape(expr) == Shape::Scalar => {
                let parts = terms.iter().map(|term| {
                    let (sign, rest) = self.without_sign(*term);
                    (sign, Part::Written(rest))
                });
                Some(List { is_negative: false, parts: parts.collect() })
            }
            (Kind::Product, Node::Product(factors)) => {
                let is_sign = |graph: &Self, factor: Expr| graph.value(factor) == Some(-1.0);
                let is_negative = factors.iter().any(|factor| is_sign(self, *factor));
                let parts = factors.iter().filter(|factor| !is_sign(self, **factor));
                Some(List {
                    is_negative,
                    parts: parts.map(|factor| (false, Part::Written(*factor))).collect(),
                })
            }
            _ => None,
        }
    }

    /// Whether there is a minus before an expression, and what stands behind it.
    fn without_sign(&mut self, expr: Expr) -> (bool, Expr) {
        let Node::Product(factors) = self.node(expr).clone() else { return (false, expr) };
        let Some(sign) = factors.iter().position(|factor| self.value(*factor) == Some(-1.0)) else {
            return (false, expr);
        };
        let mut rest = factors.to_vec();
        rest.remove(sign);
        let rest = if rest.len() == 1 { rest[0] } else { self.flat(false, rest, Shape::Scalar) };
        (true, rest)
    }

    fn build(
        &mut self,
        kind: Kind,
        part: Part,
        pairs: &[Pair],
        made: &HashMap<Expr, Expr>,
        made_pairs: &mut [Option<Expr>],
    ) -> Expr {
        match part {
            Part::Written(expr) => match made.get(&expr) {
                Some(new) => *new,
                // what stands behind a minus was no expression of its own: its factors are old
                None => {
                    let Node::Product(factors) = self.node(expr).clone() else { return expr };
                    let factors = factors.iter().map(|factor| made[factor]).collect();
                    self.flat(false, factors, Shape::Scalar)
                }
            },
            Part::Pair(index) => {
                if let Some(made) = made_pairs[index] {
                    return made;
                }
                let (a, b, differ) = pairs[index];
                let [a, b] = [a, b].map(|part| self.build(kind, part, pairs, made, made_pairs));
                let pair = self.nested(kind, false, &[(false, a), (differ, b)]);
                made_pairs[index] = Some(pair);
                pair
            }
        }
    }

    fn nested(&mut self, kind: Kind, is_negative: bool, parts: &[(bool, Expr)]) -> Expr {
        let mut operands: Vec<Expr> =
            parts.iter().map(|(sign, part)| if *sign { self.minus(*part) } else { *part }).collect();
        if is_negative {
            operands.push(self.number(-1.0));
        }
        if operands.len() == 1 { operands[0] } else { self.flat(kind == Kind::Sum, operands, Shape::Scalar) }
    }

    /// `-expr` without a look at what it is.
    fn minus(&mut self, expr: Expr) -> Expr {
        let sign = self.number(-1.0);
        match self.node(expr).clone() {
            Node::Product(factors) => {
                let factors = factors.iter().copied().chain([sign]).collect();
                self.flat(false, factors, Shape::Scalar)
            }
            _ => self.flat(false, vec![expr, sign], Shape::Scalar),
        }
    }

    /// A sum or product as it is, whatever its operands are.
    fn flat(&mut self, is_sum: bool, mut operands: Vec<Expr>, shape: Shape) -> Expr {
        operands.sort_unstable();
        let operands = operands.into();
        self.intern(if is_sum { Node::Sum(operands) } else { Node::Product(operands) }, shape)
    }
}

/// Takes pairs out of lists until none stands in several; gives what they are of, the first of each with a plus.
fn take_out(lists: &mut [List]) -> Vec<Pair> {
    let mut counts = Counts::default();
    let mut users: HashMap<Part, usize> = HashMap::new();
    lists.iter().flat_map(|list| &list.parts).for_each(|(_, part)| *users.entry(*part).or_default() += 1);
    // what one list has alone is in no pair that several have; pairs are as many as the square of the others
    let is_shared = |(_, part): &(bool, Part)| users.get(part).is_none_or(|count| *count > 1);
    let mut shared: Vec<Vec<(bool, Part)>> =
        lists.iter().map(|list| list.parts.iter().copied().filter(is_shared).collect()).collect();
    for (index, shared) in shared.iter().enumerate() {
        for (position, a) in shared.iter().enumerate() {
            shared[..position].iter().for_each(|b| counts.change(pair_of(*a, *b), index, true));
        }
    }
    let mut pairs = Vec::new();
    while let Some((pair, users)) = counts.most_frequent() {
        let new = Part::Pair(pairs.len());
        pairs.push(pair);
        let is_taken = |(_, part): &(bool, Part)| *part == pair.0 || *part == pair.1;
        for user in users {
            let (parts, shared) = (&mut lists[user].parts, &mut shared[user]);
            let taken: Vec<usize> = (0..shared.len()).filter(|place| is_taken(&shared[*place])).collect();
            for &place in &taken {
                let others = (0..shared.len()).filter(|other| *other != place);
                // a pair of two that are taken is one pair
                for other in others.filter(|other| *other < place || !taken.contains(other)) {
                    let (later, earlier) = (shared[place.max(other)], shared[place.min(other)]);
                    counts.change(pair_of(later, earlier), user, false);
                }
            }
            let first = shared.iter().find(|(_, part)| *part == pair.0);
            // pairs are of parts that are there
            let sign = first.is_some_and(|(sign, _)| *sign);
            parts.retain(|part| !is_taken(part));
            shared.retain(|part| !is_taken(part));
            for other in shared.iter() {
                counts.change(pair_of(*other, (sign, new)), user, true);
            }
            parts.push((sign, new));
            shared.push((sign, new));
        }
    }
    pairs
}
