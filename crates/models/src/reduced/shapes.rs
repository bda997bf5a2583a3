//! Fields that whole bodies deform by: monomials of where matter rests, and the deformations of a whole that have names.

use souple_math::Vec3;
use souple_table::{Entry, Table};

/// All monomials `u^i v^j w^k` of a degree and below along each axis, at points of coordinates about one: a basis of the polynomial fields.
pub fn monomials(degree: usize, points: &[Vec3]) -> Vec<Vec<Vec3>> {
    let powers = (0..=degree)
        .flat_map(|total| (0..=total).flat_map(move |i| (0..=total - i).map(move |j| [i, j, total - i - j])));
    let monomial =
        |[i, j, k]: [usize; 3], x: &Vec3| x.x.powi(i as i32) * x.y.powi(j as i32) * x.z.powi(k as i32);
    powers
        .flat_map(|powers| Vec3::AXES.map(|axis| points.iter().map(|x| axis * monomial(powers, x)).collect()))
        .collect()
}

/// A deformation of a body as a whole, linear in its one number: Barr's (1984) for small ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GlobalDeformation {
    pub kind: GlobalKind,
    /// The axis that it is along.
    pub along: usize,
    /// Of what needs a second axis: which.
    pub towards: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlobalKind {
    /// `x_k e_k`
    Stretch,
    /// `x_k e_l + x_l e_k`
    Shear,
    /// `x_k x_l e_l`: thicker across, along one axis, the farther along another.
    Taper,
    /// `x_k e_k × x`
    Twist,
    /// `x_k² e_l / 2 − x_k x_l e_k`: straight lines along one axis become parabolas towards another, and what is across them stays so.
    Bend,
}

/// All of them by their names: `stretch_x`, `twist_x`, and those of two axes `shear_xy`, `taper_xy`, `bend_xy`.
pub static GLOBAL_DEFORMATIONS: Table<GlobalDeformation> = Table {
    kind: "deformation",
    entries: &[
        &entry(
            "stretch_x",
            "longer along x, or shorter, by one number for all of the body",
            GlobalKind::Stretch,
            [0, 0],
        ),
        &entry(
            "stretch_y",
            "longer along y, or shorter, by one number for all of the body",
            GlobalKind::Stretch,
            [1, 1],
        ),
        &entry(
            "stretch_z",
            "longer along z, or shorter, by one number for all of the body",
            GlobalKind::Stretch,
            [2, 2],
        ),
        &entry("twist_x", "turned about x, the farther along it the more", GlobalKind::Twist, [0, 0]),
        &entry("twist_y", "turned about y, the farther along it the more", GlobalKind::Twist, [1, 1]),
        &entry("twist_z", "turned about z, the farther along it the more", GlobalKind::Twist, [2, 2]),
        &entry(
            "shear_xy",
            "moved along y, the farther along x, and as much the other way round",
            GlobalKind::Shear,
            [0, 1],
        ),
        &entry(
            "shear_xz",
            "moved along z, the farther along x, and as much the other way round",
            GlobalKind::Shear,
            [0, 2],
        ),
        &entry(
            "shear_yz",
            "moved along z, the farther along y, and as much the other way round",
            GlobalKind::Shear,
            [1, 2],
        ),
        &entry("taper_xy", "thicker along y the farther along x", GlobalKind::Taper, [0, 1]),
        &entry("taper_xz", "thicker along z the farther along x", GlobalKind::Taper, [0, 2]),
        &entry("taper_yx", "thicker along x the farther along y", GlobalKind::Taper, [1, 0]),
        &entry("taper_yz", "thicker along z the farther along y", GlobalKind::Taper, [1, 2]),
        &entry("taper_zx", "thicker along x the farther along z", GlobalKind::Taper, [2, 0]),
        &entry("taper_zy", "thicker along y the farther along z", GlobalKind::Taper, [2, 1]),
        &entry("bend_xy", "lines along x become parabolas towards y", GlobalKind::Bend, [0, 1]),
        &entry("bend_xz", "lines along x become parabolas towards z", GlobalKind::Bend, [0, 2]),
        &entry("bend_yx", "lines along y become parabolas towards x", GlobalKind::Bend, [1, 0]),
        &entry("bend_yz", "lines along y become parabolas towards z", GlobalKind::Bend, [1, 2]),
        &entry("bend_zx", "lines along z become parabolas towards x", GlobalKind::Bend, [2, 0]),
        &entry("bend_zy", "lines along z become parabolas towards y", GlobalKind::Bend, [2, 1]),
    ],
};

const fn entry(
    name: &'static str,
    summary: &'static str,
    kind: GlobalKind,
    [along, towards]: [usize; 2],
) -> Entry<GlobalDeformation> {
    let build = GlobalDeformation { kind, along, towards };
    Entry { name, summary, source: "Barr 1984, for small deformations", parameters: &[], build }
}

impl GlobalDeformation {
    /// The field at a place from the body's middle.
    pub fn at(self, x: Vec3) -> Vec3 {
        let (k, l) = (self.along, self.towards);
        let [e_k, e_l] = [k, l].map(|axis| Vec3::AXES[axis]);
        match self.kind {
            GlobalKind::Stretch => e_k * x[k],
            GlobalKind::Shear => e_l * x[k] + e_k * x[l],
            GlobalKind::Taper => e_l * (x[k] * x[l]),
            GlobalKind::Twist => e_k.cross(x) * x[k],
            GlobalKind::Bend => e_l * (0.5 * x[k] * x[k]) - e_k * (x[k] * x[l]),
        }
    }
}
