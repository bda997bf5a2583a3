//! Any series and parallel network of springs, dampers and sliders, written as text.

use std::cell::RefCell;

use souple_table::{Parameter, Value};

use crate::network::law::{LinkEntry, LinkError, Making, Moment, Reach, Response};
use crate::network::rheology::{self, Network};
use crate::network::written::{
    OneByOne, WRITTEN_MEMORY, WrittenLaw, constants, formula, number_in, refuse_unnamed,
};

/// `φ = -Q(q)` with `q = D - S`; remembers the deformations of dampers and sliders.
#[derive(Debug)]
struct Rheological {
    network: Network,
    /// `Te` [s].
    timestep: f64,
}

impl WrittenLaw for Rheological {
    fn memory_len(&self) -> usize {
        self.network.memory_len()
    }

    fn begin(&self, rest: f64, length: f64, memory: &mut [f64]) {
        self.network.rest_at(length - rest, memory);
    }

    fn is_conservative(&self) -> bool {
        self.network.memory_len() == 0
    }

    fn respond(&self, reach: &Reach, _: &Moment, memory: &mut [f64]) -> Response {
        let outcome = self.network.deform(reach.length - reach.rest, self.timestep, memory);
        Response { push: -outcome.effort, stored: outcome.account.stored, heat: outcome.account.heat }
    }

    fn slopes(&self, reach: &Reach, _: &Moment, memory: &[f64]) -> [f64; 2] {
        let mut numbers = [0.0; WRITTEN_MEMORY];
        numbers[..memory.len()].copy_from_slice(memory);
        let outcome = self.network.deform(reach.length - reach.rest, self.timestep, &mut numbers);
        [-outcome.slope, 0.0]
    }

    fn stiffest(&self, _: f64) -> f64 {
        self.network.stiffest(self.timestep)
    }
}

pub const ENTRY: LinkEntry = LinkEntry {
    name: "rheological",
    summary: "any network of springs, dampers and sliders: `-` puts in series, `|` in parallel",
    source: "Jimenez 1993, P2-V.3; solved exactly for each step instead of by recursions",
    parameters: &[
        Parameter::text(
            "network",
            "\"spring(1000) - (damper(100) | slider(5))\": spring(k), damper(z), slider(Q) or slider(Qt, Qc) with what it \
             holds in traction and in compression; `-` binds before `|`",
        ),
        Parameter::texts("parameters", "numbers that the network names").or(Value::Texts(&[])),
    ],
    build: |making| Ok(Box::new(OneByOne(read(making)?))),
};

fn read(making: &Making) -> Result<Rheological, LinkError> {
    let texts = making.values.texts("parameters");
    let (names, values) = constants(texts, 0, &[])?;
    // what is wrong with a parameter is shown there
    let wrong = RefCell::new(None);
    let named_in_text = RefCell::new(vec![false; names.len()]);
    let number = |text: &str, unit: &str| {
        // what stands for a parameter has the unit of that
        let named = texts.iter().position(|(name, _)| name == text);
        if let Some(at) = named {
            named_in_text.borrow_mut()[at] = true;
        }
        let named = named.map(|at| &texts[at]);
        let written = named.map_or(text, |(_, value)| value);
        let read = number_in(written, unit);
        if let (Some((name, _)), Some(Err(problem))) = (named, &read) {
            let what = format!("stands in `network`: {problem}");
            *wrong.borrow_mut() = Some(LinkError::text(format!("parameters.{name}"), what));
        }
        read.unwrap_or_else(|| match formula("network", text, &names) {
            Ok(formula) => {
                for (at, is_named) in named_in_text.borrow_mut().iter_mut().enumerate() {
                    *is_named |= formula.depends_on(at);
                }
                Ok(formula.evaluate(&values))
            }
            Err(LinkError::Formula { error, .. }) => Err(error.without_place()),
            Err(error) => Err(error.to_string()),
        })
    };
    let network = rheology::read(making.values.text("network"), &number).map_err(|error| {
        if let Some(wrong) = wrong.take() {
            return wrong;
        }
        let what = format!("cannot be built: {}", error.without_place());
        LinkError::Text { place: "network".to_owned(), what, part: error.span() }
    })?;
    refuse_unnamed(&names, "`network` names", |at| named_in_text.borrow()[at])?;
    Ok(Rheological { network, timestep: making.timestep })
}
