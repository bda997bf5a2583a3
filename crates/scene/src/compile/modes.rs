//! Bodies of modes: the natural modes of a body of finite elements are found once, and its points become rows over a frame and amplitudes.

use std::f64::consts::TAU;
use std::ops::Range;

use souple_engine::modes::{ModesError, RitzPairs, Settings, lowest, refuse_loose, rigid_motions, within};
use souple_engine::{Constraint, Force, Kinematics, Mass, Model, State, System, UnknownKind};
use souple_math::{Mat3, Vec3};
use souple_models::materials::Material;
use souple_models::reduced::{Coupling, ModalBasis, ModalDamping, ModalStiffness, monomials};
use souple_models::solids::{FlatCell, SolidDescription, SolidForce};
use souple_table::four_digits;

use super::Draft;
use super::bodies::{Placed, add_point_mass, solid_name};
use super::reduced::{Moving, add_point};
use crate::diagnostic::Code;
use crate::spec::modes::ModesSpec;

/// The modes of a body and the frame that they are seen from.
pub struct PlacedModes {
    basis: ModalBasis,
    /// Row of the frame's origin.
    first_row: usize,
    /// Where pins hold the frame: what sets each mode swinging, `φ_i·M v` of the body moved by `v` and turned by `ω` about the frame's
    /// origin, as vectors to be multiplied with both.
    held: Option<Vec<[Vec3; 2]>>,
    coupling: Coupling,
    /// Natural modes, the first of the basis; deformations of the whole follow.
    natural: usize,
    /// In words, why its modes may not be those that are meant.
    doubts: Vec<String>,
}

/// Rigid motions of a body in space.
const RIGID: usize = 6;
/// `ω²` of what moves rigidly is rounding, below this part of that of the first mode that strains.
const RIGID_PART: f64 = 1e-6;
/// Modes are one pair up to this part of their frequency: a body that is the same along two axes has such, and its mesh is that but for its cells.
const PAIR: f64 = 0.01;
/// Modes among polynomials are told to be too stiff from this part of their frequency on.
const TOO_STIFF: f64 = 0.05;
/// Where `ω²` of free bodies is sought from, below zero, over the inverse square of the time that a longitudinal wave takes across: thin
/// bodies swing that slowly.
const SHIFT: f64 = 1e-4;

impl PlacedModes {
    pub fn kind(&self) -> UnknownKind {
        UnknownKind::FloatingFrame { modes: self.basis.mode_count() as u32 }
    }

    pub fn give_rows(&mut self, first: usize) {
        self.first_row = first;
    }

    /// Rows of the frame and the modes, which have the body's mass.
    pub fn row_range(&self) -> Range<usize> {
        self.first_row..self.first_row + self.kind().row_count()
    }

    /// The configuration at rest, as rows.
    pub fn configuration(&self) -> impl Iterator<Item = Vec3> + '_ {
        let frame = std::iter::once(self.basis.centre).chain(Vec3::AXES);
        let rows = self.row_range().len();
        frame.chain(std::iter::repeat(Vec3::ZERO)).take(rows)
    }

    /// `ω²` of each natural mode [1/s²].
    pub fn eigenvalues(&self) -> &[f64] {
        &self.basis.eigenvalues()[..self.natural]
    }

    /// In words, why its modes may not be those that are meant.
    pub fn doubts(&self) -> &[String] {
        &self.doubts
    }

    /// Appends the points of the mesh to the rows.
    pub fn add_points(&self, points: usize, kinematics: &mut Kinematics) {
        for point in 0..points {
            add_point(self.first_row, self.basis.weights(point), kinematics);
        }
    }

    pub fn add_mass(&self, of_points: &Mass, mass: &mut Mass) {
        self.basis.add_mass(of_points, self.coupling, self.first_row as u32, mass);
    }

    /// What resists the modes and what damps them.
    ///
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn forces(
        &self,
        description: &SolidDescription,
        body: &Placed,
        forces: &mut Vec<Box<dyn Force>>,
    ) -> Result<(), FlatCell> {
        let (first, eigenvalues) = (self.first_row as u32, self.basis.eigenvalues());
        forces.push(Box::new(ModalStiffness::new(description, first, eigenvalues)?));
        let seconds = body.spec.damping.rayleigh_stiffness;
        let ratio = body.spec.modes.as_ref().map_or(0.0, |modes| modes.damping_ratio);
        if seconds > 0.0 || ratio > 0.0 {
            let name = format!("{}.modal_damping", body.spec.name);
            forces.push(Box::new(ModalDamping::new(name, first, eigenvalues, seconds, ratio)));
        }
        Ok(())
    }

    /// What holds the frame, and components of blocks that are amplitudes of no mode.
    pub fn constraints(&self, kinematics: &Kinematics) -> Vec<Constraint> {
        let block = kinematics.block_of(self.first_row as u32);
        let mut constraints = Vec::new();
        if self.held.is_some() {
            constraints.push(Constraint::pin(block, self.basis.centre));
            constraints.push(Constraint::of_turn(block + 1, Mat3::IDENTITY, None));
        }
        let kind = self.kind();
        for part in 0..kind.block_count() {
            let idle = kind.idle_components(part);
            if idle.contains(&true) {
                constraints.push(Constraint::partial(
                    block + part as u32,
                    Vec3::ZERO,
                    idle.map(|idle| !idle),
                ));
            }
        }
        constraints
    }

    /// Velocity blocks of a motion `v + ω × (x - c)` of the whole; where the frame is held, what its modes have of it.
    pub fn start_velocity(&self, kinematics: &Kinematics, motion: [Vec3; 3], v: &mut [Vec3]) {
        let [velocity, spin, centre] = motion;
        let block = kinematics.block_of(self.first_row as u32) as usize;
        let of_origin = velocity + spin.cross(self.basis.centre - centre);
        let Some(held) = &self.held else {
            [v[block], v[block + 1]] = [of_origin, spin];
            return;
        };
        for (mode, [moved, turned]) in held.iter().enumerate() {
            v[block + 2 + mode / 3][mode % 3] = moved.dot(of_origin) + turned.dot(spin);
        }
    }
}

