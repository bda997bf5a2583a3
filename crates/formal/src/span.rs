//! Places in a text, and how they are shown to the one who wrote it.

/// Bytes `start..end` of a text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Span {
    pub start: usize,
    pub end: usize,
}

/// Characters shown on either side of a place in a long line.
const WINDOW: usize = 60;

impl Span {
    pub const fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }

    /// The part of `text` this span covers; empty where it does not fit the text.
    pub fn of(self, text: &str) -> &str {
        text.get(self.start..self.end).unwrap_or("")
    }

    /// The line of `text` the span starts on, long lines cut, with `^^^` below the span.
    pub fn underlined(self, text: &str) -> String {
        let start = text.floor_char_boundary(self.start);
        let end = text.ceil_char_boundary(self.end.max(start));
        let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
        let end = end.min(line_end);

        let before = &text[line_start..start];
        let shown_from =
            before.char_indices().rev().nth(WINDOW - 1).map_or(line_start, |(at, _)| line_start + at);
        let shown_to =
            text[start..line_end].char_indices().nth(WINDOW).map_or(line_end, |(at, _)| start + at);
        let cut_before = if shown_from > line_start { "…" } else { "" };
        let cut_after = if shown_to < line_end { "…" } else { "" };

        // tabs and control characters would shift the marks
        let shown: String =
            text[shown_from..shown_to].chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        let indent = cut_before.chars().count() + text[shown_from..start].chars().count();
        let marks = text[start..end.min(shown_to)].chars().count().max(1);
        format!("{cut_before}{shown}{cut_after}\n{}{}", " ".repeat(indent), "^".repeat(marks))
    }
}

/// At most 32 characters of `text`, for quoting what was read.
pub(crate) fn shortened(text: &str) -> String {
    const LONGEST: usize = 32;
    match text.char_indices().nth(LONGEST) {
        None => text.to_owned(),
        Some((cut, _)) => format!("{}…", &text[..cut]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The marks stand below the characters meant, whatever their width in bytes and the line's length.
    #[test]
    fn marks_stand_below_the_span() {
        assert_eq!(Span::new(4, 7).underlined("1 + sim(x)"), "1 + sim(x)\n    ^^^");
        assert_eq!(Span::new(3, 4).underlined("µ\n+?"), "+?\n^");
        assert_eq!(Span::new(2, 3).underlined("µ?"), "µ?\n ^");
        assert_eq!(Span::new(9, 12).underlined("a"), "a\n ^");
        let long = "x".repeat(1000);
        let picture = Span::new(500, 501).underlined(&long);
        assert_eq!(picture, format!("…{}…\n{}^", "x".repeat(120), " ".repeat(61)));
    }
}
