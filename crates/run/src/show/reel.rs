//! A run as it lies on disk: its moments are read when they are shown, and no others.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use souple_io::{SeriesPart, read_series};
use souple_mesh::Mesh;
use souple_table::counted;

use super::gap::add_gap;
use super::{BodyMoment, Moment, Show, ShowError, Stage};

/// The moments of a run, or of a mesh by itself.
#[derive(Clone, Debug)]
pub struct Reel {
    pub stage: Stage,
    /// Of each moment [s].
    times: Vec<f64>,
    takes: Takes,
    /// The run from whose bodies the field `gap` is measured.
    against: Option<Box<Reel>>,
}

#[derive(Clone, Debug)]
enum Takes {
    /// Of each body the file of each moment.
    Files(Vec<Series>),
    Held(Vec<Moment>),
}

#[derive(Clone, Debug)]
struct Series {
    name: String,
    files: Vec<PathBuf>,
}

impl Reel {
    /// The frames of a run's folder, of which none is read yet.
    ///
    /// # Errors
    /// There are none, their times differ from body to body, or a list of them cannot be read.
    pub fn of_run(folder: &Path, stage: Stage) -> Result<Self, ShowError> {
        let no_frames = |found: String| Err(ShowError::NoFrames { folder: folder.to_owned(), found });
        let frames = folder.join("frames");
        let Ok(entries) = std::fs::read_dir(&frames) else {
            return no_frames("there is no folder `frames` that can be read".to_owned());
        };
        let mut lists: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        lists.retain(|path| path.extension().is_some_and(|extension| extension == "pvd"));
        lists.sort();
        if lists.is_empty() {
            return no_frames("there is no series (`.pvd`) in `frames`".to_owned());
        }
        Self::of_lists(folder, &lists, stage)
    }

    /// The bodies of some lists of frames, each part of a list a body.
    fn of_lists(from: &Path, lists: &[PathBuf], stage: Stage) -> Result<Self, ShowError> {
        let mut times: Vec<f64> = Vec::new();
        let mut takes: Vec<Series> = Vec::new();
        for list in lists {
            let stem = list.file_stem().unwrap_or_default().to_string_lossy();
            let parts = read_series(list)?;
            let is_one = parts.len() == 1;
            for SeriesPart { name, frames } in parts {
                let name = if is_one { stem.to_string() } else { format!("{stem} {name}") };
                let (own, files): (Vec<f64>, Vec<PathBuf>) = frames.into_iter().unzip();
                if takes.is_empty() {
                    times.clone_from(&own);
                }
                if let Some(difference) = difference(&own, &times) {
                    let found =
                        format!("the times of `{name}` are not those of the body before it: {difference}");
                    return Err(ShowError::NoFrames { folder: from.to_owned(), found });
                }
                takes.push(Series { name, files });
            }
        }
        Ok(Self { stage, times, takes: Takes::Files(takes), against: None })
    }

    /// A mesh by itself, as it stands.
    pub fn of_mesh(name: &str, mesh: Mesh) -> Self {
        let Show { stage, moments } = Show::of_mesh(name, mesh);
        let times = moments.iter().map(|moment| moment.time).collect();
        Self { stage, times, takes: Takes::Held(moments), against: None }
    }

