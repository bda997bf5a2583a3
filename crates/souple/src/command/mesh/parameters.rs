//! `NAME=VALUE` on the command line, as values of an entry's parameters.

use souple_table::{Kind, Parameter, Value, Values};

use crate::command::{Refusal, did_you_mean};

/// Reads each text as the parameter it names; numbers may carry their unit. Names that are unknown stay in, for the
/// entry to refuse.
pub fn values(texts: &[String], known: &[&Parameter]) -> Result<Values, Refusal> {
    let mut values = Values::new();
    for text in texts {
        let refuse = |message: &str, expected: &str| {
            Refusal::request("parameter", text, expected, format!("`{text}`: {message}"))
        };
        let (key, value) = text.split_once('=').ok_or_else(|| refuse("there is no `=`", "NAME=VALUE"))?;
        if texts.iter().filter(|text| text.split_once('=').is_some_and(|(other, _)| other == key)).count() > 1
        {
            return Err(refuse("the name is given twice", "each name once"));
        }
        let parameter = known.iter().find(|parameter| parameter.name == key);
        let unit = parameter.map_or("", |parameter| parameter.unit);
        let number = |text: &str| match text.trim().parse() {
            Ok(number) => Ok(number),
            // SI where no unit is written
            Err(_) => souple_formal::quantity_in(text.trim(), unit),
        };
        let list = value.trim().trim_start_matches('[').trim_end_matches(']');
        let is_number = matches!(
            parameter.map(|parameter| parameter.kind),
            Some(Kind::Integer | Kind::Vector | Kind::Number | Kind::Numbers)
        );
        let numbers: Option<Vec<f64>> = if is_number {
            let numbers: Result<_, _> = list.split(',').map(number).collect();
            let expected = parameter.map_or_else(String::new, |parameter| parameter.expected());
            Some(numbers.map_err(|error: souple_formal::UnitError| refuse(&error.to_string(), &expected))?)
        } else {
            None
        };
        let value = match (parameter.map(|parameter| parameter.kind), numbers.as_deref()) {
            (Some(Kind::Integer), Some([number])) if number.fract() == 0.0 => Value::Integer(*number as i64),
            (Some(Kind::Vector), Some([x, y, z])) => Value::Vector([*x, *y, *z]),
            (Some(Kind::Number), Some([number])) => Value::Number(*number),
            (Some(Kind::Numbers), Some(numbers)) => Value::Numbers(numbers),
            _ => Value::Text(value),
        };
        values.set(key.to_owned(), value);
    }
    Ok(values)
}

/// Refuses names that are not known, the first of them.
pub fn refuse_unknown(values: &Values, known: &[&Parameter]) -> Result<(), Refusal> {
    let names = || known.iter().map(|parameter| parameter.name);
    let Some(name) = values.names().find(|name| !names().any(|known| known == *name)) else { return Ok(()) };
    let message = format!("there is no parameter `{name}`{}", did_you_mean(name, names()));
    let expected = format!("one of {}", names().collect::<Vec<_>>().join(", "));
    Err(Refusal::request("parameter", name, expected, message))
}

/// The values of some parameters, and those of all others.
pub fn split(values: Values, parameters: &[Parameter]) -> (Values, Values) {
    let (mut own, mut others) = (Values::new(), Values::new());
    let names: Vec<String> = values.names().map(str::to_owned).collect();
    for name in names {
        let Some(value) = values.get(&name) else { continue };
        let list =
            if parameters.iter().any(|parameter| parameter.name == name) { &mut own } else { &mut others };
        list.set(name, value);
    }
    (own, others)
}
