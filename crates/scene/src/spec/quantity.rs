//! What can be measured: the table of quantities.
//!
//! Adding one is an entry of [`QUANTITIES`] and a line where its [`Subject`] is measured (`crate::measure`).

use souple_table::{Entry, Table};

/// What a quantity is: its unit, whether it is a vector, how the values of a region become one, what it is of.
#[derive(Clone, Copy, Debug)]
pub struct Quantity {
    /// SI unit of its values.
    pub unit: &'static str,
    pub rank: Rank,
    /// How the values of a region become one unless the probe says otherwise.
    pub reduction: Reduction,
    pub subject: Subject,
}

/// An entry of [`QUANTITIES`].
pub type QuantityEntry = Entry<Quantity>;

/// Whether a value is one number or three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
    Number,
    Vector,
}

/// How many values become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reduction {
    /// Arithmetic over points, by volume over cells.
    Mean,
    Sum,
    Min,
    Max,
    /// As the mean, of values without their signs.
    MeanMagnitude,
}

/// What a quantity is measured on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A value at every point of a region.
    Points(PointQuantity),
    /// A value in every cell of a region.
    Cells(CellQuantity),
    /// One value of the matter of a region.
    Body(BodyQuantity),
    /// One value of a body's region, or of the world where no body is named.
    BodyOrWorld(Momentum),
    World(WorldQuantity),
    Skin(SkinQuantity),
    /// One value of a body with levels, or of one of its levels.
    Levels(LevelsQuantity),
    Hand(HandQuantity),
    /// What a bone does to the frames of a body that follow it.
    Bone(BoneQuantity),
    /// One value of the masses of a region, which count as near when they are within a distance that the probe tells.
    Masses(MassesQuantity),
    /// One value of a contour of a network.
    Contour(ContourQuantity),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContourQuantity {
    Length,
    Area,
    Lines,
    Apart,
    Roundness,
    Turn,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MassesQuantity {
    Parts,
    Neighbours,
    Spacing,
    Kept,
    Relief,
    Gap,
    Pairs,
    Interactions,
    Temperature,
    Bonds,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoneQuantity {
    Force,
    Torque,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HandQuantity {
    Position,
    Force,
    Energy,
    Jump,
    Age,
    ToolPosition,
    ToolForce,
    ToolPenetration,
    ToolJump,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LevelsQuantity {
    Active,
    Ghosts,
    Jump,
    Cells,
    Evaluations,
    Peak,
    Toggling,
    Grading,
    FewestNeighbours,
    MostNeighbours,
    UnlistedNeighbours,
    Nearness,
    Variation,
    RadiusRatio,
    Distance,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SkinQuantity {
    Area,
    Volume,
    Curvature,
    Euler,
    Components,
    Events,
    Speed,
    Roundness,
    Distance,
    Blocks,
    Work,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointQuantity {
    Displacement,
    Position,
    Velocity,
    Reaction,
    Torque,
    ConstraintForce,
    ContactForce,
    NormalForce,
    FrictionForce,
    ContactTorque,
    Penetration,
    ContactResidual,
    Slip,
    Torn,
    Whitening,
    Burn,
    Blood,
    BloodVolume,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellQuantity {
    VonMises,
    Pressure,
    MaxPrincipalStress,
    MinPrincipalStress,
    MaxPrincipalStretch,
    MinPrincipalStretch,
    StrainEnergy,
    StrainEnergyDensity,
    Volume,
    VolumeRatio,
    Law,
    Excess,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyQuantity {
    Mass,
    CentreOfMass,
    KineticEnergy,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Momentum {
    Linear,
    Angular,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WorldQuantity {
    TotalEnergy,
    ControlEnergy,
    EnergyBalance,
    KineticEnergy,
    StoredEnergy,
    DissipatedEnergy,
    Time,
}

impl Quantity {
    const fn of(unit: &'static str, rank: Rank, reduction: Reduction, subject: Subject) -> Self {
        Self { unit, rank, reduction, subject }
    }

    /// Whether it is a moment, taken about a place.
    pub fn is_moment(&self) -> bool {
        matches!(
            self.subject,
            Subject::Points(PointQuantity::Torque | PointQuantity::ContactTorque)
                | Subject::BodyOrWorld(Momentum::Angular)
                | Subject::Bone(BoneQuantity::Torque)
        )
    }

    /// Whether it is told of a place that may be chosen.
    pub fn has_place(&self) -> bool {
        self.is_moment() || matches!(self.subject, Subject::Levels(LevelsQuantity::Nearness))
    }

    /// Whether it counts masses as neighbours that are within a distance.
    pub fn is_of_neighbours(&self) -> bool {
        matches!(
            self.subject,
            Subject::Masses(
                MassesQuantity::Parts
                    | MassesQuantity::Neighbours
                    | MassesQuantity::Spacing
                    | MassesQuantity::Kept
                    | MassesQuantity::Relief
            )
        )
    }

    /// Whether it is of octrees whose particles see finer and coarser ones.
    pub fn is_of_particles(&self) -> bool {
        use LevelsQuantity::{FewestNeighbours, MostNeighbours, UnlistedNeighbours};
        matches!(self.subject, Subject::Levels(FewestNeighbours | MostNeighbours | UnlistedNeighbours))
    }

    /// Whether it is of active points of a body with levels, which may be those in a region.
    pub fn is_of_active_points(&self) -> bool {
        matches!(self.subject, Subject::Levels(LevelsQuantity::Active | LevelsQuantity::Variation))
    }

    /// Whether it is of the meshes of a body with levels, as they rest.
    pub fn is_of_meshes(&self) -> bool {
        matches!(self.subject, Subject::Levels(LevelsQuantity::RadiusRatio | LevelsQuantity::Distance))
    }

    /// Whether it is of bodies whose elements change their law.
    pub fn is_of_adaptation(&self) -> bool {
        matches!(self.subject, Subject::Cells(CellQuantity::Law | CellQuantity::Excess))
    }

    /// Whether it is of the marks on a surface.
    pub fn is_of_marks(&self) -> bool {
        matches!(self.subject, Subject::Points(PointQuantity::Whitening | PointQuantity::Burn))
            || self.is_of_blood()
    }

    /// Whether it is of the blood on a surface.
    pub fn is_of_blood(&self) -> bool {
        matches!(self.subject, Subject::Points(PointQuantity::Blood | PointQuantity::BloodVolume))
    }

    /// Whether it is of contacts, of which a probe may choose one.
    pub fn is_of_contact(&self) -> bool {
        matches!(
            self.subject,
            Subject::Points(
                PointQuantity::ContactForce
                    | PointQuantity::NormalForce
                    | PointQuantity::FrictionForce
                    | PointQuantity::ContactTorque
                    | PointQuantity::Penetration
                    | PointQuantity::ContactResidual
            )
        )
    }
}

const KINEMATICS: &str = "kinematics of points";
const ATTACHMENT: &str = "own";
const CONTACT: &str = "Wriggers 2006, §5";
const COMPLEMENTARITY: &str = "Moreau 1988; Stewart & Trinkle 1996";
const MARKS: &str = "Debunne 2000, 5 §5.1";
const STRESS: &str = "Bonet & Wood 2008, §5";
const SKIN: &str = "Desbrun & Cani-Gascuel 1998, Active implicit surface for animation";
const ADAPTATION: &str = "Faure 2014, §6.4";
const LEVELS: &str = "Debunne 2000, 5 §2.3";
const SHAPES: &str = "Debunne 2000, 5 §2.1";
const HAPTICS: &str = "Debunne 2000, 6 §3; Colgate, Stanley & Brown 1995";
const OUTLINE: &str = "Jimenez 1993, P2-III.2.3";
const HEAT: &str = "Jimenez 1993, P1-II.4.2, after Terzopoulos, Platt & Fleischer 1989";
const MULTITUDE: &str = "Jimenez 1993, P2-III.2";
const MECHANICS: &str = "balance of momentum";

const fn entry(
    name: &'static str,
    summary: &'static str,
    source: &'static str,
    build: Quantity,
) -> QuantityEntry {
    QuantityEntry { name, summary, source, parameters: &[], build }
}

const fn points(unit: &'static str, rank: Rank, reduction: Reduction, quantity: PointQuantity) -> Quantity {
    Quantity::of(unit, rank, reduction, Subject::Points(quantity))
}

const fn cells(unit: &'static str, reduction: Reduction, quantity: CellQuantity) -> Quantity {
    Quantity::of(unit, Rank::Number, reduction, Subject::Cells(quantity))
}

const fn skin(unit: &'static str, quantity: SkinQuantity) -> Quantity {
    Quantity::of(unit, Rank::Number, Reduction::Sum, Subject::Skin(quantity))
}

const fn levels(unit: &'static str, quantity: LevelsQuantity) -> Quantity {
    Quantity::of(unit, Rank::Number, Reduction::Sum, Subject::Levels(quantity))
}

const fn hand(unit: &'static str, rank: Rank, quantity: HandQuantity) -> Quantity {
    Quantity::of(unit, rank, Reduction::Sum, Subject::Hand(quantity))
}

const fn bone(unit: &'static str, quantity: BoneQuantity) -> Quantity {
    Quantity::of(unit, Rank::Vector, Reduction::Sum, Subject::Bone(quantity))
}

const fn masses(unit: &'static str, quantity: MassesQuantity) -> Quantity {
    Quantity::of(unit, Rank::Number, Reduction::Sum, Subject::Masses(quantity))
}

const fn contour(unit: &'static str, quantity: ContourQuantity) -> Quantity {
    Quantity::of(unit, Rank::Number, Reduction::Sum, Subject::Contour(quantity))
}

const fn world(unit: &'static str, quantity: WorldQuantity) -> Quantity {
    Quantity::of(unit, Rank::Number, Reduction::Sum, Subject::World(quantity))
}

use Rank::{Number, Vector};
use Reduction::{Max, Mean, Min, Sum};

const ENTRIES: &[&QuantityEntry] = &[
    &entry(
        "displacement",
        "from where the points rest",
        KINEMATICS,
        points("m", Vector, Mean, PointQuantity::Displacement),
    ),
    &entry(
        "position",
        "where the points are",
        KINEMATICS,
        points("m", Vector, Mean, PointQuantity::Position),
    ),
    &entry("velocity", "of the points", KINEMATICS, points("m/s", Vector, Mean, PointQuantity::Velocity)),
    &entry(
        "reaction",
        "force of pins on the body, along the directions they hold: mass times prescribed acceleration, less all other forces",
        MECHANICS,
        points("N", Vector, Sum, PointQuantity::Reaction),
    ),
    &entry(
        "torque",
        "moment of the reactions on the body, about the key `about` or its centre of mass",
        MECHANICS,
        points("N m", Vector, Sum, PointQuantity::Torque),
    ),
    &entry(
        "constraint_force",
        "force of the constraints of networks on their masses, but of those with a sense, which are contacts",
        MECHANICS,
        points("N", Vector, Sum, PointQuantity::ConstraintForce),
    ),
    &entry(
        "bone.force",
        "force of a bone on what of the body follows it, frames and pinned points: mass times acceleration, less all other forces on that",
        MECHANICS,
        bone("N", BoneQuantity::Force),
    ),
    &entry(
        "bone.torque",
        "torque of a bone on these, about the key `about` or the origin, which stays where it is",
        MECHANICS,
        bone("N m", BoneQuantity::Torque),
    ),
    &entry(
        "contact_force",
        "force of contacts on the points",
        CONTACT,
        points("N", Vector, Sum, PointQuantity::ContactForce),
    ),
    &entry(
        "contact_force.normal",
        "the part of the contact force along the normal: pressure, damping",
        CONTACT,
        points("N", Vector, Sum, PointQuantity::NormalForce),
    ),
    &entry(
        "contact_force.tangential",
        "the part of the contact force along the surface: friction",
        CONTACT,
        points("N", Vector, Sum, PointQuantity::FrictionForce),
    ),
    &entry(
        "contact_torque",
        "moment of the contact forces on the body, about the key `about` or its centre of mass",
        CONTACT,
        points("N m", Vector, Sum, PointQuantity::ContactTorque),
    ),
    &entry(
        "penetration",
        "how deep points are in what they touch, thickness included; zero where they do not",
        CONTACT,
        points("m", Number, Max, PointQuantity::Penetration),
    ),
    &entry(
        "contact_residual",
        "how far contacts whose forces are solved for are from complementarity: how deep they are, or how far what presses is apart",
        COMPLEMENTARITY,
        points("m", Number, Max, PointQuantity::ContactResidual),
    ),
    &entry(
        "whitening",
        "how white the surface of a body with `marks` is, from 0 to 1",
        MARKS,
        points("", Number, Mean, PointQuantity::Whitening),
    ),
    &entry(
        "burn",
        "heat per area that the surface of a body with `marks` has taken up from what burnt it",
        MARKS,
        points("J/m^2", Number, Mean, PointQuantity::Burn),
    ),
    &entry(
        "blood",
        "how thick blood lies on the surface of a body whose `marks` bleed, by volume for each area at rest",
        MARKS,
        points("m", Number, Mean, PointQuantity::Blood),
    ),
    &entry(
        "blood_volume",
        "the blood on the surface of a body whose `marks` bleed",
        MARKS,
        points("m^3", Number, Sum, PointQuantity::BloodVolume),
    ),
    &entry(
        "slip",
        "how far attached points are from where their springs would have them; zero of points that are torn off or not attached",
        ATTACHMENT,
        points("m", Number, Max, PointQuantity::Slip),
    ),
    &entry(
        "torn",
        "springs of attached points that have torn",
        ATTACHMENT,
        points("", Number, Sum, PointQuantity::Torn),
    ),
    &entry(
        "von_mises",
        "√(3/2 s:s) of the deviator of the Cauchy stress",
        STRESS,
        cells("Pa", Max, CellQuantity::VonMises),
    ),
    &entry(
        "pressure",
        "minus a third of the trace of the Cauchy stress: positive under compression",
        STRESS,
        cells("Pa", Mean, CellQuantity::Pressure),
    ),
    &entry(
        "max_principal_stress",
        "the greatest principal Cauchy stress, tension positive",
        STRESS,
        cells("Pa", Max, CellQuantity::MaxPrincipalStress),
    ),
    &entry(
        "min_principal_stress",
        "the least principal Cauchy stress, compression negative",
        STRESS,
        cells("Pa", Min, CellQuantity::MinPrincipalStress),
    ),
    &entry(
        "max_principal_stretch",
        "the greatest principal stretch: length over rest length",
        STRESS,
        cells("", Max, CellQuantity::MaxPrincipalStretch),
    ),
    &entry(
        "min_principal_stretch",
        "the least principal stretch: length over rest length",
        STRESS,
        cells("", Min, CellQuantity::MinPrincipalStretch),
    ),
    &entry("strain_energy", "stored by the material", STRESS, cells("J", Sum, CellQuantity::StrainEnergy)),
    &entry(
        "strain_energy_density",
        "stored by the material, per rest volume",
        STRESS,
        cells("J/m^3", Max, CellQuantity::StrainEnergyDensity),
    ),
    &entry("volume", "as it stands", KINEMATICS, cells("m^3", Sum, CellQuantity::Volume)),
    &entry(
        "volume_ratio",
        "volume over rest volume of each cell",
        KINEMATICS,
        cells("", Mean, CellQuantity::VolumeRatio),
    ),
    &entry(
        "law",
        "of each cell of a body that adapts: 0 for the first, 1 for the second",
        ADAPTATION,
        cells("", Mean, CellQuantity::Law),
    ),
    &entry(
        "excess",
        "of each cell of a body that adapts: its greatest criterion over the threshold",
        ADAPTATION,
        cells("", Max, CellQuantity::Excess),
    ),
    &entry(
        "mass",
        "of the points",
        MECHANICS,
        Quantity::of("kg", Number, Sum, Subject::Body(BodyQuantity::Mass)),
    ),
    &entry(
        "centre_of_mass",
        "of the points",
        MECHANICS,
        Quantity::of("m", Vector, Mean, Subject::Body(BodyQuantity::CentreOfMass)),
    ),
    &entry(
        "kinetic_energy",
        "of the points",
        MECHANICS,
        Quantity::of("J", Number, Sum, Subject::Body(BodyQuantity::KineticEnergy)),
    ),
    &entry(
        "momentum",
        "of the body, or of the world where no body is named",
        MECHANICS,
        Quantity::of("kg m/s", Vector, Sum, Subject::BodyOrWorld(Momentum::Linear)),
    ),
    &entry(
        "angular_momentum",
        "of the body about its centre of mass, or of the world about the origin, or about the key `about`",
        MECHANICS,
        Quantity::of("kg m^2/s", Vector, Sum, Subject::BodyOrWorld(Momentum::Angular)),
    ),
    &entry(
        "energy.total",
        "kinetic and stored, of the world",
        MECHANICS,
        world("J", WorldQuantity::TotalEnergy),
    ),
    &entry("energy.kinetic", "of the world", MECHANICS, world("J", WorldQuantity::KineticEnergy)),
    &entry("energy.stored", "by all forces of the world", MECHANICS, world("J", WorldQuantity::StoredEnergy)),
    &entry(
        "energy.dissipated",
        "since the start, by the forces that keep account of it",
        MECHANICS,
        world("J", WorldQuantity::DissipatedEnergy),
    ),
    &entry(
        "energy.balance",
        "kinetic, stored and dissipated: it stays as it was where forces keep account of what they take and nothing works from outside",
        MECHANICS,
        world("J", WorldQuantity::EnergyBalance),
    ),
    &entry(
        "energy.controls",
        "that controls have made since the start by what they changed: stiffnesses, links made and broken",
        MECHANICS,
        world("J", WorldQuantity::ControlEnergy),
    ),
    &entry("time", "simulated", KINEMATICS, world("s", WorldQuantity::Time)),
    &entry("skin.area", "of its triangles", SKIN, skin("m^2", SkinQuantity::Area)),
    &entry("skin.volume", "enclosed by its triangles", SKIN, skin("m^3", SkinQuantity::Volume)),
    &entry(
        "skin.curvature",
        "kappa = div n, twice the mean curvature, over the surface",
        SKIN,
        skin("1/m", SkinQuantity::Curvature),
    ),
    &entry(
        "skin.euler",
        "V - E + F of its triangles: 2 for each ball, 0 for a ring, 2 - 2g at g holes",
        SKIN,
        skin("", SkinQuantity::Euler),
    ),
    &entry("skin.components", "parts that share no point", SKIN, skin("", SkinQuantity::Components)),
    &entry(
        "skin.events",
        "times that the Euler characteristic or the number of parts changed, and stayed so for two steps or was never as before for eight",
        SKIN,
        skin("", SkinQuantity::Events),
    ),
    &entry("skin.speed", "the greatest at the surface", SKIN, skin("m/s", SkinQuantity::Speed)),
    &entry(
        "skin.roundness",
        "area of a ball of the skin's volume over that of the skin: 1 for a ball, less for all else",
        SKIN,
        skin("", SkinQuantity::Roundness),
    ),
    &entry(
        "skin.distance",
        "Hausdorff's, between its surface and that of its target, to first order in the potential",
        SKIN,
        skin("m", SkinQuantity::Distance),
    ),
    &entry(
        "masses.parts",
        "parts that masses hang together in, each nearer to another than the key `within`",
        MULTITUDE,
        masses("", MassesQuantity::Parts),
    ),
    &entry(
        "masses.neighbours",
        "how many others a mass has nearer than the key `within`, on average",
        MULTITUDE,
        masses("", MassesQuantity::Neighbours),
    ),
    &entry(
        "masses.spacing",
        "mean distance of masses nearer than the key `within`; that itself where none are",
        MULTITUDE,
        masses("m", MassesQuantity::Spacing),
    ),
    &entry(
        "masses.kept",
        "share of the neighbours that masses had as the scene gives them, nearer than the key `within`, which are neighbours still",
        MULTITUDE,
        masses("", MassesQuantity::Kept),
    ),
    &entry(
        "masses.relief",
        "root of the mean square of the heights of the topmost masses, against gravity, in columns as wide as the key `within`, about their mean",
        MULTITUDE,
        masses("m", MassesQuantity::Relief),
    ),
    &entry(
        "masses.gap",
        "from the surface of the shape that masses fill, where it is farthest from them, to the nearest of them, less its radius",
        MULTITUDE,
        masses("m", MassesQuantity::Gap),
    ),
    &entry(
        "masses.pairs",
        "pairs of masses that crowds have within their ranges: what a step costs",
        MULTITUDE,
        masses("", MassesQuantity::Pairs),
    ),
    &entry(
        "masses.interactions",
        "pairs of masses that crowds act between, however far apart they are: what a step would cost without a search",
        MULTITUDE,
        masses("", MassesQuantity::Interactions),
    ),
    &entry(
        "masses.temperature",
        "mean temperature of masses of a fusible crowd [K]",
        HEAT,
        masses("", MassesQuantity::Temperature),
    ),
    &entry(
        "masses.bonds",
        "bonds between masses of fusible crowds that have not melted",
        HEAT,
        masses("", MassesQuantity::Bonds),
    ),
    &entry(
        "contour.length",
        "of all lines of the contour that the key `contour` names",
        OUTLINE,
        contour("m", ContourQuantity::Length),
    ),
    &entry(
        "contour.area",
        "what the contour encloses, less its holes",
        OUTLINE,
        contour("m^2", ContourQuantity::Area),
    ),
    &entry("contour.lines", "closed lines of the contour", OUTLINE, contour("", ContourQuantity::Lines)),
    &entry(
        "contour.apart",
        "how far the contour is from the one that the key `from` names, at most",
        OUTLINE,
        contour("m", ContourQuantity::Apart),
    ),
    &entry(
        "contour.roundness",
        "4 pi A/L^2 of its area and length: 1 for a circle, 1/n for n equal ones, less for all else",
        OUTLINE,
        contour("", ContourQuantity::Roundness),
    ),
    &entry(
        "contour.turn",
        "by how much the masses of the contour have turned as a whole since their rest, from the first of the axes in its plane towards the second, between -pi and pi [rad]",
        OUTLINE,
        contour("rad", ContourQuantity::Turn),
    ),
    &entry(
        "levels.active",
        "points that move by themselves, of all levels or of the key `level`, in the region where there is one",
        LEVELS,
        levels("", LevelsQuantity::Active),
    ),
    &entry(
        "levels.variation",
        "the greatest variation around an active point, as it is compared with `refine` and `coarsen`, of all levels or of the key `level`",
        LEVELS,
        levels("", LevelsQuantity::Variation),
    ),
    &entry(
        "levels.ghosts",
        "points that follow because active ones see them, of all levels or of the key `level`",
        LEVELS,
        levels("", LevelsQuantity::Ghosts),
    ),
    &entry(
        "levels.jump",
        "the most that a node of its `dress` has jumped from one period to the next so far, because levels changed",
        LEVELS,
        levels("m", LevelsQuantity::Jump),
    ),
    &entry(
        "levels.cells",
        "tetrahedra, or particles, of all levels or of the key `level`, whether at work or not",
        LEVELS,
        levels("", LevelsQuantity::Cells),
    ),
    &entry(
        "levels.radius_ratio",
        "three times the inscribed over the circumscribed radius of a tetrahedron at rest, the least, of all levels or of the key `level`: 1 of a regular one, 0 of a flat one",
        SHAPES,
        levels("", LevelsQuantity::RadiusRatio),
    ),
    &entry(
        "levels.distance",
        "how far the surface of a level at rest, of the key `level` or of any, and that of the body's own mesh are from each other, from points of either: the most",
        SHAPES,
        levels("m", LevelsQuantity::Distance),
    ),
    &entry(
        "levels.evaluations",
        "forces of tetrahedra, or of particles with their neighbours, that a step evaluates",
        LEVELS,
        levels("", LevelsQuantity::Evaluations),
    ),
    &entry(
        "levels.peak",
        "forces evaluated in the busiest tick of a step over those of a tick in the mean",
        LEVELS,
        levels("", LevelsQuantity::Peak),
    ),
    &entry(
        "levels.toggling",
        "one over the shortest time from when a point was refined to when it was coarsened, or the other way about, so far; 0 where none was",
        LEVELS,
        levels("Hz", LevelsQuantity::Toggling),
    ),
    &entry(
        "levels.grading",
        "levels by which cells that share a corner, or particles side by side, differ at most",
        LEVELS,
        levels("", LevelsQuantity::Grading),
    ),
    &entry(
        "levels.fewest_neighbours",
        "active neighbours of an active particle of an octree, the fewest; of those with 26 others of their level around them",
        LEVELS,
        levels("", LevelsQuantity::FewestNeighbours),
    ),
    &entry(
        "levels.most_neighbours",
        "the same, the most",
        LEVELS,
        levels("", LevelsQuantity::MostNeighbours),
    ),
    &entry(
        "levels.unlisted_neighbours",
        "pairs of active particles of an octree that lie side by side and do not know each other, counted from both sides: none",
        LEVELS,
        levels("", LevelsQuantity::UnlistedNeighbours),
    ),
    &entry(
        "levels.nearness",
        "rank correlation (Spearman) of the level at work at each point with its distance at rest from `about`; below zero where it is finer the nearer",
        LEVELS,
        levels("", LevelsQuantity::Nearness),
    ),
    &entry(
        "hand.position",
        "of the device, from where it started",
        HAPTICS,
        hand("m", Vector, HandQuantity::Position),
    ),
    &entry("hand.force", "of the device on the person", HAPTICS, hand("N", Vector, HandQuantity::Force)),
    &entry(
        "hand.energy",
        "that the person has put into the device, less what came back: where the device is passive, below zero by the work of a tick at most",
        "Hannaford & Ryu 2002",
        hand("J", Number, HandQuantity::Energy),
    ),
    &entry(
        "hand.jump",
        "the greatest change of the force on the person from one millisecond to the next, so far",
        HAPTICS,
        hand("N", Number, HandQuantity::Jump),
    ),
    &entry(
        "hand.age",
        "how old what the force says of the body is when the next one takes its place, at most so far: time of the world, in an explicit step",
        HAPTICS,
        hand("s", Number, HandQuantity::Age),
    ),
    &entry(
        "tool.position",
        "of the tool of a hand, from where it started",
        HAPTICS,
        hand("m", Vector, HandQuantity::ToolPosition),
    ),
    &entry(
        "tool.force",
        "of the tool of a hand on the body, friction included",
        HAPTICS,
        hand("N", Vector, HandQuantity::ToolForce),
    ),
    &entry(
        "tool.penetration",
        "how deep points of the body are in the tool of a hand",
        HAPTICS,
        hand("m", Number, HandQuantity::ToolPenetration),
    ),
    &entry(
        "tool.jump",
        "greatest change of the force of the tool of a hand from one step to the next within the last period, over the larger of the two; of a tool that holds points",
        HAPTICS,
        hand("", Number, HandQuantity::ToolJump),
    ),
    &entry("skin.blocks", "blocks of 512 nodes that its grid keeps", SKIN, skin("", SkinQuantity::Blocks)),
    &entry(
        "skin.work",
        "nodes of its grid that the last step worked out, in all its sub-steps",
        SKIN,
        skin("", SkinQuantity::Work),
    ),
];

/// All quantities.
pub static QUANTITIES: Table<Quantity> = Table { kind: "quantity", entries: ENTRIES };

/// Their names, for the key that chooses one.
pub(crate) const NAMES: &[&str] = &names();

const fn names() -> [&'static str; ENTRIES.len()] {
    let mut names = [""; ENTRIES.len()];
    let mut index = 0;
    while index < names.len() {
        names[index] = ENTRIES[index].name;
        index += 1;
    }
    names
}
