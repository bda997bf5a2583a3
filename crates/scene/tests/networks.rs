//! Networks in scenes: what they become, what is refused and what is warned of.

use std::path::Path;

use souple_models::network::LINKS;
use souple_scene::spec::units::from_algorithmic;
use souple_scene::{Scene, read_text};
use souple_table::Kind;

const HEAD: &str = "format = 1\n[world]\nperiod = \"10 ms\"\n[systems.main]\nstepper = \"t_simulation\"\n";

fn scene(text: &str) -> Result<Scene, String> {
    read_text("net.toml", &format!("{HEAD}{text}"), Path::new("."), &[]).map_err(|faults| faults.to_string())
}

fn refused(text: &str, words: &[&str]) {
    let message = scene(text).err().expect("the scene is refused");
    for word in words {
        assert!(message.contains(word), "`{word}` is not in:\n{message}");
    }
}

const TWO: &str = "[networks.n.masses.a]\npositions = [[0, 0, 0], [1, 0, 0]]\nmass = 2\n";

fn linked(links: &str) -> String {
    format!("{TWO}[[networks.n.links]]\n{links}\n")
}

const SPRING: &str = "law = { name = \"spring\", stiffness = 100 }";

/// Groups are numbered as they are written; links join what their keys say, each pair of a group once.
#[test]
fn masses_become_points_and_links_edges() {
    let text = format!(
        "{TWO}[networks.n.masses.b]\nlattice = {{ origin = [0, 1, 0], spacing = 1, counts = [3, 2, 2] }}\nmass = 0.5\n\
         velocity = [0, 0, 2]\n[networks.n]\nvelocity = [1, 0, 0]\n\
         [[networks.n.links]]\n{SPRING}\nof = [\"b\"]\nreach = 1.01\n\
         [[networks.n.links]]\n{SPRING}\nof = [\"a\", \"b\"]\nall = true\n\
         [[networks.n.links]]\n{SPRING}\nof = [\"a\"]\nchain = true\nrest_length = 0.9\n"
    );
    let scene = scene(&text).unwrap();
    let body = &scene.bodies[0];
    assert_eq!(body.mesh.points.len(), 14);
    // 12 nodes of a 3 x 2 x 2 lattice have 20 edges; 2 x 12 pairs; 1
    assert_eq!(body.mesh.cell_count(), 20 + 24 + 1);
    assert_eq!(body.mesh.groups["b"].points, (2..14).collect::<Vec<u32>>());
    let state = &scene.state.systems[0];
    assert_eq!(state.v[0].to_array(), [1.0, 0.0, 0.0]);
    assert_eq!(state.v[13].to_array(), [1.0, 0.0, 2.0]);
    let mass = &scene.model.systems[0].mass.diagonal;
    assert_eq!((mass[1], mass[2]), (2.0, 0.5));
}

#[test]
fn wrong_networks_are_refused_in_words() {
    refused(
        &linked(&format!("{SPRING}\nof = [\"c\"]\nchain = true")),
        &["no group of masses `c`", "one of a"],
    );
    refused(&linked(&format!("{SPRING}\nfrom = [0]\nto = [2]")), &["to[0] is mass 2", "numbers below 2"]);
    refused(&linked(&format!("{SPRING}\nfrom = [1]\nto = [1]")), &["joins mass 1 to itself", "two masses"]);
    refused(&linked(&format!("{SPRING}\nfrom = [0, 1]\nto = [1]")), &["not as many"]);
    refused(&linked(&format!("{SPRING}\nreach = 0.5")), &["no masses are joined"]);
    refused(&linked(&format!("{SPRING}\nchain = true\nall = true")), &["in one way", "chain and all"]);
    refused(&linked("law = \"sprung\"\nchain = true"), &["no link `sprung`"]);
    refused(
        &linked(
            "law = { name = \"cohesion\", distance = 1, peak = 0.9, range = 2, cohesion = 5 }\nchain = true",
        ),
        &["`peak` is 0.9", "greater than `distance`"],
    );
    refused(&TWO.replace("mass = 2", "mass = 0"), &["0 is out of range"]);
    refused(
        &TWO.replace("mass = 2", "mass = 2\nline = { from = [0, 0, 0], to = [1, 0, 0], count = 3 }"),
        &["start in one way"],
    );
    refused(
        &TWO.replace("positions = [[0, 0, 0], [1, 0, 0]]", "lattice = { spacing = 1, counts = [2, 0, 1] }"),
        &["lattice of (2, 0, 1)"],
    );
}

