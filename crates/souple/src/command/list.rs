//! `souple list` and `souple describe`: what there is, from the tables.

use serde_json::{Value, json};
use souple_engine::linear;
use souple_formal::law::EnergyLaw;
use souple_mesh::ElementKind;
use souple_models::materials::{Lame, WRITTEN_LAWS, WrittenLaw};
use souple_scene::{SceneKey, SceneTable, scene_tables};
use souple_table::{Entry, Kind, Parameter, Table, readable};

use super::law_steps::Step;
use super::{End, Refusal, did_you_mean, print_json, print_line};

#[derive(clap::Args)]
pub struct ListArguments {
    /// materials, laws, elements, sections, links, modules, placements, weights, points, deformations, steppers, solvers, preconditioners,
    /// generators, bodies, shapes, skin_parts, skin_terms, skin_warps, devices, formats, quantities, functions, units, colour_maps, colour_scales
    ///
    /// The kinds themselves if left out.
    kind: Option<String>,
    #[arg(long)]
    pub json: bool,
}

#[derive(clap::Args)]
pub struct DescribeArguments {
    /// Name of a material, an element, a stepper, …, or of a key of scenes that holds a table, as `actuators`
    name: String,
    #[arg(long)]
    pub json: bool,
}

/// An entry of any table, its constructor forgotten.
struct Page {
    kind: &'static str,
    name: String,
    summary: String,
    source: &'static str,
    parameters: &'static [Parameter],
    /// A law as `souple derive --law` reads it.
    text: Option<String>,
}

fn pages_of<B>(table: &'static Table<B>) -> Vec<Page> {
    let page = |entry: &&'static Entry<B>| Page {
        kind: table.kind,
        name: entry.name.to_owned(),
        summary: entry.summary.to_owned(),
        source: entry.source,
        parameters: entry.parameters,
        text: None,
    };
    table.entries.iter().map(page).collect()
}

/// Those entries of a table that a parameter of scenes lets choose.
fn pages_chosen_by<B>(parameter: &Parameter, table: &'static Table<B>) -> Vec<Page> {
    let Kind::Choice(choices) = parameter.kind else { return pages_of(table) };
    pages_of(table).into_iter().filter(|page| choices.contains(&page.name.as_str())).collect()
}

/// What formulas may call, and the constants they may name.
fn functions() -> Vec<Page> {
    let page = |name: &str, summary: String| Page {
        kind: "function",
        name: name.to_owned(),
        summary,
        source: "",
        parameters: &[],
        text: None,
    };
    let functions = souple_formal::FUNCTIONS
        .iter()
        .map(|entry| page(entry.name, format!("{}: {}", entry.usage, entry.summary)));
    let constants =
        souple_formal::CONSTANTS.iter().map(|(name, value)| page(name, format!("the constant {value}")));
    functions.chain(constants).collect()
}

/// Laws as text, for `souple derive` and for scenes to begin with.
fn laws() -> Vec<Page> {
    let page = |law: &WrittenLaw| Page {
        kind: "law",
        name: law.name.to_owned(),
        summary: law.summary.to_owned(),
        source: law.source,
        parameters: &[],
        text: Some(law.written()),
    };
    WRITTEN_LAWS.iter().map(page).collect()
}

/// Units, with the prefixes they take.
fn units() -> Vec<Page> {
    let page = |entry: souple_formal::UnitEntry| Page {
        kind: "unit",
        name: entry.symbol.to_owned(),
        summary: match entry.prefixes.join(" ") {
            none if none.is_empty() => entry.meaning,
            prefixes => format!("{}; prefixes {prefixes}", entry.meaning),
        },
        source: "",
        parameters: &[],
        text: None,
    };
    souple_formal::units().map(page).collect()
}

