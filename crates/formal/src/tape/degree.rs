//! Of which degree in the deformation gradient a tape's numbers are, where they are polynomials.

use super::stored::sizes;
use super::{Code, Tape};

/// Entries of a matrix.
const ENTRIES: usize = 9;

impl Tape {
    /// The degree of its first output in the entries of `F`, at most: terms that cancel count. `None` of what is no polynomial of them.
    pub fn degree(&self) -> Option<u32> {
        // of each register, as instructions come to it
        let mut degrees: Vec<Option<u32>> = vec![Some(0); self.registers];
        let first = self.inputs[0].first().copied()? as usize;
        degrees[first..first + ENTRIES].fill(Some(1));
        for instruction in &self.instructions {
            let (of_out, of_operands) = sizes(instruction.code, u32::from(instruction.entries));
            let of = |operand: usize| {
                let first = instruction.operands[operand] as usize;
                let all = &degrees[first..first + of_operands[operand] as usize];
                all.iter().copied().try_fold(0, |most, degree| Some(most.max(degree?)))
            };
            let product = |a: usize, b: usize| Some(of(a)?.saturating_add(of(b)?));
            let greater = |a: Option<u32>, b: Option<u32>| Some(a?.max(b?));
            let degree = match instruction.code {
                Code::Copy | Code::Transpose | Code::Trace => of(0),
                Code::Add | Code::PlusDiagonal => greater(of(0), of(1)),
                Code::Multiply
                | Code::Scale
                | Code::Product
                | Code::TransposeProduct
                | Code::ProductTranspose
                | Code::Dot
                | Code::Cross
                | Code::Outer
                | Code::Apply
                | Code::TransposeApply => product(0, 1),
                Code::MultiplyAdd | Code::ScaleAdd => greater(product(0, 1), of(2)),
                Code::Combine => greater(product(0, 1), product(2, 3)),
                Code::WholePower(exponent) => of(0).map(|degree| degree.saturating_mul(u32::from(exponent))),
                Code::Gram | Code::Cofactor => of(0).map(|degree| degree.saturating_mul(2)),
                Code::Determinant => of(0).map(|degree| degree.saturating_mul(3)),
                Code::Divide => of(0).filter(|_| of(1) == Some(0)),
                // constants are anything of constants
                _ => (0..of_operands.len()).all(|operand| of(operand) == Some(0)).then_some(0),
            };
            let out = instruction.out as usize;
            degrees[out..out + of_out as usize].fill(degree);
        }
        *degrees.get(*self.outputs.first()? as usize)?
    }
}
