//! Base64 as VTK writes it: streams of padded groups, one behind the other.

/// Decodes until the end or the first byte that is neither a letter, padding nor space.
///
/// Padding may stand within: a length and its data are often encoded apart. The last element is the number of
/// bytes of text that were read.
pub(super) fn decode(text: &[u8]) -> Result<(Vec<u8>, usize), BadGroup> {
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let mut group = [0u8; 4];
    let (mut filled, mut padding, mut end) = (0, 0, text.len());
    for (offset, byte) in text.iter().enumerate() {
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            b'=' => 0,
            space if space.is_ascii_whitespace() => continue,
            _ => {
                end = offset;
                break;
            }
        };
        // "=" ends a group: two letters or more before it, no letter behind it
        if (*byte == b'=' && filled < 2) || (*byte != b'=' && padding > 0) {
            return Err(BadGroup { offset });
        }
        padding += usize::from(*byte == b'=');
        group[filled] = value;
        filled += 1;
        if filled == 4 {
            let [a, b, c, d] = group;
            let whole = [a << 2 | b >> 4, b << 4 | c >> 2, c << 6 | d];
            bytes.extend_from_slice(&whole[..3 - padding]);
            (filled, padding) = (0, 0);
        }
    }
    if filled > 0 { Err(BadGroup { offset: end }) } else { Ok((bytes, end)) }
}

/// A group that is no group of four letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct BadGroup {
    /// From the start of the text.
    pub offset: usize,
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Encodes with padding at the end.
    pub fn encode(bytes: &[u8]) -> String {
        const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let mut text = String::new();
        for group in bytes.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|index| group.get(index).copied().unwrap_or(0));
            let letters = [a >> 2, (a & 3) << 4 | b >> 4, (b & 15) << 2 | c >> 6, c & 63];
            for (place, letter) in letters.into_iter().enumerate() {
                text.push(if place <= group.len() { char::from(LETTERS[usize::from(letter)]) } else { '=' });
            }
        }
        text
    }

    #[test]
    fn decodes_what_was_encoded_also_in_pieces() {
        for length in 0..20u8 {
            let bytes: Vec<u8> = (0..length).map(|index| index.wrapping_mul(83) ^ 0xa5).collect();
            let text = encode(&bytes);
            assert_eq!(decode(text.as_bytes()), Ok((bytes.clone(), text.len())));
            let twice = format!("  {text}\n{text}<");
            assert_eq!(decode(twice.as_bytes()), Ok(([bytes.clone(), bytes].concat(), twice.len() - 1)));
        }
        assert_eq!(decode(b"TWFu"), Ok((b"Man".to_vec(), 4)));
    }

    #[test]
    fn half_groups_and_stray_padding_are_refused() {
        for bad in ["TWF", "T===", "=WFu", "TW=u", "TWFuT"] {
            assert!(decode(bad.as_bytes()).is_err(), "{bad}");
        }
    }
}
