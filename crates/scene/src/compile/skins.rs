//! Skins become fields of the world.

use std::cell::RefCell;
use std::path::Path;
use std::sync::Arc;

use souple_engine::levels::Division;
use souple_engine::{FieldState, Force, System};
use souple_math::Vec3;
use souple_mesh::TriangleSurface;
use souple_skin::reaction::{Reaction, SkinPush};
use souple_skin::strategy::Term;
use souple_skin::target::{Moment, Part, Particle, Particles, Rows, Surroundings, Target};
use souple_skin::{Lattice, PlacedTarget, Skin, SkinError, SkinField};

use super::Draft;
use super::bodies::{Placed, solid_name};
use crate::diagnostic::{Code, Site};
use crate::scene::SkinInfo;
use crate::spec::skin::{PartSpec, SkinSpec};

/// A ball of five voxels has as many.
const FEW_POINTS: u64 = 100;

/// All skins, each with its first state.
pub fn add(draft: &mut Draft) {
    for spec in &draft.spec.skins {
        let told = RefCell::default();
        let built = build(draft, spec, &told);
        draft.warnings.extend(told.into_inner());
        let Some((skin, state)) = built else { continue };
        let (skin, field) = (Arc::new(skin), draft.model.fields.len());
        if let Some(reaction) = &skin.reaction {
            let rows = reaction.rows.iter().map(|(row, _)| *row).collect();
            let push = SkinPush { name: format!("{}.skin", spec.name), field, rows };
            draft.systems[reaction.system].forces.push(Box::new(push));
        }
        let [points, _] = skin.view(&state).counts();
        if points < FEW_POINTS {
            draft.warnings.push(format!(
                "skin `{}` has {points} points at voxels of {} m: it is hardly seen by its grid; smaller voxels would show it",
                spec.name, spec.voxel
            ));
        }
        draft.model.fields.push(Box::new(SkinField(Arc::clone(&skin))));
        draft.state.fields.push(state);
        draft.skins.push(SkinInfo { name: spec.name.clone(), field, skin, formats: spec.formats.clone() });
    }
}

fn build(draft: &Draft, spec: &SkinSpec, told: &Told) -> Option<(Skin, FieldState)> {
    let target = target(draft, &spec.parts, spec.iso, told)?;
    let start = target_of_start(draft, spec, told)?;
    let terms: Option<Vec<Box<dyn Term>>> = spec
        .terms
        .iter()
        .map(|chosen| {
            let refuse = |error: souple_skin::strategy::TermError| {
                let expected = format!("a term that holds, see `souple describe {}`", chosen.entry.name);
                draft.log.add(Code::BadFormula, &chosen.site, error.to_string(), expected);
            };
            (chosen.entry.build)(&chosen.values).map_err(refuse).ok()
        })
        .collect();
    let skin = Skin {
        name: spec.name.clone(),
        lattice: Lattice { origin: spec.origin, voxel: spec.voxel },
        target: (!target.parts.is_empty()).then_some(target),
        terms: terms?,
        redistance: spec.redistance,
        reaction: reaction(draft, spec)?,
    };
    if skin.target.is_none() && skin.terms.iter().any(|term| term.needs_target()) {
        let message = format!("skin `{}` is drawn to a target, and has no `parts`", spec.name);
        draft.log.add(Code::Conflict, &spec.site, message, "[[skins.NAME.parts]], or no such term");
        return None;
    }
    let started = first_state(draft, spec, &skin, start.as_ref());
    let refuse = |error: SkinError| {
        let message = format!("skin `{}` cannot start: {error}", spec.name);
        draft.log.add(Code::OutOfRange, &spec.site, message, "a skin that can start, as it says");
    };
    let field = started.map_err(refuse).ok()?;
    if misses_target(draft, &skin, start.as_ref()) {
        told.borrow_mut().push(format!(
            "skin `{}` starts beside its target, which it does not meet at t = 0: until the target comes to it, attraction draws it \
             together, and it may be gone before; expected a `start` that meets the target",
            spec.name
        ));
    }
    Some((skin, field))
}

/// Whether a skin is drawn to a target that is nowhere near where it starts.
fn misses_target(draft: &Draft, skin: &Skin, start: Option<&Target>) -> bool {
    let is_drawn = skin.terms.iter().any(|term| term.draws_to_target());
    let Some((start, target)) = start.zip(skin.target.as_ref()).filter(|_| is_drawn) else { return false };
    let rows = Start::of(draft);
    let bounds = |target: &Target| {
        let mut placed = target.new_scratch();
        target.place(&Moment { time: 0.0, rows: &rows }, &mut placed).ok()?;
        target.bounds(&placed)
    };
    bounds(start).zip(bounds(target)).is_some_and(|(start, target)| {
        let gap = (start.low - target.high).max_components(target.low - start.high);
        gap.to_array().into_iter().any(|gap| gap > 0.0)
    })
}

