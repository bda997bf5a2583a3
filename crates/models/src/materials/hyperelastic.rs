//! Hyperelasticity written as text in the scene: any energy density, derived and compiled when the scene is read.
//!
//! For laws that have no file here, and for trying one before it gets a file. A step takes somewhat longer than with a law
//! compiled ahead. Outside the range where its formula has a value (`log(J)` of inverted elements) such a law has none:
//! the step is refused. The compiled laws are continued there on purpose.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use souple_formal::law::{self, EnergyLaw, LawError, LawParameter, LawText, Strain};
use souple_formal::tape::{Part, Tape};
use souple_formal::{Expression, Formula, Span, UnitError, parse_quantity};
use souple_math::{Mat3, Vec3};
use souple_table::{Entry, Parameter, Value};

use super::{Build, DENSITY, KeptLaws, Lame, Material, MaterialLaw, PARAMETERS_MAX};

pub(super) const ENTRY: Entry<Build> = Entry {
    name: "hyperelastic",
    summary: "any law as text: an energy density of F, C, E, J, I1, I2, I1_bar, l1, I4(a), …; stress and tangent are \
              derived, units, rest state and objectivity checked when the scene is read",
    source: "Korelc 2002, Multi-language and multi-environment generation of nonlinear finite element codes; Faure 2014",
    parameters: &[
        Parameter::text(
            "energy",
            "Ψ, energy per rest volume, such as \"mu/2*(I1 - 3) - mu*log(J) + lambda/2*log(J)^2\"",
        ),
        Parameter::texts(
            "parameters",
            "material constants of the energy, such as { mu = \"1 MPa\", fibre = [1, 0, 0] }",
        )
        .or(Value::Texts(&[])),
        Parameter::texts(
            "definitions",
            "names for parts of the energy, such as { Q = \"b*(I4(fibre) - 1)^2\" }",
        )
        .or(Value::Texts(&[])),
        DENSITY,
    ],
    build: |values| {
        let text = law_text(values.text("energy"), values.texts("parameters"), values.texts("definitions"))?;
        let law = TextLaw::known(text)?;
        let small_strain = law.small_strain();
        Ok(Material {
            law: MaterialLaw::Text(law),
            parameters: [0.0; PARAMETERS_MAX],
            small_strain,
            density: values.number("density"),
        })
    },
};

/// Why the values of a material make none.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct MaterialError {
    path: Vec<String>,
    span: Option<Span>,
    message: String,
    /// What is wrong elsewhere in the same law.
    others: Vec<Self>,
}

impl MaterialError {
    /// Of one parameter.
    pub(super) fn of(parameter: &str, message: String) -> Self {
        Self { path: vec![parameter.to_owned()], span: None, message, others: Vec::new() }
    }

    /// Keys that lead from the material to what is wrong: `["parameters", "mu"]`.
    pub fn path(&self) -> &[String] {
        &self.path
    }

    /// The place in the text there.
    pub fn span(&self) -> Option<Span> {
        self.span
    }

    /// This and all else that is wrong in the same law.
    pub fn all(&self) -> impl Iterator<Item = &Self> {
        std::iter::once(self).chain(&self.others)
    }
}

/// A law as text with its compiled forms.
#[derive(Debug)]
pub struct TextLaw {
    text: LawText,
    derived: Derived,
    /// Its expressions, which only a few need; not there before that where the law was kept.
    expressions: OnceLock<EnergyLaw>,
}

/// What a run needs of a law: all of it fits into a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Derived {
    pub energy: Tape,
    pub stress: Tape,
    pub differential: Tape,
    pub strain: Strain,
    pub is_linear: bool,
    pub warnings: Vec<String>,
    /// As [`EnergyLaw::stiffness`].
    pub stiffness: Box<[f64; 81]>,
}

/// The same text with the same parameters.
impl PartialEq for TextLaw {
    fn eq(&self, other: &Self) -> bool {
        // most comparisons are of a law with itself, cell after cell
        std::ptr::eq(self, other) || self.text == other.text
    }
}

/// The law that an energy, parameters and definitions as written stand for.
///
/// # Errors
/// A parameter is no number, quantity or direction.
pub fn law_text(
    energy: &str,
    parameters: &[(String, String)],
    definitions: &[(String, String)],
) -> Result<LawText, MaterialError> {
    let (mut read, mut faults) = (Vec::with_capacity(parameters.len()), Vec::new());
    for (name, text) in parameters {
        match parameter_of(text) {
            Ok(parameter) => read.push((name.clone(), parameter)),
            Err((error, span)) => faults.push(MaterialError {
                path: vec!["parameters".to_owned(), name.clone()],
                span,
                message: format!("`{name}`: {error}"),
                others: Vec::new(),
            }),
        }
    }
    if faults.is_empty() {
        return Ok(LawText {
            energy: energy.to_owned(),
            definitions: definitions.to_vec(),
            parameters: read,
        });
    }
    let first = faults.remove(0);
    Err(MaterialError { others: faults, ..first })
}

