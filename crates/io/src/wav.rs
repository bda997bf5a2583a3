//! Sounds as WAV files (RIFF/WAVE): samples of one or several channels, as 16-bit integers or as floats.

use std::path::Path;

use crate::{IoError, write_file};

/// Greatest rate that is written [Hz]: what programs that play sounds still take.
pub const MOST_RATE: u32 = 192_000;

/// How a sample is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleFormat {
    /// Rounded to one of 65,535 steps between -1 and 1; what is beyond is cut off.
    Int16,
    /// 32 bits, of any size; players cut off beyond -1 and 1.
    Float32,
}

impl SampleFormat {
    fn bytes(self) -> usize {
        match self {
            Self::Int16 => 2,
            Self::Float32 => 4,
        }
    }
}

/// Writes channels of equal length, full scale being 1.
///
/// # Errors
/// No channel, or channels of different lengths; a rate that players do not take; a sample that is no number; more than
/// the 4 GB of the format; the file cannot be written.
pub fn write_wav(path: &Path, rate: u32, channels: &[Vec<f64>], format: SampleFormat) -> Result<(), IoError> {
    let Some(first) = channels.first().filter(|_| channels.len() <= usize::from(u16::MAX)) else {
        return Err(IoError::request("the number of channels", channels.len(), "at least one"));
    };
    if rate == 0 || rate > MOST_RATE {
        let expected = format!("1 to {MOST_RATE} Hz");
        return Err(IoError::request("the rate of the samples", format!("{rate} Hz"), expected));
    }
    for (number, channel) in channels.iter().enumerate() {
        if channel.len() != first.len() {
            let subject = format!("the length of channel {number}");
            return Err(IoError::request(
                subject,
                channel.len(),
                format!("{}, as of the first", first.len()),
            ));
        }
        if let Some(sample) = channel.iter().position(|sample| !sample.is_finite()) {
            let subject = format!("sample {sample} of channel {number}");
            return Err(IoError::request(subject, channel[sample], "a finite number"));
        }
    }
    let bytes = first.len() as u64 * (channels.len() * format.bytes()) as u64;
    let Ok(data) = u32::try_from(bytes + HEADER_MOST).map(|all| all - HEADER_MOST as u32) else {
        return Err(IoError::request("the size of the sound", format!("{bytes} bytes"), "less than 4 GB"));
    };
    write_file(path, |out| {
        out.write_all(&header(rate, channels.len() as u16, format, data))?;
        for sample in 0..first.len() {
            for channel in channels {
                match format {
                    SampleFormat::Int16 => out.write_all(&int16(channel[sample]).to_le_bytes())?,
                    SampleFormat::Float32 => out.write_all(&(channel[sample] as f32).to_le_bytes())?,
                }
            }
        }
        Ok(())
    })
}

/// Bytes before the samples, at most.
const HEADER_MOST: u64 = 64;

/// Full scale is 32767 on both sides.
fn int16(sample: f64) -> i16 {
    (sample.clamp(-1.0, 1.0) * f64::from(i16::MAX)).round() as i16
}

/// `RIFF`, `fmt `, for floats `fact`, and the head of `data`, which is followed by so many bytes.
fn header(rate: u32, channels: u16, format: SampleFormat, data: u32) -> Vec<u8> {
    let frame = channels * format.bytes() as u16;
    let mut chunks = Vec::new();
    let (tag, extension): (u16, &[u8]) = match format {
        SampleFormat::Int16 => (1, &[]),
        // all but plain integers say how long their extension is, and how many samples there are
        SampleFormat::Float32 => (3, &[0, 0]),
    };
    chunks.extend(b"fmt ");
    chunks.extend((16 + extension.len() as u32).to_le_bytes());
    chunks.extend(tag.to_le_bytes());
    chunks.extend(channels.to_le_bytes());
    chunks.extend(rate.to_le_bytes());
    chunks.extend((rate * u32::from(frame)).to_le_bytes());
    chunks.extend(frame.to_le_bytes());
    chunks.extend((8 * format.bytes() as u16).to_le_bytes());
    chunks.extend(extension);
    if format == SampleFormat::Float32 {
        chunks.extend(b"fact");
        chunks.extend(4_u32.to_le_bytes());
        chunks.extend((data / u32::from(frame)).to_le_bytes());
    }
    chunks.extend(b"data");
    chunks.extend(data.to_le_bytes());
    let mut header = b"RIFF".to_vec();
    header.extend((4 + chunks.len() as u32 + data).to_le_bytes());
    header.extend(b"WAVE");
    header.extend(chunks);
    header
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TemporaryFolder;

    /// The bytes of a plain file, as every player knows them; what is beyond full scale is cut off.
    #[test]
    fn sixteen_bits() {
        let folder = TemporaryFolder::new("wav");
        let path = folder.path("a.wav");
        write_wav(&path, 44_100, &[vec![0.0, 1.0, -2.0], vec![0.5, -1.0, 1e9]], SampleFormat::Int16).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(&bytes[..4], b"RIFF");
        assert_eq!(u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize, bytes.len() - 8);
        // stereo, 44.1 kHz, 4 bytes a frame, 16 bits
        let format = [16, 0, 0, 0, 1, 0, 2, 0, 0x44, 0xac, 0, 0, 0x10, 0xb1, 2, 0, 4, 0, 16, 0];
        assert_eq!((&bytes[8..16], &bytes[16..36]), (&b"WAVEfmt "[..], &format[..]));
        assert_eq!((&bytes[36..40], &bytes[40..44]), (&b"data"[..], &[12, 0, 0, 0][..]));
        let samples: Vec<i16> =
            bytes[44..].chunks(2).map(|pair| i16::from_le_bytes(pair.try_into().unwrap())).collect();
        assert_eq!(samples, [0, 16384, 32767, -32767, -32767, 32767]);
    }

    /// Floats are as they are, beyond full scale too, and say how many they are.
    #[test]
    fn floats() {
        let folder = TemporaryFolder::new("wav_floats");
        let path = folder.path("a.wav");
        write_wav(&path, 8000, &[vec![0.25, -3.0]], SampleFormat::Float32).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize, bytes.len() - 8);
        assert_eq!((&bytes[16..22], &bytes[34..38]), (&[18, 0, 0, 0, 3, 0][..], &[32, 0, 0, 0][..]));
        assert_eq!((&bytes[38..42], &bytes[46..50]), (&b"fact"[..], &[2, 0, 0, 0][..]));
        assert_eq!((&bytes[50..54], bytes.len()), (&b"data"[..], 58 + 8));
        assert_eq!(&bytes[58..], [0.25_f32.to_le_bytes(), (-3.0_f32).to_le_bytes()].concat());
    }

    /// What no player takes is refused with what would be, and nothing is written.
    #[test]
    fn refusals() {
        let folder = TemporaryFolder::new("wav_refused");
        let path = folder.path("a.wav");
        let refused = |rate: u32, channels: &[Vec<f64>]| {
            write_wav(&path, rate, channels, SampleFormat::Int16).unwrap_err().to_string()
        };
        assert!(refused(400_000, &[vec![0.0]]).contains("400000 Hz; expected 1 to 192000 Hz"));
        assert!(refused(44_100, &[]).contains("at least one"));
        assert!(refused(44_100, &[vec![0.0], vec![]]).contains("channel 1 is 0; expected 1"));
        assert!(refused(44_100, &[vec![0.0, f64::NAN]]).contains("sample 1 of channel 0 is NaN"));
        assert!(!path.exists());
    }
}
