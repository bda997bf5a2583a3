//! Motions that no sample of an element sees: where there are fewer strains at the points of a rule than ways to move.

use super::ElementKind;
use crate::QuadratureRule;

/// Of the largest entry of the strains; entries are of order one and no more than a few hundred are summed.
const RANK_TOLERANCE: f64 = 1e-10;

impl ElementKind {
    /// How many motions of a cell that is held by all nodes of one face have no strain at the points of a rule, of all its faces the
    /// most. A bar that is one cell thick moves by them without resistance; whether neighbours at the other sides hold them depends on
    /// the element: of twenty nodes and eight points they do, of twenty-seven they do not.
    pub fn unstrained_motions(self, rule: &QuadratureRule) -> usize {
        let free_of = |face: &super::Face| -> Vec<usize> {
            (0..self.node_count())
                .filter(|node| face.nodes.iter().all(|held| usize::from(*held) != *node))
                .collect()
        };
        let motions = |free: Vec<usize>| {
            let strains = self.strains(rule, &free);
            self.dimension() * free.len() - rank(strains)
        };
        self.faces().iter().map(free_of).map(motions).max().unwrap_or(0)
    }

    /// `ε` at the points of a rule, a row for each of its components, for motions of nodes by one: a column for each of theirs.
    fn strains(self, rule: &QuadratureRule, nodes: &[usize]) -> Vec<Vec<f64>> {
        let dimension = self.dimension();
        let pairs: Vec<[usize; 2]> =
            (0..dimension).flat_map(|a| (a..dimension).map(move |b| [a, b])).collect();
        let mut rows = Vec::new();
        for point in &rule.points {
            let gradients = self.shape_gradients(point.position);
            rows.extend(pairs.iter().map(|[a, b]| {
                let of_node = |node: &usize| {
                    let gradient = gradients[*node].to_array();
                    (0..dimension).map(move |axis| {
                        let along =
                            |axis_of: usize, by: usize| if axis == axis_of { gradient[by] } else { 0.0 };
                        0.5 * (along(*a, *b) + along(*b, *a))
                    })
                };
                nodes.iter().flat_map(of_node).collect::<Vec<f64>>()
            }));
        }
        rows
    }
}

/// Rank of a matrix by its rows, by elimination with the largest entry of each column.
fn rank(mut rows: Vec<Vec<f64>>) -> usize {
    let largest = rows.iter().flatten().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    let columns = rows.first().map_or(0, Vec::len);
    let mut rank = 0;
    for column in 0..columns {
        let at = |row: &Vec<f64>| row[column].abs();
        let Some(best) = (rank..rows.len()).max_by(|a, b| at(&rows[*a]).total_cmp(&at(&rows[*b]))) else {
            break;
        };
        if at(&rows[best]) <= RANK_TOLERANCE * largest {
            continue;
        }
        rows.swap(rank, best);
        let (done, rest) = rows.split_at_mut(rank + 1);
        let pivot = &done[rank];
        for row in rest {
            let factor = row[column] / pivot[column];
            row.iter_mut().zip(pivot).for_each(|(entry, of_pivot)| *entry -= factor * of_pivot);
        }
        rank += 1;
    }
    rank
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a trilinear cell of one point every way of its free corners but six strains; eight points see them all. Of twenty nodes they miss
    /// `((1 + ζ) ξ (3 η² - 1), -(1 + ζ) η (3 ξ² - 1), 0)`. Every element's own rules see all there is to see.
    #[test]
    fn points_see_motions() {
        let of = |kind: ElementKind, rule: &str| kind.unstrained_motions(kind.rule(rule).unwrap());
        assert_eq!(of(ElementKind::Hex8, "gauss_1"), 12 - 6);
        assert_eq!(of(ElementKind::Hex8, "gauss_8"), 0);
        assert_eq!(of(ElementKind::Hex20, "gauss_8"), 1);
        assert_eq!(of(ElementKind::Quad8, "gauss_4"), 0);
        assert!(of(ElementKind::Hex27, "gauss_8") > 1);
        assert_eq!(of(ElementKind::Quad9, "gauss_4"), 0);
        for kind in ElementKind::ALL.iter().filter(|kind| kind.dimension() > 1) {
            for rule in [kind.default_rule(), kind.full_rule()] {
                assert_eq!(kind.unstrained_motions(rule), 0, "{} {}", kind.name(), rule.name);
            }
        }
    }

    #[test]
    fn ranks_are_known() {
        assert_eq!(rank(vec![vec![1.0, 2.0], vec![2.0, 4.0], vec![0.0, 1.0]]), 2);
        assert_eq!(rank(vec![vec![0.0, 3.0], vec![0.0, 6.0]]), 1);
        assert_eq!(rank(vec![vec![0.0, 0.0]]), 0);
        assert_eq!(rank(Vec::new()), 0);
    }
}
