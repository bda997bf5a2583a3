//! Plane bodies, membranes, bars and cables: derivatives of every section under every law on every element, and the
//! answers of small strain and of neo-Hookean rubber.
#![allow(non_snake_case)]

use souple_engine::{Configuration, Force, Scratch, TangentWeights};
use souple_math::{Mat3, Vec3, exponential};
use souple_mesh::{ElementKind, Mesh};
use souple_models::materials::{self, AnyLaw, Material};
use souple_models::solids::{Quadrature, SECTIONS, Section, SolidDescription, SolidForce, lumped_mass};
use souple_table::{Value, Values};

use crate::common;

const YOUNG: f64 = 1e6;
const POISSON: f64 = 0.3;

fn material(law: &str) -> Material {
    common::material_of(materials::TABLE.find(law).unwrap(), YOUNG, POISSON)
}

/// A law as text.
fn text(energy: &str) -> Material {
    let entry = materials::TABLE.find("hyperelastic").unwrap();
    let parameters = [("mu".to_owned(), "380 kPa".to_owned()), ("lambda".to_owned(), "570 kPa".to_owned())];
    let values = Values::new()
        .with("energy", Value::Text(energy))
        .with("parameters", Value::Texts(&parameters))
        .with("density", Value::Number(1000.0));
    (entry.build)(&entry.values(values).unwrap()).unwrap()
}

/// Every law that a section takes, by name.
fn laws(section: Section) -> Vec<(String, Material)> {
    let known = AnyLaw::ALL.iter().map(|law| (law.entry().name.to_owned(), material(law.entry().name)));
    let ogden = "mu/2*(l1^3 + l2^3 + l3^3 - 3) - 1.5*mu*ln(J) + lambda/2*(J - 1)^2";
    let written = [("ogden as text".to_owned(), text(ogden))];
    let is_membrane = matches!(section, Section::Membrane { .. });
    known.chain(written).filter(|(_, material)| !is_membrane || material.law.is_objective()).collect()
}

fn sections() -> [Section; 5] {
    let (thickness, area) = (0.02, 3e-4);
    [
        Section::PlaneStrain { thickness },
        Section::PlaneStress { thickness },
        Section::Membrane { thickness },
        Section::Bar { area },
        Section::Cable { area },
    ]
}

/// A mesh of cells of one kind.
fn mesh_of(kind: ElementKind) -> Mesh {
    let values = match kind.dimension() {
        2 => Values::new()
            .with("length", Value::Number(1.0))
            .with("width", Value::Number(0.6))
            .with("cells_along", Value::Integer(3))
            .with("cells_across", Value::Integer(2)),
        _ => Values::new()
            .with("from", Value::Vector([0.0; 3]))
            .with("to", Value::Vector([1.0, 0.0, 0.0]))
            .with("cells", Value::Integer(5)),
    };
    let generator = if kind.dimension() == 2 { "sheet" } else { "line" };
    souple_mesh::generate(generator, values.with("element", Value::Text(kind.name()))).unwrap()
}

fn kinds(section: Section) -> impl Iterator<Item = ElementKind> {
    ElementKind::ALL.iter().copied().filter(move |kind| kind.dimension() == section.dimension())
}

fn force_of(mesh: &Mesh, material: &Material, section: Section) -> SolidForce {
    force_by(mesh, material, section, Quadrature::Default)
}

fn force_by(mesh: &Mesh, material: &Material, section: Section, quadrature: Quadrature) -> SolidForce {
    let of_cell = vec![0; mesh.cell_count()];
    SolidForce::new(&SolidDescription {
        name: "sheet".into(),
        mesh,
        first_row: 0,
        materials: std::slice::from_ref(material),
        material_of_cell: &of_cell,
        axes: &[],
        quadrature,
        section,
    })
    .unwrap()
}

fn at(positions: &[Vec3]) -> Configuration<'_> {
    Configuration {
        positions,
        velocities: &[],
        time: 0.0,
        load: 1.0,
        memory: &[],
        pairs: &[],
        kept: souple_engine::KeptRef::default(),
        driven: &[],
        fields: &[],
    }
}

fn forces(force: &SolidForce, scratch: &mut Scratch, positions: &[Vec3]) -> Vec<Vec3> {
    let mut out = vec![Vec3::ZERO; positions.len()];
    force.add_force(&at(positions), scratch, &mut out);
    out
}

