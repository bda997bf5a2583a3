//! Paths of values in TOML texts, such as `bodies.bar.pins[0].axes` or `networks."a.b".visible`.

/// A step of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step<'a> {
    Key(&'a str),
    /// Of a list, from 0.
    Item(usize),
}

/// The steps of a path: keys between dots, in quotes those that are more than a word, and numbers of items in brackets; `None` where it is malformed.
pub fn steps(path: &str) -> Option<Vec<Step<'_>>> {
    let (mut steps, mut left) = (Vec::new(), path);
    loop {
        let key;
        (key, left) = first_key(left)?;
        steps.push(Step::Key(key));
        while let Some(item) = left.strip_prefix('[') {
            let (number, rest) = item.split_once(']')?;
            steps.push(Step::Item(number.parse().ok()?));
            left = rest;
        }
        if left.is_empty() {
            return Some(steps);
        }
        left = left.strip_prefix('.')?;
    }
}

/// The path and the value of a text `path = value`; an equals sign within quotes is of a key.
pub fn assignment(text: &str) -> Option<(&str, &str)> {
    let mut quote = None;
    let place = text.char_indices().find(|(_, character)| match (quote, character) {
        (None, '=') => true,
        (None, '"' | '\'') => {
            quote = Some(*character);
            false
        }
        (Some(open), _) => {
            if open == *character {
                quote = None;
            }
            false
        }
        _ => false,
    });
    place.map(|(at, sign)| (&text[..at], &text[at + sign.len_utf8()..]))
}

/// A key at the begin of a path, and what comes after it.
fn first_key(path: &str) -> Option<(&str, &str)> {
    for quote in ['"', '\''] {
        if let Some(quoted) = path.strip_prefix(quote) {
            return quoted.split_once(quote);
        }
    }
    let (key, rest) = path.split_at(path.find(['.', '[']).unwrap_or(path.len()));
    let is_one = !key.is_empty() && !key.contains(['"', '\'']);
    is_one.then_some((key, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is set is told from its value by the first equals sign that is not within quotes.
    #[test]
    fn assignments_are_split() {
        assert_eq!(assignment("a.b=c=d"), Some(("a.b", "c=d")));
        assert_eq!(assignment("a.\"x=y\".b = 2"), Some(("a.\"x=y\".b ", " 2")));
        assert_eq!(assignment("a.'\"='=\"2\""), Some(("a.'\"='", "\"2\"")));
        for none in ["", "a", "\"a=b", "é"] {
            assert_eq!(assignment(none), None, "{none}");
        }
    }

    /// Keys, keys in quotes and items of lists are told from each other; what is cut short or lacks a dot is no path.
    #[test]
    fn paths_are_split() {
        use Step::{Item, Key};
        assert_eq!(steps("a"), Some(vec![Key("a")]));
        assert_eq!(steps("plan.keys[2].probe"), Some(vec![Key("plan"), Key("keys"), Item(2), Key("probe")]));
        assert_eq!(
            steps("a.\"b.c[\"[0][11].'\"'"),
            Some(vec![Key("a"), Key("b.c["), Item(0), Item(11), Key("\"")])
        );
        for bad in ["", ".", "a.", "a..b", "a[", "a[x]", "a[0]b", "[0]", "\"a", "a\"b\"", "\"a\"b", "é\"["] {
            assert_eq!(steps(bad), None, "{bad}");
        }
    }
}
