//! Hands on the world: how firmly they hold, and what they do becomes edits.

use std::ops::Range;

use souple_engine::hand::hand_name;
use souple_engine::steppers::Stability;
use souple_engine::{Edit, Force, Grip, Hand, HeldTool, InHand, Tool, World};
use souple_math::Vec3;
use souple_mesh::Span;
use souple_scene::BodyInfo;

use super::Shown;
use super::shown::has_inside;
use crate::hub::PageId;
use crate::protocol::{HandShown, Holds, Wish};

/// A hand that holds something.
#[derive(Clone, Debug)]
struct Holding {
    page: PageId,
    hand: u32,
    holds: Holds,
    /// Systems that its force acts in.
    systems: Vec<usize>,
    /// Number in the world.
    number: u32,
    /// Where it took hold [m].
    start: Vec3,
    /// Where it is [m].
    place: Vec3,
    /// Where it is led to [m].
    goal: Vec3,
    /// How fast it goes there [m/s]; what gives way itself goes at once.
    speed: f64,
}

/// The frequency at which a whole body would swing on a hand of strength 1 [rad/s]: it follows within a quarter of a
/// second, and hangs by a hand's breadth under its own weight.
const FREQUENCY: f64 = 14.0;
/// Time over which a hand's damping takes the speed of what it holds [s].
const DAMPING_TIME: f64 = 0.02;
/// How fast a tool is led, in its size a second: a mouse jumps, and what is hard must not.
const TOOL_SPEED: f64 = 4.0;
/// Time in which a tool on its spring follows the hand [s].
const FOLLOWING: f64 = 0.01;
/// By which the most that a hand gives is the weight of bodies [m/s²].
const WEIGHT: f64 = 9.81;
/// Part of its radius by which a tool sinks in when it is pressed with that.
const SINKING: f64 = 0.1;
/// Between a tool and bodies: of what is smooth, and not wet.
const FRICTION: f64 = 0.3;
/// Share of the stable step's stiffness that a hand may take in an explicit system.
const EXPLICIT_SHARE: f64 = 0.1;

/// The grip of a hand on rows of a body.
pub fn grip(world: &World, body: &BodyInfo, rows: &[u32], strength: f64) -> Grip {
    let system = &world.model().systems[body.system];
    let masses = &system.mass.diagonal;
    let body_mass: f64 = mass_rows(body).iter().map(|row| masses[*row as usize]).sum();
    let mut stiffness = strength * body_mass * FREQUENCY * FREQUENCY;
    let mut damping = stiffness * DAMPING_TIME;
    if !matches!(system.stepper.stability(), Stability::Unconditional) {
        let timestep = system.stepper.interval(world.model().timestep(body.system));
        let origin = body.reduced.as_ref().map(|reduced| reduced.rows.start as u32);
        let of_origin = origin.as_ref().map_or(rows, std::slice::from_ref);
        let carriers = body.frames.as_ref().map_or(of_origin, |frames| &frames.rows);
        let lightest = carriers.iter().map(|row| masses[*row as usize]).fold(f64::INFINITY, f64::min);
        // k/n < 0.1 m/h², c/n < 0.1 m/h: well within what the step bears
        let bearable = EXPLICIT_SHARE * lightest * rows.len() as f64 / timestep;
        stiffness = stiffness.min(bearable / timestep);
        damping = damping.min(bearable);
    }
    Grip::on(rows, &world.rows(body.system).positions, stiffness, damping)
}

/// What a tool may meet: points, and the triangles between them.
#[derive(Debug, Default)]
pub struct TouchedSurface {
    pub rows: Vec<u32>,
    /// At rest [m].
    places: Vec<Vec3>,
    /// Corners among the rows.
    triangles: Vec<[u32; 3]>,
    /// Of each triangle.
    spans: Vec<Span>,
    /// Whether all of it is around something: what is thin is touched on both sides, of which triangles have one.
    pub is_closed: bool,
}

