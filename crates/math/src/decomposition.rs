//! Polar, singular-value and eigen-decompositions of 3×3 matrices.

use crate::Mat3;
