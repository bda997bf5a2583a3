//! Watches masses that go through what should stop them.
//!
//! A penalty is a spring: a wall that is thin, or soft, holds no more than the work of pressing it to its middle, and beyond that pushes
//! out on the other side. A mass that is faster than half of a wall in a step is not held either. It is told once of each contact.

use souple_engine::{Configuration, Force, System, World};
use souple_math::{Mat3, Vec3};
use souple_models::contact::ShapeContact;
use souple_models::contact::passage::{Passage, passage};
use souple_scene::BodyInfo;
use souple_table::{counted, four_digits};

/// Contacts of masses with shapes, and where the masses were in the place of each.
#[derive(Clone, Debug)]
pub struct Passages {
    watched: Vec<Watched>,
    /// [s]
    time: f64,
}

#[derive(Clone, Debug)]
struct Watched {
    system: usize,
    contact: String,
    /// Of its points, in their order, in the place of the shape [m].
    places: Vec<Vec3>,
    /// Of each, whether all of its ways are prescribed: nothing holds it back.
    is_led: Vec<bool>,
}

/// The first way through a wall, of how many of a period.
struct Through {
    row: usize,
    passage: Passage,
    /// Across the wall [m/s].
    speed: f64,
    count: u64,
    /// Of the contact for that mass [N/m].
    stiffness: f64,
    /// At which touching starts [m].
    thickness: f64,
}

impl Passages {
    /// Watches the masses of networks.
    pub fn new(world: &World, bodies: &[BodyInfo]) -> Self {
        let mut watched = Vec::new();
        for system in 0..world.model().systems.len() {
            world.visit_forces(system, &mut |force, at| {
                let Some(contact) = watchable(force) else { return };
                let is_of_masses =
                    contact.points().iter().all(|point| mass_of(bodies, system, point.row).is_some());
                if is_of_masses {
                    let places = contact.places(at).collect();
                    let is_led = contact
                        .points()
                        .iter()
                        .map(|point| is_led(&world.model().systems[system], point.row));
                    let (contact, is_led) = (force.name().to_owned(), is_led.collect());
                    watched.push(Watched { system, contact, places, is_led });
                }
            });
        }
        Self { watched, time: world.time() }
    }

    /// Looks at where masses are now; what there is to say of contacts that they pass for the first time.
    pub fn look(&mut self, world: &World, bodies: &[BodyInfo]) -> Vec<String> {
        let lasted = world.time() - self.time;
        self.time = world.time();
        let mut said = Vec::new();
        self.watched.retain_mut(|watched| {
            let Some(through) = watched.follow(world, lasted) else { return true };
            let timestep = world.model().timestep(watched.system);
            let mass = world.model().systems[watched.system].mass.diagonal[through.row];
            let (body, number) = mass_of(bodies, watched.system, through.row as u32).unwrap_or(("", 0));
            said.push(through.message(&watched.contact, (body, number, mass), (world.time(), timestep)));
            false
        });
        said
    }
}

impl Watched {
    fn follow(&mut self, world: &World, lasted: f64) -> Option<Through> {
        let mut found: Option<Through> = None;
        world.visit_forces(self.system, &mut |force, at| {
            if force.name() == self.contact
                && let Some(contact) = watchable(force)
            {
                found = found.take().or_else(|| self.follow_contact(contact, at, lasted));
            }
        });
        found
    }

    fn follow_contact(&mut self, contact: &ShapeContact, at: &Configuration, lasted: f64) -> Option<Through> {
        let mut found: Option<Through> = None;
        let points = contact.points().iter().zip(&self.is_led);
        for (((point, is_led), before), now) in points.zip(&mut self.places).zip(contact.places(at)) {
            let from = std::mem::replace(before, now);
            if *is_led {
                continue;
            }
            let Some(passage) = passage(contact.shape(), from, now) else { continue };
            match &mut found {
                Some(through) => through.count += 1,
                None => {
                    found = Some(Through {
                        row: point.row as usize,
                        speed: if lasted > 0.0 { passage.normal.dot(from - now).abs() / lasted } else { 0.0 },
                        passage,
                        count: 1,
                        stiffness: contact.law().stiffness * point.share,
                        thickness: contact.law().thickness,
                    });
                }
            }
        }
        found
    }
}

impl Through {
    fn message(
        &self,
        contact: &str,
        (body, number, mass): (&str, usize, f64),
        (time, timestep): (f64, f64),
    ) -> String {
        let Self { passage: Passage { width, .. }, speed, count, stiffness, thickness, .. } = *self;
        // what is left of its motion in the middle, ½ m v², has to be stored before: ½ k p² with all that is pressed in
        let deepest = 0.5 * width + thickness;
        let own = mass * speed * speed / (deepest * deepest);
        // what leaps has not felt what there is
        let leaps = speed * timestep > 0.5 * width;
        let enough = if leaps { own.max(stiffness) } else { stiffness + own };
        let others = match count {
            1 => String::new(),
            count => format!(" and {} with it", counted(count - 1, "other")),
        };
        let cure = match leaps {
            // also as long as the contact itself bears
            true => format!(
                "steps of less than {} s",
                four_digits((0.5 * width / speed).min(2.0 * (mass / enough).sqrt()))
            ),
            false => String::new(),
        };
        let cure = match enough > stiffness {
            true if leaps => format!(
                "about {} N/m, where {} are given, in {cure} hold",
                four_digits(enough),
                four_digits(stiffness)
            ),
            true => {
                format!("about {} N/m, where {} are given, hold", four_digits(enough), four_digits(stiffness))
            }
            false => format!("{cure} hold"),
        };
        format!(
            "went through a wall: by {} s mass {number} of `{body}`{others} was over the middle of what it touches by contact `{contact}`, {} m thick \
             there, at {} m/s, and is pushed out on the other side; {cure} it there, or a thicker wall, or a plane with a `sense`, which nothing passes",
            four_digits(time),
            four_digits(width),
            four_digits(speed),
        )
    }
}

/// Whether constraints leave a row no way of its own.
fn is_led(system: &System, row: u32) -> bool {
    system.constraints.iter().any(|constraint| {
        constraint.free == Mat3::ZERO && system.kinematics.row_of_block(constraint.block) == Some(row)
    })
}

/// Contacts whose shape is where its contact says, and not what rows bear.
fn watchable(force: &dyn Force) -> Option<&ShapeContact> {
    let contact = force.as_any().downcast_ref::<ShapeContact>()?;
    contact.shape().bearers().is_empty().then_some(contact)
}

/// The network that a row is a mass of, and the number of the mass.
pub(crate) fn mass_of(bodies: &[BodyInfo], system: usize, row: u32) -> Option<(&str, usize)> {
    let row = row as usize;
    let body = bodies.iter().find(|body| body.system == system && body.rows.contains(&row))?;
    body.is_network().then(|| (body.name.as_str(), row - body.rows.start))
}
