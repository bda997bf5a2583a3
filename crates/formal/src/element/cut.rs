//! Cutting expressions into addends: by terms of the law, samples, nodes, directions.

use std::fmt;

/// One of the ways to cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Terms of the law.
    Law,
    /// Samples (Gauss points).
    Gauss,
    /// Nodes whose variation is multiplied, in the differential.
    Nodes,
    /// Directions of that variation, in the differential.
    Dimension,
}

impl Axis {
    pub const ALL: [Self; 4] = [Self::Law, Self::Gauss, Self::Nodes, Self::Dimension];

    fn letter(self) -> char {
        match self {
            Self::Law => 'L',
            Self::Gauss => 'G',
            Self::Nodes => 'N',
            Self::Dimension => 'D',
        }
    }
}

/// Which axes are cut: 16 choices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cut {
    axes: [bool; 4],
}

impl Cut {
    pub const NONE: Self = Self { axes: [false; 4] };
    pub const ALL: Self = Self { axes: [true; 4] };

    pub fn of(axes: &[Axis]) -> Self {
        let mut cut = Self::NONE;
        axes.iter().for_each(|axis| cut.axes[*axis as usize] = true);
        cut
    }

    pub fn has(self, axis: Axis) -> bool {
        self.axes[axis as usize]
    }

    /// All of them, from none to all.
    pub fn every() -> impl Iterator<Item = Self> {
        (0..16_u8).map(|bits| Self { axes: [0, 1, 2, 3].map(|axis| bits >> axis & 1 == 1) })
    }

    /// The cut of that name, as the source writes it (`DecoupageLG`) or by its letters (`LG`, `none`, `all`).
    pub fn from_name(name: &str) -> Option<Self> {
        let name = name.strip_prefix("Decoupage").unwrap_or(name);
        match name {
            "Non" | "none" => return Some(Self::NONE),
            "Tout" | "all" => return Some(Self::ALL),
            _ => {}
        }
        let mut cut = Self::NONE;
        for letter in name.chars() {
            let axis = Axis::ALL.into_iter().find(|axis| axis.letter() == letter.to_ascii_uppercase())?;
            // a letter twice is a slip
            if std::mem::replace(&mut cut.axes[axis as usize], true) {
                return None;
            }
        }
        (cut != Self::NONE).then_some(cut)
    }

    /// `none`, `all`, or the letters of its axes.
    pub fn name(self) -> String {
        match self {
            Self::NONE => "none".to_owned(),
            Self::ALL => "all".to_owned(),
            _ => Axis::ALL.into_iter().filter(|axis| self.has(*axis)).map(Axis::letter).collect(),
        }
    }
}

/// The source's name.
impl fmt::Display for Cut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NONE => f.write_str("DecoupageNon"),
            Self::ALL => f.write_str("DecoupageTout"),
            _ => write!(f, "Decoupage{}", self.name()),
        }
    }
}

/// Which addends an expression gathers; `None` where all of an axis are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fragment {
    pub term: Option<usize>,
    pub sample: Option<usize>,
    pub node: Option<usize>,
    pub direction: Option<usize>,
}

impl Fragment {
    /// The fragments of forces: the axes of nodes and directions do not cut them.
    pub(super) fn of_forces(cut: Cut, terms: usize, samples: usize) -> Vec<Self> {
        let mut all = Vec::new();
        for sample in choices(cut.has(Axis::Gauss), samples) {
            for term in choices(cut.has(Axis::Law), terms) {
                all.push(Self { term, sample, ..Self::default() });
            }
        }
        all
    }

    /// The fragments of differentials.
    pub(super) fn of_differentials(
        cut: Cut,
        (terms, samples): (usize, usize),
        (nodes, dimension): (usize, usize),
    ) -> Vec<Self> {
        let mut all = Vec::new();
        for fragment in Self::of_forces(cut, terms, samples) {
            for node in choices(cut.has(Axis::Nodes), nodes) {
                for direction in choices(cut.has(Axis::Dimension), dimension) {
                    all.push(Self { node, direction, ..fragment });
                }
            }
        }
        all
    }
}

fn choices(is_cut: bool, count: usize) -> Vec<Option<usize>> {
    if is_cut { (0..count).map(Some).collect() } else { vec![None] }
}

/// Which expressions of an element a name is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derivative {
    Force,
    Differential,
}

impl Derivative {
    fn prefix(self) -> &'static str {
        match self {
            Self::Force => "F",
            Self::Differential => "dF",
        }
    }

    /// The source's name of the expression of a node along an axis (0 to 2) in a fragment of an association of law,
    /// element and cut: `FHookeTriangleDecoupageNon0_0x`.
    pub fn expression_name(self, association: &str, fragment: usize, node: usize, axis: usize) -> String {
        let axis = ["x", "y", "z"].get(axis).copied().unwrap_or_default();
        format!("{}{association}{fragment}_{node}{axis}", self.prefix())
    }

    /// The source's name of the grouped constants of a fragment: `ECR_dFHookeHexa8IDecoupageLN4`.
    pub fn constants_name(self, association: &str, fragment: usize) -> String {
        format!("ECR_{}{association}{fragment}", self.prefix())
    }
}
