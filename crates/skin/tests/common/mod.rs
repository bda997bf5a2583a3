//! Skins, their terms and the parts of their targets, as tests write them.

use souple_math::Vec3;
use souple_skin::strategy::{TERMS, Term};
use souple_skin::target::{PARTS, Part, Surroundings};
use souple_skin::{Lattice, Skin};
use souple_table::{Value, Values};

pub fn term(name: &str, values: &[(&'static str, Value<'static>)]) -> Box<dyn Term> {
    let entry = TERMS.find(name).unwrap();
    let mut given = Values::new();
    for (name, value) in values {
        given.set((*name).to_owned(), *value);
    }
    (entry.build)(&entry.values(given).unwrap()).unwrap()
}

pub fn number(value: f64) -> Value<'static> {
    Value::Number(value)
}

/// A skin whose nodes are nowhere special to what is centred at the origin.
pub fn skin(voxel: f64, terms: Vec<Box<dyn Term>>) -> Skin {
    let origin = Vec3::new(0.37, 0.21, 0.43) * voxel;
    Skin {
        name: "skin".to_owned(),
        lattice: Lattice { origin, voxel },
        target: None,
        terms,
        redistance: 0.25,
        reaction: None,
    }
}

pub fn part(name: &str, values: &[(&'static str, Value<'static>)]) -> Part {
    struct Nothing;
    impl Surroundings for Nothing {
        fn surface(&self, _: &str) -> Result<souple_mesh::TriangleSurface, String> {
            Err("there is none".to_owned())
        }
        fn particles(&self, _: &str, _: &str, _: f64) -> Result<souple_skin::target::Particles, String> {
            Err("there is none".to_owned())
        }
        fn body_surface(&self, _: &str) -> Result<(souple_mesh::TriangleSurface, usize, Vec<u32>), String> {
            Err("there is none".to_owned())
        }
    }
    let entry = PARTS.find(name).unwrap();
    let mut given = Values::new();
    for (name, value) in values {
        given.set((*name).to_owned(), *value);
    }
    Part::new((entry.build)(&entry.values(given).unwrap(), &Nothing).unwrap())
}
