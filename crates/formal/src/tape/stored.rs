//! Tapes as bytes, to be kept from one run of the program to the next.
//!
//! What is read is no tape until every register of every instruction has been found to lie within its memory: the machine
//! reads and writes there without looking.

use super::{Code, Instruction, Tape};
use crate::FUNCTIONS;
use crate::graph::Comparison;

/// Codes without a detail; a code is written as its place here.
pub(super) const PLAIN: [Code; 30] = [
    Code::Copy,
    Code::Add,
    Code::Multiply,
    Code::MultiplyAdd,
    Code::Divide,
    Code::SquareRoot,
    Code::Power,
    Code::PowerOfPositive,
    Code::Select,
    Code::Scale,
    Code::ScaleAdd,
    Code::Combine,
    Code::PlusDiagonal,
    Code::Product,
    Code::TransposeProduct,
    Code::ProductTranspose,
    Code::Gram,
    Code::Transpose,
    Code::Dot,
    Code::Trace,
    Code::Determinant,
    Code::Cofactor,
    Code::Cross,
    Code::Outer,
    Code::Apply,
    Code::TransposeApply,
    Code::Decompose,
    Code::Compose,
    Code::StretchRates,
    Code::ComposeDifferential,
];
// codes with one
const WHOLE_POWER: u8 = 100;
const CALL: u8 = 101;
const COMPARE: u8 = 102;
pub(super) const COMPARISONS: [Comparison; 3] =
    [Comparison::Less, Comparison::LessOrEqual, Comparison::Equal];

/// Entries of a matrix.
const MATRIX: u32 = 9;

/// Why bytes are no tape: they were cut off, changed, or written by another version.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("these bytes are no tape")]
pub struct NoTape;

impl Tape {
    /// Appends the tape to `bytes`.
    pub fn store(&self, bytes: &mut Vec<u8>) {
        let mut words = |words: &[u32]| words.iter().for_each(|word| bytes.extend(word.to_le_bytes()));
        let counts = [self.instructions.len(), self.split, self.registers, self.constants.len()];
        words(&counts.map(|count| count as u32));
        for places in self.inputs.iter().chain([&self.outputs]) {
            words(&[places.len() as u32]);
            words(places);
        }
        for (register, value) in &self.constants {
            let bits = value.to_bits();
            words(&[*register, bits as u32, (bits >> 32) as u32]);
        }
        for Instruction { code, entries, out, operands } in &self.instructions {
            let [code, detail] = written(*code);
            words(&[u32::from_le_bytes([code, detail, *entries, 0]), *out]);
            words(operands);
        }
    }

    /// Takes a tape from the front of `bytes`: one whose inputs and outputs have as many entries as `inputs` and `outputs` say.
    ///
    /// # Errors
    /// The bytes are none.
    pub fn restore(bytes: &mut &[u8], inputs: [&[usize]; 2], outputs: &[usize]) -> Result<Self, NoTape> {
        let mut words = Words(bytes);
        let [count, split, registers, constants] = words.take::<4>()?.map(|count| count as usize);
        let mut places = |wanted: &[usize]| {
            let places = words.list()?;
            let lie_within = |(place, len): (&u32, &usize)| *place as usize + len <= registers;
            let fits = places.len() == wanted.len() && places.iter().zip(wanted).all(lie_within);
            if fits { Ok(places) } else { Err(NoTape) }
        };
        let inputs = [places(inputs[0])?, places(inputs[1])?];
        let outputs = places(outputs)?;
        let constant = |_| {
            let [register, low, high] = words.take()?;
            let value = f64::from_bits(u64::from(high) << 32 | u64::from(low));
            if (register as usize) < registers { Ok((register, value)) } else { Err(NoTape) }
        };
        let constants = (0..constants).map(constant).collect::<Result<Vec<_>, NoTape>>()?;
        let instruction = |_| {
            let [head, out, operands @ ..] = words.take::<7>()?;
            let [code, detail, entries, _] = head.to_le_bytes();
            let read = Instruction { code: code_of(code, detail)?, entries, out, operands };
            if lies_within(&read, registers) { Ok(read) } else { Err(NoTape) }
        };
        let instructions = (0..count).map(instruction).collect::<Result<Vec<_>, NoTape>>()?;
        // each register takes a byte at least to name or to write: a number far beyond is none of a tape
        if split > count || registers > bytes.len() {
            return Err(NoTape);
        }
        *bytes = words.0;
        Ok(Self { instructions, split, registers, constants, inputs, outputs })
    }
}

/// Words at the front of bytes.
struct Words<'a>(&'a [u8]);