/// Links name points of view as they name groups; what these cannot see is refused.
#[test]
fn points_of_view_are_checked() {
    let seen = |view: &str, rest: &str| {
        linked(&format!(
            "{SPRING}\nof = [\"v\", \"a\"]\nall = true\nrest_length = 1\n{rest}\n[networks.n.views.v]\n{view}\n"
        ))
    };
    let good = scene(&seen("of = \"a\"\nkind = \"scale\"\nfactor = 3", "")).unwrap();
    assert_eq!(good.bodies[0].mesh.points.len(), 2, "points of view are no masses");
    refused(&seen("of = \"b\"\nkind = \"mean\"", ""), &["`b`"]);
    refused(&seen("of = \"a\"\nkind = \"mean\"\nweights = [1]", ""), &["1 weights of 2 masses"]);
    refused(&seen("of = \"a\"\nkind = \"cylinder\"\naxis = [0, 0, 0]", ""), &["an axis of no length"]);
    refused(
        &seen("of = \"a\"\nkind = \"frame\"\nmoving_with = \"c\"", ""),
        &["no group of masses `c`", "one of a"],
    );
    refused(&seen("of = \"a\"\nkind = \"mirror\"", ""), &["mirror", "scale"]);
    let crowd =
        "[[networks.n.crowds]]\nof = [\"v\"]\nlaw = { name = \"ball\", threshold = 0.1, stiffness = 1 }";
    refused(&seen("of = \"a\"\nkind = \"scale\"", crowd), &["points of view do not come near"]);
}

/// A lattice keeps the masses where its condition holds, in their order; none, and more than can be asked about, are refused.
#[test]
fn lattices_keep_what_is_within() {
    let ball = |within: &str, counts: &str| {
        format!(
            "[networks.n.masses.a]\nlattice = {{ origin = [-2, -2, -2], spacing = 1, counts = {counts}, within = \"{within}\" }}\nmass = 1\n"
        )
    };
    let kept = scene(&ball("x^2 + y^2 + z^2 <= 1", "[5, 5, 5]")).unwrap();
    // the middle and its six neighbours
    let body = &kept.bodies[0];
    assert_eq!(body.mesh.points.len(), 7);
    assert!(body.mesh.points.iter().all(|p| p.length() < 1.5));
    refused(&ball("x > 10", "[5, 5, 5]"), &["none of the 125 masses"]);
    refused(&ball("x > 10", "[300, 300, 300]"), &["at most 1e7"]);
    refused(&ball("x > w", "[5, 5, 5]"), &["w"]);
}

/// What no memory holds is refused before it is made, in all the ways that a network grows.
#[test]
fn networks_that_no_memory_holds_are_refused() {
    let lattice = |name: &str, counts: &str| {
        format!(
            "[networks.n.masses.{name}]\nlattice = {{ spacing = 1e-9, counts = {counts} }}\nmass = 1e-9\n"
        )
    };
    let cube = lattice("a", "[100, 100, 100]");
    let links = |how: &str| format!("{cube}[[networks.n.links]]\n{SPRING}\n{how}\n");
    refused(
        &format!("{}{}", lattice("a", "[1000, 1000, 60]"), lattice("b", "[1000, 1000, 60]")),
        &["120000000 masses", "at most 1e8"],
    );
    // 5e11 links of 80 bytes
    refused(&links("all = true"), &["needs at least 40000.5 GB", "1000000 masses", "499999500000 links"]);
    refused(&links("reach = 1"), &["links of at most 1 m", "a shorter reach"]);
    let crowd = |law: &str| format!("[[networks.n.crowds]]\nlaw = {{ {law} }}\n");
    let ball = crowd("name = \"ball\", threshold = 1, stiffness = 1");
    refused(&format!("{cube}{ball}"), &["more pairs", "a shorter range"]);
    // who is near whom is all that a crowd tells its law
    let placed = crowd(
        "name = \"conditional\", stiffness = 1, states = { free = \"SUP, X1.x, 0.5 -> held\", held = \"CHK, 0\" }",
    );
    refused(&format!("{cube}{placed}"), &["asks where the ends are", "or `links`"]);
    refused(&linked(&format!("{SPRING}\nchain = false")), &["`chain = false` joins nothing"]);
    refused(&linked(&format!("{SPRING}\nreach = 1e-300")), &["no masses are joined"]);
}

/// Two free masses of 2 kg on a spring bear `k Te² < 2 · 2 kg`.
#[test]
fn unstable_networks_are_warned_of() {
    let with = |stiffness: f64| {
        linked(&format!("law = {{ name = \"spring\", stiffness = {stiffness} }}\nchain = true"))
    };
    let warnings = |stiffness| scene(&with(stiffness)).unwrap().warnings.join("\n");
    assert_eq!(warnings(39_999.0), "");
    let said = warnings(40_001.0);
    assert!(said.contains("network `n`") && said.contains("may be unstable"), "{said}");
    let together = TWO.replace("[1, 0, 0]", "[0, 0, 0]");
    let said = scene(&format!("{together}[[networks.n.links]]\n{SPRING}\nchain = true\n")).unwrap().warnings;
    assert!(said[0].contains("masses 0 and 1") && said[0].contains("no direction"), "{said:?}");
}

