//! Derived expressions of an element under a law, tried: forces against energies, differentials against forces, symmetry, rigid
//! motion, sums, and the law at the samples as bodies take it (EXP-6 of the solids' specification).
//!
//! Expressions are tried as bodies take them, in tensors; on elements of first order under their usual rule also written out in
//! numbers, as code is emitted, and cut along every axis, fragments added up; and hexahedra and quadrilaterals as boxes too. The cell is crooked, or a box of three
//! different sides, and its displacements have no symmetry; both are the same in every run.

use std::ops::Range;

use souple_engine::{Configuration, Force};
use souple_formal::element::{Cut, ElementData, ElementExpressions, Step, Symbols};
use souple_formal::graph::{Expr, Graph};
use souple_formal::law::{EnergyLaw, LawParameter, Strain};
use souple_formal::tape::{BATCH, Part, Tape};
use souple_math::{Vec3, exponential};
use souple_mesh::{ElementKind, Mesh, QuadratureRule};
use souple_table::{Value, Values};

use crate::derive::{MapKind, element_data};
use crate::materials::{self, Material, WrittenLaw};
use crate::solids::{Quadrature, Section, SolidDescription, SolidForce};

/// How expressions are tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trying {
    /// Of differences, of a cell of size one.
    pub step: f64,
    /// A fault that must be seen: this share of their size is added to the first force and the first differential.
    pub fault: f64,
}

impl Default for Trying {
    fn default() -> Self {
        // the cube root of what rounding leaves
        Self { step: 1e-5, fault: 0.0 }
    }
}

/// How far expressions are off, relative to forces, products and energies of their size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Battery {
    /// Of `F = -∂W/∂U`, by central differences.
    pub force: f64,
    /// Of `δF = ∂F/∂U V`, by central differences.
    pub differential: f64,
    /// Of `a·δF(b) = b·δF(a)`.
    pub symmetry: f64,
    /// Forces of a cell that is turned and moved, over those of the bent one; zero where the law counts turns as strain.
    pub rigid: f64,
    /// The same where the law counts turns as strain; zero where it does not.
    pub turned: f64,
    /// Sums of forces, and of moments where the law does not count turns as strain.
    pub balance: f64,
    /// Of the law at the samples, by the kernels of bodies.
    pub samples: f64,
}

/// Why an association cannot be tried.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{law} on {kind} under {rule}: {problem}")]
pub struct Untried {
    pub law: &'static str,
    pub kind: ElementKind,
    pub rule: &'static str,
    pub problem: String,
}

impl Battery {
    /// The bounds of the specification; there is none on what a law that counts turns as strain makes of them.
    pub const BOUNDS: Self = Self {
        force: 1e-6,
        differential: 1e-6,
        symmetry: 1e-12,
        rigid: 1e-10,
        turned: f64::INFINITY,
        balance: 1e-10,
        samples: 1e-10,
    };

    /// Its numbers by name.
    pub fn named(&self) -> [(&'static str, f64); 7] {
        [
            ("force", self.force),
            ("differential", self.differential),
            ("symmetry", self.symmetry),
            ("rigid", self.rigid),
            ("turned", self.turned),
            ("balance", self.balance),
            ("samples", self.samples),
        ]
    }

    /// The worse of both, number by number; what is not a number is worst.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        Self {
            force: worse(self.force, other.force),
            differential: worse(self.differential, other.differential),
            symmetry: worse(self.symmetry, other.symmetry),
            rigid: worse(self.rigid, other.rigid),
            turned: worse(self.turned, other.turned),
            balance: worse(self.balance, other.balance),
            samples: worse(self.samples, other.samples),
        }
    }

    /// Tries a law on an element under a rule.
    ///
    /// # Errors
    /// The law's text is none, or the crooked cell has no volume under the rule.
    pub fn of(
        law: &'static WrittenLaw,
        kind: ElementKind,
        rule: &'static QuadratureRule,
        trying: Trying,
    ) -> Result<Self, Untried> {
        let untried = |problem: String| Untried { law: law.name, kind, rule: rule.name, problem };
        let text = law.text().map_err(|error| untried(error.to_string()))?;
        let compiled = EnergyLaw::compile(&text).map_err(|error| untried(error.to_string()))?;
        let material = material(law).map_err(&untried)?;
        let mut battery = Self::default();
        for (map, form, cut) in forms(kind, rule) {
            let element = element_data(kind, rule, map).map_err(|error| untried(error.to_string()))?;
            let Some(cell) = Cell::new(kind, (map, form, cut), &element, &compiled) else { continue };
            let samples = cell.forces_at_samples(rule, &material).map_err(&untried)?;
            battery = battery.worse(cell.battery(trying, compiled.strain == Strain::Finite, &samples));
        }
        Ok(battery)
    }
}

