//! Time of a step by resolution: a sphere that fills its domain, drawn to a target and tense, with its triangles.
//!
//! `cargo run --release -p souple-skin --example skin_cost`

use std::time::Instant;

use souple_math::Vec3;
use souple_skin::strategy::TERMS;
use souple_skin::target::{ISO, Moment, PARTS, Part, Target};
use souple_skin::{Lattice, Skin};
use souple_table::{Value, Values};

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread starts");
    pool.install(|| {
        let mut last: Option<(f64, f64)> = None;
        for cells in [64.0, 128.0, 256.0] {
            let seconds = seconds_per_step(cells);
            let exponent = last.map(|(n, s): (f64, f64)| (seconds / s).ln() / (cells / n).ln());
            println!("{cells:5} cells: {:8.2} ms/step, exponent {exponent:?}", 1e3 * seconds);
            last = Some((cells, seconds));
        }
    });
}

fn seconds_per_step(cells: f64) -> f64 {
    let voxel = 2.0 / cells;
    let number = |name: &str, value: f64| {
        let mut values = Values::new();
        values.set(name.to_owned(), Value::Number(value));
        values
    };
    let term = |name: &str, strength: f64| {
        let entry = TERMS.find(name).expect("it is in the table");
        (entry.build)(&entry.values(number("strength", strength)).expect("it fits")).expect("it fits")
    };
    let entry = PARTS.find("point").expect("it is in the table");
    let mut values = number("radius", 0.9);
    values.set("at".to_owned(), Value::Vector([0.0; 3]));
    let values = entry.values(values).expect("they fit");
    struct Nothing;
    impl souple_skin::target::Surroundings for Nothing {
        fn surface(&self, _: &str) -> Result<souple_mesh::TriangleSurface, String> {
            Err(String::new())
        }
        fn particles(&self, _: &str, _: f64) -> Result<souple_skin::target::Particles, String> {
            Err(String::new())
        }
        fn body_surface(&self, _: &str) -> Result<(souple_mesh::TriangleSurface, usize, Vec<u32>), String> {
            Err(String::new())
        }
    }
    let potential = (entry.build)(&values, &Nothing).expect("they fit");
    let target = Target { parts: vec![Part::new(potential)], iso: ISO };
    let skin = Skin {
        name: "ball".to_owned(),
        lattice: Lattice { origin: Vec3::ZERO, voxel },
        target: Some(target),
        terms: vec![term("attraction", 0.1), term("tension", 0.01 * voxel)],
        redistance: 0.25,
        reaction: None,
    };
    let mut scratch = skin.new_scratch();
    let corner = Vec3::new(1.0, 1.0, 1.0);
    let mut field =
        skin.start(-corner, corner, &|p| 0.95 - p.length(), &mut scratch).expect("a ball is a skin");
    let (steps, timestep) = (20, voxel);
    for step in 1..=3 {
        skin.step(&Moment::at(f64::from(step) * timestep), timestep, &mut field, &mut scratch)
            .expect("it steps");
    }
    let clock = Instant::now();
    for step in 4..4 + steps {
        skin.step(&Moment::at(f64::from(step) * timestep), timestep, &mut field, &mut scratch)
            .expect("it steps");
    }
    assert!(skin.view(&field).substeps() == 1.0);
    clock.elapsed().as_secs_f64() / f64::from(steps)
}