/// Masses that are near each other from the start on store energy before the first step: `½ k (threshold − d)²` for each pair of
/// neighbours of a lattice.
#[test]
fn crowds_have_their_energy_from_the_start_on() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/skin_drop/scene.toml");
    let scene = souple_scene::read_file(&path, &[]).unwrap_or_else(|errors| panic!("{errors}"));
    let energies = scene.model.start(scene.state).energy().by_force;
    let stored: f64 =
        energies.iter().filter(|(name, _)| name.contains("crowds")).map(|(_, e)| e.stored).sum();
    let pairs = f64::from(11 * 4 * 4 + 2 * 12 * 3 * 4);
    let expected = pairs * 0.5 * 8.0 * 0.002_f64.powi(2);
    // differences of places that are a hundred times as far from the origin as neighbours overlap
    assert!((stored / expected - 1.0).abs() < 1e-10, "{stored} J, not {expected} J");
}

/// Along an axis rest lengths are what the masses are apart along it where they rest, with their sign; the start is displaced
/// from there, and an axis has any length but none.
#[test]
fn links_along_an_axis() {
    let text = format!(
        "{TWO}[networks.n]\nstart = {{ displacement = [0, 0, \"0.25 * x\"] }}\n\
         [[networks.n.links]]\n{SPRING}\nchain = true\nalong = [0, 0, 4]\naccount = 1\n"
    );
    refused(&text, &["account"]);
    let mut world = {
        let Scene { model, state, .. } = scene(&text.replace("account = 1\n", "")).unwrap();
        model.start(state)
    };
    // 100 N/m stretched by 0.25 m
    assert!((world.energy().total() - 3.125).abs() < 1e-14);
    refused(
        &linked(&format!("{SPRING}\nchain = true\nalong = [0, 0, 0]")),
        &["an axis of no length", "[0, 0, 1]"],
    );
}

/// What a probe is drawn over is another of one number, or of as many; anything else is refused in words.
#[test]
fn probes_are_drawn_over_others() {
    let over = |of: &str, name: &str| {
        let probes = "[probes.one]\nbody = \"n\"\nregion = \"a\"\nquantity = \"velocity\"\ncomponent = \"x\"\n\
                      [probes.all]\nbody = \"n\"\nquantity = \"velocity\"\n\
                      [probes.way]\nbody = \"n\"\nquantity = \"displacement\"\n";
        let head = format!("[probes.{of}]\n");
        let probes = probes.replace(&head, &format!("{head}over = \"{name}\"\n"));
        let text = format!("{HEAD}{TWO}{probes}");
        read_text("net.toml", &text, Path::new("."), &[]).map_err(|faults| faults.to_string())
    };
    for (of, name) in [("all", "one"), ("all", "way")] {
        let scene = over(of, name).unwrap();
        let probe = scene.probes.iter().find(|probe| probe.name == of).unwrap();
        assert_eq!(probe.over.as_deref(), Some(name));
    }
    let refused = |of: &str, name: &str, words: &[&str]| {
        let message = over(of, name).err().expect("the probe is refused");
        assert!(words.iter().all(|word| message.contains(word)), "{words:?} not in:\n{message}");
    };
    refused("one", "all", &["probes.one.over", "`all` gives a vector", "a `component`"]);
    refused("one", "way", &["`way` gives a vector, and `one` a number"]);
    refused("one", "one", &["no other probe `one`", "one of all, way"]);
    refused("one", "al", &["no other probe `al`", "all"]);
}

/// The rate of a sound is that of the periods where it is a whole number; what cannot be heard is refused in words.
#[test]
fn sounds_are_probes_at_a_rate() {
    let probes = "[probes.one]\nbody = \"n\"\nregion = \"a\"\nquantity = \"velocity\"\ncomponent = \"x\"\n\
                  [probes.all]\nbody = \"n\"\nquantity = \"velocity\"\n";
    let with = |period: &str, sound: &str| {
        let text = format!("{HEAD}{TWO}{probes}[sounds.s]\n{sound}\n");
        let text = text.replace("period = \"10 ms\"", &format!("period = {period}"));
        read_text("net.toml", &text, Path::new("."), &[]).map_err(|faults| faults.to_string())
    };
    let sound = |period: &str, every: u32| {
        with(period, &format!("probes = [\"one\", \"one\"]\nevery = {every}")).unwrap().sounds[0].clone()
    };
    assert_eq!(sound("\"10 ms\"", 1).rate, 100);
    // 88.2 kHz, rounded to ten digits, and every second of them
    assert_eq!((sound("1.133786848e-5", 1).rate, sound("1.133786848e-5", 2).rate), (88_200, 44_100));
    let refused = |period: &str, text: &str, words: &[&str]| {
        let message = with(period, text).err().expect("the sound is refused");
        assert!(words.iter().all(|word| message.contains(word)), "{words:?} not in:\n{message}");
    };
    refused("\"3 ms\"", "probes = [\"one\"]", &["sounds.s", "0.003 s", "a whole number from 1 to 192000"]);
    refused("1e-6", "probes = [\"one\"]", &["1000000 samples", "`every` above 1"]);
    assert_eq!(sound("1e-6", 8).rate, 125_000);
    refused("1", "probes = [\"all\"]", &["gives a vector", "a `component`"]);
    refused("1", "probes = [\"onne\"]", &["no probe `onne`", "one"]);
    refused("1", "probes = [\"one\", \"one\", \"one\"]", &["a sound of 3 probes", "left and right"]);
    refused("1", "probes = [\"one\"]\ngain = 0", &["gain"]);
    refused("1", "probes = [\"one\"]\nsamples = \"mp3\"", &["int16", "float32"]);
}