fn energy(force: &SolidForce, positions: &[Vec3]) -> f64 {
    force.energy(&at(positions), &mut force.new_scratch()).stored
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

fn norm(a: &[Vec3]) -> f64 {
    dot(a, a).sqrt()
}

fn directions(count: usize, flat: f64) -> Vec<Vec3> {
    let number = |i: usize, salt: f64| ((i as f64 + salt) * 12.9898).sin();
    (0..count).map(|i| Vec3::new(number(i, 0.1), number(i, 0.2), number(i, 0.3) * flat)).collect()
}

/// A smooth stretch and bending, in the plane where the section is held there.
fn bent(mesh: &Mesh, section: Section) -> Vec<Vec3> {
    let out = if section.is_plane() { 0.0 } else { 1.0 };
    let wave = |p: &Vec3| {
        Vec3::new((5.0 * p.y).sin() + 2.0 * p.x, (4.0 * p.x).cos() + p.y, out * (3.0 * p.x - 2.0 * p.y).sin())
    };
    mesh.points.iter().map(|p| *p + wave(p) * 0.05).collect()
}

/// For every section, element, rule and law: force = -∂E/∂x, tangent = ∂f/∂x, blocks = products; zero at rest; in rigid
/// motion, where the law is objective, no force.
#[test]
fn battery_of_every_section() {
    for section in sections() {
        for (law, material) in laws(section) {
            for kind in kinds(section) {
                for rule in kind.rules() {
                    let name = format!("{law} on {kind} by {} in {section:?}", rule.name);
                    let quadrature = Quadrature::Default.with(kind, rule);
                    check_section(&name, &mesh_of(kind), &material, (section, quadrature));
                }
            }
        }
    }
}

fn check_section(name: &str, mesh: &Mesh, material: &Material, (section, quadrature): (Section, Quadrature)) {
    let force = force_by(mesh, material, section, quadrature);
    let mut scratch = force.new_scratch();
    let x = bent(mesh, section);
    let flat = if section.is_plane() { 0.0 } else { 1.0 };
    let direction = directions(x.len(), flat);
    let step = 1e-6;
    let moved =
        |sign: f64| -> Vec<Vec3> { x.iter().zip(&direction).map(|(x, d)| *x + *d * (sign * step)).collect() };
    let f = forces(&force, &mut scratch, &x);
    let slope = (energy(&force, &moved(1.0)) - energy(&force, &moved(-1.0))) / (2.0 * step);
    let scale = norm(&f) * norm(&direction);
    assert!((slope + dot(&f, &direction)).abs() <= 1e-7 * scale, "{name}: {slope}");

    let mut product = vec![Vec3::ZERO; x.len()];
    let weights = TangentWeights { position: 1.0, velocity: 0.0 };
    force.add_differential(&at(&x), weights, &direction, &mut scratch, &mut product);
    let [ahead, behind] = [1.0, -1.0].map(|sign| forces(&force, &mut scratch, &moved(sign)));
    let difference: Vec<Vec3> = ahead.iter().zip(&behind).map(|(a, b)| (*a - *b) * (0.5 / step)).collect();
    let gap: Vec<Vec3> = product.iter().zip(&difference).map(|(a, b)| *a - *b).collect();
    assert!(norm(&gap) <= 1e-6 * norm(&product), "{name}: {:e}", norm(&gap) / norm(&product));
    // ∂f/∂x is symmetric
    let other = directions(x.len() + 7, flat).split_off(7);
    let mut crossed = vec![Vec3::ZERO; x.len()];
    force.add_differential(&at(&x), weights, &other, &mut scratch, &mut crossed);
    let (ab, ba) = (dot(&other, &product), dot(&direction, &crossed));
    assert!((ab - ba).abs() <= 1e-10 * norm(&product) * norm(&other), "{name}: {ab} {ba}");

    let rest = forces(&force, &mut scratch, &mesh.points);
    assert!(norm(&rest) <= 1e-11 * norm(&f), "{name}: {} N at rest", norm(&rest));
    if force.declaration().internal {
        let axis = if section.is_plane() { Vec3::Z } else { Vec3::new(1.0, -2.0, 0.7) };
        let Q = exponential(axis * 0.8);
        let turned: Vec<Vec3> = mesh.points.iter().map(|p| Q * *p + Vec3::X).collect();
        let rigid = norm(&forces(&force, &mut scratch, &turned));
        assert!(rigid <= 1e-9 * norm(&f), "{name}: {rigid} N in rigid motion");
    }
}

/// Uniform small stretch along x: energy of the moduli of each section. Plane strain, held across: `λ + 2μ`; plane
/// stress and membranes, held across in the plane: `E / (1 - ν²)`; bars: `E`. To the first order of the stretch.
#[test]
fn moduli_of_small_stretch() {
    let stretch = 1e-5;
    for section in sections() {
        let (lambda, mu) =
            (YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON)), 0.5 * YOUNG / (1.0 + POISSON));
        let (modulus, measure) = match section {
            Section::PlaneStrain { .. } => (lambda + 2.0 * mu, 0.6),
            Section::PlaneStress { .. } | Section::Membrane { .. } => {
                (YOUNG / (1.0 - POISSON * POISSON), 0.6)
            }
            _ => (YOUNG, 1.0),
        };
        for (law, material) in laws(section).into_iter().filter(|(law, _)| !law.contains("text")) {
            for kind in kinds(section) {
                let mesh = mesh_of(kind);
                let force = force_of(&mesh, &material, section);
                let x: Vec<Vec3> = mesh.points.iter().map(|p| *p + Vec3::X * (p.x * stretch)).collect();
                let expected = 0.5 * modulus * stretch * stretch * measure * section.measure();
                let measured = energy(&force, &x);
                assert!(
                    (measured / expected - 1.0).abs() < 1e2 * stretch,
                    "{law} {kind} {section:?}: {measured}"
                );
            }
        }
    }
}

