//! Runs a tape on a batch of lanes.
//!
//! Every instruction is a loop over the lanes of the batch, so that a tape of tensor operations costs little more than the
//! same law compiled ahead. No closures over lanes here: what is not inlined is not compiled for the processor's
//! instructions.

#![allow(non_snake_case)]

use pulp::{Simd, WithSimd};
use souple_math::{Lanes, Mat3, Real, Vec3, svd, whole_power};

use super::{BATCH, Code, Instruction, Part, Tape};
use crate::graph::{Comparison, EQUAL_STRETCHES};
use crate::{Function, arithmetic};

impl Tape {
    /// Runs on the first `lanes` lanes of a memory that [`Tape::prepare`] has seen, rounded up to whole registers.
    ///
    /// # Panics
    /// If the memory is shorter than [`Tape::memory_len`], or `lanes` is more than [`BATCH`].
    #[inline(always)]
    pub fn run<S: Simd>(&self, simd: S, part: Part, lanes: usize, memory: &mut [f64]) {
        assert!(memory.len() >= self.memory_len() && lanes <= BATCH, "memory and lanes of this tape");
        let instructions = match part {
            Part::All => &self.instructions[..],
            Part::Deformation => &self.instructions[..self.split],
            Part::Variation => &self.instructions[self.split..],
        };
        let groups = lanes.div_ceil(S::F64_LANES);
        for instruction in instructions {
            let registers = Registers { simd, memory: memory.as_mut_ptr(), at: *instruction };
            registers.run(groups);
        }
    }

    /// Runs with the best instructions of this processor.
    pub fn run_here(&self, part: Part, lanes: usize, memory: &mut [f64]) {
        struct Run<'a>(&'a Tape, Part, usize, &'a mut [f64]);
        impl WithSimd for Run<'_> {
            type Output = ();
            #[inline(always)]
            fn with_simd<S: Simd>(self, simd: S) {
                self.0.run(simd, self.1, self.2, self.3);
            }
        }
        pulp::Arch::new().dispatch(Run(self, part, lanes, memory));
    }
}

/// The registers of one instruction.
#[derive(Clone, Copy)]
struct Registers<S: Simd> {
    simd: S,
    /// Start of a memory that holds all registers of the tape.
    memory: *mut f64,
    at: Instruction,
}

impl<S: Simd> Registers<S> {
    /// Number `entry` of operand `operand` in a group of lanes.
    #[inline(always)]
    fn load(&self, operand: usize, entry: usize, group: usize) -> Lanes<S> {
        let at = (self.at.operands[operand] as usize + entry) * BATCH + group * S::F64_LANES;
        // SAFETY: `run` has asserted that the memory holds all registers the tape was assigned or, if it was restored, found to
        // use; `group` lies within the batch, and unaligned reads of any `f64` bits are valid lanes
        Lanes::new(self.simd, unsafe { self.memory.add(at).cast::<S::f64s>().read_unaligned() })
    }

    #[inline(always)]
    fn store(&self, entry: usize, group: usize, value: Lanes<S>) {
        let at = (self.at.out as usize + entry) * BATCH + group * S::F64_LANES;
        // SAFETY: as in `load`; no other reference to the memory is alive while instructions run
        unsafe { self.memory.add(at).cast::<S::f64s>().write_unaligned(value.values()) };
    }

    #[inline(always)]
    fn vector(&self, operand: usize, first: usize, group: usize) -> Vec3<Lanes<S>> {
        Vec3::new(
            self.load(operand, first, group),
            self.load(operand, first + 1, group),
            self.load(operand, first + 2, group),
        )
    }

    #[inline(always)]
    fn matrix(&self, operand: usize, first: usize, group: usize) -> Mat3<Lanes<S>> {
        Mat3::from_columns(
            self.vector(operand, first, group),
            self.vector(operand, first + 3, group),
            self.vector(operand, first + 6, group),
        )
    }

    #[inline(always)]
    fn store_vector(&self, first: usize, group: usize, value: Vec3<Lanes<S>>) {
        self.store(first, group, value.x);
        self.store(first + 1, group, value.y);
        self.store(first + 2, group, value.z);
    }

    #[inline(always)]
    fn store_matrix(&self, first: usize, group: usize, value: &Mat3<Lanes<S>>) {
        self.store_vector(first, group, value.columns[0]);
        self.store_vector(first + 3, group, value.columns[1]);
        self.store_vector(first + 6, group, value.columns[2]);
    }

