//! A tree of axis-aligned boxes over items: what overlaps a box, what is nearest to a point.
//!
//! Built by median splits of the centres; the same boxes give the same tree. Moving items only need [`AabbTree::refit`].

use souple_math::Vec3;

use crate::BoundingBox;

/// The box of an item of the tree.
pub type Aabb = BoundingBox;

/// Items of one leaf at most.
const LEAF: usize = 4;

/// Deepest path: a median split halves the items, of which there are fewer than 2³².
const MAX_DEPTH: usize = 64;

#[derive(Clone, Debug)]
struct Node {
    bounds: Aabb,
    /// Leaf: first of its items in `order`. Branch: its second child; the first one follows it.
    start: u32,
    /// Number of items of a leaf, zero for a branch.
    count: u32,
}

/// Boxes over numbered items.
#[derive(Clone, Debug, Default)]
pub struct AabbTree {
    nodes: Vec<Node>,
    /// Items in the order of the leaves.
    order: Vec<u32>,
    boxes: Vec<Aabb>,
}

impl AabbTree {
    /// A tree over items `0 … boxes.len()`.
    pub fn build(boxes: &[Aabb]) -> Self {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut tree = Self { nodes: Vec::new(), order: Vec::new(), boxes: boxes.to_vec() };
        let centres: Vec<Vec3> = boxes.iter().map(|bounds| bounds.centre()).collect();
        if !order.is_empty() {
            tree.split(&centres, &mut order, 0);
        }
        tree.order = order;
        tree
    }

    fn split(&mut self, centres: &[Vec3], items: &mut [u32], start: u32) {
        let bounds = items.iter().fold(Aabb::EMPTY, |bounds, item| bounds.union(self.boxes[*item as usize]));
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, start, count: items.len() as u32 });
        if items.len() <= LEAF {
            items.sort_unstable();
            return;
        }
        let size = Aabb::of(items.iter().map(|item| centres[*item as usize])).size();
        let axis = longest_axis(size);
        let middle = items.len() / 2;
        // ties are broken by number, so that the halves do not depend on how they were found
        items.select_nth_unstable_by(middle, |a, b| {
            let [x, y] = [a, b].map(|item| centres[*item as usize][axis]);
            x.total_cmp(&y).then(a.cmp(b))
        });
        let (low, high) = items.split_at_mut(middle);
        self.split(centres, low, start);
        let second = self.nodes.len() as u32;
        self.split(centres, high, start + middle as u32);
        (self.nodes[node].start, self.nodes[node].count) = (second, 0);
    }

    pub fn len(&self) -> usize {
        self.boxes.len()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of::<Aabb>() * self.boxes.capacity()
            + size_of::<Node>() * self.nodes.capacity()
            + 4 * self.order.capacity()
    }

    pub fn is_empty(&self) -> bool {
        self.boxes.is_empty()
    }

    /// Box around all items.
    pub fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, |node| node.bounds)
    }

    /// New boxes for the same items, in the same tree; no allocation.
    ///
    /// # Panics
    /// If their number differs from that at the building.
    pub fn refit(&mut self, boxes: impl ExactSizeIterator<Item = Aabb>) {
        assert_eq!(boxes.len(), self.boxes.len(), "a tree is refitted with the boxes of its own items");
        for (slot, bounds) in self.boxes.iter_mut().zip(boxes) {
            *slot = bounds;
        }
        // children come after their parents
        for index in (0..self.nodes.len()).rev() {
            let node = &self.nodes[index];
            let bounds = if node.count == 0 {
                self.nodes[index + 1].bounds.union(self.nodes[node.start as usize].bounds)
            } else {
                let items = &self.order[node.start as usize..(node.start + node.count) as usize];
                items.iter().fold(Aabb::EMPTY, |bounds, item| bounds.union(self.boxes[*item as usize]))
            };
            self.nodes[index].bounds = bounds;
        }
    }

    /// Calls `visit` with each item whose box overlaps `query`, in the order of the tree.
    pub fn overlapping(&self, query: Aabb, mut visit: impl FnMut(u32)) {
        self.overlapping_while(query, |item| {
            visit(item);
            true
        });
    }

    /// The same until `visit` says no.
    pub fn overlapping_while(&self, query: Aabb, mut visit: impl FnMut(u32) -> bool) {
        let mut stack = [0u32; MAX_DEPTH];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let index = stack[depth] as usize;
            let node = &self.nodes[index];
            if !node.bounds.overlaps(query) {
                continue;
            }
            if node.count == 0 {
                stack[depth] = node.start;
                stack[depth + 1] = index as u32 + 1;
                depth += 2;
                continue;
            }
            for item in &self.order[node.start as usize..(node.start + node.count) as usize] {
                if self.boxes[*item as usize].overlaps(query) && !visit(*item) {
                    return;
                }
            }
        }
    }

    /// The item of least squared distance to `point` as measured by `distance_sq`, which is never less than the
    /// distance to the item's box, and at most `limit`; of equal ones the lowest number.
    pub fn nearest(
        &self,
        point: Vec3,
        limit: f64,
        mut distance_sq: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let mut best: Option<(u32, f64)> = None;
        let mut bound = limit;
        let mut stack = [(0u32, 0.0); MAX_DEPTH];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let (index, distance) = stack[depth];
            if distance > bound {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count == 0 {
                let child = |index: u32| (index, self.nodes[index as usize].bounds.distance_sq(point));
                let (near, far) = (child(index + 1), child(node.start));
                let (near, far) = if far.1 < near.1 { (far, near) } else { (near, far) };
                stack[depth] = far;
                stack[depth + 1] = near;
                depth += 2;
                continue;
            }
            for &item in &self.order[node.start as usize..(node.start + node.count) as usize] {
                if self.boxes[item as usize].distance_sq(point) > bound {
                    continue;
                }
                let measured = distance_sq(item);
                let better = match best {
                    Some((number, least)) => measured < least || (measured == least && item < number),
                    None => measured <= limit,
                };
                if better {
                    best = Some((item, measured));
                    bound = measured;
                }
            }
        }
        best
    }
}

