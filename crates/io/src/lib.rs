//! Files in and out: meshes with fields, series for ParaView, tables, pictures, plots, sounds.
//!
//! [`read_mesh`] and [`write_mesh`] go by the table [`FORMATS`]. Readers answer a faulty file with a [`Fault`]
//! that names the place, what was read and what would be accepted; writers write beside and rename.

mod beside;
mod csv;
mod cursor;
mod dataset;
mod encoding;
mod error;
mod facets;
mod format;
pub mod gltf;
mod gmsh;
mod holds;
mod obj;
mod off;
mod particles;
mod parts;
pub mod picture;
pub mod plot;
mod ply;
mod stl;
#[cfg(test)]
mod testing;
mod tetgen;
mod vtk;
mod wav;

pub use beside::{may_be_written, write_file};
pub use csv::{Column, NumberTable, csv_cell, csv_cells, write_csv};
pub use dataset::{Dataset, Facets, Field, Output, Precision};
pub use error::{Fault, IoError, Place};
pub use format::{
    FORMATS, Format, Read, WriteError, WriteInto, files_of_mesh, losses, read_dataset, read_dataset_bytes,
    read_mesh, read_mesh_bytes, read_mesh_content, writable_format, write_and_read_back, write_dataset,
    write_dataset_as, write_mesh,
};
pub use holds::{Digits, HeldFields, HeldGroups, Holds, Shapes};
pub use particles::{ParticleRow, read_particle_bytes, read_particles};
pub use vtk::{Series, SeriesPart, read_series, read_series_bytes};
pub use wav::{MOST_RATE, SampleFormat, write_wav};
