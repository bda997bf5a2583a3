//! Tokens to a tree, by precedence climbing.

use super::lexer::{Lexer, Token, TokenKind};
use super::{BinaryOperator, Constant, Function, ParseError, ParseFault, Precedence, Syntax, SyntaxBuilder};
use crate::{Span, span::shortened};

/// Longest text of a formula [bytes].
pub const TEXT_LIMIT: usize = 1 << 20;
/// Deepest nesting of operands, counted in expressions within expressions.
pub const NESTING_LIMIT: usize = 256;

/// Names listed in an error at most.
const NAMES_LISTED: usize = 24;
const OPERAND: &str = "a number, a name, `(`, `[`, `-` or `not`";

/// Reads `text` as a formula of `variables`. A variable hides a constant of its name.
///
/// Kinds are not checked here: `1 + (2 < 3)` has a tree. [`crate::Formula`] and its siblings check them.
///
/// # Errors
/// Names the place, what was read, and what would be accepted.
pub fn parse(text: &str, variables: &[&str]) -> Result<Syntax, ParseError> {
    if text.len() > TEXT_LIMIT {
        let fault = ParseFault::TextTooLong { bytes: text.len() };
        return Err(ParseError { span: Span::new(0, text.len()), fault });
    }
    let mut lexer = Lexer::new(text);
    let current = lexer.next_token()?;
    let builder = SyntaxBuilder::new(variables);
    let mut parser = Parser { text, variables, lexer, current, previous_end: 0, depth: 0, builder };
    parser.expression(Precedence::Or)?;
    match parser.current.kind {
        TokenKind::End => Ok(parser.builder.finish()),
        _ => Err(parser.unexpected("an operator or the end of the text")),
    }
}

struct Parser<'a> {
    text: &'a str,
    variables: &'a [&'a str],
    lexer: Lexer<'a>,
    current: Token,
    /// Where the token before `current` ended.
    previous_end: usize,
    depth: usize,
    builder: SyntaxBuilder,
}

impl<'a> Parser<'a> {
    /// An operand and all operators behind it that hold at least as tightly as `minimum`.
    fn expression(&mut self, minimum: Precedence) -> Result<(), ParseError> {
        if self.depth == NESTING_LIMIT {
            return Err(ParseError { span: self.current.span, fault: ParseFault::TooDeep });
        }
        self.depth += 1;
        let start = self.current.span.start;
        self.operand()?;

        let mut compared = false;
        while let TokenKind::Operator(operator) = self.current.kind {
            if operator.precedence() < minimum {
                break;
            }
            let comparison = operator.precedence() == Precedence::Comparison;
            if comparison && compared {
                return Err(ParseError { span: self.current.span, fault: ParseFault::ChainedComparison });
            }
            compared = comparison;
            self.advance()?;
            self.expression(operator.operand_precedences().1)?;
            self.builder.at(Span::new(start, self.previous_end)).binary(operator);
        }
        self.depth -= 1;
        Ok(())
    }

    fn operand(&mut self) -> Result<(), ParseError> {
        let Token { kind, span } = self.current;
        match kind {
            TokenKind::Number(value) => {
                self.advance()?;
                self.builder.at(span).number(value);
            }
            TokenKind::Name => {
                self.advance()?;
                self.name(span)?;
            }
            TokenKind::Operator(BinaryOperator::Subtract) => {
                self.advance()?;
                self.expression(Precedence::Negation)?;
                self.builder.at(Span::new(span.start, self.previous_end)).negate();
            }
            TokenKind::Operator(BinaryOperator::Add) => {
                self.advance()?;
                self.expression(Precedence::Negation)?;
            }
            TokenKind::Not => {
                self.advance()?;
                self.expression(Precedence::Not)?;
                self.builder.at(Span::new(span.start, self.previous_end)).not();
            }
            TokenKind::LeftParenthesis => {
                self.advance()?;
                self.expression(Precedence::Or)?;
                if self.current.kind != TokenKind::RightParenthesis {
                    return Err(self.unclosed("an operator or `)`", "(", span));
                }
                self.advance()?;
            }
            TokenKind::LeftBracket => {
                self.advance()?;
                let count = self.list(TokenKind::RightBracket, "[", "]", span)?;
                self.builder.at(Span::new(span.start, self.previous_end)).vector(count);
            }
            _ => return Err(self.unexpected(OPERAND)),
        }
        Ok(())
    }

