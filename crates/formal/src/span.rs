//! Places in a text, so that an error can point at what it is about.

use std::fmt;

/// A half-open range of bytes in the text that was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// The first byte.
    pub start: usize,
    /// The byte after the last one.
    pub end: usize,
}

/// Characters shown on either side of an underlined place: a line of a terminal in all.
const CONTEXT: usize = 36;

impl Span {
    pub fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }

    /// From the first byte of `self` to the last of `other`.
    pub fn to(self, other: Self) -> Self {
        Self::new(self.start, other.end)
    }

    /// Of a piece that begins at a byte of a text, in that text.
    pub fn moved_by(self, bytes: usize) -> Self {
        Self::new(self.start + bytes, self.end + bytes)
    }

    /// A message without the words that say where, for those who show it.
    pub fn taken_out_of(self, message: &str) -> String {
        message.replace(&format!(" (at {self})"), "").replace(&format!(" at {self}"), "")
    }

    /// Whether `other` lies within it.
    pub fn contains(self, other: Self) -> bool {
        self.start <= other.start && other.end <= self.end
    }

    /// The characters covered, or nothing where the span does not belong to `text`.
    pub fn of(self, text: &str) -> &str {
        text.get(self.start..self.end).unwrap_or_default()
    }

    /// Two lines: the surroundings of the place in `text`, and carets under it.
    pub fn underline(self, text: &str) -> String {
        let line_start = text.get(..self.start).and_then(|before| before.rfind('\n')).map_or(0, |at| at + 1);
        let line = text.get(line_start..).unwrap_or_default().lines().next().unwrap_or_default();
        let column = text.get(line_start..self.start).map_or(0, |before| before.chars().count());
        let width = self.of(text).lines().next().unwrap_or_default().chars().count().clamp(1, CONTEXT);
        let skipped = column.saturating_sub(CONTEXT);
        let shown: String = line.chars().skip(skipped).take(column - skipped + width + CONTEXT).collect();
        format!("{shown}\n{}{}", " ".repeat(column - skipped), "^".repeat(width))
    }
}

impl fmt::Display for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "byte {}", self.start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The carets stand under the place, counted in characters, also in a long text and at its end.
    #[test]
    fn underline_points_at_the_place() {
        assert_eq!(Span::new(4, 7).underline("1 + foo * 2"), "1 + foo * 2\n    ^^^");
        assert_eq!(Span::new(4, 5).underline("µµ x"), "µµ x\n  ^");
        assert_eq!(Span::new(3, 3).underline("1 +"), "1 +\n   ^");
        assert_eq!(Span::new(2, 3).underline("a\nb\nc"), "b\n^");
        let long = format!("{}!{}", "a".repeat(500), "b".repeat(500));
        let expected = format!("{}!{}\n{}^", "a".repeat(36), "b".repeat(36), " ".repeat(36));
        assert_eq!(Span::new(500, 501).underline(&long), expected);
        assert_eq!(Span::new(50, 90).underline("short"), "short\n^");
    }
}
