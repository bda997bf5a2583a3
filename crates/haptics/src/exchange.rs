//! The latest numbers of one thread, for another that must not wait.
//!
//! A sequence lock of atomic words: the writer never waits for readers; a reader that meets the writer at work tries again a
//! few times and then keeps what it had, as the writer may have been put to sleep by the system in the middle.

use std::sync::atomic::{AtomicU64, Ordering, fence};

/// `N` numbers that belong together.
#[derive(Debug)]
pub struct Latest<const N: usize> {
    /// Odd while they are being written.
    version: AtomicU64,
    words: [AtomicU64; N],
}

/// Times that a reader tries.
const TRIES: usize = 8;

impl<const N: usize> Latest<N> {
    pub fn new(numbers: [f64; N]) -> Self {
        Self { version: AtomicU64::new(0), words: numbers.map(|number| AtomicU64::new(number.to_bits())) }
    }

    /// Puts numbers there; by one thread alone.
    pub fn write(&self, numbers: &[f64; N]) {
        let version = self.version.load(Ordering::Relaxed);
        self.version.store(version + 1, Ordering::Relaxed);
        // nobody sees a new word with the old version
        fence(Ordering::Release);
        for (word, number) in self.words.iter().zip(numbers) {
            word.store(number.to_bits(), Ordering::Relaxed);
        }
        self.version.store(version + 2, Ordering::Release);
    }

    /// Numbers that were written together; `None` where the writer is always in the way.
    pub fn read(&self) -> Option<[f64; N]> {
        for _ in 0..TRIES {
            let before = self.version.load(Ordering::Acquire);
            if before.is_multiple_of(2) {
                let numbers = std::array::from_fn(|i| f64::from_bits(self.words[i].load(Ordering::Relaxed)));
                // nobody reads the version again before the words
                fence(Ordering::Acquire);
                if self.version.load(Ordering::Relaxed) == before {
                    return Some(numbers);
                }
            }
            std::hint::spin_loop();
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// While one thread writes as fast as it can, another only ever reads numbers that were written together, and never older
    /// ones than before.
    #[test]
    fn numbers_come_together() {
        let latest = Latest::new([0.0; 7]);
        let last = 200_000;
        std::thread::scope(|scope| {
            scope.spawn(|| (1..=last).for_each(|i| latest.write(&[f64::from(i); 7])));
            let (mut seen, mut reads) = (0.0, 0);
            while seen < f64::from(last) {
                let Some(numbers) = latest.read() else { continue };
                assert!(numbers.iter().all(|number| *number == numbers[0]), "{numbers:?}");
                assert!(numbers[0] >= seen);
                seen = numbers[0];
                reads += 1;
            }
            assert!(reads > 0);
        });
    }

    /// A writer that was stopped in the middle does not stop the reader.
    #[test]
    fn readers_do_not_wait() {
        let latest = Latest::new([1.0; 2]);
        latest.version.store(1, Ordering::Relaxed);
        assert_eq!(latest.read(), None);
    }
}