/// The law as a material of bodies.
fn material(law: &WrittenLaw) -> Result<Material, String> {
    let owned = |list: &[(&str, &str)]| -> Vec<(String, String)> {
        list.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect()
    };
    let (parameters, definitions) = (owned(law.parameters), owned(law.definitions));
    let entry = materials::TABLE.find("hyperelastic").map_err(|unknown| unknown.to_string())?;
    let values = Values::new()
        .with("energy", Value::Text(law.energy))
        .with("parameters", Value::Texts(&parameters))
        .with("definitions", Value::Texts(&definitions))
        .with("density", Value::Number(1000.0));
    let values = entry.values(values).map_err(|error| error.to_string())?;
    (entry.build)(&values).map_err(|error| error.to_string())
}

/// How expressions are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// In tensors.
    Tensors,
    /// In numbers; laws of principal stretches have no such form.
    Numbers,
}

/// The forms that an element is tried in under a rule.
fn forms(kind: ElementKind, rule: &QuadratureRule) -> Vec<(MapKind, Form, Cut)> {
    let mut forms = vec![(MapKind::General, Form::Tensors, Cut::NONE)];
    // written out, elements of second order are as long as a book
    let is_usual = rule.name == kind.default_rule().name && kind.is_linear();
    if is_usual {
        forms.push((MapKind::General, Form::Numbers, Cut::NONE));
        forms.push((MapKind::General, Form::Tensors, Cut::ALL));
    }
    if element_data(kind, rule, MapKind::Box).is_ok() {
        forms.push((MapKind::Box, Form::Tensors, Cut::NONE));
        if is_usual {
            forms.push((MapKind::Box, Form::Numbers, Cut::NONE));
        }
    }
    forms
}

/// Numbers without symmetry between -1 and 1.
fn wave(number: usize, phase: f64) -> f64 {
    (12.9898 * number as f64 + phase).sin()
}

/// An expression of displacements, and what is multiplied with, as it is run.
struct Running {
    tape: Tape,
    constants: Vec<f64>,
    outputs: usize,
}

/// One cell and its expressions.
struct Cell {
    kind: ElementKind,
    dimension: usize,
    rest: Vec<Vec3>,
    energy: Fragments,
    force: Fragments,
    differential: Fragments,
}

/// Expressions that add up.
struct Fragments(Vec<Running>);

/// A displacement and a variation of every node, flat.
type Lane = (Vec<f64>, Vec<f64>);

impl Cell {
    /// `None` where the law has no such form.
    fn new(
        kind: ElementKind,
        (map, form, cut): (MapKind, Form, Cut),
        element: &ElementData,
        law: &EnergyLaw,
    ) -> Option<Self> {
        let dimension = element.dimension;
        let nodes = kind.element().nodes;
        let rest: Vec<Vec3> = nodes
            .iter()
            .enumerate()
            .map(|(node, xi)| {
                if map == MapKind::Box {
                    return Vec3::new(0.9 * xi[0], 1.1 * xi[1], 1.05 * xi[2]);
                }
                // middles of edges stay near the middle
                let shift = |axis: usize| {
                    if axis < dimension { 0.02 * wave(3 * node + axis, 0.4) } else { 0.0 }
                };
                Vec3::from_array(*xi) + Vec3::new(shift(0), shift(1), shift(2))
            })
            .collect();
        let [energy, force, differential] = match form {
            Form::Tensors => {
                let steps = element.steps(law, cut);
                let given = Given { graph: &steps.graph, law, symbols: &steps.symbols };
                let running =
                    |step: &Step| given.running(&rest, &step.constants, &step.definitions, &step.outputs);
                [&steps.energies, &steps.forces, &steps.differentials]
                    .map(|addends| Fragments(addends.iter().map(running).collect()))
            }
            Form::Numbers => {
                let derived = element.derive(law, cut).ok()?;
                let given = Given { graph: &derived.graph, law, symbols: &derived.symbols };
                let running = |fragment: &ElementExpressions| {
                    let grouped = &fragment.grouped;
                    given.running(&rest, &grouped.constants, &[], &grouped.varying)
                };
                [&derived.energies, &derived.forces, &derived.differentials]
                    .map(|addends| Fragments(addends.iter().map(running).collect()))
            }
        };
        Some(Self { kind, dimension, rest, energy, force, differential })
    }

    fn len(&self) -> usize {
        self.rest.len() * self.dimension
    }

