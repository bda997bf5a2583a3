//! Letters as strokes: no font file, the same on every machine, legible at any size.
//!
//! A glyph is a string of strokes. Each stroke is a row of points, two signs for each: `x`, then `y`, in base 36.
//! Baseline at `y = 4`, small letters up to `f` (15), capitals to `k` (20). A stroke that begins with `~` is a
//! quadratic B-spline from its first to its last point, with `@` a closed one.

use std::collections::HashMap;
use std::sync::LazyLock;

/// Height of capitals in the units of glyphs.
const CAPITAL: f64 = 16.0;
const BASELINE: f64 = 4.0;
/// Between glyphs, in the units of glyphs.
const GAP: f64 = 4.0;
const SPACE_WIDTH: f64 = 4.0;

/// Segments of each spline piece.
const PIECES: usize = 6;

const GLYPHS: &[(char, &str)] = &[
    ('A', "045ka4 2a8a"),
    ('B', "040k ~0k5k9k9c5c0c ~0c6caca46404"),
    ('C', "~ah9k5k0k0c045494a7"),
    ('D', "040k ~0k4kaka44404"),
    ('E', "9k0k0494 0c8c"),
    ('F', "9k0k04 0c8c"),
    ('G', "~ah9k5k0k0c045494a4aa 6aaa"),
    ('H', "040k a4ak 0cac"),
    ('I', "040k"),
    ('J', "~6k6764340407"),
    ('K', "040k ak0a 3da4"),
    ('L', "0k0484"),
    ('M', "040k68ckc4"),
    ('N', "040ka4ak"),
    ('O', "@0k5kakaca454040c"),
    ('P', "040k ~0k6kakab6b0b"),
    ('Q', "@0k5kakaca454040c 68b3"),
    ('R', "040k ~0k6kakab6b0b 5ba4"),
    ('S', "~9h8k5k0k0c5caca4541407"),
    ('T', "0kak 5k54"),
    ('U', "~0k090454a4a9ak"),
    ('V', "0k54ak"),
    ('W', "0k346h94ck"),
    ('X', "04ak 0ka4"),
    ('Y', "0k5bak 5b54"),
    ('Z', "0kak04a4"),
    ('a', "@0f4f8f8a8444040a 8f84"),
    ('b', "0k04 @0f4f8f8a8444040a"),
    ('c', "~7d6f4f0f04446476"),
    ('d', "8k84 @0f4f8f8a8444040a"),
    ('e', "0a8a ~8a8f4f0f04446477"),
    ('f', "~5k4k2k2g2b 2b24 0f5f"),
    ('g', "@0f4f8f8a8444040a ~8f8680401002"),
    ('h', "0k04 ~0a0f4f8f8a84"),
    ('i', "0f04 0j0k"),
    ('j', "~3f36302000 3j3k"),
    ('k', "0k04 7f09 2b74"),
    ('l', "0k04"),
    ('m', "0f04 ~0a0f3f6f6a64 ~6a6f9fcfcac4"),
    ('n', "0f04 ~0a0f4f8f8a84"),
    ('o', "@0f4f8f8a8444040a"),
    ('p', "0f00 @0f4f8f8a8444040a"),
    ('q', "8f80 @0f4f8f8a8444040a"),
    ('r', "0f04 ~0a0f3f5f"),
    ('s', "~7d6f4f0f0a4a8a84441406"),
    ('t', "~2k28244454 0f5f"),
    ('u', "~0f080444848a 8f84"),
    ('v', "0f448f"),
    ('w', "0f346e94cf"),
    ('x', "048f 0f84"),
    ('y', "0f44 8f20"),
    ('z', "0f8f0484"),
    ('0', "@0k4k8k8c8444040c"),
    ('1', "0g3k34"),
    ('2', "~0g0k4k8k8e6a04 0484"),
    ('3', "~0h1k4k8k8c4c2c ~2c4c9c94440407"),
    ('4', "646k0989"),
    ('5', "7k1k0c ~0c1e4e9e94440407"),
    ('6', "@0d4d8d8884440408 ~7i6k4k0k0d08"),
    ('7', "0k8k34"),
    ('8', "@0c4c8c8884440408 @1k4k7k7g7c4c1c1g"),
    ('9', "@0k4k8k8g8b4b0b0g ~162444848b8g"),
    ('.', "0405"),
    (',', "1501"),
    (':', "0405 0e0f"),
    (';', "1502 1e1f"),
    ('-', "0b6b"),
    ('−', "0b8b"),
    ('–', "0b9b"),
    ('+', "0b8b 4f47"),
    ('=', "0d8d 0989"),
    ('/', "027l"),
    ('\\', "0l72"),
    ('(', "~3l0h0631"),
    (')', "~0l3h3601"),
    ('[', "3l0l0131"),
    (']', "0l3l3101"),
    ('{', "~4l2l2d0b ~0b292141"),
    ('}', "~0l2l2d4b ~4b292101"),
    ('%', "@0k4k4e0e @5aaaa454 149k"),
    ('°', "@0k4k4f0f"),
    ('²', "~0i0k2k4k4h3f0c 0c4c"),
    ('³', "~0j1k2k4k4g2g ~2g4g4c2c0c0d"),
    ('·', "0b0c"),
    ('×', "1e78 187e"),
    ('µ', "0f00 ~0f080444848a 8f84"),
    ('μ', "0f00 ~0f080444848a 8f84"),
    ('|', "0l01"),
    ('_', "0282"),
    ('*', "4k4e 1i7g 1g7i"),
    ('\'', "0k0h"),
    ('"', "0k0h 3k3h"),
    ('!', "0k09 0405"),
    ('?', "~0h0k4k8k8d4d49 4445"),
    ('<', "8f0b87"),
    ('>', "0f8b07"),
    ('#', "3k24 7k64 0f9f 0989"),
    ('&', "~a42g2k5k7k7g0b0444849a"),
    ('^', "0f4k8f"),
    ('~', "~0a0d3d5a8a8d"),
    ('σ', "@0f4f8f8a8444040a 4f9f"),
    ('ε', "~7d6f4f0f0a4a ~4a0a04446476"),
    ('λ', "~0k2k3g84 4b04"),
    ('ν', "0f448f"),
    ('ρ', "@0f4f8f8a8444040a 0a00"),
    ('θ', "@0k4k8k8c8444040c 0c8c"),
    ('Δ', "045ka404"),
    ('π', "0f8f 2f24 6f64"),
];

/// What stands for a character that has no glyph.
const UNKNOWN: &str = "040k8k8404";

/// A glyph: its strokes as rows of points, its width.
#[derive(Clone, Debug)]
struct Glyph {
    strokes: Vec<Vec<[f64; 2]>>,
    width: f64,
}

static TABLE: LazyLock<HashMap<char, Glyph>> =
    LazyLock::new(|| GLYPHS.iter().map(|(letter, text)| (*letter, parse(text))).collect());
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

    /// Every printable ASCII character but two that nobody writes in a title has a glyph of pairs of digits.
    #[test]
    fn glyphs_are_complete() {
        for letter in ('!'..='~').filter(|letter| !['$', '@', '`'].contains(letter)) {
            assert!(TABLE.contains_key(&letter), "{letter}");
        }
        for (letter, text) in GLYPHS {
            for stroke in text.split(' ') {
                let digits = stroke.trim_start_matches(['~', '@']);
                assert!(digits.len() >= 4 && digits.len() % 2 == 0, "{letter}: {stroke}");
                assert!(digits.chars().all(|digit| digit.is_digit(36)), "{letter}: {stroke}");
            }
        }
        assert_eq!(GLYPHS.len(), TABLE.len(), "a character has two glyphs");
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
