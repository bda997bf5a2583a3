//! Contacts become forces: surface points against shapes, and the surfaces of two bodies against each other.

use std::path::Path;

use souple_engine::{Detection, Felt, Force};
use souple_math::Vec3;
use souple_mesh::{OpeningSurface, TriangleSurface};
use souple_models::contact::shape::{BuildShape, ShapeError};
use souple_models::contact::{
    ContactLaw, ContactPoint, ContactSurface, ImposedContact, ImposedLaw, Shape, ShapeContact, Shares,
    SurfaceContact, ToolContact, ToolSurface, penalty_stiffness,
};
use souple_models::loads::RigidMotion;
use souple_skin::BAND;

use super::Draft;
use super::bodies::Placed;
use super::freedom::{Joint, touching_joints};
use super::levels;
use super::motion::motion;
use super::skin_shape::SkinShape;
use crate::diagnostic::Code;
use crate::reader::Chosen;
use crate::scene::SkinInfo;
use crate::spec::contact::{Against, Contact, Detect, Imposed, ShapeSpec, Weighing};

/// A body's points that touch, with the areas around them.
pub(super) struct Touching {
    pub points: Vec<ContactPoint>,
    /// Their shares from each date on at which the surface opens.
    pub later: Vec<Shares>,
    /// Of those that are on the surface before it opens [m²].
    pub mean_area: f64,
}

impl Touching {
    /// Rows of the points with the largest shares of the stiffness that they ever have.
    fn shares(&self) -> impl Iterator<Item = (u32, f64)> {
        let largest = |(index, point): (usize, &ContactPoint)| {
            let later = self.later.iter().map(|shares| shares.of_points[index]);
            (point.row, later.fold(point.share, f64::max))
        };
        self.points.iter().enumerate().map(largest)
    }
}

/// How a contact weighs an area, in parts of a mean one; what is not on the surface has none.
fn share_of(contact: &Contact, area: f64, mean_area: f64) -> f64 {
    if area > 0.0 { contact.weigh.share(area / mean_area) } else { 0.0 }
}

/// The dates at which a surface opens in the course of a run [s].
fn later_dates(surface: &OpeningSurface) -> impl Iterator<Item = f64> {
    surface.dates().into_iter().filter(|date| *date > 0.0)
}

/// All contacts.
pub fn add(draft: &mut Draft) {
    // those that nothing touches are refused as well where they cannot be
    for chosen in draft.spec.shapes.iter().filter_map(|shape| shape.shape.as_ref()) {
        built(draft, chosen);
    }
    let mut added: Vec<(usize, Box<dyn Force>)> = Vec::new();
    let mut joints = Vec::new();
    for contact in &draft.spec.contacts {
        let Some(body) = draft.body(&contact.body) else { continue };
        let Some(touching) = touching(draft, body, contact) else { continue };
        let force: Option<Box<dyn Force>> = match &contact.against {
            Some(Against::Shape(name)) => draft
                .spec
                .shapes
                .iter()
                .find(|shape| shape.name == *name)
                .and_then(|shape| against_shape(draft, contact, shape, touching, body))
                .map(|(force, held)| {
                    joints.extend(held);
                    force
                }),
            Some(Against::Body(name)) => draft
                .body(name)
                .and_then(|other| against_body(draft, contact, touching, [body, other]))
                .map(|force| Box::new(force) as _),
            Some(Against::Skin(name)) => draft
                .skins
                .iter()
                .find(|skin| skin.name == *name)
                .and_then(|skin| against_skin(draft, contact, skin, touching, body))
                .map(|force| Box::new(force) as _),
            None => None,
        };
        added.extend(force.map(|force| (body.system, force)));
    }
    draft.joints.extend(joints);
    for (system, force) in added {
        draft.systems[system].forces.push(force);
    }
}

/// What is around a point that touches.
struct Around {
    /// Of the mesh.
    point: u32,
    /// Before its surface opens [m²].
    closed: f64,
    /// At the start, then from each date on at which its surface opens [m²].
    areas: Vec<f64>,
}

/// Masses of a network, which count alike.
fn masses(body: &Placed) -> Vec<Around> {
    let mass = |point| Around { point, closed: 1.0, areas: vec![1.0] };
    (0..body.mesh.points.len() as u32).map(mass).collect()
}

