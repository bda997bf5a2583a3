//! What a network is made of, for those who ask what it costs: masses, laws, memories, and its numbers in the algorithmic space.

use souple_models::network::{Crowd, Links, ViewedLinks};
use souple_table::Value;

use super::super::Draft;
use super::steps;
use super::table::StateSpace;
use crate::spec::network::{Filled, MassGroup, Places};
use crate::spec::units::from_algorithmic;

/// What a network is made of.
#[derive(Clone, Debug)]
pub struct NetworkInfo {
    pub name: String,
    /// Index of its system.
    pub system: usize,
    /// `Te` [s].
    pub timestep: f64,
    pub masses: usize,
    pub fixed: usize,
    /// A step that masses bear whatever their links and crowds come to [s]; none where they bear those that they are taken in.
    pub safe_step: Option<f64>,
    /// Mass of the lightest that moves [kg]; none where all are fixed.
    pub lightest: Option<f64>,
    pub laws: Vec<LawInfo>,
    pub fills: Vec<FillInfo>,
    /// Of controls that have a table.
    pub state_spaces: Vec<StateSpace>,
}

/// A group of masses that fills a shape.
#[derive(Clone, Debug)]
pub struct FillInfo {
    pub group: String,
    pub balls: usize,
    /// From the surface to the nearest ball, where that is farthest, in radii; none where gaps are left.
    pub widest_gap: Option<f64>,
}

/// Links of one law.
#[derive(Clone, Debug)]
pub struct LawInfo {
    /// Name of their force.
    pub force: String,
    pub law: &'static str,
    /// Links; 0 of crowds, whose pairs come and go.
    pub links: usize,
    /// Of crowds: every two masses that it would join, were it made of links.
    pub pairs: u64,
    /// Of encounters: those that there would be more if all layers met.
    pub saved: u64,
    /// Numbers that each remembers, or each pair of a crowd that is within its range: the dimension of its state.
    pub remembers: usize,
    /// Of fusible crowds: masses with a temperature.
    pub temperatures: usize,
    /// What a link takes of the bound `4M`: `K + 2Z` of a spring and damper [N/m]; none of crowds.
    pub stiffest: Option<f64>,
    /// Name, unit, and the number in SI units and in the algorithmic space.
    pub parameters: Vec<(&'static str, &'static str, f64, f64)>,
}

impl NetworkInfo {
    pub fn link_count(&self) -> usize {
        self.laws.iter().map(|law| law.links).sum()
    }

    /// Numbers that all links remember.
    pub fn memory(&self) -> usize {
        self.laws.iter().map(|law| law.links * law.remembers).sum()
    }

    /// Every two masses that are looked at, and how many there would be if all layers of objects met.
    pub fn pairs(&self) -> [u64; 2] {
        let pairs = self.laws.iter().map(|law| law.pairs).sum();
        [pairs, pairs + self.laws.iter().map(|law| law.saved).sum::<u64>()]
    }

    /// Where it stands between multitudes of points under simple laws and few points under laws that do much.
    pub fn category(&self) -> &'static str {
        let is_complex = self.laws.iter().any(|law| law.remembers > 0);
        match (self.masses > 100, is_complex) {
            (true, false) => "a multitude under simple laws",
            (true, true) => "a multitude under laws with memory",
            (false, false) => "few masses under simple laws",
            (false, true) => "few masses under laws with memory: a functional model",
        }
    }
}

fn fill(group: &MassGroup) -> Option<FillInfo> {
    let Places::Filled(fill) = &group.places else { return None };
    let Filled { places, widest, .. } = fill.filled.get()?;
    let widest_gap = widest.map(|gap| gap.width / (0.5 * fill.spacing));
    Some(FillInfo { group: group.name.clone(), balls: places.len(), widest_gap })
}

/// Of every network of a scene.
pub fn networks(draft: &Draft) -> Vec<NetworkInfo> {
    let networks = draft.bodies.iter().filter_map(|body| Some((body, body.spec.network.as_ref()?)));
    networks
        .map(|(body, network)| {
            let system = &draft.systems[body.system];
            let steps = draft.spec.systems[body.system].steps_per_period;
            let timestep = draft.spec.world.period / f64::from(steps);
            let parameters = |law: &crate::reader::Chosen<souple_models::network::BuildLink>| {
                let of = |parameter: &souple_table::Parameter| match law.values.get(parameter.name) {
                    Some(Value::Number(number)) => {
                        let algorithmic = number / from_algorithmic(parameter.unit, timestep);
                        Some((parameter.name, parameter.unit, number, algorithmic))
                    }
                    _ => None,
                };
                law.entry.parameters.iter().filter_map(of).collect::<Vec<_>>()
            };
            let links = body.links.iter().enumerate().filter_map(|(index, links)| {
                let law = network.links[links.table].law.as_ref()?;
                let force = format!("{}.links[{index}]", body.spec.name);
                let of = system.forces.iter().find(|known| known.name() == force)?;
                let any = of.as_any();
                let seen = || any.downcast_ref::<ViewedLinks>().map(ViewedLinks::links);
                let of = any.downcast_ref::<Links>().or_else(seen)?;
                Some(LawInfo {
                    law: law.entry.name,
                    links: links.ends.len(),
                    pairs: 0,
                    saved: 0,
                    remembers: of.remembered_len(),
                    temperatures: 0,
                    stiffest: Some(of.stiffest()),
                    parameters: parameters(law),
                    force,
                })
            });
            let all = body.mesh.points.len() as u64;
            let count = |group: &str| network.numbers_of(group).map_or(0, |masses| masses.len() as u64);
            let pairs = |of: &[&str]| match of {
                [a, b] => count(a) * count(b),
                [of] => count(of) * count(of).saturating_sub(1) / 2,
                _ => all * all.saturating_sub(1) / 2,
            };
            let crowds = network.crowds.iter().enumerate().filter_map(|(index, crowd)| {
                let law = crowd.law.as_ref()?;
                let force = crowd.force_name(&body.spec.name, index);
                let of = system.forces.iter().find(|known| known.name() == force);
                let of = of.and_then(|known| known.as_any().downcast_ref::<Crowd>());
                Some(LawInfo {
                    law: law.entry.name,
                    links: 0,
                    pairs: pairs(&crowd.of.iter().map(String::as_str).collect::<Vec<_>>()),
                    saved: crowd.kept_apart.iter().map(|of| pairs(&of.each_ref().map(String::as_str))).sum(),
                    remembers: of.map_or(0, Crowd::remembered_len),
                    temperatures: of.map_or(0, Crowd::temperature_count),
                    stiffest: None,
                    parameters: parameters(law),
                    force,
                })
            });
            let moving = network.masses.iter().filter(|group| !group.is_fixed && group.places.count() > 0);
            NetworkInfo {
                name: body.spec.name.clone(),
                system: body.system,
                timestep,
                masses: body.mesh.points.len(),
                fixed: network.of_each(|group| group.is_fixed).filter(|fixed| *fixed).count(),
                safe_step: steps::safe_step(draft, body, network),
                lightest: moving.map(|group| group.mass).reduce(f64::min),
                laws: links.chain(crowds).collect(),
                fills: network.masses.iter().filter_map(fill).collect(),
                state_spaces: (network.controls.iter())
                    .filter_map(|control| StateSpace::of(draft, body, network, control))
                    .collect(),
            }
        })
        .collect()
}