/// What the skin of a body does to it; the outer `None` where that was refused.
fn reaction(draft: &Draft, spec: &SkinSpec) -> Option<Option<Reaction>> {
    let Some(push) = &spec.push else { return Some(None) };
    let Some(body) = draft.body(&spec.name) else { return Some(None) };
    let Some(radius) = push.radius else {
        let message =
            format!("the skin of body `{}` pushes particles, and has no `radius` of them", spec.name);
        draft.log.add(Code::MissingKey, &spec.site, message, "radius = LENGTH beside");
        return None;
    };
    let rows = match rows_of(body, &push.group) {
        Ok(rows) => rows.into_iter().map(|row| (row, radius)).collect(),
        // its particles were refused for the same reason
        Err(_) => return None,
    };
    Some(Some(Reaction { system: body.system, rows, tension: push.tension, pressure: push.pressure }))
}

/// What a skin begins as, where that is not its target.
fn target_of_start(draft: &Draft, spec: &SkinSpec, told: &Told) -> Option<Option<Target>> {
    if spec.start.is_empty() { Some(None) } else { target(draft, &spec.start, spec.iso, told).map(Some) }
}

fn first_state(
    draft: &Draft,
    spec: &SkinSpec,
    skin: &Skin,
    start: Option<&Target>,
) -> Result<FieldState, SkinError> {
    let Some(target) = start.or(skin.target.as_ref()) else { return Err(SkinError::NoDomain) };
    let rows = Start::of(draft);
    let mut placed = target.new_scratch();
    let at = Moment { time: 0.0, rows: &rows };
    target.place(&at, &mut placed).map_err(SkinError::Target)?;
    let [low, high] = match spec.domain {
        Some(domain) => domain,
        None => {
            let bounds = target.bounds(&placed).ok_or(SkinError::NoDomain)?;
            [bounds.low, bounds.high]
        }
    };
    let size = (high - low).to_array();
    // one that has no size is nowhere inside
    if size.iter().all(|side| *side < spec.voxel) && size.iter().any(|side| *side > 0.0) {
        return Err(SkinError::Coarse { voxel: spec.voxel, size });
    }
    let begun = skin.begin(low, high, &PlacedTarget { target, scratch: &placed }, &mut skin.new_scratch());
    begun.map_err(|error| match (error, target.most(&placed)) {
        (SkinError::Empty { .. }, Some(most)) if most <= target.iso => {
            SkinError::Sparse { most, iso: target.iso }
        }
        (error, _) => error,
    })
}

/// Rows of all systems before the first step.
struct Start {
    positions: Vec<Vec<Vec3>>,
    /// Of each body with levels, by its system and its force: points that move by themselves in the first step.
    active: Vec<((usize, usize), Vec<u32>)>,
}

impl Start {
    fn of(draft: &Draft) -> Self {
        let systems = || draft.systems.iter().enumerate();
        let positions: Vec<Vec<Vec3>> =
            systems().map(|(index, system)| start_of(draft, index, system)).collect();
        let forces = systems().flat_map(|(index, system)| {
            system.forces.iter().enumerate().map(move |(number, force)| ((index, number), force))
        });
        let active = forces.filter_map(|((system, number), force)| {
            Some(((system, number), active_of(force.as_ref(), &positions[system])?))
        });
        Self { active: active.collect(), positions }
    }
}

impl Rows for Start {
    fn positions(&self, system: usize) -> &[Vec3] {
        &self.positions[system]
    }

    fn active(&self, system: usize, force: usize) -> &[u32] {
        let of = self.active.iter().find(|(which, _)| *which == (system, force));
        of.map_or(&[], |(_, active)| active)
    }
}

/// Which points of a body with levels its first step begins with, as that step chooses them.
fn active_of(force: &dyn Force, positions: &[Vec3]) -> Option<Vec<u32>> {
    let levels = force.levels()?;
    // how the step is divided among points says nothing of which they are, but where a budget of evaluations is short
    let division = Division::new(1.0, 0);
    let velocities = vec![Vec3::ZERO; positions.len()];
    let mut rows = souple_engine::Rows { positions: positions.to_vec(), velocities, time: 0.0 };
    let mut memory = vec![0.0; force.memory_len()];
    force.initial_memory(&mut memory);
    let mut scratch = force.new_scratch();
    levels.adapt(&division, &mut rows, &mut memory, &mut scratch);
    Some(levels.active(&scratch).to_vec())
}

/// Where the points of all bodies of a system start, by their rows.
fn start_of(draft: &Draft, index: usize, system: &System) -> Vec<Vec3> {
    let mut rows = vec![Vec3::ZERO; system.kinematics.row_count()];
    for body in draft.bodies.iter().filter(|body| body.system == index) {
        for body in body.levels_of().chain([body]) {
            rows[body.rows.clone()].copy_from_slice(&body.mesh.points);
        }
    }
    rows
}

/// The rows of a body's points, or of a group of them.
fn rows_of(body: &Placed, group: &str) -> Result<Vec<u32>, String> {
    let first = body.rows.start as u32;
    if group.is_empty() {
        return Ok((first..body.rows.end as u32).collect());
    }
    let known = body.mesh.groups.get(group).filter(|group| !group.points.is_empty());
    let missing = || {
        let names: Vec<&str> = body.mesh.groups.keys().map(String::as_str).collect();
        format!("`{}` has no group `{group}` of points, it has {}", body.spec.name, names.join(", "))
    };
    Ok(known.ok_or_else(missing)?.points.iter().map(|point| first + point).collect())
}

