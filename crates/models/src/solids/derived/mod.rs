//! Laws on elements that are derived by machine and compiled with the program: gradients, law and forces in one function.
//!
//! `cargo xtask kernels` writes a file for each line of [`DERIVED`], by `souple derive --law NAME --element NAME --emit kernel`; a test
//! compares them. Their grouped constants lie with the samples of a chunk, where the kernels of samples have them too: `X_ξ⁻¹` and the
//! volume, by which moduli are multiplied in registers, once per sample. A box along the axes has one map for all its samples: four
//! numbers are read in the place of eighty. Blocks of matrices are those of the samples.

mod boxes;
mod kernel;

pub mod linear_hex8;
pub mod linear_hex8_box;
pub mod linear_prism6;
pub mod linear_pyramid5;
pub mod linear_tet4;
pub mod linear_tri3;
pub mod st_venant_kirchhoff_hex8;
pub mod st_venant_kirchhoff_hex8_box;
pub mod st_venant_kirchhoff_prism6;
pub mod st_venant_kirchhoff_pyramid5;
pub mod st_venant_kirchhoff_tet4;
pub mod st_venant_kirchhoff_tri3;
pub mod stable_neo_hookean_hex8;
pub mod stable_neo_hookean_hex8_box;
pub mod stable_neo_hookean_prism6;
pub mod stable_neo_hookean_pyramid5;
pub mod stable_neo_hookean_tri3;

use souple_math::{Mat3, Real, Vec3};
use souple_mesh::{Cell, ElementKind, Mesh, QuadratureRule};

use super::kernel::Kernel;
use super::layout::Alike;
use crate::derive::MapKind;
use crate::materials::{AnyLaw, Law, LawVisitor, MaterialLaw, Parameters};
use kernel::DerivedKernel;

/// A law on an element of `N` nodes, with all samples of its usual rule.
pub trait DerivedElement<const N: usize>: Copy + Send + Sync + 'static {
    const SAMPLES: usize;
    /// The numbers of the law.
    type Numbers<R: Real>: Parameters<R>;

    /// Of the nodes where they are [J].
    fn energy<R: Real>(p: &Self::Numbers<R>, x: &[Vec3<R>; N], at: &impl RestSamples<R>) -> R;

    /// On the nodes [N].
    fn forces<R: Real>(p: &Self::Numbers<R>, x: &[Vec3<R>; N], at: &impl RestSamples<R>) -> [Vec3<R>; N];

    /// `∂f/∂x dx` [N].
    fn differential<R: Real>(
        p: &Self::Numbers<R>,
        x: &[Vec3<R>; N],
        dx: &[Vec3<R>; N],
        at: &impl RestSamples<R>,
    ) -> [Vec3<R>; N];
}

/// The rest shape of an element at its samples.
pub trait RestSamples<R> {
    /// `X_ξ⁻¹` and the volume of a sample.
    fn sample(&self, sample: usize) -> (Mat3<R>, R);
}

/// `Σ number · vector`.
#[inline(always)]
fn weighted<R: Real, const N: usize>(terms: [(Vec3<R>, f64); N]) -> Vec3<R> {
    let (first, number) = terms[0];
    let mut sum = first * first.x.splat(number);
    for index in 1..N {
        let (x, number) = terms[index];
        let number = x.x.splat(number);
        sum = Vec3::new(x.x.mul_add(number, sum.x), x.y.mul_add(number, sum.y), x.z.mul_add(number, sum.z));
    }
    sum
}

/// A law on an element of one shape that has a file here.
pub struct Derived {
    pub law: AnyLaw,
    pub element: ElementKind,
    pub map: MapKind,
    /// Whether it is faster than the law by samples: measured, `souple bench formal`.
    pub is_fastest: bool,
    /// What the file holds.
    pub text: &'static str,
    make: Make,
}

/// Makes a kernel from the names of the numbers of an element and the kernel of its samples.
type Make = fn(&[&str], Box<dyn Kernel>) -> Box<dyn Kernel>;

macro_rules! derived {
    ($law:ident, $element:ident, $map:ident, $file:ident, $name:ident, fastest: $is_fastest:literal) => {
        Derived {
            law: AnyLaw::$law,
            element: ElementKind::$element,
            map: MapKind::$map,
            is_fastest: $is_fastest,
            text: include_str!(concat!(stringify!($file), ".rs")),
            make: |names, samples| Box::new(DerivedKernel::<$file::$name, _>::new(names, samples)),
        }
    };
}

