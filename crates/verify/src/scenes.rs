//! The scenes of the repository, carried in the binary.

/// `(name, text)` of every scene in `scenes/`.
pub const SCENES: &[(&str, &str)] = &[
    ("block_on_springs", include_str!("../../../scenes/block_on_springs/scene.toml")),
    ("blown_strip", include_str!("../../../scenes/blown_strip/scene.toml")),
    ("cantilever", include_str!("../../../scenes/cantilever/scene.toml")),
    ("cantilever_dynamic", include_str!("../../../scenes/cantilever_dynamic/scene.toml")),
    ("clay_sticks_again", include_str!("../../../scenes/clay_sticks_again/scene.toml")),
    ("collision", include_str!("../../../scenes/collision/scene.toml")),
    ("fascia", include_str!("../../../scenes/fascia/scene.toml")),
    ("frames_cantilever", include_str!("../../../scenes/frames_cantilever/scene.toml")),
    ("frames_spinning", include_str!("../../../scenes/frames_spinning/scene.toml")),
    ("hanging_cable", include_str!("../../../scenes/hanging_cable/scene.toml")),
    ("hanging_cube", include_str!("../../../scenes/hanging_cube/scene.toml")),
    ("harmonic_cube", include_str!("../../../scenes/harmonic_cube/scene.toml")),
    ("incline_slides", include_str!("../../../scenes/incline_slides/scene.toml")),
    ("incline_sticks", include_str!("../../../scenes/incline_sticks/scene.toml")),
    ("ligament", include_str!("../../../scenes/ligament/scene.toml")),
    ("liver", include_str!("../../../scenes/liver/scene.toml")),
    ("mixed_bar", include_str!("../../../scenes/mixed_bar/scene.toml")),
    ("network_collision", include_str!("../../../scenes/network_collision/scene.toml")),
    ("network_free_fall", include_str!("../../../scenes/network_free_fall/scene.toml")),
    ("network_friction", include_str!("../../../scenes/network_friction/scene.toml")),
    ("network_lattice", include_str!("../../../scenes/network_lattice/scene.toml")),
    ("network_oscillator", include_str!("../../../scenes/network_oscillator/scene.toml")),
    ("network_spin", include_str!("../../../scenes/network_spin/scene.toml")),
    ("patch", include_str!("../../../scenes/patch/scene.toml")),
    ("plate", include_str!("../../../scenes/plate/scene.toml")),
    ("rheometer", include_str!("../../../scenes/rheometer/scene.toml")),
    ("rubber_as_text", include_str!("../../../scenes/rubber_as_text/scene.toml")),
    ("rubber_pulled", include_str!("../../../scenes/rubber_pulled/scene.toml")),
    ("rubber_spread", include_str!("../../../scenes/rubber_spread/scene.toml")),
    ("sand_heap", include_str!("../../../scenes/sand_heap/scene.toml")),
    ("soft_block", include_str!("../../../scenes/soft_block/scene.toml")),
    ("spinning_cube", include_str!("../../../scenes/spinning_cube/scene.toml")),
    ("stretched_cube", include_str!("../../../scenes/stretched_cube/scene.toml")),
    ("tearing_sheet", include_str!("../../../scenes/tearing_sheet/scene.toml")),
    ("thick_sphere", include_str!("../../../scenes/thick_sphere/scene.toml")),
    ("tied_organs", include_str!("../../../scenes/tied_organs/scene.toml")),
    ("traction", include_str!("../../../scenes/traction/scene.toml")),
    ("twisted_bar", include_str!("../../../scenes/twisted_bar/scene.toml")),
    ("two_materials", include_str!("../../../scenes/two_materials/scene.toml")),
];

/// The text of a scene.
pub fn text(name: &str) -> Option<&'static str> {
    SCENES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
