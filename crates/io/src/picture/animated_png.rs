//! Animations as APNG: every colour, played by browsers; programs that know only PNG show the first image.

use std::path::Path;

use super::image::cause;
use super::images::Images;
use crate::{IoError, write_file};

/// Images of one size, each shown for `seconds`, over and over.
///
/// # Errors
/// No images, a time out of range; the file cannot be written, or an image not be had.
pub fn write_animated_png(path: &Path, images: &(impl Images + ?Sized), seconds: f64) -> Result<(), IoError> {
    let [width, height] = check(images, seconds)?;
    write_file(path, |out| {
        let mut encoder = png::Encoder::new(out, width as u32, height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_animated(images.count() as u32, 0)?;
        encoder.set_frame_delay((seconds * 1000.0).round() as u16, 1000)?;
        let mut writer = encoder.write_header().map_err(cause)?;
        images.each(&mut |image| writer.write_image_data(image.pixels.as_flattened()).map_err(cause))?;
        writer.finish().map_err(cause)
    })
}

/// Longest time of one image [s].
const LONGEST: f64 = 60.0;
const MOST_IMAGES: usize = 100_000;

/// The size of images that can be played.
pub(super) fn check(images: &(impl Images + ?Sized), seconds: f64) -> Result<[usize; 2], IoError> {
    let Some(size) = images.size().filter(|_| images.count() <= MOST_IMAGES) else {
        let expected = format!("1 to {MOST_IMAGES}");
        return Err(IoError::request("the number of images", images.count(), expected));
    };
    if !(0.001..=LONGEST).contains(&seconds) {
        let expected = format!("0.001 to {LONGEST} s");
        return Err(IoError::request("the time of an image", seconds, expected));
    }
    Ok(size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Image;
    use crate::testing::TemporaryFolder;

    pub(in super::super) fn images() -> Vec<Image> {
        let pixel = |index: usize, frame: usize| [(index * 5 % 256) as u8, (frame * 60) as u8, 128];
        let image = |frame: usize| Image {
            width: 20,
            height: 10,
            pixels: (0..200).map(|index| pixel(index, frame)).collect(),
        };
        (0..4).map(image).collect()
    }

    /// All images come back as the same pixels, each with its time.
    #[test]
    fn images_come_back() {
        let folder = TemporaryFolder::new("apng");
        let path = folder.path("a.png");
        write_animated_png(&path, &images()[..], 0.04).unwrap();
        let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        for image in images() {
            let mut pixels = vec![0; 600];
            reader.next_frame(&mut pixels).unwrap();
            let delay = reader.info().frame_control().unwrap();
            assert_eq!((f64::from(delay.delay_num) / f64::from(delay.delay_den)), 0.04);
            assert_eq!(pixels, image.pixels.as_flattened());
        }
    }

    #[test]
    fn faulty_animations_are_refused() {
        let path = Path::new("never.png");
        let refused = |images: &[Image], seconds: f64| {
            write_animated_png(path, images, seconds).unwrap_err().to_string()
        };
        assert!(refused(&[], 0.1).contains("the number of images is 0"));
        assert!(refused(&images(), f64::NAN).contains("the time of an image is NaN"));
        assert!(refused(&images(), 0.0).contains("expected 0.001 to 60 s"));
    }
}
