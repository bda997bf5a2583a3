//! What a law remembers, asked of its entry alone.

use souple_table::{Kind, Value, Values};

use super::law::{LinkEntry, Making};
use super::span::Span;

/// Numbers that a link of this law remembers: the dimension of its state. `None` where what a scene writes decides, as of
/// automata, formulas and rheological networks.
pub fn state_dimension(entry: &LinkEntry) -> Option<usize> {
    // pieces are one more than thresholds; points have as many lengths as forces
    [1, 2].into_iter().find_map(|first| dimension_with(entry, first))
}

/// With so many numbers in the first list, and two in others.
fn dimension_with(entry: &LinkEntry, first: usize) -> Option<usize> {
    let mut values = Values::new();
    let mut count = first;
    for (index, parameter) in entry.parameters.iter().enumerate() {
        match parameter.kind {
            // whatever is written as text decides
            Kind::Text | Kind::Texts => return None,
            _ if parameter.default.is_some() => {}
            // thresholds ascend as they are told
            Kind::Number => values.set(parameter.name, Value::Number(1.0 + index as f64)),
            Kind::Numbers => {
                values.set(parameter.name, Value::Numbers(&[1.0, 2.0][..count]));
                count = 2;
            }
            _ => return None,
        }
    }
    let values = entry.values(values).ok()?;
    Some(
        (entry.build)(&Making { values: &values, timestep: 1e-3, span: Span::Distance, driven: &[] })
            .ok()?
            .memory_len(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::LINKS;

    /// Laws without texts tell, as the source counts them.
    #[test]
    fn laws_tell_their_dimension() {
        for entry in LINKS.entries {
            let is_written = entry.parameters.iter().any(|p| matches!(p.kind, Kind::Text | Kind::Texts));
            assert_eq!(state_dimension(entry).is_none(), is_written, "{}", entry.name);
        }
        let of = |name: &str| state_dimension(LINKS.find(name).unwrap()).unwrap();
        assert_eq!([of("spring_damper"), of("ball"), of("cohesion"), of("piecewise_linear")], [0; 4]);
        assert!(of("maxwell") == 1 && of("burger") >= 3 && of("elasto_plastic") >= 3);
    }
}
