//! Derived expressions at work: tapes over lanes of elements. What several fragments hold as a constant is stored once.

use std::cell::RefCell;
use std::ops::Range;
use std::sync::Arc;

use pulp::{Arch, Simd, WithSimd};
use souple_formal::element::{Step, Steps};
use souple_formal::graph::Expr;
use souple_formal::law::{EnergyLaw, LawParameter};
use souple_formal::tape::{BATCH, Part, Tape};
use souple_math::{Lanes, Padded, Vec3};
use souple_mesh::Mesh;

use super::Names;
use crate::materials::kept::{put_count, put_text, take_count, take_text};
use crate::materials::{Material, MaterialLaw, TextLaw};
use crate::solids::group::Group;
use crate::solids::kernel::Kernel;
use crate::solids::layout::{Chunk, LANES};

/// [`Kernel`] of one association: what it evaluates.
pub struct Expressions {
    nodes: usize,
    parameters: Vec<String>,
    energy: Vec<Fragment>,
    forces: Vec<Fragment>,
    differential: Vec<Fragment>,
    /// Constants of an element, of all fragments together.
    constant_count: usize,
}

/// Expressions of displacements, an addend of the whole, and their constants.
struct Fragment {
    /// From rest positions and material.
    constants: Tape,
    /// From displacements and constants, and what the differential is multiplied with.
    step: Tape,
    /// Of its constants, among those of the element.
    places: Vec<usize>,
    /// Where the lanes of displacements, of variations and of outputs start in the memory of `step`.
    displacements: Vec<usize>,
    variations: Vec<usize>,
    outputs: Vec<usize>,
}

thread_local! {
    /// What tapes work in.
    static MEMORY: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
}

impl Fragment {
    /// `counts` are those of displacements, of variations and of outputs.
    fn new(constants: Tape, step: Tape, places: Vec<usize>, counts: [usize; 3]) -> Self {
        Self {
            displacements: (0..counts[0]).map(|input| step.input(input)).collect(),
            variations: (0..counts[1]).map(|input| step.varied(input)).collect(),
            outputs: (0..counts[2]).map(|output| step.output(output, 0)).collect(),
            constants,
            places,
            step,
        }
    }

    fn store(&self, bytes: &mut Vec<u8>) {
        put_count(self.places.len(), bytes);
        self.places.iter().for_each(|place| put_count(*place, bytes));
        self.constants.store(bytes);
        self.step.store(bytes);
    }

    /// One whose tape of constants takes `given` numbers, and whose constants have places below `constant_count`.
    fn restore(
        bytes: &mut &[u8],
        (given, constant_count): (usize, usize),
        counts: [usize; 3],
    ) -> Option<Self> {
        let len = take_count(bytes).filter(|len| *len <= constant_count)?;
        let places: Vec<usize> = (0..len).map(|_| take_count(bytes)).collect::<Option<_>>()?;
        if places.iter().any(|place| *place >= constant_count) {
            return None;
        }
        let numbers = |count: usize| vec![1; count];
        let constants = Tape::restore(bytes, [&numbers(given), &[]], &numbers(len)).ok()?;
        let [displacements, variations, outputs] = counts;
        let inputs = [numbers(displacements + len), numbers(variations)];
        let step = Tape::restore(bytes, [&inputs[0], &inputs[1]], &numbers(outputs)).ok()?;
        Some(Self::new(constants, step, places, counts))
    }
}

impl Expressions {
    /// Appends all of it to `bytes`.
    pub fn store(&self, bytes: &mut Vec<u8>) {
        put_count(self.constant_count, bytes);
        put_count(self.parameters.len(), bytes);
        self.parameters.iter().for_each(|name| put_text(name, bytes));
        for fragments in [&self.energy, &self.forces, &self.differential] {
            put_count(fragments.len(), bytes);
            fragments.iter().for_each(|fragment| fragment.store(bytes));
        }
    }

