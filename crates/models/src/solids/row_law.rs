//! A law at a row of samples: eight deformation gradients side by side, asked one row at a time. Sections ask several
//! times for each row, until the stretch across is found.

use std::cell::RefCell;
use std::marker::PhantomData;
use std::sync::Arc;

use pulp::{Arch, Simd, WithSimd};
use souple_formal::tape::{BATCH, Part, Tape};
use souple_math::{Lanes, Mat3, Vec3};

use super::layout::{LANES, LaneBlock};
use crate::materials::{Law, LawVisitor, MaterialLaw, Parameters, TextLaw};

/// Entries of eight matrices by columns, lanes side by side.
pub type Row = [[f64; LANES]; 9];

/// A law at rows of samples; `parameters` are the law's numbers for the lanes, `[parameter][lane]`.
pub trait RowLaw: Send + Sync {
    /// `Ψ(F)` of each lane [J/m³].
    fn energy(&self, parameters: &[f64], F: &Row) -> [f64; LANES];
    /// `P(F)` of each lane [Pa].
    fn stress(&self, parameters: &[f64], F: &Row) -> Row;
    /// `∂P/∂F : δF` for several `δF` at the same `F`, in place [Pa].
    fn differential(&self, parameters: &[f64], F: &Row, d: &mut [Row]);
}

/// The law of a material for rows.
pub fn row_law(law: &MaterialLaw) -> Box<dyn RowLaw> {
    struct Make;
    impl LawVisitor for Make {
        type Output = Box<dyn RowLaw>;
        fn visit<L: Law>(self, _: L) -> Box<dyn RowLaw> {
            Box::new(Known::<L>(PhantomData))
        }
    }
    match law {
        MaterialLaw::Known(law) => law.visit(Make),
        MaterialLaw::Text(law) => Box::new(Written(Arc::clone(law))),
    }
}

#[inline(always)]
fn load<S: Simd>(simd: S, row: &Row, lane: usize) -> Mat3<Lanes<S>> {
    let mut matrix = Mat3::zero(Lanes::constant(simd, 0.0));
    for column in 0..3 {
        matrix.columns[column] = Vec3::new(
            Lanes::load(simd, &row[3 * column][lane..]),
            Lanes::load(simd, &row[3 * column + 1][lane..]),
            Lanes::load(simd, &row[3 * column + 2][lane..]),
        );
    }
    matrix
}

#[inline(always)]
fn store<S: Simd>(matrix: &Mat3<Lanes<S>>, row: &mut Row, lane: usize) {
    for column in 0..3 {
        matrix.columns[column].x.store(&mut row[3 * column][lane..]);
        matrix.columns[column].y.store(&mut row[3 * column + 1][lane..]);
        matrix.columns[column].z.store(&mut row[3 * column + 2][lane..]);
    }
}

#[inline(always)]
fn unpack<S: Simd, P: Parameters<Lanes<S>>>(simd: S, parameters: &[f64], lane: usize) -> P {
    P::unpack(|i| Lanes::load(simd, &parameters[i * LANES + lane..]))
}

/// A law compiled with the program.
struct Known<L>(PhantomData<L>);

impl<L: Law> RowLaw for Known<L> {
    fn energy(&self, parameters: &[f64], F: &Row) -> [f64; LANES] {
        let mut out = [0.0; LANES];
        Arch::new().dispatch(Energy::<L> { parameters, F, out: &mut out, law: PhantomData });
        out
    }

    fn stress(&self, parameters: &[f64], F: &Row) -> Row {
        let mut out = [[0.0; LANES]; 9];
        Arch::new().dispatch(Stress::<L> { parameters, F, out: &mut out, law: PhantomData });
        out
    }

    fn differential(&self, parameters: &[f64], F: &Row, d: &mut [Row]) {
        Arch::new().dispatch(Differential::<L> { parameters, F, d, law: PhantomData });
    }
}

struct Energy<'a, L> {
    parameters: &'a [f64],
    F: &'a Row,
    out: &'a mut [f64; LANES],
    law: PhantomData<L>,
}

