//! Laws that know directions, in cells whose axes are not those of the world.
//!
//! With the law's axes as the columns of `Q` it is `Ψ(F) = Ψ'(Qᵀ F Q)`, so that `P = Q P'(Qᵀ F Q) Qᵀ` and
//! `δP = Q (∂P'/∂F : Qᵀ δF Q) Qᵀ`. Of a law of `C = Fᵀ F` the turn on the left does nothing; laws of small strain need it.
//! The nine numbers of `Q`, by columns, are the parameters of a cell.

use pulp::{Arch, Simd, WithSimd};
use souple_formal::tape::BATCH;
use souple_math::{Lanes, Mat3, Vec3};

use super::layout::LANES;
use super::row_law::{Row, RowLaw};
use super::sample_law::{Answer, Places, Run, SampleLaw, group, load_matrix, store_matrix};

/// Numbers of axes.
pub const AXES_LEN: usize = 9;

/// The numbers of axes, by columns.
pub fn numbers(axes: &Mat3) -> [f64; AXES_LEN] {
    std::array::from_fn(|i| axes.columns[i / 3].to_array()[i % 3])
}

/// A law without numbers of its own, at samples with axes.
pub struct TurnedSamples(pub Box<dyn SampleLaw>);

/// The same at rows.
pub struct TurnedRows(pub Box<dyn RowLaw>);

#[derive(Clone, Copy)]
enum Way {
    /// From the world to the law: `Qᵀ M Q`.
    In,
    /// From the law to the world: `Q M Qᵀ`.
    Out,
}

impl Way {
    #[inline(always)]
    fn turn<S: Simd>(self, Q: &Mat3<Lanes<S>>, M: &Mat3<Lanes<S>>) -> Mat3<Lanes<S>> {
        match self {
            Self::In => Q.transpose_mul(&(*M * *Q)),
            Self::Out => (*Q * *M).mul_transpose(Q),
        }
    }
}

impl SampleLaw for TurnedSamples {
    fn places(&self, answer: Answer) -> Places {
        self.0.places(answer)
    }

    fn prepare(&self, answer: Answer, memory: &mut [f64]) {
        self.0.prepare(answer, memory);
    }

    fn answer(&self, answer: Answer, run: &Run, memory: &mut [f64]) {
        let Places { deformation, variation, result, .. } = self.places(answer);
        let mut turn = |at: usize, way| Arch::new().dispatch(TurnRun { run, memory: &mut memory[at..], way });
        turn(deformation, Way::In);
        if answer == Answer::Differential {
            turn(variation, Way::In);
        }
        self.0.answer(answer, run, memory);
        let mut turn =
            |at: usize| Arch::new().dispatch(TurnRun { run, memory: &mut memory[at..], way: Way::Out });
        if answer != Answer::Energy {
            turn(result);
        }
        // what is contracted with the result stands as it was given
        if answer == Answer::Differential && variation != result {
            turn(variation);
        }
    }

    fn tangents(&self, run: &Run, memory: &mut [f64], tangents: &mut [f64]) {
        let at = self.places(Answer::Differential).deformation;
        Arch::new().dispatch(TurnRun { run, memory: &mut memory[at..], way: Way::In });
        self.0.tangents(run, memory, tangents);
        Arch::new().dispatch(TurnTangents { run, tangents });
    }
}

/// The axes of a register's worth of samples.
#[inline(always)]
fn axes<'a, S: Simd>(simd: S, run: &Run<'a>, row: usize, lane: usize) -> (Mat3<Lanes<S>>, usize) {
    let (group, at) = group(simd, run, row, lane);
    let mut Q = Mat3::zero(Lanes::constant(simd, 0.0));
    for column in 0..3 {
        let number = |i: usize| group.parameter(3 * column + i, AXES_LEN);
        Q.columns[column] = Vec3::new(number(0), number(1), number(2));
    }
    (Q, at)
}

