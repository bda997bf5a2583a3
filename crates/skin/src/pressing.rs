//! A skin presses on what it dresses, from where its surface stands at the end of a step.

use rayon::prelude::*;
use souple_engine::FieldState;
use souple_math::Vec3;

use crate::error::SkinError;
use crate::grid::BAND;
use crate::polygons::area_vectors;
use crate::reaction::Tense;
use crate::skin::{FLESH, HEAD, Skin, SkinScratch, VOLUME};
use crate::target::Moment;

impl Skin {
    /// Forces on rows, from the surface as it stands now.
    pub(crate) fn react(
        &self,
        field: &mut FieldState,
        scratch: &mut SkinScratch,
        at: &Moment,
    ) -> Result<(), SkinError> {
        let Some(reaction) = &self.reaction else { return Ok(()) };
        let mut volume = field.values[VOLUME];
        if reaction.pressure > 0.0 {
            volume += self.volume_ahead(scratch);
        }
        if field.values[FLESH] == 0.0 {
            field.values[FLESH] = volume;
        }
        let surface = Tense {
            points: &scratch.crossings.points,
            triangles: &scratch.triangles,
            volume,
            rest_volume: field.values[FLESH],
        };
        let out = &mut field.values[HEAD..HEAD + 3 * reaction.rows.len()];
        reaction.act(surface, at, &mut scratch.reaction, out).map_err(SkinError::Target)
    }

    /// The volume between the surface and that of its target, which it is on the way to, to first order [m³]. A pressure by the
    /// volume of the surface would come later than what it acts on has moved, and drive it on.
    fn volume_ahead(&self, scratch: &mut SkinScratch) -> f64 {
        if self.target.is_none() {
            return 0.0;
        }
        self.find_excess(scratch);
        let (Some(target), Some(placed)) = (&self.target, &scratch.target) else { return 0.0 };
        area_vectors(&scratch.crossings.points, &scratch.triangles, &mut scratch.area_vectors);
        let step = 0.5 * self.voxel();
        let farthest = BAND * self.voxel();
        let ahead = |point: Vec3, area: Vec3, excess: f64| {
            let normal = area.try_normalised()?;
            let excess_at = |side: f64| target.excess(point + normal * (side * step), placed);
            let slope = (excess_at(-1.0) - excess_at(1.0)) / (2.0 * step);
            // beyond the band nothing is known of the way
            (slope > 0.0).then(|| (excess / slope).clamp(-farthest, farthest) * area.length())
        };
        let known = scratch.crossings.points.par_iter().zip(&scratch.area_vectors);
        let each = scratch.excess.par_iter_mut().zip(known);
        each.for_each(|(excess, (point, area))| *excess = ahead(*point, *area, *excess).unwrap_or(0.0));
        // added up in their order, whatever the number of threads
        scratch.excess.iter().sum()
    }
}