    /// A field of this size, by node and axis.
    fn field(&self, size: f64, phase: f64) -> Vec<f64> {
        (0..self.len()).map(|number| size * wave(number, phase)).collect()
    }

    fn bent(&self) -> Vec<f64> {
        self.field(0.05, 1.1)
    }

    /// By node and axis, of vectors that lie in the plane of plane cells.
    fn flat(&self, vectors: &[Vec3]) -> Vec<f64> {
        vectors.iter().flat_map(|v| v.to_array()[..self.dimension].to_vec()).collect()
    }

    fn vectors(&self, flat: &[f64]) -> Vec<Vec3> {
        flat.chunks_exact(self.dimension)
            .map(|v| Vec3::new(v[0], v[1], v.get(2).copied().unwrap_or(0.0)))
            .collect()
    }

    fn battery(&self, Trying { step, fault }: Trying, is_objective: bool, at_samples: &[f64]) -> Battery {
        let (bent, still) = (self.bent(), vec![0.0; self.len()]);
        let directions = [0.2, 1.7, 3.3].map(|phase| self.field(1.0, phase));
        let moved = |direction: &Vec<f64>, by: f64| -> Vec<f64> {
            bent.iter().zip(direction).map(|(u, d)| u + by * d).collect()
        };
        let mut lanes: Vec<Lane> = vec![(bent.clone(), still.clone())];
        for direction in &directions {
            lanes.extend([step, -step].map(|by| (moved(direction, by), still.clone())));
        }
        lanes.push((self.turned(), still.clone()));
        let energies = self.energy.run(&lanes);
        let mut forces = self.force.run(&lanes);
        let products: Vec<Lane> =
            directions.iter().map(|direction| (bent.clone(), direction.clone())).collect();
        let mut products = self.differential.run(&products);
        let size = norm(&forces[0]);
        forces.iter_mut().for_each(|force| force[0] += fault * size);
        products.iter_mut().for_each(|product| product[0] += fault * norm(product));
        let force = &forces[0];
        let mut battery = Battery::default();
        for (index, direction) in directions.iter().enumerate() {
            let (ahead, behind) = (1 + 2 * index, 2 + 2 * index);
            let slope = (energies[ahead][0] - energies[behind][0]) / (2.0 * step);
            let off = (slope + dot(force, direction)).abs() / (norm(force) * norm(direction));
            battery.force = worse(battery.force, off);
            let difference: Vec<f64> = forces[ahead]
                .iter()
                .zip(&forces[behind])
                .map(|(ahead, behind)| (ahead - behind) / (2.0 * step))
                .collect();
            battery.differential = worse(battery.differential, distance(&products[index], &difference));
            let next = (index + 1) % directions.len();
            let (one, other) = (dot(&directions[next], &products[index]), dot(direction, &products[next]));
            let size = norm(&directions[next]) * norm(&products[index]);
            battery.symmetry = worse(battery.symmetry, (one - other).abs() / size);
        }
        let f = self.vectors(force);
        let x = self.rest.iter().zip(self.vectors(&bent)).map(|(rest, u)| *rest + u);
        let sum: Vec3 = f.iter().copied().sum();
        let moment: Vec3 = x.zip(&f).map(|(x, f)| x.cross(*f)).sum();
        battery.balance = sum.length() / norm(force);
        let turned = norm(&forces[forces.len() - 1]) / norm(force);
        if is_objective {
            battery.balance = worse(battery.balance, moment.length() / norm(force));
            battery.rigid = turned;
        } else {
            battery.turned = turned;
        }
        battery.samples = distance(at_samples, force);
        battery
    }

    /// Turned and moved, in the plane of a plane cell.
    fn turned(&self) -> Vec<f64> {
        let (turn, shift) = if self.dimension == 2 {
            (Vec3::new(0.0, 0.0, 0.9), Vec3::new(0.3, -0.2, 0.0))
        } else {
            (Vec3::new(0.6, -0.8, 0.5), Vec3::new(0.3, -0.2, 0.4))
        };
        let rotation = exponential(turn);
        let moved: Vec<Vec3> = self.rest.iter().map(|p| rotation * *p + shift - *p).collect();
        self.flat(&moved)
    }

