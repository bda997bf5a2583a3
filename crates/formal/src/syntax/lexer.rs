//! A formula's text cut into tokens, one at a time.

use super::{BinaryOperator, ParseError, ParseFault};
use crate::{Span, span::shortened};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TokenKind {
    Number(f64),
    /// A name that is no operator; its text is its span's.
    Name,
    /// `not`
    Not,
    /// `-` is here as subtraction, `+` as addition; the parser knows when they are signs.
    Operator(BinaryOperator),
    LeftParenthesis,
    RightParenthesis,
    LeftBracket,
    RightBracket,
    Comma,
    End,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Token {
    pub kind: TokenKind,
    pub span: Span,
}

pub(super) struct Lexer<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Lexer<'a> {
    pub fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    pub fn next_token(&mut self) -> Result<Token, ParseError> {
        self.skip(char::is_whitespace);
        let start = self.at;
        let Some(first) = self.rest().chars().next() else {
            return Ok(Token { kind: TokenKind::End, span: Span::new(start, start) });
        };
        let kind = if first.is_ascii_digit() || (first == '.' && self.digit_at(start + 1)) {
            self.number()?
        } else if first.is_alphabetic() || first == '_' {
            self.skip(|c| c.is_alphabetic() || c.is_ascii_digit() || c == '_');
            match &self.text[start..self.at] {
                "and" => TokenKind::Operator(BinaryOperator::And),
                "or" => TokenKind::Operator(BinaryOperator::Or),
                "not" => TokenKind::Not,
                _ => TokenKind::Name,
            }
        } else {
            self.symbol(first)?
        };
        Ok(Token { kind, span: Span::new(start, self.at) })
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn skip(&mut self, wanted: impl Fn(char) -> bool) {
        let rest = self.rest();
        self.at += rest.find(|c| !wanted(c)).unwrap_or(rest.len());
    }

    fn digit_at(&self, at: usize) -> bool {
        self.text.as_bytes().get(at).is_some_and(u8::is_ascii_digit)
    }

    /// `digits [. digits] [e [+-] digits]`; the point may lack digits on one side.
    fn number(&mut self) -> Result<TokenKind, ParseError> {
        let start = self.at;
        self.skip(|c| c.is_ascii_digit());
        if self.rest().starts_with('.') {
            self.at += 1;
            self.skip(|c| c.is_ascii_digit());
        }
        // an `e` without digits behind it is a name of its own
        if self.rest().starts_with(['e', 'E']) {
            let signed = self.rest()[1..].starts_with(['+', '-']);
            let digits = self.at + 1 + usize::from(signed);
            if self.digit_at(digits) {
                self.at = digits;
                self.skip(|c| c.is_ascii_digit());
            }
        }
        let read = &self.text[start..self.at];
        match read.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(TokenKind::Number(value)),
            _ => {
                let fault = ParseFault::NumberTooLarge { read: shortened(read) };
                Err(ParseError { span: Span::new(start, self.at), fault })
            }
        }
    }

    fn symbol(&mut self, first: char) -> Result<TokenKind, ParseError> {
        use BinaryOperator as Operator;
        let rest = self.rest();
        let two = [
            ("<=", Operator::LessOrEqual),
            (">=", Operator::GreaterOrEqual),
            ("==", Operator::Equal),
            ("!=", Operator::NotEqual),
        ];
        if let Some((_, operator)) = two.iter().find(|(symbol, _)| rest.starts_with(symbol)) {
            self.at += 2;
            return Ok(TokenKind::Operator(*operator));
        }
        let kind = match first {
            '+' => TokenKind::Operator(Operator::Add),
            '-' => TokenKind::Operator(Operator::Subtract),
            '*' if !rest.starts_with("**") => TokenKind::Operator(Operator::Multiply),
            '/' => TokenKind::Operator(Operator::Divide),
            '^' => TokenKind::Operator(Operator::Power),
            '<' => TokenKind::Operator(Operator::Less),
            '>' => TokenKind::Operator(Operator::Greater),
            '(' => TokenKind::LeftParenthesis,
            ')' => TokenKind::RightParenthesis,
            '[' => TokenKind::LeftBracket,
            ']' => TokenKind::RightBracket,
            ',' => TokenKind::Comma,
            _ => {
                let fault = ParseFault::UnexpectedCharacter { character: first, instead: instead_of(first) };
                return Err(ParseError { span: Span::new(self.at, self.at + first.len_utf8()), fault });
            }
        };
        self.at += 1;
        Ok(kind)
    }
}

/// What other languages write with a character that this one does not have.
fn instead_of(character: char) -> Option<&'static str> {
    Some(match character {
        '*' => "`^` for a power",
        '=' => "`==` to compare",
        '!' => "`not`, or `!=` to compare",
        '&' => "`and`",
        '|' => "`or`, or `abs(x)` for an absolute value",
        '?' | ':' => "`if(condition, a, b)` to choose",
        ';' => "`,` between arguments",
        '%' => "`x - n*floor(x/n)` for a remainder, `x/100` for a percentage",
        '²' | '³' | '⁻' => "`^` for a power",
        '×' | '·' | '⋅' => "`*` for a product",
        '÷' => "`/` for a quotient",
        '−' | '–' => "`-` for a difference",
        '≤' | '≥' | '≠' => "`<=`, `>=` or `!=`",
        '√' => "`sqrt(x)`",
        '{' | '}' => "`(` and `)` for grouping",
        '.' => "a digit beside the point",
        '"' | '\'' => "names without quotes",
        _ => return None,
    })
}
