//! Elements, shape functions, quadrature, generators and quality of meshes.
