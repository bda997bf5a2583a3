//! Loops over rows of nodes with the widest instructions of this processor.

/// A loop over rows of a block.
pub trait Rows {
    fn run(self);
}

/// Runs with the widest instructions of this processor.
pub fn run_widest<R: Rows>(rows: R) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        struct Wide<R>(R);
        impl<R: Rows> pulp::NullaryFnOnce for Wide<R> {
            type Output = ();
            #[inline(always)]
            fn call(self) {
                self.0.run();
            }
        }
        return simd.vectorize(Wide(rows));
    }
    rows.run();
}
