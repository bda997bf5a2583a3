//! Neighbour search finds what looking at all pairs finds, in every scene with crowds.

use std::path::Path;

use souple_engine::Force;
use souple_models::network::Crowd;
use souple_verify::scenes;

/// Steps of the world before pairs are counted: lists have been made, kept and made anew by then.
const STEPS: usize = 30;

/// The pairs of each crowd that are in range after some steps are those that all pairs have, once each.
#[test]
fn every_scene_finds_all_pairs() {
    let (mut crowds, mut found) = (0, 0);
    for (name, text) in scenes::SCENES {
        if !text.contains(".crowds]]") && !text.contains(".objects") {
            continue;
        }
        let scene = souple_scene::read_text(name, text, Path::new("."), &[])
            .unwrap_or_else(|errors| panic!("{name}: {errors}"));
        let mut world = scene.model.start(scene.state);
        for _ in 0..STEPS {
            world.step().unwrap_or_else(|error| panic!("{name}: {error}"));
        }
        for system in 0..world.model().systems.len() {
            let mut near = Vec::new();
            world.visit_near(system, &mut |pair| near.push(pair));
            let positions = &world.rows(system).positions;
            let forces = &world.model().systems[system].forces;
            let mut all = Vec::new();
            for crowd in forces.iter().filter_map(|force| force.as_any().downcast_ref::<Crowd>()) {
                // pairs in State are found by another search (crates/models/tests/network.rs)
                if crowd.declaration().changing_pattern {
                    continue;
                }
                crowds += 1;
                let ([first, second], range_sq) = (crowd.rows(), crowd.range() * crowd.range());
                let is_one = first == second;
                for a in first {
                    for b in second.clone().filter(|b| !is_one || *b > a) {
                        if (positions[a as usize] - positions[b as usize]).length_sq() < range_sq {
                            all.push([a, b]);
                        }
                    }
                }
            }
            assert_eq!(near, all, "{name}: {} pairs found, {} there", near.len(), all.len());
            found += all.len();
        }
    }
    assert!(crowds > 20 && found > 1000, "{crowds} crowds, {found} pairs");
}
