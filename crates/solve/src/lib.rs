//! Block-sparse matrices, preconditioned Krylov methods, direct factors, Newton.
