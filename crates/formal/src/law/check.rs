//! Trying a law before it is used: at rest, under rotations, and where it is legal but doubtful.

#![allow(non_snake_case)]

use std::collections::HashMap;

use souple_math::{Mat3, Vec3, eigen_symmetric, exponential};

use super::read::Read;
use super::{DEFORMATION, EnergyLaw, LawError, LawParameter, LawProblem, Strain};
use crate::graph::{Evaluation, Expr, Node};
use crate::{Function, Span};

/// Stress at rest beside the stiffness: what rounding of a hundred operations leaves, far below any physics.
const STRESS_AT_REST: f64 = 1e-9;
/// Relative change of energy under rotation that rounding may make.
const ROTATION_TOLERANCE: f64 = 1e-9;

/// Rotation vectors [rad].
const TURNS: [[f64; 3]; 8] = [
    [0.4, -1.1, 0.8],
    [2.0, 0.5, -0.3],
    [0.1, 0.0, 0.0],
    [0.0, 1.3, 0.0],
    [0.0, 0.0, -0.7],
    [-0.9, 0.2, 1.7],
    [1.0, 1.0, 0.6],
    [-0.3, -0.5, 0.25],
];

pub(super) fn check(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    let depends = |exprs: &[Expr]| {
        let depends = law.graph.depends(exprs, &[law.deformation]);
        exprs.iter().any(|expr| depends[expr.index()])
    };
    if depends(&[law.energy]) {
        value_at_rest(law, read)?;
        resistance(law, read)?;
        slope_at_rest(law, read)?;
        values_at_turned_rest(law, read)?;
        order_of_stretches(law, read)?;
        objectivity(law, read)?;
        doubts(law);
        return Ok(());
    }
    let written: Vec<Expr> = read.origins.keys().copied().collect();
    Err(if depends(&written) { no_stress(law, read) } else { whole(LawProblem::NoDeformation) })
}

fn whole(problem: LawProblem) -> LawError {
    LawError::new("energy", None, problem)
}

/// The problem at the place where `expr`, or the first thing around it, is written.
fn at(read: &Read, expr: Expr, problem: LawProblem) -> LawError {
    match read.origins.get(&expr) {
        Some((part, span)) => LawError::new(part.clone(), Some(*span), problem),
        None => whole(problem),
    }
}

/// Derivatives that became too long, told where most parts stand in one sum or product.
pub(super) fn too_long(read: &Read) -> LawError {
    let parts = |expr: &Expr| read.graph.node(*expr).operands().count();
    let written =
        read.graph.reachable(&[read.energy]).into_iter().filter(|expr| read.origins.contains_key(expr));
    let longest = written.max_by_key(parts).unwrap_or(read.energy);
    let problem = LawProblem::LongDerivatives { parts: parts(&longest), limit: super::LARGEST_DERIVATIVES };
    at(read, longest, problem)
}

impl EnergyLaw {
    /// Evaluates expressions of the law at a deformation and a variation of it.
    pub fn evaluate(&self, roots: &[Expr], F: &Mat3, dF: &Mat3) -> Evaluation {
        let (F, dF) = (entries(F), entries(dF));
        self.graph.evaluate(roots, |symbol| match symbol.name.as_str() {
            DEFORMATION => &F[..],
            super::VARIATION => &dF[..],
            name => self.parameter(name).map_or(&[0.0; 9][..], |parameter| parameter.numbers()),
        })
    }

    /// `Ψ(F)` [J/m³].
    pub fn energy_at(&self, F: &Mat3) -> f64 {
        self.evaluate(&[self.energy], F, &Mat3::ZERO).scalar(self.energy)
    }

    /// `P(F)` [Pa].
    pub fn stress_at(&self, F: &Mat3) -> Mat3 {
        self.evaluate(&[self.stress], F, &Mat3::ZERO).matrix(self.stress)
    }

    /// `∂P/∂F : δF` [Pa].
    pub fn differential_at(&self, F: &Mat3, dF: &Mat3) -> Mat3 {
        self.evaluate(&[self.differential], F, dF).matrix(self.differential)
    }
}

fn entries(matrix: &Mat3) -> [f64; 9] {
    let mut out = [0.0; 9];
    for (three, column) in out.chunks_exact_mut(3).zip(matrix.columns) {
        three.copy_from_slice(&column.to_array());
    }
    out
}

fn identity() -> Mat3 {
    Mat3::identity(1.0)
}

/// How much smaller and larger than moderate ones deformations are tried too.
const SCALES: [f64; 3] = [1.0, 1e-3, 20.0];