    /// A mesh and its fields as its file has them, and what is to be said of them.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn of_file(path: &Path) -> Result<(Self, Vec<String>), ShowError> {
        let souple_io::Dataset { mesh, point_fields, cell_fields, notes, .. } =
            souple_io::read_dataset(path)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let mut reel = Self::of_mesh(&name, mesh);
        if let Takes::Held(moments) = &mut reel.takes {
            for body in moments.iter_mut().flat_map(|moment| &mut moment.bodies) {
                (body.point_fields, body.cell_fields) = (point_fields.clone(), cell_fields.clone());
            }
        }
        Ok((reel, notes))
    }

    /// The bodies of one list of frames.
    ///
    /// # Errors
    /// The list cannot be read, or its parts have other times.
    pub fn of_series(list: &Path) -> Result<Self, ShowError> {
        let title = list.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut stage = Stage::default();
        stage.title = title;
        Self::of_lists(list, &[list.to_owned()], stage)
    }

    /// Without the bodies that wear a skin, which hides them.
    #[must_use]
    pub fn without_worn(mut self) -> Self {
        match &mut self.takes {
            Takes::Files(takes) => {
                let skins: Vec<String> = takes.iter().map(|series| series.name.clone()).collect();
                takes.retain(|series| !skins.contains(&crate::frames::worn_by(&series.name)));
            }
            Takes::Held(moments) => {
                *moments = std::mem::take(moments).into_iter().map(Moment::without_worn).collect();
            }
        }
        self
    }

    /// With the field `gap`, see [`Show::against`].
    #[must_use]
    pub fn against(mut self, other: Self) -> Self {
        self.against = Some(Box::new(other));
        self
    }

    /// Of all moments [s].
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The moment nearest to a time [s].
    pub fn nearest(&self, time: f64) -> usize {
        let off = |index: &usize| (self.times[*index] - time).abs();
        (0..self.times.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
    }

    /// At most `count` moments, those nearest to times that are evenly spread over the run, the first and the last among them.
    pub fn chosen(&self, count: usize) -> Vec<usize> {
        let all = self.times.len();
        let wanted = count.clamp(1, all.max(1));
        if wanted == 1 {
            return (all.saturating_sub(1)..all).collect();
        }
        let (start, end) = (self.times[0], self.times[all - 1]);
        let mut chosen: Vec<usize> = Vec::with_capacity(wanted);
        for index in 0..wanted {
            let time = start + (end - start) * index as f64 / (wanted - 1) as f64;
            // each one after the one before, and as many left as are to come
            let first = chosen.last().map_or(0, |last| last + 1);
            let left = wanted - index - 1;
            chosen.push(if left == 0 { all - 1 } else { self.nearest(time).clamp(first, all - 1 - left) });
        }
        chosen
    }

    /// Reads a moment; `before` lends its meshes where cells are the same.
    ///
    /// # Errors
    /// A file cannot be read; the other run of a `gap` has no body of a name.
    pub fn moment(&self, index: usize, before: Option<&Moment>) -> Result<Moment, ShowError> {
        let mut moment = match &self.takes {
            Takes::Held(moments) => moments[index].clone(),
            Takes::Files(takes) => {
                let body = |series: &Series| {
                    let known =
                        before.and_then(|moment| moment.bodies.iter().find(|b| b.name == series.name));
                    BodyMoment::of_file(&series.name, &series.files[index], known.map(|body| &body.mesh))
                };
                let is_drawn = |series: &&Series| carried_by(takes, series).is_none();
                let bodies: Result<_, _> = takes.iter().filter(is_drawn).map(body).collect();
                let mut moment = Moment { time: self.times[index], bodies: bodies? };
                for series in takes {
                    let Some(carried) = carried_by(takes, series) else { continue };
                    let read = body(series)?;
                    let frames = crate::frames::carriers_from(&read.positions, &read.point_fields);
                    let of = moment.bodies.iter_mut().find(|body| body.name == carried.name);
                    of.into_iter().for_each(|body| body.frames.clone_from(&frames));
                }
                moment
            }
        };
        if let Some(other) = &self.against {
            let there = other.moment(other.nearest(moment.time), None)?;
            add_gap(&mut moment, &there.bodies)?;
        }
        Ok(moment)
    }

    /// The last moment that can be drawn, or the last if none can.
    ///
    /// # Errors
    /// As [`Self::moment`].
    pub fn last_drawable(&self) -> Result<Moment, ShowError> {
        let last = self.times.len() - 1;
        for index in (0..=last).rev() {
            let moment = self.moment(index, None)?;
            if moment.is_drawable() {
                return Ok(moment);
            }
        }
        self.moment(last, None)
    }

    /// Some moments, all in memory.
    ///
    /// # Errors
    /// As [`Self::moment`].
    pub fn show(&self, indices: &[usize]) -> Result<Show, ShowError> {
        let mut moments: Vec<Moment> = Vec::with_capacity(indices.len());
        for index in indices {
            let moment = self.moment(*index, moments.last())?;
            moments.push(moment);
        }
        Ok(Show { stage: self.stage.clone(), moments })
    }
}

/// The body whose frames a series holds, if it does.
fn carried_by<'a>(takes: &'a [Series], series: &Series) -> Option<&'a Series> {
    takes.iter().find(|body| crate::frames::carriers_of(&body.name) == series.name)
}

/// What differs between the times of a body and those of another.
fn difference(own: &[f64], others: &[f64]) -> Option<String> {
    let frame = own.iter().zip(others).position(|(own, other)| own != other);
    match frame {
        Some(frame) => Some(format!("frame {frame} is of {} s, not of {} s", own[frame], others[frame])),
        None if own.len() != others.len() => {
            Some(format!("it has {}, not {}", counted(own.len() as u64, "frame"), others.len()))
        }
        None => None,
    }
}

impl BodyMoment {
    /// `known`: the mesh of a frame before, taken again where the cells are the same.
    fn of_file(name: &str, path: &Path, known: Option<&Arc<Mesh>>) -> Result<Self, souple_io::IoError> {
        let souple_io::Dataset { mesh, point_fields, cell_fields, .. } = souple_io::read_dataset(path)?;
        // the cells of a sheet are read as facets, fields on them in the same order
        let mesh = if mesh.cell_count() == 0 { mesh.facets_as_cells() } else { mesh };
        let positions = mesh.points.clone();
        let mesh = match known {
            Some(known) if known.blocks == mesh.blocks && known.points.len() == mesh.points.len() => {
                Arc::clone(known)
            }
            _ => Arc::new(mesh),
        };
        Ok(Self { name: name.to_owned(), mesh, positions, point_fields, cell_fields, frames: Vec::new() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments are those nearest to times evenly apart, each once, the first and the last among them; also where times are uneven.
    #[test]
    fn moments_are_evenly_spread() {
        let chosen = |times: &[f64], count: usize| {
            let takes = Takes::Held(Vec::new());
            let reel = Reel { stage: Stage::default(), times: times.to_vec(), takes, against: None };
            reel.chosen(count)
        };
        let even: Vec<f64> = (0..=30).map(f64::from).collect();
        assert_eq!(chosen(&even, 7), [0, 5, 10, 15, 20, 25, 30]);
        assert_eq!(chosen(&even, 9), [0, 4, 7, 11, 15, 19, 22, 26, 30]);
        let ten: Vec<f64> = (0..10).map(f64::from).collect();
        assert_eq!(chosen(&ten, 4), [0, 3, 6, 9]);
        assert_eq!((chosen(&ten, 1), chosen(&ten, 99).len()), (vec![9], 10));
        let uneven = [0.0, 0.1, 0.2, 0.3, 1.0];
        assert_eq!((chosen(&uneven, 3), chosen(&uneven, 4)), (vec![0, 3, 4], vec![0, 2, 3, 4]));
        assert_eq!(chosen(&[2.0, 2.0, 2.0], 2), [0, 2]);
        assert!(chosen(&[], 3).is_empty());
    }
}
