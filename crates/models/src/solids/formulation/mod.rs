//! Ways to evaluate the forces of a solid, side by side: what the others are held against.
//!
//! Bodies take forces by derived kernels or sample by sample, whichever is faster, and of linear laws by a stiffness that elements of
//! one shape share, unless their scene says otherwise ([`crate::solids::SolidForce`]); that is exact for every law on every element. The formulations here are those of the literature: exact ones that arrange the same
//! numbers otherwise, and approximations that were made for speed. `souple bench formal` prints time and error of all.

mod cells;
mod corotated;
mod derived;
mod edge_tensors;
mod four_loops;
mod gauss_voronoi;
mod grouped;
mod pairs;
mod polynomial;
mod quality;
mod simplices;
mod springs;
mod tensor_mass;

use souple_engine::Force;
use souple_mesh::ElementKind;
use souple_table::{Entry, Table, Values};

pub(crate) use four_loops::operations as four_loop_count;
pub use quality::{OperatorQuality, QualityError, operator_quality};

/// What linear forces between pairs of points are made of, for rooms that have other pairs.
pub(crate) mod linear_pairs {
    pub use super::edge_tensors::{add as add_simplex, elastic, in_plane};
    pub use super::pairs::{PairForce, PairSums};
    pub use super::simplices::{Simplex, depth_of, linear_moduli};
}

use super::{FlatCell, Section, SolidDescription, SolidForce};
use crate::materials::{AnyLaw, Lame, Material, MaterialLaw};

/// Makes the elastic force of a body from it and the formulation's own values.
pub type BuildFormulation = fn(&SolidDescription, &Values) -> Result<Box<dyn Force>, FormulationError>;

/// The elastic force of a body; texts that are laws of the table are taken as those by formulations that take no text.
///
/// # Errors
/// The formulation does not take the body.
pub fn formulated(
    build: BuildFormulation,
    description: &SolidDescription,
    values: &Values,
) -> Result<Box<dyn Force>, FormulationError> {
    let refused = match build(description, values) {
        Err(refused @ (FormulationError::Law { .. } | FormulationError::Underived { .. })) => refused,
        answer => return answer,
    };
    let materials = Material::all_of_table(description.materials);
    if materials.iter().zip(description.materials).all(|(known, given)| known.law == given.law) {
        return Err(refused);
    }
    build(&SolidDescription { materials: &materials, ..description.clone() }, values)
}

/// Whether a formulation takes a text as it is, also where that is a law of the table.
pub fn keeps_texts(formulation: &Entry<BuildFormulation>) -> bool {
    KEEPING_TEXTS.contains(&formulation.name)
}

/// Formulations that take any law, and run it as it is given or, `mass_spring`, read its stiffness alone.
const KEEPING_TEXTS: [&str; 3] = ["samples", "grouped_constants", "mass_spring"];

/// All formulations.
pub static FORMULATIONS: Table<BuildFormulation> = Table {
    kind: "formulation",
    entries: &[
        &Entry {
            name: "samples",
            summary: "stress and tangent of the law at every sample of every element: exact for all laws",
            source: "Bonet & Wood 2008, Nonlinear Continuum Mechanics for Finite Element Analysis, §9",
            parameters: &[],
            build: |description, _| Ok(Box::new(SolidForce::of_samples(description)?)),
        },
        &Entry {
            name: "shared_stiffness",
            summary: "one stiffness for all elements of a linear law that have the same shape and material, derived kernels or \
                      samples elsewhere, whichever is faster: exact, and what bodies do where nothing is said",
            source: "Hughes 2000, The Finite Element Method, §3.3",
            parameters: &[],
            build: |description, _| Ok(Box::new(SolidForce::new(description)?)),
        },
        &derived::ENTRY,
        &grouped::ENTRY,
        &tensor_mass::ENTRY,
        &four_loops::ENTRY,
        &corotated::ENTRY,
        &springs::ENTRY,
        &edge_tensors::ENTRY,
        &edge_tensors::HYBRID_ENTRY,
        &gauss_voronoi::ENTRY,
        &crate::particles::ENTRY,
    ],
};

/// Why a body has no such formulation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FormulationError {
    #[error(transparent)]
    Flat(#[from] FlatCell),
    #[error("`{formulation}` knows no {kind}; it takes {accepted}")]
    Element { formulation: &'static str, kind: ElementKind, accepted: &'static str },
    #[error("`{formulation}` cannot take the law `{law}`; it takes {accepted}")]
    Law { formulation: &'static str, law: String, accepted: &'static str },
    #[error("`{formulation}` has no file of `{law}` on {kind} under `{rule}`; it has {accepted}")]
    Underived {
        formulation: &'static str,
        law: String,
        kind: ElementKind,
        rule: &'static str,
        accepted: &'static str,
    },
    #[error("there is no cut `{name}`; it is none, all, or letters of L, G, N, D")]
    Cut { name: String },
    #[error("`{formulation}` is of volumes, and the body has a section")]
    Section { formulation: &'static str },
    #[error("`{formulation}` is of volumes, or of plane bodies that nothing stretches across")]
    PlaneStrain { formulation: &'static str },
    #[error(
        "the neighbours of point {point} do not tell second derivatives: {count} points, as far as three rings around it"
    )]
    Neighbours { point: u32, count: usize },
}

/// Refuses sections, and cells of other kinds.
fn check_cells(
    formulation: &'static str,
    description: &SolidDescription,
    takes: impl Fn(ElementKind) -> bool,
    accepted: &'static str,
) -> Result<(), FormulationError> {
    if description.section != Section::Solid {
        return Err(FormulationError::Section { formulation });
    }
    match description.mesh.cells().find(|cell| !takes(cell.kind)) {
        Some(cell) => Err(FormulationError::Element { formulation, kind: cell.kind, accepted }),
        None => Ok(()),
    }
}

/// A law's name in the table of materials.
fn name_of(law: &MaterialLaw) -> &'static str {
    match law {
        MaterialLaw::Known(law) => law.entry().name,
        MaterialLaw::Text(_) => "hyperelastic",
    }
}

/// The moduli of materials that all have one of `laws`.
fn moduli_of(
    formulation: &'static str,
    materials: &[Material],
    laws: &[AnyLaw],
    accepted: &'static str,
) -> Result<Vec<Lame>, FormulationError> {
    let moduli = |material: &Material| match &material.law {
        MaterialLaw::Known(law) if laws.contains(law) => Ok(material.small_strain),
        law => Err(FormulationError::Law { formulation, law: name_of(law).to_owned(), accepted }),
    };
    materials.iter().map(moduli).collect()
}
