//! Souple, a simulator of soft things: everything a program that embeds it needs, under one roof.
//!
//! ```
//! let text = r#"
//! format = 1
//! [world]
//! period = "10 ms"
//! gravity = [0, -9.81, 0]
//! [bodies.bar]
//! mesh = { generate = "bar", size = [1, 0.1, 0.1], cells = [10, 1, 1], element = "hex8" }
//! material = { name = "neo_hookean", youngs_modulus = "10 MPa", poissons_ratio = 0.3, density = 1000 }
//! [[bodies.bar.pins]]
//! region = { box = [[-1e-9, -1, -1], [1e-9, 1, 1]] }
//! "#;
//! let scene = souple::scene::read_text("bar", text, std::path::Path::new("."), &[])?;
//! let mut world = scene.model.start(scene.state);
//! world.step()?;
//! assert!(world.rows(0).positions.iter().any(|x| x.y < -1e-4), "the bar has begun to sag");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use souple_engine as engine;
pub use souple_formal as formal;
pub use souple_io as io;
pub use souple_math as math;
pub use souple_mesh as mesh;
pub use souple_models as models;
pub use souple_run as run;
pub use souple_scene as scene;
pub use souple_solve as solve;
pub use souple_table as table;
pub use souple_verify as verify;
pub use souple_view as view;
