//! Images of few colours: animations as GIF, played everywhere, and small PNG files.

use std::io::Write;
use std::path::Path;

use super::animated_png::check;
use super::image::{Image, cause};
use super::images::Images;
use crate::{IoError, write_file};

/// Images of one size, each shown for `seconds` (to a hundredth), over and over.
///
/// Colours are those of boxes into which the colours of all images are cut at their medians (Heckbert 1982); what of
/// an image is as before is left out of it. Compressed by LZW (Welch 1984).
///
/// # Errors
/// No images or too large ones, a time out of range; the file cannot be written, or an image not be had.
pub fn write_gif(path: &Path, images: &(impl Images + ?Sized), seconds: f64) -> Result<(), IoError> {
    let [width, height] = check(images, seconds)?;
    for (side, name) in [(width, "width"), (height, "height")] {
        if side > usize::from(u16::MAX) {
            return Err(IoError::request(format!("the {name} of a GIF"), side, "at most 65535 pixels"));
        }
    }
    write_file(path, |out| {
        let palette = Palette::of(images)?;
        let size = [width as u16, height as u16];
        out.write_all(b"GIF89a")?;
        words(out, &size)?;
        // a table of 256 colours for all images; no aspect
        out.write_all(&[0xf7, 0, 0])?;
        out.write_all(palette.colours.as_flattened())?;
        out.write_all(b"\x21\xff\x0bNETSCAPE2.0\x03\x01\0\0\0")?;
        let mut shown: Vec<u8> = Vec::new();
        images.each(&mut |image| {
            let indices: Vec<u8> = image.pixels.iter().map(|pixel| palette.nearest(*pixel)).collect();
            let changes = |(index, before): (&u8, &u8)| if index == before { CLEAR_PIXEL } else { *index };
            let data: Vec<u8> = if shown.is_empty() {
                indices.clone()
            } else {
                indices.iter().zip(&shown).map(changes).collect()
            };
            // keep what was, one colour is see-through
            out.write_all(&[0x21, 0xf9, 4, 0x05])?;
            words(out, &[(seconds * 100.0).round().max(2.0) as u16])?;
            out.write_all(&[CLEAR_PIXEL, 0, 0x2c])?;
            words(out, &[0, 0, size[0], size[1]])?;
            out.write_all(&[0, 8])?;
            for block in compressed(&data).chunks(255) {
                out.write_all(&[block.len() as u8])?;
                out.write_all(block)?;
            }
            shown = indices;
            out.write_all(&[0])
        })?;
        out.write_all(&[0x3b])
    })
}

impl Image {
    /// Writes a PNG of at most 255 colours, a third of the size of [`Image::write_png`]: smooth gradients show
    /// steps.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_compact_png(&self, path: &Path) -> Result<(), IoError> {
        let palette =
            Palette::of(std::slice::from_ref(self)).map_err(|source| IoError::write(path, source))?;
        let indices: Vec<u8> = self.pixels.iter().map(|pixel| palette.nearest(*pixel)).collect();
        write_file(path, |out| {
            let mut encoder = png::Encoder::new(out, self.width as u32, self.height as u32);
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_depth(png::BitDepth::Eight);
            encoder.set_palette(palette.colours.as_flattened());
            encoder.set_compression(png::Compression::High);
            // differences of numbers of colours mean nothing
            encoder.set_filter(png::Filter::NoFilter);
            let mut writer = encoder.write_header().map_err(cause)?;
            writer.write_image_data(&indices).map_err(cause)?;
            writer.finish().map_err(cause)
        })
    }
}

/// The last colour stands for what is as before.
const CLEAR_PIXEL: u8 = 255;

fn words(out: &mut dyn Write, words: &[u16]) -> std::io::Result<()> {
    words.iter().try_for_each(|word| out.write_all(&word.to_le_bytes()))
}

/// Bits of a channel by which colours are told apart.
const BITS: usize = 5;

struct Palette {
    colours: [[u8; 3]; 256],
    /// Colour of each cell of the coarse cube.
    nearest: Vec<u8>,
}

/// A cell of the coarse cube with how often it is met, and the sum of its colours.
#[derive(Clone, Copy, Default)]
struct Bin {
    count: u64,
    sums: [u64; 3],
}

fn bin_of(pixel: [u8; 3]) -> usize {
    let [r, g, b] = pixel.map(|value| usize::from(value) >> (8 - BITS));
    (r << BITS | g) << BITS | b
}

