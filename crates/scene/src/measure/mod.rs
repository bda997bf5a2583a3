//! Probes at work: a quantity read off a running world.
//!
//! Each subject of the table of quantities has a file that measures it.

mod against;
mod body;
mod cells;
mod contact;
mod contour;
mod hand;
mod levels;
mod masses;
mod points;
mod reaction;
mod skin;

pub use contour::ContourInfo;
pub use levels::Workload;
pub use reaction::power_from_outside;

use std::collections::BTreeMap;

use souple_engine::{Force, World};
use souple_math::Vec3;
use souple_mesh::Mesh;

use self::against::Reference;
use self::masses::{Mould, Multitude};
use crate::compile::{Draft, Placed, hold_name, solid_name};
use crate::diagnostic::Code;
use crate::scene::{DressInfo, HandInfo, MarksInfo, SkinInfo};
use crate::spec::network::{MassGroup, Places};
use crate::spec::octree::OctreeSpec;
use crate::spec::probe::{Component, Probe};
use crate::spec::quantity::{
    BodyQuantity, BoneQuantity, CellQuantity, ContourQuantity, HandQuantity, LevelsQuantity, MassesQuantity,
    Momentum, PointQuantity, Rank, Reduction, SkinQuantity, Subject, WorldQuantity,
};

/// A probe that knows where to read.
#[derive(Clone, Debug)]
pub struct ProbeInfo {
    pub name: String,
    /// SI unit of its values.
    pub unit: &'static str,
    /// The quantity's name.
    pub quantity: &'static str,
    /// The date from which on extremes are taken [s].
    pub since: f64,
    /// The probe whose values its plot is over; over time where `None`.
    pub over: Option<String>,
    rank: Rank,
    component: Option<Component>,
    reduction: Reduction,
    target: Target,
    /// What the values at points are the differences from.
    against: Option<Reference>,
}

/// What is read, and where.
#[derive(Clone, Debug)]
enum Target {
    World(WorldQuantity),
    /// Momentum of the world; angular momentum is about a place [m].
    WorldMomentum(Momentum, Vec3),
    Points(PointQuantity, Part),
    Body(BodyQuantity, Part),
    BodyMomentum(Momentum, Part),
    Cells(CellQuantity, CellPart),
    Skin(SkinQuantity, SkinInfo),
    Levels(LevelsQuantity, LevelsPart),
    Hand(HandQuantity, HandInfo),
    Bone(BoneQuantity, BonePart),
    Contour(ContourQuantity, usize, [ContourInfo; 2]),
    Masses(Box<Multitude>),
}

/// Points of a body.
#[derive(Clone, Debug)]
struct Part {
    system: usize,
    /// Among the rows of the system.
    rows: Vec<u32>,
    /// Rows of the unknowns that the points are, where they are any; else as `rows`.
    held: Vec<u32>,
    /// Whether points of the system hang on others.
    hangs: bool,
    /// Rows of coarser points of a body with levels in the same region, for what holds them.
    coarser: Vec<u32>,
    /// Where the rows started [m].
    starts: Vec<Vec3>,
    /// All rows of the body, for its centre of mass.
    whole: std::ops::Range<usize>,
    /// Only this contact.
    contact: Option<String>,
    /// Only this constraint.
    constraint: Option<String>,
    /// The place that moments are taken about [m]; the body's centre of mass where `None`.
    about: Option<Vec3>,
    /// The force that holds its pinned points, of a body of frames.
    hold: Option<String>,
    /// The marks on the surface and the points that are looked at, of a probe of marks.
    marks: Option<(MarksInfo, Vec<u32>)>,
}

impl Part {
    /// Whether it is of the contact of that name too.
    fn has_contact(&self, name: &str) -> bool {
        self.contact.as_deref().is_none_or(|contact| contact == name)
    }
}

/// What of a body follows a bone.
#[derive(Clone, Debug)]
struct BonePart {
    system: usize,
    /// Rows of the origins of frames.
    frames: Vec<u32>,
    /// Pinned points: their rows, those of the unknowns that they are, and the axes along which the bone leads them.
    pinned: Vec<PinnedPoint>,
    /// Whether points of the system hang on others.
    hangs: bool,
    /// The force that holds pinned points, of a body of frames.
    hold: Option<String>,
    /// The place that torques are taken about [m].
    about: Vec3,
}

