//! Laws whose parameters controls drive: parametric control (Jimenez 1993, P2-I.2.3).
//!
//! A law is made anew from the table with the numbers that controls give, once for each value. Laws that keep their parameters
//! in place, as formulas do, are copied instead: their texts are not read again.

use std::sync::{Arc, Mutex, PoisonError};

use souple_table::{Kind, Parameter, Value, Values};

use super::kernel::LinkKernel;
use super::law::{LinkEntry, Making};
use super::span::Span;
use super::written::constants;

/// What controls drive: places among the driven parameters of State.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wiring {
    /// How much of the law acts, from 0, parted, to 1.
    pub gain: Option<usize>,
    /// Parameters ([`Recipe::drivable`]), and where their values are.
    pub parameters: Vec<(String, usize)>,
}

/// Most parameters of one law that are driven.
pub const DRIVEN_PARAMETERS: usize = 8;

/// The texts of laws that hold numbers under names of the writer's choice.
const NAMED: &str = "parameters";

/// What a law of the table is made from.
#[derive(Clone, Debug)]
pub struct Recipe {
    pub entry: &'static LinkEntry,
    /// Checked by the entry.
    pub values: Values,
    /// Of the system [s].
    pub timestep: f64,
    pub span: Span,
}

/// A number of a recipe.
#[derive(Clone, Debug)]
enum Register {
    Number(&'static Parameter),
    /// One of a list.
    OfList(&'static Parameter, usize),
    Named(String),
}

impl Register {
    fn name(&self) -> String {
        match self {
            Self::Number(parameter) => parameter.name.to_owned(),
            Self::OfList(parameter, index) => format!("{}[{index}]", parameter.name),
            Self::Named(name) => name.clone(),
        }
    }
}

impl Recipe {
    /// Numbers of the law by the names that controls use: `stiffness`, `slopes[0]`, and those that the scene names.
    pub fn drivable(&self, law: &dyn LinkKernel) -> Vec<String> {
        let names = self.registers().into_iter().map(|register| register.name());
        names.filter(|name| !law.begins_with().contains(&name.as_str())).collect()
    }

    fn registers(&self) -> Vec<Register> {
        let of = |parameter: &'static Parameter| match (parameter.kind, self.values.get(parameter.name)) {
            (Kind::Number | Kind::Integer, _) => vec![Register::Number(parameter)],
            (Kind::Numbers, Some(Value::Numbers(numbers))) => {
                (0..numbers.len()).map(|i| Register::OfList(parameter, i)).collect()
            }
            (Kind::Texts, Some(Value::Texts(texts))) if parameter.name == NAMED => {
                texts.iter().map(|(name, _)| Register::Named(name.clone())).collect()
            }
            _ => Vec::new(),
        };
        self.entry.parameters.iter().flat_map(of).collect()
    }

    fn register(&self, name: &str) -> Option<Register> {
        self.registers().into_iter().find(|register| register.name() == name)
    }

    /// A number as it is written.
    pub fn written(&self, name: &str) -> Option<f64> {
        match &self.register(name)? {
            Register::Number(parameter) => match self.values.get(parameter.name)? {
                Value::Number(number) => Some(number),
                Value::Integer(number) => Some(number as f64),
                _ => None,
            },
            Register::OfList(parameter, index) => self.values.numbers(parameter.name).get(*index).copied(),
            Register::Named(name) => {
                let (names, numbers) = constants(self.values.texts(NAMED), 0, &[]).ok()?;
                names.iter().zip(numbers).find_map(|(known, number)| (known == name).then_some(number))
            }
        }
    }

    /// The law with other numbers in registers.
    ///
    /// # Errors
    /// A number out of its range, or numbers that make no law together.
    fn make(&self, numbers: &[(Register, f64)]) -> Result<Box<dyn LinkKernel>, String> {
        let mut values = self.values.clone();
        for (register, number) in numbers {
            if !number.is_finite() {
                return Err(format!("`{}` is {number}, but must be a finite number", register.name()));
            }
            match register {
                Register::Number(Parameter { name, kind: Kind::Integer, .. }) => {
                    values.set(*name, Value::Integer(number.round() as i64));
                }
                Register::Number(parameter) => values.set(parameter.name, Value::Number(*number)),
                Register::OfList(parameter, index) => {
                    let mut list = values.numbers(parameter.name).to_vec();
                    list[*index] = *number;
                    values.set(parameter.name, Value::Numbers(&list));
                }
                Register::Named(name) => {
                    let mut texts = values.texts(NAMED).to_vec();
                    let own = texts.iter_mut().filter(|(known, _)| known == name);
                    own.for_each(|(_, text)| *text = format!("{number:?}"));
                    values.set(NAMED, Value::Texts(&texts));
                }
            }
        }
        let values = self.entry.values(values).map_err(|error| error.to_string())?;
        let driven: Vec<String> = numbers.iter().map(|(register, _)| register.name()).collect();
        let making = Making { values: &values, timestep: self.timestep, span: self.span, driven: &driven };
        (self.entry.build)(&making).map_err(|error| error.to_string())
    }
}

/// A law, and what controls drive of it.
#[derive(Debug)]
pub struct DrivenLaw {
    /// As it is written.
    law: Box<dyn LinkKernel>,
    gain: Option<usize>,
    driving: Driving,
    is_conservative: bool,
}

#[derive(Debug)]
enum Driving {
    Nothing,
    /// Registers of the law ([`LinkKernel::registers`]) and places of their values.
    InPlace(Vec<(usize, usize)>),
    Anew(Anew),
}

/// A law that is made again for other numbers.
#[derive(Debug)]
struct Anew {
    recipe: Recipe,
    /// With the places of their values.
    registers: Vec<(Register, usize)>,
    /// Of links of the law as it is written.
    memory_len: usize,
    last: Mutex<Made>,
}

/// A law for some values.
#[derive(Clone, Debug)]
struct Made {
    numbers: Vec<f64>,
    law: Arc<Result<Box<dyn LinkKernel>, String>>,
}

impl From<Box<dyn LinkKernel>> for DrivenLaw {
    fn from(law: Box<dyn LinkKernel>) -> Self {
        let is_conservative = law.is_conservative();
        Self { law, gain: None, driving: Driving::Nothing, is_conservative }
    }
}

impl DrivenLaw {
    /// A law as it is made, of which at most [`DRIVEN_PARAMETERS`] are driven.
    ///
    /// # Panics
    /// If `wiring` names what is not [drivable](Recipe::drivable): callers look first.
    pub fn new(law: Box<dyn LinkKernel>, recipe: Recipe, wiring: &Wiring) -> Self {
        let gain = wiring.gain;
        if wiring.parameters.is_empty() {
            return Self { gain, ..law.into() };
        }
        let in_place = law.registers();
        let register_of = |name: &String| in_place.iter().position(|known| known == name);
        let own: Option<Vec<_>> =
            wiring.parameters.iter().map(|(name, slot)| Some((register_of(name)?, *slot))).collect();
        if let Some(registers) = own {
            return Self { gain, driving: Driving::InPlace(registers), ..law.into() };
        }
        let register =
            |name: &String| recipe.register(name).unwrap_or_else(|| panic!("`{name}` cannot be driven"));
        let registers: Vec<(Register, usize)> =
            wiring.parameters.iter().map(|(name, slot)| (register(name), *slot)).collect();
        // energy that the law of the scene keeps another number may not: a damper that is driven from nothing
        let at_work = |register: &Register| {
            recipe.written(&register.name()).filter(|number| *number != 0.0).unwrap_or(1.0)
        };
        let others: Vec<_> =
            registers.iter().map(|(register, _)| (register.clone(), at_work(register))).collect();
        let is_conservative =
            law.is_conservative() && recipe.make(&others).is_ok_and(|law| law.is_conservative());
        let last = Mutex::new(Made { numbers: Vec::new(), law: Arc::new(Err(String::new())) });
        let anew = Anew { recipe, registers, memory_len: law.memory_len(), last };
        Self { law, gain, driving: Driving::Anew(anew), is_conservative }
    }

