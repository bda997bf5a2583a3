//! Bodies of several meshes: the coarser ones are made or read, and get rows behind those of the body's own mesh.

use std::sync::Arc;

use souple_engine::Force;
use souple_engine::levels::{Division, Filter, Levels, Pace};
use souple_formal::Formula;
use souple_math::Vec3;
use souple_mesh::coarsen::{coarser, coarser_of_count, mean_edge};
use souple_mesh::{BoundingBox, Mesh, OpeningSurface};
use souple_models::multiresolution::{
    Coupling, Cut, Dress, Fading, LevelsDescription, LevelsForce, Support, Worn,
};
use souple_models::solids::Section;
use souple_table::{Value, four_digits, readable};

use super::bodies::{BodyMaterials, Placed, solid_name};
use super::{Draft, shape};
use crate::diagnostic::{Code, Site};
use crate::scene::DressInfo;
use crate::spec::body::{Body, MassKind};
use crate::spec::boundary::Pin;
use crate::spec::levels::{CutSpec, LevelsSpec};
use crate::spec::world::SystemSpec;

/// The coarser meshes of a body, from coarse to fine.
pub struct PlacedLevels<'a> {
    /// Each like a body with the keys of the whole one, for what is chosen on it by regions.
    pub coarser: Vec<Placed<'a>>,
}

impl PlacedLevels<'_> {
    pub fn point_count(&self) -> usize {
        self.coarser.iter().map(|level| level.mesh.points.len()).sum()
    }

    pub fn give_rows(&mut self, first: usize) {
        let mut next = first;
        for level in &mut self.coarser {
            level.rows = next..next + level.mesh.points.len();
            next = level.rows.end;
        }
    }
}

/// Makes or reads the coarser meshes of a body; `None` where one was refused, or is none of a body with levels.
pub fn place<'a>(
    draft: &Draft,
    body: &'a Body,
    system: usize,
    mesh: &Mesh,
    warnings: &mut Vec<String>,
) -> Option<PlacedLevels<'a>> {
    let spec = body.levels.as_ref()?;
    if !suits(draft, body, spec) {
        return None;
    }
    let level = |mesh: Mesh, point_numbers: Vec<u32>| Placed {
        spec: body,
        system,
        rows: 0..0,
        mesh,
        point_numbers,
        materials: BodyMaterials::default(),
        axes: Vec::new(),
        links: Vec::new(),
        frames: None,
        levels: None,
        reduced: None,
        hanging: None,
    };
    let mut placed = Vec::new();
    for mesh in &spec.coarser {
        let shape = shape::build_of(body, mesh, draft)?;
        warnings.extend(shape.warnings);
        placed.push(level(shape.mesh, shape.point_numbers));
    }
    if spec.coarser.is_empty() {
        for made in coarser_meshes(spec, mesh) {
            match made {
                Ok(mesh) => placed.push(level(mesh.clone(), (0..mesh.points.len() as u32).collect())),
                Err(message) => {
                    let expected = "fewer levels, a smaller ratio, or other numbers of `cells`";
                    draft.log.add(Code::Mesh, &spec.site, message, expected);
                    return None;
                }
            }
        }
    }
    Some(PlacedLevels { coarser: placed })
}

/// The meshes that are made of a body's own, from coarse to fine; or why there is none.
fn coarser_meshes(spec: &LevelsSpec, mesh: &Mesh) -> Vec<Result<Mesh, String>> {
    if !spec.cells.is_empty() {
        let own = mesh.cell_count();
        let made = |count: &usize| match *count {
            count if count >= own => {
                Err(format!("{count} cells are no fewer than the {own} of the body's own mesh"))
            }
            count => coarser_of_count(mesh, count).map_err(|error| error.to_string()),
        };
        return spec.cells.iter().map(made).collect();
    }
    let edge = mean_edge(mesh);
    let sizes = (1..spec.count).rev().map(|finer| edge * spec.ratio.powi(finer as i32));
    sizes.map(|size| coarser(mesh, size).map_err(|error| error.to_string())).collect()
}

