//! Bodies: shape, material, damping, where they start, what holds and loads them.

use souple_formal::Formula;
use souple_math::Vec3;
use souple_models::materials::{self, WrittenLaw};
use souple_models::multiresolution::PLACE_VARIABLES;
use souple_models::solids::{BuildFormulation, BuildSection, FORMULATIONS, Quadrature, SECTIONS, Section};
use souple_table::{Range, Value};

use super::adapt::{ADAPT, AdaptSpec};
use super::bending::{BENDING, BendingSpec};
use super::boundary::{LOAD, Load, PIN, Pin, SPRING, Spring};
use super::frames::{FRAMES, FramesSpec};
use super::incompressible::{INCOMPRESSIBLE, IncompressibleSpec};
use super::inelasticity::{INELASTICITY, InelasticitySpec};
use super::levels::{LEVELS, LevelsSpec};
use super::marks::{MARKS, MarksSpec};
use super::mesh::{MESH, MeshSpec};
use super::modes::{MODES, ModesSpec};
use super::network::Network;
use super::octree::{OCTREE, OctreeSpec};
use super::polynomial::{POLYNOMIAL, PolynomialSpec};
use super::region::{Region, direction};
use super::skin::BODY_SKIN;
use super::split::{SPLIT, SplitSpec};
use super::start::{START, StartSpec};
use super::texture::{TEXTURE, TextureSpec};
use crate::diagnostic::{Code, Site};
use crate::keys::{EntryShape, Key, Keys, NOWHERE, Need, Shape, outlines};
use crate::reader::{Chosen, Reader};

pub(crate) const MATERIAL: EntryShape = EntryShape {
    tag: "name",
    kind: "material",
    outlines: || outlines(&materials::TABLE),
    instead: &[],
    elsewhere: law_as_text,
};

pub(crate) const SECTION: EntryShape = EntryShape {
    tag: "name",
    kind: "section",
    outlines: || outlines(&SECTIONS),
    instead: &[],
    elsewhere: NOWHERE,
};

pub(crate) const FORMULATION: EntryShape = EntryShape {
    tag: "name",
    kind: "formulation",
    outlines: || outlines(&FORMULATIONS),
    instead: &[],
    elsewhere: NOWHERE,
};

pub(crate) static DAMPING: Keys = Keys::new(
    "damping",
    "what takes energy from a body",
    &[
        Key::number("rayleigh_mass", "1/s", Range::NOT_NEGATIVE, "a of the damping force -(a M + b K) v")
            .or(Value::Number(0.0)),
        Key::number("rayleigh_stiffness", "s", Range::NOT_NEGATIVE, "b of the damping force -(a M + b K) v")
            .or(Value::Number(0.0)),
        Key::number("viscosity", "Pa s", Range::NOT_NEGATIVE, "Kelvin–Voigt: stress per rate of strain")
            .or(Value::Number(0.0)),
        Key::number(
            "neighbour_friction",
            "N s/m",
            Range::NOT_NEGATIVE,
            "of each point against those that share a cell with it, by their masses",
        )
        .or(Value::Number(0.0)),
        Key::new(
            "friction_filter",
            Shape::Boolean,
            "drop the friction of a point that it would speed up, or turn back within a step; of explicit steppers",
        )
        .or(Value::Boolean(false)),
    ],
);

pub(crate) static ROTATION: Keys = Keys::new(
    "rotation",
    "a turn about an axis",
    &[
        Key::vector("axis", "", "the turn is counterclockwise seen against it").required(),
        Key::number("angle", "rad", Range::ANY, "such as \"30 deg\"").required(),
        Key::vector("centre", "m", "a point of the axis").or(Value::Vector([0.0; 3])),
    ],
);

pub(crate) static BODY_REGION: Keys = Keys::new(
    "body_region",
    "a part of a body with a material of its own",
    &[
        Key::new("region", Shape::Region, "cells of which all nodes, or the centre, are inside").required(),
        Key::new("material", Shape::Entry(MATERIAL), "the material there").required(),
        Key::new(
            "adapts_to",
            Shape::Entry(MATERIAL),
            "the law that takes over there where the body has `adapt`; its `material` where left out",
        ),
    ],
);

