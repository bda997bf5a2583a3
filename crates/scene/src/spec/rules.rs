//! The rules of quadrature of a body: `quadrature` for all its kinds of elements, `rules` for single ones.

use souple_mesh::ElementKind;
use souple_models::solids::Quadrature;

use crate::diagnostic::Code;
use crate::keys::{Key, Shape};
use crate::reader::Reader;
use crate::values::Reading;

pub(crate) const RULES: Key = Key::new(
    "rules",
    Shape::Values,
    "rules of quadrature by kind of element, such as { pyramid5 = \"gauss_5\" }; `souple describe` names those of a kind",
);

/// The rule of every kind of element.
pub(crate) fn read(reader: &Reader) -> Quadrature {
    let all = if reader.choice("quadrature") == "full" { Quadrature::Full } else { Quadrature::Default };
    let Some(reading) = reader.reading(RULES.name) else { return all };
    let Some(table) = reading.node.as_table() else {
        let message = format!("this is {}", reading.node.content.kind());
        reading.refuse::<()>(Code::WrongType, message, "a table such as { pyramid5 = \"gauss_5\" }");
        return all;
    };
    table.entries.iter().fold(all, |quadrature, entry| {
        let path = format!("{}.{}", reading.path, entry.key);
        let value = Reading { node: &entry.node, path, log: reading.log };
        let chosen = chosen(&entry.key, &value);
        chosen.map_or(quadrature, |(kind, rule)| quadrature.with(kind, rule))
    })
}

/// A kind by its name, and the rule of it that a text names; what is unknown is reported.
fn chosen(name: &str, value: &Reading) -> Option<(ElementKind, &'static souple_mesh::QuadratureRule)> {
    let rule = value.text()?;
    let known = ElementKind::from_name(name).and_then(|kind| Ok((kind, kind.rule(rule)?)));
    known.map_or_else(
        |unknown| {
            let expected = format!("one of {}", unknown.known.join(", "));
            value.refuse(Code::UnknownName, unknown.to_string(), expected)
        },
        Some,
    )
}
