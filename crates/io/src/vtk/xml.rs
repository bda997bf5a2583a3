//! The elements of an XML document, as far as VTK uses XML.
//!
//! Raw data behind `<AppendedData>` is not XML and would stop any complete parser, so this one knows where to
//! stop. Elements lie in one list with their parents: a document of a million open elements is no recursion.

use crate::cursor::line_of;
use crate::error::{Fault, Place, quoted};

#[derive(Clone, Debug)]
pub(super) struct Element<'a> {
    pub name: &'a str,
    attributes: Vec<(&'a str, String)>,
    /// Number of the element around it.
    pub parent: Option<usize>,
    /// From the end of its tag to its first child or its end.
    pub text: &'a [u8],
    /// Of the tag in the file.
    pub position: usize,
    /// Of the text in the file.
    pub text_position: usize,
}

#[derive(Clone, Debug)]
pub(super) struct Document<'a> {
    bytes: &'a [u8],
    pub elements: Vec<Element<'a>>,
}

impl<'a> Document<'a> {
    /// Parses up to the end, or up to the first element called `last`, whose text is then all that follows.
    pub fn parse(bytes: &'a [u8], last: &str) -> Result<Self, Fault> {
        let mut document = Self { bytes, elements: Vec::new() };
        let mut open: Vec<usize> = Vec::new();
        let mut position = 0;
        while let Some(length) = bytes[position..].iter().position(|byte| *byte == b'<') {
            let start = position + length;
            document.close_text(start);
            let rest = &bytes[start..];
            if rest.starts_with(b"<!--") {
                position = document.after(start, b"-->", "-->")?;
            } else if rest.starts_with(b"<?") {
                position = document.after(start, b"?>", "?>")?;
            } else if rest.starts_with(b"<!") {
                return Err(document.fault(
                    start,
                    "a declaration",
                    quoted(&rest[..rest.len().min(20)]),
                    "elements only",
                ));
            } else if rest.starts_with(b"</") {
                position = document.after(start, b">", ">")?;
                let name = bytes[start + 2..position - 1].trim_ascii();
                let expected = match open.pop() {
                    Some(element) if document.elements[element].name.as_bytes() == name => continue,
                    Some(element) => format!("</{}>", document.elements[element].name),
                    None => "the end of the file".to_owned(),
                };
                return Err(document.fault(start, "the closing tag", quoted(name), expected));
            } else {
                position = document.open_tag(start, open.last().copied())?;
                let index = document.elements.len() - 1;
                if document.elements[index].name == last {
                    document.elements[index].text = &bytes[position..];
                    return Ok(document);
                }
                if bytes[position - 2] != b'/' {
                    open.push(index);
                }
            }
        }
        match open.last() {
            Some(element) => {
                let name = document.elements[*element].name;
                let place = Place::Line(line_of(bytes, bytes.len()));
                Err(Fault::cut_off(place, format!("the end of <{name}>"), format!("</{name}>")))
            }
            None => Ok(document),
        }
    }

    pub fn place(&self, position: usize) -> Place {
        Place::Line(line_of(self.bytes, position))
    }

    pub fn fault(
        &self,
        position: usize,
        subject: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Fault {
        Fault::new(self.place(position), subject, found, expected)
    }

    /// Elements of that name right within another.
    pub fn children<'b>(
        &'b self,
        parent: usize,
        name: &'b str,
    ) -> impl Iterator<Item = (usize, &'b Element<'a>)> {
        let elements = self.elements.iter().enumerate().skip(parent);
        elements.filter(move |(_, element)| element.parent == Some(parent) && element.name == name)
    }

    /// The first element of that name right within another.
    pub fn child(&self, parent: usize, name: &str) -> Result<usize, Fault> {
        match self.children(parent, name).next() {
            Some((index, _)) => Ok(index),
            None => {
                let around = &self.elements[parent];
                let subject = format!("<{name}> within <{}>", around.name);
                Err(self.fault(around.position, subject, "missing", format!("an element <{name}>")))
            }
        }
    }

    /// Position after the next `end`.
    fn after(&self, start: usize, end: &[u8], expected: &str) -> Result<usize, Fault> {
        let found = self.bytes[start..].windows(end.len()).position(|window| window == end);
        let place = || self.place(self.bytes.len());
        found.map(|length| start + length + end.len()).ok_or_else(|| {
            let subject = format!("the end of the tag of line {}", line_of(self.bytes, start));
            Fault::cut_off(place(), subject, expected)
        })
    }

    /// The text of the latest element ends where the next tag begins.
    fn close_text(&mut self, end: usize) {
        let bytes = self.bytes;
        if let Some(element) = self.elements.last_mut()
            && element.text.is_empty()
            && element.text_position < end
        {
            element.text = &bytes[element.text_position..end];
        }
    }

