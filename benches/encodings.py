#!/usr/bin/env python3
"""Compares the two encodings of the workspace: half-spaces, and the paper's cells.

Prints one line for each row of the paper's Table I and for Fig. 2 (our reconstruction of both): the
length of the plan, the search's time (`time_encode_s + time_sat_s + time_convex_s`), the time of the
whole process, the number of Boolean variables, of these the ones for connectivity, and the cells.
Times are medians of several runs, in milliseconds.

    cargo build --release
    benches/encodings.py [--runs 5] [--timeout 60s] [--binary target/release/dosmc]
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
ENCODINGS = ["half-spaces", "paper"]
SEARCH = ["time_encode_s", "time_sat_s", "time_convex_s"]


def rows():
    """Name, mission and parameters of each row."""
    for robots in (2, 3, 4):
        for states in (4, 6, 8):
            for bases in (1, 2):
                plural = "base" if bases == 1 else "bases"
                name = f"Table I: {robots} robots, {states} states, {bases} {plural}"
                yield name, f"table1-{states}", {"robots": robots, "bases": bases}
    for states in (4, 6, 8):
        yield f"Fig. 2: 3 robots, {states} states, 1 base", f"fig2-{states}", {"robots": 3, "bases": 1}
    yield "Fig. 2: 4 robots, 8 states, 1 base", "fig2-8", {"robots": 4, "bases": 1}


def solve(binary, mission, parameters, encoding, timeout, directory):
    """The answer of one run as parsed JSON, and the process's wall time in seconds."""
    command = [binary, "solve", str(ROOT / "examples/paper" / f"{mission}.dosm"), "-o", directory, "--json"]
    command += ["--encoding", encoding, "--timeout", timeout]
    for name, value in parameters.items():
        command += ["--set", f"{name}={value}"]
    began = time.perf_counter()
    done = subprocess.run(command, capture_output=True, text=True)
    wall = time.perf_counter() - began
    return json.loads(done.stdout), wall


def measure(binary, mission, parameters, encoding, runs, timeout, directory):
    """The figures of one row with one encoding; `None` for the length where no plan was found."""
    searches, walls = [], []
    for _ in range(runs):
        answer, wall = solve(binary, mission, parameters, encoding, timeout, directory)
        stats = answer["stats"]
        searches.append(sum(stats[key] for key in SEARCH))
        walls.append(wall)
        if answer["status"] != "plan":
            break
    steps = (answer["length"] or 0) + 1
    return {
        "length": answer["length"],
        "search": 1e3 * statistics.median(searches),
        "wall": 1e3 * statistics.median(walls),
        "variables": stats["bool_vars"],
        "connectivity": stats["bool_vars_connectivity"],
        "step": stats["bool_vars_connectivity"] // steps,
        "cells": stats["cells"],
    }


def text(figures):
    length = "-" if figures["length"] is None else figures["length"]
    return (
        f"{length:>3} {figures['search']:>9.1f} {figures['wall']:>9.1f} "
        f"{figures['variables']:>6} {figures['connectivity']:>5} {figures['step']:>4}"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--timeout", default="60s")
    parser.add_argument("--binary", default=str(ROOT / "target/release/dosmc"))
    arguments = parser.parse_args()
    head = f"{'L':>3} {'search':>9} {'wall':>9} {'vars':>6} {'conn':>5} {'/step':>4}"
    print(f"{'':<38} | {'half-spaces':^41} | {'paper':^47}")
    print(f"{'':<38} | {head} | {head} {'cells':>5}")
    with tempfile.TemporaryDirectory() as directory:
        for name, mission, parameters in rows():
            found = [
                measure(arguments.binary, mission, parameters, e, arguments.runs, arguments.timeout, directory)
                for e in ENCODINGS
            ]
            print(f"{name:<38} | {text(found[0])} | {text(found[1])} {found[1]['cells']:>5}")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
