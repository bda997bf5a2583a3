//! Solids: finite elements of any kind and law, mixed in one body; plane bodies, membranes and bars with them.

mod assembly;
mod elements;
mod geometry;
mod group;
mod kernel;
pub(crate) mod layout;
mod mass;
mod output;
pub(crate) mod parallel;
mod rayleigh;
mod row_law;
pub(crate) mod sample_law;
mod section;
mod section_kernel;
mod staged;
mod viscosity;
mod viscous_kernel;

use std::any::Any;
use std::ops::Range;
use std::sync::Arc;

use souple_engine::state::Pair;
use souple_engine::{CellField, Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::Vec3;
use souple_mesh::{ElementKind, MAX_NODES, Mesh, QuadratureRule};
use souple_solve::BlockMatrix;

use crate::materials::{Law, LawVisitor, Material, MaterialLaw, Parameters};
use assembly::{Assembly, Symmetry};
use elements::{Batch, Elements, Sorting};
use geometry::{AnyElement, Tetrahedron};
use kernel::{Kernel, LawKernel};
use layout::Chunk;
use row_law::{RowLaw, row_law};
use sample_law::{Compiled, SampleLaw, Taped};
use section_kernel::SectionKernel;
use staged::Staged;

pub use layout::FlatCell;
pub use mass::{consistent_mass, lumped_mass, uniform_mass};
pub use rayleigh::RayleighDamping;
pub use section::{BuildSection, SECTIONS, Section};
pub use viscosity::Viscosity;

/// Elastic forces of a body.
pub struct SolidForce {
    name: String,
    elements: Elements<Box<dyn Kernel>>,
    materials: Vec<Material>,
    /// Per cell of the body.
    material_of_cell: Vec<u16>,
    chunk_of_cell: Vec<u32>,
    quadrature: Quadrature,
    section: Section,
    /// The laws of the materials, for what is read off single cells.
    row_laws: Vec<Box<dyn RowLaw>>,
}

/// Which rule of quadrature integrates the energy of an element.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quadrature {
    /// Exact for linear elasticity on straight-sided elements; the cheapest that keeps full rank.
    #[default]
    Default,
    /// Exact for St. Venant–Kirchhoff energy too: more samples in hexahedra, prisms and pyramids.
    Full,
}

impl Quadrature {
    pub fn rule(self, kind: ElementKind) -> &'static QuadratureRule {
        match self {
            Self::Default => kind.default_rule(),
            Self::Full => kind.full_rule(),
        }
    }
}

/// What a body is made of.
#[derive(Clone)]
pub struct SolidDescription<'a> {
    pub name: String,
    /// Rest shape; point `i` is row `first_row + i`.
    pub mesh: &'a Mesh,
    pub first_row: usize,
    pub materials: &'a [Material],
    /// Index into `materials` for each cell.
    pub material_of_cell: &'a [u16],
    pub quadrature: Quadrature,
    /// What its cells are sections of.
    pub section: Section,
}

/// Partial sums and what assembles matrices, kept between calls.
struct SolidScratch {
    partials: Vec<Vec3>,
    assembly: Assembly,
}

impl SolidScratch {
    fn boxed() -> Scratch {
        Box::new(Self { partials: Vec::new(), assembly: Assembly::new(Symmetry::Symmetric) })
    }

    fn of(scratch: &mut Scratch) -> &mut Self {
        scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
    }

    fn bytes(scratch: &Scratch) -> usize {
        scratch
            .downcast_ref()
            .map_or(0, |Self { partials, assembly }| 24 * partials.capacity() + assembly.bytes())
    }
}

/// A cell's batch and chunk, and its number there.
type Place<'a> = (&'a Batch<Box<dyn Kernel>>, &'a Chunk, usize);

struct MakeKernel(ElementKind);

impl LawVisitor for MakeKernel {
    type Output = Box<dyn Kernel>;

    fn visit<L: Law>(self, _: L) -> Box<dyn Kernel> {
        match self.0 {
            ElementKind::Tet4 => Box::new(LawKernel::<L, Tetrahedron, 4>::default()),
            kind => staged(kind, Box::new(Compiled::<L>::default())),
        }
    }
}

/// Elements by law, with the law's numbers.
struct ByLaw<'a> {
    materials: &'a [Material],
    material_of_cell: &'a [u16],
    section: Section,
}

impl Sorting for ByLaw<'_> {
    type Law = MaterialLaw;
    type Kernel = Box<dyn Kernel>;

    fn law_of(&self, cell: usize) -> &MaterialLaw {
        &self.materials[self.material_of_cell[cell] as usize].law
    }

    fn parameters_of(&self, cell: usize) -> &[f64] {
        let material = &self.materials[self.material_of_cell[cell] as usize];
        let count = match &material.law {
            MaterialLaw::Known(law) => law.visit(ParameterCount),
            // its numbers are constants of its tape
            MaterialLaw::Text(_) => 0,
        };
        &material.parameters[..count]
    }

    fn kernel(&self, kind: ElementKind, law: &MaterialLaw) -> Box<dyn Kernel> {
        if self.section != Section::Solid {
            let (law, nodes) = (row_law(law), kind.node_count());
            return Box::new(SectionKernel { law, section: self.section, nodes });
        }
        match law {
            MaterialLaw::Known(law) => law.visit(MakeKernel(kind)),
            MaterialLaw::Text(law) => staged(kind, Box::new(Taped(Arc::clone(law)))),
        }
    }

    fn blocks_at_once(&self, kernel: &Box<dyn Kernel>) -> usize {
        kernel.blocks_at_once()
    }
}

