//! Solids: finite elements of any kind and law, mixed in one body; plane bodies, membranes and bars with them.

mod abreast;
mod adaptive;
mod assembly;
mod bending;
mod cellwise;
pub mod derived;
mod difference;
mod eight_samples;
mod elements;
mod formulation;
pub(crate) mod geometry;
mod group;
mod incompressible;
mod inelastic;
mod kernel;
pub(crate) mod layout;
mod linear_elements;
mod mass;
mod output;
pub(crate) mod parallel;
mod quadrature;
mod rayleigh;
mod row_law;
pub(crate) mod sample_law;
mod section;
mod section_kernel;
mod staged;
mod stiffness;
pub(crate) mod turned;
mod viscosity;
mod viscous_kernel;

use std::any::Any;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use souple_engine::state::Pair;
use souple_engine::{
    CellField, Configuration, Curvature, Declaration, Energy, Force, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_mesh::{ElementKind, MAX_NODES, Mesh, QuadratureRule};
use souple_solve::BlockMatrix;

use crate::derive::MapKind;
use crate::materials::{Law, LawVisitor, Material, MaterialLaw, Oriented, Parameters};
use assembly::{Assembly, Symmetry};
use derived::Wanted;
use eight_samples::EightSamples;
use elements::{Batch, Elements, Sorting};
use geometry::{AnyElement, Tetrahedron};
use kernel::{Kernel, LawKernel};
use layout::{Alike, Chunk};
use linear_elements::{Hexahedron, Prism, Pyramid};
use row_law::{RowLaw, row_law};
use sample_law::{Compiled, SampleLaw, Taped};
use section_kernel::SectionKernel;
use staged::Staged;
use stiffness::{Shapes, Stiffness};
use turned::{AXES_LEN, TurnedRows, TurnedSamples};

pub use adaptive::{Adaptation, AdaptiveForce, Criterion};
pub use bending::{
    Bending, BendingDamping, BendingDescription, BendingError, BorderEdge, Clamp, HeldSlope, Plate,
    Rigidities, border_edges, lies_across, plane_axes, rigidity_of_law,
};
pub use difference::DifferencedForce;
pub(crate) use formulation::four_loop_count;
pub(crate) use formulation::linear_pairs;
pub use formulation::{
    BuildFormulation, FORMULATIONS, FormulationError, OperatorQuality, QualityError, formulated, keeps_texts,
    operator_quality,
};
pub use incompressible::{Incompressibility, Incompressible, Multipliers, Pressures};
pub use inelastic::{Amount, Fracture, InelasticForce, Inelasticity, Yielding};
pub use layout::FlatCell;
pub use mass::{consistent_mass, lumped_mass, uniform_mass, voronoi_mass};
pub use quadrature::Quadrature;
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
    /// Of each cell, where they are not those of the world.
    axes: Vec<Mat3>,
    declaration: Declaration,
    /// Where its points rest, if its kernels take displacements in the place of positions [m]; else empty.
    rest: Vec<Vec3>,
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
    /// The axes of the law of each cell as columns; none: those of the world. Laws without directions do not read them.
    pub axes: &'a [Mat3],
    pub quadrature: Quadrature,
    /// What its cells are sections of.
    pub section: Section,
}

/// Partial sums and what assembles matrices, kept between calls.
struct SolidScratch {
    partials: Vec<Vec3>,
    assembly: Assembly,
    /// Of all rows, where kernels take displacements.
    displacements: Vec<Vec3>,
}

impl SolidScratch {
    fn boxed() -> Scratch {
        Box::new(Self {
            partials: Vec::new(),
            assembly: Assembly::new(Symmetry::Symmetric),
            displacements: Vec::new(),
        })
    }

    fn of(scratch: &mut Scratch) -> &mut Self {
        scratch.downcast_mut().unwrap_or_else(|| unreachable!("made by this force's own new_scratch"))
    }

    fn bytes(scratch: &Scratch) -> usize {
        scratch.downcast_ref().map_or(0, |Self { partials, assembly, displacements }| {
            24 * (partials.capacity() + displacements.capacity()) + assembly.bytes()
        })
    }
}

/// A cell's batch and chunk, and its number there.
type Place<'a> = (&'a Batch<Box<dyn Kernel>>, &'a Chunk, usize);

struct MakeKernel<'a>(ElementKind, &'a QuadratureRule);

impl LawVisitor for MakeKernel<'_> {
    type Output = Box<dyn Kernel>;

    fn visit<L: Law>(self, _: L) -> Box<dyn Kernel> {
        match self.0 {
            ElementKind::Tet4 => Box::new(LawKernel::<L, Tetrahedron, 4>::default()),
            kind => staged(kind, self.1, Box::new(Compiled::<L>::default())),
        }
    }
}