pub(crate) static MATERIAL_FIELD: Keys = Keys::new(
    "material_field",
    "a number of a body's own material that differs from cell to cell, under its name; regions keep theirs",
    &[
        Key::new(
            "value",
            Shape::Formula(&PLACE_VARIABLES),
            "of the middle of each cell at rest, in the unit of the number",
        ),
        Key::new("file", Shape::Text, "a text file with a number for each cell, in the order of the mesh"),
    ],
);

pub(crate) static MATERIAL_AXES: Keys = Keys::new(
    "material_axes",
    "the axes of the law at each place of a body, for laws that know directions: numbers, or formulas of `x`, `y`, `z`",
    &[
        Key::new(
            "x",
            Shape::VectorFormula(&PLACE_VARIABLES),
            "where the law's x points at rest, of any length: the way of fibres [1, 0, 0]",
        )
        .required(),
        Key::new(
            "y",
            Shape::VectorFormula(&PLACE_VARIABLES),
            "on the side of which the law's y lies, across its x; any where left out",
        ),
    ],
);

pub(crate) static BODY: Keys = Keys::new(
    "body",
    "a soft solid",
    &[
        Key { need: Need::Required, ..Key::new("mesh", Shape::Entry(MESH), "its shape at rest") },
        Key::new("split", Shape::Table(&SPLIT), "splits the tetrahedra of `mesh` into smaller ones"),
        Key { need: Need::Required, ..Key::new("material", Shape::Entry(MATERIAL), "its law") },
        Key::new(
            "section",
            Shape::Entry(SECTION),
            "what its cells are sections of, where they are no volumes: a plane body, a membrane, a bar, a cable",
        ),
        Key::new(
            "bending",
            Shape::Table(&BENDING),
            "how it resists bending where it is a membrane of triangles: a thin shell",
        ),
        Key::new(
            "inelasticity",
            Shape::Table(&INELASTICITY),
            "how its rest shape gives way: creep, yielding, fracture",
        ),
        Key::new(
            "incompressible",
            Shape::Table(&INCOMPRESSIBLE),
            "its volume is kept by multipliers, whatever its law",
        ),
        Key::new("frames", Shape::Table(&FRAMES), "a few frames that carry it, in the place of its mesh"),
        Key::new("modes", Shape::Table(&MODES), "its natural modes carry it, in the place of its mesh"),
        Key::new(
            "polynomial",
            Shape::Table(&POLYNOMIAL),
            "one polynomial carries it, in the place of its mesh",
        ),
        Key::new("levels", Shape::Table(&LEVELS), "coarser meshes that are at work where little happens"),
        Key::new(
            "octree",
            Shape::Table(&OCTREE),
            "its points as particles, grouped by eight where little happens",
        ),
        Key::new(
            "material_fields",
            Shape::Named(&MATERIAL_FIELD),
            "numbers of its material that differ from cell to cell, by their names",
        ),
        Key::new("material_axes", Shape::Table(&MATERIAL_AXES), "directions of its law, from place to place"),
        Key::new("regions", Shape::Named(&BODY_REGION), "parts of another material; later ones win"),
        Key::new(
            "mass",
            Shape::Choice(&["lumped", "consistent", "uniform", "voronoi"]),
            "how mass is spread over points",
        )
        .or(Value::Text("lumped")),
        Key::new(
            "quadrature",
            Shape::Choice(&["default", "full"]),
            "samples in an element: the cheapest of full rank, or exact ones for quadratic stress",
        )
        .or(Value::Text("default")),
        super::rules::RULES,
        Key::new(
            "formulation",
            Shape::Entry(FORMULATION),
            "how its forces are evaluated; sample by sample where left out",
        ),
        Key::new(
            "tangent",
            Shape::Choice(&["exact", "difference"]),
            "products with its stiffness in solvers without a matrix: derived, or by differences of forces",
        )
        .or(Value::Text("exact")),
        Key::new("adapt", Shape::Table(&ADAPT), "a second law for the elements that need one while it runs"),
        Key::new("damping", Shape::Table(&DAMPING), "what takes energy from it"),
        Key::number(
            "drag",
            "N s/m",
            Range::NOT_NEGATIVE,
            "of the whole body against a medium at rest, shared by its surface",
        )
        .or(Value::Number(0.0)),
        Key::new("rotate", Shape::Table(&ROTATION), "turns the rest shape, before it is translated"),
        Key::vector("translate", "m", "moves the rest shape").or(Value::Vector([0.0; 3])),
        Key::vector("velocity", "m/s", "at the start").or(Value::Vector([0.0; 3])),
        Key::vector("angular_velocity", "rad/s", "at the start, about the centre of mass")
            .or(Value::Vector([0.0; 3])),
        Key::new(
            "start",
            Shape::Table(&START),
            "how its points stand and move at the start, by where they rest",
        ),
        Key::new("system", Shape::Text, "the system it steps in"),
        Key::new("pins", Shape::Tables(&PIN), "points that are held or led"),
        Key::new("loads", Shape::Tables(&LOAD), "forces on points"),
        Key::new("springs", Shape::Tables(&SPRING), "springs from points to where they start"),
        Key::new("skin", Shape::Table(&BODY_SKIN), "a skin that dresses it, see `skins`"),
        Key::new("texture", Shape::Table(&TEXTURE), "colours of its surface that stick to the matter"),
        Key::new(
            "marks",
            Shape::Table(&MARKS),
            "its surface shows where it was pressed and burnt, and bleeds",
        ),
    ],
);

