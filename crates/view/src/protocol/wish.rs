//! What a page may wish for.

use serde_json::Value;
use souple_math::Vec3;

use crate::dropped::DroppedFile;

/// A wish, as `{"do": "…", …}`.
#[derive(Clone, Debug, PartialEq)]
pub enum Wish {
    /// A frame has been drawn: another one may come.
    Seen,
    Play,
    Pause,
    /// One period, of a world that is paused.
    Step,
    Reset,
    /// Simulated seconds per second.
    Speed(f64),
    /// Loads a scene of the catalogue.
    Load(String),
    /// Loads a scene from its text, and keeps the mesh that was dropped for it.
    LoadText {
        name: String,
        text: String,
        mesh: Option<DroppedFile>,
    },
    /// Sets a value of the scene.
    Set {
        path: String,
        value: String,
    },
    /// Colours by the field of this name; by none.
    Colour(Option<String>),
    /// Shows vectors of this name as arrows; none.
    Arrows(Option<String>),
    /// The frame of a body whose weights `influence` shows to all pages.
    Influence {
        body: usize,
        frame: usize,
    },
    /// Whether the page looks inside bodies.
    Inside(bool),
    /// Takes hold of points of a body's surface.
    Grab {
        hand: u32,
        body: usize,
        points: Vec<u32>,
        strength: f64,
    },
    /// Presses on bodies with a tool of the table of tools.
    Touch {
        hand: u32,
        tool: String,
        /// [m]
        size: f64,
        /// [m]
        place: Vec3,
        /// From the bodies to whoever holds it.
        direction: Vec3,
        strength: f64,
    },
    /// Leads a hand this far from where it took hold [m].
    Move {
        hand: u32,
        offset: Vec3,
    },
    Release(u32),
    Pin {
        body: usize,
        points: Vec<u32>,
    },
    Unpin {
        body: usize,
        points: Vec<u32>,
    },
    /// Gives a whole body a velocity on top of its own [m/s].
    Throw {
        body: usize,
        velocity: Vec3,
    },
}

/// Hands that a page has.
pub const HANDS_MAX: u32 = 10;
/// Points that a wish may name.
const POINTS_MAX: usize = 4096;

impl Wish {
    /// What it is about, for refusals.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Seen => "seen",
            Self::Play => "play",
            Self::Pause => "pause",
            Self::Step => "step",
            Self::Reset => "reset",
            Self::Speed(_) => "speed",
            Self::Load(_) | Self::LoadText { .. } => "load",
            Self::Set { .. } => "set",
            Self::Colour(_) => "colour",
            Self::Arrows(_) => "arrows",
            Self::Influence { .. } => "influence",
            Self::Inside(_) => "inside",
            Self::Grab { .. } => "grab",
            Self::Touch { .. } => "touch",
            Self::Move { .. } => "move",
            Self::Release(_) => "release",
            Self::Pin { .. } => "pin",
            Self::Unpin { .. } => "unpin",
            Self::Throw { .. } => "throw",
        }
    }

    /// # Errors
    /// Says what is wrong and what would be right.
    pub fn parse(text: &str) -> Result<Self, String> {
        let wish: Value = serde_json::from_str(text).map_err(|error| format!("this is no wish: {error}"))?;
        let name = wish["do"].as_str().ok_or("a wish names what to do as text: {\"do\": \"play\"}")?;
        let read = Fields(&wish);
        Ok(match name {
            "seen" => Self::Seen,
            "play" => Self::Play,
            "pause" => Self::Pause,
            "step" => Self::Step,
            "reset" => Self::Reset,
            "speed" => Self::Speed(read.number("factor", 0.001, 100.0)?),
            "load" => Self::Load(read.text("scene")?),
            "load_text" => Self::LoadText { name: read.text("name")?, text: read.text("text")?, mesh: None },
            "set" => Self::Set { path: read.text("path")?, value: read.text("value")? },
            "colour" if wish["field"].is_null() => Self::Colour(None),
            "colour" => Self::Colour(Some(read.text("field")?)),
            "arrows" if wish["of"].is_null() => Self::Arrows(None),
            "arrows" => Self::Arrows(Some(read.text("of")?)),
            "inside" => Self::Inside(wish["is_shown"].as_bool().ok_or("`is_shown` must be true or false")?),
            "influence" => Self::Influence { body: read.index("body")?, frame: read.index("frame")? },
            "touch" => Self::Touch {
                hand: read.hand()?,
                tool: read.text("tool")?,
                size: read.number("size", 1e-9, 1e9)?,
                place: read.vector("place", FARTHEST)?,
                direction: read.vector("direction", FARTHEST)?,
                strength: read.number("strength", 0.0, 1e4)?,
            },
            "grab" => Self::Grab {
                hand: read.hand()?,
                body: read.index("body")?,
                points: read.points()?,
                strength: read.number("strength", 0.0, 1e4)?,
            },
            "move" => Self::Move { hand: read.hand()?, offset: read.vector("offset", FARTHEST)? },
            "release" => Self::Release(read.hand()?),
            "pin" => Self::Pin { body: read.index("body")?, points: read.points()? },
            "unpin" => Self::Unpin { body: read.index("body")?, points: read.points()? },
            "throw" => Self::Throw { body: read.index("body")?, velocity: read.vector("velocity", FASTEST)? },
            other => {
                return Err(format!("there is no wish `{}`", other.chars().take(40).collect::<String>()));
            }
        })
    }
}

