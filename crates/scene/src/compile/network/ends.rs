//! Which masses links join, and which are near each other: never more than memory holds.

use std::collections::HashMap;
use std::ops::Range;

use souple_math::Vec3;
use souple_mesh::MeshSize;

use super::super::memory;
use crate::diagnostic::{Code, Log, Site};
use crate::spec::network::{Join, LinkTable, Network};

/// Numbers of the masses of two groups, the same where there is one; all masses where none is named. `None` for an
/// unknown name.
pub fn groups(of: &[String], network: &Network) -> Option<(Range<u32>, Range<u32>)> {
    let find = |name: &String| network.numbers_of(name);
    let all = 0..network.mass_count() as u32;
    Some(match of {
        [] => (all.clone(), all),
        [one] => (find(one)?, find(one)?),
        [one, other, ..] => (find(one)?, find(other)?),
    })
}

/// Masses and links that a network has at least: what masses find within their reach is not counted.
pub fn size(network: &Network) -> MeshSize {
    let links = |table: &LinkTable| {
        let (first, last) = groups(&table.of, network)?;
        Some(match table.join.as_ref()? {
            Join::Chain => first.len().saturating_sub(1) as u64,
            Join::Loop => first.len() as u64,
            Join::Paired => first.len().min(last.len()) as u64,
            Join::All => pair_count(&first, &last),
            Join::Reach(_) => 0,
            Join::Ends(from, _) => from.len() as u64,
        })
    };
    MeshSize { points: network.mass_count(), cells: network.links.iter().filter_map(links).sum() }
}

/// The masses that a table of links joins, at most `most` pairs; `None` where it was refused.
pub fn of_table(
    table: &LinkTable,
    network: &Network,
    points: &[Vec3],
    most: usize,
    log: &Log,
) -> Option<Vec<[u32; 2]>> {
    joined((table.join.as_ref()?, &table.of, &table.site, "link"), network, points, most, log)
}

/// The masses of groups that are joined in a way, likewise; what is refused is so at the site, and called by a word.
pub fn joined(
    (join, of, site, word): (&Join, &[String], &Site, &str),
    network: &Network,
    points: &[Vec3],
    most: usize,
    log: &Log,
) -> Option<Vec<[u32; 2]>> {
    let (first, last) = groups(of, network)?;
    let too_many = |links: String, expected: &str| {
        let message = format!("{links}, and memory holds no more than {most}");
        log.add(Code::TooLarge, site, message, expected);
    };
    let mut ends: Vec<[u32; 2]> = match join {
        Join::Chain => first.clone().zip(first.skip(1)).map(|(a, b)| [a, b]).collect(),
        Join::Loop if first.len() < 3 => {
            let message = format!("a loop of {} masses", first.len());
            log.add(Code::Conflict, site, message, "at least three masses, or a chain");
            return None;
        }
        Join::Loop => {
            let next = first.clone().cycle().skip(1);
            first.zip(next).map(|(a, b)| [a, b]).collect()
        }
        Join::Paired if first.len() != last.len() || first == last => {
            let message = format!("groups of {} and {} masses are no pairs", first.len(), last.len());
            log.add(Code::Conflict, site, message, "two groups of as many masses");
            return None;
        }
        Join::Paired => first.zip(last).map(|(a, b)| [a, b]).collect(),
        Join::All => {
            let count = pair_count(&first, &last);
            if count > most as u64 {
                let links = format!("{count} {word}s between every pair");
                too_many(links, "`reach`, which joins neighbours only");
                return None;
            }
            let all = first.clone().flat_map(|a| last.clone().map(move |b| [a, b]));
            all.filter(|[a, b]| is_pair(&first, &last, *a, *b)).collect()
        }
        Join::Reach(reach) => match near(points, first, last, *reach, most) {
            Some(ends) => ends,
            None => {
                too_many(format!("more than {most} {word}s of at most {reach} m"), "a shorter reach");
                return None;
            }
        },
        Join::Ends(from, to) => listed((site, word), [from, to], [&first, &last], log)?,
    };
    if ends.is_empty() {
        log.add(Code::EmptyRegion, site, "no masses are joined", "a longer reach, or other groups");
        return None;
    }
    ends.shrink_to_fit();
    Some(ends)
}

