//! Numbers in sets that are joined one after the other.

/// The sets of `0..n`, each called by its lowest number (a union-find forest).
#[derive(Clone, Debug, Default)]
pub struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    /// Each number in a set of its own.
    pub fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    /// Adds the next number, in a set of its own, and returns it.
    pub fn add(&mut self) -> u32 {
        let next = self.parent.len() as u32;
        self.parent.push(next);
        next
    }

    pub fn clear(&mut self) {
        self.parent.clear();
    }

    /// How many sets there are.
    pub fn count(&self) -> usize {
        self.parent.iter().enumerate().filter(|(number, parent)| *number as u32 == **parent).count()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * self.parent.capacity()
    }

    /// The lowest number of the set of one.
    #[inline(always)]
    pub fn of(&mut self, mut number: u32) -> u32 {
        while self.parent[number as usize] != number {
            // the path is halved on the way
            let grandparent = self.parent[self.parent[number as usize] as usize];
            self.parent[number as usize] = grandparent;
            number = grandparent;
        }
        number
    }

    /// Makes the sets of two numbers one; whether they were two.
    #[inline(always)]
    pub fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.of(a), self.of(b));
        self.parent[a.max(b) as usize] = a.min(b);
        a != b
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sets have the lowest of their numbers as name, whatever the order they were joined in.
    #[test]
    fn sets_are_called_by_their_lowest_number() {
        let mut sets = Sets::new(5);
        assert_eq!((sets.add(), sets.count()), (5, 6));
        assert!([(4, 5), (5, 2), (1, 3)].into_iter().all(|(a, b)| sets.join(a, b)));
        assert!(!sets.join(2, 4) && sets.count() == 3);
        assert_eq!([0, 1, 2, 3, 4, 5].map(|number| sets.of(number)), [0, 1, 2, 1, 2, 2]);
    }
}
