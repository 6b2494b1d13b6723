#!/usr/bin/env python3
"""Flies every example mission in closed loop, and prints a table.

For each mission: the robot-steps flown, how many a second, violations (there must be none), and the least
margin of each kind. With --exceed the table shows instead how many violations there were, and how many of
them no monitor had reported in time (there must be none).

    cargo build --release
    benches/soak.py                              # 10^8 robot-steps each
    benches/soak.py --robot-steps 1e7 relay fig2-4
    benches/soak.py --robot-steps 1e6 --exceed 1.3
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
MARGINS = ["state", "input", "workspace", "blocker", "separation", "link", "range", "region"]


def missions(names):
    """The examples, or those of them that are named."""
    found = sorted([*ROOT.glob("examples/*.dosm"), *ROOT.glob("examples/paper/*.dosm")])
    chosen = [path for path in found if not names or path.stem in names]
    if not chosen:
        sys.exit(f"no such example: {', '.join(names)}")
    return chosen


def dosmc(binary, *arguments):
    """A command's answer as parsed JSON."""
    done = subprocess.run([binary, *map(str, arguments), "--json"], capture_output=True, text=True)
    return json.loads(done.stdout)


def simulate(binary, plan, mission, arguments, robot_steps):
    """As many runs as have so many robot-steps."""
    flags = ["--seed", arguments.seed, "--disturbance", arguments.disturbance, "--exceed", arguments.exceed]
    probe = dosmc(binary, "simulate", plan, mission, *flags, "--runs", 1)
    a_run = probe["robots"] * probe["steps"]
    runs = -(-int(robot_steps) // a_run)
    return dosmc(binary, "simulate", plan, mission, *flags, "--runs", runs)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("missions", nargs="*", help="names of examples; all when left out")
    parser.add_argument("--binary", default=str(ROOT / "target/release/dosmc"))
    parser.add_argument("--robot-steps", type=float, default=1e8)
    parser.add_argument("--seed", default="0")
    parser.add_argument("--disturbance", default="mixed")
    parser.add_argument("--exceed", default="1")
    arguments = parser.parse_args()
    beyond = float(arguments.exceed) > 1
    print(f"{'mission':<12} {'robot-steps':>12} {'million/s':>9} {'violations':>10} {'unreported':>10}", end="")
    print("".join(f" {name:>10}" for name in MARGINS))
    failed = []
    for mission in missions(arguments.missions):
        with tempfile.TemporaryDirectory() as directory:
            solved = dosmc(arguments.binary, "solve", mission, "-o", directory)
            if solved["status"] != "plan":
                print(f"{mission.stem:<12} {solved['status']}")
                continue
            plan = pathlib.Path(directory) / "plan.json"
            flown = simulate(arguments.binary, plan, mission, arguments, arguments.robot_steps)
        rate = flown["robot_steps_per_s"] / 1e6
        print(f"{mission.stem:<12} {flown['robot_steps']:>12} {rate:>9.2f} {flown['violations']:>10}", end="")
        print(f" {flown['unreported_violations']:>10}", end="")
        margins = [flown["margins"][name] for name in MARGINS]
        print("".join(f" {'–' if m is None else format(m, '.2e'):>10}" for m in margins), flush=True)
        if flown["unreported_violations"] or (flown["violations"] and not beyond) or flown["status"] == "unknown":
            failed.append(mission.stem)
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
