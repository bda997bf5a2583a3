//! Tokens to a syntax tree, by precedence (Pratt 1973, "Top down operator precedence").

use crate::expression::Grouping;
use crate::lexer::{Lexer, Symbol, Token};
use crate::{BinaryOperator, Expression, NodeId, NodeKind, ParseError, Span, UnaryOperator};

/// Longest text of a formula [bytes].
pub const LONGEST: usize = 1_000_000;
/// Deepest nesting of parentheses, arguments, signs and operators on the right of others.
pub const DEEPEST: usize = 200;

impl Expression {
    /// Reads the syntax of a formula; names may be anything.
    ///
    /// # Errors
    /// Names the place, what was read and what would be accepted there; or the limit that is exceeded.
    pub fn parse(text: &str) -> Result<Self, ParseError> {
        if text.len() > LONGEST {
            return Err(ParseError::TooLong { length: text.len(), limit: LONGEST });
        }
        let mut lexer = Lexer::new(text);
        let (token, span) = lexer.next()?;
        let mut parser = Parser { text, lexer, token, span, depth: 0, expression: Self::empty() };
        parser.operand_of(0)?;
        match parser.token {
            Token::End => Ok(parser.expression),
            Token::Symbol(Symbol::ParenthesisClose) => Err(parser.unexpected("`(` before it, or the end")),
            _ => Err(parser.unfinished(" or the end")),
        }
    }
}

struct Parser<'a> {
    text: &'a str,
    lexer: Lexer<'a>,
    /// The token that is not yet used, and its place.
    token: Token,
    span: Span,
    depth: usize,
    expression: Expression,
}

/// A node and its place with the parentheses around it.
type Placed = (NodeId, Span);

