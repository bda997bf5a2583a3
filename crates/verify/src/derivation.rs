//! What is read of derivations: counts and errors, as `souple derive` prints them.

use std::collections::BTreeSet;
use std::sync::Mutex;

use rayon::prelude::*;
use souple_formal::element::{Cut, Derived, ElementData, ElementExpressions, Step, Steps};
use souple_formal::emit::ElementCode;
use souple_formal::law::{EnergyLaw, group_constants};
use souple_mesh::ElementKind;
use souple_models::associations::{Association, variants};
use souple_models::battery::{Battery, Trying};
use souple_models::derive::{MapKind, element_data, four_loop_operations};
use souple_models::materials::{WRITTEN_LAWS, WrittenLaw};

/// What is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// Grouped constants of the energy, added up over its fragments.
    Constants,
    /// The same of the fragment that has most of them.
    MostConstants,
    /// Constants of an element that forces and differential read, as bodies run them.
    StepConstants,
    /// Fragments of the differential.
    Fragments,
    /// Fragments of the forces.
    ForceFragments,
    /// Operations of the differential at every step, written out in numbers.
    DifferentialOperations,
    /// The same over those on another element; settings, apart by spaces, that make it another.
    DifferentialOperationsOver(&'static str),
    /// The same in tensors, as bodies run them.
    TensorOperationsOver(&'static str),
    /// Operations of forces in tensors, as bodies run them, over those of another law or element; settings, apart by spaces, that make it
    /// the other.
    TensorForcesOver(&'static str),
    /// How many times the operations of forces in tensors those of the four loops are.
    FourLoopForces,
    /// The same of the differential.
    FourLoopDifferential,
    /// How many times the operands of the differential those are that the derivation in physical coordinates gives.
    DirectOperands,
    /// Bytes of the code in Rust.
    CodeBytes,
    /// Associations of a law, an element with its rule, and a cut.
    Associations,
    /// Grouped constants of a formula.
    ConstantsOfFormula,
    /// A number of [`Battery`], the worst of all that is tried.
    Off(Trial),
}

/// A number of [`Battery`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trial {
    Force,
    Differential,
    Symmetry,
    Rigid,
    Turned,
    Balance,
    Samples,
    Fragments,
}

/// The command line that prints it; settings are its arguments, `law=linear`, and its flags, `list`.
pub fn command(settings: &[&str]) -> String {
    let argument = |setting: &&str| match setting.split_once('=') {
        Some((name, value)) if value.contains(' ') || value.contains('(') => format!(" --{name} '{value}'"),
        Some((name, value)) => format!(" --{name} {value}"),
        None => format!(" --{setting}"),
    };
    format!("souple derive{}", settings.iter().map(argument).collect::<String>())
}

/// The arguments of a derivation; of those that stand once the last counts.
#[derive(Default)]
struct Settings {
    law: Option<String>,
    element: Option<String>,
    rule: Option<String>,
    map: Option<String>,
    cut: Option<String>,
    group: Option<String>,
    varying: Vec<String>,
    trying: Trying,
}

impl Settings {
    fn read(settings: &[String]) -> Result<Self, String> {
        let mut read = Self::default();
        for setting in settings {
            let Some((name, value)) = setting.split_once('=') else {
                if matches!(setting.as_str(), "list" | "check") {
                    continue;
                }
                return Err(format!("`{setting}` is no flag of `souple derive` that rows know"));
            };
            let value = value.to_owned();
            match name {
                "law" => read.law = Some(value),
                "element" => read.element = Some(value),
                "rule" => read.rule = Some(value),
                "map" => read.map = Some(value),
                "cut" => read.cut = Some(value),
                "group" => read.group = Some(value),
                "varying" => read.varying.push(value),
                "step" | "fault" => {
                    let number = value.parse().map_err(|_| format!("`{value}` is no number"))?;
                    if name == "step" { read.trying.step = number } else { read.trying.fault = number }
                }
                _ => return Err(format!("`{name}` is no argument of `souple derive` that rows know")),
            }
        }
        Ok(read)
    }

    fn law(&self) -> Result<EnergyLaw, String> {
        let name = self.law.as_deref().unwrap_or_default();
        let written = WrittenLaw::find(name).ok_or_else(|| format!("there is no law `{name}`"))?;
        let text = written.text().map_err(|error| error.to_string())?;
        EnergyLaw::compile(&text).map_err(|error| error.explained(&text.energy))
    }

    fn kind(&self) -> Result<ElementKind, String> {
        ElementKind::from_name(self.element.as_deref().unwrap_or_default())
            .map_err(|unknown| unknown.to_string())
    }

    fn element(&self) -> Result<ElementData, String> {
        let kind = self.kind()?;
        let rule = match &self.rule {
            Some(name) => kind.rule(name).map_err(|unknown| unknown.to_string())?,
            None => kind.default_rule(),
        };
        let map = match self.map.as_deref() {
            None | Some("general") => MapKind::General,
            Some("box") => MapKind::Box,
            Some(other) => return Err(format!("there is no map `{other}`")),
        };
        element_data(kind, rule, map).map_err(|error| error.to_string())
    }

    fn derived(&self) -> Result<Derived, String> {
        let cut = self.cut.as_deref().unwrap_or("none");
        let cut = Cut::from_name(cut).ok_or_else(|| format!("there is no cut `{cut}`"))?;
        Ok(self.element()?.derive(&self.law()?, cut))
    }
}

/// The number for these arguments.
///
/// # Errors
/// What an argument is not.
pub fn count(count: Count, given: &[String]) -> Result<f64, String> {
    let settings = Settings::read(given)?;
    let number = match count {
        Count::Constants => {
            settings.derived()?.energies.iter().map(|fragment| fragment.grouped.constants.len()).sum()
        }
        Count::MostConstants => {
            let derived = settings.derived()?;
            derived.energies.iter().map(|fragment| fragment.grouped.constants.len()).max().unwrap_or(0)
        }
        Count::Fragments => settings.derived()?.differentials.len(),
        Count::ForceFragments => settings.derived()?.forces.len(),
        Count::DifferentialOperations => settings.differential_operations()?,
        Count::StepConstants => {
            let places = settings.steps()?.constant_places();
            places.forces.iter().chain(&places.differentials).flatten().collect::<BTreeSet<_>>().len()
        }
        Count::DifferentialOperationsOver(other) => {
            let other = settings_on(given, other)?.differential_operations()?;
            return Ok(settings.differential_operations()? as f64 / other as f64);
        }
        Count::TensorOperationsOver(other) => {
            let of =
                |settings: &Settings| settings.steps().map(|steps| operations(&steps, &steps.differentials));
            return Ok(of(&settings)? as f64 / of(&settings_on(given, other)?)? as f64);
        }
        Count::TensorForcesOver(other) => {
            let of = |settings: &Settings| settings.steps().map(|steps| operations(&steps, &steps.forces));
            return Ok(of(&settings)? as f64 / of(&settings_on(given, other)?)? as f64);
        }
        Count::CodeBytes => settings.derived()?.emit(ElementCode::Rust).text.len(),
        Count::Associations => {
            let is_wanted = |wanted: &Option<String>, name: &str| wanted.as_deref().is_none_or(|w| w == name);
            let associations = Association::all();
            associations
                .filter(|a| {
                    is_wanted(&settings.law, a.law.name) && is_wanted(&settings.element, a.kind.name())
                })
                .count()
        }
        Count::ConstantsOfFormula => {
            let formula = settings.group.as_deref().unwrap_or_default();
            let (_, grouped) =
                group_constants(formula, &settings.varying).map_err(|error| error.explained(formula))?;
            grouped.constants.len()
        }
        Count::DirectOperands => {
            let (derived, direct) =
                (settings.derived()?, settings.element()?.derive_directly(&settings.law()?));
            let direct = direct.ok_or("the element is no box")?;
            let ours = derived.differentials.iter().map(|fragment| fragment.operands(&derived.graph));
            return Ok(direct.operands() / ours.sum::<f64>());
        }
        Count::FourLoopForces => return settings.over_four_loops(false),
        Count::FourLoopDifferential => return settings.over_four_loops(true),
        Count::Off(trial) => return settings.worst().map(|worst| trial.of(&worst)),
    };
    Ok(number as f64)
}

/// The settings, and behind them others that are apart by spaces.
fn settings_on(given: &[String], others: &str) -> Result<Settings, String> {
    let all: Vec<String> = given.iter().cloned().chain(others.split(' ').map(str::to_owned)).collect();
    Settings::read(&all)
}

fn operations(steps: &Steps, of: &[Step]) -> usize {
    of.iter().map(|step| step.operations(&steps.graph).total()).sum()
}

impl Settings {
    /// As bodies run them.
    fn steps(&self) -> Result<Steps, String> {
        let cut = Cut::from_name(self.cut.as_deref().unwrap_or("none")).ok_or("there is no such cut")?;
        Ok(self.element()?.steps(&self.law()?, cut))
    }

    /// Operations of the differential at every step, written out in numbers.
    fn differential_operations(&self) -> Result<usize, String> {
        let derived = self.derived()?;
        let of = |fragment: &ElementExpressions| fragment.operations(&derived.graph).0.total();
        Ok(derived.differentials.iter().map(of).sum())
    }

    /// How many times the operations of forces, or of the differential, the four loops take.
    fn over_four_loops(&self, is_differential: bool) -> Result<f64, String> {
        let (kind, name) = (self.kind()?, self.law.as_deref().unwrap_or_default());
        let loops = four_loop_operations(kind, name)
            .ok_or_else(|| format!("the four loops know no {name} on {kind}"))?;
        let steps = self.steps()?;
        let ours = if is_differential { &steps.differentials } else { &steps.forces };
        Ok(loops[usize::from(is_differential)] as f64 / operations(&steps, ours) as f64)
    }

    /// The worst of all associations that are named, or of all; rows of one battery read it together.
    fn worst(&self) -> Result<Battery, String> {
        static KNOWN: Mutex<Vec<(String, Battery)>> = Mutex::new(Vec::new());
        let key = format!("{:?} {:?} {:?} {:?}", self.law, self.element, self.rule, self.trying);
        let mut known = KNOWN.lock().map_err(|_| "a row before this one broke off")?;
        if let Some((_, worst)) = known.iter().find(|(other, _)| *other == key) {
            return Ok(*worst);
        }
        let is_wanted = |wanted: &Option<String>, name: &str| wanted.as_deref().is_none_or(|w| w == name);
        let laws = WRITTEN_LAWS.iter().filter(|law| is_wanted(&self.law, law.name));
        let associations: Vec<_> = laws
            .flat_map(|law| variants().map(move |(kind, rule)| (law, kind, rule)))
            .filter(|(_, kind, rule)| {
                is_wanted(&self.element, kind.name()) && is_wanted(&self.rule, rule.name)
            })
            .collect();
        let tried: Result<Vec<Battery>, String> = associations
            .into_par_iter()
            .map(|(law, kind, rule)| {
                Battery::of(law, kind, rule, self.trying).map_err(|untried| untried.to_string())
            })
            .collect();
        let worst = tried?.into_iter().fold(Battery::default(), Battery::worse);
        known.push((key, worst));
        Ok(worst)
    }
}

impl Trial {
    fn of(self, battery: &Battery) -> f64 {
        match self {
            Self::Force => battery.force,
            Self::Differential => battery.differential,
            Self::Symmetry => battery.symmetry,
            Self::Rigid => battery.rigid,
            Self::Turned => battery.turned,
            Self::Balance => battery.balance,
            Self::Samples => battery.samples,
            Self::Fragments => battery.fragments,
        }
    }
}
