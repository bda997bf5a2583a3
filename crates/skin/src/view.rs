//! A skin's part of State, for those who read it.

use souple_engine::FieldState;

use crate::grid::Grid;
use crate::polygons::Measures;
use crate::skin::{
    AREA, CHANGED, CHECKED, COMPONENTS, COUNTED, EULER, EVENTS, HEAD, HEAD_INDICES, POINTS, SPEED, TRIANGLES,
    VOLUME, WORK,
};

/// A skin's part of State, as a reader sees it.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    pub grid: Grid<'a>,
    head: &'a [f64],
    head_indices: &'a [u64],
    /// Forces on the rows it acts on [N], three numbers each.
    pub reactions: &'a [f64],
}

impl<'a> View<'a> {
    pub fn new(field: &'a FieldState, reactions: usize) -> Self {
        let (head, rest) = field.values.split_at(HEAD);
        let (head_indices, words) = field.indices.split_at(HEAD_INDICES);
        Self { grid: Grid::of_words(words), head, head_indices, reactions: &rest[..3 * reactions] }
    }

    pub fn measures(&self) -> Measures {
        Measures {
            area: self.head[AREA],
            volume: self.head[VOLUME],
            euler: self.head_indices[EULER] as i64,
            components: self.head_indices[COMPONENTS],
        }
    }

    /// Greatest speed of a node beside the surface in the last sub-step [m/s].
    pub fn speed(&self) -> f64 {
        self.head[SPEED]
    }

    /// Times that the number of components or the Euler characteristic changed, as `topology` counts it: for two steps at least, or never as before for eight.
    pub fn events(&self) -> u64 {
        self.head_indices[EVENTS]
    }

    /// When the last of them began [s].
    pub fn changed(&self) -> f64 {
        self.head[CHANGED]
    }

    /// Euler characteristic and components since then.
    pub fn counted_topology(&self) -> (i64, u64) {
        let [euler, components] = COUNTED.map(|index| self.head_indices[index]);
        (euler as i64, components)
    }

    /// Surfaces so far that were checked to be closed, oriented and manifold, and were.
    pub fn checked(&self) -> u64 {
        self.head_indices[CHECKED]
    }

    /// Nodes that the last step worked out, in all its sub-steps.
    pub fn work(&self) -> u64 {
        self.head_indices[WORK]
    }

    /// Points and triangles of the surface.
    pub fn counts(&self) -> [u64; 2] {
        [self.head_indices[POINTS], self.head_indices[TRIANGLES]]
    }
}
