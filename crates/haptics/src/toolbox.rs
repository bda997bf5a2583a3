//! Shapes as tools in a hand that a person leads from place to place: with a mouse, say.
//!
//! A tool that is told how it is held is one as those of devices are: it hangs on a spring and a damper, gives way to what it meets, and
//! meets triangles. Any other is where it is led to, and meets points.

use souple_engine::{Force, HeldTool, Tool, Toolbox};
use souple_math::Vec3;
use souple_mesh::{OpeningSurface, Span, TriangleSurface};
use souple_models::contact::{
    ContactLaw, ContactPoint, SHAPES, Shape, ShapeContact, Shares, ToolContact, ToolSurface,
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
        let HeldTool { places, triangles, spans, friction, mass, spring, damper, limit } = held;
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
        let surface = OpeningSurface { surface, spans: spans.iter().map(span).collect() };
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

fn span([from, until]: &[f64; 2]) -> Span {
    Span { from: *from, until: *until }
}

/// Shares of points that count alike while they are on their surface, from each date on at which one comes or goes.
fn shares(spans: &[Span]) -> Vec<Shares> {
    let mut dates: Vec<f64> = spans.iter().flat_map(|span| [span.from, span.until]).collect();
    dates.retain(|date| date.is_finite());
    dates.sort_unstable_by(f64::total_cmp);
    dates.dedup();
    let share = |span: &Span, time: f64| f64::from(u8::from(span.holds(time)));
    let from =
        |time: f64| Shares { from: time, of_points: spans.iter().map(|span| share(span, time)).collect() };
    dates.into_iter().map(from).collect()
}

fn led(name: String, tool: &Tool, shape: Box<dyn Shape>) -> Result<Box<dyn Force>, String> {
    let spans: Vec<Span> = tool.spans.iter().map(span).collect();
    let is_first = |point: usize| spans.get(point).is_none_or(|span| span.from == f64::NEG_INFINITY);
    // without friction nothing depends on where points start
    let point = |(index, row): (usize, &u32)| ContactPoint {
        row: *row,
        share: f64::from(u8::from(is_first(index))),
        start: Vec3::ZERO,
    };
    let points = tool.rows.iter().enumerate().map(point).collect();
    let law = ContactLaw {
        stiffness: tool.stiffness,
        damping: 0.0,
        friction: 0.0,
        tangential_stiffness: 0.0,
        thickness: 0.0,
    };
    let contact = ShapeContact::new(name, points, shape, RigidMotion::at(tool.place), law)
        .and_then(|contact| contact.opening(shares(&spans)));
    Ok(Box::new(contact.map_err(|error| error.to_string())?))
}

#[cfg(test)]
mod tests {
    use souple_engine::{Configuration, KeptRef};

    use super::*;

    fn tool(shape: &str, held: Option<HeldTool>) -> Tool {
        let values = vec![("radius".to_owned(), vec![0.1])];
        let (place, stiffness) = (Vec3::Y, 100.0);
        Tool {
            shape: shape.to_owned(),
            values,
            place,
            stiffness,
            rows: vec![0, 1, 2],
            spans: Vec::new(),
            held,
        }
    }

    fn held() -> HeldTool {
        HeldTool {
            places: vec![Vec3::ZERO, Vec3::X, Vec3::Z],
            triangles: vec![[0, 1, 2]],
            spans: Vec::new(),
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

    /// Rows are met while they are on a surface: the first until 1 s, the second from then on, the third always.
    #[test]
    fn rows_are_met_while_they_are_there() {
        let spans = vec![[f64::NEG_INFINITY, 1.0], [1.0, f64::INFINITY], [f64::NEG_INFINITY, f64::INFINITY]];
        let tool = Tool { place: Vec3::ZERO, spans, ..tool("sphere", None) };
        let force = HandTools { period: 0.01 }.make("hand[0]".to_owned(), &tool).unwrap();
        let mut memory = vec![0.0; force.memory_len()];
        force.initial_memory(&mut memory);
        let positions = [Vec3::X * 0.05, Vec3::Y * 0.05, Vec3::Z * 0.05];
        for (time, met) in [(0.5, [true, false, true]), (1.0, [false, true, true])] {
            let at = Configuration {
                positions: &positions,
                velocities: &[Vec3::ZERO; 3],
                time,
                load: 1.0,
                memory: &memory,
                pairs: &[],
                kept: KeptRef::default(),
                driven: &[],
                fields: &[],
            };
            let mut out = [Vec3::ZERO; 3];
            force.add_force(&at, &mut force.new_scratch(), &mut out);
            assert_eq!(out.map(|force| force != Vec3::ZERO), met, "{time} s");
            let mut rows = Vec::new();
            force.visit_contacts(&at, &mut |point| rows.push(point.row));
            assert_eq!(rows.len(), 2);
        }
    }
}
