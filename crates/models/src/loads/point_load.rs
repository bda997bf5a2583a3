//! Point loads: forces on chosen rows, constant or a function of time and place.

use std::any::Any;
use std::sync::Arc;

use souple_engine::tangent::add_block;
use souple_engine::{Configuration, Declaration, Energy, Force, Pair, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::{ForceField, LoadError, finite};

/// `f_i = share_i F(x_i, t)`: shares of one force on each row, or of a total spread by area.
#[derive(Clone, Debug)]
pub struct PointLoad {
    name: String,
    rows: Vec<(u32, f64)>,
    field: Arc<dyn ForceField>,
}

impl PointLoad {
    /// `rows` with their shares of the force: 1 each where every row takes all of it.
    ///
    /// # Errors
    /// No rows, or a share that is not finite.
    pub fn new(
        name: impl Into<String>,
        rows: Vec<(u32, f64)>,
        field: Arc<dyn ForceField>,
    ) -> Result<Self, LoadError> {
        if rows.is_empty() {
            return Err(LoadError::Empty { field: "rows", expected: "row that takes the load" });
        }
        for (index, (_, share)) in rows.iter().enumerate() {
            finite(format!("rows[{index}].share"), *share)?;
        }
        Ok(Self { name: name.into(), rows, field })
    }

    /// Calls `add(row, ∂f/∂x)` for every row; never where the force does not change with the place.
    fn for_blocks(&self, at: &Configuration, mut add: impl FnMut(usize, Mat3)) {
        if !self.field.depends_on_position() {
            return;
        }
        for &(row, share) in &self.rows {
            let gradient = self.field.gradient(at.positions[row as usize], at.time);
            add(row as usize, gradient * (share * at.load));
        }
    }
}

impl Force for PointLoad {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        // a field of place may have a curl: no potential is claimed for it
        let by_time_alone = !self.field.depends_on_position();
        Declaration { conservative: by_time_alone, symmetric_tangent: by_time_alone, ..Declaration::LOAD }
    }

    // E = -Σ share F(t) · x, where the force does not change with the place
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        if self.field.depends_on_position() {
            return Energy::default();
        }
        let work = |&(row, share): &(u32, f64)| {
            let x = at.positions[row as usize];
            self.field.force(x, at.time).dot(x) * share
        };
        Energy { stored: -at.load * self.rows.iter().map(work).sum::<f64>(), dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        for &(row, share) in &self.rows {
            let row = row as usize;
            out[row] += self.field.force(at.positions[row], at.time) * (share * at.load);
        }
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        self.for_blocks(at, |row, block| out[row] += block * delta[row] * weights.position);
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.rows.iter().for_each(|&(row, _)| visit(&[row]));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.for_blocks(at, |row, block| add_block(matrix, row, row, &(block * weights.position)));
    }

    // (K + Kᵀ)/2
    fn add_symmetric_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.for_blocks(at, |row, block| {
            add_block(matrix, row, row, &(block.symmetric_part() * weights.position));
        });
    }

    fn bytes(&self) -> usize {
        size_of_val(self.rows.as_slice())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
