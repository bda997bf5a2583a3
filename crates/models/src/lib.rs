//! What the world is made of: solids, materials, loads, contact.

#![allow(non_snake_case)] // symbols of the mathematics: F, P, K

pub mod associations;
pub mod battery;
pub mod contact;
pub mod derive;
pub mod frames;
pub mod loads;
pub mod marks;
pub mod materials;
pub mod multiresolution;
pub mod network;
pub mod particles;
pub mod reduced;
pub mod solids;
mod stays;
