//! The tensor-mass method as it is derived by machine: energy, forces and differentials of each kind of element and law as
//! expressions of displacements, with everything that depends on rest positions and material grouped into constants that
//! are computed once (Faure 2014). Hexahedra that are boxes along the axes take the shorter map.

use std::cell::RefCell;
use std::ops::Range;
use std::sync::Arc;

use souple_formal::element::{Cut, Derived, ElementExpressions};
use souple_formal::graph::Expr;
use souple_formal::law::{EnergyLaw, LawParameter};
use souple_formal::tape::{BATCH, Part, Tape};
use souple_math::{Padded, Vec3};
use souple_mesh::{Cell, ElementKind, Mesh};
use souple_table::Entry;

use super::{BuildFormulation, FormulationError, check_cells, name_of};
use crate::derive::{MapKind, element_data};
use crate::materials::{Law, LawVisitor, Material, MaterialLaw, Parameters, WrittenLaw};
use crate::solids::elements::Sorting;
use crate::solids::kernel::Kernel;
use crate::solids::layout::{Chunk, LANES};
use crate::solids::{SolidDescription, SolidForce};

const NAME: &str = "grouped_constants";
const ELEMENTS: &str = "tet4, hex8, prism6 and pyramid5";
const LAWS: &str = "linear, st_venant_kirchhoff, neo_hookean, and laws as text without principal stretches";

pub(super) const ENTRY: Entry<BuildFormulation> = Entry {
    name: NAME,
    summary: "expressions derived for each kind of element and law, with constants of rest shape and material grouped; linear \
              elements",
    source: "Faure 2014, Modélisation de systèmes complexes par approche formelle, ch. 3",
    parameters: &[],
    build: |description| {
        let takes = |kind: ElementKind| kind.dimension() == 3 && kind.corners() == kind;
        check_cells(NAME, description, takes, ELEMENTS)?;
        let sorting = ByAssociation::new(description)?;
        Ok(Box::new(SolidForce::sorted_by(description, &sorting)?.of_displacements(description.mesh)))
    },
};

/// Associations of law, kind and map, and the constants of every cell.
struct ByAssociation {
    kernels: Vec<Arc<Expressions>>,
    of_cell: Vec<usize>,
    constants: Vec<Vec<f64>>,
}

impl Sorting for ByAssociation {
    type Law = usize;
    type Kernel = Box<dyn Kernel>;

    fn law_of(&self, cell: usize) -> &usize {
        &self.of_cell[cell]
    }

    fn parameters_of(&self, cell: usize) -> &[f64] {
        &self.constants[cell]
    }

    fn kernel(&self, _: ElementKind, association: &usize) -> Box<dyn Kernel> {
        Box::new(Arc::clone(&self.kernels[*association]))
    }
}

impl ByAssociation {
    fn new(description: &SolidDescription) -> Result<Self, FormulationError> {
        let SolidDescription { mesh, materials, material_of_cell, quadrature, .. } = description;
        let mut known: Vec<(&MaterialLaw, ElementKind, MapKind)> = Vec::new();
        let mut sorting = Self {
            kernels: Vec::new(),
            of_cell: Vec::with_capacity(mesh.cell_count()),
            constants: vec![Vec::new(); mesh.cell_count()],
        };
        for (cell, material) in mesh.cells().zip(*material_of_cell) {
            let law = &materials[usize::from(*material)].law;
            let key = (law, cell.kind, map_of(mesh, &cell));
            let found = known.iter().position(|known| *known == key);
            sorting.of_cell.push(found.unwrap_or(known.len()));
            if found.is_none() {
                known.push(key);
                let law = energy_law(law)?;
                let element = element_data(key.1, quadrature.rule(key.1), key.2)
                    .unwrap_or_else(|error| unreachable!("only hexahedra are found to be boxes: {error}"));
                let derived = element.derive(&law, Cut::NONE).map_err(|_| refused(key.0))?;
                sorting.kernels.push(Arc::new(Expressions::new(&derived, &law, cell.kind.node_count())));
            }
        }
        for (association, kernel) in sorting.kernels.iter().enumerate() {
            let cells: Vec<usize> =
                (0..mesh.cell_count()).filter(|cell| sorting.of_cell[*cell] == association).collect();
            let numbers = |cell: usize| kernel.numbers_of(&materials[usize::from(material_of_cell[cell])]);
            kernel.compute_constants(mesh, &cells, &numbers, &mut sorting.constants);
        }
        Ok(sorting)
    }
}

fn refused(law: &MaterialLaw) -> FormulationError {
    FormulationError::Law { formulation: NAME, law: name_of(law).to_owned(), accepted: LAWS }
}