impl Palette {
    fn of(images: &(impl Images + ?Sized)) -> std::io::Result<Self> {
        let mut bins = vec![Bin::default(); 1 << (3 * BITS)];
        images.each(&mut |image| {
            for pixel in &image.pixels {
                let bin = &mut bins[bin_of(*pixel)];
                bin.count += 1;
                bin.sums = [0, 1, 2].map(|channel| bin.sums[channel] + u64::from(pixel[channel]));
            }
            Ok(())
        })?;
        let used: Vec<usize> = (0..bins.len()).filter(|bin| bins[*bin].count > 0).collect();
        let mut palette = Self { colours: [[0; 3]; 256], nearest: vec![0; bins.len()] };
        for (index, members) in boxes(&bins, used).into_iter().enumerate() {
            let count: u64 = members.iter().map(|bin| bins[*bin].count).sum();
            palette.colours[index] = [0, 1, 2].map(|channel| {
                let sum: u64 = members.iter().map(|bin| bins[*bin].sums[channel]).sum();
                (sum / count.max(1)) as u8
            });
            members.into_iter().for_each(|bin| palette.nearest[bin] = index as u8);
        }
        Ok(palette)
    }

    fn nearest(&self, pixel: [u8; 3]) -> u8 {
        self.nearest[bin_of(pixel)]
    }
}

/// At most 255 boxes: the one that spreads most, weighed by how often it is met, is cut at its median, again and
/// again.
fn boxes(bins: &[Bin], used: Vec<usize>) -> Vec<Vec<usize>> {
    let mean = |bin: usize, channel: usize| bins[bin].sums[channel] as f64 / bins[bin].count as f64;
    let spread = |members: &[usize]| {
        let along = |channel: usize| {
            let values = members.iter().map(|bin| mean(*bin, channel));
            let (low, high) =
                values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
            high - low
        };
        let widths = [0, 1, 2].map(along);
        let widest = (0..3).max_by(|a, b| widths[*a].total_cmp(&widths[*b])).unwrap_or(0);
        let count: u64 = members.iter().map(|bin| bins[*bin].count).sum();
        (widest, if members.len() > 1 { widths[widest] * (count as f64).sqrt() } else { 0.0 })
    };
    let mut boxes = vec![(spread(&used), used)];
    while boxes.len() < usize::from(CLEAR_PIXEL) {
        let Some(most) = (0..boxes.len()).max_by(|a, b| boxes[*a].0.1.total_cmp(&boxes[*b].0.1)) else {
            break;
        };
        if boxes[most].0.1 <= 0.0 {
            break;
        }
        let ((channel, _), mut members) = boxes.swap_remove(most);
        members.sort_by(|a, b| mean(*a, channel).total_cmp(&mean(*b, channel)).then(a.cmp(b)));
        let half: u64 = members.iter().map(|bin| bins[*bin].count).sum::<u64>() / 2;
        let mut before = 0;
        let reaches = |bin: &usize| {
            before += bins[*bin].count;
            before > half
        };
        let middle = members.iter().position(reaches).unwrap_or(0).clamp(1, members.len() - 1);
        let upper = members.split_off(middle);
        boxes.push((spread(&members), members));
        boxes.push((spread(&upper), upper));
    }
    boxes.into_iter().map(|(_, members)| members).collect()
}

/// LZW with codes of 9 to 12 bits, lowest bits first; the table starts anew when it is full.
fn compressed(data: &[u8]) -> Vec<u8> {
    const CLEAR: u16 = 256;
    const END: u16 = 257;
    const FULL: u16 = 4096;
    let mut bits = BitWriter::default();
    // code of each known string with one byte more: a table of 4096 strings and 256 bytes
    let mut longer = vec![0u16; usize::from(FULL) * 256];
    let (mut next, mut width) = (END + 1, 9);
    bits.push(CLEAR, width);
    let mut string: Option<u16> = None;
    for byte in data {
        let Some(code) = string else {
            string = Some(u16::from(*byte));
            continue;
        };
        let slot = usize::from(code) * 256 + usize::from(*byte);
        if longer[slot] != 0 {
            string = Some(longer[slot]);
            continue;
        }
        bits.push(code, width);
        if next < FULL {
            longer[slot] = next;
            // the reader learns a string one code later
            if next == 1 << width {
                width += 1;
            }
            next += 1;
        } else {
            bits.push(CLEAR, width);
            longer.fill(0);
            (next, width) = (END + 1, 9);
        }
        string = Some(u16::from(*byte));
    }
    if let Some(code) = string {
        bits.push(code, width);
        if next == 1 << width && width < 12 {
            width += 1;
        }
    }
    bits.push(END, width);
    bits.finish()
}

#[derive(Default)]
struct BitWriter {
    bytes: Vec<u8>,
    pending: u32,
    count: u32,
}