/// Every table, under the plural that `list` takes.
fn tables() -> Vec<(&'static str, Vec<Page>)> {
    vec![
        ("materials", pages_of(&souple_models::materials::TABLE)),
        ("laws", laws()),
        ("elements", pages_of(&souple_mesh::ELEMENTS)),
        ("sections", pages_of(&souple_models::solids::SECTIONS)),
        ("formulations", pages_of(&souple_models::solids::FORMULATIONS)),
        ("links", pages_of(&souple_models::network::LINKS)),
        ("modules", pages_of(&souple_scene::MODULES)),
        ("placements", pages_of(&souple_models::frames::PLACEMENTS)),
        ("weights", pages_of(&souple_models::frames::WEIGHTS)),
        ("points", pages_of(&souple_models::frames::POINTS)),
        ("deformations", pages_of(&souple_models::reduced::GLOBAL_DEFORMATIONS)),
        ("steppers", pages_of(&souple_engine::steppers::TABLE)),
        ("solvers", pages_chosen_by(&linear::SOLVER, &souple_solve::solvers::TABLE)),
        ("preconditioners", pages_chosen_by(&linear::PRECONDITIONER, &souple_solve::precondition::TABLE)),
        ("generators", pages_of(&souple_mesh::GENERATORS)),
        ("bodies", pages_of(&souple_mesh::implicit::SHAPES)),
        ("shapes", pages_of(&souple_models::contact::SHAPES)),
        ("skin_parts", pages_of(&souple_skin::target::PARTS)),
        ("skin_terms", pages_of(&souple_skin::strategy::TERMS)),
        ("skin_warps", pages_of(&souple_skin::target::WARPS)),
        ("devices", pages_of(&souple_haptics::DEVICES)),
        ("formats", pages_of(&souple_io::FORMATS)),
        ("quantities", pages_of(&souple_scene::spec::quantity::QUANTITIES)),
        ("functions", functions()),
        ("units", units()),
        ("colour_maps", pages_of(&souple_io::picture::COLOUR_MAPS)),
        ("colour_scales", pages_of(&souple_io::picture::COLOUR_SCALES)),
    ]
}

pub fn list(arguments: &ListArguments) -> Result<End, Refusal> {
    let tables = tables();
    let kinds: Vec<&str> = tables.iter().map(|(plural, _)| *plural).collect();
    let Some(wanted) = arguments.kind.as_deref() else {
        if arguments.json {
            print_json(&json!(kinds));
        } else {
            kinds.iter().for_each(print_line);
        }
        return Ok(End::Done);
    };
    let found = tables
        .iter()
        .find(|(plural, pages)| *plural == wanted || pages.iter().any(|page| page.kind == wanted));
    let Some((_, pages)) = found else {
        let message = format!("there is no kind `{wanted}`{}", did_you_mean(wanted, kinds.iter().copied()));
        return Err(Refusal::request(
            "unknown_kind",
            wanted,
            format!("one of {}", kinds.join(", ")),
            message,
        ));
    };
    if arguments.json {
        print_json(&Value::Array(pages.iter().map(to_json).collect()));
        return Ok(End::Done);
    }
    let width = pages.iter().map(|page| page.name.chars().count()).max().unwrap_or(0);
    for page in pages {
        let text = page.text.as_ref().map(|text| format!(": {text}")).unwrap_or_default();
        print_line(format_args!("{:width$}  {}{text}", page.name, page.summary));
    }
    Ok(End::Done)
}