/// A value as written; or what is wrong, and where.
fn parameter_of(text: &str) -> Result<LawParameter, (String, Option<Span>)> {
    if is_list(text) {
        return direction(text).map(LawParameter::Direction);
    }
    let quantity = parse_quantity(text).map_err(|error| (error.to_string(), Some(error.span())))?;
    // a bare number is taken in the unit that is wanted
    let bare = text.trim().parse::<f64>().is_ok();
    Ok(LawParameter::Number { value: quantity.value, dimension: (!bare).then_some(quantity.dimension) })
}

/// Whether a text is the value of a parameter: a number, a quantity or a direction, and else a part of an energy.
pub fn is_parameter(text: &str) -> bool {
    if is_list(text) {
        return direction(text).is_ok();
    }
    match (parse_quantity(text), Expression::parse(text)) {
        (Ok(_), _) => true,
        (Err(_), Ok(_)) => false,
        (Err(UnitError::OutOfRange { .. }), Err(_)) => true,
        // what went on for longer is what was meant: `10 kpa` is no part of an energy
        (Err(unit), Err(formula)) => unit.span().start >= formula.span().start,
    }
}

/// Whether a text is meant for a direction, in brackets or without.
fn is_list(text: &str) -> bool {
    let pieces: Vec<&str> = text.split([',', ' ']).filter(|piece| !piece.is_empty()).collect();
    let are_three = pieces.len() == 3 && pieces.iter().all(|piece| piece.parse::<f64>().is_ok());
    let text = text.trim_start();
    are_three || text.starts_with('[') || (text.starts_with('(') && text.contains(','))
}

/// `[x, y, z]`, made one long; or what is wrong, and where.
fn direction(text: &str) -> Result<[f64; 3], (String, Option<Span>)> {
    let wanted = "three numbers in brackets are accepted, as in [1, 0, 0]";
    if !text.trim_start().starts_with('[') {
        return Err((format!("`{text}` is no direction; {wanted}"), None));
    }
    let components = Formula::compile_vector::<3>(text, &[]).map_err(|error| {
        let message = format!("`{text}` is no direction: {}; {wanted}", error.without_place());
        (message, Some(error.span()))
    })?;
    let vector = components.map(|component| component.evaluate(&[]));
    let largest = vector.iter().fold(0.0, |most: f64, number| most.max(number.abs()));
    // what is zero or no number goes on, to be refused with its name
    if !(largest > 0.0 && largest.is_finite()) {
        return Ok(vector);
    }
    // squares of the smallest and largest numbers there are would be none
    let vector = vector.map(|number| number / largest);
    let length = vector.iter().map(|number| number * number).sum::<f64>().sqrt();
    Ok(vector.map(|number| number / length))
}

/// Laws compiled last, the latest first. A scene is read, built and, while it is shown, built again.
static KNOWN: Mutex<VecDeque<Arc<TextLaw>>> = Mutex::new(VecDeque::new());
/// How many of them.
const KNOWN_MOST: usize = 32;
/// Where laws are kept between runs; nowhere, if nobody says.
static KEPT: Mutex<Option<KeptLaws>> = Mutex::new(None);
/// Of the largest entry of the stiffness at rest: eighty-one of them are summed, each a hundred roundings of the derivation.
const MODULUS_ROUNDING: f64 = 1e-12;
/// The same, for entries one by one.
const ISOTROPY_ROUNDING: f64 = 1e-11;

impl TextLaw {
    /// The law of a text, compiled if it is not among those compiled last.
    ///
    /// # Errors
    /// As [`Self::compile`].
    pub fn known(text: LawText) -> Result<Arc<Self>, MaterialError> {
        let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(law) = known().iter().find(|law| law.text == text) {
            return Ok(Arc::clone(law));
        }
        let law = Arc::new(match Self::folder() {
            Some(kept) => Self::kept(text, &kept)?,
            None => Self::compile(text)?,
        });
        let mut known = known();
        known.truncate(KNOWN_MOST - 1);
        known.push_front(Arc::clone(&law));
        Ok(law)
    }