fn suits(draft: &Draft, body: &Body, spec: &LevelsSpec) -> bool {
    let refuse = |message: &str, expected: &str| {
        draft.log.add(Code::Conflict, &spec.site, message, expected);
        false
    };
    if body.section() != Section::Solid || body.frames.is_some() {
        return refuse(
            "levels are of volumes that their points carry",
            "no `section` and no `frames` beside",
        );
    }
    if body.mass != MassKind::Lumped {
        return refuse("points of levels have masses of their own", "`mass = \"lumped\"`");
    }
    if body.damping.rayleigh_stiffness > 0.0 {
        return refuse("levels have no damping by the stiffness at rest", "`viscosity` or `rayleigh_mass`");
    }
    true
}

/// The elastic force of a body of levels; `None` where its meshes were refused.
pub fn force(draft: &Draft, body: &Placed, levels: &PlacedLevels) -> Option<Box<dyn Force>> {
    let spec = body.spec.levels.as_ref()?;
    let meshes: Vec<&Mesh> = levels.coarser.iter().map(|level| &level.mesh).chain([&body.mesh]).collect();
    let system = draft.spec.systems.get(body.system)?;
    let description = LevelsDescription {
        name: solid_name(&body.spec.name),
        meshes: &meshes,
        first_row: body.rows.start,
        materials: &body.materials.all,
        material_of_cell: &body.materials.of_cell,
        coupling: spec.coupling,
        loops: spec.loops,
        stiffness: spec.stiffness,
        choice: spec.choice(),
        viscosity: body.spec.damping.viscosity,
        mass_damping: body.spec.damping.rayleigh_mass,
        budget: spec.budget,
        cuts: cuts(draft, body, spec),
        supports: supports(draft, body, levels),
    };
    match LevelsForce::new(description) {
        Ok(force) => {
            check_fixed(draft, &spec.site, spec.fixed.as_ref(), &force.hierarchy().rest, meshes.len());
            check_steps(draft, system, body.spec, spec, &force);
            Some(Box::new(force))
        }
        Err(error) => {
            let expected = "tetrahedra of one body, from coarse to fine";
            draft.log.add(Code::Mesh, &spec.site, error.to_string(), expected);
            None
        }
    }
}

/// What each pin holds of the body's own mesh, and of the coarser ones, whose numbers follow.
fn supports(draft: &Draft, body: &Placed, levels: &PlacedLevels) -> Vec<Support> {
    let support = |pin: &Pin| {
        let region = pin.region.as_ref()?;
        let mut support = Support { points: Vec::new(), axes: pin.axes };
        let mut first = 0;
        for level in [body].into_iter().chain(&levels.coarser) {
            let points = draft.selector(level).points_if_any(region);
            support.points.extend(points.iter().map(|point| first + point));
            first += level.mesh.points.len() as u32;
        }
        Some(support)
    };
    body.spec.pins.iter().filter_map(support).collect()
}

/// Cells of the body's own mesh, by the dates at which they are cut.
fn cuts(draft: &Draft, body: &Placed, spec: &LevelsSpec) -> Vec<Cut> {
    let cut = |cut: &CutSpec| {
        let cells = draft.selector(body).cells(cut.region.as_ref()?);
        Some(Cut { time: cut.time, cells })
    };
    spec.cuts.iter().filter_map(cut).collect()
}

/// When each cell of a body is cut [s], infinite where that is never; empty where nothing is cut.
pub fn cut_at(draft: &Draft, body: &Placed) -> Vec<f64> {
    let cuts = body.spec.levels.as_ref().map_or_else(Vec::new, |spec| cuts(draft, body, spec));
    if cuts.is_empty() {
        return Vec::new();
    }
    let mut at = vec![f64::INFINITY; body.mesh.cell_count()];
    for cut in &cuts {
        cut.cells.iter().for_each(|cell| at[*cell as usize] = cut.time.min(at[*cell as usize]));
    }
    at
}

/// What is ever on the surface of a body, and from when until when.
pub(super) fn opening_surface(draft: &Draft, body: &Placed) -> OpeningSurface {
    body.mesh.opening_surface(&cut_at(draft, body))
}

