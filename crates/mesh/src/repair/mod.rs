//! Surfaces as found in the wild: what is wrong with them, and what can be mended without guessing.
//!
//! [`diagnose`] finds everything at once; [`repair`] welds points, drops triangles that are flat or doubled, turns
//! triangles until neighbours agree and every closed part faces outward, and closes small holes. Crossings, sheets
//! and large holes stay: a [`SurfaceShape`](crate::implicit::SurfaceShape) then decides by winding number.

mod crossing;
mod diagnose;
mod facing;
mod flat;
mod holes;
mod orient;
mod weld;
mod within;

use souple_math::Vec3;
use souple_table::{four_digits, in_number};

use crate::TriangleSurface;

pub use crossing::Crossings;
pub(crate) use crossing::{crossings, triangles_cross};
pub(crate) use diagnose::components;
pub use diagnose::{Diagnosis, MOST_CROSSINGS, diagnose};

/// What [`repair`] may do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RepairLimits {
    /// Points closer than this are one, relative to the diagonal of the surface's box.
    pub weld: f64,
    /// Holes whose box has a diagonal up to this are closed, relative to that of the surface's box.
    pub hole: f64,
}

impl Default for RepairLimits {
    /// Rounding of coordinates written with seven digits; holes of a tenth.
    fn default() -> Self {
        Self { weld: 1e-6, hole: 0.1 }
    }
}

/// What [`repair`] did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceRepairs {
    pub welded_points: usize,
    /// How far apart points were that are one now [m].
    pub longest_weld: f64,
    pub flat_triangles: usize,
    /// Triangles without area that share what their neighbour has.
    pub joined_triangles: usize,
    pub doubled_triangles: usize,
    /// Triangles that lay back to back, where parts touch.
    pub facing_triangles: usize,
    /// Triangles turned so that neighbours agree.
    pub turned_triangles: usize,
    /// Closed parts that were inside out as a whole.
    pub turned_parts: usize,
    pub closed_holes: usize,
    /// Relative to the diagonal of the surface's box, as [`RepairLimits::hole`].
    pub largest_closed_hole: f64,
    /// Closed holes of which some triangles lie on each other.
    pub folded_holes: usize,
    pub left: Left,
}

/// What [`repair`] left on purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Left {
    /// Closed parts that are as thin as what is welded: joined at equal points alone.
    pub thin_parts: usize,
    /// Places where closed parts touch each other or themselves, which stay several points.
    pub touching_points: usize,
    /// Parts that have one side only, or whose triangles cannot agree otherwise.
    pub one_sided_parts: usize,
    /// Closed parts within others that face the same way.
    pub nested_parts: usize,
    /// Holes larger than the limit.
    pub holes: usize,
    /// Relative to the diagonal of the surface's box.
    pub smallest_hole: f64,
    pub largest_hole: f64,
    /// Rings of open edges around sheets, which are no holes.
    pub outlines: usize,
    /// Open edges that are in no ring of their own: of holes that touch at a point, or that end at an edge of three triangles.
    pub tangled_edges: usize,
}

impl Left {
    fn add_hole(&mut self, size: f64) {
        self.smallest_hole = if self.holes == 0 { size } else { self.smallest_hole.min(size) };
        self.largest_hole = self.largest_hole.max(size);
        self.holes += 1;
    }