/// A soft solid as specified.
pub struct Body {
    pub name: String,
    pub mesh: Option<MeshSpec>,
    /// Smaller tetrahedra in the place of those of its mesh.
    pub split: Option<SplitSpec>,
    pub material: Option<Chosen<materials::Build>>,
    /// What its cells are sections of; volumes where left out.
    pub section: Option<Chosen<BuildSection>>,
    /// How it resists bending; as a membrane does, not at all, where left out.
    pub bending: Option<BendingSpec>,
    /// How its rest shape gives way; not at all where left out.
    pub inelasticity: Option<InelasticitySpec>,
    /// How its volume is kept; as its law has it where left out.
    pub incompressible: Option<IncompressibleSpec>,
    /// What carries it; the points of its mesh where left out.
    pub frames: Option<FramesSpec>,
    /// Natural modes that it moves in.
    pub modes: Option<ModesSpec>,
    /// A polynomial that it moves as.
    pub polynomial: Option<PolynomialSpec>,
    /// Coarser meshes of it.
    pub levels: Option<LevelsSpec>,
    /// Its points as particles of several levels.
    pub octree: Option<OctreeSpec>,
    /// Directions of its law; those of the world, or of tissue its own, where left out.
    pub axes: Option<AxesSpec>,
    pub material_fields: Vec<MaterialField>,
    pub regions: Vec<BodyRegion>,
    pub mass: MassKind,
    pub quadrature: Quadrature,
    /// How its forces are evaluated; sample by sample where left out.
    pub formulation: Option<Chosen<BuildFormulation>>,
    pub tangent: TangentKind,
    /// A second law for the elements that need one.
    pub adapt: Option<AdaptSpec>,
    pub damping: Damping,
    /// Of the whole body against a medium at rest [N s/m].
    pub drag: f64,
    pub placement: Placement,
    /// [m/s]
    pub velocity: Vec3,
    /// About the centre of mass [rad/s].
    pub angular_velocity: Vec3,
    pub start: Option<StartSpec>,
    /// Name of its system; the only one, or `main`, where left out.
    pub system: String,
    pub pins: Vec<Pin>,
    pub loads: Vec<Load>,
    pub springs: Vec<Spring>,
    /// What tools leave on its surface.
    pub marks: Option<MarksSpec>,
    pub texture: Option<TextureSpec>,
    /// Masses and links in place of a mesh and its material.
    pub network: Option<Network>,
    pub site: Site,
}

/// Where the axes of a law point.
pub struct AxesSpec {
    /// Of [`PLACE_VARIABLES`].
    pub x: [Formula; 3],
    /// Of the same; `None`: any direction across.
    pub y: Option<[Formula; 3]>,
    pub site: Site,
}

impl AxesSpec {
    fn read(reader: &Reader) -> Option<Self> {
        let y = reader.maybe_vector_formula("y");
        Some(Self { x: reader.maybe_vector_formula("x")?, y, site: reader.site() })
    }
}

/// A number of the body's own material, cell by cell.
pub struct MaterialField {
    /// Of the material.
    pub parameter: String,
    pub values: FieldValues,
    pub site: Site,
}

pub enum FieldValues {
    /// Of the middle of a cell at rest.
    Formula(Formula),
    /// A number for each cell.
    File { name: String, site: Site },
}

