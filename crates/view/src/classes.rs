//! What cells are told apart by: their kinds, laws and levels.

use souple_io::picture::{Colour, ColourMap, ELEMENT_KINDS};
use souple_run::Session;
use souple_run::show::number_of;
use souple_scene::BodyInfo;

/// A way to tell the cells of bodies apart.
#[derive(Clone, Copy)]
pub struct Classes {
    /// Names of all there may be in a scene, with their colours.
    pub all: fn(&Session) -> Vec<(String, Colour)>,
    /// Of each cell its number among them; `None` where a body's cells do not differ so.
    pub of: fn(&Session, &BodyInfo) -> Option<Vec<usize>>,
}

/// Linear and quadratic elements of a kind are one; colours are those of pictures.
pub const KINDS: Classes = Classes {
    all: |_| {
        let count = ELEMENT_KINDS.len() as f64;
        let colour = |kind: usize| ColourMap::Elements.colour((kind as f64 + 0.5) / count);
        ELEMENT_KINDS.iter().enumerate().map(|(kind, name)| ((*name).to_owned(), colour(kind))).collect()
    },
    of: |_, body| Some(body.mesh.cells().map(|cell| number_of(cell.kind)).collect()),
};

/// By law and region, and second laws where elements took them.
pub const LAWS: Classes = Classes {
    all: |session| {
        let names = names_of_laws(session);
        let colours = spread(names.len());
        names.into_iter().map(str::to_owned).zip(colours).collect()
    },
    of: laws_of_cells,
};

/// The mesh that is at work at the corners of a cell: the finest of them.
pub const LEVELS: Classes = Classes {
    all: |session| {
        let levels = |body: &BodyInfo| body.level_count(&session.world).unwrap_or(0);
        let count = session.bodies.iter().map(levels).max().unwrap_or(0);
        let name = |level: usize| match level {
            0 => "0, coarsest".to_owned(),
            _ if level + 1 == count => format!("{level}, finest"),
            _ => level.to_string(),
        };
        (0..count).map(name).zip(spread(count)).collect()
    },
    of: |session, body| {
        let level = body.level_of_point(&session.world)?;
        let finest = |nodes: &[u32]| nodes.iter().map(|node| level[*node as usize] as usize).max();
        body.mesh.cells().map(|cell| finest(cell.nodes)).collect()
    },
};

/// Colours at equal distances in the sequential map.
fn spread(count: usize) -> impl Iterator<Item = Colour> {
    let last = count.saturating_sub(1).max(1) as f64;
    (0..count).map(move |number| ColourMap::Sequential.colour(number as f64 / last))
}

/// Each once, whichever bodies have it.
fn names_of_laws(session: &Session) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for name in session.bodies.iter().flat_map(|body| body.laws.names.iter().chain(&body.laws.seconds)) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    names
}

fn laws_of_cells(session: &Session, body: &BodyInfo) -> Option<Vec<usize>> {
    let all = names_of_laws(session);
    let number = |name: &String| all.iter().position(|known| known == name);
    let [firsts, seconds] = [&body.laws.names, &body.laws.seconds]
        .map(|names| names.iter().filter_map(number).collect::<Vec<usize>>());
    // numbers beyond the names are of fields of the body's own law
    let of = |laws: &[usize], law: u16| laws.get(usize::from(law)).or(laws.first()).copied();
    let cells = body.laws.of_cell.iter();
    if seconds.is_empty() {
        return cells.map(|law| of(&firsts, *law)).collect();
    }
    let (solid, at) = session.world.force_named(body.system, &body.force)?;
    let has_second = |cell: usize| solid.adapted(cell, &at).is_some_and(|adapted| adapted.law > 0.0);
    cells.enumerate().map(|(cell, law)| of(if has_second(cell) { &seconds } else { &firsts }, *law)).collect()
}
