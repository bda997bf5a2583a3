//! What tests of materials share.

use souple_models::materials::{Build, Lame, Material};
use souple_table::{Entry, Value, Values};

/// The material of an entry that has these moduli at rest, and 1000 kg/m³: a law with numbers of its own takes them from
/// there.
pub fn material_of(entry: &Entry<Build>, youngs_modulus: f64, poissons_ratio: f64) -> Material {
    let lame = Lame::from_young_poisson(youngs_modulus, poissons_ratio);
    let values = match entry.name {
        "mooney_rivlin" => Values::new()
            .with("c10", Value::Number(0.4 * lame.mu))
            .with("c01", Value::Number(0.1 * lame.mu))
            .with("bulk_modulus", Value::Number(lame.bulk_modulus())),
        // shear modulus 2 c₁; stiffer where it is stretched
        "yeoh" => Values::new()
            .with("c1", Value::Number(0.5 * lame.mu))
            .with("c2", Value::Number(-0.02 * lame.mu))
            .with("c3", Value::Number(0.005 * lame.mu))
            .with("bulk_modulus", Value::Number(lame.bulk_modulus())),
        // Σ μ α / 2 = μ, three quarters of it by lengths
        "ogden" => Values::new()
            .with("mu", Value::Numbers(&[1.5 / 1.8 * lame.mu, -0.5 / 2.5 * lame.mu]))
            .with("alpha", Value::Numbers(&[1.8, -2.5]))
            .with("bulk_modulus", Value::Number(lame.bulk_modulus())),
        _ => Values::new()
            .with("youngs_modulus", Value::Number(youngs_modulus))
            .with("poissons_ratio", Value::Number(poissons_ratio)),
    };
    let values = values.with("density", Value::Integer(1000));
    (entry.build)(&entry.values(values).unwrap()).unwrap()
}