    /// What [`Self::store`] appended, of an element of so many nodes.
    pub fn restore(bytes: &mut &[u8], nodes: usize) -> Option<Self> {
        // every place is named in four bytes at least
        let constant_count = take_count(bytes).filter(|count| 4 * count <= bytes.len())?;
        let names = take_count(bytes)?;
        let parameters = (0..names).map(|_| take_text(bytes)).collect::<Option<Vec<String>>>()?;
        let width = 3 * nodes;
        let given = (width + names, constant_count);
        let mut fragments = |variations: usize, outputs: usize| {
            let count = take_count(bytes)?;
            let counts = [width, variations, outputs];
            (0..count).map(|_| Fragment::restore(bytes, given, counts)).collect::<Option<Vec<Fragment>>>()
        };
        let (energy, forces) = (fragments(0, 1)?, fragments(0, width)?);
        let differential = fragments(width, width)?;
        Some(Self { nodes, parameters, energy, forces, differential, constant_count })
    }

    pub fn new(steps: &Steps, law: &EnergyLaw, nodes: usize) -> Self {
        let Steps { graph, symbols, .. } = steps;
        let flat = |list: &[Vec<Expr>]| list.iter().flatten().copied().collect::<Vec<Expr>>();
        let mut given = flat(&symbols.rest);
        given.extend(&symbols.parameters);
        let (displacements, variations) = (flat(&symbols.displacements), flat(&symbols.variations));
        let of_element = steps.constant_places();
        let fragment = |(of, places): (&Step, Vec<usize>), varied: &[Expr]| {
            let (constants, values): (Vec<Expr>, Vec<Expr>) = of.constants.iter().copied().unzip();
            let inputs: Vec<Expr> = displacements.iter().chain(&constants).copied().collect();
            let directions = &law.parameters;
            let step =
                Tape::of_expressions(graph, [&inputs, varied], &of.definitions, &of.outputs, directions);
            let constants = Tape::of_expressions(graph, [&given, &[]], &of.constants, &values, directions);
            Fragment::new(constants, step, places, [displacements.len(), varied.len(), of.outputs.len()])
        };
        let fragments = |all: &[Step], places: Vec<Vec<usize>>, varied: &[Expr]| -> Vec<Fragment> {
            all.iter().zip(places).map(|of| fragment(of, varied)).collect()
        };
        let energy = fragments(&steps.energies, of_element.energies, &[]);
        let forces = fragments(&steps.forces, of_element.forces, &[]);
        let differential = fragments(&steps.differentials, of_element.differentials, &variations);
        let parameters =
            law.parameters.iter().filter(|(_, value)| matches!(value, LawParameter::Number { .. }));
        let parameters = parameters.map(|(name, _)| name.clone()).collect();
        Self { nodes, parameters, energy, forces, differential, constant_count: of_element.count }
    }

    /// The numbers of a material in the order of the law's.
    pub fn numbers_of(&self, material: &Material) -> Vec<f64> {
        let of_text = |law: &TextLaw, name: &String| match law.parameter(name) {
            Some(LawParameter::Number { value, .. }) => *value,
            _ => unreachable!("the text that the association was derived from"),
        };
        let number = |name: &String| match &material.law {
            MaterialLaw::Text(text) => of_text(text, name),
            MaterialLaw::Known(law) => {
                let index = law.visit(Names).iter().position(|known| known == name);
                material.parameters[index.unwrap_or_else(|| unreachable!("checked when it was derived"))]
            }
        };
        self.parameters.iter().map(number).collect()
    }

