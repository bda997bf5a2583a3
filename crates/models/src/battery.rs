//! Derived expressions of an element under a law, tried: forces against energies, differentials against forces, symmetry, rigid
//! motion, sums, and the law at the samples as bodies take it (EXP-6 of the solids' specification).
//!
//! Expressions are tried as bodies take them, in tensors; on elements of first order under their usual rule also written out in
//! numbers, as code is emitted, and with fragments added up, cut along every axis and in one other way for each law and element; and
//! hexahedra and quadrilaterals as boxes too. Cells are crooked, or boxes of three different sides, in several shapes, and their
//! displacements have no symmetry; all are the same in every run.

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
    /// Of the matrix of `δF`, all of it.
    pub symmetry: f64,
    /// Forces of a cell that is turned and moved, over those of the bent one; zero where the law counts turns as strain.
    pub rigid: f64,
    /// The same where the law counts turns as strain; zero where it does not.
    pub turned: f64,
    /// Sums of forces, and of moments where the law does not count turns as strain.
    pub balance: f64,
    /// Of the law at the samples, by the kernels of bodies.
    pub samples: f64,
    /// Of forces and differential that are cut and added up, from those that are not.
    pub fragments: f64,
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
        fragments: 1e-12,
    };

    /// Its numbers by name.
    pub fn named(&self) -> [(&'static str, f64); 8] {
        [
            ("force", self.force),
            ("differential", self.differential),
            ("symmetry", self.symmetry),
            ("rigid", self.rigid),
            ("turned", self.turned),
            ("balance", self.balance),
            ("samples", self.samples),
            ("fragments", self.fragments),
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
            fragments: worse(self.fragments, other.fragments),
        }
    }

    /// Tries a law on an element under a rule.
    ///
    /// # Errors
    /// The law's text is none, or a cell is nearly turned inside out at a point of the rule.
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
        let is_objective = compiled.strain == Strain::Finite;
        let mut battery = Self::default();
        let mut uncut = Vec::new();
        for (map, form, cut) in forms(law.name, kind, rule) {
            let element = element_data(kind, rule, map).map_err(|error| untried(error.to_string()))?;
            let mut cell = Cell::new(kind, map, (form, cut), &element, &compiled);
            for (number, shape) in SHAPES.into_iter().enumerate() {
                cell.lay(shape);
                let kept = cell.least_volume(rule);
                if kept < LEAST_VOLUME {
                    return Err(untried(format!("{shape:?} leaves {kept} of the volume at a point")));
                }
                let samples = cell.forces_at_samples(rule, &material).map_err(&untried)?;
                let mut tried = cell.battery(trying, is_objective, &samples);
                // the first form is uncut, of the same crooked cells
                if map == MapKind::General && cut != Cut::NONE {
                    tried.fragments = cell.whole(trying.fault).distance(&uncut[number]);
                } else if uncut.len() <= number {
                    uncut.push(cell.whole(0.0));
                }
                battery = battery.worse(tried);
            }
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
    /// In numbers.
    Numbers,
}

/// How a cell is laid.
#[derive(Clone, Copy, Debug)]
struct Shape {
    /// Of what has no symmetry.
    phase: f64,
    /// How far nodes are at rest from where they are in the reference, at most, along each axis.
    crooked: f64,
    /// How far nodes are displaced, at most, along each axis.
    bent: f64,
}

/// A mild one, one that is more crooked, and one that is bent more. Phases are such that no fibre at a sample comes to bear
/// within a step of the differences, where forces have a kink.
const SHAPES: [Shape; 3] = [
    Shape { phase: 0.4, crooked: 0.02, bent: 0.05 },
    Shape { phase: 1.8, crooked: 0.08, bent: 0.05 },
    Shape { phase: 3.0, crooked: 0.03, bent: 0.07 },
];

/// What must be left of its volume at each point of a rule, in the reference and of the cell at rest. Logarithms of a
/// volume `J` have differences by a step `h` that are off by `(h ∂J/∂u)²/3J²`, relative: where nothing is left, by all.
const LEAST_VOLUME: f64 = 0.5;

/// A cut that is neither none nor all, another for another law or element.
fn some_cut(law: &str, kind: ElementKind) -> Cut {
    let number: usize = law.bytes().chain(kind.name().bytes()).map(usize::from).sum();
    Cut::every().nth(1 + number % 14).unwrap_or(Cut::ALL)
}

/// The forms that a law on an element is tried in under a rule, that which is not cut first.
fn forms(law: &str, kind: ElementKind, rule: &QuadratureRule) -> Vec<(MapKind, Form, Cut)> {
    let mut forms = vec![(MapKind::General, Form::Tensors, Cut::NONE)];
    // written out, elements of second order are as long as a book
    let is_usual = rule.name == kind.default_rule().name && kind.is_linear();
    if is_usual {
        forms.push((MapKind::General, Form::Numbers, Cut::NONE));
        forms.push((MapKind::General, Form::Tensors, Cut::ALL));
        forms.push((MapKind::General, Form::Tensors, some_cut(law, kind)));
        if kind.element().nodes.len() <= 4 {
            forms.push((MapKind::General, Form::Numbers, some_cut(law, kind)));
        }
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
    /// Constants by rest positions and the law's numbers.
    start: Tape,
    numbers: Vec<f64>,
    tape: Tape,
    constants: Vec<f64>,
    outputs: usize,
}

/// One cell and its expressions.
struct Cell {
    kind: ElementKind,
    map: MapKind,
    dimension: usize,
    shape: Shape,
    rest: Vec<Vec3>,
    energy: Fragments,
    force: Fragments,
    differential: Fragments,
}

/// What expressions give of a bent cell: forces, and their change along a variation.
struct Whole([Vec<f64>; 2]);

impl Whole {
    /// Relative to the other.
    fn distance(&self, other: &Self) -> f64 {
        self.0.iter().zip(&other.0).map(|(own, other)| distance(other, own)).fold(0.0, worse)
    }
}

/// Expressions that add up.
struct Fragments(Vec<Running>);

/// A displacement and a variation of every node, flat.
type Lane = (Vec<f64>, Vec<f64>);

impl Cell {
    fn new(
        kind: ElementKind,
        map: MapKind,
        (form, cut): (Form, Cut),
        element: &ElementData,
        law: &EnergyLaw,
    ) -> Self {
        let [energy, force, differential] = match form {
            Form::Tensors => {
                let steps = element.steps(law, cut);
                let given = Given { graph: &steps.graph, law, symbols: &steps.symbols };
                let running = |step: &Step| given.running(&step.constants, &step.definitions, &step.outputs);
                [&steps.energies, &steps.forces, &steps.differentials]
                    .map(|addends| Fragments(addends.iter().map(running).collect()))
            }
            Form::Numbers => {
                let derived = element.derive(law, cut);
                let given = Given { graph: &derived.graph, law, symbols: &derived.symbols };
                let running = |fragment: &ElementExpressions| {
                    let grouped = &fragment.grouped;
                    given.running(&grouped.constants, &[], &grouped.varying)
                };
                [&derived.energies, &derived.forces, &derived.differentials]
                    .map(|addends| Fragments(addends.iter().map(running).collect()))
            }
        };
        // no cell before it is laid
        let (shape, rest) = (SHAPES[0], Vec::new());
        Self { kind, map, dimension: element.dimension, shape, rest, energy, force, differential }
    }

    /// Rests in this shape.
    fn lay(&mut self, shape: Shape) {
        let Shape { phase, crooked, .. } = shape;
        let side = |axis: usize| 1.0 + 5.0 * crooked * wave(axis, phase);
        // middles of edges stay near the middle
        let shift = |node: usize, axis: usize| {
            if axis < self.dimension { crooked * wave(3 * node + axis, phase) } else { 0.0 }
        };
        let nodes = self.kind.element().nodes.iter().enumerate();
        self.rest = nodes
            .map(|(node, xi)| {
                Vec3::from_array([0, 1, 2].map(|axis| match self.map {
                    MapKind::Box => side(axis) * xi[axis],
                    MapKind::General => xi[axis] + shift(node, axis),
                }))
            })
            .collect();
        self.shape = shape;
        let rest = self.flat(&self.rest);
        for fragments in [&mut self.energy, &mut self.force, &mut self.differential] {
            fragments.0.iter_mut().for_each(|running| running.rest_in(&rest));
        }
    }

    /// What is left of its volume at the points of a rule, the least of all: at rest, of the reference's or a box's own,
    /// and bent, of what it is at rest.
    fn least_volume(&self, rule: &QuadratureRule) -> f64 {
        let moved = self.rest.iter().zip(self.vectors(&self.bent()));
        let bent: Vec<Vec3> = moved.map(|(rest, u)| *rest + u).collect();
        let volume = |places: &[Vec3], xi: Vec3| {
            let [a, b, c] = self.kind.jacobian(places, xi).columns;
            // normals of plane cells turn over with them
            a.cross(b).dot(if self.dimension == 2 { Vec3::AXES[2] } else { c })
        };
        let left = |xi: Vec3| {
            let at_rest = volume(&self.rest, xi);
            let own = if self.map == MapKind::Box { 1.0 } else { at_rest };
            own.min(volume(&bent, xi) / at_rest)
        };
        rule.points.iter().map(|point| left(point.position)).fold(f64::INFINITY, f64::min)
    }

    /// Forces, bent, and one product.
    fn whole(&self, fault: f64) -> Whole {
        let bent = self.bent();
        let direction = self.field(1.0, 0.2);
        let mut answers = [
            self.force.run(&[(bent.clone(), vec![0.0; self.len()])]).concat(),
            self.differential.run(&[(bent, direction)]).concat(),
        ];
        answers.iter_mut().for_each(|answer| answer[0] += fault * norm(answer));
        Whole(answers)
    }

    fn len(&self) -> usize {
        self.rest.len() * self.dimension
    }

    /// A field of this size, by node and axis.
    fn field(&self, size: f64, phase: f64) -> Vec<f64> {
        (0..self.len()).map(|number| size * wave(number, phase)).collect()
    }

    fn bent(&self) -> Vec<f64> {
        self.field(self.shape.bent, self.shape.phase + 0.7)
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
        let mut battery = Battery { symmetry: self.asymmetry(fault), ..Battery::default() };
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

    /// The matrix of the differential less its transpose, over itself.
    fn asymmetry(&self, fault: f64) -> f64 {
        let (bent, count) = (self.bent(), self.len());
        let unit = |along: usize| (0..count).map(|number| f64::from(u8::from(number == along))).collect();
        let lanes: Vec<Lane> = (0..count).map(|along| (bent.clone(), unit(along))).collect();
        let mut columns: Vec<Vec<f64>> =
            lanes.chunks(BATCH).flat_map(|lanes| self.differential.run(lanes)).collect();
        columns.iter_mut().for_each(|column| column[0] += fault * norm(column));
        let rows: Vec<f64> =
            (0..count).flat_map(|row| columns.iter().map(move |column| column[row])).collect();
        distance(&columns.concat(), &rows)
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
    /// Outputs by constants and definitions.
    fn running(&self, constants: &[(Expr, Expr)], definitions: &[(Expr, Expr)], outputs: &[Expr]) -> Running {
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
        let inputs: Vec<Expr> = flat(&self.symbols.displacements).into_iter().chain(symbols).collect();
        let varied = flat(&self.symbols.variations);
        let tape = Tape::of_expressions(graph, [&inputs, &varied], definitions, outputs, &law.parameters);
        let constants = vec![f64::NAN; constants.len()];
        Running { start, numbers: numbers.collect(), tape, constants, outputs: outputs.len() }
    }
}

impl Running {
    /// Constants of a cell at rest in these places, by node and axis.
    fn rest_in(&mut self, rest: &[f64]) {
        let Self { start, numbers, constants, .. } = self;
        let mut memory = vec![0.0; start.memory_len()];
        start.prepare(&mut memory);
        for (input, number) in rest.iter().chain(&*numbers).enumerate() {
            memory[start.input(input)] = *number;
        }
        start.run_here(Part::All, 1, &mut memory);
        for (constant, value) in constants.iter_mut().enumerate() {
            *value = memory[start.output(constant, 0)];
        }
    }

    /// The outputs of each lane.
    fn run(&self, lanes: &[Lane]) -> Vec<Vec<f64>> {
        let Self { tape, constants, outputs, .. } = self;
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
