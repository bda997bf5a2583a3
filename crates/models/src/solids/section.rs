//! What cells of fewer than three dimensions are sections of: plane bodies, membranes, bars, cables.
//!
//! Such a cell knows the part of the deformation gradient along itself; the section completes it, and the law stays the
//! one of solids. In plane strain nothing stretches across. Elsewhere the stretch across, `λ`, is what makes the stress
//! across vanish: at each sample `Ψ(F̄) = min_λ Ψ(F̄ + λ M)`, by Newton, with
//!
//! - plane stress: `M = e_z ⊗ e_z`;
//! - membrane: `M = n ⊗ N = cof F̄ / |cof F̄|`, for the cofactor of a gradient of rank two is its area ratio times the
//!   normal now by the normal at rest;
//! - bar: in the frame of the bar, `F̄ = s e_x ⊗ e_x` and `M = e_y ⊗ e_y + e_z ⊗ e_z`: the law's x is along the bar.
//!   A cable is a bar that takes no push.
//!
//! As `∂Ψ/∂λ = 0`, the stress is that of the law at the completed gradient; its differential takes
//! `δλ = -(M:A:δF) / (M:A:M)` with the tangent `A` of the law (static condensation).

use souple_table::{Entry, Parameter, Range, Table, Values};

use super::layout::LANES;
use super::row_law::{Row, RowLaw};

/// What the cells of a body are sections of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Section {
    /// Volume cells: nothing to complete.
    #[default]
    Solid,
    /// A slice of a long body, in a plane of constant z.
    PlaneStrain { thickness: f64 },
    /// A plate free on its faces, in a plane of constant z.
    PlaneStress { thickness: f64 },
    /// A skin without bending stiffness, anywhere in space.
    Membrane { thickness: f64 },
    /// A rod without bending stiffness.
    Bar { area: f64 },
    /// A bar that takes no push.
    Cable { area: f64 },
}

/// Makes a section of completed values.
pub type BuildSection = fn(&Values) -> Section;

const THICKNESS: Parameter = Parameter::number("thickness", "m", Range::POSITIVE, "across, at rest");
const AREA: Parameter = Parameter::number("area", "m²", Range::POSITIVE, "of the cross-section, at rest");

/// All sections but the solid one.
pub static SECTIONS: Table<BuildSection> = Table {
    kind: "section",
    entries: &[
        &Entry {
            name: "plane_strain",
            summary: "slice of a long body: nothing stretches across; in a plane of constant z, held there",
            source: "Bonet & Wood 2008, §6.6",
            parameters: &[THICKNESS],
            build: |values| Section::PlaneStrain { thickness: values.number("thickness") },
        },
        &Entry {
            name: "plane_stress",
            summary: "plate free on its faces: no stress across; in a plane of constant z, held there",
            source: "Bonet & Wood 2008, §6.6.6",
            parameters: &[THICKNESS],
            build: |values| Section::PlaneStress { thickness: values.number("thickness") },
        },
        &Entry {
            name: "membrane",
            summary: "skin, free to move in space, that resists bending only where its body has `bending`; objective isotropic laws",
            source: "Oden & Sato 1967; own condensation",
            parameters: &[THICKNESS],
            build: |values| Section::Membrane { thickness: values.number("thickness") },
        },
        &Entry {
            name: "bar",
            summary: "rod of edges without bending stiffness; the law's x is along the rod",
            source: "Bonet & Wood 2008, §3",
            parameters: &[AREA],
            build: |values| Section::Bar { area: values.number("area") },
        },
        &Entry {
            name: "cable",
            summary: "a bar that takes no push: slack below its rest length",
            source: "own",
            parameters: &[AREA],
            build: |values| Section::Cable { area: values.number("area") },
        },
    ],
};

/// Newton's steps for the stretch across.
const STEPS: usize = 60;
/// Change of the stretch at which it is found: a few units of the last place.
const FOUND: f64 = 4e-16;

impl Section {
    /// Dimension of its cells.
    pub fn dimension(self) -> usize {
        match self {
            Self::Solid => 3,
            Self::PlaneStrain { .. } | Self::PlaneStress { .. } | Self::Membrane { .. } => 2,
            Self::Bar { .. } | Self::Cable { .. } => 1,
        }
    }

    /// What makes a volume of the measure of a cell: 1, a thickness [m], an area [m²].
    pub fn measure(self) -> f64 {
        match self {
            Self::Solid => 1.0,
            Self::PlaneStrain { thickness }
            | Self::PlaneStress { thickness }
            | Self::Membrane { thickness } => thickness,
            Self::Bar { area } | Self::Cable { area } => area,
        }
    }