    #[inline(always)]
    fn run(&self, groups: usize) {
        let entries = usize::from(self.at.entries);
        macro_rules! entrywise {
            (|$entry:ident, $g:ident| $value:expr) => {
                for $entry in 0..entries {
                    for $g in 0..groups {
                        self.store($entry, $g, $value);
                    }
                }
            };
        }
        macro_rules! numbers {
            (|$g:ident| $value:expr) => {
                for $g in 0..groups {
                    self.store(0, $g, $value);
                }
            };
        }
        macro_rules! matrices {
            (|$g:ident| $value:expr) => {
                for $g in 0..groups {
                    self.store_matrix(0, $g, &$value);
                }
            };
        }
        match self.at.code {
            Code::Copy => entrywise!(|e, g| self.load(0, e, g)),
            Code::Add => entrywise!(|e, g| self.load(0, e, g) + self.load(1, e, g)),
            Code::Multiply => numbers!(|g| self.load(0, 0, g) * self.load(1, 0, g)),
            Code::MultiplyAdd => {
                numbers!(|g| self.load(0, 0, g).mul_add(self.load(1, 0, g), self.load(2, 0, g)))
            }
            Code::Divide => numbers!(|g| self.load(0, 0, g) / self.load(1, 0, g)),
            Code::WholePower(exponent) => numbers!(|g| whole_power(self.load(0, 0, g), exponent)),
            Code::SquareRoot => numbers!(|g| self.load(0, 0, g).sqrt()),
            Code::Power => numbers!(|g| power(self.load(0, 0, g), self.load(1, 0, g))),
            Code::PowerOfPositive => {
                numbers!(|g| (self.load(0, 0, g).ln() * self.load(1, 0, g)).exp())
            }
            Code::Call(Function::Ln) => numbers!(|g| self.load(0, 0, g).ln()),
            Code::Call(Function::Abs) => numbers!(|g| self.load(0, 0, g).abs()),
            Code::Call(function) => numbers!(|g| call(function, self.load(0, 0, g))),
            Code::Compare(Comparison::Less) => numbers!(|g| {
                let (a, b) = (self.load(0, 0, g), self.load(1, 0, g));
                a.select_less(b, a.one(), a.zero())
            }),
            Code::Compare(comparison) => {
                numbers!(|g| compare(comparison, self.load(0, 0, g), self.load(1, 0, g)))
            }
            Code::Select => numbers!(|g| {
                // truth is 1 or 0
                let condition = self.load(0, 0, g);
                condition.zero().select_less(condition, self.load(1, 0, g), self.load(2, 0, g))
            }),
            Code::Scale => entrywise!(|e, g| self.load(0, 0, g) * self.load(1, e, g)),
            Code::ScaleAdd => {
                entrywise!(|e, g| self.load(1, e, g).mul_add(self.load(0, 0, g), self.load(2, e, g)))
            }
            Code::Combine => entrywise!(|e, g| {
                let second = self.load(2, 0, g) * self.load(3, e, g);
                self.load(1, e, g).mul_add(self.load(0, 0, g), second)
            }),
            Code::PlusDiagonal => entrywise!(|e, g| {
                let a = self.load(0, e, g);
                if e % 4 == 0 { a + self.load(1, 0, g) } else { a }
            }),
            Code::Product => matrices!(|g| self.matrix(0, 0, g) * self.matrix(1, 0, g)),
            Code::TransposeProduct => {
                matrices!(|g| self.matrix(0, 0, g).transpose_mul(&self.matrix(1, 0, g)))
            }
            Code::ProductTranspose => {
                matrices!(|g| self.matrix(0, 0, g).mul_transpose(&self.matrix(1, 0, g)))
            }
            Code::Gram => matrices!(|g| gram(&self.matrix(0, 0, g))),
            Code::Transpose => entrywise!(|e, g| self.load(0, (e % 3) * 3 + e / 3, g)),
            Code::Dot if entries == 9 => numbers!(|g| self.matrix(0, 0, g).dot(&self.matrix(1, 0, g))),
            Code::Dot => numbers!(|g| self.vector(0, 0, g).dot(self.vector(1, 0, g))),
            Code::Trace => numbers!(|g| self.load(0, 0, g) + self.load(0, 4, g) + self.load(0, 8, g)),
            Code::Determinant => numbers!(|g| self.matrix(0, 0, g).determinant()),
            Code::Cofactor => matrices!(|g| self.matrix(0, 0, g).cofactor()),
            Code::Cross => matrices!(|g| cross(&self.matrix(0, 0, g), &self.matrix(1, 0, g))),
            Code::Outer => matrices!(|g| self.vector(0, 0, g).outer(self.vector(1, 0, g))),
            Code::Apply => {
                for g in 0..groups {
                    self.store_vector(0, g, self.matrix(0, 0, g) * self.vector(1, 0, g));
                }
            }
            Code::TransposeApply => {
                for g in 0..groups {
                    self.store_vector(0, g, self.matrix(0, 0, g).transpose_apply(self.vector(1, 0, g)));
                }
            }
            Code::Decompose => {
                for g in 0..groups {
                    let parts = svd(&self.matrix(0, 0, g));
                    self.store_matrix(0, g, &parts.left);
                    self.store_matrix(9, g, &parts.right);
                    self.store_vector(18, g, parts.values);
                }
            }
            Code::Compose => matrices!(|g| {
                let (left, right) = (self.matrix(0, 0, g), self.matrix(0, 9, g));
                scaled_columns(&left, self.vector(1, 0, g)).mul_transpose(&right)
            }),
            Code::StretchRates => {
                for g in 0..groups {
                    let (left, right) = (self.matrix(0, 0, g), self.matrix(0, 9, g));
                    let rates = left.transpose_mul(&(self.matrix(1, 0, g) * right)).diagonal();
                    self.store_vector(0, g, rates);
                }
            }
            Code::ComposeDifferential => matrices!(|g| compose_differential(self, g)),
        }
    }
}

