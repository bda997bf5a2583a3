//! Laws on elements that are derived by machine and compiled with the program: [`crate::solids::derived`].

use souple_mesh::{ElementKind, QuadratureRule};
use souple_table::Entry;

use super::{BuildFormulation, FormulationError, name_of};
use crate::derive::MapKind;
use crate::materials::MaterialLaw;
use crate::solids::derived::{Wanted, kernel, least_blocks, map_of};
use crate::solids::elements::Sorting;
use crate::solids::kernel::Kernel;
use crate::solids::layout::Alike;
use crate::solids::{ByLaw, Kernels, Section, Shapes, SolidDescription, SolidForce};

const NAME: &str = "derived";
const ACCEPTED: &str = "linear, st_venant_kirchhoff and stable_neo_hookean on tri3 (in plane strain), hex8, prism6 and pyramid5, the first \
                        two on tet4 as well, each under its usual rule";

pub(super) const ENTRY: Entry<BuildFormulation> = Entry {
    name: NAME,
    summary: "kernels derived for each pair of law and element and compiled with the program: linear, \
              st_venant_kirchhoff and stable_neo_hookean on first-order elements",
    source: "Faure 2014, Modélisation de systèmes complexes par approche formelle, ch. 3",
    parameters: &[],
    build: |description, _| {
        if !matches!(description.section, Section::Solid | Section::PlaneStrain { .. }) {
            return Err(FormulationError::PlaneStrain { formulation: NAME });
        }
        let sorting = ByPair::new(description)?;
        Ok(Box::new(SolidForce::sorted_by(description, &sorting)?))
    },
};

/// Cells by law and map.
struct ByPair<'a> {
    by_law: ByLaw<'a>,
    classes: Vec<(&'a MaterialLaw, MapKind)>,
    of_cell: Vec<usize>,
}

impl<'a> ByPair<'a> {
    fn new(description: &SolidDescription<'a>) -> Result<Self, FormulationError> {
        let SolidDescription { mesh, materials, material_of_cell, quadrature, .. } = description;
        let mut sorting = Self {
            by_law: ByLaw::new(description, &Shapes::default(), Kernels::Samples)?,
            classes: Vec::new(),
            of_cell: Vec::with_capacity(mesh.cell_count()),
        };
        for (cell, material) in mesh.cells().zip(*material_of_cell) {
            let class = (&materials[usize::from(*material)].law, map_of(mesh, &cell));
            let known = sorting.classes.iter().position(|known| *known == class);
            let place = known.unwrap_or(sorting.classes.len());
            if known.is_none() {
                sorting.classes.push(class);
            }
            sorting.of_cell.push(place);
            let rule = quadrature.rule(cell.kind);
            if sorting.derived(cell.kind, rule, &class).is_none() {
                return Err(FormulationError::Underived {
                    formulation: NAME,
                    law: name_of(class.0).to_owned(),
                    kind: cell.kind,
                    rule: rule.name,
                    accepted: ACCEPTED,
                });
            }
        }
        Ok(sorting)
    }

    fn derived(
        &self,
        kind: ElementKind,
        rule: &QuadratureRule,
        (law, map): &(&MaterialLaw, MapKind),
    ) -> Option<Box<dyn Kernel>> {
        kernel(law, (kind, *map), rule, Wanted::Any, || self.by_law.of_samples(kind, rule, law))
    }
}

impl<'a> Sorting for ByPair<'a> {
    type Law = (&'a MaterialLaw, MapKind);
    type Kernel = Box<dyn Kernel>;

    fn law_of(&self, cell: usize) -> &Self::Law {
        &self.classes[self.of_cell[cell]]
    }

    fn parameters_of(&self, cell: usize) -> &[f64] {
        self.by_law.parameters_of(cell)
    }

    fn kernel(&self, kind: ElementKind, rule: &QuadratureRule, class: &Self::Law) -> Box<dyn Kernel> {
        let derived = self.derived(kind, rule, class);
        derived.unwrap_or_else(|| unreachable!("found when cells were sorted"))
    }

    fn alike(&self, (_, map): &Self::Law) -> Alike {
        Alike { least_blocks: least_blocks(*map), ..Alike::IN_KIND }
    }

    fn blocks_at_once(&self, kernel: &Box<dyn Kernel>) -> usize {
        kernel.blocks_at_once()
    }
}