/// The axis along which `size` is longest, the first of equal ones.
pub(crate) fn longest_axis(size: Vec3) -> usize {
    if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes scattered without a pattern, always the same.
    fn boxes(count: usize, seed: f64) -> Vec<Aabb> {
        let fraction = |i: usize, k: f64| ((i as f64 + 1.0) * k + seed).fract();
        let at = |i| Vec3::new(fraction(i, 0.754_877), fraction(i, 0.569_840), fraction(i, 0.438_579));
        (0..count).map(|i| Aabb { low: at(i), high: at(i) + Vec3::new(0.05, 0.02, 0.03) }).collect()
    }

    fn assert_answers(tree: &AabbTree, boxes: &[Aabb]) {
        for query in self::boxes(50, 0.3) {
            let mut found = Vec::new();
            tree.overlapping(query, |item| found.push(item));
            found.sort_unstable();
            let expected: Vec<u32> =
                (0..boxes.len() as u32).filter(|item| boxes[*item as usize].overlaps(query)).collect();
            assert_eq!(found, expected);
            let distance = |item: u32| boxes[item as usize].distance_sq(query.low);
            let nearest = tree.nearest(query.low, f64::INFINITY, distance);
            let expected = (0..boxes.len() as u32)
                .map(|item| (item, distance(item)))
                .min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            assert_eq!(nearest, expected);
        }
    }

    /// The tree finds what a look at every item finds, also after the items have moved.
    #[test]
    fn answers_are_those_of_brute_force() {
        for count in [0, 1, 4, 5, 333] {
            let before = boxes(count, 0.0);
            let mut tree = AabbTree::build(&before);
            assert_eq!(tree.len(), count);
            assert_answers(&tree, &before);
            let after = boxes(count, 0.5);
            tree.refit(after.iter().copied());
            assert_answers(&tree, &after);
        }
    }

    /// Equal centres do not make the tree deeper than halving allows.
    #[test]
    fn equal_boxes() {
        let same = vec![Aabb { low: Vec3::ZERO, high: Vec3::X }; 1000];
        let tree = AabbTree::build(&same);
        assert_eq!(
            tree.nearest(Vec3::Y, 2.0, |item| same[item as usize].distance_sq(Vec3::Y)),
            Some((0, 1.0))
        );
        assert_eq!(tree.nearest(Vec3::Y, 0.5, |item| same[item as usize].distance_sq(Vec3::Y)), None);
    }
}
