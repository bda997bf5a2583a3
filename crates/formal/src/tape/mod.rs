//! Laws compiled for many lanes at once, at run time.
//!
//! A [`Tape`] is a list of instructions on whole tensors (`cofactor`, `A Bᵀ`, `s A + t B`, …). Each instruction runs over a
//! batch of [`BATCH`] lanes before the next one is looked at, so the cost of choosing it is shared by all of them, and the
//! registers of a batch stay in the first-level cache. What does not vary with the deformation is computed once, when
//! the tape is made: the grouped constants of the law.

pub(crate) mod lower;
mod machine;
mod registers;
mod stored;

use crate::Function;
use crate::graph::{Comparison, Expr, Graph, Symbol};
use crate::law::{EnergyLaw, LawParameter};

pub use stored::NoTape;

/// Lanes of one run.
pub const BATCH: usize = 64;

/// What an instruction does with its operands `a`, `b`, `c`, `d`, each one number or several in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Code {
    /// Entry by entry.
    Copy,
    Add,
    /// `a b` of numbers.
    Multiply,
    /// `a b + c` of numbers.
    MultiplyAdd,
    Divide,
    /// `a bⁿ⁻¹ …`: a whole power from 2 on.
    WholePower(u8),
    SquareRoot,
    /// `aᵇ`, also of a base below zero to a whole power.
    Power,
    /// `exp(b ln a)`, a power of a base that is not below zero: half of what [`Self::Power`] takes.
    PowerOfPositive,
    Call(Function),
    Compare(Comparison),
    Select,
    /// `a` times the entries of `b`.
    Scale,
    /// `a b + c`, entry by entry for one number `a`.
    ScaleAdd,
    /// `a b + c d`, entry by entry for numbers `a`, `c`.
    Combine,
    /// The matrix `a + b I`.
    PlusDiagonal,
    Product,
    /// `aᵀ b`.
    TransposeProduct,
    /// `a bᵀ`.
    ProductTranspose,
    /// `aᵀ a`.
    Gram,
    Transpose,
    /// Sum of products of entries.
    Dot,
    Trace,
    Determinant,
    Cofactor,
    Cross,
    Outer,
    Apply,
    TransposeApply,
    Decompose,
    Compose,
    StretchRates,
    /// Of a decomposition, and of `g`, `δg`, `k`, `δF` packed behind each other as `b`, `c`, `d` and the entries behind `d`.
    ComposeDifferential,
}

/// Registers of one instruction, by their first number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Instruction {
    pub code: Code,
    /// Entries of what is worked on entry by entry.
    pub entries: u8,
    pub out: u32,
    pub operands: [u32; 5],
}

/// A compiled law: some of its expressions as functions of `F`, or of `F` and `δF`.
#[derive(Clone, Debug, PartialEq)]
pub struct Tape {
    instructions: Vec<Instruction>,
    /// Instructions before it need `F` only.
    split: usize,
    registers: usize,
    constants: Vec<(u32, f64)>,
    inputs: [Vec<u32>; 2],
    outputs: Vec<u32>,
}

/// Which instructions are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    All,
    /// What needs `F` only.
    Deformation,
    /// The rest, for another `δF` at the same `F`.
    Variation,
}

impl Tape {
    /// Compiles expressions of a law for its parameters.
    pub fn compile(law: &EnergyLaw, outputs: &[Expr]) -> Self {
        let request = lower::Request {
            graph: &law.graph,
            inputs: [&[law.deformation], &[law.variation]],
            definitions: &[],
            outputs,
        };
        let parameter = |symbol: &Symbol| law.parameter(&symbol.name).map_or(&[][..], LawParameter::numbers);
        registers::assign(lower::lower(&request, parameter))
    }

    /// Compiles expressions of numbers: `inputs` are the symbols that come first and those that vary at the same first
    /// ones, `definitions` symbols that stand for expressions, `directions` the numbers of all other symbols and of their
    /// components.
    pub fn of_expressions(
        graph: &Graph,
        inputs: [&[Expr]; 2],
        definitions: &[(Expr, Expr)],
        outputs: &[Expr],
        directions: &[(String, LawParameter)],
    ) -> Self {
        let request = lower::Request { graph, inputs, definitions, outputs };
        let numbers = |symbol: &Symbol| {
            directions
                .iter()
                .find_map(|(name, parameter)| {
                    // `a`, or its components `a_0`, `a_1`, `a_2`
                    let Some(component) = symbol.own_name() else {
                        return (symbol.name == *name).then(|| parameter.numbers());
                    };
                    let index = component.strip_prefix(name.as_str())?.strip_prefix('_')?;
                    let index: usize = index.parse().ok()?;
                    parameter.numbers().get(index..=index)
                })
                .unwrap_or_else(|| unreachable!("`{}` is neither an input nor of a direction", symbol.name))
        };
        registers::assign(lower::lower(&request, numbers))
    }

    /// Numbers that the memory of a run must hold, [`BATCH`] for each register.
    pub fn memory_len(&self) -> usize {
        self.registers * BATCH
    }

    /// How many instructions there are.
    pub fn len(&self) -> usize {
        self.instructions.len()
    }

    pub fn is_empty(&self) -> bool {
        self.instructions.is_empty()
    }

    /// Where the lanes of entry `entry` of `F` start, by columns.
    #[inline]
    pub fn deformation(&self, entry: usize) -> usize {
        self.input(0) + entry * BATCH
    }

    /// Where the lanes of entry `entry` of `δF` start.
    #[inline]
    pub fn variation(&self, entry: usize) -> usize {
        self.varied(0) + entry * BATCH
    }

    /// Where the lanes of an input that comes first start.
    #[inline]
    pub fn input(&self, input: usize) -> usize {
        self.inputs[0][input] as usize * BATCH
    }

    /// Where the lanes of an input that varies at the same first ones start.
    #[inline]
    pub fn varied(&self, input: usize) -> usize {
        self.inputs[1][input] as usize * BATCH
    }

    /// Where the lanes of number `entry` of an output start.
    #[inline]
    pub fn output(&self, output: usize, entry: usize) -> usize {
        (self.outputs[output] as usize + entry) * BATCH
    }

    /// Writes the constants, once before the runs on a memory.
    ///
    /// # Panics
    /// If the memory is shorter than [`Self::memory_len`].
    pub fn prepare(&self, memory: &mut [f64]) {
        for (register, value) in &self.constants {
            memory[*register as usize * BATCH..][..BATCH].fill(*value);
        }
    }
}

#[cfg(test)]
mod tests;
