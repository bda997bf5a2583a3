//! Tapes against the plain reading of the graph.

#![allow(non_snake_case)]

use souple_math::{Mat3, Vec3};

use super::stored::{COMPARISONS, PLAIN, sizes};
use super::*;
use crate::FUNCTIONS;
use crate::law::{LawParameter, LawText};

fn compiled(energy: &str) -> EnergyLaw {
    let number = |name: &str, value| (name.to_owned(), LawParameter::Number { value, dimension: None });
    let mut parameters = vec![number("mu", 3.0), number("k", 5.0), number("p", 2.5), number("one", 1.0)];
    parameters.push(("a".to_owned(), LawParameter::Direction([0.6, 0.0, 0.8])));
    let text = LawText { energy: energy.to_owned(), definitions: Vec::new(), parameters };
    EnergyLaw::compile(&text).unwrap_or_else(|error| panic!("{}", error.explained(energy)))
}

const LAWS: &[&str] = &[
    "mu/2*(I1-3) - mu*log(J) + k/2*log(J)^2",
    "mu*dot(E, E) + k/2*tr(E)^2",
    "one*(J - 1)^2",
    "mu*dot(eps, eps) + k/2*tr(eps)^2",
    "mu/2*(I1_bar - 3) + k*(I2_bar - 3)^2 + k/2*(J - 1)^2 + mu*(I1_bar - 3)^3",
    "mu/p*(l1^p + l2^p + l3^p - 3) - mu*ln(J) + k/2*(J - 1)^2",
    "mu/2*(I1 - 3) - mu*ln(J) + k*(exp(p*max(I4(a) - 1, 0)^2) - 1) + k*dot(dev(C), B)*0 + mu*dot(inv(C) - I, E)^2",
    "mu/2*(I1 - 3) - mu*ln(J) + k/2*dot(J^(1/3)*I - I, J^(1/3)*I - I)",
    "mu/2*(I1 - 3 - 2*ln(J)) + k/2*ln(J)^2 + k*((J - 1)^2)^2.25",
    "mu*tr(C^3 - 3*C)^2 + mu*(det(2*C - I) - 1)^4 + k*sinh(E12)^2 + if(J < 0.9, (0.9 - J)^3, 0)*mu + mu*sqrt(I1)*(J-1)^2",
];

fn put(memory: &mut [f64], at: impl Fn(usize) -> usize, lane: usize, matrix: &Mat3) {
    for entry in 0..9 {
        memory[at(entry) + lane] = matrix.columns[entry / 3].to_array()[entry % 3];
    }
}

/// Every lane gives what the graph gives, in one pass and in two, for full and for partly filled batches.
#[test]
fn lanes_agree_with_the_graph() {
    LAWS.iter().for_each(|energy| agrees(energy));
}

/// Powers of one base whose exponents differ by whole numbers share a transcendental function where that is near, whichever comes
/// first, and are right however far apart they are.
#[test]
fn powers_of_one_base_agree_with_the_graph() {
    let exponents = [1.5, 2.5, 65.5, 66.5, 300.5, -0.5, -3.5, -64.5, -300.5];
    let term = |exponent: f64| format!("J^({exponent})/({exponent})");
    for (index, a) in exponents.iter().enumerate() {
        for b in exponents.iter().skip(index + 1) {
            for (a, b) in [(*a, *b), (*b, *a)] {
                agrees(&format!("k*({} - {}) + mu*(I1_bar - 3)", term(a), term(b)));
            }
        }
    }
}

/// A tape against the graph, on lanes of different deformations.
fn agrees(energy: &str) {
    // the first lane is at rest
    let wave = |lane: usize, phase: f64| {
        let size = if lane == 0 && phase == 0.0 { 0.0 } else { 0.2 };
        let number = |i: usize| size * (1.3 * lane as f64 + 0.7 * i as f64 + phase).sin();
        let column = |c: usize| Vec3::new(number(3 * c), number(3 * c + 1), number(3 * c + 2));
        Mat3::from_columns(column(0), column(1), column(2))
    };
    let law = compiled(energy);
    let outputs = [law.energy, law.stress, law.differential];
    let tape = Tape::compile(&law, &outputs);
    for lanes in [BATCH, 8, 3] {
        let mut memory = vec![0.0; tape.memory_len()];
        tape.prepare(&mut memory);
        for lane in 0..BATCH {
            put(&mut memory, |entry| tape.deformation(entry), lane, &(Mat3::identity(1.0) + wave(lane, 0.0)));
            put(&mut memory, |entry| tape.variation(entry), lane, &wave(lane, 2.0));
        }
        tape.run_here(Part::Deformation, lanes, &mut memory);
        // twice: the second part leaves what it needs of the first
        tape.run_here(Part::Variation, lanes, &mut memory);
        tape.run_here(Part::Variation, lanes, &mut memory);
        for lane in 0..lanes {
            let (F, dF) = (Mat3::identity(1.0) + wave(lane, 0.0), wave(lane, 2.0));
            let values = law.evaluate(&outputs, &F, &dF);
            for (index, output) in outputs.iter().enumerate() {
                let scale = values.of(*output).iter().fold(1.0, |a: f64, b| a.max(b.abs()));
                for (entry, expected) in values.of(*output).iter().enumerate() {
                    let found = memory[tape.output(index, entry) + lane];
                    // a hundred roundings in another order; quotients of near stretches lose four digits more
                    assert!((found - expected).abs() <= 1e-11 * scale, "{energy}: {found} {expected}");
                }
            }
        }
    }
}

