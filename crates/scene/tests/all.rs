//! The tests of this crate, which are one program: as many programs as files would be linked one by one, each with all
//! that the crate stands on.

mod constraints;
mod contacts;
mod controls;
mod doubts;
mod faults;
mod files;
mod frames;
mod hanging;
mod heat;
mod incompressible;
mod inelastic;
mod landing;
mod liver;
mod marks;
mod material_fields;
mod modes;
mod modules;
mod mutations;
mod networks;
mod polyhedra;
mod quantities;
mod rigid_contacts;
mod scenes;
mod skins;
mod slips;
mod split;
mod surfaces;
mod textures;
mod tool_doubts;
mod worlds;
mod yielding;