/// A point that a pin holds.
#[derive(Clone, Copy, Debug)]
struct PinnedPoint {
    row: u32,
    /// That of the unknown which it is.
    held: u32,
    /// Ones along the axes that are held.
    axes: Vec3,
}

/// Cells of the solid of this name.
#[derive(Clone, Debug)]
struct CellPart {
    system: usize,
    solid: String,
    cells: Vec<u32>,
}

/// Levels of the body with the force of this name.
#[derive(Clone, Debug)]
struct LevelsPart {
    system: usize,
    force: String,
    /// Only this one.
    level: Option<usize>,
    /// Of active points: those rows that are looked at, ascending.
    rows: Vec<u32>,
    /// What it wears.
    dress: Option<DressInfo>,
    /// What is asked of its meshes, where it is of them.
    of_meshes: f64,
    /// Of a nearness: the distances at rest of the points of the finest mesh from its place [m].
    distances: Vec<f64>,
}

/// What a probe reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measurement {
    Number(f64),
    Vector(Vec3),
}

/// A quantity at each point of a part.
enum PointValues {
    Numbers(Vec<f64>),
    Vectors(Vec<Vec3>),
}

impl Measurement {
    /// One number, or three.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Number(number) => vec![*number],
            Self::Vector(vector) => vector.to_array().to_vec(),
        }
    }
}

impl ProbeInfo {
    /// `None` where the body or region was refused.
    pub(crate) fn compile(probe: &Probe, draft: &Draft) -> Option<Self> {
        let against = match &probe.against {
            Some(against) => Some(Reference::compile(against, probe, draft)?),
            None => None,
        };
        let target = match (probe.quantity.build.subject, &probe.body) {
            (Subject::World(quantity), _) => Target::World(quantity),
            (Subject::Skin(quantity), _) => {
                let name = probe.skin.as_deref()?;
                let info = draft.skins.iter().find(|skin| skin.name == name)?;
                if quantity == SkinQuantity::Distance && info.skin.target.is_none() {
                    let message = format!("skin `{name}` has no `parts` that it is drawn to");
                    draft.log.add(
                        Code::Conflict,
                        &probe.site,
                        message,
                        "another quantity, or [[skins.NAME.parts]]",
                    );
                    return None;
                }
                Target::Skin(quantity, info.clone())
            }
            (Subject::Hand(quantity), _) => {
                let name = probe.hand.as_deref()?;
                let hand = draft.spec.hands.iter().find(|hand| hand.name == name)?;
                if quantity == HandQuantity::ToolJump && hand.touch.imposed.is_none() {
                    let message =
                        format!("the tool of hand `{name}` holds no points, whose force could jump");
                    let expected = "a hand whose `touch` has `response = \"imposed\"`, or `hand.jump`";
                    draft.log.add(Code::Conflict, &probe.site, message, expected);
                    return None;
                }
                Target::Hand(quantity, draft.hands.iter().find(|hand| hand.name == name)?.clone())
            }
            (Subject::Bone(quantity), _) => Target::Bone(quantity, bone_part(probe, draft)?),
            (Subject::BodyOrWorld(momentum), None) => {
                Target::WorldMomentum(momentum, probe.about.unwrap_or(Vec3::ZERO))
            }
            (Subject::BodyOrWorld(momentum), Some(_)) => {
                Target::BodyMomentum(momentum, matter(probe, draft)?)
            }
            (Subject::Points(quantity), _) => Target::Points(quantity, part(probe, draft)?),
            (Subject::Body(quantity), _) => Target::Body(quantity, matter(probe, draft)?),
            (Subject::Cells(quantity), _) => Target::Cells(quantity, cell_part(probe, draft)?),
            (Subject::Contour(quantity), _) => {
                let body = draft.body(probe.body.as_deref()?)?;
                let own = contour::named(probe.contour.as_deref()?, probe, body, draft)?;
                let from = match &probe.from {
                    Some(from) => contour::named(from, probe, body, draft)?,
                    None => own.clone(),
                };
                Target::Contour(quantity, body.system, [own, from])
            }
            (Subject::Masses(quantity), _) => {
                let gravity = draft.spec.world.gravity.as_ref();
                let weight = gravity.map_or(Vec3::ZERO, |g| {
                    Vec3::from_array([0, 1, 2].map(|axis: usize| g[axis].evaluate(&[0.0])))
                });
                let up = (-weight).try_normalised().unwrap_or(Vec3::Z);
                let (part, within) = (part(probe, draft)?, probe.within.unwrap_or(0.0));
                if matches!(quantity, MassesQuantity::Temperature | MassesQuantity::Bonds) {
                    has_heat(probe, draft)?;
                }
                let mould = match quantity {
                    MassesQuantity::Gap => Some(mould(probe, draft)?),
                    _ => None,
                };
                Target::Masses(Box::new(Multitude::new(quantity, part, within, up, mould)))
            }
            (Subject::Levels(quantity), _) => Target::Levels(quantity, levels_part(probe, draft)?),
        };
        Some(Self {
            name: probe.name.clone(),
            unit: probe.quantity.build.unit,
            quantity: probe.quantity.name,
            since: probe.since,
            rank: probe.rank(),
            component: probe.component,
            reduction: probe.reduction,
            target,
            over: probe.over.clone(),
            against,
        })
    }

