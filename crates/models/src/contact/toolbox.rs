//! Shapes as tools in a hand: smooth, and led from place to place.

use souple_engine::{Force, Tool, Toolbox};
use souple_math::Vec3;
use souple_table::{Value, Values};

use super::{ContactLaw, ContactPoint, SHAPES, ShapeContact};
use crate::loads::RigidMotion;

/// Every shape that needs no file is a tool.
pub struct ShapeToolbox;

impl Toolbox for ShapeToolbox {
    fn make(&self, name: String, tool: &Tool) -> Result<Box<dyn Force>, String> {
        let entry = SHAPES.find(&tool.shape).map_err(|error| error.to_string())?;
        let mut values = Values::new();
        for (name, numbers) in &tool.values {
            let value = match numbers[..] {
                [number] => Value::Number(number),
                [x, y, z] => Value::Vector([x, y, z]),
                _ => return Err(format!("`{name}` is {numbers:?}, but must be a number or a vector")),
            };
            values.set(name.clone(), value);
        }
        let values = entry.values(values).map_err(|error| error.to_string())?;
        let no_file = |surface: &str| Err(format!("`{surface}` is a file, which a tool has not"));
        let shape = (entry.build)(&values, &no_file).map_err(|error| error.to_string())?;
        // without friction nothing depends on where points start
        let point = |row: &u32| ContactPoint { row: *row, share: 1.0, start: Vec3::ZERO };
        let points = tool.rows.iter().map(point).collect();
        let law = ContactLaw {
            stiffness: tool.stiffness,
            damping: 0.0,
            friction: 0.0,
            tangential_stiffness: 0.0,
            thickness: 0.0,
        };
        let contact = ShapeContact::new(name, points, shape, RigidMotion::at(tool.place), law);
        Ok(Box::new(contact.map_err(|error| error.to_string())?))
    }
}