    /// Where laws are kept between runs, and what else is derived.
    pub(crate) fn folder() -> Option<KeptLaws> {
        KEPT.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// As written.
    pub(crate) fn text(&self) -> &LawText {
        &self.text
    }

    /// From now on laws that are not among those compiled last are looked for there, and left there for later runs.
    pub fn keep_in(kept: Option<KeptLaws>) {
        *KEPT.lock().unwrap_or_else(PoisonError::into_inner) = kept;
    }

    /// The law of a text as it was kept, and else compiled and kept: the same bits.
    ///
    /// # Errors
    /// As [`Self::compile`].
    pub fn kept(text: LawText, kept: &KeptLaws) -> Result<Self, MaterialError> {
        if let Some(derived) = kept.find(&text) {
            return Ok(Self { text, derived, expressions: OnceLock::new() });
        }
        let law = Self::compile(text)?;
        kept.keep(&law.text, &law.derived);
        Ok(law)
    }

    /// # Errors
    /// As [`EnergyLaw::compile`], with the place marked.
    pub fn compile(text: LawText) -> Result<Self, MaterialError> {
        let mut law = EnergyLaw::compile(&text).map_err(|error| told(&text, &error))?;
        let stress = law.guarded_stress();
        let tape = |output| Tape::compile(&law, &[output]);
        let derived = Derived {
            energy: tape(law.energy),
            stress: tape(stress),
            differential: tape(law.differential),
            strain: law.strain,
            is_linear: law.is_linear(),
            warnings: law.warnings.clone(),
            stiffness: law.stiffness.clone(),
        };
        Ok(Self { text, derived, expressions: OnceLock::from(law) })
    }

    /// Whether it may tell directions apart.
    pub fn knows_directions(&self) -> bool {
        self.text.names_directions()
    }

    /// The law as expressions, derived now if it was kept.
    ///
    /// # Errors
    /// As [`Self::compile`].
    pub fn expressions(&self) -> Result<&EnergyLaw, MaterialError> {
        if let Some(law) = self.expressions.get() {
            return Ok(law);
        }
        let law = EnergyLaw::compile(&self.text).map_err(|error| told(&self.text, &error))?;
        Ok(self.expressions.get_or_init(|| law))
    }

    /// Whether both have the same instructions, constants and numbers at rest.
    pub fn is_same_program(&self, other: &Self) -> bool {
        self.derived == other.derived
    }

    /// A parameter of the text.
    pub fn parameter(&self, name: &str) -> Option<&LawParameter> {
        self.text.parameters.iter().find(|(known, _)| known == name).map(|(_, parameter)| parameter)
    }

    /// Whether its stress is linear in `F - I`.
    pub fn is_linear(&self) -> bool {
        self.derived.is_linear
    }

    pub fn strain(&self) -> Strain {
        self.derived.strain
    }

    /// What is legal and doubtful.
    pub fn warnings(&self) -> &[String] {
        &self.derived.warnings
    }

    /// `Ψ(F)` [J/m³].
    pub fn energy_at(&self, F: &Mat3) -> f64 {
        let [energy] = at(self.energy(), F, None);
        energy
    }

    /// `P(F)`, which is no number where the energy is none [Pa].
    pub fn stress_at(&self, F: &Mat3) -> Mat3 {
        let [a, b, c, d, e, f, g, h, i] = at(self.stress(), F, None);
        Mat3::from_columns(Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::new(g, h, i))
    }

    /// `∂P/∂F : δF` [Pa].
    pub fn stress_differential_at(&self, F: &Mat3, dF: &Mat3) -> Mat3 {
        let [a, b, c, d, e, f, g, h, i] = at(self.differential(), F, Some(dF));
        Mat3::from_columns(Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::new(g, h, i))
    }

    /// `F` to `Ψ`.
    pub(crate) fn energy(&self) -> &Tape {
        &self.derived.energy
    }

    /// `F` to `P`, which is no number where the energy is none.
    pub(crate) fn stress(&self) -> &Tape {
        &self.derived.stress
    }

    /// `F`, `δF` to `δP`.
    pub(crate) fn differential(&self) -> &Tape {
        &self.derived.differential
    }

    /// Bulk modulus at rest and, over all directions, the mean shear modulus [Pa]; what is nothing but rounding is zero.
    pub(crate) fn bulk_and_shear(&self) -> [f64; 2] {
        let stiffness = &self.derived.stiffness;
        let rounding = self.modulus_rounding();
        [law::bulk_modulus(stiffness), law::mean_shear_modulus(stiffness)]
            .map(|modulus| if modulus.abs() <= rounding { 0.0 } else { modulus })
    }

    /// How large a modulus at rest must be to be told from rounding [Pa].
    pub(crate) fn modulus_rounding(&self) -> f64 {
        let stiffness = self.derived.stiffness.iter();
        MODULUS_ROUNDING * stiffness.fold(0.0, |most: f64, entry| most.max(entry.abs()))
    }

    /// The law of small strain with the stiffness at rest, `Ψ = 1/2 ε : C : ε`, where that is not the same in all directions.
    pub(crate) fn anisotropic_at_rest(&self) -> Option<Arc<Self>> {
        // entries of `F` by columns that make each strain: three stretches, three shears of two entries each
        const STRAINS: [(&str, &[usize]); 6] = [
            ("eps11", &[0]),
            ("eps22", &[4]),
            ("eps33", &[8]),
            ("eps12", &[1, 3]),
            ("eps13", &[2, 6]),
            ("eps23", &[5, 7]),
        ];
        let Lame { mu, lambda } = self.small_strain();
        let isotropic = |a: usize, b: usize| {
            let same = |condition: bool| f64::from(u8::from(condition));
            let (ra, ca, rb, cb) = (a % 3, a / 3, b % 3, b / 3);
            lambda * same(ra == ca) * same(rb == cb) + mu * (same(a == b) + same(ra == cb) * same(ca == rb))
        };
        let entry = |a: usize, b: usize| self.derived.stiffness[9 * a + b];
        let pairs = || (0..81).map(|index| (index / 9, index % 9));
        let largest = pairs().fold(0.0, |most: f64, (a, b)| most.max(entry(a, b).abs()));
        if pairs().all(|(a, b)| (entry(a, b) - isotropic(a, b)).abs() <= ISOTROPY_ROUNDING * largest) {
            return None;
        }
        let (mut terms, mut parameters) = (Vec::new(), Vec::new());
        for (i, (first, of_first)) in STRAINS.iter().enumerate() {
            for (second, of_second) in &STRAINS[i..] {
                let sum: f64 =
                    of_first.iter().flat_map(|a| of_second.iter().map(move |b| entry(*a, *b))).sum();
                // pairs of different strains stand twice in the sum
                let value = if first == second { 0.5 * sum } else { sum };
                if value.abs() > ISOTROPY_ROUNDING * largest {
                    let name = format!("c{}", parameters.len());
                    terms.push(format!("{name}*{first}*{second}"));
                    parameters.push((name, LawParameter::Number { value, dimension: None }));
                }
            }
        }
        let text = LawText { energy: terms.join(" + "), definitions: Vec::new(), parameters };
        Self::known(text).ok()
    }

    /// Moduli at rest: of an anisotropic law the mean shear modulus, and the stiffest longitudinal one.
    pub(crate) fn small_strain(&self) -> Lame {
        let entry = |a: usize, b: usize| self.derived.stiffness[9 * a + b];
        // entries (0,1), (1,2), (2,0) of F lie at 3, 7, 2
        let mu = (entry(3, 3) + entry(7, 7) + entry(2, 2)) / 3.0;
        let longitudinal = [0, 4, 8].map(|a| entry(a, a)).into_iter().fold(f64::NEG_INFINITY, f64::max);
        Lame { mu, lambda: longitudinal - 2.0 * mu }
    }
}

/// What a tape gives at one deformation, and of a differential at one change of it, by columns.
fn at<const N: usize>(tape: &Tape, F: &Mat3, dF: Option<&Mat3>) -> [f64; N] {
    thread_local! {
        static MEMORY: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) };
    }
    MEMORY.with_borrow_mut(|memory| {
        if memory.len() < tape.memory_len() {
            memory.resize(tape.memory_len(), 0.0);
        }
        tape.prepare(memory);
        for (entry, number) in F.columns.iter().flat_map(|column| column.to_array()).enumerate() {
            memory[tape.deformation(entry)] = number;
        }
        let numbers = dF.into_iter().flat_map(|dF| dF.columns).flat_map(|column| column.to_array());
        for (entry, number) in numbers.enumerate() {
            memory[tape.variation(entry)] = number;
        }
        tape.run_here(Part::All, 1, memory);
        std::array::from_fn(|entry| memory[tape.output(0, entry)])
    })
}

/// The error with the path of its part and the place in that.
fn told(text: &LawText, error: &LawError) -> MaterialError {
    let path = if text.definitions.iter().any(|(name, _)| *name == error.part) {
        vec!["definitions".to_owned(), error.part.clone()]
    } else if text.parameters.iter().any(|(name, _)| *name == error.part) {
        vec!["parameters".to_owned(), error.part.clone()]
    } else {
        vec!["energy".to_owned()]
    };
    MaterialError { path, span: error.span, message: error.to_string(), others: Vec::new() }
}