    /// Whether its values are vectors.
    pub fn gives_vector(&self) -> bool {
        self.rank == Rank::Vector
    }

    /// The quantity at the committed state.
    pub fn measure(&self, world: &mut World) -> Measurement {
        match &self.target {
            Target::World(quantity) => Measurement::Number(of_world(*quantity, world)),
            Target::Skin(quantity, skin) => Measurement::Number(skin::measure(*quantity, skin, world)),
            Target::Contour(quantity, system, contours) => {
                Measurement::Number(contour::measure(*quantity, &world.rows(*system).positions, contours))
            }
            Target::Masses(asked) => Measurement::Number(asked.measure(world)),
            Target::Levels(quantity, part) => Measurement::Number(levels::measure(*quantity, part, world)),
            Target::Hand(quantity, hand) => match hand::measure(*quantity, hand, world) {
                Measurement::Vector(vector) => self.vector(vector),
                number => number,
            },
            Target::Bone(quantity, part) => self.vector(reaction::of_bone(*quantity, part, world)),
            Target::WorldMomentum(momentum, about) => {
                let (linear, angular) = world.momentum();
                self.vector(match momentum {
                    Momentum::Linear => linear,
                    Momentum::Angular => angular - about.cross(linear),
                })
            }
            Target::BodyMomentum(momentum, part) => self.vector(body::momentum(*momentum, part, world)),
            Target::Body(quantity, part) => match body::measure(*quantity, part, world) {
                Measurement::Vector(vector) => self.vector(vector),
                number => number,
            },
            Target::Points(quantity, part) => {
                let mut values = points::measure(*quantity, part, world);
                if let (Some(reference), PointValues::Vectors(vectors)) = (&self.against, &mut values) {
                    reference.take_from(vectors, *quantity, part, world);
                }
                self.reduce_points(&values)
            }
            Target::Cells(quantity, part) => {
                let (numbers, volumes) = cells::measure(*quantity, part, world);
                Measurement::Number(reduced(&numbers, &volumes, self.reduction))
            }
        }
    }

    fn vector(&self, vector: Vec3) -> Measurement {
        match self.component {
            Some(component) => Measurement::Number(component.of(vector)),
            None => Measurement::Vector(vector),
        }
    }

    fn reduce_points(&self, values: &PointValues) -> Measurement {
        let reduce = |numbers: &[f64]| {
            Measurement::Number(reduced(numbers, &vec![1.0; numbers.len()], self.reduction))
        };
        match (values, self.component) {
            (PointValues::Numbers(numbers), _) => reduce(numbers),
            (PointValues::Vectors(vectors), Some(component)) => {
                let numbers: Vec<f64> = vectors.iter().map(|vector| component.of(*vector)).collect();
                reduce(&numbers)
            }
            (PointValues::Vectors(vectors), None) => {
                let sum: Vec3 = vectors.iter().copied().sum();
                let divisor = if self.reduction == Reduction::Mean { vectors.len() as f64 } else { 1.0 };
                Measurement::Vector(sum / divisor)
            }
        }
    }
}

