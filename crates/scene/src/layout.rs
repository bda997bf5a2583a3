//! Where the bytes of a text stand in the source, so that an error within a formula points at its character.
//!
//! A text of a scene is not what was written: it stands in quotes, with escapes, over several lines, with parameters put in.

use souple_formal::Span;

use crate::source::Place;

/// How a text lies in the sources it was read from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// In the order of the text.
    pieces: Vec<Piece>,
    /// Bytes of the text.
    length: usize,
}

/// Bytes of the text that were written together.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    /// The first byte in the text.
    from: usize,
    place: Place,
    /// Whether the text has the bytes of the place; else they stand for the place as a whole, as `é` for `\u00e9`.
    is_verbatim: bool,
}

impl Layout {
    /// A text that stands in the source as it is.
    pub fn verbatim(place: Place) -> Self {
        let mut layout = Self::default();
        layout.push(place, place.end - place.start, true);
        layout
    }

    /// A text that `written` stands for, a string of TOML with its quotes, which begins at `place`.
    pub fn of_literal(written: &str, text: &str, place: Place) -> Self {
        Self::read(written, text, place).unwrap_or_else(|| Self::whole(place, text.len()))
    }

    /// A text of some length that stands for a place as a whole.
    pub fn whole(place: Place, length: usize) -> Self {
        let mut layout = Self::default();
        layout.push(place, length, false);
        layout
    }

    /// `None` where the two are not the same string.
    fn read(written: &str, text: &str, place: Place) -> Option<Self> {
        let quote = written.chars().next().filter(|quote| matches!(quote, '"' | '\''))?;
        let is_long = written.len() >= 6 && written.starts_with(&quote.to_string().repeat(3));
        let width = if is_long { 3 } else { 1 };
        let end = written.len().checked_sub(width)?;
        let mut at = width;
        if is_long {
            // a line break right behind the quotes is none of the text
            at += ["\r\n", "\n"].iter().find(|ends| written[at..].starts_with(**ends)).map_or(0, |e| e.len());
        }
        let mut layout = Self::default();
        let within = |from: usize, to: usize| Place {
            source: place.source,
            start: place.start + from,
            end: place.start + to,
        };
        while at < end {
            // what is no whole string, of a text with faults, may end within a character
            let rest = written.get(at..end)?;
            let first = rest.chars().next()?;
            let wanted = text[layout.length..].chars().next();
            if first == '\\' && quote == '"' {
                let behind = rest[1..].trim_start_matches([' ', '\t', '\r']);
                if is_long && behind.starts_with('\n') {
                    // the line goes on at the next character
                    at = end - behind.trim_start().len();
                    continue;
                }
                let length = match rest[1..].chars().next()? {
                    'u' => 6,
                    'U' => 10,
                    'x' => 4,
                    _ => 2,
                };
                layout.push(within(at, at + length), wanted?.len_utf8(), false);
                at += length;
            } else if wanted == Some(first) {
                layout.push(within(at, at + first.len_utf8()), first.len_utf8(), true);
                at += first.len_utf8();
            } else if first == '\r' {
                at += 1;
            } else {
                return None;
            }
        }
        (layout.length == text.len()).then_some(layout)
    }

    /// Appends bytes of another text.
    pub fn push_part(&mut self, other: &Self, from: usize, to: usize) {
        let mut at = from;
        while at < to {
            let Some(index) = other.piece_at(at) else { return };
            let piece = other.pieces[index];
            let next = other.pieces.get(index + 1).map_or(other.length, |next| next.from).min(to);
            let place = match piece.is_verbatim {
                true => {
                    let start = piece.place.start + at - piece.from;
                    Place { start, end: start + next - at, ..piece.place }
                }
                false => piece.place,
            };
            self.push(place, next - at, piece.is_verbatim);
            at = next;
        }
    }

    /// Appends bytes that stand for a place as a whole.
    pub fn push_whole(&mut self, place: Place, length: usize) {
        self.push(place, length, false);
    }

    fn push(&mut self, place: Place, length: usize, is_verbatim: bool) {
        let from = self.length;
        self.length += length;
        match self.pieces.last_mut() {
            _ if length == 0 => {}
            Some(last)
                if is_verbatim
                    && last.is_verbatim
                    && (last.place.source, last.place.end) == (place.source, place.start) =>
            {
                last.place.end = place.end;
            }
            _ => self.pieces.push(Piece { from, place, is_verbatim }),
        }
    }

