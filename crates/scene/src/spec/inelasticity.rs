//! Bodies whose rest shape gives way: creep, yielding and fracture.

use souple_models::solids::{Amount, Fracture, Inelasticity, Yielding};
use souple_table::{Range, Value};

use crate::diagnostic::{Code, Site};
use crate::keys::{Key, Keys, Shape};
use crate::reader::Reader;

pub(crate) static INELASTICITY: Keys = Keys::new(
    "inelasticity",
    "its rest shape gives way: what is strained goes over into it by creep or yielding, and its cells may tear",
    &[
        Key::number(
            "creep_time",
            "s",
            Range::POSITIVE,
            "in which elastic strain of shape falls to 1/e where the body is held: Maxwell's",
        ),
        Key::new("yielding", Shape::Table(&YIELDING), "strain goes over above a threshold of stress"),
        Key::new("fracture", Shape::Table(&FRACTURE), "cells lose their stiffness beyond a limit"),
    ],
);

pub(crate) static YIELDING: Keys = Keys::new(
    "yielding",
    "plasticity: where the equivalent stress of von Mises is above a threshold, strain goes over into the rest shape",
    &[
        Key::number("stress", "Pa", Range::POSITIVE, "the threshold").required(),
        Key::number("hardening", "Pa", Range::NOT_NEGATIVE, "how the threshold grows with what has yielded")
            .or(Value::Number(0.0)),
        Key::new(
            "amount",
            Shape::Choice(&["excess", "whole"]),
            "what goes over: the strain above the threshold, or all",
        )
        .or(Value::Text("excess")),
    ],
);

pub(crate) static FRACTURE: Keys = Keys::new(
    "fracture",
    "where cells tear: beyond a stress, a strain, or whichever comes first",
    &[
        Key::number("stress", "Pa", Range::POSITIVE, "greatest principal stress of Cauchy that a cell bears"),
        Key::number(
            "strain",
            "",
            Range::POSITIVE,
            "greatest principal stretch that a cell bears elastically, less one",
        ),
        Key::number(
            "scatter",
            "",
            Range::closed(0.0, 0.99),
            "by what part of themselves limits differ from cell to cell",
        )
        .or(Value::Number(0.0)),
        Key::integer("seed", Range::closed(0.0, 4_294_967_295.0), "of the scatter").or(Value::Integer(0)),
    ],
);

/// How the rest shape of a body gives way, as specified.
pub struct InelasticitySpec {
    pub rules: Inelasticity,
    pub site: Site,
}

impl InelasticitySpec {
    pub(crate) fn read(reader: &Reader) -> Self {
        let yielding = reader.table("yielding").map(|table| Yielding {
            stress: table.number("stress"),
            hardening: table.number("hardening"),
            amount: if table.choice("amount") == "whole" { Amount::Whole } else { Amount::Excess },
        });
        let fracture = reader.table("fracture").and_then(|table| fracture(&table));
        let rules = Inelasticity { creep_time: reader.maybe_number("creep_time"), yielding, fracture };
        let keys = ["creep_time", "yielding", "fracture"];
        if reader.written(&keys).is_empty() {
            let message = "nothing makes the rest shape give way";
            reader.log().add(
                Code::Conflict,
                &reader.site(),
                message,
                "`creep_time`, `yielding` or `fracture`",
            );
        }
        Self { rules, site: reader.site() }
    }
}

fn fracture(reader: &Reader) -> Option<Fracture> {
    let [stress, strain] = ["stress", "strain"].map(|name| reader.maybe_number(name));
    if stress.is_none() && strain.is_none() {
        let message = "there is no limit beyond which cells tear";
        reader.log().add(Code::Conflict, &reader.site(), message, "`stress`, `strain` or both");
        return None;
    }
    Some(Fracture {
        stress: stress.unwrap_or(f64::INFINITY),
        strain: strain.unwrap_or(f64::INFINITY),
        scatter: reader.number("scatter"),
        seed: reader.maybe_integer("seed").unwrap_or(0) as u64,
    })
}