impl<L: Law> WithSimd for Energy<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let mut lane = 0;
        while lane < LANES {
            let parameters = unpack::<S, L::Parameters<Lanes<S>>>(simd, self.parameters, lane);
            L::energy_density(&parameters, &load(simd, self.F, lane)).store(&mut self.out[lane..]);
            lane += S::F64_LANES;
        }
    }
}

struct Stress<'a, L> {
    parameters: &'a [f64],
    F: &'a Row,
    out: &'a mut Row,
    law: PhantomData<L>,
}

impl<L: Law> WithSimd for Stress<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let mut lane = 0;
        while lane < LANES {
            let parameters = unpack::<S, L::Parameters<Lanes<S>>>(simd, self.parameters, lane);
            store(&L::stress(&parameters, &load(simd, self.F, lane)), self.out, lane);
            lane += S::F64_LANES;
        }
    }
}

struct Differential<'a, L> {
    parameters: &'a [f64],
    F: &'a Row,
    d: &'a mut [Row],
    law: PhantomData<L>,
}

impl<L: Law> WithSimd for Differential<'_, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let mut lane = 0;
        while lane < LANES {
            let parameters = unpack::<S, L::Parameters<Lanes<S>>>(simd, self.parameters, lane);
            let point = L::at(&parameters, &load(simd, self.F, lane));
            for row in &mut *self.d {
                let d = load(simd, row, lane);
                store(&L::stress_differential(&parameters, &point, &d), row, lane);
            }
            lane += S::F64_LANES;
        }
    }
}

thread_local! {
    /// Registers of a tape.
    static MEMORY: RefCell<Vec<LaneBlock>> = const { RefCell::new(Vec::new()) };
}

/// Runs `work` with memory for a tape, its constants written.
fn with_memory<T>(tape: &Tape, work: impl FnOnce(&mut [f64]) -> T) -> T {
    MEMORY.with_borrow_mut(|registers| {
        let wanted = tape.memory_len().div_ceil(LANES);
        if registers.len() < wanted {
            registers.resize(wanted, LaneBlock::default());
        }
        let registers = bytemuck::cast_slice_mut(registers);
        tape.prepare(registers);
        work(registers)
    })
}

/// A law as text: its numbers are constants of its tapes.
struct Written(Arc<TextLaw>);

impl RowLaw for Written {
    fn energy(&self, _: &[f64], F: &Row) -> [f64; LANES] {
        let tape = self.0.energy();
        with_memory(tape, |memory| {
            write(memory, tape.deformation(0), F);
            tape.run_here(Part::All, LANES, memory);
            let mut out = [0.0; LANES];
            out.copy_from_slice(&memory[tape.output(0, 0)..][..LANES]);
            out
        })
    }

    fn stress(&self, _: &[f64], F: &Row) -> Row {
        let tape = self.0.stress();
        with_memory(tape, |memory| {
            write(memory, tape.deformation(0), F);
            tape.run_here(Part::All, LANES, memory);
            read(memory, tape.output(0, 0))
        })
    }

    fn differential(&self, _: &[f64], F: &Row, d: &mut [Row]) {
        let tape = self.0.differential();
        with_memory(tape, |memory| {
            write(memory, tape.deformation(0), F);
            tape.run_here(Part::Deformation, LANES, memory);
            for row in d {
                write(memory, tape.variation(0), row);
                tape.run_here(Part::Variation, LANES, memory);
                *row = read(memory, tape.output(0, 0));
            }
        });
    }
}

/// Entry `e` of a matrix lies `e · BATCH` behind its first.
fn write(memory: &mut [f64], at: usize, row: &Row) {
    for (e, lanes) in row.iter().enumerate() {
        memory[at + e * BATCH..][..LANES].copy_from_slice(lanes);
    }
}

fn read(memory: &[f64], at: usize) -> Row {
    std::array::from_fn(|e| std::array::from_fn(|lane| memory[at + e * BATCH + lane]))
}
