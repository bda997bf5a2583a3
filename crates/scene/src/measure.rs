//! Probes at work: a quantity read off a running world.

use souple_engine::{System, World};
use souple_math::Vec3;
use souple_models::contact::{ShapeContact, SurfaceContact};
use souple_models::solids::SolidForce;

use crate::compile::{Draft, solid_name};
use crate::spec::probe::{Component, Probe, Quantity, Reduction, Subject};

/// A probe that knows where to read.
#[derive(Clone, Debug)]
pub struct ProbeInfo {
    pub name: String,
    /// SI unit of its values.
    pub unit: &'static str,
    /// The quantity's name.
    pub quantity: &'static str,
    what: Quantity,
    component: Option<Component>,
    reduction: Reduction,
    /// Only the forces of this contact.
    contact: Option<String>,
    target: Target,
}

/// What is read.
#[derive(Clone, Debug)]
enum Target {
    World,
    /// Rows of a system, with where they started [m].
    Rows {
        system: usize,
        rows: Vec<u32>,
        starts: Vec<Vec3>,
    },
    /// Cells of the solid of this name.
    Cells {
        system: usize,
        solid: String,
        cells: Vec<u32>,
    },
}

/// What a probe reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measurement {
    Number(f64),
    Vector(Vec3),
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
    /// `None` where the region was refused.
    pub(crate) fn compile(probe: &Probe, draft: &Draft) -> Option<Self> {
        let target = match probe.quantity.subject {
            Subject::World => Target::World,
            Subject::Points | Subject::Body => {
                let body = draft.body(probe.body.as_deref()?)?;
                let points: Vec<u32> = match &probe.region {
                    Some(region) => draft.selector(body).points(region),
                    None => (0..body.mesh.points.len() as u32).collect(),
                };
                let starts = points.iter().map(|point| body.mesh.points[*point as usize]).collect();
                let rows = points.iter().map(|point| body.rows.start as u32 + point).collect();
                Target::Rows { system: body.system, rows, starts }
            }
            Subject::Cells => {
                let body = draft.body(probe.body.as_deref()?)?;
                let cells = match &probe.region {
                    Some(region) => draft.selector(body).cells(region),
                    None => (0..body.mesh.cell_count() as u32).collect(),
                };
                Target::Cells { system: body.system, solid: solid_name(&body.spec.name), cells }
            }
        };
        Some(Self {
            name: probe.name.clone(),
            unit: probe.quantity.unit,
            quantity: probe.quantity.name,
            what: probe.quantity.quantity,
            component: probe.component,
            reduction: probe.reduction,
            contact: probe.contact.clone(),
            target,
        })
    }

    /// Whether its values are vectors.
    pub fn gives_vector(&self) -> bool {
        let is_vector = matches!(
            self.what,
            Quantity::Displacement
                | Quantity::Position
                | Quantity::Velocity
                | Quantity::Reaction
                | Quantity::ContactForce
                | Quantity::Momentum
                | Quantity::AngularMomentum
        );
        is_vector && self.component.is_none()
    }

    /// The quantity at the committed state.
    pub fn measure(&self, world: &mut World) -> Measurement {
        match &self.target {
            Target::World => self.of_world(world),
            Target::Rows { system, rows, starts } => self.of_rows(world, *system, rows, starts),
            Target::Cells { system, solid, cells } => {
                Measurement::Number(self.of_cells(world, *system, solid, cells))
            }
        }
    }

    fn of_world(&self, world: &mut World) -> Measurement {
        match self.what {
            Quantity::TotalEnergy => Measurement::Number(world.energy().total()),
            Quantity::TotalKineticEnergy => Measurement::Number(world.energy().kinetic),
            Quantity::Momentum => self.vector(world.momentum().0),
            Quantity::AngularMomentum => self.vector(world.momentum().1),
            _ => Measurement::Number(world.time()),
        }
    }

    fn vector(&self, vector: Vec3) -> Measurement {
        match self.component {
            Some(component) => Measurement::Number(component.of(vector)),
            None => Measurement::Vector(vector),
        }
    }

    fn of_rows(&self, world: &mut World, system: usize, rows: &[u32], starts: &[Vec3]) -> Measurement {
        let placed = world.rows(system);
        let position = |row: &u32| placed.positions[*row as usize];
        let velocity = |row: &u32| placed.velocities[*row as usize];
        let vectors: Vec<Vec3> = match self.what {
            Quantity::Position => rows.iter().map(position).collect(),
            Quantity::Velocity => rows.iter().map(velocity).collect(),
            Quantity::KineticEnergy => {
                let mut only = vec![Vec3::ZERO; placed.velocities.len()];
                rows.iter().for_each(|row| only[*row as usize] = velocity(row));
                return Measurement::Number(world.model().systems[system].mass.kinetic_energy(&only));
            }
            Quantity::Reaction => reactions(world, system, rows),
            Quantity::ContactForce => contact_forces(world, system, rows, self.contact.as_deref()),
            _ => rows.iter().zip(starts).map(|(row, start)| position(row) - *start).collect(),
        };
        match self.component {
            Some(component) => {
                let numbers: Vec<f64> = vectors.iter().map(|vector| component.of(*vector)).collect();
                Measurement::Number(reduced(&numbers, &vec![1.0; numbers.len()], self.reduction))
            }
            None => {
                let sum: Vec3 = vectors.iter().copied().sum();
                let divisor = if self.reduction == Reduction::Mean { vectors.len() as f64 } else { 1.0 };
                Measurement::Vector(sum / divisor)
            }
        }
    }

    fn of_cells(&self, world: &World, system: usize, solid: &str, cells: &[u32]) -> f64 {
        let forces = &world.model().systems[system].forces;
        let solid = forces.iter().find(|force| force.name() == solid);
        let Some(solid) = solid.and_then(|force| force.as_any().downcast_ref::<SolidForce>()) else {
            return f64::NAN;
        };
        let positions = &world.rows(system).positions;
        let (mut numbers, mut volumes) = (Vec::with_capacity(cells.len()), Vec::with_capacity(cells.len()));
        for &cell in cells {
            let Some(field) = solid.cell_field(cell as usize, positions) else { continue };
            numbers.push(match self.what {
                Quantity::VonMises => field.von_mises,
                // tension is positive in stresses, compression in pressures
                Quantity::Pressure => -field.cauchy.trace() / 3.0,
                Quantity::StrainEnergy => field.energy_density * field.volume,
                _ => current_volume(solid, cell, positions),
            });
            volumes.push(field.volume);
        }
        reduced(&numbers, &volumes, self.reduction)
    }
}