/// Whether a point lies inside the rectangle or line of a mesh.
fn inside(mesh: &Mesh, kind: ElementKind) -> impl Fn(&Vec3) -> bool + use<> {
    let (bounds, dimension) = (mesh.bounds(), kind.dimension());
    move |p| (0..dimension).all(|axis| (p[axis] - bounds.low[axis]).min(bounds.high[axis] - p[axis]) > 1e-9)
}

/// A crooked mesh of a kind: inner nodes are moved, along the line where there is only one, in the plane of sheets. With `is_curved` so are the
/// middles of inner edges.
fn crooked(kind: ElementKind, is_curved: bool) -> Mesh {
    let mut mesh = mesh_of(kind.corners());
    let is_inner = inside(&mesh, kind);
    let across = if kind.dimension() == 2 { 1.0 } else { 0.0 };
    let shift = |points: &mut [Vec3], by: f64| {
        for p in points.iter_mut().filter(|p| is_inner(p)) {
            let wave = Vec3::new((7.0 * p.x + 3.0 * p.y).sin(), across * (2.0 * p.x - 5.0 * p.y).sin(), 0.0);
            *p += wave * by;
        }
    };
    shift(&mut mesh.points, 0.05);
    if !kind.is_linear() {
        mesh = mesh.raised(kind.last_place(), |[a, b]| (a + b) * 0.5);
    }
    if is_curved {
        shift(&mut mesh.points, 0.01);
    }
    mesh
}

/// An affine motion is an equilibrium of crooked meshes (patch test): inner nodes feel nothing, and the energy is that of a regular
/// mesh. Straight sides take rules of degree one under linear and three under quadratic elements, `cof J ∇N` of a quadrilateral; curved
/// ones the full rule.
#[test]
fn patch_test_in_the_plane_is_exact() {
    for section in sections() {
        let out = if section.is_plane() { 0.0 } else { 0.2 };
        let F = Mat3::from_rows([[1.1, 0.05, 0.0], [0.03, 0.95, 0.0], [out, -0.5 * out, 1.0]]);
        let moved = |mesh: &Mesh| mesh.points.iter().map(|p| F * *p).collect::<Vec<Vec3>>();
        for (law, material) in laws(section) {
            let regular = mesh_of(kinds(section).next().unwrap());
            let expected = energy(&force_of(&regular, &material, section), &moved(&regular));
            for kind in kinds(section) {
                let is_quadratic = !kind.is_linear();
                let least = if is_quadratic { 3 } else { 1 };
                let straight = kind.rules().iter().filter(|rule| rule.degree >= least);
                let cases = straight.map(|rule| (rule, false));
                for (rule, is_curved) in cases.chain(is_quadratic.then_some((kind.full_rule(), true))) {
                    let name =
                        format!("{law} on {kind} by {} in {section:?}, curved: {is_curved}", rule.name);
                    let mesh = crooked(kind, is_curved);
                    let force = force_by(&mesh, &material, section, Quadrature::Default.with(kind, rule));
                    let x = moved(&mesh);
                    // sums over some hundred samples, each rounded; across a sheet what Newton's method leaves of its stress
                    let measured = energy(&force, &x);
                    assert!((measured / expected - 1.0).abs() < 1e-11, "{name}: {measured} {expected}");
                    let f = forces(&force, &mut force.new_scratch(), &x);
                    let inner = inside(&mesh, kind);
                    let unbalanced: Vec<Vec3> =
                        mesh.points.iter().zip(&f).filter(|(p, _)| inner(p)).map(|(_, f)| *f).collect();
                    assert!(!unbalanced.is_empty());
                    assert!(
                        norm(&unbalanced) < 1e-11 * norm(&f),
                        "{name}: {:e}",
                        norm(&unbalanced) / norm(&f)
                    );
                }
            }
        }
    }
}