/// All points that are ever on a surface, which opens at some dates [s].
fn around_points(surface: &OpeningSurface, dates: &[f64]) -> Vec<Around> {
    let closed = surface.point_areas(f64::NEG_INFINITY);
    let areas: Vec<Vec<f64>> = [0.0].iter().chain(dates).map(|date| surface.point_areas(*date)).collect();
    let around = |(index, point): (usize, &u32)| Around {
        point: *point,
        closed: closed[index],
        areas: areas.iter().map(|areas| areas[index]).collect(),
    };
    surface.surface.mesh_points.iter().enumerate().map(around).collect()
}

/// The mean area around points while their surface is closed; of walls that a cut opens alone, the largest that they have [m²].
fn mean_area(points: &[Around]) -> f64 {
    let closed: Vec<f64> = points.iter().map(|around| around.closed).filter(|area| *area > 0.0).collect();
    if closed.is_empty() {
        let largest = |around: &Around| around.areas.iter().copied().fold(0.0, f64::max);
        return points.iter().map(largest).sum::<f64>() / points.len() as f64;
    }
    closed.iter().sum::<f64>() / closed.len() as f64
}

/// Surface points in the region of a contact, or masses of a network, which count alike; `None` where there are none, which is
/// reported.
pub(super) fn touching(draft: &Draft, body: &Placed, contact: &Contact) -> Option<Touching> {
    let inside: Option<Vec<u32>> = contact.region.as_ref().map(|region| draft.selector(body).points(region));
    if inside.as_ref().is_some_and(Vec::is_empty) {
        return None;
    }
    let is_inside = |point: u32| inside.as_ref().is_none_or(|inside| inside.binary_search(&point).is_ok());
    let (mut chosen, dates) = match &body.spec.network {
        Some(_) => (masses(body), Vec::new()),
        None => {
            let surface = levels::opening_surface(draft, body);
            let dates: Vec<f64> = later_dates(&surface).collect();
            (around_points(&surface, &dates), dates)
        }
    };
    // what has no area at any time of the run is on no surface then
    let is_there = |around: &Around| around.areas.iter().any(|area| *area > 0.0);
    chosen.retain(|around| is_inside(around.point) && is_there(around));
    if chosen.is_empty() {
        let site = contact.region.as_ref().map_or(&contact.site, |region| &region.site);
        let message = format!("this region holds no point on the surface of body `{}`", contact.body);
        draft.log.add(Code::EmptyRegion, site, message, "a region that reaches the surface");
        return None;
    }
    let mean_area = mean_area(&chosen);
    let first = body.rows.start as u32;
    let contact_point = |around: &Around| ContactPoint {
        row: first + around.point,
        share: share_of(contact, around.areas[0], mean_area),
        start: body.mesh.points[around.point as usize],
    };
    let points = chosen.iter().map(contact_point).collect();
    let later = dates.into_iter().enumerate().map(|(number, from)| {
        let share = |around: &Around| share_of(contact, around.areas[number + 1], mean_area);
        Shares { from, of_points: chosen.iter().map(share).collect() }
    });
    Some(Touching { later: later.collect(), points, mean_area })
}

/// Young's modulus behind the points of a contact [Pa]; `None` where a stiffness must be told, and is not.
pub(super) fn modulus_of(
    draft: &Draft,
    contact: &Contact,
    body: &Placed,
    touching: &Touching,
) -> Option<f64> {
    if body.spec.network.is_none() {
        return Some(modulus_behind(body, touching.shares()));
    }
    if contact.stiffness.is_none() && contact.detect == Detect::Triangles {
        // there are none, which is said where the tool asks for them
        return Some(0.0);
    }
    if contact.stiffness.is_none() {
        let message = format!("masses of network `{}` have no material behind them", contact.body);
        draft.log.add(Code::MissingKey, &contact.site, message, "stiffness = \"… N/m\" of each mass");
        return None;
    }
    // told, so that no modulus is asked for
    Some(0.0)
}

/// Young's modulus behind points of a body, given as rows and shares: the mean over the cells around them [Pa].
fn modulus_behind(body: &Placed, points: impl Iterator<Item = (u32, f64)>) -> f64 {
    let mut sums = vec![(0.0, 0_u32); body.mesh.points.len()];
    for (index, cell) in body.mesh.cells().enumerate() {
        let modulus = body.materials.of(index).small_strain.youngs_modulus();
        for node in cell.nodes {
            let (sum, count) = &mut sums[*node as usize];
            *sum += modulus;
            *count += 1;
        }
    }
    let (mut weighted, mut shares) = (0.0, 0.0);
    for (row, share) in points {
        let (sum, count) = sums[row as usize - body.rows.start];
        weighted += share * sum / f64::from(count);
        shares += share;
    }
    weighted / shares
}

