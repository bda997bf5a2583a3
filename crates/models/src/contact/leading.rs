//! Who moves a shape: a motion that is known beforehand, or something that gives way.

use std::sync::Arc;

use souple_engine::obstacle::Form;
use souple_engine::{Editable, InHand, Motion, Obstacle};
use souple_math::Vec3;

use super::carrier::Carrier;
use super::{Outline, Shape};
use crate::loads::{Pose, RigidMotion};

/// Who moves a shape. What a carrier remembers is a part of the contact's memory, `own`.
#[derive(Debug)]
pub enum Leading {
    /// A motion that is known beforehand.
    Motion(RigidMotion),
    /// Something that gives way.
    Carrier(Box<dyn Carrier>),
}

impl Leading {
    pub fn memory_len(&self) -> usize {
        match self {
            Self::Motion(_) => 0,
            Self::Carrier(carrier) => carrier.memory_len(),
        }
    }

    /// Fills `own`; where the shape is then.
    pub fn begin(&self, own: &mut [f64]) -> Pose {
        if let Self::Carrier(carrier) = self {
            carrier.initial_memory(own);
        }
        self.pose(0.0, own)
    }

    pub fn pose(&self, time: f64, own: &[f64]) -> Pose {
        match self {
            Self::Motion(motion) => motion.pose(time),
            Self::Carrier(carrier) => carrier.pose(own),
        }
    }

    /// Whether the shape stays where it is as long as a step lasts.
    pub fn rests(&self) -> bool {
        match self {
            Self::Motion(motion) => motion.rests(),
            Self::Carrier(_) => false,
        }
    }

    pub fn lead(&mut self, place: Vec3) {
        match self {
            Self::Motion(motion) => *motion = RigidMotion::at(place),
            Self::Carrier(carrier) => carrier.lead(place),
        }
    }

    pub fn in_hand(&self, own: &[f64]) -> Option<InHand> {
        match self {
            Self::Motion(_) => None,
            Self::Carrier(carrier) => Some(carrier.in_hand(own)),
        }
    }

    pub fn editable(&self) -> Vec<Editable> {
        match self {
            Self::Motion(_) => Vec::new(),
            Self::Carrier(carrier) => carrier.editable(),
        }
    }

    /// The carrier that has a parameter of this name.
    pub fn owner_of(&mut self, parameter: &str) -> Option<&mut Box<dyn Carrier>> {
        match self {
            Self::Carrier(carrier) if carrier.editable().iter().any(|own| own.name == parameter) => {
                Some(carrier)
            }
            _ => None,
        }
    }

    /// The shape as pictures show it.
    pub fn obstacle(&self, shape: &dyn Shape, name: &str) -> Option<Obstacle> {
        let motion = match self {
            Self::Motion(motion) => motion.clone(),
            Self::Carrier(carrier) => {
                RigidMotion { translation: carrier.planned(), ..RigidMotion::default() }
            }
        };
        let form = match (shape.as_plane(), shape.outline()) {
            (Some((point, normal)), _) => Form::Plane { point, normal },
            (None, Some(Outline { surface, bodies })) => {
                Form::Surface { points: surface.points, triangles: surface.triangles, bodies }
            }
            (None, None) => return None,
        };
        Some(Obstacle { name: name.to_owned(), form, motion: Arc::new(motion) })
    }
}
