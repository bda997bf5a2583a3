//! The texture of a body's surface.

use souple_io::picture::{Colour, PATTERNS, Pattern};
use souple_table::Range;

use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

/// Names of [`PATTERNS`], in their order.
static NAMES: [&str; 3] = ["mottled", "spots", "fibres"];

pub(crate) static TEXTURE: Keys = Keys::new(
    "texture",
    "colours that stick to the matter of a body: a picture, or a pattern of tissue",
    &[
        Key::new(
            "file",
            Shape::Text,
            "a PNG, relative to the scene file that names it, laid on along the axes",
        ),
        Key::new("pattern", Shape::Choice(&NAMES), "made of noise, in the place of a file"),
        Key::new("colours", Shape::Texts, "the two colours of a pattern, as `#96342e`"),
        Key::number(
            "size",
            "m",
            Range::POSITIVE,
            "after which a picture repeats itself; of the parts of a pattern",
        )
        .required(),
    ],
);

/// A texture as specified.
pub struct TextureSpec {
    pub figure: FigureSpec,
    /// [m]
    pub size: f64,
}

/// What a texture shows, as specified.
pub enum FigureSpec {
    File { file: String, site: Site },
    Pattern(Pattern, [Colour; 2]),
}

/// The colours of an organ, where a pattern tells none: dark and pale.
const ORGAN: [[u8; 3]; 2] = [[128, 38, 34], [176, 78, 66]];

impl TextureSpec {
    /// `None` where it was refused.
    pub(crate) fn read(reader: &Reader) -> Option<Self> {
        let refuse = |site: Site, message: &str, expected: &str| {
            reader.log().add(Code::Conflict, &site, message, expected);
            None
        };
        let size = reader.number("size");
        let (file, pattern) =
            (reader.maybe_text("file"), reader.has("pattern").then(|| reader.choice("pattern")));
        let figure = match (file, pattern) {
            (Some(file), None) if !reader.has("colours") => {
                FigureSpec::File { file, site: reader.site_of("file") }
            }
            (Some(_), None) => {
                return refuse(reader.site_of("colours"), "a picture has colours of its own", "no `colours`");
            }
            (None, Some(name)) => {
                let pattern = PATTERNS.entries.iter().find(|entry| entry.name == name)?.build;
                FigureSpec::Pattern(pattern, colours(reader)?)
            }
            (Some(_), Some(_)) => {
                let message = "`file` and `pattern` both say what the texture is";
                return refuse(reader.site_of("pattern"), message, "`file` or `pattern` alone");
            }
            (None, None) => {
                return refuse(reader.site(), "a texture is a picture or a pattern", "`file` or `pattern`");
            }
        };
        Some(Self { figure, size })
    }
}

/// The two colours of a pattern; `None` where they were refused.
fn colours(reader: &Reader) -> Option<[Colour; 2]> {
    if !reader.has("colours") {
        return Some(ORGAN.map(Colour::from_screen));
    }
    let told = reader.texts("colours");
    let read: Option<Vec<Colour>> = told.iter().map(|text| colour(text)).collect();
    match read.as_deref() {
        Some([first, second]) => Some([*first, *second]),
        _ => {
            let message = format!("`colours` is {told:?}");
            let expected = "two colours of six hexadecimal digits each, as [\"#96342e\", \"#c07060\"]";
            reader.log().add(Code::Conflict, &reader.site_of("colours"), message, expected);
            None
        }
    }
}

/// `#rrggbb`.
fn colour(text: &str) -> Option<Colour> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6)?;
    digits.bytes().all(|byte| byte.is_ascii_hexdigit()).then_some(())?;
    let part = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).ok();
    Some(Colour::from_screen([part(0)?, part(2)?, part(4)?]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Scenes know the patterns of the table, by its names.
    #[test]
    fn patterns_are_those_of_the_table() {
        assert_eq!(PATTERNS.entries.iter().map(|entry| entry.name).collect::<Vec<_>>(), NAMES);
    }

    #[test]
    fn colours_are_six_digits() {
        assert_eq!(colour("#ff0080"), Some(Colour::from_screen([255, 0, 128])));
        for bad in ["ff0080", "#ff008", "#ff00801", "#gg0080", "#+f+f+f", "#äöü"] {
            assert_eq!(colour(bad), None, "{bad}");
        }
    }
}
