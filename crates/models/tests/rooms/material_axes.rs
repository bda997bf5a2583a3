//! Laws along axes of their cells: as if the law were written along them.

use std::sync::Arc;

use souple_engine::{Configuration, Force, KeptRef, TangentWeights};
use souple_math::{Mat3, Vec3, exponential};
use souple_mesh::Mesh;
use souple_models::frames::{
    Carried, Frame, FramesDescription, FramesForce, POINTS, Shape, TangentKind, WEIGHTS,
};
use souple_models::materials::{self, Material};
use souple_models::solids::{Quadrature, RayleighDamping, Section, SolidDescription, SolidForce};
use souple_solve::{BlockMatrix, LinearOperator, PatternBuilder};
use souple_table::{Value, Values};

/// Of finite strain with fibres, and of small strain: both know the direction `a`.
const LAWS: [&str; 2] = [
    "mu/2*(I1 - 3) - mu*ln(J) + 2*mu*ln(J)^2 + mu/4*(exp(2*(I4(a) - 1)^2) - 1)",
    "mu*dot(eps, eps) + mu/2*tr(eps)^2 + 3*mu*dot(a, eps*a)^2",
];
/// The direction in the axes of the law.
const DIRECTION: Vec3 = Vec3::new(0.6, 0.0, 0.8);

fn law_along(energy: &str, direction: Vec3) -> Material {
    let entry = materials::TABLE.find("hyperelastic").unwrap();
    let [x, y, z] = direction.to_array();
    let parameters =
        [("mu".to_owned(), "3 kPa".to_owned()), ("a".to_owned(), format!("[{x:?}, {y:?}, {z:?}]"))];
    let values = Values::new()
        .with("energy", Value::Text(energy))
        .with("parameters", Value::Texts(&parameters))
        .with("density", Value::Number(1000.0));
    (entry.build)(&entry.values(values).unwrap()).unwrap()
}

fn bar(element: &str) -> Mesh {
    let values = Values::new()
        .with("size", Value::Vector([1.0, 0.4, 0.3]))
        .with("cells", Value::Vector([5.0, 2.0, 2.0]))
        .with("element", Value::Text(element));
    souple_mesh::generate("bar", values).unwrap()
}

/// Of neighbouring cells different ones.
fn turns() -> [Mat3; 2] {
    [exponential(Vec3::new(0.4, -0.9, 0.3)), exponential(Vec3::new(-1.2, 0.2, 2.0))]
}

fn at(positions: &[Vec3]) -> Configuration<'_> {
    Configuration {
        positions,
        velocities: positions,
        time: 0.0,
        load: 1.0,
        memory: &[0.0],
        pairs: &[],
        kept: KeptRef::default(),
        driven: &[],
        fields: &[],
    }
}

/// Everything that a force says: energy, forces, products with its tangent, by its blocks too, and fields of its cells.
fn said(force: &dyn Force, x: &[Vec3], cells: usize) -> Vec<f64> {
    let mut scratch = force.new_scratch();
    let delta: Vec<Vec3> = (0..x.len())
        .map(|i| Vec3::new((i as f64 * 0.7).sin(), (i as f64 * 1.3).cos(), (i as f64 * 2.1).sin()))
        .collect();
    let weights = TangentWeights { position: 1.0, velocity: 0.5 };
    let [mut forces, mut product, mut by_blocks] = [0, 1, 2].map(|_| vec![Vec3::ZERO; x.len()]);
    let energy = force.energy(&at(x), &mut scratch).stored;
    force.add_force(&at(x), &mut scratch, &mut forces);
    force.add_differential(&at(x), weights, &delta, &mut scratch, &mut product);
    let mut pattern = PatternBuilder::new(x.len());
    force.visit_cliques(&[], &mut |rows| pattern.add_clique(rows).unwrap());
    let mut matrix = BlockMatrix::zeros(Arc::new(pattern.build().unwrap()));
    force.add_blocks(&at(x), weights, &mut scratch, &mut matrix);
    matrix.apply(&delta, &mut by_blocks);
    let vectors = forces.into_iter().chain(product).chain(by_blocks).flat_map(Vec3::to_array);
    let fields = (0..cells).filter_map(|cell| force.cell_field(cell, x)).flat_map(|field| {
        let matrices = [field.deformation, field.stress, field.cauchy];
        let entries = matrices.into_iter().flat_map(|matrix| matrix.columns.map(Vec3::to_array)).flatten();
        entries.chain([field.energy_density, field.current_volume]).collect::<Vec<f64>>()
    });
    [energy].into_iter().chain(vectors).chain(fields).collect()
}

/// Each number is another's, to rounding of the largest of its neighbours.
fn assert_same(own: &[f64], other: &[f64], what: &str) {
    assert_eq!(own.len(), other.len());
    let largest = own.iter().fold(0.0_f64, |largest, number| largest.max(number.abs()));
    for (a, b) in own.iter().zip(other) {
        // sums of a thousand products of numbers turned there and back
        assert!((a - b).abs() <= 1e-12 * largest, "{what}: {a} for {b}, of {largest}");
    }
}

