//! What is told of a mesh or a surface, in sentences: the same as in the JSON document, without its brackets.

use serde_json::Value as Json;
use souple_table::{counted, four_digits, in_number, readable};

/// Lines for people of a document of `souple mesh`; `name` is the file's.
pub fn sentences(name: &str, document: &Json) -> Vec<String> {
    let mut lines = vec![format!("{name}: {}", contents(document))];
    let mut say = |what: &str, text: String| {
        if !text.is_empty() {
            lines.push(format!("  {what:9}{text}"));
        }
    };
    say("groups", names(&document["groups"]));
    say("bounds", bounds(&document["bounds"]));
    if document["area"].is_number() {
        say("area", format!("{} m²", number(&document["area"])));
        let enclosed = &document["enclosed_volume"];
        let closed = if enclosed.is_number() {
            format!("encloses {} m³", number(enclosed))
        } else {
            "is not closed".to_owned()
        };
        say("surface", closed);
        say(
            "angles",
            format!(
                "{} to {} degrees",
                number(&document["smallest_angle_degrees"]),
                number(&document["largest_angle_degrees"])
            ),
        );
    } else {
        say("volume", volume(document));
        say("quality", quality(document));
    }
    lines.extend(document["problem"].as_str().map(|problem| format!("  problem  {problem}")));
    let repairs = &document["repairs"];
    for (what, list) in [
        ("mended", &repairs["messages"]),
        ("fault", &document["faults"]["messages"]),
        ("left", &repairs["left"]["messages"]),
        ("note", &document["notes"]),
    ] {
        lines.extend(texts(list).map(|text| format!("  {what:9}{text}")));
    }
    lines
}

/// `20 points, 24 tet4 in one part`.
fn contents(document: &Json) -> String {
    let mut parts = vec![counted(document["points"].as_u64().unwrap_or(0), "point")];
    let cells = document["cells"].as_object().into_iter().flatten();
    parts.extend(cells.map(|(kind, count)| format!("{count} {kind}")));
    if let Some(facets @ 1..) = document["facets"].as_u64() {
        parts.push(counted(facets, "facet"));
    }
    let components = document["components"].as_u64().or(document["faults"]["components"].as_u64());
    let in_parts = match components {
        Some(1) => " in one part".to_owned(),
        Some(several @ 2..) => format!(" in {several} parts"),
        _ => String::new(),
    };
    parts.join(", ") + &in_parts
}

/// Of several kinds of cells the share of each.
fn volume(document: &Json) -> String {
    let whole = document["volume"].as_f64().unwrap_or_default();
    let kinds: Vec<String> = document["volume_of_kinds"]
        .as_object()
        .into_iter()
        .flatten()
        .map(|(kind, volume)| format!("{:.1} % {kind}", 100.0 * volume.as_f64().unwrap_or_default() / whole))
        .collect();
    let shares =
        if kinds.len() > 1 && whole > 0.0 { format!(": {}", kinds.join(", ")) } else { String::new() };
    format!("{} m³{shares}", number(&document["volume"]))
}

fn quality(document: &Json) -> String {
    let quality = &document["quality"];
    if quality.is_null() {
        return String::new();
    }
    let inverted = match quality["inverted_cells"].as_u64() {
        Some(count @ 1..) => {
            format!("{}; ", in_number(count as usize, "cell is inverted", "cells are inverted"))
        }
        _ => String::new(),
    };
    format!(
        "{inverted}scaled Jacobian at least {}, dihedral angles {} to {} degrees, aspect ratio {} on average, {} at worst",
        number(&document["smallest_scaled_jacobian"]),
        number(&quality["dihedral_degrees"]["min"]),
        number(&quality["dihedral_degrees"]["max"]),
        number(&quality["aspect_ratio"]["mean"]),
        number(&quality["aspect_ratio"]["worst"]),
    )
}

fn bounds(corners: &Json) -> String {
    let coordinate = |corner: usize, axis: usize| corners[corner][axis].as_f64();
    let corner = |index: usize| {
        let numbers = (0..3).map(|axis| {
            let both = coordinate(0, axis).zip(coordinate(1, axis));
            let extent = both.map_or(0.0, |(low, high)| high - low);
            coordinate(index, axis).map_or_else(|| "—".to_owned(), |number| four_digits_of(number, extent))
        });
        numbers.collect::<Vec<_>>().join(", ")
    };
    format!("({}) to ({}) m", corner(0), corner(1))
}

/// A number to four digits of itself, and of an extent that it is an end of: far from the origin too it is seen how large that is.
fn four_digits_of(number: f64, extent: f64) -> String {
    if !(extent > 0.0 && extent < number.abs()) {
        return four_digits(number);
    }
    let exponent = |number: f64| format!("{number:e}").rsplit('e').next().and_then(|e| e.parse::<i64>().ok());
    let digits = exponent(number).zip(exponent(extent)).map_or(3, |(own, other)| own - other + 3);
    let rounded = format!("{number:.*e}", digits.clamp(3, 16) as usize).parse().unwrap_or(number);
    readable(rounded)
}

fn number(value: &Json) -> String {
    value.as_f64().map_or_else(|| "—".to_owned(), four_digits)
}

fn names(list: &Json) -> String {
    texts(list).collect::<Vec<_>>().join(", ")
}

fn texts(list: &Json) -> impl Iterator<Item = &str> {
    list.as_array().into_iter().flatten().filter_map(Json::as_str)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn meshes_are_told_in_words() {
        let document = json!({
            "points": 20, "cells": {"tet4": 24}, "facets": 0, "groups": ["x_max", "x_min"], "components": 1,
            "volume": 0.009_999_999_999_998, "bounds": [[0.0, 0.0, 0.0], [1.0, 0.1, 1e-7]],
            "smallest_scaled_jacobian": null, "problem": null, "notes": ["a note"],
        });
        assert_eq!(
            sentences("bar.msh", &document),
            [
                "bar.msh: 20 points, 24 tet4 in one part",
                "  groups   x_max, x_min",
                "  bounds   (0, 0, 0) to (1, 0.1, 1e-7) m",
                "  volume   0.01 m³",
                "  note     a note",
            ]
        );
        let far = json!([[1e6, -0.123_456, 0.0], [1_000_002.345_67, 0.5, 0.0]]);
        assert_eq!(bounds(&far), "(1000000, -0.1235, 0) to (1000002.346, 0.5, 0) m");
    }
}