/// The modulus of two bodies that press on each other: their layers of one thickness give way in series [Pa].
fn modulus_between(a: f64, b: f64) -> f64 {
    2.0 * a * b / (a + b)
}

/// `modulus`: of what gives way [Pa].
pub(super) fn law(contact: &Contact, modulus: f64, mean_area: f64) -> ContactLaw {
    // the material behind a point resists over about the width of an element
    let stiffness =
        contact.stiffness.unwrap_or_else(|| penalty_stiffness(modulus, mean_area, mean_area.sqrt()));
    ContactLaw {
        stiffness,
        damping: contact.damping,
        friction: contact.friction,
        tangential_stiffness: contact.tangential_stiffness.unwrap_or(stiffness),
        thickness: contact.thickness,
    }
}

/// A shape as it is written; `None` where it was refused.
pub(super) fn built(draft: &Draft, chosen: &Chosen<BuildShape>) -> Option<Box<dyn Shape>> {
    let source = chosen.site.place.source;
    let open = |file: &str| {
        let path = draft.sources.get(source).folder.join(file);
        draft
            .sources
            .open(source, file)
            .map_err(|error| format!("`{}` cannot be read: {error}", path.display()))
    };
    match (chosen.entry.build)(&chosen.values, &|file| read_surface(&open(file)?)) {
        Ok(built) => Some(built),
        Err(error) => {
            // the file shows the text and where in it
            let (site, message, expected) = match &error {
                ShapeError::Formula { field, variables, example, error, .. } => (
                    chosen.site_of_part(field, Some(error.span())),
                    format!("`{field}`: {}", error.without_place()),
                    format!("a formula of {variables}, such as {example}"),
                ),
                _ => (chosen.site.clone(), error.to_string(), "a shape that can be".to_owned()),
            };
            draft.log.add(Code::Mesh, &site, message, expected);
            None
        }
    }
}

fn against_shape(
    draft: &Draft,
    contact: &Contact,
    shape: &ShapeSpec,
    touching: Touching,
    body: &Placed,
) -> Option<(Box<dyn Force>, Vec<Joint>)> {
    let built = built(draft, shape.shape.as_ref()?)?;
    let led = |spec| motion(draft.log, spec, &shape.site);
    let motion = RigidMotion {
        translation: led(shape.motion.as_ref())?,
        rotation: led(shape.rotation.as_ref())?,
        pivot: shape.pivot,
    };
    let pose = motion.pose(0.0);
    let parts = [pose.origin, pose.velocity, pose.angular_velocity, pose.turn * Vec3::X];
    if parts.iter().any(|vector| !vector.is_finite()) {
        let message = format!("the motion of shape `{}` is not finite at t = 0", shape.name);
        draft.log.add(
            Code::NotFinite,
            &shape.site,
            message,
            "formulas that are finite with their derivative by t",
        );
        return None;
    }
    for (point, at) in
        touching.points.iter().zip(touching.points.iter().map(|point| pose.to_shape(point.start)))
    {
        if let Some(what) = built.undefined_at(at) {
            let message = format!(
                "there is nothing of shape `{}` to touch where point {} of body `{}` starts, at {:?} m: {what} there",
                shape.name,
                point.row as usize - body.rows.start,
                body.spec.name,
                at.to_array()
            );
            draft.log.add(
                Code::NotFinite,
                &shape.site,
                message,
                "a formula that is finite with its slope where points are",
            );
            return None;
        }
    }
    let law = law(contact, modulus_of(draft, contact, body, &touching)?, touching.mean_area);
    let mut joints = touching_joints(body, &touching.points, built.as_ref(), &motion, &law);
    if contact.imposed.is_some() {
        // nothing pushes
        joints.clear();
    }
    let force: Result<Box<dyn Force>, _> =
        match tool_surface(draft, contact, body, &touching, built.as_ref())? {
            Some((surface, numbers)) => match imposed(draft, contact) {
                Some((law, period)) => {
                    ImposedContact::new(contact.name.clone(), surface, built, motion, law, period)
                        .map(|force| Box::new(force.against(&shape.name)) as _)
                }
                None => {
                    let law = stiff(contact, law);
                    ToolContact::new(contact.name.clone(), surface, built, motion, law, numbers)
                        .map(|force| Box::new(weighed(contact, force).against(&shape.name)) as _)
                }
            },
            None => ShapeContact::new(contact.name.clone(), touching.points, built, motion, law)
                .and_then(|force| force.opening(touching.later))
                .map(|force| Box::new(force.against(&shape.name)) as _),
        };
    match force {
        Ok(force) => Some((force, joints)),
        Err(error) => {
            draft.log.add(Code::OutOfRange, &contact.site, error.to_string(), "finite numbers");
            None
        }
    }
}