    fn piece_at(&self, byte: usize) -> Option<usize> {
        self.pieces.partition_point(|piece| piece.from <= byte).checked_sub(1)
    }

    /// Where a part of the text was written; what is missing at its end is missed at the character behind it. `None` of an
    /// empty text.
    pub fn place_of(&self, span: Span) -> Option<Place> {
        let last = self.pieces.last()?;
        if span.start >= self.length {
            return Some(Place { start: last.place.end, end: last.place.end + 1, ..last.place });
        }
        let of = |byte: usize| {
            let piece = self.pieces[self.piece_at(byte)?];
            let start = piece.place.start + byte - piece.from;
            Some(if piece.is_verbatim { Place { start, end: start + 1, ..piece.place } } else { piece.place })
        };
        let first = of(span.start)?;
        let behind = of(span.end.min(self.length).max(span.start + 1) - 1)?;
        let end = if behind.source == first.source { behind.end.max(first.end) } else { first.end };
        Some(Place { end, ..first })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found<'a>(written: &'a str, text: &str, part: &str) -> &'a str {
        let place = Place { source: 0, start: 0, end: written.len() };
        let start = text.find(part).unwrap();
        let layout = Layout::of_literal(written, text, place);
        let place = layout.place_of(Span::new(start, start + part.len())).unwrap();
        &written[place.start..place.end]
    }

    /// In every kind of string of TOML a part of the text is found where it was written.
    #[test]
    fn parts_are_found_in_every_string() {
        for (written, text, part, at) in [
            ("\"a + foo\"", "a + foo", "foo", "foo"),
            ("'a\\ + foo'", "a\\ + foo", "foo", "foo"),
            ("\"\\u0061 + \\t foo\"", "a + \t foo", "foo", "foo"),
            ("\"\\u0061 + \\t foo\"", "a + \t foo", "a", "\\u0061"),
            ("\"\"\"\na +\n  foo\"\"\"", "a +\n  foo", "foo", "foo"),
            ("\"\"\"a + \\\n   \n foo\"\"\"", "a + foo", "foo", "foo"),
            ("\"\"\"a + \\\r\n foo\"\"\"", "a + foo", "foo", "foo"),
            ("'''\r\na +\r\nfoo'''", "a +\nfoo", "foo", "foo"),
            ("'''\r\na +\r\nfoo'''", "a +\r\nfoo", "foo", "foo"),
            ("\"µ + foo\"", "µ + foo", "foo", "foo"),
            ("\"\"\"a \"quote\" foo\"\"\"", "a \"quote\" foo", "foo", "foo"),
            // what is not the same string is pointed at as a whole
            ("\"other\"", "a + foo", "foo", "\"other\""),
        ] {
            assert_eq!(found(written, text, part), at, "{written}");
        }
    }

    /// What is missing at the end is missed behind it: at the quote that closes.
    #[test]
    fn the_end_is_behind_the_last_character() {
        let written = "\"a +\"";
        let place = Place { source: 3, start: 10, end: 15 };
        let layout = Layout::of_literal(written, "a +", place);
        assert_eq!(layout.place_of(Span::new(3, 3)), Some(Place { source: 3, start: 14, end: 15 }));
        assert_eq!(Layout::of_literal("\"\"", "", place).place_of(Span::new(0, 0)), None);
    }

    /// A text that ends within a character where its quote should be, as damaged ones do, is taken as a whole.
    #[test]
    fn texts_without_an_end_are_whole() {
        let place = Place { source: 0, start: 2, end: 6 };
        assert_eq!(Layout::of_literal("\"m³", "m³", place).place_of(Span::new(0, 1)), Some(place));
    }

    /// A parameter that was put in stands for its name; what follows is found where it is.
    #[test]
    fn parameters_stand_for_their_names() {
        let place = Place { source: 0, start: 0, end: 12 };
        let written = Layout::of_literal("\"2 * $k + q\"", "2 * $k + q", place);
        let mut layout = Layout::default();
        layout.push_part(&written, 0, 4);
        layout.push_whole(written.place_of(Span::new(4, 6)).unwrap(), "(1000.0)".len());
        layout.push_part(&written, 6, 10);
        let at = |start: usize, end: usize| {
            let place = layout.place_of(Span::new(start, end)).unwrap();
            (place.start, place.end)
        };
        assert_eq!(at(0, 1), (1, 2));
        assert_eq!(at(6, 8), (5, 7));
        assert_eq!(at(15, 16), (10, 11));
        assert_eq!(at(2, 16), (3, 11));
    }
}
