//! Common parts of sums and products: pairs of addends or factors that stand in several of them are computed once.
//!
//! Sums and products are flat, so that equal ones are one expression; what two of them have in common is no expression then.
//! Here the pair that most of them share is taken out first, then the next, until all pairs are single. What comes out nests
//! sums in sums and products in products: it is meant to be evaluated, and simplifying it again would flatten it.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

use super::{Expr, Graph, Node, Shape};
use crate::hashing::Map;

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

impl Graph {
    /// Expressions of numbers in which what sums or products have in common is one expression.
    pub fn shared(&mut self, roots: &[Expr]) -> Vec<Expr> {
        let products = self.shared_of(Kind::Product, roots);
        self.shared_of(Kind::Sum, &products)
    }

    fn shared_of(&mut self, kind: Kind, roots: &[Expr]) -> Vec<Expr> {
        let reachable = self.reachable(roots);
        let mut lists: Vec<List> = Vec::new();
        let mut list_of: Map<Expr, usize> = Map::default();
        for expr in &reachable {
            if let Some(list) = self.list_of(kind, *expr) {
                list_of.insert(*expr, lists.len());
                lists.push(list);
            }
        }
        let pairs = take_out(&mut lists);
        let mut made: Map<Expr, Expr> = Map::default();
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
        made: &Map<Expr, Expr>,
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
    let mut written: Vec<Part> = lists.iter().flat_map(|list| &list.parts).map(|(_, part)| *part).collect();
    written.sort_unstable();
    // what one list has alone is in no pair that several have; pairs are as many as the square of the others
    let shared: Vec<Part> =
        written.chunk_by(|a, b| a == b).filter(|equal| equal.len() > 1).map(|equal| equal[0]).collect();
    let mut pairing =
        Pairing { lists: lists.iter().map(|list| numbered(list, &shared)).collect(), ..Pairing::default() };
    pairing.find_first(shared.len());
    let mut pairs = Vec::new();
    let part_of = |number: u32| match shared.get(number as usize) {
        Some(part) => *part,
        None => Part::Pair(number as usize - shared.len()),
    };
    while let Some(([a, b], differ, users)) = pairing.most_frequent() {
        let new = (shared.len() + pairs.len()) as u32;
        let pair = (part_of(a), part_of(b), differ);
        for user in &users {
            let sign = pairing.merge(*user, [a, b], new);
            let parts = &mut lists[*user as usize].parts;
            parts.retain(|(_, part)| *part != pair.0 && *part != pair.1);
            parts.push((sign, Part::Pair(pairs.len())));
        }
        pairing.find_with(new, &users);
        pairs.push(pair);
    }
    pairs
}

/// The numbers of a list's shared parts, ascending, with their signs.
fn numbered(list: &List, shared: &[Part]) -> Vec<(u32, bool)> {
    let number = |(sign, part): &(bool, Part)| Some((shared.binary_search(part).ok()? as u32, *sign));
    let mut numbers: Vec<(u32, bool)> = list.parts.iter().filter_map(number).collect();
    numbers.sort_unstable();
    numbers
}

/// A pair that several lists had when it was found. It gets no more of them: a pair is found when the later of its parts is made.
struct Candidate {
    parts: [u32; 2],
    differ: bool,
    /// Among [`Pairing::users`]; those that have it no more are left out when it is looked at.
    users: Range<usize>,
}

/// How many lists have a candidate, its parts and whether their signs differ, and its number.
type Queued = (usize, Reverse<([u32; 2], bool)>, usize);

/// The pairs of all lists by the numbers of their parts, which ascend as parts do.
#[derive(Default)]
struct Pairing {
    /// Ascending by part.
    lists: Vec<Vec<(u32, bool)>>,
    candidates: Vec<Candidate>,
    /// Lists of candidates, one after another.
    users: Vec<u32>,
    /// How many lists had a candidate when it was last looked at; most first, then the first pair.
    queue: BinaryHeap<Queued>,
    /// By number of a part and whether signs differ: how many lists have it beside the part in question, and of which candidate that is.
    counts: Vec<[(u32, usize); 2]>,
}

impl Pairing {
    /// Finds the pairs of the first `count` parts.
    fn find_first(&mut self, count: usize) {
        let mut holders: Vec<Vec<u32>> = vec![Vec::new(); count];
        for (list, parts) in self.lists.iter().enumerate() {
            parts.iter().for_each(|(part, _)| holders[*part as usize].push(list as u32));
        }
        for (part, holders) in holders.iter().enumerate() {
            let after = |parts: &[(u32, bool)]| parts.partition_point(|(other, _)| *other as usize <= part);
            self.find(part as u32, holders, |parts| after(parts)..parts.len());
        }
    }