/// What a network is made of is told: masses, links by law, the numbers that they remember, and both spaces of parameters.
#[test]
fn networks_are_told() {
    let text = format!(
        "{TWO}[networks.n.masses.nail]\npositions = [[0, 1, 0]]\nmass = 1\nfixed = true\n\
         [[networks.n.links]]\nlaw = {{ name = \"spring_damper\", stiffness = 100, damping = 0.5 }}\nof = [\"a\"]\nchain = true\n\
         [[networks.n.links]]\nlaw = {{ name = \"maxwell\", stiffness = 10, viscosity = 2 }}\nof = [\"a\", \"nail\"]\nall = true\n"
    );
    let told = scene(&text).unwrap().networks;
    let [network] = &told[..] else { panic!("one network") };
    assert_eq!((network.masses, network.fixed, network.link_count(), network.memory()), (3, 1, 3, 2));
    assert_eq!(network.lightest, Some(2.0));
    assert!(network.category().contains("functional"));
    let spring = &network.laws[0];
    // K + 2 z/Te
    assert!((spring.stiffest.unwrap() - 200.0).abs() < 1e-12);
    let (name, unit, physical, algorithmic) = spring.parameters[1];
    assert_eq!((name, unit, physical), ("damping", "N s/m", 0.5));
    assert!((algorithmic - 50.0).abs() < 1e-12);
    assert_eq!(network.laws[1].remembers, 1);
}

/// A network of a core, flesh around it and a floor, with more keys of their object.
fn fruit(more: &str) -> String {
    let group = |name: &str, x: f64| {
        format!("[networks.n.masses.{name}]\npositions = [[{x}, 0, 0], [{x}, 1, 0]]\nmass = 1\n")
    };
    let ball = "{ name = \"ball\", threshold = 0.5, stiffness = 10 }";
    format!(
        "{}{}{}[networks.n.objects.fruit]\nkernel = [\"core\"]\ndermis = [\"flesh\"]\ncentring = {ball}\nmatter = {ball}\n{more}\n\
         [[networks.n.encounters]]\nlaw = {ball}\n",
        group("core", 0.0),
        group("flesh", 1.0),
        group("floor", 2.0)
    )
}

/// What layers save is told: of two masses each, core and flesh act on each other, flesh on itself and on the floor; the core
/// alone does not meet it.
#[test]
fn saved_pairs_are_told() {
    let told = |more: &str| scene(&fruit(more)).unwrap().networks[0].pairs();
    assert_eq!(told(""), [4 + 1 + 4, 4 + 1 + 8]);
    assert_eq!(told("breakable = true"), [4 + 1 + 8; 2]);
}

/// Layers become crowds of their groups; things meet by their outermost layers alone, unless they may break.
#[test]
fn objects_become_crowds() {
    let names = |more: &str| -> Vec<String> {
        let scene = scene(&fruit(more)).unwrap();
        scene.model.systems[0].forces.iter().map(|force| force.name().to_owned()).collect()
    };
    let within = ["n.fruit.centring", "n.fruit.matter"];
    assert_eq!(names(""), [&within[..], &["n.encounters[0]"]].concat());
    let all = ["n.encounters[0][0]", "n.encounters[0][1]"];
    assert_eq!(names("breakable = true"), [&within[..], &all].concat());
    refused(&fruit("epidermis = [\"peal\"]"), &["no group of masses `peal`", "core, flesh, floor"]);
    refused(&fruit("epidermis = [\"core\"]"), &["`core` is in a layer already"]);
}

/// Balls fill a shape, a ring closes, and what has no end, or no room, is refused.
#[test]
fn shapes_are_filled_and_polygons_close() {
    let filled = |fill: &str| format!("[networks.n.masses.a]\nfill = {fill}\nmass = 1\n");
    let ball = "{ shape = { name = \"sphere\", radius = 1 }, spacing = 0.5 }";
    let points = scene(&filled(ball)).unwrap().bodies[0].mesh.points.clone();
    assert!(points.len() > 20 && points.iter().all(|point| point.length() <= 0.75 + 1e-6));
    refused(&filled("{ shape = \"plane\", spacing = 0.5 }"), &["has no end", "box ="]);
    refused(&filled(&ball.replace("0.5", "3")), &["no ball of this size has room"]);
    refused(&filled("{ spacing = 0.5 }"), &["one thing is filled", "`shape`, or `mesh`"]);
    let ring = "[networks.n.masses.a]\npolygon = { corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], count = 6 }\nmass = 1\n";
    let text = format!("{ring}[[networks.n.links]]\n{SPRING}\nloop = true\n");
    let body = &scene(&text).unwrap().bodies[0];
    assert_eq!((body.mesh.points.len(), body.mesh.cell_count()), (6, 6));
}

