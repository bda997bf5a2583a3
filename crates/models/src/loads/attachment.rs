//! Attachments: damped springs between material points of two bodies, solved with both bodies at once.

use std::any::Any;

use souple_engine::{
    Configuration, Declaration, Editable, Energy, Force, Pair, ParameterError, Scratch, TangentWeights,
};
use souple_math::{Mat3, Vec3};
use souple_solve::BlockMatrix;

use super::{Combination, Fit, LoadError, editable, not_negative, set_number};

/// Two points held together or at a distance.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    pub a: Combination,
    pub b: Combination,
    /// Distance at which it is at rest [m]; zero: the points are pulled onto each other.
    pub rest_length: f64,
    /// How stiff it is, of what the attachments have: links with more area about them bear more.
    pub share: f64,
    /// Pull under which it tears for good [N]; infinite where it never does.
    pub strength: f64,
}

impl Link {
    /// As stiff as the attachments say, for good.
    pub fn new(a: Combination, b: Combination, rest_length: f64) -> Self {
        Self { a, b, rest_length, share: 1.0, strength: f64::INFINITY }
    }
}

/// With `d = x_a - x_b`, `l = |d|`, `n = d/l` and the rest length `L`, the force on `x_a` is
///
/// `f = -k d - c ḋ` for `L = 0`, and `f = -(k (l - L) + c n·ḋ) n` for `L > 0`.
///
/// A link of a rest length that has shrunk to a point has no direction: it gives no force there, and rests in
/// unstable balance until something moves it.
#[derive(Clone, Debug)]
pub struct Attachments {
    name: String,
    links: Vec<Link>,
    /// Of a link with the share 1 [N/m].
    stiffness: f64,
    /// Per link [N s/m].
    damping: f64,
    /// Whether any link does.
    can_tear: bool,
}

/// How attachments stand.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slip {
    pub links: usize,
    /// Links that have torn.
    pub torn: usize,
    /// The greatest way between what a whole link holds together, beyond its rest length [m].
    pub greatest: f64,
}

impl Attachments {
    /// # Errors
    /// No links, or a number that is negative or not finite.
    pub fn new(
        name: impl Into<String>,
        links: Vec<Link>,
        stiffness: f64,
        damping: f64,
    ) -> Result<Self, LoadError> {
        if links.is_empty() {
            return Err(LoadError::Empty { field: "links", expected: "pair of points" });
        }
        for (index, link) in links.iter().enumerate() {
            not_negative(format!("links[{index}].rest_length"), link.rest_length)?;
            not_negative(format!("links[{index}].share"), link.share)?;
            if link.strength.is_nan() || link.strength <= 0.0 {
                let field = format!("links[{index}].strength");
                return Err(LoadError::Unfit { field, value: link.strength, expected: "a number above 0" });
            }
        }
        not_negative("stiffness", stiffness)?;
        not_negative("damping", damping)?;
        let can_tear = links.iter().any(|link| link.strength.is_finite());
        Ok(Self { name: name.into(), links, stiffness, damping, can_tear })
    }

    /// [N/m]
    fn stiffness_of(&self, link: &Link) -> f64 {
        self.stiffness * link.share
    }

    /// Whether a link has torn, by the force's memory.
    pub fn is_torn(&self, link: usize, memory: &[f64]) -> bool {
        self.can_tear && memory.get(1 + link).is_some_and(|torn| *torn > 0.0)
    }

    /// Links that hold.
    fn whole<'a>(&'a self, memory: &'a [f64]) -> impl Iterator<Item = &'a Link> {
        self.links.iter().enumerate().filter(|(index, _)| !self.is_torn(*index, memory)).map(|(_, link)| link)
    }

    /// How far the ends of a link are from where it would have them [m]; zero once it has torn.
    pub fn slip_of(&self, link: usize, at: &Configuration) -> f64 {
        if self.is_torn(link, at.memory) { 0.0 } else { stretch(&self.links[link], at).abs() }
    }