/// Some deformation makes a stress. What rounding leaves of zero is another number a millionth beside it; a stress is the same.
fn resistance(law: &EnergyLaw, read: &Read) -> Result<(), LawError> {
    let tried =
        deformations().into_iter().flat_map(|F| SCALES.map(|scale| identity() + (F - identity()) * scale));
    let resists = |F: Mat3| {
        let here = law.stress_at(&F);
        let is_steady = |direction: Mat3| {
            let beside = law.stress_at(&(F + direction * 1e-6));
            (beside - here).largest_entry() < 0.1 * here.largest_entry()
        };
        entries(&here).iter().any(|entry| entry.is_infinite()) || directions().into_iter().all(is_steady)
    };
    if tried.into_iter().any(resists) { Ok(()) } else { Err(no_stress(law, read)) }
}

fn no_stress(law: &EnergyLaw, read: &Read) -> LawError {
    let is_zero = |(name, parameter): &(String, LawParameter)| {
        let is_used = read.used.contains(name);
        (is_used && parameter.numbers() == [0.0]).then(|| name.clone())
    };
    let zeros = law.parameters.iter().filter_map(is_zero).collect();
    at(read, read.energy, LawProblem::NoStress { zeros })
}

/// The energy has a value at rest, which becomes zero; an offset has no physics.
fn value_at_rest(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    finite_at(law, read, &identity())?;
    let offset = law.evaluate(&[law.energy], &identity(), &Mat3::ZERO).scalar(law.energy);
    if offset != 0.0 {
        let minus = law.graph.number(-offset);
        law.energy = law.graph.sum(&[law.energy, minus]);
    }
    Ok(())
}

/// Turned bodies are at rest as well, where what is zero by formula is a rounding, above or below.
fn values_at_turned_rest(law: &EnergyLaw, read: &Read) -> Result<(), LawError> {
    TURNS.iter().try_for_each(|turn| finite_at(law, read, &exponential(Vec3::from_array(*turn))))
}

fn finite_at(law: &EnergyLaw, read: &Read, F: &Mat3) -> Result<(), LawError> {
    let values = law.evaluate(&[law.energy], F, &Mat3::ZERO);
    for expr in law.graph.reachable(&[law.energy]) {
        if let Some(bad) = values.of(expr).iter().find(|number| !number.is_finite()) {
            let reason = reason(law, &values, expr, *bad);
            // the innermost part that was written: parts of it that the reader made itself have no place
            let named = law.graph.reachable(&[law.energy]).into_iter().find(|outer| {
                read.origins.contains_key(outer)
                    && *outer >= expr
                    && law.graph.depends(&[*outer], &[expr])[outer.index()]
            });
            return Err(at(read, named.unwrap_or(expr), LawProblem::NoValueAtRest { reason }));
        }
    }
    Ok(())
}

fn reason(law: &EnergyLaw, values: &Evaluation, expr: Expr, bad: f64) -> String {
    match law.graph.node(expr) {
        Node::Power(base, exponent) if values.scalar(*base) == 0.0 && values.scalar(*exponent) < 0.0 => {
            "a division by zero".to_owned()
        }
        Node::Power(base, _) if values.scalar(*base) < 0.0 => {
            format!("a power of {} that is not whole", values.scalar(*base))
        }
        Node::Function(function, argument) => {
            format!("{} of {}", format!("{function:?}").to_lowercase(), values.scalar(*argument))
        }
        _ if bad.is_nan() => "it is not defined".to_owned(),
        _ => format!("it is {bad}"),
    }
}

/// Energy a ten-millionth from rest, over the stiffness, at most: a smooth one is of the size of the square.
const JUMP_AT_REST: f64 = 1e-6;