    /// A variable, a constant or a call; its name at `span` is already read.
    fn name(&mut self, span: Span) -> Result<(), ParseError> {
        let text: &'a str = self.text;
        let name = span.of(text);
        let variable = self.variables.iter().position(|variable| *variable == name);
        let constant = Constant::ALL.into_iter().find(|constant| constant.name() == name);
        let fail = |fault| Err(ParseError { span, fault });

        if self.current.kind == TokenKind::LeftParenthesis {
            if name == "if" {
                return self.select(span);
            }
            return match Function::named(name) {
                Some(function) => self.call(function, span),
                None if variable.is_some() || constant.is_some() => {
                    fail(ParseFault::NotAFunction { name: shortened(name) })
                }
                None => fail(unknown_function(name)),
            };
        }
        if let Some(index) = variable {
            self.builder.at(span).variable(index as u32);
        } else if let Some(constant) = constant {
            self.builder.at(span).constant(constant);
        } else if let Some(function) = Function::named(name) {
            let (name, signature) = (function.name(), function.signature());
            return fail(ParseFault::FunctionWithoutArguments { name, signature });
        } else if name == "if" {
            return fail(ParseFault::FunctionWithoutArguments { name: "if", signature: SELECT });
        } else {
            return fail(self.unknown_name(name));
        }
        Ok(())
    }

    fn call(&mut self, function: Function, name: Span) -> Result<(), ParseError> {
        let given = self.parenthesised()?;
        let span = Span::new(name.start, self.previous_end);
        if !function.accepts(given) {
            let (signature, takes) = (function.signature(), function.argument_count());
            return Err(ParseError {
                span,
                fault: ParseFault::WrongArgumentCount { signature, takes, given },
            });
        }
        self.builder.at(span).call(function, given);
        Ok(())
    }

    fn select(&mut self, name: Span) -> Result<(), ParseError> {
        let given = self.parenthesised()?;
        let span = Span::new(name.start, self.previous_end);
        if given != 3 {
            let fault = ParseFault::WrongArgumentCount { signature: SELECT, takes: "3 arguments", given };
            return Err(ParseError { span, fault });
        }
        self.builder.at(span).select();
        Ok(())
    }

    /// `( a, b, ... )`, at least one; how many.
    fn parenthesised(&mut self) -> Result<usize, ParseError> {
        let opening = self.current.span;
        self.advance()?;
        self.list(TokenKind::RightParenthesis, "(", ")", opening)
    }

    /// `a, b, ...` and the closing token, at least one; how many.
    fn list(
        &mut self,
        closing: TokenKind,
        opened: &str,
        closed: &str,
        opening: Span,
    ) -> Result<usize, ParseError> {
        let mut count = 0;
        loop {
            self.expression(Precedence::Or)?;
            count += 1;
            match self.current.kind {
                TokenKind::Comma => self.advance()?,
                kind if kind == closing => break,
                _ => return Err(self.unclosed(&format!("an operator, `,` or `{closed}`"), opened, opening)),
            }
        }
        self.advance()?;
        Ok(count)
    }

    fn advance(&mut self) -> Result<(), ParseError> {
        self.previous_end = self.current.span.end;
        self.current = self.lexer.next_token()?;
        Ok(())
    }

    fn unexpected(&self, expected: &str) -> ParseError {
        let Token { kind, span } = self.current;
        let read = match kind {
            TokenKind::End => "the end of the text".to_owned(),
            _ => format!("`{}`", shortened(span.of(self.text))),
        };
        // `2 x` and `2 (x)` are the commonest of these
        let product = match kind {
            TokenKind::Name | TokenKind::Number(_) | TokenKind::LeftParenthesis if expected != OPERAND => {
                " (a product is written with `*`)"
            }
            _ => "",
        };
        ParseError { span, fault: ParseFault::Unexpected { read, expected: format!("{expected}{product}") } }
    }

    fn unclosed(&self, expected: &str, opened: &str, opening: Span) -> ParseError {
        let mut error = self.unexpected(expected);
        if let (TokenKind::End, ParseFault::Unexpected { expected, .. }) =
            (self.current.kind, &mut error.fault)
        {
            expected.push_str(&format!(" for the `{opened}` at byte {}", opening.start));
        }
        error
    }

    fn unknown_name(&self, name: &str) -> ParseFault {
        let constants = Constant::ALL.map(Constant::name);
        let all = || self.variables.iter().copied().chain(constants);
        let mut known: Vec<String> = all().take(NAMES_LISTED).map(shortened).collect();
        if all().count() > NAMES_LISTED {
            known.push("…".to_owned());
        }
        let nearest = souple_table::nearest(name, all()).map(shortened);
        ParseFault::UnknownName { name: shortened(name), nearest, known }
    }
}

const SELECT: &str = "if(condition, a, b)";

fn unknown_function(name: &str) -> ParseFault {
    let mut known: Vec<&'static str> = Function::ALL.map(Function::name).to_vec();
    known.push("if");
    let nearest = match name {
        // natural to most programming languages, far in letters or ambiguous
        "log" => Some("ln"),
        "sgn" => Some("sign"),
        "round" => Some("floor"),
        "power" => Some("pow"),
        "select" | "where" => Some("if"),
        _ => souple_table::nearest(name, known.iter().copied()),
    };
    ParseFault::UnknownFunction { name: shortened(name), nearest, known }
}