    /// Finds the pairs of a new part, the last, that these lists have.
    fn find_with(&mut self, new: u32, users: &[u32]) {
        self.find(new, users, |parts| 0..parts.len() - 1);
    }

    /// Finds the pairs of a part in the lists that have it, with those parts that stand in `range`.
    fn find(&mut self, part: u32, holders: &[u32], range: impl Fn(&[(u32, bool)]) -> Range<usize>) {
        let Self { lists, candidates, users, queue, counts } = self;
        if holders.len() < 2 {
            return;
        }
        let others = |list: u32| {
            let parts = &lists[list as usize];
            let own = parts.binary_search_by_key(&part, |(other, _)| *other);
            let sign = own.is_ok_and(|place| parts[place].1);
            parts[range(parts)].iter().map(move |(other, of_other)| (*other, *of_other != sign))
        };
        for (other, differ) in holders.iter().flat_map(|list| others(*list)) {
            if counts.len() <= other as usize {
                counts.resize(other as usize + 1, [(0, 0); 2]);
            }
            counts[other as usize][usize::from(differ)].0 += 1;
        }
        for list in holders {
            for (other, differ) in others(*list) {
                let (count, candidate) = &mut counts[other as usize][usize::from(differ)];
                if *count > 1 && *count != MET {
                    // the first list that has it makes room for all
                    let start = users.len();
                    users.resize(start + *count as usize, 0);
                    *candidate = candidates.len();
                    let parts = [part.min(other), part.max(other)];
                    queue.push((*count as usize, Reverse((parts, differ)), *candidate));
                    candidates.push(Candidate { parts, differ, users: start..start });
                    *count = MET;
                }
                if *count == MET {
                    let place = &mut candidates[*candidate].users.end;
                    users[*place] = *list;
                    *place += 1;
                }
            }
        }
        for (other, differ) in holders.iter().flat_map(|list| others(*list)) {
            counts[other as usize][usize::from(differ)].0 = 0;
        }
    }

    /// The pair that most lists have, the first of several, and which lists.
    fn most_frequent(&mut self) -> Option<([u32; 2], bool, Vec<u32>)> {
        while let Some((count, _, index)) = self.queue.pop() {
            let Candidate { parts, differ, users } = &mut self.candidates[index];
            // lists lose parts and get new ones only: counts fall
            let mut end = users.start;
            for place in users.clone() {
                let user = self.users[place];
                if has(&self.lists[user as usize], *parts, *differ) {
                    self.users[end] = user;
                    end += 1;
                }
            }
            users.end = end;
            if users.len() == count {
                return Some((*parts, *differ, self.users[users.clone()].to_vec()));
            }
            if users.len() > 1 {
                self.queue.push((users.len(), Reverse((*parts, *differ)), index));
            }
        }
        None
    }

    /// Puts a part, the last, in the place of two; gives its sign.
    fn merge(&mut self, list: u32, [a, b]: [u32; 2], new: u32) -> bool {
        let parts = &mut self.lists[list as usize];
        // pairs are of parts that are there
        let sign = parts.iter().find(|(part, _)| *part == a).is_some_and(|(_, sign)| *sign);
        parts.retain(|(part, _)| *part != a && *part != b);
        parts.push((new, sign));
        sign
    }
}

/// In the place of a count: the pair is a candidate.
const MET: u32 = u32::MAX;

fn has(parts: &[(u32, bool)], pair: [u32; 2], differ: bool) -> bool {
    let sign =
        |part: u32| parts.binary_search_by_key(&part, |(other, _)| *other).ok().map(|place| parts[place].1);
    let [a, b] = pair.map(sign);
    a.zip(b).is_some_and(|(a, b)| (a != b) == differ)
}
