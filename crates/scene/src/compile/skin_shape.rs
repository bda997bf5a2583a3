//! A skin as a shape that bodies touch, where State has it.

use souple_engine::Configuration;
use souple_math::Vec3;
use souple_models::contact::{Nearest, Shape};
use souple_skin::look_up;
use souple_skin::reaction::visit_shares;

use crate::scene::SkinInfo;

/// One look-up of the potential of a skin tells distance and normal; what pushes on it, the rows bear that lead it.
#[derive(Debug)]
pub struct SkinShape {
    info: SkinInfo,
    bearers: Vec<u32>,
    /// Of the bearers [m].
    radii: Vec<f64>,
}

impl SkinShape {
    /// For bodies of a system: it has the bearers.
    pub fn new(info: SkinInfo, system: usize) -> Self {
        let followed = info.skin.followed().into_iter().filter(|followed| followed.system == system);
        let (bearers, radii) = followed.map(|followed| (followed.row, followed.radius)).unzip();
        Self { info, bearers, radii }
    }
}

impl Shape for SkinShape {
    // without State it is nowhere
    fn nearest(&self, _: Vec3, _: f64) -> Option<Nearest> {
        None
    }

    fn nearest_in(&self, at: &Configuration, point: Vec3, reach: f64) -> Option<Nearest> {
        let skin = &self.info.skin;
        let seen = look_up(skin.view(&at.fields[self.info.field]).grid, &skin.lattice, point)?;
        let nearest = Nearest { distance: seen.distance, normal: seen.normal, curvature: seen.curvature };
        (seen.distance <= reach).then_some(nearest)
    }

    fn bearers(&self) -> &[u32] {
        &self.bearers
    }

    fn visit_shares(&self, at: &Configuration, point: Vec3, visit: &mut dyn FnMut(usize, f64)) {
        let particle = |(row, radius): (&u32, &f64)| (at.positions[*row as usize], *radius);
        visit_shares(self.bearers.iter().zip(&self.radii).map(particle), point, visit);
    }
}