    /// Whether its cells lie in a plane of constant z.
    pub fn is_plane(self) -> bool {
        matches!(self, Self::PlaneStrain { .. } | Self::PlaneStress { .. })
    }

    /// Whether it evaluates its law in a frame that turns with the cell.
    pub fn follows_rotation(self) -> bool {
        matches!(self, Self::Bar { .. } | Self::Cable { .. })
    }
}

/// A row of samples of a section, completed.
pub struct Completed<'a> {
    section: Section,
    law: &'a dyn RowLaw,
    parameters: &'a [f64],
    /// As the cells have it.
    own: Row,
    /// Complete, of bars in their own frame.
    pub F: Row,
    /// Stretch across.
    stretch: [f64; LANES],
    /// `M`.
    across: Row,
    /// Stretch along a bar.
    along: [f64; LANES],
}

const ZERO: Row = [[0.0; LANES]; 9];

impl<'a> Completed<'a> {
    pub fn new(section: Section, law: &'a dyn RowLaw, parameters: &'a [f64], own: Row) -> Self {
        let mut row = Self {
            section,
            law,
            parameters,
            own,
            F: own,
            stretch: [1.0; LANES],
            across: ZERO,
            along: [1.0; LANES],
        };
        match section {
            Section::Solid => return row,
            Section::PlaneStrain { .. } => {
                row.F[8] = [1.0; LANES];
                return row;
            }
            Section::PlaneStress { .. } => row.across[8] = [1.0; LANES],
            Section::Membrane { .. } => {
                let cofactor = cofactor(&own);
                let size = norm(&cofactor);
                for (entry, of) in row.across.iter_mut().zip(&cofactor) {
                    *entry = std::array::from_fn(|l| over(of[l], size[l]));
                }
            }
            Section::Bar { .. } | Section::Cable { .. } => {
                row.along = norm(&own);
                row.own = ZERO;
                row.own[0] = row.along;
                (row.across[4], row.across[8]) = ([1.0; LANES], [1.0; LANES]);
            }
        }
        row.find_stretch();
        if row.section.follows_rotation() {
            // the entries as they are in space are needed again for directions
            row.own = own;
        }
        row
    }

    /// Newton for `M : P(F̄ + λ M) = 0`, each lane until it is found.
    fn find_stretch(&mut self) {
        let mut is_found = [false; LANES];
        for _ in 0..STEPS {
            self.F = sum(&self.own, &self.across, &self.stretch);
            if is_found == [true; LANES] {
                return;
            }
            let stress = dot(&self.across, &self.law.stress(self.parameters, &self.F));
            let mut rate = [self.across];
            self.law.differential(self.parameters, &self.F, &mut rate);
            let slope = dot(&self.across, &rate[0]);
            for lane in 0..LANES {
                if is_found[lane] {
                    continue;
                }
                let old = self.stretch[lane];
                // where the energy is not convex in λ, downhill; never by more than a factor of two
                let wanted = if slope[lane] > 0.0 {
                    old - stress[lane] / slope[lane]
                } else {
                    old - old * stress[lane].signum()
                };
                let new = if wanted.is_finite() { wanted.clamp(0.5 * old, 2.0 * old) } else { old };
                is_found[lane] = (new - old).abs() <= FOUND * old || !wanted.is_finite();
                self.stretch[lane] = new;
            }
        }
        self.F = sum(&self.own, &self.across, &self.stretch);
    }

    /// Whether a lane is a slack cable.
    pub fn is_slack(&self, lane: usize) -> bool {
        matches!(self.section, Section::Cable { .. }) && self.along[lane] < 1.0
    }

    pub fn energy(&self) -> [f64; LANES] {
        let mut energy = self.law.energy(self.parameters, &self.F);
        for lane in (0..LANES).filter(|lane| self.is_slack(*lane)) {
            energy[lane] = 0.0;
        }
        energy
    }

    /// `∂Ψ/∂F̄`.
    pub fn stress(&self) -> Row {
        let stress = self.law.stress(self.parameters, &self.F);
        if !self.section.follows_rotation() {
            return stress;
        }
        let mut along = stress[0];
        for lane in (0..LANES).filter(|lane| self.is_slack(*lane)) {
            along[lane] = 0.0;
        }
        let direction = self.direction();
        direction.map(|entry| std::array::from_fn(|l| along[l] * entry[l]))
    }