struct TurnRun<'a> {
    run: &'a Run<'a>,
    /// Begins with the first entry of the matrices.
    memory: &'a mut [f64],
    way: Way,
}

impl WithSimd for TurnRun<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { run, memory, way } = self;
        for row in run.rows() {
            let mut lane = 0;
            while lane < LANES {
                let (Q, at) = axes(simd, run, row, lane);
                let M = load_matrix(simd, &memory[at..]);
                store_matrix(&way.turn(&Q, &M), &mut memory[at..]);
                lane += S::F64_LANES;
            }
        }
    }
}

/// `∂P/∂F` by columns of `F` and of `P`: both pairs of indices turn.
struct TurnTangents<'a> {
    run: &'a Run<'a>,
    tangents: &'a mut [f64],
}

impl WithSimd for TurnTangents<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { run, tangents } = self;
        for row in run.rows() {
            let mut lane = 0;
            while lane < LANES {
                let (Q, at) = axes(simd, run, row, lane);
                for of_deformation in 0..9 {
                    let of_stress = &mut tangents[9 * of_deformation * BATCH + at..];
                    store_matrix(&Way::Out.turn(&Q, &load_matrix(simd, of_stress)), of_stress);
                }
                for of_stress in 0..9 {
                    let place = |entry: usize| (9 * entry + of_stress) * BATCH + at;
                    let mut M = Mat3::zero(Lanes::constant(simd, 0.0));
                    for column in 0..3 {
                        let entry = |i: usize| Lanes::load(simd, &tangents[place(3 * column + i)..]);
                        M.columns[column] = Vec3::new(entry(0), entry(1), entry(2));
                    }
                    let turned = Way::Out.turn(&Q, &M);
                    for column in 0..3 {
                        for (i, number) in turned.columns[column].to_array().into_iter().enumerate() {
                            number.store(&mut tangents[place(3 * column + i)..]);
                        }
                    }
                }
                lane += S::F64_LANES;
            }
        }
    }
}

impl RowLaw for TurnedRows {
    fn energy(&self, parameters: &[f64], F: &Row) -> [f64; LANES] {
        self.0.energy(&[], &turned(parameters, F, Way::In))
    }

    fn stress(&self, parameters: &[f64], F: &Row) -> Row {
        turned(parameters, &self.0.stress(&[], &turned(parameters, F, Way::In)), Way::Out)
    }

    fn differential(&self, parameters: &[f64], F: &Row, d: &mut [Row]) {
        d.iter_mut().for_each(|row| *row = turned(parameters, row, Way::In));
        self.0.differential(&[], &turned(parameters, F, Way::In), d);
        d.iter_mut().for_each(|row| *row = turned(parameters, row, Way::Out));
    }
}

fn turned(parameters: &[f64], row: &Row, way: Way) -> Row {
    let mut out = *row;
    Arch::new().dispatch(TurnRow { parameters, row: &mut out, way });
    out
}

struct TurnRow<'a> {
    /// `[number of Q][lane]`
    parameters: &'a [f64],
    row: &'a mut Row,
    way: Way,
}

impl WithSimd for TurnRow<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { parameters, row, way } = self;
        let mut lane = 0;
        while lane < LANES {
            let matrix = |number: &dyn Fn(usize) -> Lanes<S>| {
                let column = |i: usize| Vec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2));
                Mat3::from_columns(column(0), column(1), column(2))
            };
            let Q = matrix(&|i| Lanes::load(simd, &parameters[i * LANES + lane..]));
            let M = matrix(&|i| Lanes::load(simd, &row[i][lane..]));
            let turned = way.turn(&Q, &M);
            for column in 0..3 {
                for (i, number) in turned.columns[column].to_array().into_iter().enumerate() {
                    number.store(&mut row[3 * column + i][lane..]);
                }
            }
            lane += S::F64_LANES;
        }
    }
}
