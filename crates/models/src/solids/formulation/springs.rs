//! Masses and springs: every edge of the mesh is a spring, stiff as the cells around it ask for.
//!
//! `k = Σ E V / l²` over the cells of an edge of rest length `l`, so that a mesh of regular tetrahedra has about the stiffness of the
//! matter; no set of springs has the stiffness of any other, and Poisson's ratio is theirs. (Van Gelder 1998, Approximate
//! simulation of elastic membranes by triangulated spring meshes.)
//!
//! Simpler rules are there to be compared: the same `k` everywhere, `k = c l`, `k = c/l`. None of them makes two meshes of one
//! body move alike.

#![allow(non_snake_case)]

use std::any::Any;
use std::collections::BTreeMap;

use souple_engine::state::Pair;
use souple_engine::tangent::add_block;
use souple_engine::{Configuration, Declaration, Energy, Force, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;
use souple_table::{Entry, Parameter, Range, Value, Values};

use super::{BuildFormulation, FormulationError, check_cells};
use crate::solids::SolidDescription;

const NAME: &str = "mass_spring";

pub(super) const ENTRY: Entry<BuildFormulation> = Entry {
    name: NAME,
    summary: "a spring along every edge, with the stiffness that the cells around it ask for; Poisson's ratio is not kept",
    source: "Van Gelder 1998, Approximate simulation of elastic membranes by triangulated spring meshes",
    parameters: &[
        Parameter::choice(
            "rule",
            &["van_gelder", "constant", "proportional", "inverse"],
            "stiffness k of a spring of length l: E Σ V/l², c, c l, c/l",
        )
        .or(Value::Text("van_gelder")),
        Parameter::number(
            "coefficient",
            "",
            Range::NOT_NEGATIVE,
            "c of the other rules, in N/m times what power of m the rule asks for; 0: springs as stiff in sum as van_gelder's",
        )
        .or(Value::Number(0.0)),
    ],
    build: |description, values| Ok(Box::new(MassSpring::new(description, &Rule::of(values))?)),
};

/// How stiff springs are that do not follow the matter: `k = c l^power`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rule {
    /// None: by the cells around.
    power: Option<i32>,
    /// 0: as much in sum as by the cells around.
    coefficient: f64,
}

impl Rule {
    fn of(values: &Values) -> Self {
        let power = match values.text("rule") {
            "constant" => Some(0),
            "proportional" => Some(1),
            "inverse" => Some(-1),
            _ => None,
        };
        Self { power, coefficient: values.number("coefficient") }
    }

    fn apply(self, springs: &mut [Spring]) {
        let Some(power) = self.power else { return };
        let shares = || springs.iter().map(|spring| spring.rest_length.powi(power));
        let coefficient = if self.coefficient > 0.0 {
            self.coefficient
        } else {
            springs.iter().map(|spring| spring.stiffness).sum::<f64>() / shares().sum::<f64>()
        };
        let stiffness: Vec<f64> = shares().map(|share| coefficient * share).collect();
        springs.iter_mut().zip(stiffness).for_each(|(spring, stiffness)| spring.stiffness = stiffness);
    }
}

/// [`Force`] of springs along edges.
struct MassSpring {
    name: String,
    springs: Vec<Spring>,
}

#[derive(Clone, Copy, Debug)]
struct Spring {
    rows: [u32; 2],
    /// [N/m]
    stiffness: f64,
    /// [m]
    rest_length: f64,
}

