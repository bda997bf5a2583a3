//! Materials whose numbers differ from cell to cell: formulas of the place, or numbers of a file.

use std::collections::BTreeMap;

use souple_models::materials::Material;
use souple_table::{Kind, Parameter, Value};

use super::Draft;
use super::bodies::{BodyMaterials, Placed};
use crate::diagnostic::Code;
use crate::keys::did_you_mean;
use crate::spec::body::{FieldValues, MaterialField};

/// More materials than this are not told apart.
const MOST: usize = u16::MAX as usize + 1;

/// The body's own material in each cell that no region has taken, with the numbers that fields tell there; `None` where they were
/// refused.
pub fn spread(draft: &Draft, body: &Placed, materials: BodyMaterials) -> Option<BodyMaterials> {
    if body.spec.material_fields.is_empty() {
        return Some(materials);
    }
    let main = body.spec.material.as_ref()?;
    let mut columns = Vec::new();
    for field in &body.spec.material_fields {
        let is_number =
            |parameter: &&Parameter| parameter.name == field.parameter && parameter.kind == Kind::Number;
        let Some(parameter) = main.entry.parameters.iter().find(is_number) else {
            let numbers = main.entry.parameters.iter().filter(|parameter| parameter.kind == Kind::Number);
            let known: Vec<&str> = numbers.map(|parameter| parameter.name).collect();
            let hint = did_you_mean(&field.parameter, known.iter().copied());
            let message =
                format!("`{}` is no number of the material `{}`{hint}", field.parameter, main.entry.name);
            let law = materials.all.first().and_then(Material::text_runs_as);
            let by_name = law.map_or_else(String::new, |law| {
                format!("; or the law by its name, `{law}`, which this text is, with its numbers")
            });
            draft.log.add(Code::UnknownName, &field.site, message, known.join(", ") + &by_name);
            return None;
        };
        columns.push((parameter, values(draft, body, field, parameter)?));
    }
    let BodyMaterials { mut all, mut of_cell } = materials;
    // by the bits of their numbers: cells with the same numbers share a material
    let mut known: BTreeMap<Vec<u64>, u16> = BTreeMap::new();
    for cell in 0..of_cell.len() {
        // regions have materials of their own
        if of_cell[cell] != 0 {
            continue;
        }
        let numbers: Vec<f64> = columns.iter().map(|(_, values)| values[cell]).collect();
        let key: Vec<u64> = numbers.iter().map(|number| number.to_bits()).collect();
        if let Some(number) = known.get(&key) {
            of_cell[cell] = *number;
            continue;
        }
        let mut values = main.values.clone();
        for ((parameter, _), number) in columns.iter().zip(&numbers) {
            values.set(parameter.name, Value::Number(*number));
        }
        let site = &body.spec.material_fields[0].site;
        let material = match (main.entry.build)(&values) {
            Ok(material) => material,
            Err(error) => {
                let message = format!("cell {cell} of body `{}`: {error}", body.spec.name);
                draft.log.add(Code::OutOfRange, site, message, "numbers that are a material together");
                return None;
            }
        };
        if all.len() >= MOST {
            let message = format!("body `{}` has more than {MOST} materials", body.spec.name);
            draft.log.add(Code::TooLarge, site, message, "fields of fewer values");
            return None;
        }
        let number = all.len() as u16;
        all.push(material);
        known.insert(key, number);
        of_cell[cell] = number;
    }
    Some(BodyMaterials { all, of_cell })
}

/// The values of a field in all cells; `None` where one is missing or out of range, which is reported.
fn values(draft: &Draft, body: &Placed, field: &MaterialField, parameter: &Parameter) -> Option<Vec<f64>> {
    let count = body.mesh.cell_count();
    let values = match &field.values {
        FieldValues::Formula(formula) => {
            let at = |middle: souple_math::Vec3| formula.evaluate(&middle.to_array());
            body.mesh.cell_centres().into_iter().map(at).collect()
        }
        FieldValues::File { name, site } => {
            let refuse = |message: String, expected: String| {
                draft.log.add(Code::Unreadable, site, message, expected);
                None
            };
            let expected = || format!("a text file with {count} numbers, one for each cell of the body");
            let read = draft.sources.open(site.place.source, name).and_then(std::fs::read_to_string);
            let text = match read {
                Ok(text) => text,
                Err(error) => return refuse(format!("`{name}` cannot be read: {error}"), expected()),
            };
            let mut numbers = Vec::new();
            for (line, word) in text
                .lines()
                .enumerate()
                .flat_map(|(line, text)| text.split_whitespace().map(move |word| (line, word)))
            {
                match word.parse::<f64>() {
                    Ok(number) => numbers.push(number),
                    Err(_) => {
                        return refuse(
                            format!("line {} of `{name}`: `{word}` is no number", line + 1),
                            expected(),
                        );
                    }
                }
            }
            if numbers.len() != count {
                let message = format!("`{name}` has {} numbers", numbers.len());
                return refuse(message, expected());
            }
            numbers
        }
    };
    let unfit = values.iter().position(|value: &f64| !parameter.range.contains(*value));
    if let Some(cell) = unfit {
        let message = format!("`{}` of cell {cell} is {}", parameter.name, values[cell]);
        draft.log.add(Code::OutOfRange, &field.site, message, parameter.range.describe());
        return None;
    }
    Some(values)
}