/// The stress is zero at rest and neither it nor the energy jumps there; remembers the stiffness.
fn slope_at_rest(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    let rest = law.stress_at(&identity());
    if !rest.is_finite() {
        return Err(corner(law, read));
    }
    for b in 0..9 {
        let dF = unit(b);
        let column = entries(&law.differential_at(&identity(), &dF));
        for (a, number) in column.into_iter().enumerate() {
            law.stiffness[9 * a + b] = number;
        }
    }
    // differences stand in where only the second derivative has no value at rest itself
    let size = |matrix: &Mat3| matrix.largest_entry();
    let shifted = |h: f64, direction: &Mat3| law.stress_at(&(identity() + *direction * h));
    // what overflows a thousandth away tells nothing
    let scale = directions()
        .iter()
        .map(|d| size(&(shifted(1e-3, d) - rest)) / 1e-3)
        .filter(|slope| slope.is_finite())
        .fold(0.0, f64::max);
    let limit = STRESS_AT_REST * scale.max(f64::MIN_POSITIVE);
    if size(&rest) > limit || size(&rest).is_nan() {
        // a corner such as that of |J - 1| shows as stress at rest from one side only
        if let Some(expr) = corner_at_rest(law) {
            return Err(at(read, expr, LawProblem::CornerAtRest));
        }
        let P = rest;
        let stress = format!(
            "[{:.4e}, {:.4e}, {:.4e}] Pa on the diagonal, {:.4e} Pa at most beside it",
            P.columns[0].x,
            P.columns[1].y,
            P.columns[2].z,
            (0..9).filter(|i| i % 4 != 0).map(|i| entries(&P)[i].abs()).fold(0.0, f64::max)
        );
        let span = Some(Span::new(0, 0));
        let span = read
            .origins
            .values()
            .filter(|(part, _)| part == "energy")
            .map(|(_, s)| *s)
            .reduce(wider)
            .or(span);
        return Err(LawError::new("energy", span, LawProblem::StressAtRest { stress }));
    }
    for direction in directions() {
        for sign in [1.0, -1.0] {
            let (near, far) = (shifted(sign * 1e-7, &direction), shifted(sign * 2e-7, &direction));
            // a smooth stress halves with the distance; one that jumps stays
            let jumps = size(&near) > 0.75 * size(&far) && size(&near) > 1e-3 * scale * 1e-3;
            // what jumps to a constant has no stress on either side
            let rises = law.energy_at(&(identity() + direction * (sign * 1e-7))).abs() > JUMP_AT_REST * scale;
            if jumps || rises || !near.is_finite() {
                return Err(corner(law, read));
            }
        }
    }
    if law.stiffness.iter().any(|number| !number.is_finite()) {
        return Err(corner(law, read));
    }
    Ok(())
}

fn corner(law: &EnergyLaw, read: &Read) -> LawError {
    let problem = LawProblem::CornerAtRest;
    match corner_at_rest(law) {
        Some(expr) => at(read, expr, problem),
        None => whole(problem),
    }
}

fn wider(a: Span, b: Span) -> Span {
    Span::new(a.start.min(b.start), a.end.max(b.end))
}

fn unit(entry: usize) -> Mat3 {
    let mut columns = [[0.0; 3]; 3];
    columns[entry / 3][entry % 3] = 1.0;
    let [a, b, c] = columns.map(Vec3::from_array);
    Mat3::from_columns(a, b, c)
}

/// The first part that has a corner where its operands are at rest.
fn corner_at_rest(law: &EnergyLaw) -> Option<Expr> {
    let values = law.evaluate(&[law.energy], &identity(), &Mat3::ZERO);
    let depends = law.graph.depends(&[law.energy], &[law.deformation]);
    let corner = |expr: &Expr| match law.graph.node(*expr) {
        Node::Power(base, exponent) => values.scalar(*base) == 0.0 && values.scalar(*exponent) < 2.0,
        Node::Function(Function::Abs | Function::Sign | Function::Cbrt, a) => values.scalar(*a) == 0.0,
        Node::Function(Function::Asin | Function::Acos, a) => values.scalar(*a).abs() == 1.0,
        Node::Function(Function::Floor | Function::Ceil, a) => values.scalar(*a).fract() == 0.0,
        Node::Select(condition, _, _) => match law.graph.node(*condition) {
            Node::Compare(_, a, b) => values.scalar(*a) == values.scalar(*b),
            _ => false,
        },
        _ => false,
    };
    law.graph.reachable(&[law.energy]).into_iter().filter(|expr| depends[expr.index()]).find(corner)
}

/// Deformations of all kinds, the same in every run.
fn directions() -> Vec<Mat3> {
    let rows = [
        [0.3, -0.1, 0.2, 0.15, -0.25, 0.05, -0.2, 0.1, 0.35],
        [-0.3, 0.2, 0.1, -0.05, 0.15, 0.3, 0.25, -0.15, -0.1],
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.6, 0.0, 0.0, 0.0, 0.6, 0.0, 0.0, 0.0, 0.6],
    ];
    rows.iter()
        .map(|row| {
            let column = |i: usize| Vec3::new(row[3 * i], row[3 * i + 1], row[3 * i + 2]);
            Mat3::from_columns(column(0), column(1), column(2))
        })
        .collect()
}