/// Contours are no finer than their balls bear: grids as fine as that would fill any memory.
#[test]
fn contours_far_too_fine_are_refused() {
    let contour = |way: &str, more: &str| {
        format!("{TWO}[networks.n.contours.edge]\n{way} = [\"a\"]\nradius = 0.5\n{more}\n")
    };
    refused(&contour("frontier", "step = 1e-6"), &["5.500e5 times", "at least 0.00055 m"]);
    refused(&contour("frontier", "probe = 1e6"), &["`radius` and `probe` together"]);
    refused(&contour("scan", "step = 1e-9"), &["into `radius`, 0.5 m", "at least 0.0005 m"]);
    assert!(scene(&contour("scan", "step = 0.001")).is_ok());
}

/// A whole item may be put behind the last one of a list, and no further; of an item that is not there no key is set.
#[test]
fn items_are_appended_to_lists() {
    let text = format!("{HEAD}{TWO}[[networks.n.pins]]\nregion = {{ points = [0] }}\n");
    let read = |set: &str| {
        let settings = [format!("networks.n.{set}")];
        read_text("net.toml", &text, Path::new("."), &settings).map_err(|faults| faults.to_string())
    };
    let both = read("pins[1]={ region = { points = [1] }, axes = \"x\" }").unwrap();
    assert_eq!(both.model.systems[0].constraints.len(), 2);
    let message = read("pins[2]={ region = \"a\" }").err().unwrap();
    assert!(message.contains("an index below 1, or 1 for one more"), "{message}");
    let message = read("pins[1].axes=x").err().unwrap();
    assert!(message.contains("an index below 1") && !message.contains("one more"), "{message}");
}

/// Where a scene's first system stands after some periods: places and velocities.
fn moved(text: &str, periods: usize) -> Vec<f64> {
    let Scene { model, state, .. } = scene(text).unwrap_or_else(|faults| panic!("{faults}\n{text}"));
    let mut world = model.start(state);
    (0..periods).for_each(|_| world.step().expect("a step"));
    let rows = world.rows(0);
    rows.positions.iter().chain(&rows.velocities).flat_map(|row| row.to_array()).collect()
}

/// The same numbers up to the rounding of units, which motions of order 1 take up a few hundred times.
fn assert_same_motion(what: &str, physical: &str, algorithmic: &str) {
    let [a, b] = [physical, algorithmic].map(|text| moved(text, 40));
    let start = moved(physical, 0);
    let differ = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(differ(&a, &b) < 1e-9, "{what}: {a:?} in SI units, {b:?} counted in steps");
    assert!(differ(&a, &start) > 1e-3, "{what} does not move");
}

