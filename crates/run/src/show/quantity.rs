//! Numbers to colour by: a field, its magnitude or one component, brought to the points.

use souple_io::Field;
use souple_io::picture::{ColourMap, ELEMENT_KINDS};
use souple_mesh::ElementKind;
use souple_table::nearest;

use super::{BodyMoment, Moment, ShowError};

/// Names of the components of vectors and of symmetric tensors.
const VECTOR: [&str; 3] = ["x", "y", "z"];
const TENSOR: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// The kind of each cell: what every mesh has, without a field.
const ELEMENT: &str = "element";

/// How a surface looks that whitens and burns.
pub(crate) const TISSUE: &str = "tissue";

/// How thick blood lies on it.
pub(crate) const BLOOD: &str = "blood";

/// The number of a kind among [`ELEMENT_KINDS`], which has one for linear and quadratic elements alike.
pub fn number_of(kind: ElementKind) -> usize {
    let name = kind.corners().name().trim_end_matches(|letter: char| letter.is_ascii_digit());
    ELEMENT_KINDS.iter().position(|known| *known == name).unwrap_or(ELEMENT_KINDS.len() - 1)
}

/// What is shown by colours: `von_mises`, `displacement` (its magnitude), `displacement.y`, `stress.xx`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Quantity<'a> {
    field: &'a str,
    component: Option<&'a str>,
}

impl<'a> Quantity<'a> {
    pub fn parse(name: &'a str) -> Self {
        match name.split_once('.') {
            Some((field, component)) => Self { field, component: Some(component) },
            None => Self { field: name, component: None },
        }
    }

    /// For a legend: `displacement, y`.
    pub fn title(&self) -> String {
        let name = match self.field {
            "von_mises" => "von Mises stress".to_owned(),
            field => field.replace('_', " "),
        };
        match self.component {
            Some(component) => format!("{name}, {component}"),
            // the root of the sum of the squares of its six components
            None if self.field == "stress" => format!("{name}, norm of its components"),
            None => name,
        }
    }

    /// The map whose colours mean what the quantity says; `None` where any will do.
    pub fn own_map(&self) -> Option<ColourMap> {
        match self.field {
            ELEMENT => Some(ColourMap::Elements),
            TISSUE => Some(ColourMap::Tissue),
            "adaptation" => Some(ColourMap::Adaptation),
            _ => None,
        }
    }

    pub fn unit(&self) -> &'static str {
        match self.field {
            "displacement" | BLOOD | super::GAP => "m",
            "velocity" => "m/s",
            "stress" | "von_mises" => "Pa",
            "strain_energy_density" => "J/m³",
            "link_force" => "N",
            "radius" => "m",
            "burn" => "J/m²",
            _ => "",
        }
    }

    /// Whether it is how bodies look, with all that lies on them.
    pub fn is_look(&self) -> bool {
        self.field == TISSUE
    }

    /// Whether a body has what it is of.
    pub fn is_of(&self, body: &BodyMoment) -> bool {
        body.has_field(self.field) || (self.field == ELEMENT && body.mesh.cell_count() > 0)
    }

    /// Whether a skin or a dress has what it is of: its triangles are no elements of a body.
    pub fn is_of_worn(&self, skin: &BodyMoment) -> bool {
        skin.has_field(self.field)
    }

    /// A value for each point of a body; `None` where it has no such field.
    pub fn at_points(&self, body: &BodyMoment) -> Option<Vec<f64>> {
        if let Some(field) = body.point_fields.iter().find(|field| field.name == self.field) {
            return self.scalars(field);
        }
        let cells = self.at_cells(body)?;
        let mut sums = vec![(0.0, 0.0); body.positions.len()];
        for (cell, value) in body.mesh.cells().zip(&cells) {
            for node in cell.nodes {
                let (sum, count) = &mut sums[*node as usize];
                *sum += value;
                *count += 1.0;
            }
        }
        Some(sums.into_iter().map(|(sum, count)| sum / count).collect())
    }

    /// A value for each cell of a body; `None` where it has no such field.
    pub fn at_cells(&self, body: &BodyMoment) -> Option<Vec<f64>> {
        if self.field == ELEMENT {
            return Some(body.mesh.cells().map(|cell| number_of(cell.kind) as f64).collect());
        }
        self.scalars(body.cell_fields.iter().find(|field| field.name == self.field)?)
    }

    /// What rounding makes of zero in a body of a stiffness [Pa]; zero where that is not known of the quantity.
    pub fn noise(&self, body: &BodyMoment, stiffness: f64) -> f64 {
        // positions and gradients of them are rounded: strains by this, of bodies not too far from the origin
        const ROUNDING: f64 = 1e-11;
        let scale = match self.field {
            "stress" | "von_mises" => stiffness,
            // a difference of energies of the size of the stiffness
            "strain_energy_density" => 1e-3 * stiffness,
            "displacement" => body.positions.iter().map(|x| x.length()).fold(0.0, f64::max),
            _ => 0.0,
        };
        // a component is as uncertain as the greatest of them
        let fields = body.point_fields.iter().chain(&body.cell_fields);
        let of_components = fields
            .filter(|field| field.name == self.field && self.component.is_some())
            .flat_map(|field| field.values.iter().filter(|value| value.is_finite()))
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        ROUNDING * scale.max(of_components)
    }

    fn scalars(&self, field: &Field) -> Option<Vec<f64>> {
        let n = field.components;
        let tuples = field.values.chunks_exact(n.max(1));
        match self.component {
            None if n == 1 => Some(field.values.clone()),
            None => Some(tuples.map(|tuple| tuple.iter().map(|c| c * c).sum::<f64>().sqrt()).collect()),
            Some(name) => {
                let names: &[&str] = match n {
                    3 => &VECTOR,
                    6 => &TENSOR,
                    _ => return None,
                };
                let component = names.iter().position(|known| *known == name)?;
                Some(tuples.map(|tuple| tuple[component]).collect())
            }
        }
    }

    /// Refuses a quantity that no body has.
    pub fn check(&self, moment: &Moment) -> Result<(), ShowError> {
        if moment.bodies.iter().any(|body| self.at_points(body).is_some()) {
            return Ok(());
        }
        let mut known: Vec<String> = Vec::new();
        for field in moment.bodies.iter().flat_map(|body| body.point_fields.iter().chain(&body.cell_fields)) {
            let name = match field.components {
                3 => format!("{} (.x, .y, .z)", field.name),
                6 => format!("{} (.xx, .yy, …)", field.name),
                _ => field.name.clone(),
            };
            if !known.contains(&name) {
                known.push(name);
            }
        }
        let name = match self.component {
            Some(component) => format!("{}.{component}", self.field),
            None => self.field.to_owned(),
        };
        let expected = if known.is_empty() {
            "element or none: no body has fields".to_owned()
        } else {
            let fields =
                moment.bodies.iter().flat_map(|body| body.point_fields.iter().chain(&body.cell_fields));
            let near = nearest(self.field, fields.map(|field| field.name.as_str()));
            let meant = near.map_or_else(String::new, |near| format!("`{near}`, which is near to that, or "));
            format!("{meant}one of {}, element, none", known.join(", "))
        };
        Err(ShowError::UnknownField { name, expected })
    }
}
