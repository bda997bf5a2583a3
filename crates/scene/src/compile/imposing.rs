//! Points that a tool is to move by displacements, and somebody else holds: another such tool, or a pin.

use std::collections::BTreeSet;

use souple_math::Mat3;
use souple_table::in_number;

use super::Draft;
use crate::spec::contact::Contact;

/// A tool that imposes displacements, and the rows of the surface that it may hold.
struct Imposing<'a> {
    contact: &'a Contact,
    system: usize,
    /// Ascending.
    rows: &'a [u32],
}

/// Warns of points that two such tools may hold, and of pinned ones.
pub fn warn(draft: &mut Draft) {
    let all = imposing(draft);
    let mut warnings: Vec<String> = all.iter().filter_map(|one| of_pins(draft, one)).collect();
    for (index, later) in all.iter().enumerate() {
        warnings.extend(all[..index].iter().filter_map(|earlier| of_two(draft, earlier, later)));
    }
    draft.warnings.extend(warnings);
}

/// In the order of forces, in which tools take hold.
fn imposing<'a>(draft: &'a Draft) -> Vec<Imposing<'a>> {
    let contacts = || draft.spec.contacts.iter().chain(draft.spec.hands.iter().map(|hand| &hand.touch));
    let of_system = |(system, forces): (usize, &'a souple_engine::System)| {
        forces.forces.iter().filter_map(move |force| Some((system, force.name(), force.holding()?.rows())))
    };
    let holding = draft.systems.iter().enumerate().flat_map(of_system);
    let named = |(system, name, rows): (usize, &str, &'a [u32])| {
        let contact = contacts().find(|contact| contact.name == name)?;
        Some(Imposing { contact, system, rows })
    };
    holding.filter_map(named).collect()
}

fn of_two(draft: &Draft, earlier: &Imposing, later: &Imposing) -> Option<String> {
    let is_shared = |row: &&u32| earlier.rows.binary_search(row).is_ok();
    let shared = later.rows.iter().filter(is_shared).count();
    (earlier.system == later.system && shared > 0).then(|| {
        format!(
            "{}: it may hold {} of body `{}` that {} may hold too: where both touch one, {} moves and feels it, and this one \
             does not; give each a `region` of its own, or one of them `response = \"penalty\"`",
            draft.place(&later.contact.site),
            in_number(shared, "point", "points"),
            later.contact.body,
            draft.place(&earlier.contact.site),
            draft.place(&earlier.contact.site),
        )
    })
}

fn of_pins(draft: &Draft, one: &Imposing) -> Option<String> {
    let system = &draft.systems[one.system];
    let rows = |is_whole: bool| -> BTreeSet<u32> {
        let constraints = system.constraints.iter().filter(|held| (held.free == Mat3::ZERO) == is_whole);
        let rows = constraints.filter_map(|held| system.kinematics.point_block_row(held.block));
        rows.filter(|row| one.rows.binary_search(row).is_ok()).collect()
    };
    let (whole, partly) = (rows(true).len(), rows(false).len());
    let along = match (whole, partly) {
        (0, 0) => return None,
        (_, 0) => String::new(),
        _ => format!(", {partly} of them along some axes only"),
    };
    Some(format!(
        "{}: pins hold {} of body `{}` that it may touch{along}: a pin moves its points and bears what acts on them, this tool \
         does neither; give it a `region` that leaves them out, or `response = \"penalty\"`",
        draft.place(&one.contact.site),
        in_number(whole + partly, "point", "points"),
        one.contact.body,
    ))
}
