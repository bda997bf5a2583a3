//! Memory of the machine, which is asked for before anything large is made: a system that runs out of it ends the program
//! without a word.

/// Bytes that can be had: what the system says is available, or what is left to the group the process is in, if
/// less; `None` where the system does not tell.
pub fn available_memory() -> Option<u64> {
    let text = |path: &str| std::fs::read_to_string(path).ok();
    let system = text("/proc/meminfo").and_then(|meminfo| {
        Some(1024 * (entry(&meminfo, "MemAvailable:")? + entry(&meminfo, "SwapFree:").unwrap_or(0)))
    })?;
    let group = || {
        let most: u64 = text("/sys/fs/cgroup/memory.max")?.trim().parse().ok()?;
        let used: u64 = text("/sys/fs/cgroup/memory.current")?.trim().parse().ok()?;
        // files held in memory are given up when it is needed
        let cached = text("/sys/fs/cgroup/memory.stat").and_then(|stat| entry(&stat, "inactive_file"));
        Some(most.saturating_sub(used.saturating_sub(cached.unwrap_or(0))))
    };
    Some(group().map_or(system, |group| group.min(system)))
}

/// In words.
pub fn gigabytes(bytes: u64) -> String {
    format!("{:.1} GB", bytes as f64 * 1e-9)
}

/// The number behind a word at the start of a line.
fn entry(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find(|line| line.split_whitespace().next() == Some(name))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_found_by_their_whole_name() {
        let text = "MemFree: 5 kB\nMemAvailable:  7 kB\n";
        assert_eq!((entry(text, "MemAvailable:"), entry(text, "Mem")), (Some(7), None));
    }
}