/// A model is the same in both spaces: with every number of every law, and of friction.
#[test]
fn both_spaces_give_one_motion() {
    let step = 0.01;
    let list = |numbers: &[f64], unit: &str, is_physical: bool| {
        let factor = if is_physical { 1.0 } else { from_algorithmic(unit, step) };
        let words: Vec<String> = numbers.iter().map(|number| format!("{:e}", number / factor)).collect();
        words.join(", ")
    };
    let net = |is_physical: bool, rest: &str| {
        let of = |number: f64, unit: &str| list(&[number], unit, is_physical);
        format!(
            "[networks.n]\nspace = \"{}\"\n[networks.n.masses.a]\npositions = [[0, 0, 0]]\nmass = {}\nvelocity = [{}, {}, 0]\n\
             [networks.n.masses.b]\npositions = [[0.9, 0.1, 0]]\nmass = {}\ndrag = {}\n{rest}",
            if is_physical { "physical" } else { "algorithmic" },
            of(2.0, "kg"),
            of(0.7, "m/s"),
            of(0.9, "m/s"),
            of(3.0, "kg"),
            of(0.1, "N s/m"),
        )
    };
    for entry in LINKS.entries {
        let is_written = |kind: Kind| matches!(kind, Kind::Text | Kind::Texts);
        if entry.parameters.iter().any(|parameter| is_written(parameter.kind)) {
            continue;
        }
        let links = |is_physical: bool| {
            let said = entry.parameters.iter().enumerate().filter_map(|(index, parameter)| {
                let (name, unit) = (parameter.name, parameter.unit);
                match parameter.kind {
                    _ if parameter.default.is_some() && from_algorithmic(unit, step) == 1.0 => None,
                    // thresholds ascend as they are told
                    Kind::Number => {
                        Some(format!("{name} = {}", list(&[1.0 + index as f64], unit, is_physical)))
                    }
                    Kind::Numbers => {
                        // a piece more than thresholds
                        let count = if name == "slopes" { 3 } else { 2 };
                        Some(format!("{name} = [{}]", list(&[1.0, 2.0, 0.0][..count], unit, is_physical)))
                    }
                    // of another kind no number has a time or a mass in its unit
                    _ => {
                        assert_eq!(from_algorithmic(unit, step), 1.0, "{}.{name}", entry.name);
                        None
                    }
                }
            });
            let law: Vec<String> = said.collect();
            let law = format!("{{ name = \"{}\", {} }}", entry.name, law.join(", "));
            net(is_physical, &format!("[[networks.n.links]]\nlaw = {law}\nof = [\"a\", \"b\"]\nall = true\n"))
        };
        assert_same_motion(entry.name, &links(true), &links(false));
    }
    let rubbed = |is_physical: bool, sliding: &str| {
        let of = |number: f64, unit: &str| list(&[number], unit, is_physical);
        net(
            is_physical,
            &format!(
                "[[networks.n.crowds]]\nlaw = {{ name = \"ball\", threshold = 1, stiffness = {}, damping = {} }}\n\
                 friction = {{ static = 0.6, kinetic = 0.3, stiffness = {}, damping = {}, speed = {}, {sliding} }}\n",
                of(80.0, "N/m"),
                of(0.5, "N s/m"),
                of(300.0, "N/m"),
                of(0.4, "N s/m"),
                of(0.02, "m/s"),
            ),
        )
    };
    let falling = |is_physical: bool| {
        let of = |number: f64, unit: &str| list(&[number], unit, is_physical);
        let (fall, growth) = (of(0.2, "m/s"), of(0.05, "s/m"));
        rubbed(
            is_physical,
            &format!("fall = {fall}, growth = {growth}, hook_viscosity = {}", of(6.0, "N s/m")),
        )
    };
    assert_same_motion("friction that falls and grows", &falling(true), &falling(false));
    let curved = |is_physical: bool| {
        let speeds = list(&[0.0, 0.3, 0.8], "m/s", is_physical);
        rubbed(is_physical, &format!("speeds = [{speeds}], coefficients = [0.5, 0.2, 0.4]"))
    };
    assert_same_motion("friction by a curve", &curved(true), &curved(false));
}

/// A heap is as stiff as the neighbours that a ball may have in it: `2 · 12 (K + 2 z/Te) < 4 m/Te²` in space, half as many in a
/// plane, and those that there are where they are fewer.
#[test]
fn stiff_crowds_are_warned_of() {
    let heap = |count: usize, stiffness: f64, more: &str| {
        let text = format!(
            "[networks.n]\nvelocity = [0, 1, {}]\n[networks.n.masses.a]\nline = {{ from = [0, 0, 0], to = [{count}, 0, 0], count = {count} }}\nmass = 3\n{more}\
             [[networks.n.crowds]]\nlaw = {{ name = \"ball\", threshold = 0.5, stiffness = {stiffness} }}\n",
            u8::from(!more.contains("pins"))
        );
        scene(&text).unwrap().warnings.join("\n")
    };
    let plane = "[[networks.n.pins]]\nregion = \"a\"\naxes = \"z\"\n";
    // 4 m/Te² = 120 000 N/m
    for (count, more, most) in [(20, "", 5000.0), (20, plane, 10_000.0), (4, "", 20_000.0)] {
        assert_eq!(heap(count, most - 1.0, more), "", "{count} balls");
        let said = heap(count, most + 1.0, more);
        let neighbours = (60_000.0 / most).round();
        let words = [
            format!("{neighbours} in crowd `n.crowds[0]`"),
            "at mass 0 of network `n`".to_owned(),
            "may be unstable".to_owned(),
        ];
        assert!(words.iter().all(|words| said.contains(words)), "{said}");
    }
    let ground = "[networks.n.masses.g]\npositions = [[0, 5, 0]]\nmass = 1\nfixed = true\n";
    // one free neighbour and one that is fixed
    assert_eq!(heap(2, 39_999.0, ground), "");
    assert!(heap(2, 40_001.0, ground).contains("2 in crowd"));
    // a law that is written: its steepest slope
    let written = |stiffness: f64| {
        let text = format!(
            "{TWO}[[networks.n.crowds]]\nrange = 0.5\nlaw = {{ name = \"formula\", push = \"if(D < 0.45, {stiffness} * (0.45 - D), 0)\" }}\n"
        );
        scene(&text).unwrap().warnings.join("\n")
    };
    assert_eq!(written(39_999.0), "");
    assert!(written(40_001.0).contains("may be unstable"));
}