/// How much stiffer triangles are than the material behind them, where a scene does not tell: a tool sinks in by about so
/// much less than the body gives way.
const STIFFER: f64 = 20.0;

/// The law of triangles.
pub(super) fn stiff(contact: &Contact, law: ContactLaw) -> ContactLaw {
    if contact.stiffness.is_some() {
        return law;
    }
    let tangential_stiffness = contact.tangential_stiffness.unwrap_or(STIFFER * law.stiffness);
    ContactLaw { stiffness: STIFFER * law.stiffness, tangential_stiffness, ..law }
}

/// With its stiffness shared out as a contact says.
pub(super) fn weighed(contact: &Contact, force: ToolContact) -> ToolContact {
    if contact.weigh == Weighing::Alike { force.weighing_alike() } else { force }
}

/// How displacements are imposed, and how long a period is [s]; `None` of a penalty.
pub(super) fn imposed(draft: &Draft, contact: &Contact) -> Option<(ImposedLaw, f64)> {
    let Imposed { fraction, residual, displacing } = contact.imposed?;
    let felt = match contact.weigh {
        Weighing::Area => Felt::Area,
        Weighing::Alike => Felt::Sum,
    };
    Some((ImposedLaw { fraction, residual, displacing, felt }, draft.spec.world.period))
}

/// The triangles of a body that a tool touches, with the reach [m] and the time [s] between searches, where a contact looks at
/// triangles. `None` where they were refused.
#[allow(clippy::type_complexity)]
pub(super) fn tool_surface(
    draft: &Draft,
    contact: &Contact,
    body: &Placed,
    touching: &Touching,
    shape: &dyn Shape,
) -> Option<Option<(ToolSurface, [f64; 2])>> {
    if contact.detect == Detect::Points {
        return Some(None);
    }
    let refuse = |message: String, expected: &str| {
        draft.log.add(Code::Conflict, &contact.site, message, expected);
        None
    };
    if body.spec.network.is_some() {
        let message = format!("masses of network `{}` have no triangles between them", contact.body);
        return refuse(message, "`detect = \"points\"`");
    }
    if contact.imposed.is_some() && body.spec.octree.is_some() {
        let message =
            format!("points of body `{}` are particles of an octree, which no tool holds", contact.body);
        return refuse(message, "`response = \"penalty\"`");
    }
    if shape.parts().is_empty() {
        let message = "triangles are touched by tools of rounded parts".to_owned();
        return refuse(message, "a sphere, a capsule or jaws that are not hollow, or `detect = \"points\"`");
    }
    let mut surface = levels::opening_surface(draft, body);
    let first = body.rows.start as u32;
    let rows: Vec<u32> = surface.surface.mesh_points.iter().map(|point| first + point).collect();
    let chosen: std::collections::BTreeSet<u32> = touching.points.iter().map(|point| point.row).collect();
    let is_chosen = |corners: &[u32; 3]| corners.iter().all(|point| chosen.contains(&rows[*point as usize]));
    surface.retain(is_chosen);
    if surface.surface.triangles.is_empty() {
        let message = "no triangle of the surface has all its corners in the region".to_owned();
        return refuse(message, "a larger region");
    }
    let system = draft.spec.systems.get(body.system)?;
    let period = draft.spec.world.period;
    let horizon = match draft.spec.world.detection {
        Detection::EveryStep => period / f64::from(system.steps_per_period),
        // what is seen where one period begins is used until the next one ends
        Detection::OnePeriodLate => 2.0 * period,
    };
    let reach = surface.surface.mean_edge();
    Some(Some((ToolSurface { surface, rows }, [reach, horizon])))
}