/// Cells with the same kernel: of one law, and of one shape and material where one matrix serves them all.
struct Class<'a> {
    law: &'a MaterialLaw,
    shape: Option<u32>,
    stiffness: Option<Arc<Stiffness>>,
    /// How the rest shape is mapped, where a derived kernel reads it.
    map: MapKind,
    /// The material, where cells are sorted alike under any law: those of two may have one law now and two then.
    material: Option<u16>,
}

impl PartialEq for Class<'_> {
    fn eq(&self, other: &Self) -> bool {
        (self.law, self.shape, self.map, self.material) == (other.law, other.shape, other.map, other.material)
    }
}

/// Blocks of lanes that a chunk has at least where its cells may come to have two laws, and store the samples of their shape once: those
/// of either law fill their last block in part only.
const MIXED_BLOCKS: usize = 16;

/// Which kernels cells without a stiffness of their own have.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kernels {
    /// Derived ones where they are faster, else by samples.
    Fastest,
    /// The same, where cells are sorted alike under any law: those that share no shape are not looked at for what derived ones know.
    FastestAlike,
    Samples,
}

impl Kernels {
    /// Whether cells of a kind are looked at one by one, for what a derived kernel of a law knows of boxes.
    fn reads_map(self, law: &MaterialLaw, kind: ElementKind, has_shape: bool) -> bool {
        match self {
            // a stiffness that cells of one shape share has no map
            Self::Fastest => !has_shape && derived::has_box(law, kind),
            // cells of one shape are boxes together
            Self::FastestAlike => has_shape && !law.is_linear() && derived::has_box(law, kind),
            Self::Samples => false,
        }
    }
}

/// Elements by law and by shape, with the law's numbers.
struct ByLaw<'a> {
    classes: Vec<Class<'a>>,
    class_of_cell: Vec<u32>,
    materials: &'a [Material],
    material_of_cell: &'a [u16],
    /// Of each cell, as the laws' numbers; none: those of the world.
    axes: Vec<[f64; AXES_LEN]>,
    section: Section,
    kernels: Kernels,
}

impl<'a> ByLaw<'a> {
    /// # Errors
    /// A cell with a stiffness is flat or inverted at rest.
    fn new(description: &SolidDescription<'a>, shapes: &Shapes, kernels: Kernels) -> Result<Self, FlatCell> {
        let SolidDescription {
            mesh, first_row, materials, material_of_cell, axes, quadrature, section, ..
        } = description;
        let mut sorting = Self {
            classes: Vec::new(),
            class_of_cell: Vec::with_capacity(mesh.cell_count()),
            materials,
            material_of_cell,
            axes: axes.iter().map(turned::numbers).collect(),
            section: *section,
            kernels,
        };
        // cells of one shape have one material
        let mut known: HashMap<(u16, Option<u32>, MapKind), u32> = HashMap::new();
        let mut map_of_shape: HashMap<u32, MapKind> = HashMap::new();
        for (index, (cell, material)) in mesh.cells().zip(*material_of_cell).enumerate() {
            let shape = shapes.of_cell(index);
            let law = &materials[usize::from(*material)].law;
            let map = || match kernels.reads_map(law, cell.kind, shape.is_some()) {
                true => derived::map_of(mesh, &cell),
                false => MapKind::General,
            };
            // cells of one shape have one map, that of the first, whatever their rounding
            let map = match shape {
                Some(shape) => *map_of_shape.entry(shape).or_insert_with(map),
                None => map(),
            };
            let next = sorting.classes.len() as u32;
            let class = *known.entry((*material, shape, map)).or_insert(next);
            sorting.class_of_cell.push(class);
            if class < next {
                continue;
            }
            let stiffness = if shape.is_some() && law.is_linear() {
                let rule = quadrature.rule(cell.kind);
                let body = layout::Body { mesh, first_row: *first_row, rule, measure: section.measure() };
                let (kernel, numbers) =
                    (sorting.of_samples(cell.kind, rule, law), sorting.parameters_of(index));
                Some(Arc::new(Stiffness::new(&body, index as u32, numbers, kernel.as_ref())?))
            } else {
                None
            };
            let material = (kernels == Kernels::FastestAlike).then_some(*material);
            sorting.classes.push(Class { law, shape, stiffness, map, material });
        }
        Ok(sorting)
    }

    /// The kernel that evaluates a law at every sample.
    fn of_samples(&self, kind: ElementKind, rule: &QuadratureRule, law: &MaterialLaw) -> Box<dyn Kernel> {
        if self.section != Section::Solid {
            let (law, nodes) = (rows_along(law, !self.axes.is_empty()), kind.node_count());
            return Box::new(SectionKernel { law, section: self.section, nodes });
        }
        match law {
            MaterialLaw::Known(law) => law.visit(MakeKernel(kind, rule)),
            MaterialLaw::Text(_) => staged(kind, rule, law_of_samples(law, !self.axes.is_empty()).0),
        }
    }
}

