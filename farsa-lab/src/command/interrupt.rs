//! Signals that stop a run, and the exit code with which a scheduler restarts it.

use std::fs;
use std::io::{self, Write as _};
use std::sync::Arc;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// Exit code of a process to be restarted: `EX_TEMPFAIL` of sysexits.h.
pub(crate) const START_AGAIN: u8 = 75;
/// Exit code of [`Error::Interrupted`](crate::Error::Interrupted), which is that of a shell after Ctrl-C.
pub(crate) const INTERRUPTED: u8 = 130;

/// Returns a flag that SIGINT, SIGTERM and SIGHUP set. A second signal ends the process at once.
///
/// Signals that were ignored at the start of the process remain ignored, as under `nohup`.
pub(crate) fn stop_on_signals() -> &'static AtomicBool {
    static STOP: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    STOP.get_or_init(|| {
        let stop = Arc::new(AtomicBool::new(false));
        let ignored = ignored();
        for signal in signals().iter().copied().filter(|signal| ignored >> (signal - 1) & 1 == 0) {
            // In this order, the first signal finds the flag unset. Without handlers a signal ends the process, which can be
            // resumed as well.
            let _ = flag::register_conditional_shutdown(signal, 128 + signal, stop.clone());
            let _ = flag::register(signal, stop.clone());
        }
        // Signal handlers must not print.
        let heard = stop.clone();
        let _ = thread::Builder::new().name("signals".into()).spawn(move || {
            while !heard.load(Ordering::Relaxed) {
                thread::sleep(Duration::from_millis(20));
            }
            let _ = writeln!(io::stderr(), "stopping after the trials that are running; again to stop at once");
        });
        stop
    })
}

#[cfg(unix)]
fn signals() -> [i32; 3] {
    [SIGINT, SIGTERM, signal_hook::consts::SIGHUP]
}

#[cfg(not(unix))]
fn signals() -> [i32; 2] {
    [SIGINT, SIGTERM]
}

/// Computes the ignored signals, signal n at bit n - 1, where the system provides them.
fn ignored() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    line.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Checks if a scheduler of a cluster has started this process.
pub(crate) fn under_scheduler() -> bool {
    // Slurm, PBS and Torque, LSF, Grid Engine, OAR, Flux, HTCondor.
    let names =
        ["SLURM_JOB_ID", "PBS_JOBID", "LSB_JOBID", "SGE_TASK_ID", "OAR_JOB_ID", "FLUX_JOB_ID", "_CONDOR_JOB_AD"];
    names.into_iter().any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()))
}
