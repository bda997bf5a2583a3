//! Blocks wake where the band comes to, and are dropped where it has left.

use crate::grid::{EDGE, FARTHEST, Found, Grid, Neighbours, block_of, key_of, neighbour, steps_to};
use crate::marks::{ALL, FIRST_X, FIRST_Y, LAST_X, Layers, Marks, NONE};

/// Blocks come and go with the surface.
#[derive(Clone, Debug, Default)]
pub struct Waking {
    /// Whether each block is asked for, by itself or by a neighbour.
    wanted: Vec<bool>,
    /// Keys of blocks that come, and on which side of the skin they were.
    woken: Vec<(u64, Found)>,
    /// Where each block to be comes from.
    sources: Vec<Found>,
    field: Vec<u64>,
    marks: Vec<Marks>,
}

/// A skin that would leave its space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Runaway;

impl Waking {
    /// Of a field of State, its grid after so many integers: wakes the blocks that the band has come to, and drops those that
    /// it has left; `neighbours` are those of before the move, `marks` those of the values, and stay so. `true`: the blocks
    /// changed.
    ///
    /// # Errors
    /// A block would lie beyond the farthest.
    pub fn update(
        &mut self,
        field: &mut Vec<u64>,
        head: usize,
        neighbours: &Neighbours,
        marks: &mut Vec<Marks>,
    ) -> Result<bool, Runaway> {
        let grid = Grid::of_words(&field[head..]);
        let count = grid.keys.len();
        self.wanted.clear();
        self.wanted.resize(count, false);
        self.woken.clear();
        for block in 0..count {
            self.wake_around(grid, neighbours, marks, block)?;
        }
        if self.woken.is_empty() && self.wanted.iter().all(|wanted| *wanted) {
            return Ok(false);
        }
        self.woken.sort_unstable_by_key(|(key, _)| *key);
        self.woken.dedup_by_key(|(key, _)| *key);
        self.rebuild(field, head, marks);
        Ok(true)
    }

    fn wake_around(
        &mut self,
        grid: Grid,
        neighbours: &Neighbours,
        marks: &[Marks],
        block: usize,
    ) -> Result<(), Runaway> {
        let Marks { inside, band } = marks[block];
        if band == NONE && (inside == NONE || inside == ALL) {
            // at rest by itself; neighbours may still ask for it, and it for those of another sign
            let sign = inside[0];
            let faces_other = |number: usize| match neighbours.of(block, number) {
                Found::Kept(index) => {
                    let others: Layers = std::array::from_fn(|z| marks[index as usize].inside[z] ^ sign);
                    touches(&others, 26 - number)
                }
                _ => false,
            };
            self.wanted[block] |= (0..27).any(faces_other);
        } else {
            self.wanted[block] = true;
        }
        for number in 0..27 {
            if number == neighbour(0, 0, 0) {
                continue;
            }
            let other = neighbours.of(block, number);
            let differs: Layers = match other {
                Found::Kept(_) => band,
                Found::Inside => std::array::from_fn(|z| band[z] | !inside[z]),
                Found::Outside => std::array::from_fn(|z| band[z] | inside[z]),
            };
            if !touches(&differs, number) {
                continue;
            }
            match other {
                Found::Kept(index) => self.wanted[index as usize] = true,
                _ => {
                    let place = block_of(grid.keys[block]);
                    let steps = steps_to(number);
                    let place = [0, 1, 2].map(|axis| place[axis] + i64::from(steps[axis]));
                    if place.iter().any(|c| c.abs() >= FARTHEST) {
                        return Err(Runaway);
                    }
                    self.woken.push((key_of(place), other));
                    self.wanted[block] = true;
                }
            }
        }
        Ok(())
    }

    /// Merges what is kept with what is woken.
    fn rebuild(&mut self, field: &mut Vec<u64>, head: usize, marks: &mut Vec<Marks>) {
        let grid = Grid::of_words(&field[head..]);
        self.field.clear();
        self.field.extend_from_slice(&field[..head]);
        self.sources.clear();
        let mut woken = self.woken.iter().copied().peekable();
        for (index, key) in grid.keys.iter().enumerate() {
            while let Some((new, source)) = woken.next_if(|(new, _)| new < key) {
                self.field.push(new);
                self.sources.push(source);
            }
            if self.wanted[index] {
                self.field.push(*key);
                self.sources.push(Found::Kept(index as u32));
            }
        }
        for (new, source) in woken {
            self.field.push(new);
            self.sources.push(source);
        }
        self.marks.clear();
        for source in &self.sources {
            self.field.extend_from_slice(bytemuck::cast_slice(grid.of(*source)));
            self.marks.push(match *source {
                Found::Kept(index) => marks[index as usize],
                uniform => Marks::of_uniform(uniform),
            });
        }
        std::mem::swap(field, &mut self.field);
        std::mem::swap(marks, &mut self.marks);
    }

    pub fn bytes(&self) -> usize {
        size_of::<Marks>() * self.marks.capacity()
            + self.wanted.capacity()
            + size_of::<(u64, Found)>() * self.woken.capacity()
            + 8 * (self.sources.capacity() + self.field.capacity())
    }
}

/// Whether a set has nodes at the border towards a neighbour.
fn touches(set: &Layers, number: usize) -> bool {
    let [dx, dy, dz] = steps_to(number);
    let mask = [FIRST_X, !0, LAST_X][(dx + 1) as usize] & [FIRST_Y, !0, FIRST_Y << 56][(dy + 1) as usize];
    match dz {
        -1 => set[0] & mask != 0,
        1 => set[EDGE - 1] & mask != 0,
        _ => set.iter().any(|layer| layer & mask != 0),
    }
}