impl TouchedSurface {
    /// Of some bodies of one system.
    pub fn of<'a>(bodies: impl Iterator<Item = (&'a BodyInfo, &'a Shown)>) -> Self {
        let mut surface = Self { is_closed: true, ..Self::default() };
        bodies.for_each(|(body, shown)| surface.add(body, shown));
        surface
    }

    fn add(&mut self, body: &BodyInfo, shown: &Shown) {
        let (first, before) = (body.rows.start as u32, self.rows.len() as u32);
        let points = &shown.points[..shown.outer_count];
        self.rows.extend(points.iter().map(|point| first + point));
        self.places.extend(points.iter().map(|point| body.mesh.points[*point as usize]));
        self.triangles.extend(shown.triangles.iter().map(|corners| corners.map(|corner| before + corner)));
        self.spans.extend((0..shown.triangles.len()).map(|triangle| body.surface.span(triangle)));
        self.is_closed &= has_inside(&body.mesh);
    }

    /// From when until when each triangle is there, as tools are told; none where all stay.
    fn triangle_spans(&self) -> Vec<[f64; 2]> {
        told(&self.spans)
    }

    /// The same of each row.
    pub fn row_spans(&self) -> Vec<[f64; 2]> {
        let never = Span { from: f64::INFINITY, until: f64::NEG_INFINITY };
        let mut spans = vec![never; self.rows.len()];
        for (corners, span) in self.triangles.iter().zip(&self.spans) {
            for corner in corners {
                let of_row = &mut spans[*corner as usize];
                *of_row = Span { from: of_row.from.min(span.from), until: of_row.until.max(span.until) };
            }
        }
        // what has no triangles about it, as masses of networks, stays
        spans.iter_mut().filter(|span| **span == never).for_each(|span| *span = Span::ALWAYS);
        told(&spans)
    }

    /// Of a triangle [m²].
    fn mean_area(&self) -> f64 {
        let area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|corner| self.places[corner as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        self.triangles.iter().map(area).sum::<f64>() / self.triangles.len().max(1) as f64
    }
}

fn told(spans: &[Span]) -> Vec<[f64; 2]> {
    if spans.iter().all(|span| *span == Span::ALWAYS) {
        return Vec::new();
    }
    spans.iter().map(|Span { from, until }| [*from, *until]).collect()
}

/// The bodies of a system under a tool, as far as that says how firm it is.
pub struct Touched {
    /// [kg]
    mass: f64,
    /// The most at a point that the system's step bears [N/m]; infinite of steps that are solved for.
    bearable: f64,
}

impl Touched {
    pub fn new<'a>(world: &World, bodies: impl Iterator<Item = &'a BodyInfo>) -> Self {
        let (mut mass, mut bearable) = (0.0, f64::INFINITY);
        for body in bodies {
            let system = &world.model().systems[body.system];
            let rows = mass_rows(body);
            let masses = rows.iter().map(|row| system.mass.diagonal[*row as usize]);
            mass += masses.clone().sum::<f64>();
            if !matches!(system.stepper.stability(), Stability::Unconditional) {
                let timestep = system.stepper.interval(world.model().timestep(body.system));
                let lightest = masses.filter(|mass| *mass > 0.0).fold(f64::INFINITY, f64::min);
                bearable = f64::min(bearable, EXPLICIT_SHARE * lightest / (timestep * timestep));
            }
        }
        Self { mass, bearable }
    }

    /// Whether its steps are solved for: they bear any stiffness.
    pub fn is_implicit(&self) -> bool {
        self.bearable.is_infinite()
    }

    /// Of a tool at each of so many points that it may meet: a twentieth of them, pressed, bear the bodies as firmly as a hand of ten
    /// times the strength; in an explicit system, as much as its step bears [N/m].
    pub fn stiffness_of_points(&self, point_count: usize, strength: f64) -> f64 {
        let pressed = (point_count as f64 / 20.0).max(1.0);
        (10.0 * strength * self.mass * FREQUENCY * FREQUENCY / pressed).min(self.bearable)
    }

    /// How a hand holds a tool of a size [m], and the stiffness of a triangle of mean area: its spring is that of a hand on whole bodies, it
    /// gives no more than their weight, and as much as that presses the tool in by a part of its radius, as far as steps bear it.
    pub fn held_tool(&self, surface: &TouchedSurface, size: f64, strength: f64) -> (f64, HeldTool) {
        let spring = strength * self.mass * FREQUENCY * FREQUENCY;
        let limit = strength * self.mass * WEIGHT;
        let across = 0.25 * std::f64::consts::PI * size * size;
        let pressed = (across / surface.mean_area()).max(1.0);
        let stiffness = (limit / (pressed * SINKING * 0.5 * size)).min(self.bearable);
        let held = HeldTool {
            places: surface.places.clone(),
            triangles: surface.triangles.clone(),
            spans: surface.triangle_spans(),
            friction: FRICTION,
            // critically damped
            mass: spring * FOLLOWING * FOLLOWING,
            spring,
            damper: 2.0 * spring * FOLLOWING,
            limit,
        };
        (stiffness, held)
    }
}

