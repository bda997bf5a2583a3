//! The links of a network as they stand.

use souple_engine::{LinkShown, LinkState, World};
use souple_io::Field;
use souple_models::network::Constraints;
use souple_scene::BodyInfo;

/// The field of cells that tells the state of links, see [`state_number`].
pub const LINK_STATE: &str = "link_state";
/// The field of points that tells how large balls are [m].
pub const RADIUS: &str = "radius";

/// How the links of a network stand, in the order of the cells of its mesh; none of another body.
pub fn links_of(world: &World, body: &BodyInfo) -> Vec<LinkShown> {
    let mut links = Vec::new();
    if body.radii.is_empty() {
        return links;
    }
    // rods of a rigid body are within its faces
    let is_hidden = |ends: [u32; 2]| {
        let of_body = ends.map(|end| end - body.rows.start as u32);
        body.faces.as_ref().is_some_and(|faces| faces.holds(of_body))
    };
    world.visit_forces(body.system, &mut |force, at| {
        let is_exact = force.as_any().is::<Constraints>();
        force.visit_links(at, &mut |link| {
            if body.rows.contains(&(link.ends[0] as usize)) && !(is_exact && is_hidden(link.ends)) {
                links.push(*link);
            }
        });
    });
    links
}

/// The state of a link as a number of a field: -1 where nothing holds its ends together.
pub fn state_number(state: LinkState) -> f64 {
    match state {
        LinkState::Apart => -1.0,
        LinkState::In(number) => f64::from(number),
    }
}

/// Fields of points and of links that a network has beside those of every body.
pub fn fields(world: &World, body: &BodyInfo) -> (Option<Field>, Vec<Field>) {
    let radius = body.radii.iter().any(|radius| *radius > 0.0);
    let links = links_of(world, body);
    let of_links = if links.is_empty() {
        Vec::new()
    } else {
        let states = links.iter().map(|link| state_number(link.state)).collect();
        let pushes = links.iter().map(|link| link.push).collect();
        vec![Field::new(LINK_STATE, 1, states), Field::new("link_force", 1, pushes)]
    };
    (radius.then(|| Field::new(RADIUS, 1, body.radii.clone())), of_links)
}
