#!/usr/bin/env python3
"""What one step of a generated controller costs: instructions and stack on a Cortex-M4F, time here.

    cargo build --release
    eval "$(.ci/arm)"        # unless the target thumbv7em-none-eabihf is installed
    benches/firmware.py [--binary target/release/dosmc]

For the models of Table I, with 4, 6 and 8 states and 2 inputs, in doubles and in single precision.
The controller flies its plan in a closed loop, each position pushed into one corner or another at each
step. Instructions are counted by qemu (-icount), in `step` alone; the stack is what `step` and all
that it calls has written to; code is counted from the disassembly, the law and monitor on one side,
the compiler's arithmetic of doubles (the processor has none) on the other. Time is what 1 % of 1000
flights of 1000 steps stay below, since other programs run meanwhile.

Without qemu-system-arm or a compiler for the target only the times are measured; with
DOSMC_REQUIRE_TOOLS that is an error.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGET = "thumbv7em-none-eabihf"

MANIFEST = """\
[package]
name = "measure"
version = "0.1.0"
edition = "2021"

[dependencies]
{dependencies}

[workspace]

[profile.release]
panic = "abort"
"""

# What both programs fly: the first robot of Table I, n / 2 integrators an axis, sampled exactly.
LOOP = """\
use {library}::dynamics::rover::{{Input, State}};
use {library}::{{Fleet1, Output, Real, STEP_SECONDS}};

const N: usize = {n};
const CHAIN: usize = N / 2;

/// The next state, pushed into one corner or another.
fn moved(x: [Real; N], u: [Real; 2], corner: u32) -> [Real; N] {{
    let mut next = x;
    for axis in 0..2 {{
        let chain = axis * CHAIN;
        for i in 0..CHAIN {{
            let mut factor: Real = 1.0;
            for k in i + 1..=CHAIN {{
                factor = factor * (STEP_SECONDS as Real) / ((k - i) as Real);
                next[chain + i] += factor * if k < CHAIN {{ x[chain + k] }} else {{ u[axis] }};
            }}
        }}
        next[chain] += if corner >> axis & 1 == 0 {{ -0.2 }} else {{ 0.2 }};
    }}
    next
}}

/// Flies some steps; each is taken by `step`.
fn fly(steps: usize, mut step: impl FnMut(&mut Fleet1, &State) -> Output<Input>) -> bool {{
    let mut controller = Fleet1::new();
    let mut state = <[Real; N]>::from(Fleet1::start());
    let (mut random, mut holds) = (1u32, true);
    for _ in 0..steps {{
        let output = step(&mut controller, &State::from(state));
        holds &= output.status.holds();
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state = moved(state, output.input.into(), random >> 30);
    }}
    holds
}}
"""

HOST = """\
use std::hint::black_box;
use std::time::Instant;

{loop_}
fn main() {{
    let mut states = Vec::new();
    let holds = fly(1000, |controller, state| {{
        states.push(*state);
        controller.step(state)
    }});
    assert!(holds, "the promise does not hold");
    let mut times = Vec::new();
    for _ in 0..1000 {{
        let mut controller = Fleet1::new();
        let clock = Instant::now();
        for state in &states {{
            black_box(controller.step(black_box(state)));
        }}
        times.push(clock.elapsed().as_secs_f64() * 1e9 / states.len() as f64);
    }}
    times.sort_by(f64::total_cmp);
    println!("{{:.1}}", times[10]);
}}
"""

BOARD = """\
#![no_std]
#![no_main]

use core::arch::asm;
use core::fmt::Write;

use board::Terminal;

{loop_}
const CONTROL: *mut u32 = 0xE000_E010 as *mut u32;
const RELOAD: *mut u32 = 0xE000_E014 as *mut u32;
const COUNT: *mut u32 = 0xE000_E018 as *mut u32;

/// SysTick counts down, by more than one an instruction.
#[inline(always)]
fn ticks() -> u32 {{
    unsafe {{ COUNT.read_volatile() }}
}}

#[no_mangle]
#[inline(never)]
fn measured_step(controller: &mut Fleet1, state: &State) -> Output<Input> {{
    controller.step(state)
}}

const PAINT: u32 = 0x5AFE_57AC;
const DEEP: usize = 8192;

/// How much stack a call writes to, in bytes, its own arguments and result left out.
#[inline(never)]
fn stack(controller: &mut Fleet1, state: &State) -> usize {{
    let top: usize;
    unsafe {{ asm!("mov {{}}, sp", out(reg) top) }};
    let bottom = top - DEEP;
    for word in (bottom..top - 256).step_by(4) {{
        unsafe {{ (word as *mut u32).write_volatile(PAINT) }};
    }}
    core::hint::black_box(measured_step(controller, state));
    let touched = (bottom..top).step_by(4).find(|w| unsafe {{ (*w as *const u32).read_volatile() }} != PAINT);
    top - touched.unwrap_or(top)
}}

#[no_mangle]
extern "C" fn run() -> u32 {{
    unsafe {{
        RELOAD.write_volatile(0x00FF_FFFF);
        COUNT.write_volatile(0);
        CONTROL.write_volatile(5);
    }}
    let (mut sum, mut most, mut deepest) = (0u64, 0, 0);
    let first = ticks();
    let second = ticks();
    unsafe {{ asm!(".rept 10000", "nop", ".endr") }};
    let third = ticks();
    let nothing = first.wrapping_sub(second) & 0x00FF_FFFF;
    let myriad = (second.wrapping_sub(third) & 0x00FF_FFFF) - nothing;
    let instructions = |ticks: u64| ticks * 10_000 / u64::from(myriad);
    let holds = fly(1000, |controller, state| {{
        deepest = deepest.max(stack(&mut controller.clone(), state));
        let before = ticks();
        let output = measured_step(controller, state);
        let taken = (before.wrapping_sub(ticks()) & 0x00FF_FFFF) - nothing;
        sum += u64::from(taken);
        most = most.max(taken);
        output
    }});
    let _ = writeln!(Terminal, "{{}} {{}} {{}}", instructions(sum) / 1000, instructions(most.into()), deepest);
    u32::from(!holds)
}}
"""


def run(command, **more):
    """What a program prints; ends with what it complains of when it fails."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {done.stdout}{done.stderr}")
    # qemu prints what the machine says on standard error.
    return done.stdout or done.stderr