    /// Writes the constants of cells.
    pub fn compute_constants(
        &self,
        mesh: &Mesh,
        cells: &[usize],
        numbers_of: &dyn Fn(usize) -> Vec<f64>,
        constants: &mut [Vec<f64>],
    ) {
        cells.iter().for_each(|cell| constants[*cell] = vec![0.0; self.constant_count]);
        for Fragment { constants: tape, places, .. } in
            self.energy.iter().chain(&self.forces).chain(&self.differential)
        {
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
                    for (output, place) in places.iter().enumerate() {
                        constants[*cell][*place] = memory[tape.output(output, 0) + lane];
                    }
                }
            }
        }
    }

    /// Runs `work(memory, first block, blocks)` with the displacements and constants of as many of `blocks` as a tape takes at
    /// once.
    fn for_each_batch(
        &self,
        fragment: &Fragment,
        chunk: &Chunk,
        blocks: Range<usize>,
        displacements: &[Padded],
        mut work: impl FnMut(&mut [f64], Range<usize>),
    ) {
        let tape = &fragment.step;
        MEMORY.with_borrow_mut(|memory| {
            // what lies there from another run is written before it is read
            if memory.len() < tape.memory_len() {
                memory.resize(tape.memory_len(), 0.0);
            }
            tape.prepare(memory);
            for first in blocks.clone().step_by(BATCH / LANES) {
                let batch = first..blocks.end.min(first + BATCH / LANES);
                self.put((chunk, batch.clone()), displacements, &fragment.displacements, memory);
                for block in batch.clone() {
                    let at = (block - first) * LANES;
                    let constants = chunk.parameters(block, self.constant_count);
                    for (constant, place) in fragment.places.iter().enumerate() {
                        let lanes = &constants[*place];
                        let input = tape.input(3 * self.nodes + constant) + at;
                        memory[input..input + LANES].copy_from_slice(&lanes.0);
                    }
                }
                work(memory, batch);
            }
        });
    }

    /// Runs the differential of every fragment along `delta`, batch after batch, and `work` on what it gave.
    fn for_each_differential(
        &self,
        chunk: &Chunk,
        [displacements, delta]: [&[Padded]; 2],
        mut work: impl FnMut(&Fragment, &[f64], Range<usize>),
    ) {
        for fragment in &self.differential {
            self.for_each_batch(fragment, chunk, 0..chunk.block_count(), displacements, |memory, batch| {
                self.put((chunk, batch.clone()), delta, &fragment.variations, memory);
                fragment.step.run_here(Part::All, batch.len() * LANES, memory);
                work(fragment, memory, batch);
            });
        }
    }

    /// Writes a field of the nodes of a batch where `places` says, by node and direction.
    fn put(
        &self,
        (chunk, batch): (&Chunk, Range<usize>),
        field: &[Padded],
        places: &[usize],
        memory: &mut [f64],
    ) {
        Arch::new().dispatch(Put { chunk, batch, nodes: self.nodes, field, places, memory });
    }

    /// Adds `scale` times a fragment's outputs to the nodes of a batch, element after element.
    fn add_to_nodes(
        &self,
        fragment: &Fragment,
        (chunk, batch): (&Chunk, Range<usize>),
        memory: &[f64],
        scale: f64,
        sums: &mut [Padded],
    ) {
        let places = &fragment.outputs;
        Arch::new().dispatch(Add { chunk, batch, nodes: self.nodes, places, memory, scale, sums });
    }
}

struct Put<'a> {
    chunk: &'a Chunk,
    batch: Range<usize>,
    nodes: usize,
    field: &'a [Padded],
    places: &'a [usize],
    memory: &'a mut [f64],
}

impl WithSimd for Put<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { chunk, batch, nodes, field, places, memory } = self;
        for block in batch.clone() {
            let mut lane = 0;
            while lane < LANES {
                let group = Group::<S, 0> { simd, chunk, nodes, samples: 0, block, lane };
                let at = (block - batch.start) * LANES + lane;
                for node in 0..nodes {
                    let x = group.gather_node(field, node);
                    x.x.store(&mut memory[places[3 * node] + at..]);
                    x.y.store(&mut memory[places[3 * node + 1] + at..]);
                    x.z.store(&mut memory[places[3 * node + 2] + at..]);
                }
                lane += S::F64_LANES;
            }
        }
    }
}

struct Add<'a> {
    chunk: &'a Chunk,
    batch: Range<usize>,
    nodes: usize,
    places: &'a [usize],
    memory: &'a [f64],
    scale: f64,
    sums: &'a mut [Padded],
}