/// Rows that have the mass of a body: points that frames or few other unknowns carry have none of their own.
fn mass_rows(body: &BodyInfo) -> Vec<u32> {
    match (&body.frames, &body.reduced) {
        (Some(frames), _) => frames.rows.clone(),
        (None, Some(reduced)) => vec![reduced.rows.start as u32],
        (None, None) => (body.rows.start as u32..body.rows.end as u32).collect(),
    }
}

/// What hands hold.
#[derive(Debug, Default)]
pub struct Hands {
    held: Vec<Holding>,
}

impl Hands {
    /// The edits by which a hand takes hold.
    pub fn grab(&mut self, page: PageId, hand: u32, system: usize, grip: Grip) -> Vec<Edit> {
        let mut edits = self.release(page, hand);
        let number = self.hold(page, hand, Holds::Body, vec![system], (grip.place, f64::INFINITY));
        edits.push(Edit::Grab { system, hand: number, grip });
        edits
    }

    /// The edits by which a hand takes a tool of a size [m], in each system one.
    pub fn touch(&mut self, page: PageId, hand: u32, size: f64, tools: Vec<(usize, Tool)>) -> Vec<Edit> {
        let mut edits = self.release(page, hand);
        let Some((_, first)) = tools.first() else { return edits };
        let systems = tools.iter().map(|(system, _)| *system).collect();
        let number = self.hold(page, hand, Holds::Tool, systems, (first.place, TOOL_SPEED * size));
        edits.extend(tools.into_iter().map(|(system, tool)| Edit::Touch { system, hand: number, tool }));
        edits
    }

    fn hold(
        &mut self,
        page: PageId,
        hand: u32,
        holds: Holds,
        systems: Vec<usize>,
        (place, speed): (Vec3, f64),
    ) -> u32 {
        // the first number that no hand has
        let number =
            (0..).find(|number| self.held.iter().all(|held| held.number != *number)).unwrap_or(u32::MAX);
        let goal = place;
        self.held.push(Holding { page, hand, holds, systems, number, start: place, place, goal, speed });
        number
    }

    /// Says where a hand is to go; see [`Hands::advance`].
    pub fn lead(&mut self, page: PageId, hand: u32, offset: Vec3) {
        if let Some(held) = self.held.iter_mut().find(|held| (held.page, held.hand) == (page, hand)) {
            held.goal = held.start + offset;
        }
    }

    /// The edits by which hands come nearer to where they are to go, in a time [s].
    pub fn advance(&mut self, duration: f64) -> Vec<Edit> {
        let mut edits = Vec::new();
        for held in self.held.iter_mut().filter(|held| held.place != held.goal) {
            let way = held.goal - held.place;
            let most = held.speed * duration;
            held.place =
                if way.length() <= most { held.goal } else { held.place + way * (most / way.length()) };
            let (hand, place) = (held.number, held.place);
            edits.extend(held.systems.iter().map(|system| Edit::MoveHand { system: *system, hand, place }));
        }
        edits
    }

    pub fn release(&mut self, page: PageId, hand: u32) -> Vec<Edit> {
        let Some(at) = self.held.iter().position(|held| (held.page, held.hand) == (page, hand)) else {
            return Vec::new();
        };
        let Holding { systems, number, .. } = self.held.remove(at);
        systems.into_iter().map(|system| Edit::Release { system, hand: number }).collect()
    }

    /// The edits by which a page that left lets go.
    pub fn release_all(&mut self, page: PageId) -> Vec<Edit> {
        let hands: Vec<u32> =
            self.held.iter().filter(|held| held.page == page).map(|held| held.hand).collect();
        hands.into_iter().flat_map(|hand| self.release(page, hand)).collect()
    }

    /// Page and hand of each tool.
    pub fn tools(&self) -> impl Iterator<Item = (PageId, u32)> {
        let tools = self.held.iter().filter(|held| held.holds == Holds::Tool);
        tools.map(|held| (held.page, held.hand))
    }

