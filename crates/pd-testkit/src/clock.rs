//! A clock for machines that are shared.

use std::time::Instant;

/// Seconds this thread has had the processor for (the wall clock where that is not told): other
/// work on the machine then counts only by what it does to caches and clock.
pub fn seconds() -> f64 {
    thread_local!(static START: Instant = Instant::now());
    let own = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let own = own.and_then(|s| s.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()));
    own.map_or_else(|| START.with(|start| start.elapsed().as_secs_f64()), |ns| 1e-9 * ns)
}

/// Median of the seconds that `work` takes, over `rounds` rounds of at least 30 ms each.
pub fn median(rounds: usize, mut work: impl FnMut()) -> f64 {
    work();
    let mut times: Vec<f64> = (0..rounds)
        .map(|_| {
            let (start, mut count) = (seconds(), 0);
            while seconds() - start < 0.03 {
                work();
                count += 1;
            }
            (seconds() - start) / f64::from(count)
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[rounds / 2]
}

/// The first line of a command's output; empty if there is no such command.
fn ask(command: &str, argument: &str) -> String {
    let output = std::process::Command::new(command).arg(argument).output();
    output.map_or(String::new(), |o| String::from_utf8_lossy(&o.stdout).trim().to_owned())
}

/// Date, processor and number of cores, for the head of a generated table.
pub fn machine() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or("unknown");
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    format!("{}; {}, {cores} cores", ask("date", "+%F"), model.trim_start_matches([' ', '\t', ':']))
}