/// Whether a formula of levels gives one that there is at every point at rest.
pub(super) fn check_fixed(
    draft: &Draft,
    site: &Site,
    fixed: Option<&Formula>,
    places: &[Vec3],
    count: usize,
) {
    let Some(fixed) = fixed else { return };
    let finest = (count - 1) as f64;
    let of = |place: &Vec3| (*place, fixed.evaluate(&place.to_array()));
    let is_level = |level: f64| (0.0..=finest).contains(&level) && level.fract() == 0.0;
    if let Some((place, level)) = places.iter().map(of).find(|(_, level)| !is_level(*level)) {
        let [x, y, z] = place.to_array().map(readable);
        let message = format!("`fixed` is {} at x = {x}, y = {y}, z = {z}", readable(level));
        let expected = format!("whole numbers of levels from 0, the coarsest, to {finest}");
        draft.log.add(Code::OutOfRange, site, message, expected);
    }
}

/// Whether the shortest interval of the stepper is short enough for rates by the bound, and its filter one for this coupling. Where all points are pushed in
/// every tick there are no rates: what is longer than the bound is warned of, as of any other explicit stepper.
fn check_steps(draft: &Draft, system: &SystemSpec, body: &Body, spec: &LevelsSpec, force: &LevelsForce) {
    let Some(stepper) = &system.stepper else { return };
    let Some(Value::Integer(halvings)) = stepper.values.get("halvings") else { return };
    let step = draft.timestep(system);
    let is_semi_implicit = stepper.values.boolean("semi_implicit");
    let filter = if is_semi_implicit { Filter::SemiImplicit } else { Filter::None };
    let (tick, needed) = (step / (1_u64 << halvings) as f64, force.shortest_interval(filter));
    let has_rates = halvings > 0 && stepper.values.text("schedule") != "together";
    if has_rates && tick > needed {
        let enough = (step / needed).log2().ceil();
        let message = format!("the shortest interval is {tick:.3e} s, and some points need {needed:.3e} s");
        let halvings = stepper.entry.parameters.iter().find(|parameter| parameter.name == "halvings");
        let most = halvings.map_or(f64::INFINITY, |parameter| parameter.range.high);
        // no number of halvings would do
        let modulus = body.material.as_ref().filter(|_| enough > most);
        let (site, expected) = match modulus {
            Some(material) => (
                material.site_of("youngs_modulus"),
                format!(
                    "a softer or denser material (is its unit right?), larger cells, or a step of {:.1e} s at most: it is {step:.1e} s, and is halved {most} times \
                     at most",
                    needed * most.exp2()
                ),
            ),
            None => (stepper.site_of("halvings"), format!("halvings = {enough}, or a shorter period")),
        };
        draft.log.add(Code::Conflict, site, message, expected);
    }
    if is_semi_implicit && spec.coupling == Coupling::Transpose {
        let message = "semi-implicit points brake all motion, and this coupling keeps its momentum";
        draft.log.add(Code::Conflict, stepper.site_of("semi_implicit"), message, "`coupling = \"one_way\"`");
    }
}