    /// How all links stand.
    pub fn slip(&self, at: &Configuration) -> Slip {
        let all = 0..self.links.len();
        Slip {
            links: self.links.len(),
            torn: all.clone().filter(|link| self.is_torn(*link, at.memory)).count(),
            greatest: all.map(|link| self.slip_of(link, at)).fold(0.0, f64::max),
        }
    }

    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// The force on end `a` of a link [N].
    pub fn pull(&self, link: &Link, at: &Configuration) -> Vec3 {
        let Stretch { d, rate, direction } = Stretch::of(link, at);
        match direction {
            _ if link.rest_length == 0.0 => -(d * self.stiffness_of(link) + rate * self.damping),
            Some(n) => {
                let elastic = self.stiffness_of(link) * (d.dot(n) - link.rest_length);
                -(n * (elastic + self.damping * n.dot(rate)))
            }
            None => Vec3::ZERO,
        }
    }

    /// `a ∂f/∂d + b ∂f/∂ḋ` of a link.
    fn tangent(&self, link: &Link, at: &Configuration, weights: TangentWeights) -> Mat3 {
        let (k, c) = (self.stiffness_of(link) * weights.position, self.damping * weights.velocity);
        let Stretch { d, rate, direction } = Stretch::of(link, at);
        if link.rest_length == 0.0 {
            return Mat3::IDENTITY * -(k + c);
        }
        let Some(n) = direction else { return Mat3::ZERO };
        let length = d.dot(n);
        let across = Mat3::IDENTITY - n.outer(n);
        // -k [n nᵀ + (1 - L/l) P] - c n nᵀ,  P = I - n nᵀ
        let elastic = n.outer(n) * -(k + c) - across * (k * (1.0 - link.rest_length / length));
        // the line turns with the points: -c [n (Pḋ)ᵀ + (n·ḋ) P]/l
        let turning =
            (n.outer(across * rate) + across * n.dot(rate)) * (self.damping * weights.position / length);
        elastic - turning
    }

    /// Tears the links that bear more than they can; whether any did.
    fn tear(&self, at: &Configuration, memory: &mut [f64]) -> bool {
        let mut tore = false;
        for (index, link) in self.links.iter().enumerate().filter(|_| self.can_tear) {
            if memory[1 + index] == 0.0 && self.pull(link, at).length() > link.strength {
                memory[1 + index] = 1.0;
                // what it held is given off
                memory[0] += 0.5 * self.stiffness_of(link) * stretch(link, at).powi(2);
                tore = true;
            }
        }
        tore
    }

    fn turns_with_damping(&self) -> bool {
        self.damping > 0.0 && self.links.iter().any(|link| link.rest_length > 0.0)
    }
}

/// `l - L` [m].
fn stretch(link: &Link, at: &Configuration) -> f64 {
    Stretch::of(link, at).d.length() - link.rest_length
}

/// How a link stands: `d`, `ḋ`, and `n` where there is one.
struct Stretch {
    d: Vec3,
    rate: Vec3,
    direction: Option<Vec3>,
}

impl Stretch {
    fn of(link: &Link, at: &Configuration) -> Self {
        let d = link.a.of(at.positions) - link.b.of(at.positions);
        let rate = link.a.of(at.velocities) - link.b.of(at.velocities);
        Self { d, rate, direction: d.try_normalised() }
    }
}

/// `block` between the ends of a link, with opposite signs across.
fn add_link(link: &Link, block: Mat3, matrix: &mut BlockMatrix) {
    link.a.add_blocks(&link.a, &block, matrix);
    link.b.add_blocks(&link.b, &block, matrix);
    link.a.add_blocks(&link.b, &-block, matrix);
    link.b.add_blocks(&link.a, &-block, matrix);
}

impl Force for Attachments {
    fn name(&self) -> &str {
        &self.name
    }

    fn declaration(&self) -> Declaration {
        let damped = self.damping > 0.0;
        // a damper of no rest length pulls across its line: it conserves momentum but may turn the whole
        let across = damped && self.links.iter().any(|link| link.rest_length == 0.0);
        let whole = |point: &Combination| (point.total_weight() - 1.0).abs() < 1e-12;
        let internal = !across && self.links.iter().all(|link| whole(&link.a) && whole(&link.b));
        Declaration {
            conservative: !damped && !self.can_tear,
            velocity_terms: damped,
            symmetric_tangent: !self.turns_with_damping(),
            internal,
            changing_pattern: false,
        }
    }

