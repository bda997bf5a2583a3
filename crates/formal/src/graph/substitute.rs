//! Expressions in the place of others.

use std::collections::HashMap;

use super::{Expr, Graph};
use crate::hashing::Map;

/// What stands for what, and what became of expressions so far: asked for many expressions, each part of them is gone into once.
#[derive(Clone, Debug, Default)]
pub(crate) struct Substitution {
    replacements: Vec<(Expr, Expr)>,
    made: Map<Expr, Expr>,
}

impl Substitution {
    pub fn new(replacements: impl IntoIterator<Item = (Expr, Expr)>) -> Self {
        let replacements: Vec<(Expr, Expr)> = replacements.into_iter().collect();
        Self { made: replacements.iter().copied().collect(), replacements }
    }

    /// Whether the expression has been met.
    pub fn has_met(&self, expr: Expr) -> bool {
        self.made.contains_key(&expr)
    }

    /// Replaces one more from here on. Expressions that hold it and were met are gone into again.
    pub fn replace(&mut self, expr: Expr, by: Expr, is_held: bool) {
        self.replacements.push((expr, by));
        if is_held {
            self.made = self.replacements.iter().copied().collect();
        } else {
            self.made.insert(expr, by);
        }
    }
}

impl Graph {
    /// `expr` with expressions replaced, simplified again where it changed.
    pub fn substitute(&mut self, expr: Expr, replacements: &HashMap<Expr, Expr>) -> Expr {
        let replacements = replacements.iter().map(|(expr, by)| (*expr, *by));
        self.substituted(expr, &mut Substitution::new(replacements))
    }

    /// The same of one of many.
    pub(crate) fn substituted(&mut self, expr: Expr, substitution: &mut Substitution) -> Expr {
        let made = &mut substitution.made;
        let (mut open, mut found) = (vec![expr], Vec::new());
        while let Some(expr) = open.pop() {
            made.entry(expr).or_insert_with(|| {
                found.push(expr);
                open.extend(self.node(expr).operands());
                expr
            });
        }
        found.sort_unstable();
        for old in found {
            if self.node(old).operands().any(|operand| made[&operand] != operand) {
                let new = self.rebuild(old, &|operand| made[&operand]);
                made.insert(old, new);
            }
        }
        made[&expr]
    }
}
