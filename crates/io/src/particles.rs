//! Particles as a table of comma-separated values.
//!
//! The first line names the columns: `x`, `y`, `z` [m], and where there are any `radius` [m], `vx`, `vy`, `vz` [m/s],
//! `from`, `until` [s].

use std::path::Path;

use souple_math::Vec3;

use crate::IoError;
use crate::encoding::unmarked;

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

/// What a column holds, and whether a number is such: times may be those of always.
fn expected_of(column: usize) -> (&'static str, fn(f64) -> bool) {
    match COLUMNS[column] {
        "from" => ("a number or -inf", |number| number < f64::INFINITY),
        "until" => ("a number or inf", |number| number > f64::NEG_INFINITY),
        "radius" => ("a finite number above 0", |number| number.is_finite() && number > 0.0),
        _ => ("a finite number", f64::is_finite),
    }
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
    let bytes = unmarked(bytes).map_err(|fault| IoError::content(Path::new(name), fault))?;
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
            Some(known) if places[known].is_some() => {
                return refuse("a column".to_owned(), column, "each column once".to_owned());
            }
            Some(known) => places[known] = Some(place),
            None if column.contains([';', '\t']) => {
                return refuse("a column".to_owned(), column, "names with commas between them".to_owned());
            }
            None => return refuse("a column".to_owned(), column, format!("one of {}", COLUMNS.join(", "))),
        }
    }
    if places[..3].contains(&None) {
        return refuse("the list of columns".to_owned(), head, "x, y and z among them".to_owned());
    }
    let columns = places.iter().flatten().count();
    let mut rows = Vec::new();
    for (number, line) in lines {
        let number = number + 1;
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        if cells.len() != columns {
            let what = format!("the number of cells of line {number}");
            return refuse(what, &cells.len().to_string(), format!("{columns}, as of the first line"));
        }
        let mut values = [None; COLUMNS.len()];
        for (column, (value, place)) in values.iter_mut().zip(places).enumerate() {
            let Some(cell) = place.map(|place| cells[place]) else { continue };
            let (expected, is_taken) = expected_of(column);
            *value = cell.parse().ok().filter(|number| is_taken(*number));
            if value.is_none() {
                return refuse(format!("{} in line {number}", COLUMNS[column]), cell, expected.to_owned());
            }
        }
        let at = |column: usize, default: f64| values[column].unwrap_or(default);
        let during = [at(7, f64::NEG_INFINITY), at(8, f64::INFINITY)];
        if during[0] >= during[1] {
            let what = format!("from in line {number}");
            return refuse(what, &during[0].to_string(), format!("a time before `until`, {}", during[1]));
        }
        rows.push(ParticleRow {
            position: Vec3::new(at(0, 0.0), at(1, 0.0), at(2, 0.0)),
            velocity: Vec3::new(at(4, 0.0), at(5, 0.0), at(6, 0.0)),
            radius: values[3],
            during,
        });
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_name_line_value_and_range() {
        let message = |text: &str| match read_particle_bytes("drops.csv", text.as_bytes()) {
            Ok(rows) => panic!("{text:?} is read as {rows:?}"),
            Err(error) => error.to_string(),
        };
        for (text, words) in [
            ("", "the first line of drops.csv is ``; expected names of columns among x, y"),
            ("x,y,w\n", "a column of drops.csv is `w`; expected one of x, y"),
            ("x;y;z\n0;0;0\n", "a column of drops.csv is `x;y;z`; expected names with commas"),
            ("x,y\n", "the list of columns of drops.csv is `x,y`; expected x, y and z among them"),
            ("x,y,z,x\n0,0,0,1\n", "a column of drops.csv is `x`; expected each column once"),
            (
                "x,y,z\n0,0,0,1\n",
                "the number of cells of line 2 of drops.csv is `4`; expected 3, as of the first line",
            ),
            ("x,y,z\n\n0,0\n", "the number of cells of line 3 of drops.csv is `2`; expected 3"),
            ("x,y,z\n0,inf,0\n", "y in line 2 of drops.csv is `inf`; expected a finite number"),
            ("x,y,z,vy\n0,0,0,-inf\n", "vy in line 2 of drops.csv is `-inf`"),
            ("x,y,z,until\n0,0,0,nan\n", "until in line 2 of drops.csv is `nan`"),
            ("x,y,z,until\n0,0,0,-inf\n", "until in line 2 of drops.csv is `-inf`; expected a number or inf"),
            ("x,y,z,from\n0,0,0,inf\n", "from in line 2 of drops.csv is `inf`; expected a number or -inf"),
            ("x,y,z,radius\n0,0,0,\n", "radius in line 2 of drops.csv is ``"),
            (
                "x,y,z,radius\n0,0,0,1\n0,0,0,-1\n",
                "radius in line 3 of drops.csv is `-1`; expected a finite number above 0",
            ),
            (
                "x,y,z,from,until\n0,0,0,2,1\n",
                "from in line 2 of drops.csv is `2`; expected a time before `until`, 1",
            ),
        ] {
            let message = message(text);
            assert!(message.contains(words), "{text:?}: {message}");
        }
    }

    #[test]
    fn columns_in_any_order() {
        let text = "until, z, y, x, vx\ninf, 3, 2, 1, 4\n5, 3, 2, 1, 4\n";
        let rows = read_particle_bytes("drops.csv", text.as_bytes()).unwrap();
        let row = ParticleRow {
            position: Vec3::new(1.0, 2.0, 3.0),
            velocity: Vec3::new(4.0, 0.0, 0.0),
            radius: None,
            during: [f64::NEG_INFINITY, f64::INFINITY],
        };
        assert_eq!(rows, [row, ParticleRow { during: [f64::NEG_INFINITY, 5.0], ..row }]);
    }
}