/// What is said of a body's levels, and where.
type Doubt = for<'a> fn(&Draft, &Placed, &'a LevelsSpec) -> Vec<(&'a Site, String)>;

/// Says what of levels cannot be as it is written.
pub fn warn(draft: &mut Draft) {
    let of_all = |doubt: Doubt| {
        let levels = draft.bodies.iter().filter_map(|body| Some((body, body.spec.levels.as_ref()?)));
        let found: Vec<(&Site, String)> = levels.flat_map(|(body, spec)| doubt(draft, body, spec)).collect();
        found.into_iter().map(|(site, words)| format!("{}: {words}", draft.place(site))).collect::<Vec<_>>()
    };
    let doubts: [Doubt; 4] = [doubts_of_budget, doubts_of_settling, doubts_of_late_cuts, doubts_of_cuts];
    let said: Vec<String> = doubts.into_iter().flat_map(of_all).collect();
    draft.warnings.extend(said);
}

/// A budget is below what the coarsest mesh needs, cuts, or the finest until the body has settled: these are at work all the same.
fn doubts_of_budget<'a>(draft: &Draft, body: &Placed, spec: &'a LevelsSpec) -> Vec<(&'a Site, String)> {
    let (Some(budget), Some((force, division))) = (spec.budget, levels_of(draft, body)) else {
        return Vec::new();
    };
    let name = &body.spec.name;
    let least = force.least_evaluations(&division, 0);
    let beside_cuts = force.least_evaluations(&division, force.cut_count());
    let settles = spec.criterion.settled.filter(|date| *date > 0.0);
    let finest = settles.map_or(0, |_| force.finest_evaluations(&division));
    let words = if budget < least as f64 {
        format!(
            "a step of body `{name}` evaluates {least} stresses with the coarsest mesh alone, and its budget is {budget}: it \
             stays at that, nothing is refined, and against the clock the world may come late; a coarser mesh (`count`, \
             `ratio`) or fewer `halvings` would need less"
        )
    } else if budget < beside_cuts as f64 {
        format!(
            "a step of body `{name}` evaluates {beside_cuts} stresses once all of its cuts are made, whatever its budget of {budget} says: \
             where a cut runs the finest mesh is at work; against the clock the world may come late; a larger budget, a smaller cut \
             or fewer `halvings` would fit"
        )
    } else if budget < finest as f64 {
        format!(
            "a step of body `{name}` evaluates {finest} stresses until it has settled at {} s, whatever its budget of {budget} says: \
             the finest mesh is at work until then; against the clock the world may come late; a larger budget, an earlier date, \
             a coarser finest mesh or fewer `halvings` would fit",
            settles.unwrap_or(0.0)
        )
    } else {
        return Vec::new();
    };
    vec![(&spec.site, words)]
}

/// A run ends before a body has settled, or its first step does not end before.
fn doubts_of_settling<'a>(draft: &Draft, body: &Placed, spec: &'a LevelsSpec) -> Vec<(&'a Site, String)> {
    let (duration, name) = (draft.spec.run.written_duration(), &body.spec.name);
    let Some(settled) = spec.criterion.settled else { return Vec::new() };
    let step = draft.spec.systems.get(body.system).map_or(0.0, |system| draft.timestep(system));
    let words = if let Some(duration) = duration.filter(|duration| settled >= *duration) {
        format!(
            "body `{name}` has settled at {} s, and not before the `run.duration` of {} s is over: until then the finest mesh is at work; an earlier date would let it be \
             coarse",
            readable(settled),
            readable(duration)
        )
    } else if settled > 0.0 && settled <= step {
        format!(
            "body `{name}` has settled at {} s, and its first step ends at {} s: what its own loads have made by then is hardly begun, and the rest counts; a date at which it hangs \
             still would leave it out",
            readable(settled),
            readable(step)
        )
    } else {
        return Vec::new();
    };
    vec![(&spec.site, words)]
}

/// A run ends before a cut is made.
fn doubts_of_late_cuts<'a>(draft: &Draft, body: &Placed, spec: &'a LevelsSpec) -> Vec<(&'a Site, String)> {
    let name = &body.spec.name;
    let Some(duration) = draft.spec.run.written_duration() else { return Vec::new() };
    let late = spec.cuts.iter().filter(|cut| cut.time >= duration);
    let words = |cut: &CutSpec| {
        format!(
            "a cut of body `{name}` is made at {} s, after the `run.duration` of {} s: only a longer run comes to it",
            readable(cut.time),
            readable(duration)
        )
    };
    late.map(|cut| (&cut.site, words(cut))).collect()
}

/// Cuts go through all cells of a body: from then on it is loose points, which nothing touches.
fn doubts_of_cuts<'a>(draft: &Draft, body: &Placed, spec: &'a LevelsSpec) -> Vec<(&'a Site, String)> {
    let at = cut_at(draft, body);
    let Some(last) = at.iter().copied().reduce(f64::max).filter(|last| last.is_finite()) else {
        return Vec::new();
    };
    let words = format!(
        "the cuts of body `{}` go through all of its {} cells: from {last} s on its points fall alone, and it has no surface to \
         be seen or touched; a smaller `region` would leave some of it",
        body.spec.name,
        at.len()
    );
    vec![(&spec.site, words)]
}