impl MaterialField {
    /// `unit` is that of the parameter, where the material has it.
    fn read(parameter: String, unit: Option<&'static str>, reader: &Reader) -> Option<Self> {
        if reader.has("value") == reader.has("file") {
            let message = format!("`{parameter}` is told by a formula or by a file");
            reader.log().add(Code::Conflict, &reader.site(), message, "`value` or `file`");
            return None;
        }
        let file =
            || Some(FieldValues::File { name: reader.maybe_text("file")?, site: reader.site_of("file") });
        let values = match unit {
            Some(unit) => reader.formula_in("value", unit).map(FieldValues::Formula).or_else(file)?,
            None => FieldValues::Formula(Formula::constant(0.0)),
        };
        Some(Self { parameter, values, site: reader.site() })
    }
}

/// A part of another material.
pub struct BodyRegion {
    pub name: String,
    pub region: Option<Region>,
    pub material: Option<Chosen<materials::Build>>,
    pub adapts_to: Option<Chosen<materials::Build>>,
}

/// How mass is spread over points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassKind {
    /// To each point that of the matter around it.
    Lumped,
    /// As the shape functions carry it.
    Consistent,
    /// To all points alike.
    Uniform,
    /// To each point that of all that is nearer to it than to others.
    Voronoi,
}

/// How products with the stiffness are made where no matrix is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentKind {
    Exact,
    Difference,
}

/// What takes energy from a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// [1/s]
    pub rayleigh_mass: f64,
    /// [s]
    pub rayleigh_stiffness: f64,
    /// [Pa s]
    pub viscosity: f64,
    /// Of each point against its neighbours [N s/m].
    pub neighbour_friction: f64,
    /// Whether friction that speeds up or turns back is dropped.
    pub friction_filter: bool,
}

/// Where a rest shape stands: turned by `rotation` about `centre`, then moved.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placement {
    /// Axis times angle [rad].
    pub rotation: Vec3,
    /// [m]
    pub centre: Vec3,
    /// [m]
    pub translation: Vec3,
    /// Of what moves it, or of the body.
    pub site: Site,
}

impl Placement {
    /// Where a point of the file or generator goes [m].
    pub fn place(&self, point: Vec3) -> Vec3 {
        if self.rotation == Vec3::ZERO {
            // exact: no rounding about a centre that does nothing
            return point + self.translation;
        }
        souple_math::exponential(self.rotation) * (point - self.centre) + self.centre + self.translation
    }

    /// Where a point comes from that goes there [m].
    pub fn origin_of(&self, place: Vec3) -> Vec3 {
        let moved = place - self.translation;
        if self.rotation == Vec3::ZERO {
            return moved;
        }
        souple_math::exponential(-self.rotation) * (moved - self.centre) + self.centre
    }

    /// Where a direction goes.
    pub fn turn(&self, direction: Vec3) -> Vec3 {
        if self.rotation == Vec3::ZERO {
            direction
        } else {
            souple_math::exponential(self.rotation) * direction
        }
    }

    pub(crate) fn read(reader: &Reader) -> Self {
        let written = reader.written(&["translate", "rotate"]);
        let site = written.first().map_or_else(|| reader.site(), |key| reader.site_of(key));
        let mut placement = Self { translation: reader.vector("translate"), site, ..Self::default() };
        if let Some(rotation) = reader.table("rotate")
            && let Some(axis) = direction(&rotation, "axis")
        {
            placement.rotation = axis * rotation.number("angle");
            placement.centre = rotation.vector("centre");
        }
        placement
    }
}

