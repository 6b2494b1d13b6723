#!/usr/bin/env python3
"""Table I, decided by dosmc and by other programs: do they agree on which rows have a plan?

    python3 benches/peers.py PEERS [--dosmc target/release/dosmc] [--peer p1] [--rows 2,4,1 3,6,2 ...]

PEERS is a folder with `run_peers.py` and `instance_relay.json`: the paper's method and two others on
common solvers, for the same instances. It needs Python with z3-solver, highspy, numpy and scipy. A row
is robots,states,bases; all 18 are compared by default. The times printed are one run each, the search
alone on both sides: they show an order of magnitude and nothing more.

The exit status is 0 when all rows agree, or when the folder is missing (which is said), 1 otherwise.
"""
import argparse
import itertools
import json
import os
import subprocess
import sys
import tempfile

ROWS = list(itertools.product((2, 3, 4), (4, 6, 8), (1, 2)))
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("peers", metavar="PEERS")
    parser.add_argument("--dosmc", default=os.path.join(ROOT, "target", "release", "dosmc"))
    parser.add_argument("--peer", default="p1", choices=["p1", "p2", "p3"])
    parser.add_argument("--rows", nargs="*", help="robots,states,bases")
    parser.add_argument("--timeout", default="120", help="seconds a row, for each program")
    return parser.parse_args()


def ask_dosmc(program, row, timeout):
    robots, states, bases = row
    mission = os.path.join(ROOT, "examples", "paper", f"table1-{states}.dosm")
    with tempfile.TemporaryDirectory() as out:
        command = [program, "solve", mission, "-o", out, "--json", "--timeout", timeout]
        command += ["--set", f"robots={robots}", "--set", f"bases={bases}"]
        answer = json.loads(subprocess.run(command, capture_output=True, text=True, check=False).stdout)
    stats = answer["stats"]
    seconds = stats["time_encode_s"] + stats["time_sat_s"] + stats["time_convex_s"]
    return {"plan": True, "no_plan": False}.get(answer["status"]), answer["length"], seconds


def ask_peer(folder, peer, row, timeout):
    robots, states, bases = row
    command = [sys.executable, os.path.join(folder, "run_peers.py"), "--peer", peer, "--disc", "zoh"]
    command += ["--instance", os.path.join(folder, "instance_relay.json"), "--timeout", timeout]
    command += ["--robots", str(robots), "--states", str(states), "--bases", str(bases)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if not run.stdout.strip():
        sys.exit(f"{' '.join(command)} says nothing:\n{run.stderr}")
    answer = json.loads(run.stdout.strip().splitlines()[-1])
    found = {"found": True, "exhausted": False}.get(answer["status"])
    if found and answer.get("check") != "ok":
        found = None
    return found, answer.get("horizon"), answer.get("cpu_s")


def main():
    options = arguments()
    if not os.path.isfile(os.path.join(options.peers, "run_peers.py")):
        print(f"SKIPPED: there is no run_peers.py in {options.peers}: nothing compared", file=sys.stderr)
        return 0
    rows = [tuple(map(int, row.split(","))) for row in options.rows] if options.rows else ROWS
    words = {True: "plan", False: "no plan", None: "unknown"}
    print(f"robots states bases | dosmc     L  search s | {options.peer}        L  search s | agree")
    disagreements = 0
    for row in rows:
        ours, our_length, our_time = ask_dosmc(options.dosmc, row, options.timeout)
        theirs, their_length, their_time = ask_peer(options.peers, options.peer, row, options.timeout)
        agree = ours is not None and ours == theirs
        disagreements += not agree
        print(f"{row[0]:6} {row[1]:6} {row[2]:5} | {words[ours]:8} {our_length!s:>2} {our_time:9.4f} |"
              f" {words[theirs]:8} {their_length!s:>2} {their_time or 0:9.4f} | {'yes' if agree else 'NO'}", flush=True)
    print(f"{len(rows) - disagreements} of {len(rows)} rows agree")
    return 1 if disagreements else 0


if __name__ == "__main__":
    sys.exit(main())
