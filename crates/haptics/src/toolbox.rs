//! Shapes as tools in a hand that a person leads from place to place: with a mouse, say.
//!
//! A tool that is told how it is held is one as those of devices are: it hangs on a spring and a damper, gives way to what it meets, and
//! meets triangles. Any other is where it is led to, and meets points.

use souple_engine::{Force, HeldTool, Tool, Toolbox};
use souple_math::Vec3;
use souple_mesh::TriangleSurface;
use souple_models::contact::{
    ContactLaw, ContactPoint, SHAPES, Shape, ShapeContact, ToolContact, ToolSurface,
};
use souple_models::loads::RigidMotion;
use souple_table::{Value, Values};

use crate::carrier::{HandCarrier, Rest, Weight};
use crate::coupling::Coupling;
use crate::port::Port;

/// Every shape that needs no file is a tool.
#[derive(Clone, Copy, Debug)]
pub struct HandTools {
    /// Of the world [s].
    pub period: f64,
}

impl Toolbox for HandTools {
    fn make(&self, name: String, tool: &Tool) -> Result<Box<dyn Force>, String> {
        let shape = shape_of(tool)?;
        match &tool.held {
            Some(held) => self.held(name, tool, held, shape),
            None => led(name, tool, shape),
        }
    }
}

impl HandTools {
    fn held(
        &self,
        name: String,
        tool: &Tool,
        held: &HeldTool,
        shape: Box<dyn Shape>,
    ) -> Result<Box<dyn Force>, String> {
        let HeldTool { places, triangles, friction, mass, spring, damper, limit } = held;
        let surface = TriangleSurface {
            points: places.clone(),
            triangles: triangles.clone(),
            ..TriangleSurface::default()
        };
        let law = ContactLaw {
            stiffness: tool.stiffness,
            damping: 0.0,
            friction: *friction,
            tangential_stiffness: tool.stiffness,
            thickness: 0.0,
        };
        let coupling = Coupling { stiffness: *spring, damping: *damper, limit: *limit };
        let port = Port { coupling, passive: true };
        let rest = Rest { port, mass: *mass, period: self.period, is_held: false, weight: Weight::Felt };
        let carrier = Box::new(HandCarrier::new(rest, None).starting_at(tool.place));
        let reach = surface.mean_edge();
        let touched = ToolSurface { surface, rows: tool.rows.clone() };
        let contact = ToolContact::carried(name, touched, shape, carrier, law, [reach, self.period]);
        Ok(Box::new(contact.map_err(|error| error.to_string())?))
    }
}

fn shape_of(tool: &Tool) -> Result<Box<dyn Shape>, String> {
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
    (entry.build)(&values, &no_file).map_err(|error| error.to_string())
}

fn led(name: String, tool: &Tool, shape: Box<dyn Shape>) -> Result<Box<dyn Force>, String> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn tool(shape: &str, held: Option<HeldTool>) -> Tool {
        let values = vec![("radius".to_owned(), vec![0.1])];
        let (place, stiffness) = (Vec3::Y, 100.0);
        Tool { shape: shape.to_owned(), values, place, stiffness, rows: vec![0, 1, 2], held }
    }

    fn held() -> HeldTool {
        HeldTool {
            places: vec![Vec3::ZERO, Vec3::X, Vec3::Z],
            triangles: vec![[0, 1, 2]],
            friction: 0.3,
            mass: 0.03,
            spring: 300.0,
            damper: 6.0,
            limit: 10.0,
        }
    }

    /// A tool on a spring is in a hand, and meets what comes and goes; one that is led is not, and meets its rows. What cannot be is said.
    #[test]
    fn tools_are_made() {
        let tools = HandTools { period: 0.01 };
        let led = tools.make("hand[0]".to_owned(), &tool("sphere", None)).unwrap();
        assert!(!led.declaration().changing_pattern && led.name() == "hand[0]");
        let on_spring = tools.make("hand[0]".to_owned(), &tool("sphere", Some(held()))).unwrap();
        assert!(on_spring.declaration().changing_pattern && on_spring.memory_len() > 1);
        let refused = |tool: &Tool| tools.make("hand[0]".to_owned(), tool).err().unwrap_or_default();
        assert!(refused(&tool("spoon", None)).contains("spoon"));
        assert!(
            refused(&tool("sphere", Some(HeldTool { triangles: Vec::new(), ..held() }))).contains("triangle")
        );
        let angular = Tool { values: vec![("size".to_owned(), vec![0.1; 3])], ..tool("box", Some(held())) };
        assert!(refused(&angular).contains("rounded part"), "{}", refused(&angular));
    }
}