/// The one shape that masses of a probe fill.
fn mould(probe: &Probe, draft: &Draft) -> Option<Mould> {
    let body = draft.body(probe.body.as_deref()?)?;
    let expected = "`region` with masses of one group that has `fill`";
    let Some(network) = &body.spec.network else {
        let message = format!("body `{}` is no network: no balls fill it", body.spec.name);
        draft.log.add(Code::Conflict, &probe.site, message, expected);
        return None;
    };
    let points: Option<Vec<u32>> = probe.region.as_ref().map(|region| draft.selector(body).points(region));
    let is_asked = |group: &&MassGroup| {
        let Some(numbers) = network.numbers_of(&group.name) else { return false };
        points.as_ref().is_none_or(|points| points.iter().any(|point| numbers.contains(point)))
    };
    let filled = network.masses.iter().filter(is_asked).filter_map(|group| match &group.places {
        Places::Filled(fill) => Some((group, fill.filled.get()?)),
        _ => None,
    });
    let filled: Vec<_> = filled.collect();
    match filled[..] {
        [(group, filled)] => {
            let placements = group.placements.iter().chain([&body.spec.placement]).cloned().collect();
            Some(Mould::new(filled, placements))
        }
        _ => {
            let message = format!(
                "{} of the masses asked about fill a shape",
                souple_table::counted(filled.len() as u64, "group")
            );
            draft.log.add(Code::Conflict, &probe.site, message, expected);
            None
        }
    }
}

/// The points that a probe is of.
fn part(probe: &Probe, draft: &Draft) -> Option<Part> {
    let body = draft.body(probe.body.as_deref()?)?;
    let points: Vec<u32> = match &probe.region {
        Some(region) => draft.selector(body).points(region),
        None => (0..body.mesh.points.len() as u32).collect(),
    };
    let is_held = matches!(probe.quantity.build.subject, Subject::Points(PointQuantity::Reaction));
    let rows_in = |level: &Placed| -> Vec<u32> {
        let first = level.rows.start as u32;
        let points = probe.region.as_ref().map(|region| draft.selector(level).points(region));
        let points = points.unwrap_or_else(|| (0..level.mesh.points.len() as u32).collect());
        points.into_iter().map(|point| first + point).collect()
    };
    let own = |point: &u32| body.own_row(*point).unwrap_or(body.rows.start as u32 + point);
    // what other quantities do not read is not kept, of a million balls
    let reads_starts =
        matches!(probe.quantity.build.subject, Subject::Points(_) | Subject::Masses(MassesQuantity::Kept));
    let of_points: &[u32] = if reads_starts { &points } else { &[] };
    let joins =
        |other: &Placed| other.system == body.system && (other.hanging.is_some() || other.reduced.is_some());
    // pins of a body of modes hold its frame
    let frame = (is_held && body.moves_in_modes()).then(|| body.mass_rows().start as u32);
    let held = frame.map_or_else(|| of_points.iter().map(own).collect(), |origin| vec![origin]);
    let marks = match probe.quantity.build.is_of_marks() {
        true => Some(marks_of(probe, body, &points, draft)?),
        false => None,
    };
    Some(Part {
        system: body.system,
        held,
        hangs: draft.bodies.iter().any(joins),
        coarser: body.levels_of().filter(|_| is_held).flat_map(rows_in).collect(),
        rows: points.iter().map(|point| body.rows.start as u32 + point).collect(),
        starts: of_points.iter().map(|point| body.mesh.points[*point as usize]).collect(),
        whole: body.mass_rows(),
        contact: probe.contact.clone(),
        constraint: probe.constraint.clone(),
        about: probe.about,
        hold: body.is_held_by_springs().then(|| hold_name(&body.spec.name)),
        marks,
    })
}

