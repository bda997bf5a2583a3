//! Light: three lamps that go with the camera, of which one may be placed, a sky, and the shade of corners and of contact.

use souple_math::Vec3;

use super::camera::{Camera, View};
use super::colour::Colour;
use super::raster::{Sample, Samples};

/// Lamps and sky of a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lamps {
    key: Vec3,
    fill: Vec3,
    rim: Vec3,
    sky: Vec3,
}

impl Lamps {
    pub fn of(camera: &Camera, view: &View) -> Self {
        let towards = |right: f64, above: f64, back: f64| {
            let direction = camera.right * right + camera.up * above - camera.forward * back;
            direction.try_normalised().unwrap_or(Vec3::Z)
        };
        Self {
            key: view.light.and_then(|light| (-light).try_normalised()).unwrap_or(towards(-0.55, 0.75, 0.75)),
            fill: towards(0.9, 0.15, 0.6),
            rim: towards(0.35, 0.7, -0.8),
            sky: view.up.try_normalised().unwrap_or(Vec3::Y),
        }
    }

    /// Towards the lamp that throws shadows, unit.
    pub fn key(&self) -> Vec3 {
        self.key
    }

    /// Light that a sample sends to the eye; `view`: unit vector to the eye, `open`: share of the sky it sees,
    /// `lit`: share of the key lamp that it sees.
    pub fn shade(&self, sample: &Sample, view: Vec3, open: f32, lit: f32) -> Colour {
        const KEY: Colour = Colour([1.0, 0.97, 0.92]);
        const FILL: Colour = Colour([0.82, 0.88, 1.0]);
        const SKY: Colour = Colour([0.92, 0.96, 1.0]);
        const EARTH: Colour = Colour([0.62, 0.56, 0.52]);
        let [x, y, z] = sample.normal.map(f64::from);
        let normal = Vec3::new(x, y, z);
        // where the key lamp only grazes, a map of shadows shows its own grain; little light is at stake there
        let grazing = (((normal.dot(self.key) - 0.02) / 0.18).clamp(0.0, 1.0)) as f32;
        let lit = 1.0 - (1.0 - lit) * grazing;
        let facing = |lamp: Vec3| normal.dot(lamp).max(0.0) as f32;
        // wrapped a little around the terminator: soft matter scatters light beneath its surface
        let wrapped = |lamp: Vec3| ((normal.dot(lamp) + 0.25) / 1.25).max(0.0) as f32;

        let ambient = EARTH.mixed(SKY, 0.5 + 0.5 * normal.dot(self.sky) as f32).scaled(0.46 * open);
        // corners shade the lamps too, but less than the sky
        let lamp_open = 0.45 + 0.55 * open;
        let diffuse = ambient
            .plus(KEY.scaled(0.78 * wrapped(self.key) * lamp_open * lit))
            .plus(FILL.scaled(0.16 * facing(self.fill) * lamp_open))
            .plus(KEY.scaled(0.12 * facing(self.rim)));

        // Blinn: the normal against the middle between lamp and eye
        let shine = |lamp: Vec3, sharpness: i32| {
            let middle = (lamp + view).try_normalised().unwrap_or(view);
            (normal.dot(middle).max(0.0) as f32).powi(sharpness)
        };
        let dull = 0.07 * lit * shine(self.key, 42) + 0.025 * shine(self.fill, 24);
        // a film of liquid is smooth: lamps are seen in it small and bright
        let wet = 0.9 * lit * shine(self.key, 220) + 0.2 * shine(self.fill, 120);
        let gloss = dull + sample.wet * wet;
        // Schlick: surfaces seen at a glance reflect the sky
        let glance =
            (1.0 - normal.dot(view).clamp(0.0, 1.0) as f32).powi(4) * (0.07 + 0.15 * sample.wet) * open;
        let reflected = sample
            .albedo
            .times(diffuse)
            .plus(Colour::WHITE.scaled(gloss * lamp_open))
            .plus(SKY.scaled(glance));
        if sample.inside { reflected.scaled(0.6) } else { reflected }
    }
}

