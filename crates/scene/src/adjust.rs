//! Values of a scene that may be set while it runs, as the tables describe them: what panels are made of.
//!
//! Each has the path that `--set` takes. What is not listed can be set too, as long as the world it makes has the same
//! unknowns and memories.

use std::collections::BTreeSet;

use souple_formal::Formula;
use souple_math::Vec3;
use souple_models::network::BuildLink;
use souple_table::{Kind, Parameter, Range, Value};

use crate::compile::constant_vector;
use crate::keys::{Key, Keys, Shape};
use crate::reader::Chosen;
use crate::spec::Spec;
use crate::spec::body::{BODY, Body, DAMPING};
use crate::spec::boundary::{LOAD, LoadKind, SPRING};
use crate::spec::contact::CONTACT;
use crate::spec::network::Network;
use crate::spec::world::WORLD;

/// A value that may be set.
#[derive(Clone, Debug, PartialEq)]
pub struct Adjustable {
    /// As `--set` names it.
    pub path: String,
    /// What it is of: `liver: stable_neo_hookean`.
    pub group: String,
    pub name: &'static str,
    pub summary: &'static str,
    pub unit: &'static str,
    pub kind: Kind,
    pub range: Range,
    /// As a scene file would write it, in SI units; `None`: left to the program.
    pub value: Option<String>,
}

impl Spec {
    /// What may be set while the scene runs.
    pub fn adjustables(&self) -> Vec<Adjustable> {
        let mut all = Vec::new();
        // without gravity there is no force to change
        if let Some(gravity) = self.world.gravity.as_ref().and_then(constant_vector) {
            all.extend(of_key(&WORLD, "gravity", "world", "world", Some(vector(gravity))));
        }
        for body in &self.bodies {
            all.extend(of_body(body));
        }
        for (index, contact) in self.contacts.iter().enumerate() {
            let (path, group) = (format!("contacts[{index}]"), format!("contact: {}", contact.name));
            let numbers = [
                ("stiffness", contact.stiffness),
                ("friction", Some(contact.friction)),
                ("damping", Some(contact.damping)),
            ];
            for (name, value) in numbers {
                all.extend(of_key(&CONTACT, name, &path, &group, value.map(number)));
            }
        }
        for system in &self.systems {
            if let Some(stepper) = &system.stepper {
                let group = format!("system {}: {}", system.name, stepper.entry.name);
                all.extend(of_chosen(stepper, &format!("systems.{}.stepper", system.name), &group));
            }
        }
        all
    }
}

fn of_body(body: &Body) -> Vec<Adjustable> {
    let mut all = Vec::new();
    let path = format!("bodies.{}", body.name);
    if let Some(material) = &body.material {
        let group = format!("{}: {}", body.name, material.entry.name);
        all.extend(of_chosen(material, &format!("{path}.material"), &group));
    }
    for region in &body.regions {
        if let Some(material) = &region.material {
            let group = format!("{}, {}: {}", body.name, region.name, material.entry.name);
            all.extend(of_chosen(material, &format!("{path}.regions.{}.material", region.name), &group));
        }
    }
    for (index, load) in body.loads.iter().enumerate() {
        all.extend(
            load.kind.as_ref().and_then(|kind| of_load(kind, &format!("{path}.loads[{index}]"), &body.name)),
        );
    }
    for (index, spring) in body.springs.iter().enumerate() {
        let (path, group) = (format!("{path}.springs[{index}]"), format!("{}: spring {index}", body.name));
        all.extend(of_key(&SPRING, "stiffness", &path, &group, Some(number(spring.stiffness))));
        all.extend(of_key(&SPRING, "damping", &path, &group, Some(number(spring.damping))));
    }
    // laws where they are written: of several tables of links that share one, once
    let mut seen = BTreeSet::new();
    for law in body.network.iter().flat_map(laws_of) {
        if seen.insert(law.site.path.clone()) {
            all.extend(of_chosen(law, &law.site.path, &format!("{}: {}", body.name, law.entry.name)));
        }
    }
    // damping that was not there before would be a force that the state has no memory of
    let group = format!("{}: damping", body.name);
    let damping = body.damping;
    let numbers = [
        (&DAMPING, "rayleigh_mass", format!("{path}.damping"), damping.rayleigh_mass),
        (&DAMPING, "rayleigh_stiffness", format!("{path}.damping"), damping.rayleigh_stiffness),
        (&DAMPING, "viscosity", format!("{path}.damping"), damping.viscosity),
        (&DAMPING, "neighbour_friction", format!("{path}.damping"), damping.neighbour_friction),
        (&BODY, "drag", path, body.drag),
    ];
    for (keys, name, path, value) in numbers {
        if value > 0.0 {
            let adjustable = of_key(keys, name, &path, &group, Some(number(value)));
            // nor may it go
            all.extend(adjustable.map(|adjustable| Adjustable { range: Range::POSITIVE, ..adjustable }));
        }
    }
    all
}

