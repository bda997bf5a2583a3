//! `souple derive --check`: derived expressions, tried.

use serde_json::json;
use souple_mesh::ElementKind;
use souple_models::associations::variants;
use souple_models::battery::{Battery, Trying};
use souple_models::materials::WRITTEN_LAWS;

use super::Arguments;
use crate::command::{End, Refusal, did_you_mean, print_json, print_line};

/// Differences by longer steps tell nothing of a cell of size one.
const LARGEST_STEP: f64 = 0.1;

fn within(
    name: &str,
    given: Option<f64>,
    is_fit: impl Fn(f64) -> bool,
    accepted: &str,
) -> Result<(), Refusal> {
    match given.filter(|number| !is_fit(*number)) {
        Some(number) => {
            let message = format!("`--{name} {number}` cannot be");
            Err(Refusal::request(name, number.to_string(), accepted, message))
        }
        None => Ok(()),
    }
}

/// Tries all that is named, one line for each, and prints the worst of all.
pub fn check(arguments: &Arguments) -> Result<End, Refusal> {
    let laws: Vec<&str> = WRITTEN_LAWS.iter().map(|law| law.name).collect();
    let kinds: Vec<&str> =
        ElementKind::ALL.iter().filter(|kind| kind.dimension() > 1).map(|kind| kind.name()).collect();
    if let Some(text) =
        arguments.law.as_deref().filter(|law| law.contains(|letter: char| !is_of_name(letter)))
    {
        let message = "`--check` tries laws by name; a text is tried against rotations and differences where it is read";
        return Err(Refusal::request("law", text, format!("one of {}", laws.join(", ")), message));
    }
    known("law", arguments.law.as_deref(), &laws)?;
    known("element", arguments.element.as_deref(), &kinds)?;
    let is_wanted =
        |wanted: &Option<String>, name: &str| wanted.as_deref().is_none_or(|wanted| wanted == name);
    within("step", arguments.step, |step| step > 0.0 && step <= LARGEST_STEP, "above 0, at most 0.1")?;
    within("fault", arguments.fault, f64::is_finite, "a finite number")?;
    let usual = Trying::default();
    let trying =
        Trying { step: arguments.step.unwrap_or(usual.step), fault: arguments.fault.unwrap_or(usual.fault) };
    let (mut worst, mut tried) = (Battery::default(), Vec::new());
    for law in WRITTEN_LAWS.iter().filter(|law| is_wanted(&arguments.law, law.name)) {
        for (kind, rule) in variants() {
            if !is_wanted(&arguments.element, kind.name()) || !is_wanted(&arguments.rule, rule.name) {
                continue;
            }
            let battery = Battery::of(law, kind, rule, trying)
                .map_err(|untried| Refusal::work("check", untried.to_string()))?;
            worst = worst.worse(battery);
            if arguments.json {
                let numbers: serde_json::Map<_, _> = battery
                    .named()
                    .map(|(name, number)| (name.to_owned(), json!(number)))
                    .into_iter()
                    .collect();
                tried.push(
                    json!({ "law": law.name, "element": kind.name(), "rule": rule.name, "off": numbers }),
                );
            } else {
                print_line(format_args!(
                    "{:22} {:10} {:9} {}",
                    law.name,
                    kind.name(),
                    rule.name,
                    line(&battery)
                ));
            }
        }
    }
    let numbers: serde_json::Map<_, _> =
        worst.named().map(|(name, number)| (name.to_owned(), json!(number))).into_iter().collect();
    if arguments.json {
        print_json(&json!({ "tried": tried, "worst": numbers }));
    } else {
        print_line(format_args!("{:43} {}", "worst", line(&worst)));
    }
    let holds = worst.named().iter().zip(Battery::BOUNDS.named()).all(|((_, off), (_, bound))| *off <= bound);
    if holds {
        return Ok(End::Done);
    }
    Err(Refusal::work(
        "check",
        format!("derived expressions are off by more than {}", line(&Battery::BOUNDS)),
    ))
}

fn line(battery: &Battery) -> String {
    let numbers = battery.named().map(|(name, number)| format!("{name} {number:.1e}"));
    numbers.join(", ")
}

fn is_of_name(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_'
}

fn known(what: &str, wanted: Option<&str>, names: &[&str]) -> Result<(), Refusal> {
    let Some(wanted) = wanted.filter(|wanted| !names.contains(wanted)) else { return Ok(()) };
    let message = format!("there is no {what} `{wanted}`{}", did_you_mean(wanted, names.iter().copied()));
    Err(Refusal::request(what, wanted, format!("one of {}", names.join(", ")), message))
}