/// A cable takes no push and pulls like a bar.
#[test]
fn cables_take_no_push() {
    let material = material("neo_hookean");
    for kind in kinds(Section::Cable { area: 1e-4 }) {
        let mesh = mesh_of(kind);
        let [bar, cable] = [Section::Bar { area: 1e-4 }, Section::Cable { area: 1e-4 }]
            .map(|s| force_of(&mesh, &material, s));
        let scaled = |by: f64| -> Vec<Vec3> { mesh.points.iter().map(|p| *p * by).collect() };
        let [pushed, pulled] = [scaled(0.8), scaled(1.3)];
        assert_eq!(energy(&cable, &pushed), 0.0);
        // what is read off it says the same
        let field = cable.cell_field(0, &pushed).unwrap();
        assert_eq!((field.energy_density, field.von_mises, norm(&field.stress.columns)), (0.0, 0.0, 0.0));
        assert_eq!(field.current_volume, field.volume);
        assert_eq!(norm(&forces(&cable, &mut cable.new_scratch(), &pushed)), 0.0);
        assert!(energy(&bar, &pushed) > 0.0);
        assert_eq!(energy(&cable, &pulled), energy(&bar, &pulled));
    }
}

/// A neo-Hookean membrane stretched alike in both directions: the stress of plane stress in closed form, with the
/// stretch across from `μ (λ₃ - 1/λ₃) + λ ln(J)/λ₃ = 0`.
#[test]
fn membrane_of_rubber() {
    let (material, section) = (material("neo_hookean"), Section::Membrane { thickness: 1e-3 });
    let (lambda, mu) =
        (YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON)), 0.5 * YOUNG / (1.0 + POISSON));
    for stretch in [0.9_f64, 1.3, 2.0] {
        // the residual rises with the stretch across
        let residual =
            |across: f64| mu * (across - 1.0 / across) + lambda * (stretch * stretch * across).ln() / across;
        let (mut low, mut high) = (0.1, 2.0);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if residual(middle) < 0.0 { low = middle } else { high = middle }
        }
        let across = low;
        let J: f64 = stretch * stretch * across;
        let density = 0.5 * mu * (2.0 * stretch * stretch + across * across - 3.0) - mu * J.ln()
            + 0.5 * lambda * J.ln().powi(2);
        for kind in kinds(section) {
            let mesh = mesh_of(kind);
            // out of the plane of rest, too
            let Q = exponential(Vec3::new(0.3, 1.0, -0.4));
            let x: Vec<Vec3> = mesh.points.iter().map(|p| Q * (*p * stretch)).collect();
            let measured = energy(&force_of(&mesh, &material, section), &x);
            let expected = density * 0.6 * 1e-3;
            assert!((measured / expected - 1.0).abs() < 1e-11, "{kind} at {stretch}: {measured} {expected}");
        }
    }
}

/// The mass of a section is its density times its thickness or area, and every entry of the table makes one.
#[test]
fn sections_of_the_table() {
    for entry in SECTIONS.entries {
        let parameter = entry.parameters[0].name;
        let values = entry.values(Values::new().with(parameter, Value::Number(0.25))).unwrap();
        let section = (entry.build)(&values);
        assert_eq!(section.measure(), 0.25);
        for kind in kinds(section) {
            let mesh = mesh_of(kind);
            let mut mass = souple_engine::Mass::new(mesh.points.len());
            lumped_mass(&mesh, 0, &|_| 1000.0 * section.measure(), &mut mass);
            let total: f64 = mass.diagonal.iter().sum();
            assert!((total / (250.0 * mesh.volume()) - 1.0).abs() < 1e-14);
            assert!(mass.diagonal.iter().all(|mass| *mass > 0.0), "{kind}");
        }
    }
}
