//! Quantities of skins.

use std::f64::consts::PI;

use souple_engine::World;

use crate::scene::SkinInfo;
use crate::spec::quantity::SkinQuantity;

pub fn measure(quantity: SkinQuantity, skin: &SkinInfo, world: &World) -> f64 {
    let view = skin.view(world);
    let measures = view.measures();
    let is_shape = matches!(
        quantity,
        SkinQuantity::Curvature | SkinQuantity::Speed | SkinQuantity::Roundness | SkinQuantity::Distance
    );
    // of a skin that is gone nothing holds
    if is_shape && measures.components == 0 {
        return f64::NAN;
    }
    match quantity {
        SkinQuantity::Area => measures.area,
        SkinQuantity::Volume => measures.volume,
        SkinQuantity::Curvature => souple_skin::mean_curvature(view.grid, &skin.skin.lattice),
        SkinQuantity::Euler => measures.euler as f64,
        SkinQuantity::Components => measures.components as f64,
        SkinQuantity::Events => view.events() as f64,
        SkinQuantity::Speed => view.speed(),
        // of a ball of the same volume
        SkinQuantity::Roundness => (36.0 * PI * measures.volume * measures.volume).cbrt() / measures.area,
        SkinQuantity::Distance => skin.distance(world).unwrap_or(f64::NAN),
        SkinQuantity::Work => view.work() as f64,
        SkinQuantity::Blocks => view.grid.keys.len() as f64,
    }
}
