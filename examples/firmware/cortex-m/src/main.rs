//! The same as the example for the host, on a Cortex-M4F without an operating system: 1000 steps of
//! three robots' controllers against the plant, and the summary over semihosting.
//!
//! The states and inputs must be the host's to the last bit: both print a hash of them. The machine
//! ends with status 1 when something is not as planned.

#![no_std]
#![no_main]

use core::fmt::Write;

use board::Terminal;
use flight::{run as fly, Settings};

/// A goal has to be met again within so many steps: twice the plan.
const PATIENCE: u32 = 16;

/// Called by the board after reset; what it returns is the machine's status.
#[no_mangle]
extern "C" fn run() -> u32 {
    let summary = fly(&Settings::default(), &mut |_| ());
    let good = summary.good(PATIENCE);
    let told = write!(Terminal, "{summary}{}\n", if good { "all as planned" } else { "NOT as planned" });
    u32::from(told.is_err() || !good)
}