/// The points of a body with levels: those of all its meshes, coarser ones with a larger radius, so that as many as there are
/// of each mesh stand for the same volume.
fn levels_of(draft: &Draft, body: &Placed, radius: f64) -> Option<Particles> {
    let name = solid_name(&body.spec.name);
    let force = draft.systems[body.system].forces.iter().position(|force| force.name() == name)?;
    let own = body.mesh.points.len();
    let coarser = body.levels_of().flat_map(|level| {
        let count = level.mesh.points.len();
        std::iter::repeat_n(radius * (own as f64 / count as f64).cbrt(), count)
    });
    let radii = std::iter::repeat_n(radius, own).chain(coarser).collect();
    Some(Particles::Levels { system: body.system, force, first: body.rows.start as u32, radii, own })
}

/// `None` where a part was refused.
fn target(draft: &Draft, parts: &[PartSpec], iso: f64, told: &Told) -> Option<Target> {
    let parts: Option<Vec<Part>> = parts.iter().map(|spec| part(draft, spec, told)).collect();
    Some(Target { parts: parts?, iso })
}

fn part(draft: &Draft, spec: &PartSpec, told: &Told) -> Option<Part> {
    let chosen = spec.part.as_ref()?;
    let around = Around { draft, site: &chosen.site, told };
    let potential = match (chosen.entry.build)(&chosen.values, &around) {
        Ok(potential) => potential,
        Err(error) => {
            let path = format!("{}.{}", spec.site.path, error.parameter);
            let site = Site { path, ..chosen.site_of(error.parameter).clone() };
            let message = format!("this is {}", error.value);
            draft.log.add(Code::OutOfRange, &site, message, error.expected);
            return None;
        }
    };
    let warps = spec.warps.iter().map(|chosen| (chosen.entry.build)(&chosen.values)).collect();
    Some(Part { potential, combine: spec.combine, during: spec.during, warps, motion: spec.motion.clone() })
}

/// What parts may ask of a scene.
struct Around<'a> {
    draft: &'a Draft<'a>,
    site: &'a Site,
    told: &'a Told,
}

/// Warnings that parts gave.
type Told = RefCell<Vec<String>>;

impl Around<'_> {
    fn open(&self, file: &str) -> Result<std::path::PathBuf, String> {
        let source = self.site.place.source;
        self.draft.sources.open(source, file).map_err(|error| format!("it cannot be read: {error}"))
    }
}

impl Surroundings for Around<'_> {
    fn surface(&self, file: &str) -> Result<TriangleSurface, String> {
        super::contact::read_surface(&self.open(file)?)
    }

    fn particles(&self, from: &str, group: &str, radius: f64) -> Result<Particles, String> {
        let Some(body) = self.draft.body(from) else {
            if !group.is_empty() {
                return Err(format!("there is no body `{from}`, and a file has no groups"));
            }
            return Ok(Particles::Led(read_particles(&self.open(from)?, radius)?));
        };
        if body.levels.is_some() && group.is_empty() {
            let missing = || format!("body `{from}` has levels that do not step");
            return levels_of(self.draft, body, radius).ok_or_else(missing);
        }
        let rows = rows_of(body, group)?.into_iter().map(|row| (row, radius)).collect();
        Ok(Particles::Rows { system: body.system, rows })
    }

    fn body_surface(&self, name: &str) -> Result<(TriangleSurface, usize, Vec<u32>), String> {
        let Some(body) = self.draft.body(name) else { return Err("there is none of this name".to_owned()) };
        if body.spec.network.is_some() {
            return Err("masses of a network have no surface; `part = \"particles\"` dresses them".to_owned());
        }
        let surface = body.mesh.boundary_surface();
        let first = body.rows.start as u32;
        let rows = surface.mesh_points.iter().map(|point| first + point).collect();
        Ok((surface, body.system, rows))
    }

    fn warn(&self, warning: String) {
        self.told.borrow_mut().push(format!("{}: {warning}", self.draft.place(self.site)));
    }
}

/// Particles of a file: a table with columns, or the points of a mesh.
fn read_particles(path: &Path, radius: f64) -> Result<Vec<Particle>, String> {
    let is_table = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    if is_table {
        let table = souple_io::read_particles(path).map_err(|error| error.to_string())?;
        let particle = |p: &souple_io::ParticleRow| Particle {
            position: p.position,
            velocity: p.velocity,
            radius: p.radius.unwrap_or(radius),
            during: p.during,
        };
        return Ok(table.iter().map(particle).collect());
    }
    let (mesh, _) = souple_io::read_mesh(path).map_err(|error| error.to_string())?;
    let during = [f64::NEG_INFINITY, f64::INFINITY];
    let particle = |position: &Vec3| Particle { position: *position, velocity: Vec3::ZERO, radius, during };
    Ok(mesh.points.iter().map(particle).collect())
}