    /// `t ⊗ T` of a bar.
    fn direction(&self) -> Row {
        self.own.map(|entry| std::array::from_fn(|l| over(entry[l], self.along[l])))
    }

    /// The differential of [`Self::stress`] for several `δF̄`, in place.
    pub fn differential(&self, d: &mut [Row]) {
        match self.section {
            Section::Solid | Section::PlaneStrain { .. } => {
                self.law.differential(self.parameters, &self.F, d);
            }
            Section::PlaneStress { .. } | Section::Membrane { .. } => self.condensed(d),
            Section::Bar { .. } | Section::Cable { .. } => self.of_bar(d),
        }
    }

    fn condensed(&self, d: &mut [Row]) {
        let mut by_stretch = [self.across];
        self.law.differential(self.parameters, &self.F, &mut by_stretch);
        let slope = dot(&self.across, &by_stretch[0]);
        if let Section::Membrane { .. } = self.section {
            // δM = (δcof - M (M:δcof)) / |cof|
            let size = norm(&cofactor(&self.own));
            for row in &mut *d {
                let turned = cofactor_differential(&self.own, row);
                let part = dot(&self.across, &turned);
                for e in 0..9 {
                    for l in 0..LANES {
                        let turn = turned[e][l] - self.across[e][l] * part[l];
                        row[e][l] += over(self.stretch[l] * turn, size[l]);
                    }
                }
            }
        }
        self.law.differential(self.parameters, &self.F, d);
        for row in d {
            let against = dot(&self.across, row);
            for e in 0..9 {
                for l in 0..LANES {
                    row[e][l] -= over(by_stretch[0][e][l] * against[l], slope[l]);
                }
            }
        }
    }

    /// `δP = f'' (D:δF) D + f'/s (δF - D (D:δF))` with `D = t ⊗ T`, `f' = P_xx` and
    /// `f'' = A_xx,xx - (A_xx:M)² / (M:A:M)`.
    fn of_bar(&self, d: &mut [Row]) {
        let mut axis = ZERO;
        axis[0] = [1.0; LANES];
        let mut rates = [axis, self.across];
        self.law.differential(self.parameters, &self.F, &mut rates);
        let tension = self.law.stress(self.parameters, &self.F)[0];
        let (coupling, slope) = (dot(&self.across, &rates[0]), dot(&self.across, &rates[1]));
        let direction = self.direction();
        for row in d {
            let stretching = dot(&direction, row);
            for e in 0..9 {
                for l in 0..LANES {
                    let modulus = rates[0][0][l] - over(coupling[l] * coupling[l], slope[l]);
                    let turning = row[e][l] - direction[e][l] * stretching[l];
                    row[e][l] = if self.is_slack(l) {
                        0.0
                    } else {
                        modulus * stretching[l] * direction[e][l] + over(tension[l] * turning, self.along[l])
                    };
                }
            }
        }
    }
}

/// `a / b`, zero by zero: what has shrunk to nothing has no direction.
fn over(a: f64, b: f64) -> f64 {
    if b == 0.0 { 0.0 } else { a / b }
}

fn dot(a: &Row, b: &Row) -> [f64; LANES] {
    let mut sum = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for l in 0..LANES {
            sum[l] += a[l] * b[l];
        }
    }
    sum
}

fn norm(a: &Row) -> [f64; LANES] {
    dot(a, a).map(f64::sqrt)
}

/// `a + factor b`.
fn sum(a: &Row, b: &Row, factor: &[f64; LANES]) -> Row {
    std::array::from_fn(|e| std::array::from_fn(|l| a[e][l] + factor[l] * b[e][l]))
}

/// Columns `a × b` of the columns that follow: `cof = [y × z, z × x, x × y]`.
fn cofactor(F: &Row) -> Row {
    crosses(F, F).map(|entry| entry.map(|x| 0.5 * x))
}

/// `δ cof(F)` along `d`.
fn cofactor_differential(F: &Row, d: &Row) -> Row {
    crosses(F, d)
}

/// `a_j × b_k + b_j × a_k` for `(j, k)` the columns after each one.
fn crosses(a: &Row, b: &Row) -> Row {
    let mut out = ZERO;
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        for row in 0..3 {
            let (p, q) = ((row + 1) % 3, (row + 2) % 3);
            for l in 0..LANES {
                let cross =
                    |x: &Row, y: &Row| x[3 * j + p][l] * y[3 * k + q][l] - x[3 * j + q][l] * y[3 * k + p][l];
                out[3 * i + row][l] = cross(a, b) + cross(b, a);
            }
        }
    }
    out
}