def skipped(what):
    """Says what is not measured; fatal where it must be."""
    if "DOSMC_REQUIRE_TOOLS" in os.environ:
        sys.exit(what)
    print(f"SKIPPED: {what}", file=sys.stderr)


def arm_rustc():
    """The environment for cargo to compile for the target, or None."""
    place = subprocess.run(
        ["rustc", "--print", "target-libdir", "--target", TARGET], capture_output=True, text=True, check=False
    )
    if place.returncode == 0 and Path(place.stdout.strip()).is_dir():
        return dict(os.environ)
    if os.environ.get("DOSMC_ARM_RUSTC"):
        return dict(os.environ, RUSTC=os.environ["DOSMC_ARM_RUSTC"])
    return None


def write(folder, source, dependencies):
    """A package in a folder of its own."""
    (folder / "src").mkdir(parents=True)
    lines = [f'{name} = {{ path = "{path}" }}' for name, path in dependencies.items()]
    (folder / "Cargo.toml").write_text(MANIFEST.format(dependencies="\n".join(lines)))
    (folder / "src/main.rs").write_text(source)


def host(folder, loop, controller):
    """Nanoseconds a step here."""
    write(folder, HOST.format(loop_=loop), controller)
    return float(run(["cargo", "run", "--release", "--quiet", "--offline"], cwd=folder))


def disassembly(program):
    """For each function its number of instructions, and the functions that it calls or goes on with."""
    objdump = os.environ.get("DOSMC_ARM_OBJDUMP") or shutil.which("arm-none-eabi-objdump")
    if objdump is None:
        return None
    functions, name = {}, None
    for line in run([objdump, "-d", "--no-show-raw-insn", program]).splitlines():
        start = re.match(r"[0-9a-f]+ <(.*)>:$", line)
        if start:
            name = start[1]
            functions[name] = [0, set()]
        elif name and re.match(r"\s+[0-9a-f]+:\t(?!\.word|\.short)", line):
            functions[name][0] += 1
            for target in re.findall(r"\t(?:bl?x?[a-z]{0,2}(?:\.[wn])?|cbn?z)\t.*<([^+>]+)>", line):
                functions[name][1].add(target)
    return functions


def code(program):
    """Instructions of `step` and of what it calls: the law's, and the compiler's arithmetic."""
    functions = disassembly(program)
    if functions is None:
        return "-", "-"
    reached, waiting = set(), ["measured_step"]
    while waiting:
        name = waiting.pop()
        if name not in reached and name in functions:
            reached.add(name)
            waiting.extend(functions[name][1])
    arithmetic = {f for f in reached if f.startswith(("__", "mem")) or "compiler_builtins" in f}
    count = lambda names: sum(functions[f][0] for f in names)
    return count(reached - arithmetic), count(arithmetic)


def board(folder, loop, controller, environment):
    """Code (law, arithmetic), executed (mean, most) and stack on the microcontroller."""
    write(folder, BOARD.format(loop_=loop), dict(controller, board=ROOT / "examples/firmware/board"))
    environment = dict(environment, CARGO_ENCODED_RUSTFLAGS="-Clink-arg=-Tboard.x")
    run(["cargo", "build", "--release", "--quiet", "--offline", "--target", TARGET], cwd=folder, env=environment)
    program = folder / "target" / TARGET / "release/measure"
    qemu = "qemu-system-arm -machine mps2-an386 -nographic -icount shift=6 -semihosting-config"
    printed = run([*qemu.split(), "enable=on,target=native", "-kernel", program])
    return [*code(program), *map(int, printed.split())]


def main():
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--binary", type=Path, default=ROOT / "target/release/dosmc")
    program = parser.parse_args().binary.resolve()
    environment = arm_rustc()
    if environment is None:
        skipped(f"no compiler for {TARGET}: nothing is measured on a microcontroller")
    elif shutil.which("qemu-system-arm") is None:
        environment = skipped("no qemu-system-arm: nothing is measured on a microcontroller")
    print("| states | type | ns a step here | instructions a step (mean, most) | stack, bytes "
          "| code of the law | of arithmetic |")
    print("| ---: | --- | ---: | ---: | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as temporary:
        for n in (4, 6, 8):
            for real in ("f64", "f32"):
                folder = Path(temporary) / f"{n}-{real}"
                mission = ROOT / f"examples/paper/table1-{n}.dosm"
                run([program, "solve", mission, "--float", real, "-o", folder])
                library = f"table1_{n}_controller"
                loop = LOOP.format(library=library, n=n)
                controller = {library.replace("_", "-"): folder / "controller"}
                time = host(folder / "host", loop, controller)
                law = arithmetic = mean = most = stack = "-"
                if environment is not None:
                    law, arithmetic, mean, most, stack = board(folder / "board", loop, controller, environment)
                print(f"| {n} | {real} | {time:.0f} | {mean}, {most} | {stack} | {law} | {arithmetic} |", flush=True)


if __name__ == "__main__":
    main()