    /// The forces of a body of this one cell, bent.
    fn forces_at_samples(&self, rule: &QuadratureRule, material: &Material) -> Result<Vec<f64>, String> {
        let nodes: Vec<u32> = (0..self.rest.len() as u32).collect();
        let mesh = Mesh::new(self.rest.clone(), self.kind, nodes);
        let section =
            if self.dimension == 2 { Section::PlaneStrain { thickness: 1.0 } } else { Section::Solid };
        let force = SolidForce::of_samples(&SolidDescription {
            name: "cell".to_owned(),
            mesh: &mesh,
            first_row: 0,
            materials: std::slice::from_ref(material),
            material_of_cell: &[0],
            axes: &[],
            quadrature: Quadrature::Default.with(self.kind, rule),
            section,
        });
        let force = force.map_err(|error| error.to_string())?;
        let bent = self.vectors(&self.bent());
        let positions: Vec<Vec3> = self.rest.iter().zip(&bent).map(|(rest, u)| *rest + *u).collect();
        let velocities = vec![Vec3::ZERO; positions.len()];
        let at = Configuration {
            positions: &positions,
            velocities: &velocities,
            time: 0.0,
            load: 1.0,
            memory: &[],
            pairs: &[],
            kept: souple_engine::KeptRef::default(),
            driven: &[],
            fields: &[],
        };
        let mut sum = velocities.clone();
        force.add_force(&at, &mut force.new_scratch(), &mut sum);
        Ok(self.flat(&sum))
    }
}

/// What expressions are of.
struct Given<'a> {
    graph: &'a Graph,
    law: &'a EnergyLaw,
    symbols: &'a Symbols,
}

impl Given<'_> {
    /// Outputs by constants and definitions, for a cell at rest in these places.
    fn running(
        &self,
        rest: &[Vec3],
        constants: &[(Expr, Expr)],
        definitions: &[(Expr, Expr)],
        outputs: &[Expr],
    ) -> Running {
        let Self { graph, law, .. } = self;
        let flat = |list: &[Vec<Expr>]| list.iter().flatten().copied().collect::<Vec<Expr>>();
        let mut given = flat(&self.symbols.rest);
        given.extend(&self.symbols.parameters);
        let (symbols, values): (Vec<Expr>, Vec<Expr>) = constants.iter().copied().unzip();
        let start = Tape::of_expressions(graph, [&given, &[]], constants, &values, &law.parameters);
        let numbers = law.parameters.iter().filter_map(|(_, parameter)| match parameter {
            LawParameter::Number { value, .. } => Some(*value),
            LawParameter::Direction(_) => None,
        });
        let dimension = self.symbols.rest[0].len();
        let rest = rest.iter().flat_map(|p| p.to_array()[..dimension].to_vec());
        let mut memory = vec![0.0; start.memory_len()];
        start.prepare(&mut memory);
        for (input, number) in rest.chain(numbers).enumerate() {
            memory[start.input(input)] = number;
        }
        start.run_here(Part::All, 1, &mut memory);
        let of_start = |constant: usize| memory[start.output(constant, 0)];
        let inputs: Vec<Expr> = flat(&self.symbols.displacements).into_iter().chain(symbols).collect();
        let varied = flat(&self.symbols.variations);
        let tape = Tape::of_expressions(graph, [&inputs, &varied], definitions, outputs, &law.parameters);
        Running { tape, constants: (0..constants.len()).map(of_start).collect(), outputs: outputs.len() }
    }
}

impl Fragments {
    /// The sums of each lane.
    fn run(&self, lanes: &[Lane]) -> Vec<Vec<f64>> {
        let add = |mut sums: Vec<Vec<f64>>, addends: Vec<Vec<f64>>| {
            for (sum, addend) in sums.iter_mut().flatten().zip(addends.into_iter().flatten()) {
                *sum += addend;
            }
            sums
        };
        self.0.iter().map(|fragment| fragment.run(lanes)).reduce(add).unwrap_or_default()
    }
}

impl Running {
    /// The outputs of each lane.
    fn run(&self, lanes: &[Lane]) -> Vec<Vec<f64>> {
        let Self { tape, constants, outputs } = self;
        debug_assert!(lanes.len() <= BATCH, "one batch");
        let mut memory = vec![0.0; tape.memory_len()];
        tape.prepare(&mut memory);
        let of_lanes: Range<usize> = 0..lanes.len();
        for (lane, (displacements, variations)) in lanes.iter().enumerate() {
            for (input, number) in displacements.iter().chain(constants).enumerate() {
                memory[tape.input(input) + lane] = *number;
            }
            for (input, number) in variations.iter().enumerate() {
                memory[tape.varied(input) + lane] = *number;
            }
        }
        tape.run_here(Part::All, lanes.len(), &mut memory);
        of_lanes
            .map(|lane| (0..*outputs).map(|output| memory[tape.output(output, 0) + lane]).collect())
            .collect()
    }
}

/// The greater; what is no number is worst.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// Relative to the first.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    norm(&difference) / norm(a)
}