/// Moderate deformations that change their volume and keep it positive: a law that changes where the volume is that of rest would
/// else change by rounding.
fn deformations() -> Vec<Mat3> {
    let of = |d: Mat3| [(identity() + d * 0.2) * 1.03, (identity() + d * -0.15) * 0.98];
    directions().into_iter().flat_map(of).collect()
}

fn objectivity(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    if law.strain == Strain::Small {
        return small_rotations(law, read);
    }
    // a law may be flat at rest, and along some deformations
    let largest = deformations().iter().map(|F| law.energy_at(F).abs()).fold(0.0, f64::max);
    let stiffness = law.stiffness.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    for F in deformations() {
        let before = law.energy_at(&F);
        let scale = before.abs().max(1e-3 * stiffness.max(largest));
        for turn in [Vec3::new(0.4, -1.1, 0.8), Vec3::new(2.0, 0.5, -0.3)] {
            let turned = exponential(turn) * F;
            let after = law.energy_at(&turned);
            if (after - before).abs() > ROTATION_TOLERANCE * scale {
                let problem = LawProblem::NotObjective { before, after };
                return Err(at(read, spoiler(law, read, &F, &turned).unwrap_or(law.energy), problem));
            }
        }
    }
    Ok(())
}

/// Under small strain turns are small too: at a strain of size `h` they add the skew `h W` to `F`, and the energy, of the order
/// `h²`, is the same but for higher orders.
fn small_rotations(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    let h = 1e-5;
    let scale = h * h * law.stiffness.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    for strain in directions() {
        let F = identity() + strain * h;
        for turn in Vec3::AXES {
            let turned = F + (exponential(turn * h) - identity());
            let (before, after) = (law.energy_at(&F), law.energy_at(&turned));
            // energies of the order h³
            if (after - before).abs() > 1e-2 * scale {
                let problem = LawProblem::NotObjective { before, after };
                return Err(at(read, spoiler(law, read, &F, &turned).unwrap_or(law.energy), problem));
            }
        }
    }
    let warning = "small strain (`eps`) takes rotations for strain: bodies that turn swell; E or C do not";
    law.warnings.push(warning.to_owned());
    Ok(())
}

/// The smallest written number that the rotation from one deformation to the other changes.
fn spoiler(law: &EnergyLaw, read: &Read, F: &Mat3, turned: &Mat3) -> Option<Expr> {
    let before = law.evaluate(&[law.energy], F, &Mat3::ZERO);
    let after = law.evaluate(&[law.energy], turned, &Mat3::ZERO);
    law.graph.reachable(&[law.energy]).into_iter().find(|expr| {
        let (a, b) = (before.of(*expr), after.of(*expr));
        a.len() == 1
            && read.origins.contains_key(expr)
            && (a[0] - b[0]).abs() > 1e-9 * (a[0].abs() + b[0].abs())
    })
}

/// The energy is the same in any order of the stretches.
fn order_of_stretches(law: &mut EnergyLaw, read: &Read) -> Result<(), LawError> {
    let decomposition = law.graph.decompose(law.deformation);
    let stretches = [0, 1, 2].map(|index| law.graph.stretch(decomposition, index));
    let uses = law.graph.depends(&[law.energy], &stretches)[law.energy.index()];
    if !uses {
        return Ok(());
    }
    for (i, j) in [(0, 1), (1, 2)] {
        let swap = HashMap::from([(stretches[i], stretches[j]), (stretches[j], stretches[i])]);
        let swapped = law.graph.substitute(law.energy, &swap);
        let values = law.evaluate(&[law.energy, swapped], &deformations()[0], &Mat3::ZERO);
        let (a, b) = (values.scalar(law.energy), values.scalar(swapped));
        if (a - b).abs() > 1e-9 * (a.abs() + b.abs()) {
            let used = stretches.into_iter().find(|stretch| read.origins.contains_key(stretch));
            return Err(at(read, used.unwrap_or(law.energy), LawProblem::OrderOfStretches));
        }
    }
    Ok(())
}