pub fn describe(arguments: &DescribeArguments) -> Result<End, Refusal> {
    if arguments.name.trim().is_empty() {
        let (expected, message) = ("a name that `souple list` prints", "no name is given");
        return Err(Refusal::request("unknown_name", "", expected, message));
    }
    let tables = tables();
    let pages: Vec<&Page> = tables.iter().flat_map(|(_, pages)| pages).collect();
    let found: Vec<&&Page> = pages.iter().filter(|page| page.name == arguments.name).collect();
    let scene_tables = scene_tables();
    let of_scenes: Vec<&SceneTable> =
        scene_tables.iter().filter(|table| table.name() == arguments.name).collect();
    if found.is_empty() && of_scenes.is_empty() {
        let known = pages.iter().map(|page| page.name.as_str());
        let hint = did_you_mean(&arguments.name, known.chain(scene_tables.iter().map(SceneTable::name)));
        let message = format!("nothing is called `{}`{hint}", arguments.name);
        return Err(Refusal::request(
            "unknown_name",
            &arguments.name,
            "a name that `souple list` prints",
            message,
        ));
    }
    if arguments.json {
        let described = found.iter().map(|page| {
            let mut document = to_json(page);
            for (key, step) in
                ["energy", "stress", "differential", "stiffness"].into_iter().zip(steps_of(page))
            {
                document[key] = step.to_json();
            }
            if let Some(moduli) = moduli_of(page) {
                document["small_strain"] = json!({
                    "lambda": moduli.lambda, "mu": moduli.mu,
                    "youngs_modulus": moduli.youngs_modulus(), "poissons_ratio": moduli.poissons_ratio(),
                });
            }
            document
        });
        print_json(&Value::Array(described.chain(of_scenes.into_iter().map(table_to_json)).collect()));
        return Ok(End::Done);
    }
    for table in of_scenes {
        print_line(format_args!("{} ({KEY_OF_SCENES} {})", table.name(), table.path));
        print_line(format_args!("  {}", table.summary));
        for key in &table.keys {
            let default = key.default.as_ref().map(|value| format!(", default {value}")).unwrap_or_default();
            print_line(format_args!("  {}: {}", key.name, key.summary));
            print_line(format_args!("      {}{default}", key.expected));
        }
    }
    for page in found {
        print_line(format_args!("{} ({})", page.name, page.kind));
        print_line(format_args!("  {}", page.summary));
        if let Some(text) = &page.text {
            print_line(format_args!("  as text: {text}"));
        }
        if let Some(moduli) = moduli_of(page) {
            print_line(format_args!(
                "  at small strain: lambda = {} Pa, mu = {} Pa; E = {} Pa, nu = {:.6}",
                readable(moduli.lambda.round()),
                readable(moduli.mu.round()),
                readable(moduli.youngs_modulus().round()),
                moduli.poissons_ratio()
            ));
        }
        if !page.source.is_empty() {
            print_line(format_args!("  source: {}", page.source));
        }
        if let Some(state) = state_of(page) {
            print_line(format_args!("  state of each link: {state}"));
        }
        for line in sets_of(page) {
            print_line(format_args!("  {line}"));
        }
        if let Some(rules) = rules_of(page) {
            print_line(format_args!("  rules of quadrature: {rules}"));
        }
        for step in steps_of(page) {
            print_line(format_args!("{}", step.to_text().trim_end()));
        }
        for parameter in page.parameters {
            let default = parameter.default.map(|value| format!(", default {value}")).unwrap_or_default();
            print_line(format_args!("  {}: {}", parameter.name, parameter.summary));
            print_line(format_args!("      {}{default}", parameter.expected()));
        }
    }
    Ok(End::Done)
}

/// What a table that scenes hold under a key is called among what is described.
const KEY_OF_SCENES: &str = "key of scenes";

fn table_to_json(table: &SceneTable) -> Value {
    let key = |key: &SceneKey| {
        json!({
            "name": key.name,
            "summary": key.summary,
            "unit": key.unit,
            "expected": key.expected,
            "default": key.default,
        })
    };
    json!({
        "name": table.name(),
        "kind": KEY_OF_SCENES,
        "path": table.path,
        "summary": table.summary,
        "source": "",
        "parameters": table.keys.iter().map(key).collect::<Vec<_>>(),
    })
}

/// How many numbers a link of a law remembers.
fn state_of(page: &Page) -> Option<String> {
    let entry = souple_models::network::LINKS.find(&page.name).ok().filter(|_| page.kind == "link")?;
    Some(match souple_models::network::state_dimension(entry) {
        Some(0) => "none, it has no memory".to_owned(),
        Some(numbers) => souple_table::counted(numbers as u64, "number"),
        None => "as many numbers as what is written needs".to_owned(),
    })
}

