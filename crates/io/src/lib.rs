//! Files: meshes, VTK, CSV, pictures, plots.
