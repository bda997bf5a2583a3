//! A place in the bytes of a file, and numbers read from it as text or as binary.

use std::cell::Cell;
use std::fmt::Arguments;
use std::str::FromStr;

use crate::error::{Fault, Place, quoted};

/// Order of the bytes of a binary number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Endian {
    Little,
    Big,
}

/// How numbers are written in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Text,
    Binary(Endian),
}

/// Reads bytes from front to back. Subjects name what is read, for the fault where it is not there.
#[derive(Clone, Debug)]
pub(crate) struct Cursor<'a> {
    bytes: &'a [u8],
    position: usize,
    /// A position and the line ends before it, from the last place that was asked for: the places of all lines together
    /// are one pass over the file.
    counted: Cell<(usize, usize)>,
    pub encoding: Encoding,
}

impl<'a> Cursor<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, position: 0, counted: Cell::new((0, 0)), encoding: Encoding::Text }
    }

    pub fn position(&self) -> usize {
        self.position
    }

    pub fn rest(&self) -> &'a [u8] {
        &self.bytes[self.position..]
    }

    pub fn seek(&mut self, position: usize) {
        self.position = position.min(self.bytes.len());
    }

    /// Here: a line for text, a byte for binary.
    pub fn place(&self) -> Place {
        match self.encoding {
            Encoding::Text => Place::Line(1 + self.line_ends()),
            Encoding::Binary(_) => Place::Byte(self.position),
        }
    }

    /// Line ends before the position.
    fn line_ends(&self) -> usize {
        let (from, ends) = match self.counted.get() {
            // a cursor that was set back
            (from, _) if from > self.position => (0, 0),
            counted => counted,
        };
        let ends = ends + count_line_ends(&self.bytes[from..self.position]);
        self.counted.set((self.position, ends));
        ends
    }

    /// The fault of what has just been read.
    pub fn fault(
        &self,
        subject: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Fault {
        Fault::new(self.place(), subject, found, expected)
    }

    pub fn skip_space(&mut self) {
        let spaces = self.rest().iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        self.position += spaces;
    }

    /// The next word between spaces; `None` at the end.
    pub fn word(&mut self) -> Option<&'a [u8]> {
        self.skip_space();
        let rest = self.rest();
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.position += length;
        (length > 0).then(|| &rest[..length])
    }

    pub fn expect_word(&mut self, subject: Arguments<'_>, expected: &str) -> Result<&'a [u8], Fault> {
        match self.word() {
            Some(word) => Ok(word),
            None => Err(Fault::cut_off(self.place(), subject.to_string(), expected)),
        }
    }

    /// The rest of this line without its end; `None` at the end of the file.
    pub fn line(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest();
        if rest.is_empty() {
            return None;
        }
        let length = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
        self.position += (length + 1).min(rest.len());
        Some(rest[..length].strip_suffix(b"\r").unwrap_or(&rest[..length]))
    }

    /// The next `count` bytes.
    pub fn take(&mut self, count: usize, subject: Arguments<'_>) -> Result<&'a [u8], Fault> {
        let rest = self.rest();
        if count > rest.len() {
            let (left, expected) = (rest.len(), format!("{count} bytes"));
            return Err(Fault::new(
                self.place(),
                subject.to_string(),
                format!("cut off after {left} bytes"),
                expected,
            ));
        }
        self.position += count;
        Ok(&rest[..count])
    }

    /// The next word as a number.
    pub fn parse<T: FromStr>(&mut self, subject: Arguments<'_>, expected: &str) -> Result<T, Fault> {
        let word = self.expect_word(subject, expected)?;
        parse(word).ok_or_else(|| self.fault(subject.to_string(), quoted(word), expected))
    }

    /// A whole number; 4 bytes in binary.
    pub fn int(&mut self, subject: Arguments<'_>) -> Result<i64, Fault> {
        match self.encoding {
            Encoding::Text => self.parse(subject, "a whole number"),
            Encoding::Binary(endian) => {
                let bytes = array(self.take(4, subject)?);
                Ok(i64::from(match endian {
                    Endian::Little => i32::from_le_bytes(bytes),
                    Endian::Big => i32::from_be_bytes(bytes),
                }))
            }
        }
    }

    /// A count or tag; `width` bytes (4 or 8) in binary.
    pub fn size(&mut self, width: usize, subject: Arguments<'_>) -> Result<u64, Fault> {
        match self.encoding {
            Encoding::Text => self.parse(subject, "a whole number of at least 0"),
            Encoding::Binary(endian) if width == 4 => {
                let bytes = array(self.take(4, subject)?);
                Ok(u64::from(match endian {
                    Endian::Little => u32::from_le_bytes(bytes),
                    Endian::Big => u32::from_be_bytes(bytes),
                }))
            }
            Encoding::Binary(endian) => {
                let bytes = array(self.take(8, subject)?);
                Ok(match endian {
                    Endian::Little => u64::from_le_bytes(bytes),
                    Endian::Big => u64::from_be_bytes(bytes),
                })
            }
        }
    }

    /// A number; 8 bytes in binary.
    pub fn double(&mut self, subject: Arguments<'_>) -> Result<f64, Fault> {
        match self.encoding {
            Encoding::Text => self.parse(subject, "a number"),
            Encoding::Binary(endian) => {
                let bytes = array(self.take(8, subject)?);
                Ok(match endian {
                    Endian::Little => f64::from_le_bytes(bytes),
                    Endian::Big => f64::from_be_bytes(bytes),
                })
            }
        }
    }

    /// A number that is neither infinite nor NaN.
    pub fn finite(&mut self, subject: Arguments<'_>) -> Result<f64, Fault> {
        let number = self.double(subject)?;
        if number.is_finite() {
            return Ok(number);
        }
        Err(self.fault(subject.to_string(), number.to_string(), "a finite number"))
    }

    /// Refuses a count that the bytes left cannot hold, each item taking `least` bytes or more.
    pub fn check_count(&self, count: u64, least: usize, subject: Arguments<'_>) -> Result<usize, Fault> {
        let most = self.rest().len() / least.max(1) + 1;
        usize::try_from(count).ok().filter(|count| *count <= most).ok_or_else(|| {
            self.fault(
                subject.to_string(),
                count.to_string(),
                format!("at most {most}, which is what the rest of the file has room for"),
            )
        })
    }
}

/// The number of the line of a position, from 1.
pub(crate) fn line_of(bytes: &[u8], position: usize) -> usize {
    1 + count_line_ends(&bytes[..position.min(bytes.len())])
}

fn count_line_ends(bytes: &[u8]) -> usize {
    bytes.iter().filter(|byte| **byte == b'\n').count()
}

/// What a text without a mark of its end may hide: cut within its last number it is another number.
pub(crate) fn open_end(bytes: &[u8], last_line: &str) -> Option<String> {
    let is_open = bytes.last().is_some_and(|byte| *byte != b'\n');
    is_open.then(|| format!("{last_line} has no end: the file may be cut off"))
}

pub(crate) fn parse<T: FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// `take(N)` as an array of `N`.
fn array<const N: usize>(bytes: &[u8]) -> [u8; N] {
    bytes.try_into().expect("as many bytes as were taken")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_lines_and_places() {
        let mut cursor = Cursor::new(b"a bc\r\nrest of it\n7 x");
        assert_eq!(cursor.word(), Some(&b"a"[..]));
        assert_eq!(cursor.word(), Some(&b"bc"[..]));
        assert_eq!(cursor.line(), Some(&b""[..]));
        assert_eq!(cursor.line(), Some(&b"rest of it"[..]));
        assert_eq!(cursor.int(format_args!("seven")).unwrap(), 7);
        let fault = cursor.int(format_args!("the count")).unwrap_err();
        assert_eq!(fault.to_string(), "line 3: the count is \"x\"; expected a whole number");
        let end = cursor.double(format_args!("x")).unwrap_err();
        assert_eq!(end.found, "missing, the file ends here");
    }

    /// Places are those of a count from the start, asked for in any order and after a step back.
    #[test]
    fn places_go_on_from_the_last() {
        let bytes = b"a\n\nb\nc";
        let mut cursor = Cursor::new(bytes);
        for position in [0, 2, 2, 6, 3, 7, 0, 5, 99] {
            cursor.seek(position);
            assert_eq!(cursor.place(), Place::Line(line_of(bytes, position)), "{position}");
        }
    }

    #[test]
    fn binary_in_both_orders() {
        for (endian, bytes) in [(Endian::Little, 2.5f64.to_le_bytes()), (Endian::Big, 2.5f64.to_be_bytes())] {
            let mut cursor = Cursor::new(&bytes);
            cursor.encoding = Encoding::Binary(endian);
            assert_eq!(cursor.double(format_args!("x")).unwrap(), 2.5);
            assert_eq!(cursor.int(format_args!("n")).unwrap_err().place, Place::Byte(8));
        }
    }
}