impl SolidForce {
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(description: &SolidDescription) -> Result<Self, FlatCell> {
        let SolidDescription { name, mesh, materials, material_of_cell, quadrature, section, .. } =
            description;
        let elements = Elements::new(description, &ByLaw { materials, material_of_cell, section: *section })?;
        Ok(Self {
            name: name.clone(),
            chunk_of_cell: elements.chunk_of_cell(mesh.cell_count()),
            elements,
            materials: materials.to_vec(),
            material_of_cell: material_of_cell.to_vec(),
            quadrature: *quadrature,
            section: *section,
            row_laws: materials.iter().map(|material| row_law(&material.law)).collect(),
        })
    }
}

/// A law that knows no elements, and how many numbers it has at each sample.
pub(crate) fn law_of_samples(law: &MaterialLaw) -> (Box<dyn SampleLaw>, usize) {
    struct Make;
    impl LawVisitor for Make {
        type Output = Box<dyn SampleLaw>;
        fn visit<L: Law>(self, _: L) -> Box<dyn SampleLaw> {
            Box::new(Compiled::<L>::default())
        }
    }
    match law {
        MaterialLaw::Known(law) => (law.visit(Make), law.visit(ParameterCount)),
        // its numbers are constants of its tape
        MaterialLaw::Text(law) => (Box::new(Taped(Arc::clone(law))), 0),
    }
}

struct ParameterCount;

impl LawVisitor for ParameterCount {
    type Output = usize;

    fn visit<L: Law>(self, _: L) -> usize {
        <L::Parameters<f64> as Parameters<f64>>::NAMES.len()
    }
}

/// The kernel for a law that knows no elements.
fn staged(kind: ElementKind, law: Box<dyn SampleLaw>) -> Box<dyn Kernel> {
    match kind {
        ElementKind::Tet4 => Box::new(Staged::<Tetrahedron, 4>::new(law, 4)),
        _ => Box::new(Staged::<AnyElement, MAX_NODES>::new(law, kind.node_count())),
    }
}

impl Force for SolidForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        // small strain knows a rest orientation: a rotated body feels a torque
        Declaration { internal: self.is_objective(), ..Declaration::ELASTIC }
    }

    fn new_scratch(&self) -> Scratch {
        SolidScratch::boxed()
    }

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let stored = self
            .elements
            .sum([at.positions], |batch, chunk, [x]| batch.kernel.energy(chunk, &batch.reference, x));
        Energy { stored, dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let partials = &mut SolidScratch::of(scratch).partials;
        self.elements.add_sums([at.positions], partials, out, |batch, chunk, [x], sums| {
            batch.kernel.forces(chunk, &batch.reference, x, sums);
        });
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        if weights.position == 0.0 {
            return;
        }
        let partials = &mut SolidScratch::of(scratch).partials;
        self.elements.add_sums([at.positions, delta], partials, out, |batch, chunk, [x, delta], sums| {
            batch.kernel.differential(chunk, &batch.reference, x, delta, weights.position, sums);
        });
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.elements.visit_cliques(visit);
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        if weights.position == 0.0 {
            return;
        }
        let SolidScratch { partials, assembly } = SolidScratch::of(scratch);
        assembly.add_blocks(
            &self.elements,
            [at.positions],
            partials,
            matrix,
            |batch, chunk, blocks, [x], out| {
                batch.kernel.blocks(chunk, blocks, &batch.reference, x, weights.position, out);
            },
        );
    }

    fn bytes(&self) -> usize {
        self.elements.bytes()
            + 4 * self.chunk_of_cell.capacity()
            + 2 * self.material_of_cell.capacity()
            + size_of::<Material>() * self.materials.capacity()
    }

    fn scratch_bytes(&self, scratch: &Scratch) -> usize {
        SolidScratch::bytes(scratch)
    }

    fn cell_field(&self, cell: usize, positions: &[Vec3]) -> Option<CellField> {
        self.field_of_cell(cell, positions)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

impl SolidForce {
    /// Whether every law gives rotated bodies no stress.
    fn is_objective(&self) -> bool {
        self.section.follows_rotation() || self.materials.iter().all(|material| material.law.is_objective())
    }

    pub fn cell_count(&self) -> usize {
        self.material_of_cell.len()
    }

    /// The kind of a cell and the rows of its nodes.
    pub fn cell(&self, cell: usize) -> Option<(ElementKind, impl Iterator<Item = usize>)> {
        let (batch, chunk, slot) = self.place(cell)?;
        Some((batch.kind, chunk.rows_of(slot, batch.kind.node_count()).map(|row| row as usize)))
    }

    fn place(&self, cell: usize) -> Option<Place<'_>> {
        let (batch, chunk) = self.elements.chunk(*self.chunk_of_cell.get(cell)? as usize);
        let slot = chunk.cells.binary_search(&(cell as u32)).ok()?;
        Some((batch, chunk, slot))
    }

    pub fn rows(&self) -> Range<usize> {
        self.elements.rows()
    }

    pub fn quadrature(&self) -> Quadrature {
        self.quadrature
    }

    /// The material of a cell.
    pub fn material(&self, cell: usize) -> &Material {
        &self.materials[self.material_of_cell[cell] as usize]
    }
}
