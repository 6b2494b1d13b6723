#!/usr/bin/env python3
"""How long `dosmc lsp` takes, from what is typed to what is shown.

    cargo build --release
    benches/lsp.py [--binary target/release/dosmc] [--lines 1000] [--edits 200] [--large-mb 10]

A mission of 1,000 lines is typed into at places all over it, a character at a time, and each
change is waited for until its diagnostics are there; then requests are asked at places all over it. Last,
a mission of 10 MB is opened and changed, and meanwhile another one is asked about. Times are in
milliseconds as the client sees them: median, what 95 % stay below, and the longest.
"""

import argparse
import json
import random
import resource
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

HEAD = """dosm 1
/// A mission made to be long.
mission long
workspace box (0, 0) .. (1000, 1000)
param margin = 0.5
let side = 20
base home at (1, 1)
jammer mast = ball (995, 5) radius 2
dynamics Rover {
  step 0.5 s
  integrator 2
  bound vx, vy in [-4, 4] m/s
  bound ax, ay in [-4, 4] m/s^2
  disturbance px, py in [-0.2, 0.2] m
  rejection 0.5
}
robot scout: Rover at (2, 2)
separation 0.1 m
horizon 1..40
"""


def mission(lines):
    """A mission of about so many lines: a third regions with their comments, half goals."""
    text, count = [HEAD], HEAD.count("\n")
    index = 0
    while count < lines:
        x, y = 10 + index % 30 * 30, 10 + index // 30 % 30 * 30
        text.append(
            f"/// Place number {index}.\n"
            f"region r{index} = box ({x}, {y}) .. ({x} + side, {y} + side - margin)\n"
            f"goal g{index}: always eventually[0 s, {index % 9 + 1} s] (scout in r{index} or not scout in r0)\n"
        )
        index, count = index + 1, count + 3
    return "".join(text)