/// Points of a body against a skin: what presses on it comes to those that lead it, as far as they step in the same system.
fn against_skin(
    draft: &Draft,
    contact: &Contact,
    skin: &SkinInfo,
    touching: Touching,
    body: &Placed,
) -> Option<ShapeContact> {
    let touches_itself = skin
        .skin
        .followed()
        .iter()
        .any(|followed| followed.system == body.system && body.rows.contains(&(followed.row as usize)));
    if touches_itself {
        let message = format!("skin `{}` follows body `{}`, which touches it", skin.name, contact.body);
        draft.log.add(Code::Conflict, &contact.site, message, "the skin of another body");
        return None;
    }
    let band = BAND * skin.skin.lattice.voxel;
    if contact.thickness > band {
        let message = format!(
            "`thickness` of the contact `{}` is {} m, and skin `{}` is felt up to {BAND} of its voxels",
            contact.name, contact.thickness, skin.name
        );
        let expected = format!("at most {band} m, or a skin of larger voxels");
        draft.log.add(Code::OutOfRange, &contact.site, message, expected);
        return None;
    }
    let law = law(contact, modulus_of(draft, contact, body, &touching)?, touching.mean_area);
    let shape = Box::new(SkinShape::new(skin.clone(), body.system));
    let force = ShapeContact::new(contact.name.clone(), touching.points, shape, RigidMotion::default(), law);
    match force.and_then(|force| force.opening(touching.later)) {
        Ok(force) => Some(force.against(&skin.name)),
        Err(error) => {
            draft.log.add(Code::OutOfRange, &contact.site, error.to_string(), "finite numbers");
            None
        }
    }
}

fn against_body(
    draft: &Draft,
    contact: &Contact,
    touching: Touching,
    bodies: [&Placed; 2],
) -> Option<SurfaceContact> {
    let refuse = |message: String, expected: &str| {
        draft.log.add(Code::Conflict, &contact.site, message, expected);
        None
    };
    let [body, other] = bodies;
    if body.spec.name == other.spec.name {
        return refuse(format!("body `{}` touches itself", contact.body), "another body");
    }
    if let Some(network) = bodies.iter().find(|body| body.spec.network.is_some()) {
        let message =
            format!("`{}` is a network, whose masses have no surface between them", network.spec.name);
        return refuse(message, "a shape or a skin, or `crowds` of the masses");
    }
    if body.system != other.system {
        let message = format!("`{}` and `{}` step in different systems", body.spec.name, other.spec.name);
        return refuse(message, "bodies of one system");
    }
    let surfaces = bodies.map(|placed| levels::opening_surface(draft, placed));
    let reach =
        f64::max(surfaces[0].surface.mean_edge(), surfaces[1].surface.mean_edge()) + contact.thickness;
    let mut sides = bodies.iter().zip(surfaces).map(|(placed, surface)| {
        // one stiffness for each area on both sides, of which a point of the region's mean area has the whole
        let shares = |time: f64| -> Vec<f64> {
            let areas = surface.point_areas(time);
            areas.into_iter().map(|area| share_of(contact, area, touching.mean_area)).collect()
        };
        let later = later_dates(&surface).map(|from| Shares { from, of_points: shares(from) }).collect();
        let first = placed.rows.start as u32;
        let rows = surface.surface.mesh_points.iter().map(|point| first + point).collect();
        ContactSurface { rows, shares: shares(0.0), later, surface }
    });
    let (mut a, b) = (sides.next()?, sides.next()?);
    let facing = b.rows.iter().copied().zip(b.largest_shares());
    let modulus = modulus_between(modulus_behind(body, touching.shares()), modulus_behind(other, facing));
    // points outside the region do not touch by themselves
    let chosen: std::collections::BTreeSet<u32> = touching.points.iter().map(|point| point.row).collect();
    let outside: Vec<usize> = (0..a.rows.len()).filter(|point| !chosen.contains(&a.rows[*point])).collect();
    for shares in a.later.iter_mut().map(|later| &mut later.of_points).chain([&mut a.shares]) {
        outside.iter().for_each(|point| shares[*point] = 0.0);
    }
    let law = law(contact, modulus, touching.mean_area);
    match SurfaceContact::new(contact.name.clone(), a, b, law, reach) {
        Ok(force) => Some(force),
        Err(error) => refuse(error.to_string(), "bodies with closed surfaces"),
    }
}

/// The triangles of a surface file, or the boundary of a volume mesh.
pub(super) fn read_surface(path: &Path) -> Result<TriangleSurface, String> {
    let (mesh, _) = souple_io::read_mesh(path).map_err(|error| error.to_string())?;
    match mesh.facet_surface() {
        Some(surface) if mesh.cell_count() == 0 => Ok(surface),
        _ if mesh.cell_count() > 0 => Ok(mesh.boundary_surface()),
        _ => Err("the file holds neither triangles nor cells".to_owned()),
    }
}