impl ByLaw<'_> {
    /// The kernel of cells that have no stiffness of their own.
    fn of_cells(&self, kind: ElementKind, rule: &QuadratureRule, class: &Class) -> Box<dyn Kernel> {
        let samples = || self.of_samples(kind, rule, class.law);
        let takes_derived = self.kernels != Kernels::Samples
            && matches!(self.section, Section::Solid | Section::PlaneStrain { .. });
        let derived = takes_derived
            .then(|| derived::kernel(class.law, (kind, class.map), rule, Wanted::Fastest, samples))
            .flatten();
        derived.unwrap_or_else(samples)
    }
}

impl<'a> Sorting for ByLaw<'a> {
    type Law = Class<'a>;
    type Kernel = Box<dyn Kernel>;

    fn law_of(&self, cell: usize) -> &Class<'a> {
        &self.classes[self.class_of_cell[cell] as usize]
    }

    fn parameters_of(&self, cell: usize) -> &[f64] {
        let material = &self.materials[self.material_of_cell[cell] as usize];
        let count = match &material.law {
            MaterialLaw::Known(law) => law.visit(ParameterCount),
            MaterialLaw::Text(_) => return self.axes.get(cell).map_or(&[], |axes| &axes[..]),
        };
        &material.parameters[..count]
    }

    fn kernel(&self, kind: ElementKind, rule: &QuadratureRule, class: &Class) -> Box<dyn Kernel> {
        match &class.stiffness {
            Some(stiffness) => stiffness::kernel(Arc::clone(stiffness)),
            None => self.of_cells(kind, rule, class),
        }
    }

    fn alike(&self, class: &Class<'a>) -> Alike {
        let has_one_shape = class.shape.is_some();
        let is_mixed = has_one_shape && self.kernels == Kernels::FastestAlike;
        let least_blocks = if is_mixed { MIXED_BLOCKS } else { derived::least_blocks(class.map) };
        Alike { has_one_shape, least_blocks }
    }

    fn blocks_at_once(&self, kernel: &Box<dyn Kernel>) -> usize {
        kernel.blocks_at_once()
    }
}

impl SolidForce {
    /// The fastest that is exact: cells of linear laws by their stiffness where many have one shape, others by a kernel derived for
    /// their law and kind where that is faster, and by samples; texts that are laws of the table as those.
    ///
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn new(description: &SolidDescription) -> Result<Self, FlatCell> {
        let materials = Material::all_of_table(description.materials);
        let description =
            SolidDescription { name: description.name.clone(), materials: &materials, ..*description };
        Self::of_shapes(&description, &Shapes::of_linear(&description), Kernels::Fastest)
    }

    /// Every cell by its samples.
    ///
    /// # Errors
    /// A cell is flat or inverted at rest.
    pub fn of_samples(description: &SolidDescription) -> Result<Self, FlatCell> {
        Self::of_shapes(description, &Shapes::default(), Kernels::Samples)
    }

    /// With a batch for each shape, of all laws.
    fn of_shapes(
        description: &SolidDescription,
        shapes: &Shapes,
        kernels: Kernels,
    ) -> Result<Self, FlatCell> {
        Self::sorted_by(description, &ByLaw::new(description, shapes, kernels)?)
    }

    /// With the kernels of another formulation.
    fn sorted_by(
        description: &SolidDescription,
        sorting: &impl Sorting<Kernel = Box<dyn Kernel>>,
    ) -> Result<Self, FlatCell> {
        let SolidDescription { name, mesh, materials, material_of_cell, axes, quadrature, section, .. } =
            description;
        let elements = Elements::new(description, sorting)?;
        // small strain knows a rest orientation: a rotated body feels a torque
        let is_objective =
            section.follows_rotation() || materials.iter().all(|material| material.law.is_objective());
        Ok(Self {
            name: name.clone(),
            chunk_of_cell: elements.chunk_of_cell(mesh.cell_count()),
            elements,
            materials: materials.to_vec(),
            material_of_cell: material_of_cell.to_vec(),
            quadrature: *quadrature,
            section: *section,
            row_laws: materials.iter().map(|material| rows_along(&material.law, !axes.is_empty())).collect(),
            axes: axes.to_vec(),
            declaration: Declaration { internal: is_objective, ..Declaration::ELASTIC },
            rest: Vec::new(),
        })
    }

    fn declared(self, declaration: Declaration) -> Self {
        Self { declaration, ..self }
    }

    /// Its kernels take displacements from the points of `mesh`.
    fn of_displacements(self, mesh: &Mesh) -> Self {
        Self { rest: mesh.points.clone(), ..self }
    }