    /// One line for each kind of thing that was left; empty where nothing was.
    pub fn messages(&self, limits: RepairLimits) -> Vec<String> {
        let (least, most) = (four_digits(self.smallest_hole), four_digits(self.largest_hole));
        let sizes = if least == most { least } else { format!("{least} to {most}") };
        let told = [
            (
                self.thin_parts,
                ["closed part is", "closed parts are"],
                format!(
                    "left: as thin as what weld={} joins, which would flatten it",
                    four_digits(limits.weld)
                ),
            ),
            (
                self.touching_points,
                ["place where the surface touches itself is", "places where the surface touches itself are"],
                "left: each side of it has a point of its own there".to_owned(),
            ),
            (
                self.one_sided_parts,
                ["part is", "parts are"],
                "left with edges between triangles of opposite orientation: with a twist, as a Möbius strip, it has one side only"
                    .to_owned(),
            ),
            (
                self.nested_parts,
                ["closed part is", "closed parts are"],
                "left within others that face the same way: what both enclose counts twice in the enclosed volume"
                    .to_owned(),
            ),
            (
                self.holes,
                ["hole is", "holes are"],
                format!(
                    "left: {sizes} of the surface's diagonal from corner to corner of the box, more than hole={}",
                    four_digits(limits.hole)
                ),
            ),
            (
                self.outlines,
                ["ring of open edges is", "rings of open edges are"],
                "left: outlines of sheets are no holes".to_owned(),
            ),
            (
                self.tangled_edges,
                ["open edge is", "open edges are"],
                "left: of holes that touch at a point, or end at an edge of several triangles".to_owned(),
            ),
        ];
        let told = told.into_iter().filter(|(count, ..)| *count > 0);
        told.map(|(count, [one, many], why)| format!("{} {why}", in_number(count, one, many))).collect()
    }
}

const TRIANGLES: [&str; 2] = ["triangle was", "triangles were"];

impl SurfaceRepairs {
    /// One line for each kind of repair; empty for a surface in order.
    pub fn messages(&self) -> Vec<String> {
        let largest =
            format!("closed, {} of the surface's diagonal at most", four_digits(self.largest_closed_hole));
        let welded = match self.longest_weld {
            0.0 => "welded to another at the same place".to_owned(),
            distance => format!("welded to another, up to {} m away", four_digits(distance)),
        };
        let counts = [
            (self.welded_points, ["point was", "points were"], welded.as_str()),
            (self.flat_triangles, TRIANGLES, "dropped: without area"),
            (self.doubled_triangles, TRIANGLES, "dropped: others have the same corners"),
            (self.facing_triangles, TRIANGLES, "dropped: back to back with another, where parts touch"),
            (self.turned_triangles, TRIANGLES, "turned to agree with neighbours"),
            (self.closed_holes, ["hole was", "holes were"], &largest),
            (
                self.folded_holes,
                ["of them was", "of them were"],
                "closed by triangles that lie on each other: no view shows all of the rim",
            ),
            (self.joined_triangles, TRIANGLES, "joined with a neighbour by the other diagonal: without area"),
            (self.turned_parts, ["part was", "parts were"], "inside out, and turned"),
        ];
        let told = counts.iter().filter(|(count, ..)| *count > 0);
        told.map(|(count, [one, many], done)| format!("{} {done}", in_number(*count, one, many))).collect()
    }
}

/// The surface mended as far as that is safe, and what was done.
pub fn repair(surface: &TriangleSurface, limits: RepairLimits) -> (TriangleSurface, SurfaceRepairs) {
    let mut repairs = SurfaceRepairs::default();
    let diagonal = surface.bounds().diagonal();
    let mut mended = weld::weld(surface, limits.weld * diagonal, &mut repairs);
    orient::agree(&mut mended, &mut repairs);
    flat::join(&mut mended, &mut repairs);
    holes::close(&mut mended, limits.hole, diagonal, &mut repairs);
    // what closes a slit has no area
    flat::join(&mut mended, &mut repairs);
    orient::face_outward(&mut mended, &mut repairs);
    (mended, repairs)
}

/// Edges by their points, the lower first.
fn edges_of([a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[from, to]| [*from.min(to), *from.max(to)])
}

/// Corners in their direction, the lowest first.
fn from_lowest([a, b, c]: [u32; 3]) -> [u32; 3] {
    let turns = [[a, b, c], [b, c, a], [c, a, b]];
    turns.into_iter().fold([a, b, c], |least, turn| least.min(turn))
}

/// Whether corners repeat or lie on one line, to rounding.
fn is_flat(corners: [u32; 3], points: &[Vec3]) -> bool {
    let [a, b, c] = corners;
    if a == b || b == c || c == a {
        return true;
    }
    let [a, b, c] = corners.map(|point| points[point as usize]);
    let longest_sq = (b - a).length_sq().max((c - b).length_sq()).max((a - c).length_sq());
    (b - a).cross(c - a).length() <= 1e-14 * longest_sq
}

#[cfg(test)]
mod tests;
