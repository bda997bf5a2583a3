//! Textures of bodies: reads their pictures.

use std::sync::Arc;

use souple_io::IoError;
use souple_io::picture::{Texture, TextureFigure, read_texture};

use super::{Draft, Placed};
use crate::diagnostic::{Code, Site};
use crate::spec::texture::FigureSpec;

/// The texture of a body; `None` where it has none, or where it was refused, which is reported.
pub fn texture(draft: &Draft, body: &Placed) -> Option<Arc<Texture>> {
    let spec = body.spec.texture.as_ref()?;
    let figure = match &spec.figure {
        FigureSpec::Pattern(pattern, colours) => TextureFigure::Pattern(*pattern, *colours),
        FigureSpec::File { file, site } => picture(draft, file, site)?,
    };
    if body.mesh.boundary_surface().triangles.is_empty() {
        let message = format!("body `{}` has no surface that could have a texture", body.spec.name);
        let site = &body.spec.site;
        draft.log.add(Code::Conflict, site, message, "a mesh of volumes or of sheets, or no `texture`");
        return None;
    }
    Some(Arc::new(Texture { figure, size: spec.size }))
}

fn picture(draft: &Draft, file: &str, site: &Site) -> Option<TextureFigure> {
    let read = match draft.sources.open(site.place.source, file) {
        Ok(path) => read_texture(&path),
        Err(source) => {
            let path = draft.sources.get(site.place.source).folder.join(file);
            Err(IoError::Read { path, source })
        }
    };
    match read {
        Ok(image) => Some(TextureFigure::Picture(Arc::new(image))),
        Err(error) => {
            let code = match &error {
                IoError::Read { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                    Code::NotFound
                }
                IoError::Request { .. } => Code::TooLarge,
                _ => Code::Unreadable,
            };
            draft.log.add(code, site, error.to_string(), "a PNG of at most 4096 pixels along a side");
            None
        }
    }
}