/// The neo-Hookean stress takes the instructions one would write by hand.
#[test]
fn tapes_are_short() {
    let law = compiled(LAWS[0]);
    let tape = Tape::compile(&law, &[law.stress]);
    // cofactor, determinant, logarithm, three numbers, combination of two matrices
    assert!(tape.len() <= 8, "{:#?}", tape.instructions);
    let law = compiled(LAWS[1]);
    let tape = Tape::compile(&law, &[law.stress]);
    assert!(tape.len() <= 9, "{:#?}", tape.instructions);
}

/// A tape that is stored and restored is the same, and what is cut off, lengthened or changed anywhere is none or stays within its
/// memory.
#[test]
fn stored_tapes_are_restored() {
    let shapes: [&[usize]; 2] = [&[9], &[9]];
    for energy in LAWS {
        let law = compiled(energy);
        let tape = Tape::compile(&law, &[law.energy, law.stress, law.differential]);
        let outputs = [1, 9, 9];
        let mut bytes = Vec::new();
        tape.store(&mut bytes);
        let mut rest = &bytes[..];
        assert_eq!(Tape::restore(&mut rest, shapes, &outputs).as_ref(), Ok(&tape), "{energy}");
        assert!(rest.is_empty());
        for len in 0..bytes.len() {
            assert_eq!(Tape::restore(&mut &bytes[..len], shapes, &outputs), Err(NoTape), "{energy}: {len}");
        }
        let mut memory = Vec::new();
        for place in 0..bytes.len() {
            for bit in 0..8 {
                let mut changed = bytes.clone();
                changed[place] ^= 1 << bit;
                if let Ok(tape) = Tape::restore(&mut &changed[..], shapes, &outputs) {
                    assert!(tape.registers <= bytes.len());
                    memory.resize(tape.memory_len(), 0.0);
                    tape.prepare(&mut memory);
                    tape.run_here(Part::All, 8, &mut memory);
                }
            }
        }
    }
}

/// What restored instructions are held against is what the machine does: each code writes exactly the registers that it is said to, and
/// reads none but those it is said to. Between operands, which are numbers, there is none.
#[test]
fn registers_of_instructions_are_those_of_the_machine() {
    let with_entries = [Code::Copy, Code::Add, Code::Scale, Code::ScaleAdd, Code::Combine];
    let plain = PLAIN.into_iter().flat_map(|code| {
        let entries: &[u8] = match code {
            Code::Dot => &[3, 9],
            Code::Decompose => &[21],
            _ if with_entries.contains(&code) => &[1, 3, 9],
            _ => &[9],
        };
        entries.iter().map(move |entries| (code, *entries))
    });
    let functions = FUNCTIONS.iter().filter(|entry| entry.arguments.accepts(1));
    let others = functions
        .map(|entry| Code::Call(entry.function))
        .chain(COMPARISONS.map(Code::Compare))
        .chain([2, 3, 64].map(Code::WholePower));
    for (code, entries) in plain.chain(others.map(|code| (code, 1))) {
        let (written, read) = sizes(code, u32::from(entries));
        // a gap, then an operand, a gap, …, then what is written, and a gap
        let (mut operands, mut next, mut is_number) = ([0; 5], 1, vec![false]);
        for (operand, len) in operands.iter_mut().zip(read) {
            *operand = next;
            next += len + 1;
            is_number.extend(std::iter::repeat_n(true, len as usize));
            is_number.push(false);
        }
        let registers = (next + written + 1) as usize;
        let instruction = Instruction { code, entries, out: next, operands };
        let tape = Tape {
            instructions: vec![instruction],
            split: 0,
            registers,
            constants: Vec::new(),
            inputs: [Vec::new(), Vec::new()],
            outputs: Vec::new(),
        };
        let number = |register: usize, lane: usize| {
            // functions from a half on, or from one on where that is their domain
            let shift = match code {
                Code::Call(function) if !crate::arithmetic::of_one(function, 0.5).is_finite() => 1.0,
                _ => 0.0,
            };
            shift + 0.3 + 0.5 * (1.7 * register as f64 + 0.1 * lane as f64).sin().abs()
        };
        let before: Vec<f64> = (0..registers * BATCH)
            .map(|at| {
                let register = at / BATCH;
                let holds = is_number.get(register).is_some_and(|holds| *holds);
                if holds { number(register, at % BATCH) } else { f64::NAN }
            })
            .collect();
        let mut after = before.clone();
        tape.run_here(Part::All, BATCH, &mut after);
        for register in 0..registers {
            let lanes = register * BATCH..(register + 1) * BATCH;
            let is_out = (next..next + written).contains(&(register as u32));
            let name = format!("{code:?} of {entries}, register {register} of {registers}");
            if is_out {
                assert!(
                    after[lanes].iter().all(|number| number.is_finite()),
                    "{name} is written from numbers"
                );
            } else {
                let same = after[lanes.clone()].iter().zip(&before[lanes]);
                assert!(same.into_iter().all(|(a, b)| a.to_bits() == b.to_bits()), "{name} is left alone");
            }
        }
    }
}