/// Finds the modes of a body; `None` where that was refused.
pub fn place(draft: &Draft, body: &Placed) -> Option<PlacedModes> {
    let spec = body.spec.modes.as_ref()?;
    let moving =
        Moving { key: "modes", site: &spec.site, knows_no: "moves as a sum of modes, which know no" };
    let polynomial = body.spec.polynomial.as_ref().map(|of| &of.site);
    if !moving.is_alone(draft, body, &[("polynomial", polynomial)]) || body.materials.all.is_empty() {
        return None;
    }
    let refuse = |message: String, expected: &str| {
        draft.log.add(Code::Conflict, &spec.site, message, expected);
    };
    let (of_points, centre) = matter(draft, body)?;
    let constraints = held(draft, body)?;
    let is_held = !constraints.is_empty();
    if is_held && !spec.global.is_empty() {
        let message = format!("body `{}` is held, and its modes have `global` deformations", body.spec.name);
        refuse(message, "a body without pins, or modes alone: they are of a whole that is free");
        return None;
    }
    let Ok(elastic) = SolidForce::new(&description(body, 0)) else {
        refuse(format!("body `{}` has flat cells, and no modes", body.spec.name), "cells with volume");
        return None;
    };
    let mass = of_points.clone();
    let Found { modes, global, next, of_mesh } =
        match modes_of(draft, body, spec, centre, (of_points, elastic, constraints)) {
            Ok(modes) => modes,
            Err(error) => {
                let name = &body.spec.name;
                match error.available() {
                    Some(available) => {
                        let others = spec.global.len() + if is_held { 0 } else { RIGID };
                        let most = available.saturating_sub(others);
                        let message = format!("body `{name}` has {most} modes, not {}", spec.count);
                        refuse(message, "a smaller `count`, a finer mesh or a higher `degree`");
                    }
                    None => {
                        let expected =
                            "one body that hangs together, and pins that hold it as a whole or none";
                        refuse(format!("no modes were found of body `{name}`: {error}"), expected);
                    }
                }
                return None;
            }
        };
    if global.shapes.len() < spec.global.len() {
        let message = format!(
            "of the {} `global` deformations of body `{}` {} make others, or nothing but rigid motions, on this mesh",
            spec.global.len(),
            body.spec.name,
            spec.global.len() - global.shapes.len()
        );
        refuse(
            message,
            "deformations that none of the others make together: of three twists two, of a mesh of one cell fewer",
        );
        return None;
    }
    let rigid = if is_held { 0 } else { RIGID };
    let values = &modes.eigenvalues;
    let first = values[rigid];
    let is_rigid = |value: &f64| value.abs() <= RIGID_PART * first.abs();
    if first <= 0.0 || values[..rigid].iter().any(|value| !is_rigid(value)) {
        let message = format!(
            "body `{}` has motions beside its rigid ones that nothing resists, or that go on by themselves: the first modes have ω² of {} /s²",
            body.spec.name,
            values[..=rigid].iter().map(|value| format!("{value:.1e}")).collect::<Vec<_>>().join(", ")
        );
        refuse(
            message,
            "one body that hangs together, with a law that resists at rest, and pins that hold it as a whole or none",
        );
        return None;
    }
    let mut eigenvalues = values[rigid..].to_vec();
    let mut shapes = modes.shapes[rigid..].to_vec();
    let natural = shapes.len();
    let doubts = [too_stiff(&eigenvalues, &of_mesh), split_pair(&eigenvalues, next)];
    eigenvalues.extend(global.eigenvalues.iter().map(|value| spec.global_stiffness * value));
    shapes.extend(global.shapes);
    let basis = ModalBasis::new(centre, &body.mesh.points, shapes, eigenvalues);
    let held = is_held.then(|| basis.momenta(&mass));
    // what a frame of reference that turns does to one mode by another is in the masses between them
    let swings_alone = is_held && draft.spec.world.frame.is_none();
    let coupling = if swings_alone { Coupling::OfOneMode } else { Coupling::All };
    let doubts = doubts.into_iter().flatten().collect();
    Some(PlacedModes { basis, first_row: 0, held, coupling, natural, doubts })
}