/// The marks on the surface of a body, and which of some of its points are there; `None` where there are none, which is reported.
fn marks_of(probe: &Probe, body: &Placed, points: &[u32], draft: &Draft) -> Option<(MarksInfo, Vec<u32>)> {
    let Some(marks) = draft.marks.iter().find(|marks| marks.body == body.spec.name) else {
        let message = format!("the surface of body `{}` shows no marks", body.spec.name);
        draft.log.add(Code::Conflict, &probe.site, message, "a body with `marks`");
        return None;
    };
    if probe.quantity.build.is_of_blood() && !marks.marks.bleeds() {
        let message = format!("the surface of body `{}` does not bleed", body.spec.name);
        draft.log.add(Code::Conflict, &probe.site, message, "a body with `marks.bleeding`");
        return None;
    }
    let is_marked = |point: &u32| marks.marks.is_marked(*point as usize);
    let marked: Vec<u32> = points.iter().copied().filter(is_marked).collect();
    if marked.is_empty() {
        let message = format!("this region holds no point on the surface of body `{}`", body.spec.name);
        let site = probe.region.as_ref().map_or(&probe.site, |region| &region.site);
        draft.log.add(Code::EmptyRegion, site, message, "a region that reaches the surface");
        return None;
    }
    Some((marks.clone(), marked))
}

/// The rows that hold the mass of what a probe is of; `None` for a part of a body of frames, whose mass is not parted.
fn matter(probe: &Probe, draft: &Draft) -> Option<Part> {
    let part = part(probe, draft)?;
    let body = draft.body(probe.body.as_deref()?)?;
    if !body.is_carried() {
        return Some(part);
    }
    if let Some(region) = &probe.region {
        let message =
            format!("body `{}` moves in few unknowns, which hold its mass as a whole", body.spec.name);
        draft.log.add(
            Code::Conflict,
            &region.site,
            message,
            "this quantity of the whole body, without a region",
        );
        return None;
    }
    Some(Part { rows: body.mass_rows().map(|row| row as u32).collect(), ..part })
}

/// Whether masses of the body have temperatures; `None` where they have none, which is reported.
fn has_heat(probe: &Probe, draft: &Draft) -> Option<()> {
    let body = draft.body(probe.body.as_deref()?)?;
    let crowds = body.spec.network.iter().flat_map(|network| &network.crowds);
    if crowds.into_iter().all(|crowd| crowd.fusible.is_none()) {
        let message =
            format!("nothing of body `{}` melts: it has no temperature and no bonds", body.spec.name);
        draft.log.add(Code::Conflict, &probe.site, message, "a network with a crowd that is `fusible`");
        return None;
    }
    Some(())
}

/// What of a body follows a bone: frames, and what its pins hold; `None` where nothing does, which is reported.
fn bone_part(probe: &Probe, draft: &Draft) -> Option<BonePart> {
    let body = draft.body(probe.body.as_deref()?)?;
    let name = probe.bone.as_deref()?;
    let bound = body.spec.frames.iter().flat_map(|frames| &frames.bones);
    let of_pins = body.spec.pins.iter().filter_map(|pin| pin.bone.as_deref());
    let followed: Vec<&str> = bound.clone().map(|bound| bound.bone.as_str()).chain(of_pins).collect();
    if !followed.contains(&name) {
        let hint = crate::keys::did_you_mean(name, followed.iter().copied());
        let message = format!("nothing of body `{}` follows a bone `{name}`{hint}", body.spec.name);
        let expected = "a bone that pins of the body name, or its `frames.bones`";
        draft.log.add(Code::UnknownName, &probe.site, message, expected);
        return None;
    }
    let numbers = bound.filter(|bound| bound.bone == name).flat_map(|bound| &bound.frames);
    let rows = body.frames.as_ref().map_or(&[][..], |frames| &frames.rows);
    // frames that are not there are reported where they are bound
    let frames = numbers.map(|number| rows.get(*number as usize).copied()).collect::<Option<_>>()?;
    let hangs = |other: &Placed| other.system == body.system && other.hanging.is_some();
    Some(BonePart {
        system: body.system,
        frames,
        pinned: body.levels_of().chain([body]).flat_map(|level| pinned_to(name, level, draft)).collect(),
        hangs: draft.bodies.iter().any(hangs),
        hold: body.is_held_by_springs().then(|| hold_name(&body.spec.name)),
        about: probe.about.unwrap_or(Vec3::ZERO),
    })
}

