//! Bodies with faces: which masses are of which, and what of them others meet.

use std::ops::Range;

use souple_math::Vec3;
use souple_mesh::{MOST_HULL_POINTS, convex_hull};
use souple_models::network::{Polyhedra, PolyhedraDescription, Polyhedron};

use super::super::start;
use super::constraints::{HOLDS, Making};
use crate::diagnostic::Code;
use crate::scene::FacesInfo;
use crate::spec::network::{ConstraintKind, ConstraintSpec, FacesForm, FacesSpec, Network};

/// A body of a constraint: its name, its masses, and its triangles between these.
struct Faced<'a> {
    name: &'a str,
    masses: Range<u32>,
    triangles: Vec<[u32; 3]>,
}

/// The bodies of a table, in the order of its groups.
fn bodies_of<'a>(
    spec: &'a FacesSpec,
    network: &Network,
    points: &[Vec3],
) -> impl Iterator<Item = Result<Faced<'a>, (String, String)>> {
    let all = (spec.of.is_empty()).then_some(("all masses", 0..points.len() as u32));
    let named = spec.of.iter().filter_map(|name| Some((name.as_str(), network.numbers_of(name)?)));
    all.into_iter().chain(named).map(|(name, masses)| {
        let places = &points[masses.start as usize..masses.end as usize];
        let triangles = triangles_of(&spec.form, name, places)?;
        let of_network = triangles.into_iter().map(|corners| corners.map(|corner| masses.start + corner));
        Ok(Faced { name, triangles: of_network.collect(), masses })
    })
}

/// The triangles of a form between masses that rest at places; what is wrong, and what would be accepted.
fn triangles_of(form: &FacesForm, name: &str, places: &[Vec3]) -> Result<Vec<[u32; 3]>, (String, String)> {
    let count = places.len();
    match form {
        FacesForm::Balls(_) => Ok(Vec::new()),
        FacesForm::Triangles(triangles) => match triangles.as_flattened().iter().max() {
            Some(most) if *most as usize >= count => {
                let message = format!("`triangles` are of mass {most}, and `{name}` has {count}");
                Err((message, format!("numbers below {count}")))
            }
            _ => Ok(triangles.clone()),
        },
        FacesForm::Hull if count > MOST_HULL_POINTS => {
            let message =
                format!("`{name}` has {count} masses, and a hull is found of {MOST_HULL_POINTS} at most");
            Err((message, format!("`triangles`, or {MOST_HULL_POINTS} masses at most")))
        }
        FacesForm::Hull => convex_hull(places).ok_or_else(|| {
            let message = format!("the masses of `{name}` rest in one plane, and have no hull");
            (message, "at least four masses that are not in one plane, or `triangles`".to_owned())
        }),
    }
}

/// Whether two masses are of one body that is drawn by its faces.
pub fn hide(network: &Network, ends: [u32; 2]) -> bool {
    let is_of = |spec: &FacesSpec| {
        let holds = |masses: Range<u32>| ends.iter().all(|end| masses.contains(end));
        !matches!(spec.form, FacesForm::Balls(_))
            && (spec.of.is_empty() || spec.of.iter().filter_map(|name| network.numbers_of(name)).any(holds))
    };
    network.constraints.iter().flat_map(tables).any(is_of)
}

/// What a constraint says of bodies with faces.
fn tables(constraint: &ConstraintSpec) -> &[FacesSpec] {
    match &constraint.kind {
        Some(ConstraintKind::Faces(bodies)) => bodies,
        _ => &[],
    }
}

/// What of a network is drawn as faces.
pub fn shown(network: &Network, points: &[Vec3]) -> Option<FacesInfo> {
    let mut info = FacesInfo::default();
    // what is refused has been told
    let bodies = network.constraints.iter().flat_map(tables);
    for body in bodies.flat_map(|spec| bodies_of(spec, network, points)).flatten() {
        if !body.triangles.is_empty() && !info.bodies.contains(&body.masses) {
            info.triangles.extend(body.triangles);
            info.bodies.push(body.masses);
        }
    }
    (!info.bodies.is_empty()).then_some(info)
}

impl Making<'_> {
    /// Bodies that keep out of each other.
    pub(super) fn faces(&self, name: String, tables: &[FacesSpec], timestep: f64) -> Option<Polyhedra> {
        let points = &self.body.mesh.points;
        let (mut names, mut bodies) = (Vec::new(), Vec::new());
        for spec in tables {
            for body in bodies_of(spec, self.network, points) {
                let body = match body {
                    Ok(body) => body,
                    Err((message, expected)) => {
                        self.draft.log.add(Code::Conflict, &spec.site, message, expected);
                        return None;
                    }
                };
                names.push(body.name);
                bodies.push(match spec.form {
                    FacesForm::Balls(radius) => {
                        Polyhedron::Balls(body.masses.map(|mass| self.row(mass)).collect(), radius)
                    }
                    _ => {
                        let of_rows = body.triangles.into_iter().map(|it| it.map(|mass| self.row(mass)));
                        Polyhedron::Faces(of_rows.collect())
                    }
                });
            }
        }
        let count = bodies.len();
        let description = PolyhedraDescription {
            name,
            bodies,
            law: self.spec.law,
            timestep,
            detection: self.draft.spec.world.detection,
        };
        let polyhedra = Polyhedra::new(description, &self.rows_at(points));
        if !polyhedra.may_meet() {
            let message = format!("none of the {count} bodies meets another");
            return self.refuse(
                Code::Conflict,
                message,
                "at least two bodies that share no corners, and faces of one of them",
            );
        }
        let places = start::places(self.body.spec.start.as_ref(), points);
        let scale =
            places.iter().flat_map(|place| place.to_array()).fold(0.0_f64, |most, x| most.max(x.abs()));
        if let Some(entered) = polyhedra.entered(&self.rows_at(&places), HOLDS * scale) {
            let [one, other] = entered.bodies.map(|body| names[body]);
            let mass = entered.row as usize - self.body.rows.start;
            let message = format!(
                "`{one}` begins within `{other}`, by mass {mass} of the network or an edge from there"
            );
            return self.refuse(Code::Conflict, message, "bodies that begin apart, or touch");
        }
        Some(polyhedra)
    }
}