    // an account of heat, then 1 for each link that has torn
    fn memory_len(&self) -> usize {
        if self.can_tear { 1 + self.links.len() } else { 1 }
    }

    fn tangent_reads_memory(&self) -> bool {
        self.can_tear
    }

    // E = Σ k/2 (l - L)²
    fn energy(&self, at: &Configuration, _scratch: &mut Scratch) -> Energy {
        let of = |link: &Link| 0.5 * self.stiffness_of(link) * stretch(link, at).powi(2);
        let stored = self.whole(at.memory).map(of).sum();
        Energy { stored, dissipated: at.memory[0] }
    }

    fn add_force(&self, at: &Configuration, _scratch: &mut Scratch, out: &mut [Vec3]) {
        for link in self.whole(at.memory) {
            let pull = self.pull(link, at);
            link.a.spread(pull, out);
            link.b.spread(-pull, out);
        }
    }

    fn add_differential(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        delta: &[Vec3],
        _scratch: &mut Scratch,
        out: &mut [Vec3],
    ) {
        for link in self.whole(at.memory) {
            let change = self.tangent(link, at, weights) * (link.a.of(delta) - link.b.of(delta));
            link.a.spread(change, out);
            link.b.spread(-change, out);
        }
    }

    fn visit_cliques(&self, _pairs: &[Pair], visit: &mut dyn FnMut(&[u32])) {
        let mut rows = Vec::new();
        for link in &self.links {
            rows.clear();
            rows.extend(link.a.rows().iter().chain(link.b.rows()).map(|&(row, _)| row));
            rows.sort_unstable();
            rows.dedup();
            visit(&rows);
        }
    }

    fn reads_cliques_alone(&self) -> bool {
        true
    }

    fn add_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        self.whole(at.memory).for_each(|link| add_link(link, self.tangent(link, at, weights), matrix));
    }

    fn add_symmetric_blocks(
        &self,
        at: &Configuration,
        weights: TangentWeights,
        _: &mut Scratch,
        matrix: &mut BlockMatrix,
    ) {
        // both ends have one block, so its symmetric part is that of the whole
        let of = |link: &Link| self.tangent(link, at, weights).symmetric_part();
        self.whole(at.memory).for_each(|link| add_link(link, of(link), matrix));
    }

    // heat: ∫ c |ḋ|² dt, or c (n·ḋ)² where the damper lies along the line
    fn advance_memory(&self, at: &Configuration, timestep: f64, memory: &mut [f64], _pairs: &mut [Pair]) {
        let speed_sq = |link: &Link| {
            let Stretch { rate, direction, .. } = Stretch::of(link, at);
            if link.rest_length == 0.0 {
                rate.length_sq()
            } else {
                direction.map_or(0.0, |n| n.dot(rate).powi(2))
            }
        };
        let speeds: f64 = self.whole(memory).map(speed_sq).sum();
        memory[0] += timestep * self.damping * speeds;
        self.tear(at, memory);
    }

    fn give_way(&self, at: &Configuration, memory: &mut [f64]) -> bool {
        self.tear(at, memory)
    }

    fn editable(&self) -> Vec<Editable> {
        vec![editable("stiffness", "N/m", self.stiffness), editable("damping", "N s/m", self.damping)]
    }

    fn set_parameter(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        let numbers = &mut [
            ("stiffness", &mut self.stiffness, Fit::NotNegative),
            ("damping", &mut self.damping, Fit::NotNegative),
        ];
        set_number(&self.name, numbers, name, value)
    }

    fn bytes(&self) -> usize {
        let rows: usize = self.links.iter().map(|link| link.a.rows().len() + link.b.rows().len()).sum();
        size_of_val(self.links.as_slice()) + rows * size_of::<(u32, f64)>()
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}