impl WithSimd for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { chunk, batch, nodes, places, memory, scale, sums } = self;
        for block in batch.clone() {
            let mut lane = 0;
            while lane < LANES {
                let group = Group::<S, 0> { simd, chunk, nodes, samples: 0, block, lane };
                let at = (block - batch.start) * LANES + lane;
                // lanes past the last element repeat it, and add nothing
                let real = (0..S::F64_LANES).map(|l| lane + l).filter(|l| *l < chunk.lanes_in(block)).count();
                let mut factors = [0.0; LANES];
                factors[..real].fill(scale);
                let factor = Lanes::load(simd, &factors);
                for node in 0..nodes {
                    let x = Lanes::load(simd, &memory[places[3 * node] + at..]);
                    let y = Lanes::load(simd, &memory[places[3 * node + 1] + at..]);
                    let z = Lanes::load(simd, &memory[places[3 * node + 2] + at..]);
                    group.scatter_node(node, Vec3::new(x * factor, y * factor, z * factor), sums);
                }
                lane += S::F64_LANES;
            }
        }
    }
}

impl Kernel for Arc<Expressions> {
    fn forces(&self, chunk: &Chunk, _: &[Vec3], displacements: &[Padded], forces: &mut [Padded]) {
        for fragment in &self.forces {
            self.for_each_batch(fragment, chunk, 0..chunk.block_count(), displacements, |memory, batch| {
                fragment.step.run_here(Part::All, batch.len() * LANES, memory);
                self.add_to_nodes(fragment, (chunk, batch), memory, 1.0, forces);
            });
        }
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
        self.for_each_differential(chunk, [displacements, delta], |fragment, memory, batch| {
            self.add_to_nodes(fragment, (chunk, batch), memory, scale, forces);
        });
    }

    fn energy(&self, chunk: &Chunk, _: &[Vec3], displacements: &[Padded]) -> f64 {
        let mut sum = 0.0;
        for fragment in &self.energy {
            self.for_each_batch(fragment, chunk, 0..chunk.block_count(), displacements, |memory, batch| {
                let tape = &fragment.step;
                tape.run_here(Part::All, batch.len() * LANES, memory);
                for block in batch.clone() {
                    let at = tape.output(0, 0) + (block - batch.start) * LANES;
                    sum += memory[at..at + chunk.lanes_in(block)].iter().sum::<f64>();
                }
            });
        }
        sum
    }

    // -δ·δf
    fn quadratic_form(&self, chunk: &Chunk, _: &[Vec3], displacements: &[Padded], delta: &[Padded]) -> f64 {
        let mut sum = 0.0;
        self.for_each_differential(chunk, [displacements, delta], |fragment, memory, batch| {
            for block in batch.clone() {
                let at = (block - batch.start) * LANES;
                for (lane, number) in
                    (0..chunk.lanes_in(block)).flat_map(|l| (0..3 * self.nodes).map(move |n| (l, n)))
                {
                    let [delta, force] =
                        [&fragment.variations, &fragment.outputs].map(|places| places[number]);
                    sum -= memory[delta + at + lane] * memory[force + at + lane];
                }
            }
        });
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
        let (nodes, first) = (self.nodes, blocks.start);
        out.fill(0.0);
        for fragment in &self.differential {
            let tape = &fragment.step;
            self.for_each_batch(fragment, chunk, blocks.clone(), displacements, |memory, batch| {
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
                        let pair =
                            (block - first) * nodes * (nodes + 1) / 2 + a * nodes - a * (a + 1) / 2 + b;
                        for row in 0..3 {
                            let from = tape.output(3 * a + row, 0) + (block - batch.start) * LANES;
                            let to = (9 * pair + 3 * axis + row) * LANES;
                            for (out, number) in
                                out[to..to + LANES].iter_mut().zip(&memory[from..from + LANES])
                            {
                                *out += scale * number;
                            }
                        }
                    }
                }
            });
        }
    }
}