/// Share of the sky that each pixel sees: corners and folds see less.
///
/// `samples` has one sample for each pixel; `radius` is how far away a thing may be to count [m].
pub(super) fn openness(samples: &Samples, camera: &Camera, radius: f64) -> Vec<f32> {
    let (width, height) = (samples.width, samples.height);
    let depths: Vec<f32> = samples.samples.iter().map(|sample| sample.inverse_depth).collect();
    let probes = probes(radius);
    let raw: Vec<f32> = (0..width * height)
        .map(|index| {
            let (column, row) = (index % width, index / width);
            let pattern = (column % PATTERN) * PATTERN + row % PATTERN;
            let sample = &samples.samples[index];
            if sample.inverse_depth <= 0.0 {
                return 1.0;
            }
            let (x, y) = samples.position(column, row);
            let own = &probes[pattern * DIRECTIONS..(pattern + 1) * DIRECTIONS];
            open_share(sample, camera.ray(x, y), own, camera, radius, |x, y| {
                let within = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
                within.then(|| depths[y as usize * width + x as usize])
            })
        })
        .collect();
    blurred(samples, &raw, radius)
}

const DIRECTIONS: usize = 20;
/// Side of the pattern by which neighbouring pixels use different directions; the blur is as wide.
const PATTERN: usize = 4;

/// Where to look around a point, in the frame of its tangent plane [m].
type Probe = [f64; 3];

/// Directions over the hemisphere, crowded around the normal as light counts there, at growing distances; another
/// set for each pixel of the pattern.
fn probes(radius: f64) -> Vec<Probe> {
    let probe = |index: usize| {
        let (pattern, direction) = (index / DIRECTIONS, (index % DIRECTIONS) as f64);
        let turn = pattern as f64 / (PATTERN * PATTERN) as f64;
        let angle = std::f64::consts::TAU * (direction * 0.618_033_988_75 + turn);
        let across = 0.95 * ((direction + 0.5) / DIRECTIONS as f64).sqrt();
        let along = (1.0 - across * across).sqrt();
        let reach = radius * (0.15 + 0.85 * (direction * 0.754_877_666_2 + turn).fract());
        [across * libm::cos(angle), across * libm::sin(angle), along].map(|part| part * reach)
    };
    (0..PATTERN * PATTERN * DIRECTIONS).map(probe).collect()
}

/// `seen`: `1 / depth` of what is at a place of the picture.
fn open_share(
    sample: &Sample,
    ray: Vec3,
    probes: &[Probe],
    camera: &Camera,
    radius: f64,
    seen: impl Fn(f64, f64) -> Option<f32>,
) -> f32 {
    let [nx, ny, nz] = sample.normal.map(f64::from);
    let normal = Vec3::new(nx, ny, nz);
    let tangent = normal.any_orthogonal();
    let other = normal.cross(tangent);
    let point = camera.eye + ray * (1.0 / f64::from(sample.inverse_depth));
    let mut closed = 0.0;
    for [a, b, c] in probes {
        // off the surface by a little, so that a slanted one does not shade itself
        let probe = camera.project(point + tangent * *a + other * *b + normal * (c + 0.02 * radius));
        let Some(seen) = seen(probe.x, probe.y).map(f64::from) else { continue };
        if probe.inverse_depth > 0.0 && seen > probe.inverse_depth {
            // something is before the probe; far before it, it is another thing with a gap between
            let gap = 1.0 / probe.inverse_depth - 1.0 / seen;
            closed += (1.0 - gap / (2.0 * radius)).max(0.0);
        }
    }
    (1.0 - 1.1 * closed / DIRECTIONS as f64).clamp(0.0, 1.0) as f32
}

/// The mean over the pattern, along rows, then along columns, among pixels of about the same depth.
fn blurred(samples: &Samples, values: &[f32], radius: f64) -> Vec<f32> {
    let (width, height) = (samples.width, samples.height);
    let rows = blurred_along(samples, values, radius, 1, |index| (index % width, width));
    blurred_along(samples, &rows, radius, width, |index| (index / width, height))
}

/// `place` tells how far along its line a pixel stands, and how long the line is.
fn blurred_along(
    samples: &Samples,
    values: &[f32],
    radius: f64,
    stride: usize,
    place: impl Fn(usize) -> (usize, usize),
) -> Vec<f32> {
    const REACH: usize = PATTERN / 2;
    let inverse_depth = |index: usize| f64::from(samples.samples[index].inverse_depth);
    let mean = |index: usize| {
        let own = inverse_depth(index);
        if own <= 0.0 {
            return 1.0;
        }
        let (at, count) = place(index);
        let first = index - REACH.min(at) * stride;
        let last = index + REACH.min(count - 1 - at) * stride;
        let near = |neighbour: &usize| {
            let other = inverse_depth(*neighbour);
            other > 0.0 && (1.0 / other - 1.0 / own).abs() < 0.5 * radius
        };
        let (mut sum, mut weight) = (0.0, 0.0);
        for neighbour in (first..=last).step_by(stride).filter(near) {
            sum += values[neighbour];
            weight += 1.0;
        }
        sum / weight
    };
    (0..values.len()).map(mean).collect()
}