/// The force of a body with levels, and how its steps are divided.
fn levels_of<'a>(draft: &'a Draft, body: &Placed) -> Option<(&'a LevelsForce, Division)> {
    let system = draft.spec.systems.get(body.system)?;
    let stepper = system.stepper.as_ref()?;
    let Some(Value::Integer(halvings)) = stepper.values.get("halvings") else { return None };
    let name = solid_name(&body.spec.name);
    let force = draft.systems.get(body.system)?.forces.iter().find(|force| force.name() == name)?;
    let force = force.as_any().downcast_ref::<LevelsForce>()?;
    let mut division = Division::new(draft.timestep(system), halvings as u32);
    if stepper.values.text("schedule") == "together" {
        division.pace = Pace::Together;
    }
    if stepper.values.number("velocity_jump") > 0.0 {
        division.velocity_jump = stepper.values.number("velocity_jump");
    }
    Some((force, division))
}

/// What bodies with levels wear: fields of the world, each with its first state.
pub fn add_dresses(draft: &mut Draft) {
    let made: Vec<(String, Dress)> =
        draft.bodies.iter().filter_map(|body| Some((body.spec.name.clone(), dress(draft, body)?))).collect();
    let misfits: Vec<String> = made.iter().filter_map(|(body, dress)| misfit(draft, body, dress)).collect();
    draft.warnings.extend(misfits);
    for (body, dress) in made {
        // all meshes stand at rest before a motion of the start moves them as one
        let info = DressInfo { body, field: draft.model.fields.len(), dress: Arc::new(dress), marks: None };
        draft.state.fields.push(info.dress.start());
        draft.model.fields.push(Box::new(Worn(Arc::clone(&info.dress))));
        draft.dresses.push(info);
    }
}

/// The diagonals of a body and of its dress differ by no more than this factor, unless one is in other units or of another thing.
const MISFIT: f64 = 1.5;

/// Says where a dress is of another size than its body, or beside it: it would follow all the same, by extrapolation.
fn misfit(draft: &Draft, body: &str, dress: &Dress) -> Option<String> {
    let placed = draft.body(body)?;
    let spec = placed.spec.levels.as_ref()?.dress.as_ref()?;
    let worn = BoundingBox::of(dress.rest().iter().copied());
    let own = placed.mesh.bounds();
    let [size, wanted] = [worn, own].map(BoundingBox::diagonal);
    let apart = (worn.centre() - own.centre()).length();
    let fits = size < MISFIT * wanted && wanted < MISFIT * size && apart < 0.5 * wanted;
    (!fits).then(|| {
        format!(
            "{}: the dress of body `{body}` is {} m across, its middle {} m beside that of the body, which is {} m across: it is hardly its surface; is its \
             `scale` right?",
            draft.place(&spec.site),
            four_digits(size),
            four_digits(apart),
            four_digits(wanted)
        )
    })
}

fn dress(draft: &Draft, body: &Placed) -> Option<Dress> {
    let (levels, spec) = (body.levels.as_ref()?, body.spec.levels.as_ref()?);
    let spec = spec.dress.as_ref()?;
    let surface = match &spec.mesh {
        Some(mesh) => shape::build_of(body.spec, mesh, draft)?.mesh.boundary_surface(),
        None => body.mesh.boundary_surface(),
    };
    let meshes: Vec<&Mesh> = levels.coarser.iter().chain([body]).map(|placed| &placed.mesh).collect();
    let name = solid_name(&body.spec.name);
    let forces = &draft.systems[body.system].forces;
    let of = forces.iter().position(|candidate| candidate.name() == name)?;
    let force = forces[of].as_any().downcast_ref::<LevelsForce>()?;
    let name = format!("{}.dress", body.spec.name);
    let fading = Fading { blend: spec.blend, most: spec.most.unwrap_or(f64::INFINITY) };
    Some(Dress::new(name, [body.system, of], surface, (force, &meshes, &cut_at(draft, body)), fading))
}

/// Rest positions and start velocities of the coarser points: `v + ω × (x - c)` as those of the body.
pub fn start(levels: &PlacedLevels, motion: [Vec3; 3], q: &mut [Vec3], v: &mut [Vec3]) {
    let [velocity, spin, centre] = motion;
    for level in &levels.coarser {
        for (row, x) in level.rows.clone().zip(&level.mesh.points) {
            q[row] = *x;
            v[row] = velocity + spin.cross(*x - centre);
        }
    }
}