/// The law as expressions, its constants being symbols.
fn energy_law(law: &MaterialLaw) -> Result<EnergyLaw, FormulationError> {
    let MaterialLaw::Known(known) = law else {
        let MaterialLaw::Text(text) = law else { unreachable!("a law is known or text") };
        return Ok(text.law().clone());
    };
    let written = WrittenLaw::find(known.entry().name).and_then(|written| written.text().ok());
    let compiled = written.and_then(|text| EnergyLaw::compile(&text).ok()).ok_or_else(|| refused(law))?;
    // the numbers of the table must be those of the text
    let names = known.visit(Names);
    let is_known = |(name, _): &(String, LawParameter)| names.contains(&name.as_str());
    if compiled.parameters.iter().all(is_known) { Ok(compiled) } else { Err(refused(law)) }
}

struct Names;

impl LawVisitor for Names {
    type Output = &'static [&'static str];

    fn visit<L: Law>(self, _: L) -> Self::Output {
        <L::Parameters<f64> as Parameters<f64>>::NAMES
    }
}

/// Off-diagonal part of `∂X/∂ξ`, relative, below which a hexahedron is a box along the axes.
const BOX_TOLERANCE: f64 = 1e-12;

fn map_of(mesh: &Mesh, cell: &Cell) -> MapKind {
    if cell.kind != ElementKind::Hex8 {
        return MapKind::General;
    }
    let corners: Vec<Vec3> = cell.nodes.iter().map(|node| mesh.points[*node as usize]).collect();
    let is_diagonal = |xi: Vec3| {
        let jacobian = cell.kind.jacobian(&corners, xi);
        let off = jacobian - souple_math::Mat3::from_diagonal(jacobian.diagonal());
        off.largest_entry() < BOX_TOLERANCE * jacobian.largest_entry()
    };
    if cell.kind.default_rule().points.iter().all(|point| is_diagonal(point.position)) {
        MapKind::Box
    } else {
        MapKind::General
    }
}

/// [`Kernel`] of one association: what it evaluates, each with constants of its own.
struct Expressions {
    nodes: usize,
    parameters: Vec<String>,
    energy: Expression,
    forces: Expression,
    differential: Expression,
    /// Constants of an element, of all three.
    constant_count: usize,
}

/// Expressions of displacements, their constants, and where these are among the element's.
struct Expression {
    /// From rest positions and material.
    constants: Tape,
    /// From displacements and constants, and what the differential is multiplied with.
    step: Tape,
    range: Range<usize>,
}

