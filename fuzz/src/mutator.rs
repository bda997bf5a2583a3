//! Texts and files with faults put in: the same faults for the same seed, on any machine.
//!
//! The fuzzer proper (see `fuzz/run`) is guided by coverage and needs the nightly compiler; this one needs nothing and
//! runs with the ordinary tests.

/// Random numbers by SplitMix64 (Steele, Lea & Flood 2014).
pub struct Mutator {
    state: u64,
    /// Words to put in.
    words: Vec<Vec<u8>>,
}

/// Numbers at which readers break.
const NUMBERS: [&str; 20] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "7",
    "255",
    "65536",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "1e-320",
    "1e300",
    "-1e300",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "0.1",
];

/// Bytes that mean something in texts.
const MARKS: &[u8] = b"\0\n\r\t \"'#$[]{}().,:;=+-*/^<>&|\\09aeE_\xff\xc3";

impl Mutator {
    pub fn new(seed: u64, words: Vec<Vec<u8>>) -> Self {
        Self { state: seed, words }
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `bound`, which is not zero.
    pub fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound as u64) as usize
    }

    fn pick<'a, T>(&mut self, items: &'a [T]) -> Option<&'a T> {
        if items.is_empty() { None } else { Some(&items[self.below(items.len())]) }
    }

    /// One of `seeds` with one to four faults, parts of other seeds among them.
    pub fn mutated(&mut self, seeds: &[Vec<u8>]) -> Vec<u8> {
        let mut content = self.pick(seeds).cloned().unwrap_or_default();
        for _ in 0..=self.below(4) {
            self.mutate(&mut content, seeds);
        }
        content
    }

    fn mutate(&mut self, content: &mut Vec<u8>, seeds: &[Vec<u8>]) {
        match self.below(10) {
            0 => self.replace_byte(content),
            1 => self.cut(content),
            2 => self.repeat(content),
            3 => self.remove_line(content),
            4 => self.swap_lines(content),
            5 => self.foreign_line(content, seeds),
            6 | 7 => self.replace_number(content),
            _ => self.replace_word(content),
        }
    }

    fn replace_byte(&mut self, content: &mut Vec<u8>) {
        let byte = match self.below(2) {
            0 => MARKS[self.below(MARKS.len())],
            _ => self.next() as u8,
        };
        let at = self.below(content.len() + 1);
        if at < content.len() && self.below(3) > 0 {
            content[at] = byte;
        } else {
            content.insert(at, byte);
        }
    }

    /// A range of at most `longest` bytes.
    fn range(&mut self, content: &[u8], longest: usize) -> std::ops::Range<usize> {
        let start = self.below(content.len() + 1);
        let length = self.below(longest.min(content.len() - start) + 1);
        start..start + length
    }

    fn cut(&mut self, content: &mut Vec<u8>) {
        let range = self.range(content, 40);
        if self.below(8) == 0 {
            content.truncate(range.start);
        } else {
            content.drain(range);
        }
    }

    fn repeat(&mut self, content: &mut Vec<u8>) {
        let range = self.range(content, 40);
        let part = content[range].to_vec();
        let times = 1 + self.below(3);
        let at = self.below(content.len() + 1);
        content.splice(at..at, part.repeat(times));
    }

    fn lines(content: &[u8]) -> Vec<Vec<u8>> {
        content.split_inclusive(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect()
    }

    fn remove_line(&mut self, content: &mut Vec<u8>) {
        let mut lines = Self::lines(content);
        if !lines.is_empty() {
            lines.remove(self.below(lines.len()));
        }
        *content = lines.concat();
    }

    fn swap_lines(&mut self, content: &mut Vec<u8>) {
        let mut lines = Self::lines(content);
        if !lines.is_empty() {
            let (a, b) = (self.below(lines.len()), self.below(lines.len()));
            lines.swap(a, b);
        }
        *content = lines.concat();
    }

    fn foreign_line(&mut self, content: &mut Vec<u8>, seeds: &[Vec<u8>]) {
        let other = self.pick(seeds).map(|seed| Self::lines(seed)).unwrap_or_default();
        let Some(line) = self.pick(&other).cloned() else { return };
        let mut lines = Self::lines(content);
        lines.insert(self.below(lines.len() + 1), line);
        *content = lines.concat();
    }

    /// Runs of bytes that satisfy a condition.
    fn runs(content: &[u8], is_part: impl Fn(u8) -> bool) -> Vec<std::ops::Range<usize>> {
        let mut runs = Vec::new();
        let mut start = None;
        for at in 0..=content.len() {
            let inside = at < content.len() && is_part(content[at]);
            match (inside, start) {
                (true, None) => start = Some(at),
                (false, Some(from)) => {
                    runs.push(from..at);
                    start = None;
                }
                _ => {}
            }
        }
        runs
    }

    fn replace_number(&mut self, content: &mut Vec<u8>) {
        let numbers = Self::runs(content, |byte| byte.is_ascii_digit() || matches!(byte, b'.' | b'-'));
        let Some(range) = self.pick(&numbers).cloned() else { return };
        let number = NUMBERS[self.below(NUMBERS.len())];
        content.splice(range, number.bytes());
    }

    fn replace_word(&mut self, content: &mut Vec<u8>) {
        let words = Self::runs(content, |byte| byte.is_ascii_alphabetic() || byte == b'_');
        let Some(range) = self.pick(&words).cloned() else { return };
        let own = words[self.below(words.len())].clone();
        let other = match self.below(3) {
            0 => content[own].to_vec(),
            _ if self.words.is_empty() => content[own].to_vec(),
            _ => {
                let word = self.below(self.words.len());
                self.words[word].clone()
            }
        };
        content.splice(range, other);
    }
}

/// How long to go on: a number of cases, or the seconds that the environment variable `SOUPLE_MUTATION_SECONDS` says.
pub fn repeat(cases: u64, mut case: impl FnMut(u64)) -> u64 {
    let seconds: Option<u64> =
        std::env::var("SOUPLE_MUTATION_SECONDS").ok().and_then(|text| text.parse().ok());
    let start = std::time::Instant::now();
    let mut seed = 0;
    loop {
        let is_over = match seconds {
            Some(seconds) => start.elapsed().as_secs() >= seconds,
            None => seed >= cases,
        };
        if is_over {
            return seed;
        }
        case(seed);
        seed += 1;
    }
}

/// Runs a case, and says its content where it panics or takes longer than `seconds`.
pub fn guard(seed: u64, content: &[u8], seconds: f64, case: impl FnOnce()) {
    let start = std::time::Instant::now();
    let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(case));
    let elapsed = start.elapsed().as_secs_f64();
    let text = || String::from_utf8_lossy(content).into_owned();
    assert!(outcome.is_ok(), "case {seed} panicked:\n{}", text());
    assert!(elapsed < seconds, "case {seed} took {elapsed} s:\n{}", text());
}
