//! What a Cortex-M4F needs before Rust can run, and a way to speak to the debugger (here: qemu) that
//! it hangs on. Nothing in here knows anything of robots.
//!
//! The program provides `#[no_mangle] extern "C" fn run() -> u32`: the status that the machine ends with.

#![no_std]

use core::arch::{asm, global_asm};
use core::fmt;
use core::panic::PanicInfo;

// The vector table (the stack's end, and where to go at reset and at each fault), and what comes
// before Rust: the floating-point unit on, variables with a value copied from flash, all others 0.
global_asm!(
    ".section .vectors, \"a\"",
    ".word _stack_top",
    ".word reset",
    ".rept 14",
    ".word fault",
    ".endr",
    ".section .text.reset, \"ax\"",
    ".global reset",
    ".thumb_func",
    "reset:",
    "ldr r0, =0xE000ED88", // CPACR: full access to coprocessors 10 and 11
    "ldr r1, [r0]",
    "orr r1, r1, #0xF00000",
    "str r1, [r0]",
    "dsb",
    "isb",
    "ldr r0, =_data",
    "ldr r1, =_data_end",
    "ldr r2, =_data_load",
    "1: cmp r0, r1",
    "beq 2f",
    "ldr r3, [r2], #4",
    "str r3, [r0], #4",
    "b 1b",
    "2: ldr r0, =_bss",
    "ldr r1, =_bss_end",
    "movs r3, #0",
    "3: cmp r0, r1",
    "beq 4f",
    "str r3, [r0], #4",
    "b 3b",
    "4: bl run",
    "bl end",
    ".thumb_func",
    "fault: movs r0, #70",
    "bl end",
);

/// One request to the debugger, by Arm's semihosting.
fn ask(operation: u32, argument: *const u8) {
    // SAFETY: the debugger reads what the argument points to, which the callers keep alive, and
    // changes nothing but r0.
    unsafe {
        asm!("bkpt #0xAB", inout("r0") operation => _, in("r1") argument, options(nostack));
    }
}

/// Ends the machine with a status.
#[no_mangle]
pub extern "C" fn end(status: u32) -> ! {
    const EXIT_EXTENDED: u32 = 0x20;
    const APPLICATION_EXIT: u32 = 0x20026;
    let block = [APPLICATION_EXIT, status];
    loop {
        ask(EXIT_EXTENDED, block.as_ptr().cast());
    }
}

/// The debugger's terminal.
pub struct Terminal;

impl fmt::Write for Terminal {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        const WRITE: u32 = 0x04;
        // The text has to end with a zero.
        for part in text.as_bytes().chunks(63) {
            let mut buffer = [0; 64];
            buffer[..part.len()].copy_from_slice(part);
            ask(WRITE, buffer.as_ptr());
        }
        Ok(())
    }
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    let _ = fmt::write(&mut Terminal, format_args!("{info}\n"));
    end(101)
}