/// Masses of a crowd that start at one place are named, by the first and how many places more there are.
#[test]
fn masses_at_one_place_are_told() {
    let with = |of: &str, fixed: bool| {
        let text = format!(
            "[networks.n.masses.a]\npositions = [[0, 0, 0], [1, 0, 0], [2, 0, 0]]\nmass = 1\nfixed = {fixed}\n\
             [networks.n.masses.b]\npositions = [[5, 0, 0], [1, 0, 0], [-0.0, 0, 0]]\nmass = 1\nfixed = {fixed}\n\
             [[networks.n.crowds]]\n{of}law = {{ name = \"ball\", threshold = 0.5, stiffness = 1 }}\n"
        );
        scene(&text).unwrap().warnings.join("\n")
    };
    for of in ["", "of = [\"a\", \"b\"]\n", "of = [\"b\", \"a\"]\n"] {
        let said = with(of, false);
        let words =
            ["masses 0 (`a` 0) and 5 (`b` 2) of network `n` start at one place", "1 place more", "crowds[0]"];
        assert!(words.iter().all(|words| said.contains(words)), "{said}");
        assert_eq!(with(of, true), "");
    }
    assert_eq!(with("of = [\"a\"]\n", false), "");
}

/// Masses so near to each other that rounding tells the direction between them are told as those at one place are: nearer than the
/// last digit of their places, or than half the digits of the distance that a law wants between them. Nearer still is no fault where
/// the law wants them that near.
#[test]
fn masses_lost_in_rounding_are_told() {
    let said = |links: &str, place: &str| {
        let text = format!(
            "[networks.n.masses.a]\npositions = [[{place}, 0, 0], [{place}, 1, 0], [{place}, 0, 1]]\nmass = 1\n\
             [networks.n.masses.b]\npositions = [[{place}, 0, 1e-14]]\nmass = 1\n{links}"
        );
        scene(&text).unwrap().warnings.join("\n")
    };
    let crowd = "[[networks.n.crowds]]\nlaw = { name = \"ball\", threshold = 0.5, stiffness = 1 }\n";
    let link = |rest: &str| {
        format!(
            "[[networks.n.links]]\nlaw = {{ name = \"spring\", stiffness = 1 }}\nof = [\"a\", \"b\"]\nfrom = [0]\nto = [0]\n{rest}"
        )
    };
    for place in ["0", "1"] {
        for (links, named) in
            [(crowd.to_owned(), ["0 (`a` 0)", "3 (`b` 0)"]), (link("rest_length = 0.5"), ["0", "3"])]
        {
            let said = said(&links, place);
            let [a, b] = named;
            let words = format!(
                "masses {a} and {b} of network `n` start 1.0e-14 m from each other, which is lost in rounding"
            );
            assert!(said.contains(&words) && said.contains("no direction"), "{said}");
        }
        // they are as far apart as the link is long
        assert!(!said(&link(""), place).contains("rounding"));
    }
    // 2^-46 m is the last digit of 100 m
    assert!(said(&link(""), "100").contains("lost in rounding"));
    let apart = crowd.replace("0.5", "1e-7");
    assert_eq!([said(&apart, "0"), said(&apart, "100")].map(|said| said.contains("rounding")), [false, true]);
}

/// Along an axis lengths have a sign, so that a dead zone lies about 0: a mass inside drifts on, and is turned back beyond. In space
/// they have none.
#[test]
fn dead_zones_about_zero() {
    let link = |along: &str| {
        linked(&format!(
            "law = {{ name = \"piecewise_linear\", thresholds = [-0.01, 0.01], slopes = [-100, 0, -100], zero = 0 }}\nchain = true\n{along}"
        ))
        .replace("[[0, 0, 0], [1, 0, 0]]", "[[0.008, 0, 0], [0, 1, 0]]")
    };
    let [start, end] = [0, 20].map(|periods| moved(&link("along = [1, 0, 0]"), periods));
    // slopes that cancel do so up to rounding: 1e-18 N
    assert!(start.iter().zip(&end).all(|(a, b)| (a - b).abs() < 1e-15), "no force within: {end:?}");
    let out = link("along = [1, 0, 0]").replace("0.008", "-0.03");
    assert!(moved(&out, 1)[0] > -0.03, "pushed back from the other side");
    refused(&link(""), &["`thresholds` is [-0.01, 0.01]", "never below 0", "along"]);
    let zero = link("").replace("[-0.01, 0.01]", "[0, 0.01]").replace("zero = 0", "zero = -1");
    refused(&zero, &["`zero` is -1"]);
}

/// Transitions that ask for what no distance is are refused in space, and stand along an axis.
#[test]
fn transitions_that_never_fire() {
    let link = |law: &str, along: &str| linked(&format!("law = {{ {law} }}\nchain = true\n{along}"));
    let axis = "along = [1, 0, 0]";
    let of = |condition: &str| {
        format!(
            "name = \"finite_state\", states = {{ a = \"0\", b = \"1\" }}, transitions = {{ \"a -> b\" = \"{condition}\" }}"
        )
    };
    refused(&link(&of("D < 0"), ""), &["states.a", "to `b` that never fires", "`D < 0`", "not below 0"]);
    refused(&link(&of("D > 2 and D < 1"), axis), &["to `b` that never fires", "whatever happens"]);
    assert!(scene(&link(&of("D < 0"), axis)).is_ok());
    let below = "name = \"conditional\", stiffness = 1, states = { a = \"INF, D, 0 -> b\", b = \"CHK, 0\" }";
    refused(&link(below, ""), &["states.a", "to `b` that never fires", "`D` is a distance"]);
    assert!(scene(&link(below, axis)).is_ok());
}

