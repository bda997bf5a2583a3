//! Particles as a table of comma-separated values.
//!
//! The first line names the columns: `x`, `y`, `z` [m], and where there are any `radius` [m], `vx`, `vy`, `vz` [m/s],
//! `from`, `until` [s].

use std::path::Path;

use souple_math::Vec3;

use crate::IoError;

/// A line of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParticleRow {
    /// At the time 0 [m].
    pub position: Vec3,
    /// [m/s]
    pub velocity: Vec3,
    /// [m]
    pub radius: Option<f64>,
    /// There from the first to before the second [s].
    pub during: [f64; 2],
}

const COLUMNS: [&str; 9] = ["x", "y", "z", "radius", "vx", "vy", "vz", "from", "until"];

/// Reads a table of particles.
///
/// # Errors
/// The file cannot be read, a column is unknown or missing, a line holds what is no number.
pub fn read_particles(path: &Path) -> Result<Vec<ParticleRow>, IoError> {
    let bytes = std::fs::read(path).map_err(|source| IoError::Read { path: path.to_owned(), source })?;
    read_particle_bytes(&path.display().to_string(), &bytes)
}

/// Reads the content of a table of particles, which is called `name` in errors.
///
/// # Errors
/// A column is unknown or missing, a line holds what is no number.
pub fn read_particle_bytes(name: &str, bytes: &[u8]) -> Result<Vec<ParticleRow>, IoError> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let refuse = |what: String, value: &str, expected: String| {
        Err(IoError::request(format!("{what} of {name}"), format!("`{value}`"), expected))
    };
    let Some((_, head)) = lines.next() else {
        return refuse(
            "the first line".to_owned(),
            "",
            format!("names of columns among {}", COLUMNS.join(", ")),
        );
    };
    let mut places = [None; COLUMNS.len()];
    for (place, column) in head.split(',').map(str::trim).enumerate() {
        match COLUMNS.iter().position(|known| *known == column) {
            Some(known) => places[known] = Some(place),
            None => return refuse("a column".to_owned(), column, format!("one of {}", COLUMNS.join(", "))),
        }
    }
    if places[..3].contains(&None) {
        return refuse("the columns".to_owned(), head, "x, y and z among them".to_owned());
    }
    let mut rows = Vec::new();
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let mut values = [None; COLUMNS.len()];
        for (value, place) in values.iter_mut().zip(places) {
            let Some(place) = place else { continue };
            let cell = cells.get(place).copied().unwrap_or_default();
            match cell.parse::<f64>() {
                Ok(number) if !number.is_nan() => *value = Some(number),
                _ => {
                    return refuse(
                        format!("line {}", number + 1),
                        cell,
                        "a number in each column".to_owned(),
                    );
                }
            }
        }
        let at = |column: usize, default: f64| values[column].unwrap_or(default);
        rows.push(ParticleRow {
            position: Vec3::new(at(0, 0.0), at(1, 0.0), at(2, 0.0)),
            velocity: Vec3::new(at(4, 0.0), at(5, 0.0), at(6, 0.0)),
            radius: values[3],
            during: [at(7, f64::NEG_INFINITY), at(8, f64::INFINITY)],
        });
    }
    Ok(rows)
}