    /// What the kernels take of row positions; `buffer` holds it where that is not the positions themselves.
    fn seen<'a>(&self, positions: &'a [Vec3], buffer: &'a mut Vec<Vec3>) -> &'a [Vec3] {
        if self.rest.is_empty() {
            return positions;
        }
        buffer.resize(positions.len(), Vec3::ZERO);
        let rows = self.elements.rows();
        for ((u, x), rest) in buffer[rows.clone()].iter_mut().zip(&positions[rows]).zip(&self.rest) {
            *u = *x - *rest;
        }
        buffer
    }
}

/// The law of a material for rows; of one that may know directions, along axes of each cell.
fn rows_along(law: &MaterialLaw, has_axes: bool) -> Box<dyn RowLaw> {
    let rows = row_law(law);
    if has_axes && matches!(law, MaterialLaw::Text(_)) { Box::new(TurnedRows(rows)) } else { rows }
}

/// A law that knows no elements, and how many numbers it has at each sample: those of the axes, where it may know directions and has some.
pub(crate) fn law_of_samples(law: &MaterialLaw, has_axes: bool) -> (Box<dyn SampleLaw>, usize) {
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
        MaterialLaw::Text(law) => {
            let law = Box::new(Taped(Arc::clone(law)));
            if has_axes { (Box::new(TurnedSamples(law)), AXES_LEN) } else { (law, 0) }
        }
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
fn staged(kind: ElementKind, rule: &QuadratureRule, law: Box<dyn SampleLaw>) -> Box<dyn Kernel> {
    match kind {
        ElementKind::Tet4 => Box::new(Staged::<Tetrahedron, 4>::new(law, kind, rule)),
        ElementKind::Pyramid5 => Box::new(Staged::<Pyramid, 5>::new(law, kind, rule)),
        ElementKind::Prism6 => Box::new(Staged::<Prism, 6>::new(law, kind, rule)),
        ElementKind::Hex8 if EightSamples::fit(rule) => {
            Box::new(Staged::<EightSamples, 12>::new(law, kind, rule))
        }
        ElementKind::Hex8 => Box::new(Staged::<Hexahedron, 8>::new(law, kind, rule)),
        _ => Box::new(Staged::<AnyElement, MAX_NODES>::new(law, kind, rule)),
    }
}

impl Force for SolidForce {
    fn name(&self) -> &str {
        &self.name
    }

    fn acts_within(&self) -> bool {
        true
    }

    fn declaration(&self) -> Declaration {
        self.declaration
    }

    fn new_scratch(&self) -> Scratch {
        SolidScratch::boxed()
    }

    fn energy(&self, at: &Configuration, scratch: &mut Scratch) -> Energy {
        let positions = self.seen(at.positions, &mut SolidScratch::of(scratch).displacements);
        let stored = self
            .elements
            .sum([positions], |batch, chunk, [x]| batch.kernel.energy(chunk, &batch.reference, x));
        Energy { stored, dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, scratch: &mut Scratch, out: &mut [Vec3]) {
        let SolidScratch { partials, displacements, .. } = SolidScratch::of(scratch);
        self.elements.add_sums(
            [self.seen(at.positions, displacements)],
            partials,
            out,
            |batch, chunk, [x], sums| {
                batch.kernel.forces(chunk, &batch.reference, x, sums);
            },
        );
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
        let SolidScratch { partials, displacements, .. } = SolidScratch::of(scratch);
        let positions = self.seen(at.positions, displacements);
        self.elements.add_sums([positions, delta], partials, out, |batch, chunk, [x, delta], sums| {
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
        self.assemble(Curvature::Exact, at, weights, scratch, matrix);
    }

    fn add_definite_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        self.assemble(Curvature::Definite, at, weights, scratch, matrix)
    }

    fn bytes(&self) -> usize {
        self.elements.bytes()
            + 4 * self.chunk_of_cell.capacity()
            + 2 * self.material_of_cell.capacity()
            + size_of::<Material>() * self.materials.capacity()
            + size_of_val(self.rest.as_slice())
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
    /// Whether anything was turned round to be definite.
    fn assemble(
        &self,
        curvature: Curvature,
        at: &Configuration,
        weights: TangentWeights,
        scratch: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) -> bool {
        if weights.position == 0.0 {
            return false;
        }
        let SolidScratch { partials, assembly, displacements } = SolidScratch::of(scratch);
        let inputs = [self.seen(at.positions, displacements)];
        assembly.add(curvature, &self.elements, inputs, partials, matrix, |batch, chunk, blocks, [x], out| {
            batch.kernel.blocks(chunk, blocks, &batch.reference, x, weights.position, out);
        })
    }
}

impl SolidForce {
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

    /// The material of a cell along its axes.
    fn oriented(&self, cell: usize) -> Oriented<'_> {
        self.material(cell).along(self.axes.get(cell))
    }
}
