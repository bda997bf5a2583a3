//! Images one after another: in memory, or in a file as they are made, so that a film takes no more memory than an image.

use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

use super::image::Image;
use crate::IoError;

/// Images of one size that are had one after another, as often as they are asked for.
pub trait Images {
    /// Width and height [pixels]; `None` where there is no image.
    fn size(&self) -> Option<[usize; 2]>;

    fn count(&self) -> usize;

    /// Calls with each image in turn.
    ///
    /// # Errors
    /// The first that a call gives, or why an image cannot be had.
    fn each(&self, visit: &mut dyn FnMut(&Image) -> io::Result<()>) -> io::Result<()>;
}

impl Images for [Image] {
    fn size(&self) -> Option<[usize; 2]> {
        self.first().map(|image| [image.width, image.height])
    }

    fn count(&self) -> usize {
        self.len()
    }

    fn each(&self, visit: &mut dyn FnMut(&Image) -> io::Result<()>) -> io::Result<()> {
        self.iter().try_for_each(visit)
    }
}

/// Images in a file of their own, lightly compressed; the file goes with them.
pub struct ImageFile {
    path: PathBuf,
    file: File,
    size: Option<[usize; 2]>,
    /// Bytes of each.
    lengths: Vec<u64>,
}

impl ImageFile {
    /// A new file without images.
    ///
    /// # Errors
    /// There is such a file, or it cannot be made.
    pub fn create(path: &Path) -> Result<Self, IoError> {
        let file = OpenOptions::new().read(true).write(true).create_new(true).open(path);
        let file = file.map_err(|source| IoError::write(path, source))?;
        Ok(Self { path: path.to_owned(), file, size: None, lengths: Vec::new() })
    }

    /// Writes one more image.
    ///
    /// # Errors
    /// It has another size than the first; the file cannot be written.
    pub fn push(&mut self, image: &Image) -> Result<(), IoError> {
        let size = [image.width, image.height];
        let [width, height] = *self.size.get_or_insert(size);
        if size != [width, height] {
            let found = format!("{} x {}", image.width, image.height);
            let expected = format!("{width} x {height}, as of the first");
            return Err(IoError::request("the size of an image", found, expected));
        }
        let compressed = || {
            let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
            encoder.write_all(image.pixels.as_flattened())?;
            encoder.finish()
        };
        let written = compressed().and_then(|bytes| self.file.write_all(&bytes).map(|()| bytes.len() as u64));
        self.lengths.push(written.map_err(|source| IoError::write(&self.path, source))?);
        Ok(())
    }
}

impl Images for ImageFile {
    fn size(&self) -> Option<[usize; 2]> {
        self.size
    }

    fn count(&self) -> usize {
        self.lengths.len()
    }

    fn each(&self, visit: &mut dyn FnMut(&Image) -> io::Result<()>) -> io::Result<()> {
        let [width, height] = self.size.unwrap_or_default();
        let mut image = Image { width, height, pixels: vec![[0; 3]; width * height] };
        let mut from = 0;
        for length in &self.lengths {
            // a handle of its own: reading leaves the place for the next image alone
            let mut file = File::open(&self.path)?;
            file.seek(SeekFrom::Start(from))?;
            let mut decoder = ZlibDecoder::new(BufReader::new(file.take(*length)));
            decoder.read_exact(image.pixels.as_flattened_mut())?;
            visit(&image)?;
            from += length;
        }
        Ok(())
    }
}

impl Drop for ImageFile {
    fn drop(&mut self) {
        // a file that stays in a folder of temporary files does no harm
        let _ = std::fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TemporaryFolder;

    /// Images come back from their file as they were, in order, as often as asked; the file goes with them.
    #[test]
    fn images_come_back_from_their_file() {
        let folder = TemporaryFolder::new("images");
        let path = folder.path("film.images");
        let image =
            |shade: u8| Image { width: 7, height: 5, pixels: (0..35).map(|k| [shade, k, 3]).collect() };
        let mut file = ImageFile::create(&path).unwrap();
        assert_eq!((file.size(), file.count()), (None, 0));
        (0..4).for_each(|shade| file.push(&image(shade)).unwrap());
        let uneven = Image { width: 5, height: 7, ..image(0) };
        assert!(file.push(&uneven).unwrap_err().to_string().contains("5 x 7; expected 7 x 5"));
        for _ in 0..2 {
            let mut met = Vec::new();
            file.each(&mut |image| {
                met.push(image.clone());
                Ok(())
            })
            .unwrap();
            assert_eq!(met, (0..4).map(image).collect::<Vec<_>>());
        }
        assert!(ImageFile::create(&path).is_err());
        drop(file);
        assert!(!path.exists());
    }
}