/// Points of a body that its pins tie to a bone, along the axes that no pin before them holds.
fn pinned_to(bone: &str, body: &Placed, draft: &Draft) -> Vec<PinnedPoint> {
    let mut taken: BTreeMap<u32, [bool; 3]> = BTreeMap::new();
    let mut pinned = Vec::new();
    for pin in &body.spec.pins {
        let Some(region) = &pin.region else { continue };
        for point in draft.selector(body).points(region) {
            let taken = taken.entry(point).or_default();
            let own: [bool; 3] = std::array::from_fn(|axis| pin.axes[axis] && !taken[axis]);
            (0..3).for_each(|axis| taken[axis] |= own[axis]);
            if pin.bone.as_deref() == Some(bone) {
                let row = body.rows.start as u32 + point;
                let axes = Vec3::from_array(own.map(|held| if held { 1.0 } else { 0.0 }));
                pinned.push(PinnedPoint { row, held: body.own_row(point).unwrap_or(row), axes });
            }
        }
    }
    pinned
}

/// The levels that a probe is of; `None` where its body has not so many, which is reported.
fn levels_part(probe: &Probe, draft: &Draft) -> Option<LevelsPart> {
    let body = draft.body(probe.body.as_deref()?)?;
    let count = body.levels.as_ref().map_or(0, |levels| levels.coarser.len() + 1);
    let is_there = probe.level.is_none_or(|level| level < count);
    if count == 0 || !is_there {
        let message =
            format!("body `{}` has {}", body.spec.name, souple_table::counted(count as u64, "level"));
        draft.log.add(Code::Conflict, &probe.site, message, "a body with `levels`, and one of them");
        return None;
    }
    let dress = draft.dresses.iter().find(|dress| dress.body == body.spec.name).cloned();
    if probe.quantity.build.subject == Subject::Levels(LevelsQuantity::Jump) && dress.is_none() {
        let message = format!("body `{}` wears no dress", body.spec.name);
        draft.log.add(Code::Conflict, &probe.site, message, "a body whose `levels` have a `dress`");
        return None;
    }
    if probe.quantity.build.is_of_particles()
        && !body.spec.octree.as_ref().is_some_and(OctreeSpec::is_adaptive)
    {
        let message =
            format!("body `{}` is no octree whose particles see finer and coarser ones", body.spec.name);
        draft.log.add(
            Code::Conflict,
            &probe.site,
            message,
            "a body with an `octree` of `variant = \"adaptive\"`",
        );
        return None;
    }
    if probe.quantity.build.subject == Subject::Levels(LevelsQuantity::Variation) && !follows_criterion(body)
    {
        let message = format!("no criterion chooses the levels of body `{}` by a variation", body.spec.name);
        draft.log.add(Code::Conflict, &probe.site, message, "a body with `levels`, without `fixed`");
        return None;
    }
    if probe.quantity.build.is_of_meshes() && body.spec.octree.is_some() {
        let message = format!("particles of body `{}` are no tetrahedra", body.spec.name);
        draft.log.add(Code::Conflict, &probe.site, message, "a body with `levels`");
        return None;
    }
    let meshes: Vec<&Mesh> = body.levels_of().chain([body]).map(|level| &level.mesh).collect();
    let wanted = probe.level.map_or(&meshes[..], |level| &meshes[level..=level]);
    let of_meshes = match probe.quantity.build.subject {
        Subject::Levels(quantity) if probe.quantity.build.is_of_meshes() => {
            levels::of_meshes(quantity, &body.mesh, wanted)
        }
        _ => 0.0,
    };
    let is_near = probe.quantity.build.subject == Subject::Levels(LevelsQuantity::Nearness);
    let distance = |x: &Vec3| (*x - probe.about.unwrap_or(Vec3::ZERO)).length();
    Some(LevelsPart {
        system: body.system,
        force: solid_name(&body.spec.name),
        level: probe.level,
        rows: if probe.quantity.build.is_of_active_points() {
            rows_of_levels(probe, body, draft)
        } else {
            Vec::new()
        },
        dress,
        of_meshes,
        distances: if is_near { body.mesh.points.iter().map(distance).collect() } else { Vec::new() },
    })
}