class Server:
    """A server and a client's side of the conversation."""

    def __init__(self, binary):
        self.process = subprocess.Popen([binary, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.requests = self.version = 0
        self.passed = []
        self.ask("initialize", {"capabilities": {}})
        self.tell("initialized", {})

    def send(self, message):
        body = json.dumps(dict(message, jsonrpc="2.0")).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self.process.stdin.flush()

    def tell(self, method, params):
        self.send({"method": method, "params": params})

    def request(self, method, params):
        self.requests += 1
        self.send({"id": self.requests, "method": method, "params": params})
        return self.requests

    def receive(self):
        length = 0
        while (line := self.process.stdout.readline().strip()):
            if line.lower().startswith(b"content-length:"):
                length = int(line.split(b":")[1])
        return json.loads(self.process.stdout.read(length))

    def wait(self, wanted):
        # What came while something else was waited for has come all the same.
        for index, message in enumerate(self.passed):
            if wanted(message):
                return self.passed.pop(index)
        while not wanted(message := self.receive()):
            self.passed.append(message)
        return message

    def ask(self, method, params):
        number = self.request(method, params)
        return self.wait(lambda m: m.get("id") == number)

    def published(self, uri):
        """Waits for the diagnostics of the last change of a mission."""
        return self.wait(
            lambda m: m.get("method") == "textDocument/publishDiagnostics"
            and (m["params"]["uri"], m["params"]["version"]) == (uri, self.version)
        )

    def open(self, uri, text):
        self.version += 1
        document = {"uri": uri, "languageId": "dosm", "version": self.version, "text": text}
        self.tell("textDocument/didOpen", {"textDocument": document})

    def change(self, uri, start, end, text):
        self.version += 1
        change = {"range": {"start": start, "end": end}, "text": text}
        document = {"uri": uri, "version": self.version}
        self.tell("textDocument/didChange", {"textDocument": document, "contentChanges": [change]})

    def end(self):
        self.ask("shutdown", None)
        self.tell("exit", None)
        self.process.wait()


def timed(act):
    started = time.perf_counter()
    act()
    return 1000 * (time.perf_counter() - started)


def row(name, times):
    times = sorted(times)
    at = lambda share: times[min(len(times) - 1, int(share * len(times)))]
    print(f"{name:44} {at(0.5):9.1f} {at(0.95):9.1f} {times[-1]:9.1f}", flush=True)


def position(line, character):
    return {"line": line, "character": character}


def type_into(server, uri, text, edits, random):
    """Types and deletes one character at a time; the mission is right, wrong and right again."""
    lines = text.split("\n")
    times = []
    for _ in range(edits):
        line = random.randrange(len(lines) - 1)
        column = random.randint(0, len(lines[line]))
        here, behind = position(line, column), position(line, column + 1)
        for start, end, new in ((here, here, "x"), (here, behind, "")):
            times.append(timed(lambda: (server.change(uri, start, end, new), server.published(uri))))
    return times


def requests(text):
    """Methods with their parameters for a place; those of a whole mission take none."""
    options = {"tabSize": 2, "insertSpaces": True}
    last = position(text.count("\n"), 0)
    whole = {"start": position(0, 0), "end": last}
    return {
        "hover": {},
        "completion": {},
        "signatureHelp": {},
        "definition": {},
        "references": {"context": {"includeDeclaration": True}},
        "rename": {"newName": "another_name"},
        "documentHighlight": {},
        "documentSymbol": None,
        "foldingRange": None,
        "semanticTokens/full": None,
        "inlayHint": {"range": whole},
        "formatting": {"options": options},
        "codeLens": None,
    }


def ask_about(server, uri, text, random):
    lines = text.split("\n")
    for method, extra in requests(text).items():
        times = []
        for _ in range(30):
            line = random.randrange(len(lines) - 1)
            column = random.randint(0, len(lines[line]))
            params = {"textDocument": {"uri": uri}, "position": position(line, column), **(extra or {})}
            times.append(timed(lambda: server.ask(f"textDocument/{method}", params)))
        row(f"{method}", times)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default=ROOT / "target/release/dosmc")
    parser.add_argument("--lines", type=int, default=1000)
    parser.add_argument("--edits", type=int, default=200)
    parser.add_argument("--large-mb", type=float, default=10)
    arguments = parser.parse_args()
    chance = random.Random(7)
    server = Server(arguments.binary)

    uri, text = "file:///long.dosm", mission(arguments.lines)
    print(f"{'milliseconds':44} {'median':>9} {'95 %':>9} {'longest':>9}")
    started = time.perf_counter()
    server.open(uri, text)
    said = server.published(uri)["params"]["diagnostics"]
    opened = 1000 * (time.perf_counter() - started)
    assert not said, said[0]
    row(f"open {text.count(chr(10))} lines, {len(text)} bytes", [opened])
    row("type a character, to diagnostics", type_into(server, uri, text, arguments.edits, chance))
    ask_about(server, uri, text, chance)

    small = (ROOT / "examples/first.dosm").read_text()
    server.open("file:///small.dosm", small)
    server.published("file:///small.dosm")
    large = mission(10)
    large += "\n".join(f"// {'padding ' * 12}" for _ in range(int(arguments.large_mb * 1e6) // 100)) + "\n"
    huge = "file:///huge.dosm"
    row(f"open {len(large) / 1e6:.1f} MB of comments", [timed(lambda: (server.open(huge, large), server.published(huge)))])
    row("  type a character", type_into(server, huge, large, 3, chance))
    dense = mission(int(arguments.large_mb * 1e6 / 62))
    row(f"open {len(dense) / 1e6:.1f} MB of declarations", [timed(lambda: (server.open(huge, dense), server.published(huge)))])
    row("  type a character", type_into(server, huge, dense, 2, chance))

    def meanwhile():
        here = position(3, 0)
        server.change(huge, here, here, "x")
        server.ask("textDocument/hover", {"textDocument": {"uri": "file:///small.dosm"}, "position": position(8, 3)})

    row("  hover in another mission meanwhile", [timed(meanwhile)])
    server.published(huge)
    server.end()
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print(f"peak memory {peak:.0f} MiB")


if __name__ == "__main__":
    main()
