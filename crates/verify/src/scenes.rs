//! The scenes of the repository, carried in the binary.

/// `(name, text)` of every scene in `scenes/`.
pub const SCENES: &[(&str, &str)] = &[
    ("block_on_springs", include_str!("../../../scenes/block_on_springs/scene.toml")),
    ("blown_strip", include_str!("../../../scenes/blown_strip/scene.toml")),
    ("cantilever", include_str!("../../../scenes/cantilever/scene.toml")),
    ("cantilever_dynamic", include_str!("../../../scenes/cantilever_dynamic/scene.toml")),
    ("collision", include_str!("../../../scenes/collision/scene.toml")),
    ("hanging_cable", include_str!("../../../scenes/hanging_cable/scene.toml")),
    ("hanging_cube", include_str!("../../../scenes/hanging_cube/scene.toml")),
    ("harmonic_cube", include_str!("../../../scenes/harmonic_cube/scene.toml")),
    ("incline_slides", include_str!("../../../scenes/incline_slides/scene.toml")),
    ("incline_sticks", include_str!("../../../scenes/incline_sticks/scene.toml")),
    ("liver", include_str!("../../../scenes/liver/scene.toml")),
    ("mixed_bar", include_str!("../../../scenes/mixed_bar/scene.toml")),
    ("patch", include_str!("../../../scenes/patch/scene.toml")),
    ("plate", include_str!("../../../scenes/plate/scene.toml")),
    ("rubber_as_text", include_str!("../../../scenes/rubber_as_text/scene.toml")),
    ("rubber_pulled", include_str!("../../../scenes/rubber_pulled/scene.toml")),
    ("rubber_spread", include_str!("../../../scenes/rubber_spread/scene.toml")),
    ("skin_at_rest", include_str!("../../../scenes/skin_at_rest/scene.toml")),
    ("skin_dresses", include_str!("../../../scenes/skin_dresses/scene.toml")),
    ("skin_held", include_str!("../../../scenes/skin_held/scene.toml")),
    ("skin_metamorphosis", include_str!("../../../scenes/skin_metamorphosis/scene.toml")),
    ("skin_two_way", include_str!("../../../scenes/skin_two_way/scene.toml")),
    ("skin_worn", include_str!("../../../scenes/skin_worn/scene.toml")),
    ("soft_block", include_str!("../../../scenes/soft_block/scene.toml")),
    ("sphere_under_tension", include_str!("../../../scenes/sphere_under_tension/scene.toml")),
    ("spinning_cube", include_str!("../../../scenes/spinning_cube/scene.toml")),
    ("stretched_cube", include_str!("../../../scenes/stretched_cube/scene.toml")),
    ("thick_sphere", include_str!("../../../scenes/thick_sphere/scene.toml")),
    ("traction", include_str!("../../../scenes/traction/scene.toml")),
    ("twisted_bar", include_str!("../../../scenes/twisted_bar/scene.toml")),
    ("two_materials", include_str!("../../../scenes/two_materials/scene.toml")),
];

/// The text of a scene.
pub fn text(name: &str) -> Option<&'static str> {
    SCENES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