impl Parser<'_> {
    fn advance(&mut self) -> Result<Span, ParseError> {
        let span = self.span;
        (self.token, self.span) = self.lexer.next()?;
        Ok(span)
    }

    fn word(&self) -> Option<&str> {
        (self.token == Token::Word).then(|| self.span.of(self.text))
    }

    fn unexpected(&self, expected: &str) -> ParseError {
        let read = match self.token {
            Token::End if self.text.trim().is_empty() => "an empty text".to_owned(),
            Token::End => "the end".to_owned(),
            // a name of a megabyte says no more than its beginning
            _ => format!("`{}`", self.span.of(self.text).chars().take(40).collect::<String>()),
        };
        ParseError::Unexpected { read, expected: expected.to_owned(), span: self.span }
    }

    /// Behind an operand stands neither an operator nor one of `ends`.
    fn unfinished(&self, ends: &str) -> ParseError {
        let begins_operand = matches!(
            self.token,
            Token::Number(_) | Token::Word | Token::Symbol(Symbol::ParenthesisOpen | Symbol::BracketOpen)
        );
        // books write products without a sign
        let product = if begins_operand { " (is a `*` missing?)" } else { "" };
        self.unexpected(&format!("an operator{product}{ends}"))
    }

    /// The closing bracket behind an operand; `ends` are the words for what could stand there.
    fn close(&mut self, symbol: Symbol, ends: &str) -> Result<Span, ParseError> {
        if self.token == Token::Symbol(symbol) { self.advance() } else { Err(self.unfinished(ends)) }
    }

    /// A formula whose operators bind at least as strongly as `weakest`.
    fn operand_of(&mut self, weakest: u8) -> Result<Placed, ParseError> {
        if self.depth == DEEPEST {
            return Err(ParseError::TooDeep { limit: DEEPEST, span: self.span });
        }
        self.depth += 1;
        let (mut left, mut left_span) = self.prefix()?;
        let mut compared = false;
        while let Some(operator) = self.binary_operator().filter(|operator| operator.precedence() >= weakest)
        {
            if compared && operator.is_comparison() {
                return Err(self.unexpected("`and` between two comparisons"));
            }
            compared = operator.is_comparison();
            self.advance()?;
            let precedence = operator.precedence();
            let (right, right_span) =
                self.operand_of(precedence + u8::from(operator.grouping() != Grouping::Right))?;
            left_span = left_span.to(right_span);
            left = self.expression.push(NodeKind::Binary { operator, left, right }, left_span);
        }
        self.depth -= 1;
        Ok((left, left_span))
    }

    fn binary_operator(&self) -> Option<BinaryOperator> {
        Some(match self.token {
            Token::Symbol(symbol) => match symbol {
                Symbol::Plus => BinaryOperator::Add,
                Symbol::Minus => BinaryOperator::Subtract,
                Symbol::Star => BinaryOperator::Multiply,
                Symbol::Slash => BinaryOperator::Divide,
                Symbol::Caret => BinaryOperator::Power,
                Symbol::Less => BinaryOperator::Less,
                Symbol::LessOrEqual => BinaryOperator::LessOrEqual,
                Symbol::Greater => BinaryOperator::Greater,
                Symbol::GreaterOrEqual => BinaryOperator::GreaterOrEqual,
                Symbol::Equal => BinaryOperator::Equal,
                Symbol::NotEqual => BinaryOperator::NotEqual,
                Symbol::Comma
                | Symbol::ParenthesisOpen
                | Symbol::ParenthesisClose
                | Symbol::BracketOpen
                | Symbol::BracketClose => return None,
            },
            Token::Word => match self.word()? {
                "and" => BinaryOperator::And,
                "or" => BinaryOperator::Or,
                _ => return None,
            },
            Token::Number(_) | Token::End => return None,
        })
    }

    /// A number, name, call, list, sign, negation or parentheses.
    fn prefix(&mut self) -> Result<Placed, ParseError> {
        const EXPECTED: &str = "a number, a name, `(` or a sign";
        match self.token {
            Token::Number(number) => {
                let span = self.advance()?;
                Ok((self.expression.push(NodeKind::Number(number), span), span))
            }
            Token::Word => match self.word() {
                Some("not") => self.unary(UnaryOperator::Not),
                Some("and" | "or") => Err(self.unexpected(EXPECTED)),
                _ => self.name_or_call(),
            },
            Token::Symbol(Symbol::Minus) => self.unary(UnaryOperator::Negate),
            // a plus sign changes nothing
            Token::Symbol(Symbol::Plus) => {
                let sign = self.advance()?;
                let (operand, span) = self.operand_of(UnaryOperator::Negate.precedence())?;
                Ok((operand, sign.to(span)))
            }
            Token::Symbol(Symbol::ParenthesisOpen) => {
                let open = self.advance()?;
                let (inside, _) = self.operand_of(0)?;
                let close = self.close(Symbol::ParenthesisClose, " or `)`")?;
                Ok((inside, open.to(close)))
            }
            Token::Symbol(Symbol::BracketOpen) => {
                let open = self.advance()?;
                let (components, close) = self.list(Symbol::BracketClose, ", `,` or `]`")?;
                let span = open.to(close);
                Ok((self.expression.push(NodeKind::Vector(components), span), span))
            }
            Token::Symbol(_) | Token::End => Err(self.unexpected(EXPECTED)),
        }
    }

    fn unary(&mut self, operator: UnaryOperator) -> Result<Placed, ParseError> {
        let sign = self.advance()?;
        let (operand, operand_span) = self.operand_of(operator.precedence())?;
        let span = sign.to(operand_span);
        Ok((self.expression.push(NodeKind::Unary { operator, operand }, span), span))
    }

    fn name_or_call(&mut self) -> Result<Placed, ParseError> {
        let name_span = self.advance()?;
        let name = name_span.of(self.text).to_owned();
        if self.token != Token::Symbol(Symbol::ParenthesisOpen) {
            return Ok((self.expression.push(NodeKind::Name(name), name_span), name_span));
        }
        self.advance()?;
        let (arguments, close) = self.list(Symbol::ParenthesisClose, ", `,` or `)`")?;
        let span = name_span.to(close);
        Ok((self.expression.push(NodeKind::Call { name, arguments }, span), span))
    }

    /// Formulas between commas up to `close`, which may follow at once.
    fn list(&mut self, close: Symbol, ends: &str) -> Result<(Vec<NodeId>, Span), ParseError> {
        let mut items = Vec::new();
        if self.token == Token::Symbol(close) {
            return Ok((items, self.advance()?));
        }
        loop {
            items.push(self.operand_of(0)?.0);
            if self.token != Token::Symbol(Symbol::Comma) {
                return Ok((items, self.close(close, ends)?));
            }
            self.advance()?;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(text: &str) -> String {
        Expression::parse(text).unwrap().to_string()
    }

    /// Precedence and grouping, shown by what the printer leaves of the parentheses.
    #[test]
    fn precedence() {
        let cases = [
            ("1 + 2 * 3", "1 + 2 * 3"),
            ("(1 + 2) * 3", "(1 + 2) * 3"),
            ("1 + (2 * 3)", "1 + 2 * 3"),
            ("(a - b) - c", "a - b - c"),
            ("a - (b - c)", "a - (b - c)"),
            ("(a / b) / c", "a / b / c"),
            ("a ^ (b ^ c)", "a^b^c"),
            ("(a ^ b) ^ c", "(a^b)^c"),
            ("-(a^2)", "-a^2"),
            ("(-a)^2", "(-a)^2"),
            ("2^-3", "2^(-3)"),
            ("-2^-a*b", "-2^(-a) * b"),
            ("(-a)*b", "-a * b"),
            ("-(a*b)", "-(a * b)"),
            ("+a - +b", "a - b"),
            ("- -a", "--a"),
            ("not a < b and c", "not a < b and c"),
            ("not (a and b) or c", "not (a and b) or c"),
            ("(a or b) and c", "(a or b) and c"),
            ("(a < b) == c", "(a < b) == c"),
            ("(not a) < b", "(not a) < b"),
            ("if(a<b,[1,2 ],f( ))", "if(a < b, [1, 2], f())"),
            ("1e30+1e-30+.5", "1e30 + 1e-30 + 0.5"),
        ];
        for (text, expected) in cases {
            assert_eq!(printed(text), expected, "{text}");
            assert_eq!(Expression::parse(text), Expression::parse(expected), "{text}");
        }
    }

    #[test]
    fn spans_cover_their_text() {
        let text = " (a + b) * sin( x ) ";
        let expression = Expression::parse(text).unwrap();
        let read: Vec<&str> = expression.nodes().iter().map(|node| node.span.of(text)).collect();
        assert_eq!(read, ["a", "b", "a + b", "x", "sin( x )", "(a + b) * sin( x )"]);
        assert_eq!(expression.subtree(expression.root()), 0..=5);
    }

    /// Errors point at the first character that cannot be understood, and say what could stand there.
    #[test]
    fn errors() {
        let cases = [
            ("", 0, "an empty text was read at byte 0, where a number, a name, `(` or a sign is wanted"),
            ("1 +", 3, "the end was read at byte 3, where a number, a name, `(` or a sign is wanted"),
            ("2 x", 2, "`x` was read at byte 2, where an operator (is a `*` missing?) or the end is wanted"),
            (
                "(a)(b)",
                3,
                "`(` was read at byte 3, where an operator (is a `*` missing?) or the end is wanted",
            ),
            ("(2 x)", 3, "`x` was read at byte 3, where an operator (is a `*` missing?) or `)` is wanted"),
            (
                "f(a b)",
                4,
                "`b` was read at byte 4, where an operator (is a `*` missing?), `,` or `)` is wanted",
            ),
            ("(1 + 2", 6, "the end was read at byte 6, where an operator or `)` is wanted"),
            ("1)", 1, "`)` was read at byte 1, where `(` before it, or the end is wanted"),
            ("f(1, )", 5, "`)` was read at byte 5, where a number, a name, `(` or a sign is wanted"),
            ("[1; 2]", 2, "`;` was read at byte 2, where `,`, or nothing at the end is wanted"),
            ("a < b < c", 6, "`<` was read at byte 6, where `and` between two comparisons is wanted"),
            ("x ** 2", 2, "`**` was read at byte 2, where `^` is wanted"),
            ("x # y", 2, "`#` was read at byte 2, where a number, a name or an operator is wanted"),
            ("and", 0, "`and` was read at byte 0, where a number, a name, `(` or a sign is wanted"),
        ];
        for (text, at, message) in cases {
            let error = Expression::parse(text).unwrap_err();
            assert_eq!((error.span().start, error.to_string().as_str()), (at, message), "{text}");
        }
    }

    /// Nesting and length are limited; long sums are not nested, and print as they were.
    #[test]
    fn limits() {
        for nested in ["(", "-", "not ", "2^", "f(", "[", "1+(", "+"] {
            let error = Expression::parse(&nested.repeat(100_000)).unwrap_err();
            assert!(matches!(error, ParseError::TooDeep { .. }), "{nested}: {error}");
        }
        assert!(Expression::parse(&format!("{}1{}", "(".repeat(150), ")".repeat(150))).is_ok());
        assert!(matches!(Expression::parse(&"1".repeat(LONGEST + 1)), Err(ParseError::TooLong { .. })));
        let sum = Expression::parse(&format!("1{}", "+1".repeat(400_000))).unwrap();
        assert_eq!(sum.nodes().len(), 800_001);
        assert_eq!(sum.to_string().len(), 1 + 400_000 * 4);
    }
}
