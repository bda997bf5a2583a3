//! What is doubtful of a run that is over: values that are no numbers, matter that is inside out.

use souple_mesh::Mesh;
use souple_table::counted;

use crate::{Session, Trace};

/// Probes that read what is no number or has no end, and since when.
pub fn of_traces(traces: &[Trace]) -> Vec<String> {
    let doubt = |trace: &Trace| {
        let is_number = |step: &usize| trace.value(*step).is_some_and(|v| v.iter().all(|v| v.is_finite()));
        let steps = trace.times.len();
        let first = (0..steps).find(|step| !is_number(step))?;
        let lost = (first..steps).filter(|step| !is_number(step)).count();
        Some(format!(
            "probe `{}` is no number at {lost} of {}, first at {:.6} s: there is no {} then, or nothing that it can be read off",
            trace.name,
            counted(steps as u64, "time"),
            trace.times[first],
            trace.quantity,
        ))
    };
    traces.iter().filter_map(doubt).collect()
}

/// Bodies with cells that are inside out where the run ends.
pub fn of_bodies(session: &Session) -> Vec<String> {
    let mut doubts = Vec::new();
    for body in &session.bodies {
        let Some((solid, at)) = session.world.force_named(body.system, &body.force) else { continue };
        // matter that frames carry may fold where no strain is taken: of such the cell is looked at that is drawn
        let drawn = body.frames.is_some().then(|| {
            let rows = session.world.rows(body.system);
            let points = rows.positions[body.rows.clone()].to_vec();
            Mesh { points, ..Mesh::clone(&body.mesh) }.cell_volumes()
        });
        let is_out = |cell: &usize| {
            if let Some(drawn) = &drawn {
                return drawn[*cell] <= 0.0;
            }
            solid
                .cell_field_at(*cell, &at)
                .is_some_and(|field| field.volume > 0.0 && field.current_volume <= 0.0)
        };
        let cells = body.mesh.cell_count();
        // what is cut is no matter any more
        let is_whole = |cell: &usize| body.is_whole(*cell, session.world.time());
        let out: Vec<usize> = (0..cells).filter(is_whole).filter(is_out).collect();
        if let Some(first) = out.first() {
            doubts.push(format!(
                "{} of {cells} of body `{}` {} inside out at the end, the first cell {first}: no matter does that, and what is read off the body \
                 there is not to be trusted; take shorter steps, smaller loads, a finer mesh, or a law that resists it",
                counted(out.len() as u64, "cell"),
                body.name,
                if out.len() == 1 { "is" } else { "are" },
            ));
        }
    }
    doubts
}