/// The first mode among polynomials that is stiffer than that of the mesh by more than a little, in words: no mode of fewer fields has a
/// lower frequency than the one of its number among all fields (Courant and Fischer).
fn too_stiff(squares: &[f64], of_mesh: &[f64]) -> Option<String> {
    let excess =
        |(number, (square, least)): (usize, (&f64, &f64))| (number, (square / least).sqrt() - 1.0, *square);
    let modes = squares.iter().zip(of_mesh).enumerate().map(excess);
    let (number, excess, square) = modes.into_iter().find(|(_, excess, _)| *excess > TOO_STIFF)?;
    Some(format!(
        "mode {} among polynomials of this `degree` swings at {} Hz, {:.0} % above that of the mesh: polynomials are too stiff for a body this \
         thin, or across a jump of stiffness; leave `degree` out, or raise it",
        number + 1,
        four_digits(square.sqrt() / TAU),
        100.0 * excess
    ))
}

/// A pair of modes of one frequency, of which the last that is taken is the one and the next the other, in words.
fn split_pair(squares: &[f64], next: Option<f64>) -> Option<String> {
    let (last, next) = (*squares.last()?, next?);
    ((next / last).sqrt() - 1.0 <= PAIR).then(|| {
        format!(
            "`count` = {} takes one mode of a pair at {} Hz and leaves the other out: which, and so where the body may bend, is chance of the \
             mesh; take one more or one fewer",
            squares.len(),
            four_digits(last.sqrt() / TAU)
        )
    })
}

/// The mass of the points of a body and its centre; `None` where there is none.
fn matter(draft: &Draft, body: &Placed) -> Option<(Mass, Vec3)> {
    let mut mass = Mass::new(body.mesh.points.len());
    add_point_mass(draft, body, 0, &mut mass);
    mass.seal();
    let mut shares = mass.diagonal.clone();
    for &(a, b, m) in &mass.couplings {
        shares[a as usize] += m;
        shares[b as usize] += m;
    }
    let total: f64 = shares.iter().sum();
    let moment: Vec3 = body.mesh.points.iter().zip(&shares).map(|(x, m)| *x * *m).sum();
    (total > 0.0).then(|| (mass, moment / total))
}

/// The points that pins hold, as modes see them; none of a body that is free. Pins that lead are reported.
fn held(draft: &Draft, body: &Placed) -> Option<Vec<Constraint>> {
    let mut axes_of_point = vec![[false; 3]; body.mesh.points.len()];
    for pin in &body.spec.pins {
        if pin.motion.is_some() || pin.rotation.is_some() || pin.bone.is_some() {
            let message = format!("the modes of body `{}` are those of pins that stay", body.spec.name);
            draft.log.add(
                Code::Conflict,
                &pin.site,
                message,
                "a pin without a motion, or a body without `modes`",
            );
            return None;
        }
        let Some(region) = &pin.region else { continue };
        for point in draft.selector(body).points(region) {
            let axes = &mut axes_of_point[point as usize];
            (0..3).for_each(|axis| axes[axis] |= pin.axes[axis]);
        }
    }
    let pinned = (0..).zip(axes_of_point).filter(|(_, axes)| axes.contains(&true));
    let constraint = |(point, axes): (u32, [bool; 3])| {
        Constraint::partial(point, body.mesh.points[point as usize], axes.map(|held| !held))
    };
    Some(pinned.map(constraint).collect())
}

/// What a body deforms by.
struct Found {
    /// The lowest first, rigid ones before where it is free.
    modes: RitzPairs,
    /// Deformations of the whole.
    global: RitzPairs,
    /// `ω²` of the next mode that was left out, where it is known.
    next: Option<f64>,
    /// Of modes among polynomials, `ω²` of those of the mesh by the same numbers, as far as these are known.
    of_mesh: Vec<f64>,
}