/// All of them.
pub const DERIVED: &[Derived] = &[
    derived!(Linear, Tri3, General, linear_tri3, LinearTri3, fastest: true),
    derived!(Linear, Tet4, General, linear_tet4, LinearTet4, fastest: false),
    derived!(Linear, Hex8, General, linear_hex8, LinearHex8, fastest: true),
    derived!(Linear, Hex8, Box, linear_hex8_box, LinearHex8Box, fastest: true),
    derived!(Linear, Prism6, General, linear_prism6, LinearPrism6, fastest: true),
    derived!(Linear, Pyramid5, General, linear_pyramid5, LinearPyramid5, fastest: true),
    derived!(StVenantKirchhoff, Tri3, General, st_venant_kirchhoff_tri3, StVenantKirchhoffTri3, fastest: true),
    derived!(StVenantKirchhoff, Tet4, General, st_venant_kirchhoff_tet4, StVenantKirchhoffTet4, fastest: false),
    derived!(StVenantKirchhoff, Hex8, General, st_venant_kirchhoff_hex8, StVenantKirchhoffHex8, fastest: true),
    derived!(StVenantKirchhoff, Hex8, Box, st_venant_kirchhoff_hex8_box, StVenantKirchhoffHex8Box, fastest: true),
    derived!(StVenantKirchhoff, Prism6, General, st_venant_kirchhoff_prism6, StVenantKirchhoffPrism6, fastest: true),
    derived!(StVenantKirchhoff, Pyramid5, General, st_venant_kirchhoff_pyramid5, StVenantKirchhoffPyramid5, fastest: true),
    derived!(StableNeoHookean, Tri3, General, stable_neo_hookean_tri3, StableNeoHookeanTri3, fastest: true),
    derived!(StableNeoHookean, Hex8, General, stable_neo_hookean_hex8, StableNeoHookeanHex8, fastest: true),
    derived!(StableNeoHookean, Hex8, Box, stable_neo_hookean_hex8_box, StableNeoHookeanHex8Box, fastest: true),
    derived!(StableNeoHookean, Prism6, General, stable_neo_hookean_prism6, StableNeoHookeanPrism6, fastest: true),
    derived!(StableNeoHookean, Pyramid5, General, stable_neo_hookean_pyramid5, StableNeoHookeanPyramid5, fastest: true),
];

/// The kernel of a law on cells of one kind and map under a rule, if there is a file of it; `samples` makes the kernel whose blocks of
/// matrices it takes.
pub(super) fn kernel(
    law: &MaterialLaw,
    (kind, map): (ElementKind, MapKind),
    rule: &QuadratureRule,
    wanted: Wanted,
    samples: impl FnOnce() -> Box<dyn Kernel>,
) -> Option<Box<dyn Kernel>> {
    let MaterialLaw::Known(law) = law else { return None };
    if rule.name != kind.default_rule().name {
        return None;
    }
    // what is a box has a general map too
    let of_map = |map: MapKind| {
        DERIVED.iter().find(|derived| derived.law == *law && derived.element == kind && derived.map == map)
    };
    let derived = of_map(map).or_else(|| of_map(MapKind::General))?;
    if wanted == Wanted::Fastest && !derived.is_fastest {
        return None;
    }
    Some((derived.make)(law.visit(Names), samples()))
}

/// Which kernels are asked for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    /// Those that are faster than samples.
    Fastest,
    Any,
}

/// Whether boxes of a kind have a kernel of their own under a law.
pub(super) fn has_box(law: &MaterialLaw, kind: ElementKind) -> bool {
    let is_of = |derived: &Derived| {
        derived.element == kind && derived.map == MapKind::Box && *law == MaterialLaw::Known(derived.law)
    };
    DERIVED.iter().any(is_of)
}

struct Names;

impl LawVisitor for Names {
    type Output = &'static [&'static str];

    fn visit<L: Law>(self, _: L) -> Self::Output {
        <L::Parameters<f64> as Parameters<f64>>::NAMES
    }
}

/// Blocks of lanes that a chunk of boxes has at least. Of the numbers of their samples a kernel reads one in eight, so that more of them stay
/// near; and what a chunk does for each of its nodes, which it shares with others, is a third of the time where a box has 2.3 of them.
const BOX_BLOCKS: usize = 16;

/// Blocks of lanes that a chunk of cells with this map has at least.
pub(super) fn least_blocks(map: MapKind) -> usize {
    match map {
        MapKind::General => Alike::IN_KIND.least_blocks,
        MapKind::Box => BOX_BLOCKS,
    }
}

/// How far an edge may lean out of its axis, relative to its own length, in a cell that is a box along the axes.
const BOX_TOLERANCE: f64 = 1e-12;

/// Whether a cell is a box along the axes.
pub(super) fn map_of(mesh: &Mesh, cell: &Cell) -> MapKind {
    if cell.kind.box_corners().is_none() {
        return MapKind::General;
    }
    let corners: Vec<Vec3> = cell.nodes.iter().map(|node| mesh.points[*node as usize]).collect();
    let is_diagonal = |xi: Vec3| {
        let jacobian = cell.kind.jacobian(&corners, xi);
        let off = jacobian - Mat3::from_diagonal(jacobian.diagonal());
        // the columns are the edges: a short one may not lean by what is little to a long one
        let largest =
            |edge: Vec3| edge.to_array().into_iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
        off.columns
            .into_iter()
            .zip(jacobian.columns)
            .all(|(off, edge)| largest(off) < BOX_TOLERANCE * largest(edge))
    };
    if cell.kind.default_rule().points.iter().all(|point| is_diagonal(point.position)) {
        MapKind::Box
    } else {
        MapKind::General
    }
}
