// How the client finds the program.
import assert from "node:assert/strict";
import { chmodSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { delimiter, join } from "node:path";
import { after, test } from "node:test";
import { build } from "esbuild";

const root = mkdtempSync(join(tmpdir(), "dosm-"));
after(() => rmSync(root, { recursive: true }));

const outfile = join(root, "program.mjs");
await build({ entryPoints: ["src/program.ts"], outfile, bundle: true, format: "esm", platform: "node" });
const { findProgram, notFound } = await import(outfile);

/** Makes a file in the test's directory. */
function file(path, mode = 0o755) {
  const whole = join(root, path);
  mkdirSync(join(whole, ".."), { recursive: true });
  writeFileSync(whole, "");
  chmodSync(whole, mode);
  return whole;
}

const home = join(root, "home");
const cargo = file("home/.cargo/bin/dosmc");
const inPath = file("bin/dosmc");
const unrunnable = file("plain/dosmc", 0o644);
const inWorkspace = file("work/target/dosmc");
mkdirSync(join(root, "folder/dosmc"), { recursive: true });

const around = { home, workspace: join(root, "work"), path: join(root, "bin"), endings: [""] };

test("a name is looked for in PATH and then among what cargo installed", () => {
  assert.deepEqual(findProgram("dosmc", around), { program: inPath });
  assert.deepEqual(findProgram("  ", around), { program: inPath });
  assert.deepEqual(findProgram("dosmc", { ...around, path: "" }), { program: cargo });
});

test("what can't be run is no program", () => {
  const path = [join(root, "plain"), join(root, "folder")].join(delimiter);
  assert.deepEqual(findProgram("dosmc", { ...around, path }), { program: cargo });
  assert.deepEqual(findProgram(unrunnable, around), { looked: [unrunnable] });
});

test("a path may begin at home or at the workspace", () => {
  assert.deepEqual(findProgram("~/.cargo/bin/dosmc", around), { program: cargo });
  assert.deepEqual(findProgram("target/dosmc", around), { program: inWorkspace });
  assert.deepEqual(findProgram("${workspaceFolder}/target/dosmc", around), { program: inWorkspace });
  assert.deepEqual(findProgram(inPath, { ...around, workspace: undefined }), { program: inPath });
});

test("endings of programs are tried", () => {
  const exe = file("win/dosmc.exe");
  const windows = { ...around, path: join(root, "win"), endings: [".exe", ""] };
  assert.deepEqual(findProgram("dosmc", windows), { program: exe });
});

test("the message says where it isn't", () => {
  const path = findProgram("./nowhere/dosmc", around);
  assert.equal(notFound("./nowhere/dosmc", path.looked), `There is no program ${join(root, "work/nowhere/dosmc")}.`);
  const name = findProgram("dosmx", around);
  assert.equal(name.looked.length, 2);
  assert.match(notFound("dosmx", name.looked), /no program `dosmx` in PATH/);
});