fn follows_criterion(body: &Placed) -> bool {
    body.spec.levels.as_ref().is_some_and(|levels| levels.fixed.is_none())
}

/// Rows of the points of a body's meshes, or of one of them, that are in the region of a probe, ascending.
fn rows_of_levels(probe: &Probe, body: &Placed, draft: &Draft) -> Vec<u32> {
    let levels = body.levels_of().chain([body]).enumerate();
    let mut rows: Vec<u32> = levels
        .filter(|(level, _)| probe.level.is_none_or(|wanted| wanted == *level))
        .flat_map(|(_, level)| {
            let first = level.rows.start as u32;
            let points = match &probe.region {
                Some(region) => draft.selector(level).points(region),
                None => (0..level.mesh.points.len() as u32).collect(),
            };
            points.into_iter().map(move |point| first + point)
        })
        .collect();
    rows.sort_unstable();
    rows
}

/// The cells that a probe is of.
fn cell_part(probe: &Probe, draft: &Draft) -> Option<CellPart> {
    let body = draft.body(probe.body.as_deref()?)?;
    if probe.quantity.build.is_of_adaptation() && body.spec.adapt.is_none() {
        let message = format!("the elements of body `{}` keep their law", body.spec.name);
        draft.log.add(Code::Conflict, &probe.site, message, "a body with `adapt`");
        return None;
    }
    let cells = match &probe.region {
        Some(region) => draft.selector(body).cells(region),
        None => (0..body.mesh.cell_count() as u32).collect(),
    };
    let solid = solid_name(&body.spec.name);
    let system = draft.systems.get(body.system)?;
    let force = system.forces.iter().find(|force| force.name() == solid);
    let nowhere = vec![Vec3::ZERO; system.kinematics.row_count()];
    let answers = |force: &dyn Force, cell: u32| force.cell_field(cell as usize, &nowhere).is_some();
    if force.zip(cells.first()).is_some_and(|(force, cell)| !answers(force.as_ref(), *cell)) {
        let message = format!("the forces of body `{}` are not those of cells", body.spec.name);
        draft.log.add(
            Code::Conflict,
            &probe.site,
            message,
            "a body of solid matter, with another `formulation`",
        );
        return None;
    }
    Some(CellPart { system: body.system, solid, cells })
}

fn of_world(quantity: WorldQuantity, world: &mut World) -> f64 {
    match quantity {
        WorldQuantity::TotalEnergy => world.energy().total(),
        WorldQuantity::EnergyBalance => {
            let energy = world.energy();
            energy.total() + energy.by_force.iter().map(|(_, energy)| energy.dissipated).sum::<f64>()
        }
        WorldQuantity::KineticEnergy => world.energy().kinetic,
        WorldQuantity::StoredEnergy => world.energy().by_force.iter().map(|(_, energy)| energy.stored).sum(),
        WorldQuantity::DissipatedEnergy => {
            world.energy().by_force.iter().map(|(_, energy)| energy.dissipated).sum()
        }
        WorldQuantity::ControlEnergy => world.energy().made_by_control.iter().map(|(_, made)| made).sum(),
        WorldQuantity::Time => world.time(),
    }
}

fn reduced(numbers: &[f64], weights: &[f64], reduction: Reduction) -> f64 {
    match reduction {
        Reduction::Sum => numbers.iter().sum(),
        Reduction::Min => numbers.iter().copied().fold(f64::INFINITY, f64::min),
        Reduction::Max => numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        Reduction::Mean => {
            let total: f64 = weights.iter().sum();
            numbers.iter().zip(weights).map(|(number, weight)| number * weight).sum::<f64>() / total
        }
        Reduction::MeanMagnitude => {
            let magnitudes: Vec<f64> = numbers.iter().map(|number| number.abs()).collect();
            reduced(&magnitudes, weights, Reduction::Mean)
        }
    }
}