impl MassSpring {
    fn new(description: &SolidDescription, rule: &Rule) -> Result<Self, FormulationError> {
        let linear = |kind: souple_mesh::ElementKind| kind.dimension() == 3 && kind.corners() == kind;
        check_cells(NAME, description, linear, "linear volume elements")?;
        let SolidDescription { mesh, first_row, materials, material_of_cell, .. } = description;
        // ordered by their ends: the sums of forces have one order
        let mut stiffness: BTreeMap<[u32; 2], f64> = BTreeMap::new();
        for (number, cell) in mesh.cells().enumerate() {
            let youngs_modulus =
                materials[usize::from(material_of_cell[number])].small_strain.youngs_modulus();
            let corners: Vec<Vec3> = cell.nodes.iter().map(|node| mesh.points[*node as usize]).collect();
            let points = &cell.kind.default_rule().points;
            let volume: f64 = points
                .iter()
                .map(|point| point.weight * cell.kind.jacobian(&corners, point.position).determinant())
                .sum();
            for [a, b] in cell.kind.edges() {
                let mut ends = [cell.nodes[usize::from(*a)], cell.nodes[usize::from(*b)]];
                ends.sort_unstable();
                let length_sq = (corners[usize::from(*a)] - corners[usize::from(*b)]).length_sq();
                *stiffness.entry(ends).or_insert(0.0) += youngs_modulus * volume / length_sq;
            }
        }
        let spring = |(ends, stiffness): ([u32; 2], f64)| {
            let [a, b] = ends.map(|end| mesh.points[end as usize]);
            let rows = ends.map(|end| end + *first_row as u32);
            Spring { rows, stiffness, rest_length: (b - a).length() }
        };
        let mut springs: Vec<Spring> = stiffness.into_iter().map(spring).collect();
        rule.apply(&mut springs);
        Ok(Self { name: description.name.clone(), springs })
    }
}

impl Spring {
    /// Length and direction from the first end to the second.
    fn now(&self, positions: &[Vec3]) -> (f64, Vec3) {
        let [a, b] = self.rows.map(|row| positions[row as usize]);
        let length = (b - a).length();
        // ends that meet have no direction, and no force that would part them again
        (length, if length > 0.0 { (b - a) * (1.0 / length) } else { Vec3::ZERO })
    }

    // ∂f_a/∂x_b = k (u uᵀ + (1 - l₀/l) (I - u uᵀ))
    fn block(&self, positions: &[Vec3]) -> Mat3 {
        let (length, u) = self.now(positions);
        let across = if length > 0.0 { 1.0 - self.rest_length / length } else { 0.0 };
        (u.outer(u) * (1.0 - across)).plus_diagonal(across) * self.stiffness
    }
}

impl Force for MassSpring {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        Declaration::ELASTIC
    }

    fn acts_within(&self) -> bool {
        true
    }

    fn energy(&self, at: &Configuration, _: &mut Scratch) -> Energy {
        let of = |spring: &Spring| {
            let stretch = spring.now(at.positions).0 - spring.rest_length;
            0.5 * spring.stiffness * stretch * stretch
        };
        Energy { stored: self.springs.iter().map(of).sum(), dissipated: 0.0 }
    }

    fn add_force(&self, at: &Configuration, _: &mut Scratch, out: &mut [Vec3]) {
        for spring in &self.springs {
            let (length, u) = spring.now(at.positions);
            let pull = u * (spring.stiffness * (length - spring.rest_length));
            out[spring.rows[0] as usize] += pull;
            out[spring.rows[1] as usize] -= pull;
        }
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _: &mut Scratch,
        out: &mut [Vec3],
    ) {
        for spring in &self.springs {
            let [a, b] = spring.rows.map(|row| row as usize);
            let change = spring.block(at.positions) * (delta[b] - delta[a]) * weights.position;
            out[a] += change;
            out[b] -= change;
        }
    }

    fn visit_cliques(&self, _: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        self.springs.iter().for_each(|spring| visit(&spring.rows));
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        for spring in &self.springs {
            let [a, b] = spring.rows.map(|row| row as usize);
            let block = spring.block(at.positions) * weights.position;
            for (row, column, block) in [(a, b, block), (b, a, block), (a, a, -block), (b, b, -block)] {
                add_block(matrix, row, column, &block);
            }
        }
    }

    fn bytes(&self) -> usize {
        size_of_val(self.springs.as_slice())
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
