//! A place in the bytes of a file, and numbers read from it as text or as binary.

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
    pub encoding: Encoding,
}

impl<'a> Cursor<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, position: 0, encoding: Encoding::Text }
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
        self.place_of(self.position)
    }

    fn place_of(&self, position: usize) -> Place {
        match self.encoding {
            Encoding::Text => Place::Line(line_of(self.bytes, position)),
            Encoding::Binary(_) => Place::Byte(position),
        }
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
    1 + bytes[..position.min(bytes.len())].iter().filter(|byte| **byte == b'\n').count()
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