/// A load of numbers; formulas are not for panels.
fn of_load(kind: &LoadKind, path: &str, body: &str) -> Option<Adjustable> {
    let constant = |formula: &Formula| {
        let count = formula.variables().len();
        (!(0..count).any(|variable| formula.depends_on(variable)))
            .then(|| formula.evaluate(&vec![0.0; count]))
    };
    let (name, value) = match kind {
        LoadKind::Force(formulas, _) => ("force", vector(constant_vector(formulas)?)),
        LoadKind::Traction(formulas) => ("traction", vector(constant_vector(formulas)?)),
        LoadKind::BodyForce(formulas) => ("body_force", vector(constant_vector(formulas)?)),
        LoadKind::Pressure(formula) => ("pressure", number(constant(formula)?)),
    };
    of_key(&LOAD, name, path, &format!("{body}: load"), Some(value))
}

/// The laws of links and crowds.
fn laws_of(network: &Network) -> impl Iterator<Item = &Chosen<BuildLink>> {
    let of_crowds = network.crowds.iter().filter_map(|crowd| crowd.law.as_ref());
    network.links.iter().filter_map(|table| table.law.as_ref()).chain(of_crowds)
}

/// The parameters of a chosen thing that are numbers, choices and the like; formulas are not for panels.
fn of_chosen<B>(chosen: &Chosen<B>, path: &str, group: &str) -> Vec<Adjustable> {
    let shown = |parameter: &&Parameter| !matches!(parameter.kind, Kind::Text | Kind::Texts);
    let adjustable = |parameter: &Parameter| Adjustable {
        path: format!("{path}.{}", parameter.name),
        group: group.to_owned(),
        name: parameter.name,
        summary: parameter.summary,
        unit: parameter.unit,
        kind: parameter.kind,
        range: parameter.range,
        value: chosen.values.get(parameter.name).map(|value| value.to_string()),
    };
    chosen.entry.parameters.iter().filter(shown).map(adjustable).collect()
}

fn of_key(
    keys: &'static Keys,
    name: &str,
    path: &str,
    group: &str,
    value: Option<String>,
) -> Option<Adjustable> {
    let Key { name, summary, shape, unit, range, .. } = *keys.find(name)?;
    let kind = match shape {
        Shape::Vector | Shape::VectorFormula(_) => Kind::Vector,
        _ => Kind::Number,
    };
    let (path, group) = (format!("{path}.{name}"), group.to_owned());
    Some(Adjustable { path, group, name, summary, unit, kind, range, value })
}

fn number(value: f64) -> String {
    Value::Number(value).to_string()
}

fn vector(value: Vec3) -> String {
    Value::Vector(value.to_array()).to_string()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::{read_spec, read_text};

    const SCENE: &str = r#"
        format = 1
        [world]
        period = "10 ms"
        gravity = [0, -9.81, 0]
        [systems.main]
        stepper = "backward_euler"
        [bodies.bar]
        mesh = { generate = "bar", size = [1, 0.1, 0.1], cells = [4, 1, 1], element = "hex8" }
        material = { name = "neo_hookean", youngs_modulus = "10 MPa", poissons_ratio = 0.3, density = 1000 }
        damping = { rayleigh_mass = 1 }
        [bodies.bar.regions.end]
        region = { box = [[0.5, -1, -1], [2, 1, 1]] }
        material = { name = "linear", youngs_modulus = "1 MPa", poissons_ratio = 0.3, density = 1000 }
        [[bodies.bar.pins]]
        region = { box = [[-1e-9, -1, -1], [1e-9, 1, 1]] }
        [shapes.floor]
        shape = { name = "plane", point = [0, -1, 0], normal = [0, 1, 0] }
        [[contacts]]
        body = "bar"
        shape = "floor"
    "#;

    /// Every value can be set to itself by its path, and the scene is the same then.
    #[test]
    fn paths_are_those_of_settings() {
        let folder = Path::new(".");
        let adjustables = read_spec("bar", SCENE, folder, &[]).unwrap().adjustables();
        let paths: Vec<&str> = adjustables.iter().map(|adjustable| adjustable.path.as_str()).collect();
        for path in [
            "world.gravity",
            "bodies.bar.material.youngs_modulus",
            "bodies.bar.regions.end.material.density",
            "bodies.bar.damping.rayleigh_mass",
            "contacts[0].friction",
            "systems.main.stepper.newton",
        ] {
            assert!(paths.contains(&path), "{paths:?}");
        }
        assert!(!paths.contains(&"bodies.bar.damping.viscosity"), "there is none to change");
        for adjustable in &adjustables {
            let Some(value) = &adjustable.value else { continue };
            let setting = format!("{}={value}", adjustable.path);
            let again = read_spec("bar", SCENE, folder, std::slice::from_ref(&setting));
            let again = again.unwrap_or_else(|error| panic!("{setting}: {error}")).adjustables();
            assert_eq!(again, adjustables, "{setting}");
        }
        read_text("bar", SCENE, folder, &[]).unwrap();
    }
}