/// What is legal physics and often not what was meant.
fn doubts(law: &mut EnergyLaw) {
    let mut doubts = Vec::new();
    let largest = law.stiffness.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let (shear, volume) = (least_shear(law), law.bulk_modulus());
    if volume < -1e-9 * largest || shear < -1e-9 * largest {
        doubts.push("at rest the stiffness is negative: the body leaves its rest shape by itself");
    } else if volume <= 1e-9 * largest {
        doubts.push("nothing resists a change of volume at rest");
    } else if shear <= 1e-9 * largest {
        doubts.push("some shear or stretch meets no resistance at rest");
    }
    let along = |s: f64| {
        law.energy_at(&Mat3::from_columns(Vec3::new(s, 0.0, 0.0), unit(4).columns[1], unit(8).columns[2]))
    };
    if !along(-0.5).is_finite() {
        doubts.push("inverted elements have no energy: a step that inverts one is refused");
    } else if along(-1.0).abs() < 1e-9 * largest {
        doubts.push("an element turned inside out is at rest too: nothing turns it back");
    } else if along(1e-9) < 2.0 * largest {
        doubts.push("an element can be crushed flat at little cost");
    }
    law.warnings.extend(doubts.into_iter().map(str::to_owned));
    law.warnings.extend(jump(law));
}

/// Stretches along which jumps are looked for, and how finely.
const STRETCHES: [f64; 2] = [0.2, 3.0];
const LOOKS: usize = 96;
/// Halvings that leave two neighbouring numbers of that range.
const TO_NEIGHBOURS: usize = 52;
/// A change between neighbours that is no rounding, next to the energies at both.
const JUMP: f64 = 1e-6;

/// Where an energy that is made of pieces is not continuous, pulled along x or in all directions.
fn jump(law: &EnergyLaw) -> Option<String> {
    let is_of_pieces = |expr: &Expr| match law.graph.node(*expr) {
        Node::Compare(..) => true,
        Node::Function(function, _) => {
            matches!(function, Function::Floor | Function::Ceil | Function::Sign | Function::Step)
        }
        _ => false,
    };
    if !law.graph.reachable(&[law.energy]).iter().any(is_of_pieces) {
        return None;
    }
    let pulled = |s: f64| Vec3::new(s, 1.0, 1.0);
    let swollen = |s: f64| Vec3::new(s, s, s);
    let ways: [(&str, &dyn Fn(f64) -> Vec3); 2] =
        [("pulled along x", &pulled), ("stretched in all directions", &swollen)];
    ways.into_iter().find_map(|(way, stretches)| {
        let energy = |s: f64| {
            let Vec3 { x, y, z } = stretches(s);
            law.energy_at(&Mat3::from_columns(Vec3::X * x, Vec3::Y * y, Vec3::Z * z))
        };
        let place = |look: usize| {
            STRETCHES[0] + (STRETCHES[1] - STRETCHES[0]) * look as f64 / (LOOKS - 1) as f64
        };
        (1..LOOKS).find_map(|look| {
            let (mut low, mut high) = (place(look - 1), place(look));
            let (mut below, mut above) = (energy(low), energy(high));
            for _ in 0..TO_NEIGHBOURS {
                let middle = 0.5 * (low + high);
                let between = energy(middle);
                if (between - below).abs() > (above - between).abs() {
                    (high, above) = (middle, between);
                } else {
                    (low, below) = (middle, between);
                }
            }
            let change = (above - below).abs();
            (change > JUMP * above.abs().max(below.abs())).then(|| {
                format!(
                    "the energy jumps by {change:.3e} J/m³ where a cube is {way} to {high:.4} of its length: what passes there gains or loses it"
                )
            })
        })
    })
}

/// The least stiffness at rest against shears and stretches without change of volume [Pa].
fn least_shear(law: &EnergyLaw) -> f64 {
    // two bases of three of the five-dimensional space: their least eigenvalues bound that of laws with symmetry axes
    let s = 0.5f64.sqrt();
    let shears = [(3, 1), (6, 2), (7, 5)].map(|(a, b)| (unit(a) + unit(b)) * s);
    let stretches = [(0, 4), (4, 8), (8, 0)].map(|(a, b)| (unit(a) - unit(b)) * s);
    let least = |basis: &[Mat3; 3]| {
        let row = |i: usize| {
            let numbers = [0, 1, 2].map(|j| contract(law, &basis[i], &basis[j]));
            Vec3::from_array(numbers)
        };
        eigen_symmetric(&Mat3::from_columns(row(0), row(1), row(2))).values
    };
    // the three stretches sum to zero: one eigenvalue of theirs is zero by construction, the next one counts
    let (of_shears, of_stretches) = (least(&shears), least(&stretches));
    of_shears.z.min(if of_stretches.z.abs() < of_stretches.y.abs() { of_stretches.y } else { of_stretches.z })
}

fn contract(law: &EnergyLaw, a: &Mat3, b: &Mat3) -> f64 {
    let (a, b) = (entries(a), entries(b));
    (0..81).map(|i| a[i / 9] * law.stiffness[i] * b[i % 9]).sum()
}