/// Volume of a cell as it stands [m³].
fn current_volume(solid: &SolidForce, cell: u32, positions: &[Vec3]) -> f64 {
    let Some(view) = solid.mesh().cell(cell) else { return 0.0 };
    let first = solid.rows().start;
    let corners: Vec<Vec3> = view.nodes.iter().map(|node| positions[first + *node as usize]).collect();
    let rule = view.kind.default_rule();
    rule.points
        .iter()
        .map(|point| point.weight * view.kind.jacobian(&corners, point.position).determinant())
        .sum()
}

/// What holds constrained points against all other forces: minus their sum, along the held directions [N].
fn reactions(world: &mut World, system: usize, rows: &[u32]) -> Vec<Vec3> {
    world.with_system(system, |system: &System, state, around, ws| {
        system.sum_row_forces(&ws.rows, state, around, &mut ws.scratches, &mut ws.row_force);
        let held = |row: u32| {
            let block = system.kinematics.point_block(row)?;
            system.constraints.iter().find(|constraint| constraint.block == block)
        };
        let reaction = |row: &u32| {
            held(*row)
                .map_or(Vec3::ZERO, |constraint| constraint.constrained() * -ws.row_force[*row as usize])
        };
        rows.iter().map(reaction).collect()
    })
}

/// Normal force and friction on points, of one contact or of all [N].
fn contact_forces(world: &mut World, system: usize, rows: &[u32], contact: Option<&str>) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; world.rows(system).positions.len()];
    world.with_system(system, |system: &System, state, around, ws| {
        let named = |name: &str| contact.is_none_or(|contact| contact == name);
        for (index, force) in system.forces.iter().enumerate().filter(|(_, force)| named(force.name())) {
            let at = system.view(index, &ws.rows, state, around);
            if let Some(contact) = force.as_any().downcast_ref::<ShapeContact>() {
                contact.touches(&at).iter().for_each(|touch| sums[touch.row as usize] += touch.force.total());
            }
            if let Some(contact) = force.as_any().downcast_ref::<SurfaceContact>() {
                for touch in contact.touches(&at) {
                    let force = touch.force.total();
                    sums[touch.rows[0] as usize] += force;
                    for (row, weight) in touch.rows[1..].iter().zip(touch.weights) {
                        sums[*row as usize] -= force * weight;
                    }
                }
            }
        }
    });
    rows.iter().map(|row| sums[*row as usize]).collect()
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
    }
}