    /// The force of a hand, of several the first.
    pub fn force_of<'w>(&self, world: &'w World, page: PageId, hand: u32) -> Option<&'w dyn Force> {
        let held = self.held.iter().find(|held| (held.page, held.hand) == (page, hand))?;
        let name = hand_name(held.number);
        let forces = &world.model().systems[*held.systems.first()?].forces;
        forces.iter().rev().find(|force| force.name() == name).map(AsRef::as_ref)
    }

    /// What there is to see of them.
    pub fn shown(&self, world: &World) -> Vec<HandShown> {
        let shown = |held: &Holding| {
            let Holding { page, hand, holds, place, goal, .. } = *held;
            // what gives way goes at once, as soon as there is a step
            let leads_to = if holds == Holds::Body { goal } else { place };
            let seen = HandShown { page, hand, holds, held: place, place: leads_to, force: Vec3::ZERO };
            match holds {
                // one on a spring is not where it is led to
                Holds::Tool => {
                    let stands = tool_of(world, held).map_or(place, |tool| tool.tool);
                    Some(HandShown { held: stands, force: pressed(held, world), ..seen })
                }
                Holds::Body => {
                    let hand: &Hand = self.force_of(world, page, hand)?.as_any().downcast_ref()?;
                    let rows = world.rows(*held.systems.first()?);
                    let force = hand.pull(&rows.positions, &rows.velocities);
                    Some(HandShown { held: hand.middle(&rows.positions), force, ..seen })
                }
            }
        };
        self.held.iter().filter_map(shown).collect()
    }
}

/// How a tool on a spring stands; `None` of one that is where it is led to.
fn tool_of(world: &World, held: &Holding) -> Option<InHand> {
    let (force, at) = world.force_named(*held.systems.first()?, &hand_name(held.number))?;
    force.in_hand(&at)
}

/// What a tool does to all bodies [N].
fn pressed(held: &Holding, world: &World) -> Vec3 {
    let (name, mut sum) = (hand_name(held.number), Vec3::ZERO);
    for system in &held.systems {
        world.visit_forces(*system, &mut |force, at| {
            if force.name() == name {
                force.visit_contacts(at, &mut |point| sum += point.normal_force + point.friction);
            }
        });
    }
    sum
}

/// Edits that need no memory of hands.
///
/// # Errors
/// Points of the body cannot be held.
pub fn edits_of(wish: &Wish, world: &World, body: &BodyInfo, shown: &Shown) -> Result<Vec<Edit>, String> {
    let system = body.system;
    let kinematics = &world.model().systems[system].kinematics;
    let blocks = |points: &[u32]| {
        let row = |point: &u32| body.own_row(shown.points[*point as usize]);
        points.iter().filter_map(row).filter_map(|row| kinematics.point_block(row)).collect::<Vec<u32>>()
    };
    Ok(match wish {
        Wish::Pin { .. } if body.frames.is_some() => {
            return Err(format!(
                "frames carry body `{}`: its points cannot be pinned; hold them by a hand",
                body.name
            ));
        }
        Wish::Pin { .. } if body.reduced.is_some() => {
            return Err(format!(
                "body `{}` moves in few unknowns: its points cannot be pinned; hold them by a hand",
                body.name
            ));
        }
        Wish::Pin { .. } if body.level_count(world).is_some() => {
            let why = "points of its other meshes would go on without those seen";
            return Err(format!("body `{}` has levels: {why}; hold it by a hand", body.name));
        }
        Wish::Pin { points, .. } if blocks(points).is_empty() => {
            return Err(format!("these points of body `{}` hang on another body; pin that one", body.name));
        }
        Wish::Pin { points, .. } => {
            blocks(points).into_iter().map(|block| Edit::Pin { system, block }).collect()
        }
        Wish::Unpin { points, .. } => {
            blocks(points).into_iter().map(|block| Edit::Unpin { system, block }).collect()
        }
        Wish::Throw { velocity, .. } => {
            let block = |row: &u32| kinematics.block_of(*row);
            // neighbours together: a body of points is one edit
            let mut runs: Vec<Range<u32>> = Vec::new();
            for block in body.moving_rows(world).iter().map(block) {
                match runs.last_mut() {
                    Some(run) if run.end == block => run.end += 1,
                    _ => runs.push(block..block + 1),
                }
            }
            runs.into_iter().map(|blocks| Edit::Push { system, blocks, velocity: *velocity }).collect()
        }
        _ => Vec::new(),
    })
}