/// One law along the axes of each cell is two laws, each along its own direction of the world: of volumes of all kinds, of plane strain, and
/// damping by the stiffness at rest.
#[test]
fn axes_are_directions_of_the_law_in_solids() {
    for (element, energy) in ["tet4", "hex8", "prism6", "pyramid5", "hex20"]
        .into_iter()
        .flat_map(|element| LAWS.map(|energy| (element, energy)))
    {
        let mesh = bar(element);
        let cells = mesh.cell_count();
        let of_cell: Vec<u16> = (0..cells).map(|cell| (cell % 2) as u16).collect();
        let axes: Vec<Mat3> = of_cell.iter().map(|number| turns()[usize::from(*number)]).collect();
        let in_world = turns().map(|turn| law_along(energy, turn * DIRECTION));
        let along = [law_along(energy, DIRECTION)];
        let describe = |materials, material_of_cell, axes| SolidDescription {
            name: "bar".into(),
            mesh: &mesh,
            first_row: 0,
            materials,
            material_of_cell,
            axes,
            quadrature: Quadrature::Default,
            section: Section::Solid,
        };
        let all_one = vec![0; cells];
        let [own, other] = [describe(&along, &all_one, &axes), describe(&in_world, &of_cell, &[])];
        let wave = |p: &Vec3| Vec3::new((7.0 * p.y).sin(), (5.0 * p.x + p.z).cos(), (3.0 * p.x).sin());
        let x: Vec<Vec3> = mesh.points.iter().map(|p| *p + wave(p) * 0.02).collect();
        let what = format!("{energy} on {element}");
        let solids = [&own, &other].map(|description| SolidForce::new(description).unwrap());
        assert_same(&said(&solids[0], &x, cells), &said(&solids[1], &x, cells), &what);
        let damped = [&own, &other].map(|description| RayleighDamping::new(description, 0.01).unwrap());
        assert_same(&said(&damped[0], &x, cells), &said(&damped[1], &x, cells), &what);
    }
}

/// Plane strain along axes, at rows of samples.
#[test]
fn axes_are_directions_of_the_law_in_plane_strain() {
    let values = Values::new()
        .with("length", Value::Number(1.0))
        .with("width", Value::Number(0.4))
        .with("cells_along", Value::Integer(5))
        .with("cells_across", Value::Integer(3))
        .with("element", Value::Text("quad4"));
    let mesh = souple_mesh::generate("sheet", values).unwrap();
    let turn = exponential(Vec3::new(0.0, 0.0, 0.7));
    let (cells, of_cell) = (mesh.cell_count(), vec![0; mesh.cell_count()]);
    let direction = Vec3::new(0.8, 0.6, 0.0);
    let [along, in_world] = [direction, turn * direction].map(|direction| [law_along(LAWS[0], direction)]);
    let axes = vec![turn; cells];
    let describe = |materials, axes| SolidDescription {
        name: "sheet".into(),
        mesh: &mesh,
        first_row: 0,
        materials,
        material_of_cell: &of_cell,
        axes,
        quadrature: Quadrature::Default,
        section: Section::PlaneStrain { thickness: 0.1 },
    };
    let x: Vec<Vec3> = mesh
        .points
        .iter()
        .map(|p| *p + Vec3::new((4.0 * p.y).sin(), (5.0 * p.x).cos(), 0.0) * 0.02)
        .collect();
    let [own, other] = [describe(&along, &axes[..]), describe(&in_world, &[])]
        .map(|description| said(&SolidForce::new(&description).unwrap(), &x, cells));
    assert_same(&own, &other, "plane strain");
}

/// The same of a body that frames carry, with both kinds of tangent.
#[test]
fn axes_are_directions_of_the_law_in_frames() {
    let mesh = bar("hex8");
    let cells = mesh.cell_count();
    let frames: Vec<Frame> = (0..4)
        .map(|i| Frame { origin: Vec3::new(f64::from(i) / 3.0, 0.2, 0.15), axes: Mat3::IDENTITY })
        .collect();
    let stiffness = vec![1.0; cells];
    let entry = WEIGHTS.find("wendland").unwrap();
    let shape = Shape { frames: &frames, mesh: &mesh, stiffness_of_cell: &stiffness };
    let weights = (entry.build)(&entry.values(Values::new()).unwrap(), &shape).unwrap();
    let entry = POINTS.find("cells").unwrap();
    let samples = (entry.build)(&entry.values(Values::new()).unwrap(), &mesh, &vec![0; cells]);
    let carry = |place: Vec3| Carried::new(&frames, &weights.shares(place), place);
    let carried: Vec<Carried> = samples.iter().map(|sample| carry(sample.position)).collect();
    let rows: Vec<u32> = (0..4).map(|frame| 4 * frame).collect();
    let of_cell: Vec<u16> = (0..cells).map(|cell| (cell % 2) as u16).collect();
    let axes: Vec<Mat3> = of_cell.iter().map(|number| turns()[usize::from(*number)]).collect();
    let mut x: Vec<Vec3> =
        frames.iter().flat_map(|frame| [frame.origin, Vec3::X, Vec3::Y, Vec3::Z]).collect();
    for (row, position) in x.iter_mut().enumerate() {
        let number = |k: f64| (row as f64 * 1.7 + k).sin();
        *position += Vec3::new(number(0.0), number(1.0), number(2.0)) * 0.03;
    }
    for (energy, tangent) in LAWS
        .into_iter()
        .flat_map(|law| [TangentKind::Full, TangentKind::Material].map(|tangent| (law, tangent)))
    {
        let force = |materials: &[Material], material_of_cell: &[u16], axes: &[Mat3]| {
            FramesForce::new(FramesDescription {
                name: "bar".into(),
                frames: &frames,
                row_of_frame: &rows,
                samples: &samples,
                carried: &carried,
                carried_cells: mesh.cell_centres().into_iter().map(carry).collect(),
                cell_volumes: mesh.cell_volumes(),
                materials,
                material_of_cell,
                axes,
                tangent,
            })
        };
        let own = force(&[law_along(energy, DIRECTION)], &vec![0; cells], &axes);
        let in_world = turns().map(|turn| law_along(energy, turn * DIRECTION));
        let other = force(&in_world, &of_cell, &[]);
        assert_same(&said(&own, &x, cells), &said(&other, &x, cells), &format!("{energy}, {tangent:?}"));
    }
}