/// Links that are written one by one; `None` where one was refused.
fn listed(
    (site, word): (&Site, &str),
    [from, to]: [&[u32]; 2],
    [first, last]: [&Range<u32>; 2],
    log: &Log,
) -> Option<Vec<[u32; 2]>> {
    let mut ends = Vec::with_capacity(from.len());
    for (index, (a, b)) in from.iter().zip(to).enumerate() {
        for (key, number, group) in [("from", a, first), ("to", b, last)] {
            if *number as usize >= group.len() {
                let message = format!("{key}[{index}] is mass {number}, but the group has {}", group.len());
                let expected = format!("numbers below {}", group.len());
                log.add(Code::OutOfRange, site, message, expected);
                return None;
            }
        }
        let pair = [first.start + a, last.start + b];
        if pair[0] == pair[1] {
            let message = format!("{word} {index} joins mass {a} to itself");
            log.add(Code::Conflict, site, message, format!("two masses for the two ends of a {word}"));
            return None;
        }
        ends.push(pair);
    }
    Some(ends)
}

/// Whether the pairs of a crowd that are in range of each other at the start fit into memory.
pub fn may_crowd(first: Range<u32>, last: Range<u32>, range: f64, points: &[Vec3]) -> bool {
    let most = memory::pairs_that_fit();
    pair_count(&first, &last) <= most as u64 || Neighbours::new(points, first, last, range).are_at_most(most)
}

/// Pairs of one group once, those of two all.
fn is_pair(first: &Range<u32>, last: &Range<u32>, a: u32, b: u32) -> bool {
    if first == last { a < b } else { a != b }
}

fn pair_count(first: &Range<u32>, last: &Range<u32>) -> u64 {
    let (first_count, last_count) = (first.len() as u64, last.len() as u64);
    if first == last { first_count * first_count.saturating_sub(1) / 2 } else { first_count * last_count }
}

/// Pairs of two groups at most `reach` apart, in the order of the first, then of the second; `None` where there are more
/// than `most`.
pub(super) fn near(
    points: &[Vec3],
    first: Range<u32>,
    last: Range<u32>,
    reach: f64,
    most: usize,
) -> Option<Vec<[u32; 2]>> {
    let may_be_too_many = pair_count(&first, &last) > most as u64;
    let neighbours = Neighbours::new(points, first.clone(), last, reach);
    if may_be_too_many && !neighbours.are_at_most(most) {
        return None;
    }
    let mut ends = Vec::new();
    for a in first {
        let start = ends.len();
        ends.extend(neighbours.of(a).map(|b| [a, b]));
        ends[start..].sort_unstable();
    }
    Some(ends)
}

/// Masses of one group by the cells of a grid, for those of another.
struct Neighbours<'a> {
    points: &'a [Vec3],
    first: Range<u32>,
    last: Range<u32>,
    /// [m]
    reach: f64,
    cells: HashMap<[i64; 3], Vec<u32>>,
}

fn cell(point: Vec3, size: f64) -> [i64; 3] {
    point.to_array().map(|x| (x / size).floor() as i64)
}

impl<'a> Neighbours<'a> {
    fn new(points: &'a [Vec3], first: Range<u32>, last: Range<u32>, reach: f64) -> Self {
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for b in last.clone() {
            cells.entry(cell(points[b as usize], reach)).or_default().push(b);
        }
        Self { points, first, last, reach, cells }
    }

    /// What a mass of the first group is near to, cell by cell.
    fn of(&self, a: u32) -> impl Iterator<Item = u32> {
        let from = self.points[a as usize];
        let here = cell(from, self.reach);
        let cells =
            (0..27).map(|n| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]).filter_map(move |offset: [i64; 3]| {
                // cells of a tiny reach end with the whole numbers
                self.cells.get(&std::array::from_fn(|i| here[i].wrapping_add(offset[i])))
            });
        let is_near = move |b: &u32| {
            let apart = self.points[*b as usize] - from;
            is_pair(&self.first, &self.last, a, *b) && apart.length_sq() <= self.reach * self.reach
        };
        cells.flatten().copied().filter(is_near)
    }

    fn are_at_most(&self, most: usize) -> bool {
        let add = |sum: usize, a| Some(sum + self.of(a).count()).filter(|sum| *sum <= most);
        self.first.clone().try_fold(0, add).is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On a line, each mass of one group is near the next; a bound below that is told, however small the reach.
    #[test]
    fn near_pairs_are_bounded() {
        let points: Vec<Vec3> = (0..10).map(|i| Vec3::new(f64::from(i), 0.0, 0.0)).collect();
        let count = |reach, most| near(&points, 0..10, 0..10, reach, most).map(|pairs| pairs.len());
        assert_eq!([count(1.0, 9), count(1.0, 8), count(100.0, 45)], [Some(9), None, Some(45)]);
        assert_eq!(count(1e-300, 0), Some(0));
        assert_eq!([pair_count(&(0..10), &(0..10)), pair_count(&(0..4), &(4..10))], [45, 24]);
    }
}