impl Words<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u32; N], NoTape> {
        let mut words = [0; N];
        for word in &mut words {
            let (first, rest) = self.0.split_first_chunk().ok_or(NoTape)?;
            *word = u32::from_le_bytes(*first);
            self.0 = rest;
        }
        Ok(words)
    }

    /// As many as the first says.
    fn list(&mut self) -> Result<Vec<u32>, NoTape> {
        let [count] = self.take()?;
        (0..count).map(|_| self.take().map(|[word]| word)).collect()
    }
}

/// A code and its detail.
fn written(code: Code) -> [u8; 2] {
    match code {
        Code::WholePower(exponent) => [WHOLE_POWER, exponent],
        Code::Call(function) => [CALL, function as u8],
        Code::Compare(comparison) => [COMPARE, comparison as u8],
        plain => {
            let place = PLAIN.iter().position(|code| *code == plain);
            [place.unwrap_or_else(|| unreachable!("{plain:?} is among the plain codes")) as u8, 0]
        }
    }
}

fn code_of(code: u8, detail: u8) -> Result<Code, NoTape> {
    let found = match code {
        WHOLE_POWER => (detail >= 2).then_some(Code::WholePower(detail)),
        CALL => FUNCTIONS
            .iter()
            .find(|entry| entry.function as u8 == detail && entry.arguments.accepts(1))
            .map(|entry| Code::Call(entry.function)),
        COMPARE => COMPARISONS.into_iter().find(|known| *known as u8 == detail).map(Code::Compare),
        plain => PLAIN.get(usize::from(plain)).copied(),
    };
    found.ok_or(NoTape)
}

/// Whether all that an instruction reads and writes lies among so many registers.
fn lies_within(instruction: &Instruction, registers: usize) -> bool {
    let Instruction { code, entries, out, operands } = *instruction;
    let (of_out, of_operands) = sizes(code, u32::from(entries));
    let is_within = |first: u32, len: u32| first as usize + len as usize <= registers;
    // a decomposition holds more, and does not look at their number
    (u32::from(entries) <= MATRIX || code == Code::Decompose)
        && is_within(out, of_out)
        && operands.iter().zip(of_operands).all(|(first, len)| len == 0 || is_within(*first, len))
}

/// Numbers that an instruction writes, and that it reads of each operand.
pub(super) fn sizes(code: Code, entries: u32) -> (u32, [u32; 5]) {
    let vector = 3;
    // two rotations, and three stretches behind them
    let (rotations, decomposition) = (2 * MATRIX, 2 * MATRIX + vector);
    match code {
        Code::Copy => (entries, [entries, 0, 0, 0, 0]),
        Code::Add => (entries, [entries, entries, 0, 0, 0]),
        Code::Multiply | Code::Divide | Code::Power | Code::PowerOfPositive | Code::Compare(_) => {
            (1, [1, 1, 0, 0, 0])
        }
        Code::MultiplyAdd | Code::Select => (1, [1, 1, 1, 0, 0]),
        Code::WholePower(_) | Code::SquareRoot | Code::Call(_) => (1, [1, 0, 0, 0, 0]),
        Code::Scale => (entries, [1, entries, 0, 0, 0]),
        Code::ScaleAdd => (entries, [1, entries, entries, 0, 0]),
        Code::Combine => (entries, [1, entries, 1, entries, 0]),
        Code::PlusDiagonal => (entries, [entries, 1, 0, 0, 0]),
        Code::Product | Code::TransposeProduct | Code::ProductTranspose | Code::Cross => {
            (MATRIX, [MATRIX, MATRIX, 0, 0, 0])
        }
        Code::Gram | Code::Cofactor => (MATRIX, [MATRIX, 0, 0, 0, 0]),
        Code::Transpose => (MATRIX, [MATRIX, 0, 0, 0, 0]),
        Code::Dot => (1, [entries.max(vector), entries.max(vector), 0, 0, 0]),
        Code::Trace | Code::Determinant => (1, [MATRIX, 0, 0, 0, 0]),
        Code::Outer => (MATRIX, [vector, vector, 0, 0, 0]),
        Code::Apply | Code::TransposeApply => (vector, [MATRIX, vector, 0, 0, 0]),
        Code::Decompose => (decomposition, [MATRIX, 0, 0, 0, 0]),
        Code::Compose => (MATRIX, [rotations, vector, 0, 0, 0]),
        Code::StretchRates => (vector, [rotations, MATRIX, 0, 0, 0]),
        Code::ComposeDifferential => (MATRIX, [decomposition, vector, vector, vector, MATRIX]),
    }
}
