//! The loops over elements with a derived law and element.

use std::marker::PhantomData;
use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};
use souple_math::{Lanes, Mat3, Padded, Real, Vec3};

use super::{DerivedElement, RestSamples};
use crate::materials::Parameters;
use crate::solids::group::{Group, for_each_group};
use crate::solids::kernel::Kernel;
use crate::solids::layout::{Chunk, LANES};

/// [`Kernel`] of a derived law on an element.
pub struct DerivedKernel<E, const N: usize> {
    /// Places of the derived law's numbers among those of an element, and how many these are.
    order: Vec<usize>,
    count: usize,
    /// Whose blocks of matrices these are.
    samples: Box<dyn Kernel>,
    element: PhantomData<E>,
}

impl<E: DerivedElement<N>, const N: usize> DerivedKernel<E, N> {
    /// `names` are those of the numbers of an element.
    pub fn new(names: &[&str], samples: Box<dyn Kernel>) -> Self {
        let place = |name: &&str| names.iter().position(|known| known == name);
        let own = <E::Numbers<f64> as Parameters<f64>>::NAMES;
        let order: Vec<usize> = own.iter().filter_map(place).collect();
        assert_eq!(
            order.len(),
            own.len(),
            "a law's numbers are called {own:?} here, and {names:?} in its table"
        );
        Self { order, count: names.len(), samples, element: PhantomData }
    }

    #[inline(always)]
    fn numbers<S: Simd>(&self, group: &Group<S, N>) -> E::Numbers<Lanes<S>> {
        E::Numbers::unpack(|number| group.parameter(self.order[number], self.count))
    }

    fn pass<'a>(&'a self, chunk: &'a Chunk, positions: &'a [Padded]) -> Pass<'a, E, N> {
        Pass { kernel: self, chunk, positions }
    }
}

impl<E: DerivedElement<N>, const N: usize> Kernel for DerivedKernel<E, N> {
    fn forces(&self, chunk: &Chunk, _: &[Vec3], positions: &[Padded], forces: &mut [Padded]) {
        Arch::new().dispatch(Forces { pass: self.pass(chunk, positions), forces });
    }

    fn differential(
        &self,
        chunk: &Chunk,
        _: &[Vec3],
        positions: &[Padded],
        delta: &[Padded],
        scale: f64,
        forces: &mut [Padded],
    ) {
        Arch::new().dispatch(Differential { pass: self.pass(chunk, positions), delta, scale, forces });
    }

    fn energy(&self, chunk: &Chunk, _: &[Vec3], positions: &[Padded]) -> f64 {
        Arch::new().dispatch(Energy { pass: self.pass(chunk, positions) })
    }

    fn quadratic_form(&self, chunk: &Chunk, _: &[Vec3], positions: &[Padded], delta: &[Padded]) -> f64 {
        Arch::new().dispatch(QuadraticForm { pass: self.pass(chunk, positions), delta })
    }

    fn blocks_at_once(&self) -> usize {
        self.samples.blocks_at_once()
    }

    fn blocks(
        &self,
        chunk: &Chunk,
        blocks: Range<usize>,
        reference: &[Vec3],
        positions: &[Padded],
        scale: f64,
        out: &mut [f64],
    ) {
        self.samples.blocks(chunk, blocks, reference, positions, scale, out);
    }
}

/// What every loop goes over.
struct Pass<'a, E, const N: usize> {
    kernel: &'a DerivedKernel<E, N>,
    chunk: &'a Chunk,
    positions: &'a [Padded],
}

/// The samples of a register's worth of elements, with volumes times a factor.
struct Samples<'g, 'a, S: Simd, const N: usize> {
    group: &'g Group<'a, S, N>,
    scale: f64,
}

impl<S: Simd, const N: usize> RestSamples<Lanes<S>> for Samples<'_, '_, S, N> {
    #[inline(always)]
    fn sample(&self, sample: usize) -> (Mat3<Lanes<S>>, Lanes<S>) {
        // what takes longer needs to be asked for less far ahead
        self.group.prefetch(if self.group.samples == 1 { 2 } else { 1 }, sample);
        let (inverse, volume) = self.group.sample(sample);
        (inverse, volume * self.scale)
    }
}

struct Forces<'a, E, const N: usize> {
    pass: Pass<'a, E, N>,
    forces: &'a mut [Padded],
}

impl<E: DerivedElement<N>, const N: usize> WithSimd for Forces<'_, E, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Pass { kernel, chunk, positions } = self.pass;
        for_each_group!(simd, chunk, N, E::SAMPLES, 0..chunk.block_count(), N, |group| {
            let x = group.gather(positions);
            let at = Samples { group: &group, scale: 1.0 };
            let f = E::forces(&kernel.numbers(&group), &x, &at);
            group.scatter(&f, self.forces);
        });
    }
}

struct Differential<'a, E, const N: usize> {
    pass: Pass<'a, E, N>,
    delta: &'a [Padded],
    scale: f64,
    forces: &'a mut [Padded],
}

impl<E: DerivedElement<N>, const N: usize> WithSimd for Differential<'_, E, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Pass { kernel, chunk, positions } = self.pass;
        for_each_group!(simd, chunk, N, E::SAMPLES, 0..chunk.block_count(), N, |group| {
            let (x, dx) = (group.gather(positions), group.gather(self.delta));
            let at = Samples { group: &group, scale: self.scale };
            let df = E::differential(&kernel.numbers(&group), &x, &dx, &at);
            group.scatter(&df, self.forces);
        });
    }
}

struct Energy<'a, E, const N: usize> {
    pass: Pass<'a, E, N>,
}

impl<E: DerivedElement<N>, const N: usize> WithSimd for Energy<'_, E, N> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Pass { kernel, chunk, positions } = self.pass;
        let mut sum = 0.0;
        for_each_group!(simd, chunk, N, E::SAMPLES, 0..chunk.block_count(), N, |group| {
            let x = group.gather(positions);
            let at = Samples { group: &group, scale: 1.0 };
            sum += group.sum(E::energy(&kernel.numbers(&group), &x, &at));
        });
        sum
    }
}

struct QuadraticForm<'a, E, const N: usize> {
    pass: Pass<'a, E, N>,
    delta: &'a [Padded],
}

impl<E: DerivedElement<N>, const N: usize> WithSimd for QuadraticForm<'_, E, N> {
    type Output = f64;

    // -δ·δf
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Pass { kernel, chunk, positions } = self.pass;
        let mut sum = 0.0;
        for_each_group!(simd, chunk, N, E::SAMPLES, 0..chunk.block_count(), N, |group| {
            let (x, dx) = (group.gather(positions), group.gather(self.delta));
            let at = Samples { group: &group, scale: -1.0 };
            let df = E::differential(&kernel.numbers(&group), &x, &dx, &at);
            let mut product = x[0].x.zero();
            for node in 0..N {
                product += dx[node].dot(df[node]);
            }
            sum += group.sum(product);
        });
        sum
    }
}