/// `Aᵀ A`, its six different dot products taken once.
#[inline(always)]
fn gram<R: Real>(A: &Mat3<R>) -> Mat3<R> {
    let [a, b, c] = A.columns;
    let (ab, bc, ca) = (a.dot(b), b.dot(c), c.dot(a));
    Mat3::from_columns(Vec3::new(a.dot(a), ab, ca), Vec3::new(ab, b.dot(b), bc), Vec3::new(ca, bc, c.dot(c)))
}

/// `A ⨯ B` by columns of the cofactor, `b × c` and so on.
#[inline(always)]
fn cross<R: Real>(A: &Mat3<R>, B: &Mat3<R>) -> Mat3<R> {
    let ([a, b, c], [da, db, dc]) = (A.columns, B.columns);
    Mat3::from_columns(db.cross(c) + b.cross(dc), dc.cross(a) + c.cross(da), da.cross(b) + a.cross(db))
}

#[inline(always)]
fn scaled_columns<R: Real>(A: &Mat3<R>, g: Vec3<R>) -> Mat3<R> {
    let [a, b, c] = A.columns;
    Mat3::from_columns(a * g.x, b * g.y, c * g.z)
}

/// Number after number, as all transcendental functions: the bits must not depend on the width.
#[inline(always)]
fn power<S: Simd>(mut base: Lanes<S>, exponent: Lanes<S>) -> Lanes<S> {
    for (number, exponent) in base.as_mut_slice().iter_mut().zip(exponent.as_slice()) {
        *number = libm::pow(*number, *exponent);
    }
    base
}

#[inline(always)]
fn call<S: Simd>(function: Function, mut argument: Lanes<S>) -> Lanes<S> {
    for number in argument.as_mut_slice() {
        *number = arithmetic::of_one(function, *number);
    }
    argument
}

#[inline(always)]
fn compare<S: Simd>(comparison: Comparison, mut a: Lanes<S>, b: Lanes<S>) -> Lanes<S> {
    for (number, other) in a.as_mut_slice().iter_mut().zip(b.as_slice()) {
        *number = comparison.holds(*number, *other);
    }
    a
}

/// See [`crate::graph::Graph::compose_differential`].
#[inline(always)]
fn compose_differential<S: Simd>(at: &Registers<S>, group: usize) -> Mat3<Lanes<S>> {
    let (left, right, s) = (at.matrix(0, 0, group), at.matrix(0, 9, group), at.vector(0, 18, group));
    let (g, dg, limits) = (at.vector(1, 0, group), at.vector(2, 0, group), at.vector(3, 0, group));
    let M = left.transpose_mul(&(at.matrix(4, 0, group) * right));
    let [m0, m1, m2] = M.columns;
    let (d01, d10) = pair((s.x, s.y), (g.x, g.y), limits.x, (m1.x, m0.y));
    let (d12, d21) = pair((s.y, s.z), (g.y, g.z), limits.y, (m2.y, m1.z));
    let (d20, d02) = pair((s.z, s.x), (g.z, g.x), limits.z, (m0.z, m2.x));
    let D =
        Mat3::from_columns(Vec3::new(dg.x, d10, d20), Vec3::new(d01, dg.y, d21), Vec3::new(d02, d12, dg.z));
    (left * D).mul_transpose(&right)
}

/// The entries `(i, j)` and `(j, i)` of `D` from those of `M`.
#[inline(always)]
fn pair<R: Real>(s: (R, R), g: (R, R), limit: R, m: (R, R)) -> (R, R) {
    let (difference, sum) = (s.0 - s.1, s.0 + s.1);
    let near = (s.0.abs() + s.1.abs()) * EQUAL_STRETCHES;
    let stretch = difference.abs().select_less(near, limit, (g.0 - g.1) / difference);
    let turn = (g.0 + g.1) / sum;
    let (even, odd) = (stretch * (m.0 + m.1) * 0.5, turn * (m.0 - m.1) * 0.5);
    (even + odd, even - odd)
}