impl BitWriter {
    fn push(&mut self, code: u16, width: u32) {
        self.pending |= u32::from(code) << self.count;
        self.count += width;
        while self.count >= 8 {
            self.bytes.push(self.pending as u8);
            self.pending >>= 8;
            self.count -= 8;
        }
    }

    fn finish(mut self) -> Vec<u8> {
        if self.count > 0 {
            self.bytes.push(self.pending as u8);
        }
        self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TemporaryFolder;

    /// The inverse of `compressed`, written from the specification.
    fn expanded(bytes: &[u8]) -> Vec<u8> {
        let mut bits = bytes.iter().flat_map(|byte| (0..8).map(move |bit| byte >> bit & 1));
        let mut code = |width: usize| {
            (0..width).fold(0usize, |code, bit| code | usize::from(bits.next().unwrap()) << bit)
        };
        let start = || (0..256usize).map(|byte| vec![byte as u8]).chain([vec![], vec![]]).collect::<Vec<_>>();
        let (mut table, mut width, mut last): (_, _, Option<Vec<u8>>) = (start(), 9, None);
        let mut data = Vec::new();
        loop {
            match code(width) {
                256 => (table, width, last) = (start(), 9, None),
                257 => return data,
                code => {
                    let string = match (&last, table.get(code)) {
                        (_, Some(string)) => string.clone(),
                        (Some(last), None) => [&last[..], &last[..1]].concat(),
                        (None, None) => panic!("a code that is not known"),
                    };
                    if let Some(last) = last
                        && table.len() < 4096
                    {
                        table.push([&last[..], &string[..1]].concat());
                        if table.len() == 1 << width && width < 12 {
                            width += 1;
                        }
                    }
                    data.extend(&string);
                    last = Some(string);
                }
            }
        }
    }

    #[test]
    fn compression_is_undone() {
        let mut state = 1u32;
        let mut noise = |range: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % range
        };
        // long runs, few values, and noise that fills the table several times
        for (length, range) in [(0, 1), (1, 1), (5000, 1), (20_000, 3), (60_000, 256)] {
            let data: Vec<u8> = (0..length).map(|_| noise(range) as u8).collect();
            assert_eq!(expanded(&compressed(&data)), data, "{length} of {range}");
        }
        assert!(compressed(&[7; 5000]).len() < 200);
    }

    /// Up to 255 colours that differ in their upper five bits are all kept.
    #[test]
    fn few_colours_are_kept() {
        let colours: Vec<[u8; 3]> = (0..200u8).map(|k| [k % 32 * 8, k / 32 * 8, 40]).collect();
        let image = Image { width: 20, height: 10, pixels: colours.clone() };
        let palette = Palette::of(std::slice::from_ref(&image)).unwrap();
        for colour in colours {
            assert_eq!(palette.colours[usize::from(palette.nearest(colour))], colour);
        }
    }

    /// A picture of few colours comes back as it was, from a smaller file.
    #[test]
    fn compact_pictures_come_back() {
        let folder = TemporaryFolder::new("compact");
        // 176 colours without pattern
        let mut state = 1u32;
        let mut next = |range: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % range
        };
        let pixels: Vec<[u8; 3]> = (0..5000).map(|_| [next(11) as u8 * 16, 8, next(16) as u8 * 16]).collect();
        let image = Image { width: 100, height: 50, pixels };
        let (compact, whole) = (folder.path("compact.png"), folder.path("whole.png"));
        image.write_compact_png(&compact).unwrap();
        image.write_png(&whole).unwrap();
        let size = |path: &Path| std::fs::metadata(path).unwrap().len();
        assert!(size(&compact) < size(&whole));
        let file = std::io::BufReader::new(std::fs::File::open(&compact).unwrap());
        let mut decoder = png::Decoder::new(file);
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut read = vec![0; 3 * 5000];
        reader.next_frame(&mut read).unwrap();
        assert_eq!(read, image.pixels.as_flattened());
    }

    #[test]
    fn a_file_has_its_parts() {
        let folder = TemporaryFolder::new("gif");
        let path = folder.path("a.gif");
        let image = |shade: u8| Image { width: 3, height: 2, pixels: vec![[shade; 3]; 6] };
        write_gif(&path, &[image(0), image(255)][..], 0.1).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!((&bytes[..6], bytes.last()), (&b"GIF89a"[..], Some(&0x3b)));
        assert_eq!(bytes[6..10], [3, 0, 2, 0]);
        let controls = bytes.windows(4).filter(|window| *window == [0x21, 0xf9, 4, 5]).count();
        assert_eq!(controls, 2);
        assert!(write_gif(&path, &[][..], 0.1).is_err());
    }
}
