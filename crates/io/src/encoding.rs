//! How the text of a file is written: UTF-8 and ASCII are read, a mark of byte order left out, UTF-16 told by its name.

use crate::error::{Fault, Place};

/// Editors and spreadsheets begin files with this.
const MARK: &[u8] = "\u{feff}".as_bytes();
/// The same in the two orders of UTF-16.
const MARKS_OF_16: [(&[u8], &str); 2] = [(b"\xff\xfe", "little endian"), (b"\xfe\xff", "big endian")];

/// Letters by which UTF-16 without a mark is known: each beside a zero.
const LETTERS: usize = 8;

/// What readers are given of a file: all of it, or what follows a mark of byte order.
#[derive(Clone, Copy)]
pub(crate) struct Content<'a> {
    pub bytes: &'a [u8],
    /// Length of the mark that was left out [bytes].
    mark: usize,
}

impl<'a> Content<'a> {
    /// A file's content; `is_known` says whether a format knows bytes for its own. Those of a binary format may happen to begin as a
    /// mark does, and then are known with it and not without it.
    ///
    /// # Errors
    /// It is UTF-16.
    pub fn of(bytes: &'a [u8], is_known: impl Fn(&[u8]) -> bool) -> Result<Self, Fault> {
        let raw = Self { bytes, mark: 0 };
        match unmarked(bytes) {
            Ok(text) if text.len() == bytes.len() || is_known(bytes) && !is_known(text) => Ok(raw),
            Ok(text) => Ok(Self { bytes: text, mark: bytes.len() - text.len() }),
            Err(_) if is_known(bytes) => Ok(raw),
            Err(fault) => Err(fault),
        }
    }

    /// What a reader makes of it; the places of its faults are those in the file.
    ///
    /// # Errors
    /// Those of the reader.
    pub fn read<T>(self, read: impl FnOnce(&'a [u8]) -> Result<T, Fault>) -> Result<T, Fault> {
        read(self.bytes).map_err(|fault| match fault.place {
            Place::Byte(byte) => Fault { place: Place::Byte(byte + self.mark), ..fault },
            Place::Line(_) | Place::PartLine { .. } => fault,
        })
    }
}

/// A text without a mark of byte order.
///
/// # Errors
/// It is UTF-16, of which no reader can tell more than that its first word is strange.
pub(crate) fn unmarked(bytes: &[u8]) -> Result<&[u8], Fault> {
    match order_of_16(bytes) {
        Some(order) => Err(Fault::new(
            Place::Byte(0),
            "the encoding of the text",
            format!("UTF-16, {order}"),
            "UTF-8 or ASCII: save the file anew with that encoding",
        )),
        None => Ok(bytes.strip_prefix(MARK).unwrap_or(bytes)),
    }
}

fn order_of_16(bytes: &[u8]) -> Option<&'static str> {
    let is_text = |byte: u8| byte.is_ascii_graphic() || byte.is_ascii_whitespace();
    let marked = MARKS_OF_16.iter().find(|(mark, _)| bytes.starts_with(mark));
    let body = if marked.is_some() { &bytes[2..] } else { bytes };
    let (pairs, _) = body.as_chunks::<2>();
    let first = pairs.get(..LETTERS)?;
    let is_of = |letter: usize| first.iter().all(|pair| is_text(pair[letter]) && pair[1 - letter] == 0);
    [0, 1].into_iter().find(|letter| is_of(*letter)).map(|letter| MARKS_OF_16[letter].1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encodings_are_told_apart() {
        let text = "solid thing\n facet normal 0 0 1\n";
        let of_16 = |order: fn(u16) -> [u8; 2], mark: &str| -> Vec<u8> {
            (mark.to_owned() + text).encode_utf16().flat_map(order).collect()
        };
        for mark in ["", "\u{feff}"] {
            for (order, name) in
                [(u16::to_le_bytes as fn(u16) -> [u8; 2], "little"), (u16::to_be_bytes, "big")]
            {
                let fault = unmarked(&of_16(order, mark)).unwrap_err().to_string();
                assert!(fault.contains(&format!("UTF-16, {name} endian; expected UTF-8")), "{fault}");
            }
            assert_eq!(unmarked((mark.to_owned() + text).as_bytes()).unwrap(), text.as_bytes());
        }
        // a binary header of zeros, or of nothing
        assert!(unmarked(&[0; 84]).is_ok() && unmarked(b"").is_ok() && unmarked(b"\xff\xfe").is_ok());
    }

    /// A binary file that begins as a mark does keeps it; places are counted in the file, the mark with it.
    #[test]
    fn binary_content_keeps_what_looks_like_a_mark() {
        let is_binary = |bytes: &[u8]| bytes.len() == 7;
        let fails = |_: &[u8]| Err::<(), _>(Fault::new(Place::Byte(2), "a number", "none", "one"));
        for (bytes, len, place) in
            [(b"\xef\xbb\xbfabcd".as_slice(), 7, 2), (b"\xef\xbb\xbfabcde", 5, 5), (b"abcde", 5, 2)]
        {
            let content = Content::of(bytes, is_binary).unwrap();
            assert_eq!(content.bytes.len(), len);
            assert_eq!(content.read(fails).unwrap_err().place, Place::Byte(place));
        }
        let of_16: Vec<u8> = "a text of sixteen".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert!(Content::of(&of_16, |_| false).is_err());
        assert_eq!(Content::of(&of_16, |bytes| bytes.len() == of_16.len()).unwrap().bytes, of_16);
    }
}
