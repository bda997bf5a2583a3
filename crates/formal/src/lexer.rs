//! Text to tokens: numbers, names, operators, brackets.

use crate::{ParseError, Span};

/// The smallest parts of a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Token {
    Number(f64),
    /// A name, or one of the words `and`, `or`, `not`: see the span.
    Word,
    Symbol(Symbol),
    End,
}

/// Operators and punctuation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Symbol {
    Plus,
    Minus,
    Star,
    Slash,
    Caret,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
    Comma,
    ParenthesisOpen,
    ParenthesisClose,
    BracketOpen,
    BracketClose,
}

/// Longer symbols stand before their beginnings.
const SYMBOLS: &[(&str, Symbol)] = &[
    ("<=", Symbol::LessOrEqual),
    (">=", Symbol::GreaterOrEqual),
    ("==", Symbol::Equal),
    ("!=", Symbol::NotEqual),
    ("+", Symbol::Plus),
    ("-", Symbol::Minus),
    ("*", Symbol::Star),
    ("/", Symbol::Slash),
    ("^", Symbol::Caret),
    ("<", Symbol::Less),
    (">", Symbol::Greater),
    (",", Symbol::Comma),
    ("(", Symbol::ParenthesisOpen),
    (")", Symbol::ParenthesisClose),
    ("[", Symbol::BracketOpen),
    ("]", Symbol::BracketClose),
];

/// Symbols of other languages, and how they are written here.
const FOREIGN: &[(&str, &str)] = &[
    ("**", "`^`"),
    ("&&", "`and`"),
    ("||", "`or`"),
    ("&", "`and`"),
    ("|", "`or`, or `abs(x)`"),
    ("!", "`not`"),
    ("=", "`==`"),
    ("?", "`if(condition, value, otherwise)`"),
    ("×", "`*`"),
    ("·", "`*`"),
    ("÷", "`/`"),
    ("−", "`-`"),
    ("≤", "`<=`"),
    ("≥", "`>=`"),
    ("≠", "`!=`"),
    ("²", "`^2`"),
    ("³", "`^3`"),
    ("√", "`sqrt(x)`"),
    ("π", "`pi`"),
    ("{", "`(`"),
    ("}", "`)`"),
    (";", "`,`, or nothing at the end"),
];

/// Reads tokens one after the other.
pub(crate) struct Lexer<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Lexer<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    /// The next token and its place; [`Token::End`] for ever after the last one.
    pub(crate) fn next(&mut self) -> Result<(Token, Span), ParseError> {
        let rest = self.text[self.at..].trim_start();
        self.at = self.text.len() - rest.len();
        let Some(first) = rest.chars().next() else {
            return Ok((Token::End, Span::new(self.at, self.at)));
        };
        if first.is_ascii_digit() || (first == '.' && rest[1..].starts_with(|c: char| c.is_ascii_digit())) {
            return self.number(rest);
        }
        if first.is_ascii_alphabetic() || first == '_' {
            let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
            return Ok((Token::Word, self.take(end)));
        }
        let starts = |(symbol, _): &&(&str, _)| rest.starts_with(symbol);
        // `**` begins with `*`, so what is foreign goes first, but for `!=` and `==`
        let foreign =
            FOREIGN.iter().find(starts).filter(|_| !rest.starts_with("!=") && !rest.starts_with("=="));
        if let Some((read, written_here)) = foreign {
            let expected = written_here.to_string();
            return Err(ParseError::Unexpected {
                read: format!("`{read}`"),
                expected,
                span: self.take(read.len()),
            });
        }
        if let Some((text, symbol)) = SYMBOLS.iter().find(|(symbol, _)| rest.starts_with(symbol)) {
            return Ok((Token::Symbol(*symbol), self.take(text.len())));
        }
        let expected = "a number, a name or an operator".to_owned();
        let read = format!("`{}`", first.escape_debug());
        Err(ParseError::Unexpected { read, expected, span: self.take(first.len_utf8()) })
    }

    /// Digits with at most one point, and `e` with a whole exponent.
    fn number(&mut self, rest: &str) -> Result<(Token, Span), ParseError> {
        let bytes = rest.as_bytes();
        let digits_from =
            |at: usize| at + bytes[at..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        let mut end = digits_from(0);
        if bytes.get(end) == Some(&b'.') {
            end = digits_from(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let digits = end + 1 + usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            if digits_from(digits) > digits {
                end = digits_from(digits);
            }
        }
        let span = self.take(end);
        let read = span.of(self.text);
        match read.parse() {
            Ok(number) if f64::is_finite(number) => Ok((Token::Number(number), span)),
            _ => Err(ParseError::NumberTooLarge { read: read.chars().take(40).collect(), span }),
        }
    }

    fn take(&mut self, length: usize) -> Span {
        self.at += length;
        Span::new(self.at - length, self.at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Vec<(Token, &str)> {
        let mut lexer = Lexer::new(text);
        let mut tokens = Vec::new();
        loop {
            match lexer.next().unwrap() {
                (Token::End, _) => return tokens,
                (token, span) => tokens.push((token, span.of(text))),
            }
        }
    }

    #[test]
    fn numbers_and_names() {
        assert_eq!(tokens("1.5e-3"), [(Token::Number(1.5e-3), "1.5e-3")]);
        assert_eq!(tokens(" .5 "), [(Token::Number(0.5), ".5")]);
        assert_eq!(tokens("2e"), [(Token::Number(2.0), "2"), (Token::Word, "e")]);
        assert_eq!(
            tokens("x_1<=y"),
            [(Token::Word, "x_1"), (Token::Symbol(Symbol::LessOrEqual), "<="), (Token::Word, "y")]
        );
        assert!(matches!(Lexer::new("1e999").next(), Err(ParseError::NumberTooLarge { .. })));
    }

    /// Habits from other languages are answered with how it is written here.
    #[test]
    fn foreign_symbols() {
        for (read, written_here) in FOREIGN {
            let Err(ParseError::Unexpected { expected, span, .. }) = Lexer::new(read).next() else {
                panic!("{read} was accepted")
            };
            assert_eq!((expected.as_str(), span), (*written_here, Span::new(0, read.len())));
        }
    }
}