    /// The law as it is written.
    pub fn written(&self) -> &dyn LinkKernel {
        &*self.law
    }

    /// Whether it keeps energy whatever it is driven to.
    pub fn is_conservative(&self) -> bool {
        self.is_conservative
    }

    /// How much of it acts.
    pub fn gain(&self, driven: &[f64]) -> f64 {
        self.gain.map_or(1.0, |slot| driven[slot])
    }

    /// Lends the law as it is driven; as it is written where it cannot be made, which [`DrivenLaw::fault`] tells.
    pub fn acting(&self, driven: &[f64], act: &mut dyn FnMut(&dyn LinkKernel)) {
        match &self.driving {
            Driving::Nothing => act(&*self.law),
            Driving::InPlace(registers) => {
                let mut values = [(0, 0.0); DRIVEN_PARAMETERS];
                let count = registers.len().min(DRIVEN_PARAMETERS);
                for (value, (register, slot)) in values.iter_mut().zip(registers) {
                    *value = (*register, driven[*slot]);
                }
                self.law.driven(&values[..count], act);
            }
            Driving::Anew(anew) => {
                let made = anew.made(driven);
                act(made.as_ref().as_ref().map_or(&*self.law, |law| &**law));
            }
        }
    }

    /// What of the driven numbers makes no law.
    pub fn fault(&self, driven: &[f64]) -> Option<String> {
        let Driving::Anew(anew) = &self.driving else { return None };
        anew.made(driven).as_ref().as_ref().err().cloned()
    }
}

impl Anew {
    fn made(&self, driven: &[f64]) -> Arc<Result<Box<dyn LinkKernel>, String>> {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let now = || self.registers.iter().map(|(_, slot)| driven[*slot]);
        let is_same = last.numbers.len() == self.registers.len()
            && last.numbers.iter().zip(now()).all(|(a, b)| a.to_bits() == b.to_bits());
        if !is_same {
            let registers = self.registers.iter().map(|(register, _)| register.clone());
            let numbers: Vec<_> = registers.zip(now()).collect();
            let law = self.recipe.make(&numbers).and_then(|law| self.fits(law));
            *last = Made { numbers: now().collect(), law: Arc::new(law) };
        }
        last.law.clone()
    }

    /// # Errors
    /// The law remembers other numbers than links of this one have.
    fn fits(&self, law: Box<dyn LinkKernel>) -> Result<Box<dyn LinkKernel>, String> {
        let (own, other) = (self.memory_len, law.memory_len());
        if own == other {
            return Ok(law);
        }
        Err(format!("links that remember {own} numbers became a law that remembers {other}"))
    }
}
