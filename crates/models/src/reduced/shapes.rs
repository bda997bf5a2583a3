//! Fields that whole bodies deform by: monomials of where matter rests, and the deformations of a whole that have names.

use souple_math::Vec3;

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

impl GlobalDeformation {
    /// All by their names: `stretch_x`, `twist_x`, and those of two axes `shear_xy`, `taper_xy`, `bend_xy`.
    pub const NAMES: [&'static str; 21] = [
        "stretch_x",
        "stretch_y",
        "stretch_z",
        "twist_x",
        "twist_y",
        "twist_z",
        "shear_xy",
        "shear_xz",
        "shear_yz",
        "taper_xy",
        "taper_xz",
        "taper_yx",
        "taper_yz",
        "taper_zx",
        "taper_zy",
        "bend_xy",
        "bend_xz",
        "bend_yx",
        "bend_yz",
        "bend_zx",
        "bend_zy",
    ];

    /// `None` where it is none of [`Self::NAMES`].
    pub fn named(name: &str) -> Option<Self> {
        if !Self::NAMES.contains(&name) {
            return None;
        }
        let (kind, axes) = name.split_once('_')?;
        let mut axes = axes.chars().map(|axis| "xyz".find(axis));
        let (along, towards) = (axes.next()??, axes.next().flatten());
        let kind = match kind {
            "stretch" => GlobalKind::Stretch,
            "shear" => GlobalKind::Shear,
            "taper" => GlobalKind::Taper,
            "twist" => GlobalKind::Twist,
            "bend" => GlobalKind::Bend,
            _ => return None,
        };
        Some(Self { kind, along, towards: towards.unwrap_or(along) })
    }

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