/// How far off a hand may be led, in any direction [m]: a client may say more by mistake, and would end the world of all others.
const FARTHEST: f64 = 1e9;
/// How fast a body may be thrown, in any direction [m/s].
const FASTEST: f64 = 1e6;

/// The fields of a wish.
struct Fields<'a>(&'a Value);

impl Fields<'_> {
    fn text(&self, key: &str) -> Result<String, String> {
        self.0[key].as_str().map(str::to_owned).ok_or_else(|| format!("`{key}` must be a text"))
    }

    fn number(&self, key: &str, low: f64, high: f64) -> Result<f64, String> {
        let number = self.0[key].as_f64().filter(|number| (low..=high).contains(number));
        number.ok_or_else(|| format!("`{key}` must be a number from {low} to {high}"))
    }

    fn index(&self, key: &str) -> Result<usize, String> {
        let index = self.0[key].as_u64().and_then(|index| usize::try_from(index).ok());
        index.ok_or_else(|| format!("`{key}` must be a whole number of at least 0"))
    }

    fn hand(&self) -> Result<u32, String> {
        let hand = self.0["hand"].as_u64().filter(|hand| *hand < u64::from(HANDS_MAX));
        hand.map(|hand| hand as u32).ok_or_else(|| format!("`hand` must be a whole number below {HANDS_MAX}"))
    }

    fn vector(&self, key: &str, most: f64) -> Result<Vec3, String> {
        let wrong = || format!("`{key}` must be a list of three numbers from -{most:e} to {most:e}");
        let list = self.0[key].as_array().filter(|list| list.len() == 3).ok_or_else(wrong)?;
        let number = |i: usize| list[i].as_f64().filter(|number| number.abs() <= most).ok_or_else(wrong);
        Ok(Vec3::new(number(0)?, number(1)?, number(2)?))
    }

    fn points(&self) -> Result<Vec<u32>, String> {
        let wrong = || format!("`points` must be a list of 1 to {POINTS_MAX} numbers of points");
        let list = self.0["points"].as_array().filter(|list| (1..=POINTS_MAX).contains(&list.len()));
        let point =
            |value: &Value| value.as_u64().and_then(|point| u32::try_from(point).ok()).ok_or_else(wrong);
        let mut points = list.ok_or_else(wrong)?.iter().map(point).collect::<Result<Vec<u32>, String>>()?;
        points.sort_unstable();
        points.dedup();
        Ok(points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wishes_are_read() {
        let grab = r#"{"do": "grab", "hand": 1, "body": 0, "points": [4, 2, 4], "strength": 1}"#;
        let wish = Wish::Grab { hand: 1, body: 0, points: vec![2, 4], strength: 1.0 };
        assert_eq!(Wish::parse(grab), Ok(wish));
        assert_eq!(Wish::parse(r#"{"do": "colour", "field": null}"#), Ok(Wish::Colour(None)));
        let moved = Wish::parse(r#"{"do": "move", "hand": 9, "offset": [1, -2.5, 3e-3]}"#);
        assert_eq!(moved, Ok(Wish::Move { hand: 9, offset: Vec3::new(1.0, -2.5, 3e-3) }));
    }

    #[test]
    fn nonsense_is_refused_in_words() {
        for (text, wanted) in [
            ("", "this is no wish"),
            ("\u{0}\u{1}", "this is no wish"),
            ("[1, 2]", "names what to do"),
            (r#"{"do": "fly"}"#, "no wish `fly`"),
            (r#"{"do": "speed", "factor": 1e9}"#, "from 0.001 to 100"),
            (r#"{"do": "move", "hand": 10, "offset": [0, 0, 0]}"#, "`hand` must be"),
            (r#"{"do": "move", "hand": 1, "offset": [0, 0]}"#, "three numbers"),
            (r#"{"do": "move", "hand": 1, "offset": [0, 2e9, 0]}"#, "from -1e9 to 1e9"),
            (r#"{"do": "throw", "body": 0, "velocity": [2e6, 0, 0]}"#, "to 1e6"),
            (r#"{"do": "influence", "body": 0, "frame": 0.5}"#, "`frame` must be"),
            (r#"{"do": "pin", "body": -1, "points": [1]}"#, "`body` must be"),
            (r#"{"do": "pin", "body": 0, "points": []}"#, "`points` must be"),
        ] {
            let message = Wish::parse(text).unwrap_err();
            assert!(message.contains(wanted), "{text}: {message}");
        }
    }
}
