//! Letters as strokes: no font file, the same on every machine, legible at any size.
//!
//! Glyphs are those of the table, letters of it under a mark (`é`), and small ones raised or lowered (`10⁻³`, `x₀`).

use std::collections::HashMap;
use std::sync::LazyLock;

use super::glyphs::{GLYPHS, LIKE, LOWERED, MARKED, Mark, RAISED};

/// Height of capitals in the units of glyphs.
const CAPITAL: f64 = 16.0;
const BASELINE: f64 = 4.0;
/// Between glyphs, in the units of glyphs.
const GAP: f64 = 4.0;
const SPACE_WIDTH: f64 = 4.0;

/// Segments of each spline piece.
const PIECES: usize = 6;

/// What stands for a character that has no glyph.
const UNKNOWN: &str = "040k8k8404";

/// A glyph: its strokes as rows of points, its width.
#[derive(Clone, Debug)]
struct Glyph {
    strokes: Vec<Vec<[f64; 2]>>,
    width: f64,
}

static TABLE: LazyLock<HashMap<char, Glyph>> = LazyLock::new(|| {
    let mut table: HashMap<char, Glyph> =
        GLYPHS.iter().map(|(letter, text)| (*letter, parse(text))).collect();
    for (letters, bases) in LIKE {
        derive(&mut table, letters, bases, Glyph::clone);
    }
    for (letters, bases, mark) in MARKED {
        derive(&mut table, letters, bases, |base| base.marked(mark));
    }
    derive(&mut table, RAISED.0, RAISED.1, |base| base.small(SMALL_RISE));
    derive(&mut table, LOWERED.0, LOWERED.1, |base| base.small(-SMALL_DROP));
    table
});

/// Raised and lowered signs: their size, and how far their baseline is from that of the line.
const SMALL: f64 = 0.62;
const SMALL_RISE: f64 = 7.5;
const SMALL_DROP: f64 = 3.0;

/// Glyphs of `letters` made from those of `bases`, one by one.
fn derive(table: &mut HashMap<char, Glyph>, letters: &str, bases: &str, make: impl Fn(&Glyph) -> Glyph) {
    for (letter, base) in letters.chars().zip(bases.chars()) {
        if let Some(glyph) = table.get(&base).map(&make) {
            table.insert(letter, glyph);
        }
    }
}

impl Glyph {
    fn small(&self, rise: f64) -> Self {
        let place = |[x, y]: [f64; 2]| [SMALL * x, BASELINE + rise + SMALL * (y - BASELINE)];
        let strokes = self.strokes.iter().map(|stroke| stroke.iter().copied().map(place).collect()).collect();
        Self { strokes, width: SMALL * self.width }
    }

    /// With a mark over its middle, above its own height, or below the line.
    fn marked(&self, mark: &Mark) -> Self {
        let sign = parse(mark.strokes);
        let top = self.strokes.iter().flatten().map(|point| point[1]).fold(0.0, f64::max);
        let rise = if mark.is_below { 0.0 } else { top + 2.0 };
        let shift = 0.5 * (self.width - sign.width);
        // a mark wider than its letter pushes the letter to the right
        let left = shift.min(0.0);
        let moved = |[x, y]: &[f64; 2], by: [f64; 2]| [x + by[0], y + by[1]];
        let own = self.strokes.iter().map(|stroke| stroke.iter().map(|p| moved(p, [-left, 0.0])).collect());
        let added =
            sign.strokes.iter().map(|stroke| stroke.iter().map(|p| moved(p, [shift - left, rise])).collect());
        Self { strokes: own.chain(added).collect(), width: self.width.max(sign.width) }
    }
}
static UNKNOWN_GLYPH: LazyLock<Glyph> = LazyLock::new(|| parse(UNKNOWN));

fn parse(text: &str) -> Glyph {
    let mut strokes = Vec::new();
    for stroke in text.split(' ') {
        let (kind, digits) = match stroke.strip_prefix('~') {
            Some(digits) => ('~', digits),
            None => stroke.strip_prefix('@').map_or((' ', stroke), |digits| ('@', digits)),
        };
        let numbers: Vec<f64> =
            digits.chars().filter_map(|digit| digit.to_digit(36)).map(f64::from).collect();
        let points: Vec<[f64; 2]> = numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        strokes.push(match kind {
            '~' => open_spline(&points),
            '@' => closed_spline(&points),
            _ => points,
        });
    }
    let width = strokes.iter().flatten().map(|point| point[0]).fold(0.0, f64::max);
    Glyph { strokes, width }
}

fn middle(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
}