/// The lowest modes of the body as a system of points, and its deformations of the whole about a place.
fn modes_of(
    draft: &Draft,
    body: &Placed,
    spec: &ModesSpec,
    centre: Vec3,
    (mass, elastic, constraints): (Mass, SolidForce, Vec<Constraint>),
) -> Result<Found, ModesError> {
    let is_held = !constraints.is_empty();
    let points = body.mesh.points.clone();
    let mut kinematics = Kinematics::default();
    kinematics.add_unknowns(UnknownKind::Point, points.len());
    let system = System {
        name: body.spec.name.clone(),
        kinematics,
        mass,
        forces: vec![Box::new(elastic)],
        constraints,
        stepper: Box::new(souple_engine::steppers::SymplecticEuler),
        steps_per_period: 1,
    };
    // c² / L² of the slowest material, c² = E / ρ
    let waves = |material: &Material| material.small_strain.youngs_modulus() / material.density;
    let slowest = body.materials.all.iter().map(waves).fold(f64::INFINITY, f64::min);
    let bounds = body.mesh.bounds();
    let shift = if is_held { 0.0 } else { -SHIFT * slowest / bounds.diagonal().powi(2) };
    let rigid = if is_held { 0 } else { RIGID };
    let wanted = spec.count + rigid;
    let coordinates = |x: &Vec3| {
        let (from_middle, size) = (*x - (bounds.low + bounds.high) * 0.5, bounds.high - bounds.low);
        let along = |axis| if size[axis] > 0.0 { 2.0 * from_middle[axis] / size[axis] } else { 0.0 };
        Vec3::from_array([0, 1, 2].map(along))
    };
    let state = State { systems: vec![system.initial_state(points)], ..State::default() };
    let model = Model { period: draft.spec.world.period, systems: vec![system], ..Model::default() };
    model.start(state).with_system(0, |system, state, around, ws| {
        let polynomials = spec.degree.map(|degree| {
            let places: Vec<Vec3> = body.mesh.points.iter().map(coordinates).collect();
            (monomials(degree, &places), places)
        });
        let mut of_mesh = Vec::new();
        let mut modes = if let Some((fields, places)) = &polynomials {
            if is_held {
                refuse_loose(system, places)?;
            }
            // what these cannot be compared with is not told
            if spec.global.is_empty() {
                let settings = Settings { count: wanted, shift, ..Settings::default() };
                let found = lowest(system, state, around, ws, &settings);
                of_mesh.extend(found.into_iter().flat_map(|found| found.eigenvalues).skip(rigid));
            }
            within(system, state, around, ws, fields, &[])?
        } else {
            // across deformations of the whole there are as many fewer; one more tells whether a pair is split
            let count = wanted + spec.global.len();
            let mut sought =
                |count| lowest(system, state, around, ws, &Settings { count, shift, ..Settings::default() });
            let found = match sought(count + 1) {
                Err(error) if error.available().is_some_and(|available| available >= count) => sought(count)?,
                found => found?,
            };
            RitzPairs { eigenvalues: found.eigenvalues, shapes: found.shapes }
        };
        let mut global = RitzPairs::default();
        if !spec.global.is_empty() && modes.shapes.len() > rigid {
            let arms: Vec<Vec3> = body.mesh.points.iter().map(|x| *x - centre).collect();
            let axes = souple_math::exponential(body.spec.placement.rotation);
            let fields: Vec<Vec<Vec3>> = (spec.global.iter())
                .map(|of| arms.iter().map(|s| axes * of.at(axes.transpose() * *s)).collect())
                .collect();
            let mut apart = rigid_motions(&arms);
            global = within(system, state, around, ws, &fields, &apart)?;
            if global.shapes.len() < fields.len() {
                return Ok(Found { modes, global, next: None, of_mesh });
            }
            apart.extend(global.shapes.iter().cloned());
            let space = polynomials.as_ref().map_or(&modes.shapes[rigid..], |(fields, _)| fields);
            let across = within(system, state, around, ws, space, &apart)?;
            modes.truncate(rigid);
            modes.append(across);
        }
        let available = modes.shapes.len();
        if available < wanted {
            return Err(ModesError::too_many(wanted + spec.global.len(), available + spec.global.len()));
        }
        let next = modes.eigenvalues.get(wanted).copied();
        modes.truncate(wanted);
        Ok(Found { modes, global, next, of_mesh })
    })
}

/// The finite elements of a body whose points are rows from `first_row` on.
pub fn description<'a>(body: &'a Placed, first_row: usize) -> SolidDescription<'a> {
    SolidDescription {
        name: solid_name(&body.spec.name),
        mesh: &body.mesh,
        first_row,
        materials: &body.materials.all,
        material_of_cell: &body.materials.of_cell,
        axes: &body.axes,
        quadrature: body.spec.quadrature,
        section: body.spec.section(),
    }
}