impl Body {
    pub(crate) fn read(name: String, reader: &Reader) -> Self {
        let damping = reader.table("damping").map_or(Damping::default(), |table| Damping {
            rayleigh_mass: table.number("rayleigh_mass"),
            rayleigh_stiffness: table.number("rayleigh_stiffness"),
            viscosity: table.number("viscosity"),
            neighbour_friction: table.number("neighbour_friction"),
            friction_filter: table.boolean("friction_filter"),
        });
        let region = |(name, part): (String, Reader)| BodyRegion {
            name,
            region: Region::read(&part, "region"),
            material: read_material(&part, "material"),
            adapts_to: part.has("adapts_to").then(|| read_material(&part, "adapts_to")).flatten(),
        };
        let material = read_material(reader, "material");
        // what is no number of the material is told where it is spread over cells
        let unit_of = |parameter: &str| {
            let mut of_material = material.iter().flat_map(|chosen| chosen.entry.parameters);
            of_material.find(|known| known.name == parameter).map(|known| known.unit)
        };
        let material_fields = reader.named("material_fields").into_iter().filter_map(|(name, part)| {
            let unit = unit_of(&name);
            MaterialField::read(name, unit, &part)
        });
        Self {
            name,
            mesh: MeshSpec::read(reader),
            split: reader.table("split").map(|table| SplitSpec::read(&table)),
            material_fields: material_fields.collect(),
            material,
            section: reader.entry("section", &SECTIONS),
            bending: reader.table("bending").map(|table| BendingSpec::read(&table)),
            inelasticity: reader.table("inelasticity").map(|table| InelasticitySpec::read(&table)),
            incompressible: reader.table("incompressible").map(|table| IncompressibleSpec::read(&table)),
            frames: reader.table("frames").map(|table| FramesSpec::read(&table)),
            modes: reader.table("modes").map(|table| ModesSpec::read(&table)),
            polynomial: reader.table("polynomial").map(|table| PolynomialSpec::read(&table)),
            levels: reader.table("levels").map(|table| LevelsSpec::read(&table)),
            octree: reader.table("octree").map(|table| OctreeSpec::read(&table)),
            axes: reader.table("material_axes").and_then(|table| AxesSpec::read(&table)),
            regions: reader.named("regions").into_iter().map(region).collect(),
            // lumped, the mass of frames would swing in motions that move no matter
            mass: match reader.choice("mass") {
                _ if reader.has("frames") && !reader.has("mass") => MassKind::Consistent,
                "consistent" => MassKind::Consistent,
                "uniform" => MassKind::Uniform,
                "voronoi" => MassKind::Voronoi,
                _ => MassKind::Lumped,
            },
            quadrature: super::rules::read(reader),
            formulation: reader.entry("formulation", &FORMULATIONS),
            tangent: if reader.choice("tangent") == "difference" {
                TangentKind::Difference
            } else {
                TangentKind::Exact
            },
            adapt: reader.table("adapt").map(|table| AdaptSpec::read(&table)),
            damping,
            drag: reader.number("drag"),
            placement: Placement::read(reader),
            velocity: reader.vector("velocity"),
            angular_velocity: reader.vector("angular_velocity"),
            start: reader.table("start").map(|table| StartSpec::read(&table)),
            system: reader.text("system"),
            pins: reader.tables("pins").iter().map(Pin::read).collect(),
            loads: reader.tables("loads").iter().map(Load::read).collect(),
            springs: reader.tables("springs").iter().map(Spring::read).collect(),
            marks: reader.table("marks").map(|table| MarksSpec::read(&table)),
            texture: reader.table("texture").and_then(|table| TextureSpec::read(&table)),
            network: None,
            site: reader.site(),
        }
    }
}

impl Body {
    /// What its cells are sections of.
    pub fn section(&self) -> Section {
        self.section.as_ref().map_or(Section::Solid, |chosen| (chosen.entry.build)(&chosen.values))
    }
}

/// Laws that are known by name as texts alone.
fn law_as_text(name: &str) -> Option<String> {
    let law = WrittenLaw::find(name)?;
    Some(format!(
        "`{name}` is a law as text: name = \"hyperelastic\", energy = \"{}\" with the parameters and definitions that `souple \
         describe {name}` prints",
        law.energy
    ))
}

/// The material, built once on trial: a law as text may be wrong where its table is right, and numbers that are each in their
/// range may make no body together.
pub(super) fn read_material(reader: &Reader, key: &str) -> Option<Chosen<materials::Build>> {
    let chosen = reader.entry(key, &materials::TABLE)?;
    let Err(error) = (chosen.entry.build)(&chosen.values) else { return Some(chosen) };
    for error in error.all() {
        let (mut site, mut node) = (chosen.site.clone(), reader.reading(key).map(|reading| reading.node));
        for key in error.path() {
            site.path = format!("{}.{key}", site.path);
            node = node.and_then(|node| node.as_table()?.get(key));
            if let Some(node) = node {
                site.place = node.place;
            }
        }
        let of_part = node.zip(error.span()).and_then(|(node, span)| node.layout.place_of(span));
        site.place = of_part.unwrap_or(site.place);
        reader.log().add(
            Code::BadFormula,
            &site,
            error.to_string(),
            format!("a law that holds, see `souple describe {}`", chosen.entry.name),
        );
    }
    None
}
