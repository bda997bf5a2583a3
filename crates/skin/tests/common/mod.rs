//! Skins, their terms and the parts of their targets, as tests write them.

// each test binary uses its own part of this
#![allow(dead_code)]

use souple_engine::FieldState;
use souple_math::Vec3;
use souple_skin::grid::{EDGE, NODES, block_of};
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
        fn warn(&self, _: String) {}
    }
    let entry = PARTS.find(name).unwrap();
    let mut given = Values::new();
    for (name, value) in values {
        given.set((*name).to_owned(), *value);
    }
    Part::new((entry.build)(&entry.values(given).unwrap(), &Nothing).unwrap())
}

/// Where the nodes of a skin are, and their values as distances, positive inside [m].
pub fn nodes(skin: &Skin, field: &FieldState) -> impl Iterator<Item = (Vec3, f64)> {
    let (grid, lattice) = (skin.view(field).grid, skin.lattice);
    grid.keys.iter().enumerate().flat_map(move |(block, key)| {
        let corner = block_of(*key).map(|c| (c * EDGE as i64) as f64);
        (0..NODES).map(move |node| {
            let place = [node % EDGE, node / EDGE % EDGE, node / EDGE / EDGE];
            let [x, y, z] = [0, 1, 2].map(|axis| corner[axis] + place[axis] as f64);
            let value = f64::from(grid.values[NODES * block + node]);
            (lattice.to_world(Vec3::new(x, y, z)), value * lattice.voxel)
        })
    })
}
