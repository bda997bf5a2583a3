//! Fusible crowds: what is refused and warned of, and steppers that make matrices.

use std::path::Path;

fn read(text: &str, settings: &[&str]) -> Result<souple_scene::Scene, String> {
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    souple_scene::read_text("heat", text, Path::new("."), &settings).map_err(|errors| errors.to_string())
}

const HEAT: &str = include_str!("../../../scenes/heat/scene.toml");

#[test]
fn wrong_heat_is_refused() {
    let fusible = "networks.pair.crowds[0].fusible";
    for (setting, words) in [
        (format!("{fusible}.softening=350"), "soften from 350 K on and melt at 350 K"),
        (format!("{fusible}.reach=1.6"), "masses set that are 1.6 m apart, and the crowd ends at 1.5 m"),
        (format!("{fusible}.exchange=\"1\""), "both `exchange` and `ambient`"),
        (format!("{fusible}.temperature=\"-1\""), "starts at -1 K"),
        (format!("{fusible}.capacity=0"), "capacity"),
        (format!("{fusible}.heating=\"1/t\""), "heated by inf W at the start"),
        ("networks.pair.space=algorithmic".to_owned(), "`fusible` is in SI units"),
        (
            r#"networks.pair.crowds[0].law={ name = "conditional", states = { a = "CHK, 100 N/m" } }"#
                .to_owned(),
            "the law remembers 5 numbers of a pair",
        ),
    ] {
        match read(HEAT, &[&setting]) {
            Ok(_) => panic!("{setting} is taken"),
            Err(message) => assert!(message.contains(words), "{setting}: {message}"),
        }
    }
}

/// More heat than a mass holds in a step is warned of: `Te Σ g/c = 1.01` with two neighbours.
#[test]
fn swinging_heat_is_warned_of() {
    let warned = |conductance: &str| {
        let scene =
            read(HEAT, &[&format!("networks.rod.crowds[0].fusible.conductance={conductance}")]).unwrap();
        scene.warnings.iter().any(|warning| warning.contains("exchanges 1.010 of the heat that it holds"))
    };
    assert!(warned("101") && !warned("99"));
}

/// Pairs that stand in State, for steppers that make matrices, remember the same bonds.
#[test]
fn bonds_stand_in_state_too() {
    let pull = |stepper: &str| {
        let scene = read(HEAT, &[&format!("systems.main.stepper={stepper}")]).unwrap();
        let probe = scene.probes.iter().find(|probe| probe.name == "pull").unwrap().clone();
        let mut world = scene.model.start(scene.state);
        for _ in 0..450 {
            world.step().unwrap();
        }
        probe.measure(&mut world).numbers()[0]
    };
    for stepper in ["backward_euler", "verlet"] {
        // led ends are where they are led, whatever the stepper; a step of temperature more or less at the time it sets changes nothing
        assert!((pull(stepper) - 3.0).abs() < 1e-9, "{stepper}: {}", pull(stepper));
    }
}

/// Heat that would run away, and masses with two temperatures, are refused.
#[test]
fn heat_has_one_way_and_one_place() {
    let fusible = "networks.pair.crowds[0].fusible";
    let cold = [format!("{fusible}.exchange=\"-1\""), format!("{fusible}.ambient=\"300\"")];
    let message = read(HEAT, &[&cold[0], &cold[1]]).err().expect("it runs away");
    assert!(message.contains("exchanges -1 W/K with what is around it"), "{message}");
    let place = |words: &str| HEAT.find(words).expect("a table");
    let (from, to) = (place("[[networks.rod.crowds]]"), place("[networks.pair.masses.hold]"));
    let twice = format!("{}{}{}", &HEAT[..to], &HEAT[from..to], &HEAT[to..]);
    let message = read(&twice, &[]).err().expect("two temperatures");
    assert!(message.contains("mass 0 of network `rod` is in the fusible crowds"), "{message}");
}
