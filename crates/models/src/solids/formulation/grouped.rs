//! The tensor-mass method as it is derived by machine: energy, forces and differentials of each kind of element and law as
//! expressions of displacements, with everything that depends on rest positions and material grouped into constants that
//! are computed once (Faure 2014). Cells that are boxes along the axes take the shorter map.

mod expressions;

use std::sync::Arc;

use sha2::{Digest, Sha256};
use souple_formal::element::{Cut, ElementData};
use souple_formal::law::{EnergyLaw, LawParameter, LawText};
use souple_mesh::{ElementKind, QuadratureRule};
use souple_table::{Entry, Parameter, Value};

use super::{BuildFormulation, FormulationError, check_cells, name_of};
use crate::derive::{MapKind, element_data};
use crate::materials::kept::key_of;
use crate::materials::{Law, LawVisitor, MaterialLaw, Parameters, TextLaw, WrittenLaw};
use crate::solids::derived::map_of;
use crate::solids::elements::Sorting;
use crate::solids::kernel::Kernel;
use crate::solids::{SolidDescription, SolidForce};
use expressions::Expressions;

const NAME: &str = "grouped_constants";
const ELEMENTS: &str = "volume elements";
const LAWS: &str = "linear, corotational, st_venant_kirchhoff, neo_hookean, stable_neo_hookean, mooney_rivlin, yeoh, and laws as text";

pub(super) const ENTRY: Entry<BuildFormulation> = Entry {
    name: NAME,
    summary: "expressions derived for each kind of element and law, with constants of rest shape and material grouped",
    source: "Faure 2014, Modélisation de systèmes complexes par approche formelle, ch. 3",
    parameters: &[Parameter::text(
        "cut",
        "into which addends expressions are cut: none, all, or letters of L (terms of the law), G (Gauss points), N (nodes), D \
         (dimension)",
    )
    .or(Value::Text("none"))],
    build: |description, values| {
        check_cells(NAME, description, |kind| kind.dimension() == 3, ELEMENTS)?;
        let name = values.text("cut");
        let cut = Cut::from_name(name).ok_or_else(|| FormulationError::Cut { name: name.to_owned() })?;
        let sorting = ByAssociation::new(description, cut)?;
        Ok(Box::new(SolidForce::sorted_by(description, &sorting)?.of_displacements(description.mesh)))
    },
};

/// Associations of law, kind and map, and the constants of every cell.
struct ByAssociation {
    kernels: Vec<Arc<Expressions>>,
    of_cell: Vec<usize>,
    constants: Vec<Vec<f64>>,
}

impl Sorting for ByAssociation {
    type Law = usize;
    type Kernel = Box<dyn Kernel>;

    fn law_of(&self, cell: usize) -> &usize {
        &self.of_cell[cell]
    }

    fn parameters_of(&self, cell: usize) -> &[f64] {
        &self.constants[cell]
    }

    fn kernel(&self, _: ElementKind, _: &QuadratureRule, association: &usize) -> Box<dyn Kernel> {
        Box::new(Arc::clone(&self.kernels[*association]))
    }
}

impl ByAssociation {
    fn new(description: &SolidDescription, cut: Cut) -> Result<Self, FormulationError> {
        let SolidDescription { mesh, materials, material_of_cell, quadrature, .. } = description;
        let mut known: Vec<(&MaterialLaw, ElementKind, MapKind)> = Vec::new();
        let mut sorting = Self {
            kernels: Vec::new(),
            of_cell: Vec::with_capacity(mesh.cell_count()),
            constants: vec![Vec::new(); mesh.cell_count()],
        };
        for (cell, material) in mesh.cells().zip(*material_of_cell) {
            let law = &materials[usize::from(*material)].law;
            let key = (law, cell.kind, map_of(mesh, &cell));
            let found = known.iter().position(|known| *known == key);
            sorting.of_cell.push(found.unwrap_or(known.len()));
            if found.is_none() {
                known.push(key);
                let element = element_data(key.1, quadrature.rule(key.1), key.2).unwrap_or_else(|error| {
                    unreachable!("only elements that can be boxes are found to be some: {error}")
                });
                sorting.kernels.push(Arc::new(expressions(law, &element, cut)?));
            }
        }
        for (association, kernel) in sorting.kernels.iter().enumerate() {
            let cells: Vec<usize> =
                (0..mesh.cell_count()).filter(|cell| sorting.of_cell[*cell] == association).collect();
            let numbers = |cell: usize| kernel.numbers_of(&materials[usize::from(material_of_cell[cell])]);
            kernel.compute_constants(mesh, &cells, &numbers, &mut sorting.constants);
        }
        Ok(sorting)
    }
}

/// What is derived of a law on an element, if it was not kept by an earlier run.
fn expressions(law: &MaterialLaw, element: &ElementData, cut: Cut) -> Result<Expressions, FormulationError> {
    let derive = || {
        let law = energy_law(law)?;
        Ok(Expressions::new(&element.steps(&law, cut), &law, element.node_count))
    };
    let kept = TextLaw::folder().zip(law_text_of(law));
    let Some((folder, text)) = kept else { return derive() };
    // all that it is made of, and what makes it
    let makers = [include_str!("grouped.rs"), include_str!("grouped/expressions.rs")].concat();
    let key = [key_of(&text), format!("{makers}{cut}{element:?}").into_bytes()].concat();
    let key = Sha256::digest(&key).to_vec();
    let found = folder.find_as(&key, |bytes| Expressions::restore(bytes, element.node_count));
    if let Some(found) = found {
        return Ok(found);
    }
    let derived = derive()?;
    folder.keep_as(key, |bytes| derived.store(bytes));
    Ok(derived)
}

/// The text that a law is derived from.
fn law_text_of(law: &MaterialLaw) -> Option<LawText> {
    match law {
        MaterialLaw::Text(text) => Some(text.text().clone()),
        MaterialLaw::Known(known) => WrittenLaw::find(known.entry().name)?.text().ok(),
    }
}

fn refused(law: &MaterialLaw) -> FormulationError {
    FormulationError::Law { formulation: NAME, law: name_of(law).to_owned(), accepted: LAWS }
}

/// The law as expressions, its constants being symbols.
fn energy_law(law: &MaterialLaw) -> Result<EnergyLaw, FormulationError> {
    let MaterialLaw::Known(known) = law else {
        let MaterialLaw::Text(text) = law else { unreachable!("a law is known or text") };
        return text.expressions().cloned().map_err(|_| refused(law));
    };
    let written = WrittenLaw::find(known.entry().name).and_then(|written| written.text().ok());
    let compiled = written.and_then(|text| EnergyLaw::compile(&text).ok()).ok_or_else(|| refused(law))?;
    // the numbers of the table must be those of the text
    let names = known.visit(Names);
    let is_known = |(name, _): &(String, LawParameter)| names.contains(&name.as_str());
    if compiled.parameters.iter().all(is_known) { Ok(compiled) } else { Err(refused(law)) }
}

struct Names;

impl LawVisitor for Names {
    type Output = &'static [&'static str];

    fn visit<L: Law>(self, _: L) -> Self::Output {
        <L::Parameters<f64> as Parameters<f64>>::NAMES
    }
}