/// Probes name one constraint or one crowd of several: what each does adds up to what all do, and a name that is none is refused with those that are.
#[test]
fn probes_name_constraints() {
    let network = "[world]\nperiod = \"1 ms\"\ngravity = [0, 0, -10]\n[systems.main]\nstepper = \"t_simulation\"\n\
                   [networks.n.masses.a]\npositions = [[0, 0, 0]]\nmass = 2\n\
                   [networks.n.masses.b]\npositions = [[1, 0, 0]]\nmass = 3\n\
                   [[networks.n.constraints]]\nname = \"low\"\nof = [\"a\"]\nplane = { place = [0, 0, 0], normal = [0, 0, 1] }\nsense = \"at_least\"\n\
                   [[networks.n.constraints]]\nof = [\"b\"]\nplane = { place = [0, 0, 0], normal = [0, 0, 1] }\nsense = \"at_least\"\n\
                   [[networks.n.constraints]]\nname = \"guide\"\nline = { direction = [0, 0, 1] }\n";
    let probe = |name: &str, quantity: &str, more: &str| {
        format!("[probes.{name}]\nbody = \"n\"\nquantity = \"{quantity}\"\n{more}\n")
    };
    let read = |probes: &str| {
        let text = format!("format = 1\n{network}{probes}");
        read_text("net.toml", &text, Path::new("."), &[]).map_err(|faults| faults.to_string())
    };
    let probes = [
        probe("low", "contact_force", "contact = \"n.low\""),
        probe("other", "contact_force.normal", "contact = \"n.constraints[1]\""),
        probe("all", "contact_force", ""),
        probe("guide", "constraint_force", "constraint = \"n.guide\""),
    ];
    let scene = read(&probes.concat()).unwrap();
    let mut world = scene.model.start(scene.state);
    (0..5).for_each(|_| {
        world.step().unwrap();
    });
    let lifted: Vec<f64> = scene.probes.iter().map(|probe| probe.measure(&mut world).numbers()[2]).collect();
    for (found, wanted) in lifted.iter().zip([20.0, 30.0, 50.0, 0.0]) {
        // contacts are found to a ten-millionth of what a step would enter
        assert!((found - wanted).abs() < 1e-4, "{lifted:?}");
    }
    let refused = |quantity: &str, more: &str, words: &[&str]| {
        let message = read(&probe("p", quantity, more)).err().expect("the probe is refused");
        assert!(words.iter().all(|word| message.contains(word)), "{words:?} not in:\n{message}");
    };
    refused(
        "contact_force",
        "contact = \"n.lo\"",
        &["no contact `n.lo`", "did you mean `n.low`", "n.constraints[1]"],
    );
    refused("contact_force", "contact = \"n.guide\"", &["holds from both sides", "`constraint_force`"]);
    refused("constraint_force", "constraint = \"n.low\"", &["from one side alone", "`contact_force`"]);
    refused("velocity", "constraint = \"n.guide\"", &["`velocity` is of no constraint"]);
    let without = format!("{HEAD}{TWO}{}", probe("p", "contact_force", "contact = \"floor\""));
    let message =
        read_text("net.toml", &without, Path::new("."), &[]).err().expect("it is refused").to_string();
    assert!(message.contains("expected none here, for the scene has none"), "{message}");
}

/// A period in which a duration that is told has no place is refused at its line.
#[test]
fn periods_fit_durations() {
    let text = format!("{HEAD}{TWO}[run]\nduration = \"1 s\"\n").replace("\"10 ms\"", "1e300");
    let message = read_text("net.toml", &text, Path::new("."), &[]).err().expect("it is refused").to_string();
    assert!(message.contains("net.toml:3:") && message.contains("no step would be made"), "{message}");
}

/// A plane that keeps masses on one side is drawn as a wall, with that side free.
#[test]
fn planes_of_constraints_are_drawn() {
    let wall = |more: &str| {
        let plane = "plane = { place = [0, 0, -1], normal = [0, 0, -2] }";
        let made = scene(&format!("{TWO}[[networks.n.constraints]]\n{plane}\n{more}\n")).unwrap();
        made.model.systems[0].forces.iter().find_map(|force| force.obstacle()).map(|wall| wall.form)
    };
    let up = souple_math::Vec3::Z;
    let form = souple_engine::obstacle::Form::Plane { point: -up, normal: up };
    assert_eq!(wall("sense = \"at_most\""), Some(form));
    // what holds from both sides is no wall
    assert_eq!(wall("time = \"10 ms\""), None);
}
