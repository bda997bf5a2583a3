//! Modules that every scene has: one text each, and one entry of [`MODULES`], whose parameters are those of the text.

use souple_table::{Entry, Parameter, Range, Table, Value};

const MASS: Parameter =
    Parameter::number("mass", "kg", Range::POSITIVE, "of each mass").or(Value::Number(1.0));
const STIFFNESS: Parameter =
    Parameter::number("stiffness", "N/m", Range::NOT_NEGATIVE, "of each link").or(Value::Number(100.0));
const DAMPING: Parameter =
    Parameter::number("damping", "N s/m", Range::NOT_NEGATIVE, "of each link").or(Value::Number(0.0));
const SPACING: Parameter =
    Parameter::number("spacing", "m", Range::POSITIVE, "between neighbours").or(Value::Number(0.1));
const NEIGHBOURS: Parameter = Parameter::number(
    "neighbours",
    "",
    Range::POSITIVE,
    "how many spacings links reach: 1.01 edges, 1.42 diagonals of faces too, 1.74 those of cubes too",
);
const COLUMNS: Parameter =
    Parameter::integer("columns", Range::closed(1.0, 1e4), "along x").or(Value::Integer(5));
const ROWS: Parameter = Parameter::integer("rows", Range::closed(1.0, 1e4), "along y").or(Value::Integer(5));
const SOURCE: &str = "Jimenez 1993, P2-I.3.4: macro-modules";
const MECHANISMS: &str = "Jimenez 1993, P2-VI.3";

/// Modules that networks may place without writing them: texts of TOML, as `[modules.NAME]` would hold them.
pub const MODULES: Table<&str> = Table {
    kind: "module",
    entries: &[
        &Entry {
            name: "oscillator",
            summary: "a mass at a fixed point by a spring and damper; shows `bob` and `anchor`",
            source: SOURCE,
            parameters: &[
                MASS,
                STIFFNESS,
                DAMPING,
                Parameter::number("length", "m", Range::POSITIVE, "at rest, along x").or(Value::Number(1.0)),
            ],
            build: include_str!("oscillator.toml"),
        },
        &Entry {
            name: "line",
            summary: "masses in a chain along x; shows `first`, `last` and `masses`",
            source: SOURCE,
            parameters: &[
                Parameter::integer("count", Range::closed(2.0, 1e6), "of masses").or(Value::Integer(10)),
                SPACING,
                MASS,
                STIFFNESS,
                DAMPING,
            ],
            build: include_str!("line.toml"),
        },
        &Entry {
            name: "surface",
            summary: "masses in a square mesh in the plane of x and y; shows `masses`",
            source: SOURCE,
            parameters: &[
                COLUMNS,
                ROWS,
                SPACING,
                MASS,
                STIFFNESS,
                DAMPING,
                NEIGHBOURS.or(Value::Number(1.01)),
            ],
            build: include_str!("surface.toml"),
        },
        &Entry {
            name: "volume",
            summary: "masses in a cubic mesh; shows `masses`",
            source: SOURCE,
            parameters: &[
                COLUMNS,
                ROWS,
                Parameter::integer("layers", Range::closed(1.0, 1e4), "along z").or(Value::Integer(5)),
                SPACING,
                MASS,
                STIFFNESS,
                DAMPING,
                NEIGHBOURS.or(Value::Number(1.74)),
            ],
            build: include_str!("volume.toml"),
        },
        &Entry {
            name: "tetrahedron",
            summary: "four masses, each linked to the others: the smallest solid; shows `corners`",
            source: MECHANISMS,
            parameters: &[
                Parameter::number("size", "m", Range::POSITIVE, "of its edges").or(Value::Number(1.0)),
                MASS,
                STIFFNESS,
                DAMPING,
            ],
            build: include_str!("tetrahedron.toml"),
        },
        &Entry {
            name: "truss",
            summary: "a girder of four chords along x with both diagonals of every face; shows `start` and `end`",
            source: MECHANISMS,
            parameters: &[
                Parameter::integer("bays", Range::closed(1.0, 1e5), "cubes in a row").or(Value::Integer(5)),
                SPACING,
                MASS,
                STIFFNESS,
                DAMPING,
            ],
            build: include_str!("truss.toml"),
        },
        &Entry {
            name: "wheel",
            summary: "a rim of masses about a hub of two, with spokes to both; shows `left`, `right` and `rim`",
            source: MECHANISMS,
            parameters: &[
                Parameter::integer("count", Range::closed(3.0, 1e4), "of masses on the rim")
                    .or(Value::Integer(16)),
                Parameter::number("radius", "m", Range::POSITIVE, "of the rim").or(Value::Number(0.3)),
                Parameter::number("width", "m", Range::POSITIVE, "between the ends of the hub, along z")
                    .or(Value::Number(0.1)),
                MASS,
                STIFFNESS,
                DAMPING,
            ],
            build: include_str!("wheel.toml"),
        },
        &Entry {
            name: "axle",
            summary: "two wheels whose hubs are joined along z; shows `left` and `right`, the outer ends of the hubs",
            source: MECHANISMS,
            parameters: &[
                Parameter::number("track", "m", Range::POSITIVE, "between the wheels").or(Value::Number(1.0)),
                Parameter::integer("count", Range::closed(3.0, 1e4), "of masses on each rim")
                    .or(Value::Integer(16)),
                Parameter::number("radius", "m", Range::POSITIVE, "of the rims").or(Value::Number(0.3)),
                Parameter::number("width", "m", Range::POSITIVE, "of a hub, along z").or(Value::Number(0.1)),
                MASS,
                STIFFNESS,
                DAMPING,
            ],
            build: include_str!("axle.toml"),
        },
        &Entry {
            name: "wall",
            summary: "an exact plane for balls: what is joined to `contents` stays on the side of its normal",
            source: "Jimenez 1993, P2-III.1.1: in place of huge balls",
            parameters: &[
                Parameter::vector("point", "m", "of the plane").or(Value::Vector([0.0; 3])),
                Parameter::vector("normal", "", "towards the balls").or(Value::Vector([0.0, 0.0, 1.0])),
                Parameter::number("radius", "m", Range::POSITIVE, "of the balls").or(Value::Number(0.05)),
                STIFFNESS.or(Value::Number(1e4)),
                DAMPING,
            ],
            build: include_str!("wall.toml"),
        },
        &Entry {
            name: "box",
            summary: "six exact planes about the origin: what is joined to `contents` stays inside",
            source: "Jimenez 1993, P2-III.1.1: in place of huge balls",
            parameters: &[
                Parameter::number("width", "m", Range::POSITIVE, "inside, along x").or(Value::Number(1.0)),
                Parameter::number("depth", "m", Range::POSITIVE, "inside, along y").or(Value::Number(1.0)),
                Parameter::number("height", "m", Range::POSITIVE, "inside, along z").or(Value::Number(1.0)),
                Parameter::number("radius", "m", Range::POSITIVE, "of the balls").or(Value::Number(0.05)),
                STIFFNESS.or(Value::Number(1e4)),
                DAMPING,
            ],
            build: include_str!("box.toml"),
        },
    ],
};