thread_local! {
    /// What tapes work in.
    static MEMORY: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

impl Expressions {
    fn new(derived: &Derived, law: &EnergyLaw, nodes: usize) -> Self {
        let flat = |list: &[Vec<Expr>]| list.iter().flatten().copied().collect::<Vec<Expr>>();
        let given: Vec<Expr> =
            flat(&derived.rest).into_iter().chain(derived.parameters.iter().copied()).collect();
        let (displacements, variations) = (flat(&derived.displacements), flat(&derived.variations));
        let mut constant_count = 0;
        let mut expression = |whole: &[ElementExpressions], varied: &[Expr]| {
            let grouped = &whole[0].grouped;
            let (symbols, definitions): (Vec<Expr>, Vec<Expr>) = grouped.constants.iter().copied().unzip();
            let inputs: Vec<Expr> = displacements.iter().chain(&symbols).copied().collect();
            let range = constant_count..constant_count + symbols.len();
            constant_count = range.end;
            let (graph, directions) = (&derived.graph, &law.parameters);
            Expression {
                constants: Tape::of_expressions(
                    graph,
                    [&given, &[]],
                    &grouped.constants,
                    &definitions,
                    directions,
                ),
                step: Tape::of_expressions(graph, [&inputs, varied], &[], &grouped.varying, directions),
                range,
            }
        };
        let energy = expression(&derived.energies, &[]);
        let forces = expression(&derived.forces, &[]);
        let differential = expression(&derived.differentials, &variations);
        let parameters =
            law.parameters.iter().filter(|(_, value)| matches!(value, LawParameter::Number { .. }));
        let parameters = parameters.map(|(name, _)| name.clone()).collect();
        Self { nodes, parameters, energy, forces, differential, constant_count }
    }

    /// The numbers of a material in the order of the law's.
    fn numbers_of(&self, material: &Material) -> Vec<f64> {
        let of_text = |law: &EnergyLaw, name: &String| match law.parameter(name) {
            Some(LawParameter::Number { value, .. }) => *value,
            _ => unreachable!("the text that the association was derived from"),
        };
        let number = |name: &String| match &material.law {
            MaterialLaw::Text(text) => of_text(text.law(), name),
            MaterialLaw::Known(law) => {
                let index = law.visit(Names).iter().position(|known| known == name);
                material.parameters[index.unwrap_or_else(|| unreachable!("checked when it was derived"))]
            }
        };
        self.parameters.iter().map(number).collect()
    }

    /// Writes the constants of cells.
    fn compute_constants(
        &self,
        mesh: &Mesh,
        cells: &[usize],
        numbers_of: &dyn Fn(usize) -> Vec<f64>,
        constants: &mut [Vec<f64>],
    ) {
        cells.iter().for_each(|cell| constants[*cell] = vec![0.0; self.constant_count]);
        for Expression { constants: tape, range, .. } in [&self.energy, &self.forces, &self.differential] {
            let mut memory = vec![0.0; tape.memory_len()];
            tape.prepare(&mut memory);
            for cells in cells.chunks(BATCH) {
                for (lane, cell) in cells.iter().enumerate() {
                    let nodes = mesh.cell(*cell as u32).map_or(&[][..], |cell| cell.nodes);
                    let rest = nodes.iter().flat_map(|node| mesh.points[*node as usize].to_array());
                    for (input, number) in rest.chain(numbers_of(*cell)).enumerate() {
                        memory[tape.input(input) + lane] = number;
                    }
                }
                tape.run_here(Part::All, cells.len(), &mut memory);
                for (lane, cell) in cells.iter().enumerate() {
                    for (output, constant) in constants[*cell][range.clone()].iter_mut().enumerate() {
                        *constant = memory[tape.output(output, 0) + lane];
                    }
                }
            }
        }
    }

    /// Runs `work(memory, first block, blocks)` with the displacements and constants of as many of `blocks` as a tape takes at
    /// once.
    fn for_each_batch(
        &self,
        expression: &Expression,
        chunk: &Chunk,
        blocks: Range<usize>,
        displacements: &[Padded],
        mut work: impl FnMut(&mut [f64], Range<usize>),
    ) {
        let tape = &expression.step;
        MEMORY.with_borrow_mut(|memory| {
            memory.clear();
            memory.resize(tape.memory_len(), 0.0);
            tape.prepare(memory);
            for first in blocks.clone().step_by(BATCH / LANES) {
                let batch = first..blocks.end.min(first + BATCH / LANES);
                for block in batch.clone() {
                    let at = (block - first) * LANES;
                    self.put(chunk, block, displacements, |input| tape.input(input) + at, memory);
                    let constants = &chunk.parameters(block, self.constant_count)[expression.range.clone()];
                    for (constant, lanes) in constants.iter().enumerate() {
                        let input = tape.input(3 * self.nodes + constant) + at;
                        memory[input..input + LANES].copy_from_slice(&lanes.0);
                    }
                }
                work(memory, batch);
            }
        });
    }

    /// Writes a field of a block's nodes where `place` says, by node and direction.
    fn put(
        &self,
        chunk: &Chunk,
        block: usize,
        field: &[Padded],
        place: impl Fn(usize) -> usize,
        memory: &mut [f64],
    ) {
        for node in 0..self.nodes {
            let locals = &chunk.connectivity[(block * self.nodes + node) * LANES..][..LANES];
            let places = [0, 1, 2].map(|axis| place(3 * node + axis));
            for (lane, local) in locals.iter().enumerate() {
                let numbers = Vec3::from(field[usize::from(*local)]).to_array();
                for (axis, place) in places.iter().enumerate() {
                    memory[place + lane] = numbers[axis];
                }
            }
        }
    }

    /// Adds `scale` times a tape's outputs to the nodes of a batch, element after element.
    fn add_to_nodes(
        &self,
        tape: &Tape,
        chunk: &Chunk,
        batch: Range<usize>,
        memory: &[f64],
        scale: f64,
        sums: &mut [Padded],
    ) {
        for block in batch.clone() {
            let at = (block - batch.start) * LANES;
            for node in 0..self.nodes {
                let locals = &chunk.connectivity[(block * self.nodes + node) * LANES..][..LANES];
                let places = [0, 1, 2].map(|axis| tape.output(3 * node + axis, 0) + at);
                for (lane, local) in locals[..chunk.lanes_in(block)].iter().enumerate() {
                    let sum = &mut sums[usize::from(*local)];
                    let [x, y, z] = places.map(|place| scale * memory[place + lane]);
                    *sum = (Vec3::from(*sum) + Vec3::new(x, y, z)).into();
                }
            }
        }
    }
}

impl Kernel for Arc<Expressions> {
    fn forces(&self, chunk: &Chunk, _: &[Vec3], displacements: &[Padded], forces: &mut [Padded]) {
        let all = 0..chunk.block_count();
        self.for_each_batch(&self.forces, chunk, all, displacements, |memory, batch| {
            let tape = &self.forces.step;
            tape.run_here(Part::All, batch.len() * LANES, memory);
            self.add_to_nodes(tape, chunk, batch, memory, 1.0, forces);
        });
    }

    fn differential(
        &self,
        chunk: &Chunk,
        _: &[Vec3],
        displacements: &[Padded],
        delta: &[Padded],
        scale: f64,
        forces: &mut [Padded],
    ) {
        let all = 0..chunk.block_count();
        self.for_each_batch(&self.differential, chunk, all, displacements, |memory, batch| {
            let tape = &self.differential.step;
            for block in batch.clone() {
                let at = (block - batch.start) * LANES;
                self.put(chunk, block, delta, |input| tape.varied(input) + at, memory);
            }
            tape.run_here(Part::All, batch.len() * LANES, memory);
            self.add_to_nodes(tape, chunk, batch, memory, scale, forces);
        });
    }

    fn energy(&self, chunk: &Chunk, _: &[Vec3], displacements: &[Padded]) -> f64 {
        let mut sum = 0.0;
        self.for_each_batch(&self.energy, chunk, 0..chunk.block_count(), displacements, |memory, batch| {
            let tape = &self.energy.step;
            tape.run_here(Part::All, batch.len() * LANES, memory);
            for block in batch.clone() {
                let at = tape.output(0, 0) + (block - batch.start) * LANES;
                sum += memory[at..at + chunk.lanes_in(block)].iter().sum::<f64>();
            }
        });
        sum
    }

    // -δ·δf
    fn quadratic_form(&self, chunk: &Chunk, _: &[Vec3], displacements: &[Padded], delta: &[Padded]) -> f64 {
        let mut sum = 0.0;
        self.for_each_batch(
            &self.differential,
            chunk,
            0..chunk.block_count(),
            displacements,
            |memory, batch| {
                let tape = &self.differential.step;
                for block in batch.clone() {
                    let at = (block - batch.start) * LANES;
                    self.put(chunk, block, delta, |input| tape.varied(input) + at, memory);
                }
                tape.run_here(Part::All, batch.len() * LANES, memory);
                for block in batch.clone() {
                    let at = (block - batch.start) * LANES;
                    for (lane, number) in
                        (0..chunk.lanes_in(block)).flat_map(|l| (0..3 * self.nodes).map(move |n| (l, n)))
                    {
                        sum -= memory[tape.varied(number) + at + lane]
                            * memory[tape.output(number, 0) + at + lane];
                    }
                }
            },
        );
        sum
    }

    fn blocks_at_once(&self) -> usize {
        BATCH / LANES
    }

    fn blocks(
        &self,
        chunk: &Chunk,
        blocks: Range<usize>,
        _: &[Vec3],
        displacements: &[Padded],
        scale: f64,
        out: &mut [f64],
    ) {
        let (tape, nodes, first) = (&self.differential.step, self.nodes, blocks.start);
        self.for_each_batch(&self.differential, chunk, blocks, displacements, |memory, batch| {
            let lanes = batch.len() * LANES;
            tape.run_here(Part::Deformation, lanes, memory);
            for input in 0..3 * nodes {
                memory[tape.varied(input)..][..lanes].fill(0.0);
            }
            // column `axis` of ∂f_a/∂x_b for all a, node by node
            for (b, axis) in (0..nodes).flat_map(|b| (0..3).map(move |axis| (b, axis))) {
                memory[tape.varied(3 * b + axis)..][..lanes].fill(1.0);
                tape.run_here(Part::Variation, lanes, memory);
                memory[tape.varied(3 * b + axis)..][..lanes].fill(0.0);
                for (block, a) in batch.clone().flat_map(|block| (0..=b).map(move |a| (block, a))) {
                    // pairs with a ≤ b, those of a = 0 first
                    let pair = (block - first) * nodes * (nodes + 1) / 2 + a * nodes - a * (a + 1) / 2 + b;
                    for row in 0..3 {
                        let from = tape.output(3 * a + row, 0) + (block - batch.start) * LANES;
                        let to = (9 * pair + 3 * axis + row) * LANES;
                        for (out, number) in out[to..to + LANES].iter_mut().zip(&memory[from..from + LANES]) {
                            *out = scale * number;
                        }
                    }
                }
            }
        });
    }
}