/// The nodes of an element, and which of them are its corners, edges and faces, by number.
fn sets_of(page: &Page) -> Vec<String> {
    let Some(kind) = ElementKind::from_name(&page.name).ok().filter(|_| page.kind == "element") else {
        return Vec::new();
    };
    let dimension = kind.dimension();
    let numbers = |nodes: &[u8]| nodes.iter().map(u8::to_string).collect::<Vec<_>>().join(" ");
    let place = |(number, node): (usize, &[f64; 3])| {
        let coordinates: Vec<String> = node[..dimension].iter().map(f64::to_string).collect();
        format!("{number} ({})", coordinates.join(", "))
    };
    let nodes: Vec<String> = kind.element().nodes.iter().enumerate().map(place).collect();
    let edges: Vec<String> = kind.edges().iter().map(|edge| numbers(edge)).collect();
    let faces: Vec<String> =
        kind.faces().iter().map(|face| format!("{} of {}", face.kind, numbers(&face.nodes))).collect();
    let last = kind.corner_count() - 1;
    let mut lines = vec![
        format!("dimension {dimension}; nodes in the reference cell: {}", nodes.join(", ")),
        format!("corners: 0 to {last}; edges between corners: {}", edges.join(", ")),
    ];
    if !faces.is_empty() {
        let what = if dimension == 2 { "sides" } else { "faces" };
        lines.push(format!("{what}, outward: {}", faces.join(", ")));
    }
    lines
}

/// The rules of quadrature of an element, with the degree of the polynomials that each integrates exactly.
fn rules_of(page: &Page) -> Option<String> {
    let kind = ElementKind::from_name(&page.name).ok().filter(|_| page.kind == "element")?;
    let rules = kind.rules().iter().map(|rule| format!("{} (degree {})", rule.name, rule.degree));
    Some(rules.collect::<Vec<_>>().join(", "))
}

/// What is derived from a law as text.
fn steps_of(page: &Page) -> Vec<Step> {
    let written = WrittenLaw::find(&page.name).filter(|_| page.kind == "law");
    // each law of the table is one, as its tests see to
    let law = written.and_then(|written| EnergyLaw::compile(&written.text().ok()?).ok());
    law.iter().flat_map(|law| Step::all(law).into_iter().chain(Step::block(law))).collect()
}

/// What a law as text is at small strain, with its parameters as printed.
fn moduli_of(page: &Page) -> Option<Lame> {
    if page.kind != "law" {
        return None;
    }
    // each law of the table is one, as its tests see to
    WrittenLaw::find(&page.name)?.small_strain().ok()
}

/// What letters the text of a material has for its parameters.
fn letters_of(page: &Page) -> &'static str {
    let has = |name: &str| page.parameters.iter().any(|parameter| parameter.name == name);
    if has("alpha") {
        "two of up to three terms, `mu1` and `a1` for the first of `mu` and `alpha`, `k` for `bulk_modulus`"
    } else if has("bulk_modulus") {
        "`k` for `bulk_modulus`"
    } else {
        "`lambda` and `mu` for Lamé's moduli"
    }
}

fn to_json(page: &Page) -> Value {
    let parameters: Vec<Value> = page
        .parameters
        .iter()
        .map(|parameter| {
            json!({
                "name": parameter.name,
                "summary": parameter.summary,
                "unit": parameter.unit,
                "expected": parameter.expected(),
                "default": parameter.default.map(|value| value.to_string()),
            })
        })
        .collect();
    let mut document = json!({
        "kind": page.kind,
        "name": page.name,
        "summary": page.summary,
        "source": page.source,
        "parameters": parameters,
    });
    let of_material = WrittenLaw::find(&page.name).filter(|_| page.kind == "material");
    if let Some(text) = page.text.clone().or_else(|| of_material.map(WrittenLaw::formula)) {
        document["text"] = json!(text);
    }
    if of_material.is_some() {
        document["letters"] = json!(letters_of(page));
    }
    if let Some(entry) = souple_models::network::LINKS.find(&page.name).ok().filter(|_| page.kind == "link") {
        document["state_dimension"] = json!(souple_models::network::state_dimension(entry));
    }
    document
}