    /// Reads `<name key="value" …>` and returns the position behind it.
    fn open_tag(&mut self, start: usize, parent: Option<usize>) -> Result<usize, Fault> {
        let bytes = self.bytes;
        let end_of_word = |from: usize| {
            let stops = |byte: &u8| byte.is_ascii_whitespace() || matches!(byte, b'>' | b'/' | b'=');
            from + bytes[from..].iter().position(stops).unwrap_or(bytes.len() - from)
        };
        let skip_space =
            |from: usize| from + bytes[from..].iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        let cut_off = || Fault::cut_off(self.place(bytes.len()), "the end of a tag", ">");
        let word = |from: usize, to: usize, what: &str| {
            let word = std::str::from_utf8(&bytes[from..to]).ok().filter(|word| !word.is_empty());
            word.ok_or_else(|| {
                let found = quoted(&bytes[from..(to + 1).min(bytes.len())]);
                self.fault(from, what, found, "a name of letters and digits")
            })
        };

        let mut position = end_of_word(start + 1);
        let name = word(start + 1, position, "the name of an element")?;
        let mut attributes = Vec::new();
        loop {
            position = skip_space(position);
            match bytes.get(position) {
                None => return Err(cut_off()),
                Some(b'>') => break,
                Some(b'/') if bytes.get(position + 1) == Some(&b'>') => {
                    position += 1;
                    break;
                }
                Some(_) => {}
            }
            let key_end = end_of_word(position);
            let key = word(position, key_end, "the name of an attribute")?;
            position = skip_space(key_end);
            if bytes.get(position) != Some(&b'=') {
                return Err(self.fault(
                    position,
                    format!("the attribute `{key}`"),
                    "without a value",
                    "key=\"value\"",
                ));
            }
            position = skip_space(position + 1);
            let quote = match bytes.get(position) {
                Some(quote @ (b'"' | b'\'')) => *quote,
                _ => {
                    let subject = format!("the value of the attribute `{key}`");
                    return Err(self.fault(position, subject, "not in quotes", "key=\"value\""));
                }
            };
            let length = bytes[position + 1..].iter().position(|byte| *byte == quote).ok_or_else(cut_off)?;
            let raw = &bytes[position + 1..position + 1 + length];
            let value = std::str::from_utf8(raw).ok().and_then(unescape).ok_or_else(|| {
                let subject = format!("the value of the attribute `{key}`");
                self.fault(position, subject, quoted(raw), "text in UTF-8 with the entities of XML")
            })?;
            attributes.push((key, value));
            position += length + 2;
        }
        let text_position = position + 1;
        let element = Element { name, attributes, parent, text: &[], position: start, text_position };
        self.elements.push(element);
        Ok(text_position)
    }
}

impl Element<'_> {
    pub fn attribute(&self, key: &str) -> Option<&str> {
        self.attributes.iter().find(|attribute| attribute.0 == key).map(|attribute| attribute.1.as_str())
    }
}

/// Entities replaced; `None` for unknown ones.
fn unescape(text: &str) -> Option<String> {
    let mut pieces = text.split('&');
    let mut plain = pieces.next()?.to_owned();
    for piece in pieces {
        let (entity, rest) = piece.split_once(';')?;
        plain.push(match entity {
            "amp" => '&',
            "lt" => '<',
            "gt" => '>',
            "quot" => '"',
            "apos" => '\'',
            _ => {
                let digits = entity.strip_prefix('#')?;
                let code = match digits.strip_prefix('x') {
                    Some(digits) => u32::from_str_radix(digits, 16).ok()?,
                    None => digits.parse().ok()?,
                };
                char::from_u32(code)?
            }
        });
        plain.push_str(rest);
    }
    Some(plain)
}

/// Text fit for an attribute.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            letter if letter.is_control() => escaped.push_str(&format!("&#{};", letter as u32)),
            letter => escaped.push(letter),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_attributes_and_text() {
        let text =
            b"<?xml version=\"1.0\"?><!-- < --><A x='1 &amp; &#65;'>\n<B y = \"\"/>text\n<C>inner</C></A>";
        let document = Document::parse(text, "Last").unwrap();
        let names: Vec<_> = document.elements.iter().map(|element| (element.name, element.parent)).collect();
        assert_eq!(names, [("A", None), ("B", Some(0)), ("C", Some(0))]);
        assert_eq!(document.elements[0].attribute("x"), Some("1 & A"));
        assert_eq!(document.elements[1].attribute("y"), Some(""));
        assert_eq!(document.elements[2].text, b"inner");
        assert_eq!(document.child(0, "C").unwrap(), 2);
        assert_eq!(document.child(0, "D").unwrap_err().found, "missing");
        assert_eq!(unescape(&escape("a<\"&\n>")).unwrap(), "a<\"&\n>");
    }

    #[test]
    fn faults_are_told() {
        for bad in [
            "<A>",
            "<A></B>",
            "</A>",
            "<A x>",
            "<A x=1>",
            "<A x=\"1",
            "<A",
            "<>",
            "<!--",
            "<A x='&no;'/>",
            "< A/>",
        ] {
            assert!(Document::parse(bad.as_bytes(), "Last").is_err(), "{bad}");
        }
    }
}
