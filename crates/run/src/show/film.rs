//! A show as a film by `ffmpeg`, where the machine has it.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use souple_io::picture::Images;

/// A film that could not be made.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    #[error("`ffmpeg` is not on this machine ({0}); files called .gif and .apng are made without it")]
    Missing(std::io::Error),
    #[error("`ffmpeg` did not make {}: {message}", .path.display())]
    Failed { path: PathBuf, message: String },
    #[error("a film of {width} x {height} pixels cannot be compressed")]
    Odd { width: usize, height: usize },
}

/// Images of one size as H.264 in MP4, written beside and renamed.
///
/// # Errors
/// There is no `ffmpeg`, or it fails; an odd number of pixels.
pub fn write_film(path: &Path, images: &(impl Images + ?Sized), per_second: f64) -> Result<(), FilmError> {
    let Some([width, height]) = images.size() else { return Ok(()) };
    if width % 2 != 0 || height % 2 != 0 {
        return Err(FilmError::Odd { width, height });
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let beside = path.with_file_name(format!(".{name}.{}.part.mp4", std::process::id()));
    let result = pipe(&beside, images, [width, height], per_second).and_then(|()| {
        std::fs::rename(&beside, path)
            .map_err(|error| FilmError::Failed { path: path.to_owned(), message: error.to_string() })
    });
    if result.is_err() {
        // the first failure is the one to tell
        let _ = std::fs::remove_file(&beside);
    }
    result
}

fn pipe(
    path: &Path,
    images: &(impl Images + ?Sized),
    [width, height]: [usize; 2],
    per_second: f64,
) -> Result<(), FilmError> {
    let size = format!("{width}x{height}");
    let fail = |message: String| FilmError::Failed { path: path.to_owned(), message };
    let mut command = Command::new("ffmpeg");
    command.args(["-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s"]).arg(&size);
    command.arg("-r").arg(format!("{per_second}")).args(["-i", "-", "-an", "-c:v", "libx264", "-crf", "18"]);
    command.args(["-pix_fmt", "yuv420p", "-movflags", "+faststart"]).arg(path);
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(FilmError::Missing)?;
    let mut written = Ok(());
    if let Some(mut pipe) = child.stdin.take() {
        written = images.each(&mut |image| pipe.write_all(image.pixels.as_flattened()));
    }
    let output = child.wait_with_output().map_err(|error| fail(error.to_string()))?;
    if !output.status.success() {
        return Err(fail(String::from_utf8_lossy(&output.stderr).trim().to_owned()));
    }
    written.map_err(|error| fail(error.to_string()))
}