/// `(1-t)² a + 2t(1-t) b + t² c`, without its start.
fn bezier(a: [f64; 2], b: [f64; 2], c: [f64; 2], points: &mut Vec<[f64; 2]>) {
    for piece in 1..=PIECES {
        let t = piece as f64 / PIECES as f64;
        let at = |i: usize| (1.0 - t) * (1.0 - t) * a[i] + 2.0 * t * (1.0 - t) * b[i] + t * t * c[i];
        points.push([at(0), at(1)]);
    }
}

fn open_spline(controls: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let [first, .., last] = controls else { return controls.to_vec() };
    let (mut points, mut start) = (vec![*first], *first);
    for triple in controls.windows(3) {
        let is_last = std::ptr::eq(&triple[2], last);
        let end = if is_last { *last } else { middle(triple[1], triple[2]) };
        bezier(start, triple[1], end, &mut points);
        start = end;
    }
    points
}

fn closed_spline(controls: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let n = controls.len();
    let mut points = Vec::new();
    for i in 0..n {
        let (a, b, c) = (controls[i], controls[(i + 1) % n], controls[(i + 2) % n]);
        if points.is_empty() {
            points.push(middle(a, b));
        }
        bezier(middle(a, b), b, middle(b, c), &mut points);
    }
    points
}

fn glyph(letter: char) -> &'static Glyph {
    TABLE.get(&letter).unwrap_or(&UNKNOWN_GLYPH)
}

/// Width of a text whose capitals are `height` high.
pub(crate) fn text_width(text: &str, height: f64) -> f64 {
    let widths = text.chars().map(|letter| if letter == ' ' { SPACE_WIDTH } else { glyph(letter).width });
    let total: f64 = widths.map(|width| width + GAP).sum();
    (total - GAP).max(0.0) * height / CAPITAL
}

/// The strokes of a text with its baseline from `(x, y)`, `y` downward.
pub(crate) fn text_strokes(text: &str, x: f64, y: f64, height: f64) -> Vec<Vec<[f64; 2]>> {
    let scale = height / CAPITAL;
    let mut strokes = Vec::new();
    let mut pen = x;
    for letter in text.chars() {
        if letter == ' ' {
            pen += (SPACE_WIDTH + GAP) * scale;
            continue;
        }
        let glyph = glyph(letter);
        let place = |point: &[f64; 2]| [pen + point[0] * scale, y - (point[1] - BASELINE) * scale];
        strokes.extend(glyph.strokes.iter().map(|stroke| stroke.iter().map(place).collect()));
        pen += (glyph.width + GAP) * scale;
    }
    strokes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every printable ASCII character, Greek and what stands in titles has a glyph; glyphs are pairs of digits.
    #[test]
    fn glyphs_are_complete() {
        let others = ('α'..='ω').chain("ΑΩΣ äöüÄÖÜßéèêëçñåøíÍ 10⁻³ x₀ ≤≥≈±∞√∂∇·×→←…“”°µ".chars());
        for letter in ('!'..='~').chain(others).filter(|letter| *letter != ' ') {
            assert!(TABLE.contains_key(&letter), "{letter}");
        }
        for (letter, text) in GLYPHS {
            for stroke in text.split(' ') {
                let digits = stroke.trim_start_matches(['~', '@']);
                assert!(digits.len() >= 4 && digits.len() % 2 == 0, "{letter}: {stroke}");
                assert!(digits.chars().all(|digit| digit.is_digit(36)), "{letter}: {stroke}");
            }
        }
        let mut letters: Vec<char> = GLYPHS.iter().map(|(letter, _)| *letter).collect();
        letters.extend(LIKE.iter().chain([&RAISED, &LOWERED]).flat_map(|(letters, _)| letters.chars()));
        letters.extend(MARKED.iter().flat_map(|(letters, _, _)| letters.chars()));
        let count = letters.len();
        letters.sort_unstable();
        letters.dedup();
        assert_eq!(letters.len(), count, "a character has two glyphs");
        assert_eq!(letters.len(), TABLE.len(), "a character is made from one that has no glyph");
        for (letters, bases) in LIKE.iter().chain([&RAISED, &LOWERED]) {
            assert_eq!(letters.chars().count(), bases.chars().count(), "{letters}");
        }
        for (letters, bases, _) in MARKED {
            assert_eq!(letters.chars().count(), bases.chars().count(), "{letters}");
        }
    }

    /// Width is that of the strokes plus nothing.
    #[test]
    fn width_of_a_word() {
        let strokes = text_strokes("Hn", 3.0, 0.0, 16.0);
        let right = strokes.iter().flatten().map(|point| point[0]).fold(0.0, f64::max);
        assert!((right - 3.0 - text_width("Hn", 16.0)).abs() < 1e-12);
        assert_eq!(text_width("", 10.0), 0.0);
    }
}
