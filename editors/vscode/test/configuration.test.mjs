// The language configuration's patterns, as the editor uses them.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

const read = (name) => JSON.parse(readFileSync(new URL(`../${name}`, import.meta.url), "utf8"));
const configuration = read("language-configuration.json");

/** What is put at the beginning of the next line when Enter is pressed between two texts. */
function appended(before, after = "") {
  const fits = (rule, text) => rule === undefined || new RegExp(rule.pattern).test(text);
  const rule = configuration.onEnterRules.find((r) => fits(r.beforeText, before) && fits(r.afterText, after));
  return rule?.action.appendText ?? "";
}

test("documentation goes on, other comments only when they are split", () => {
  assert.equal(appended("/// Where R3 collects."), "/// ");
  assert.equal(appended("  /// Where", " R3"), "/// ");
  assert.equal(appended("//! About the mission."), "//! ");
  assert.equal(appended("// plain"), "");
  assert.equal(appended("// plain", "text"), "// ");
  assert.equal(appended("//// four"), "");
  assert.equal(appended("region a = box (0, 0) .. (1, 1)"), "");
  assert.equal(appended("step 0.5 s // why", ""), "");
});

test("lines after an open bracket are indented, closing ones are not", () => {
  const more = new RegExp(configuration.indentationRules.increaseIndentPattern);
  const less = new RegExp(configuration.indentationRules.decreaseIndentPattern);
  for (const line of ["dynamics Rover {", "connectivity {", "  A = [1, 0;", "dynamics R { // {", "region w = where {"]) {
    assert.match(line, more);
  }
  for (const line of ["}", "// dynamics {", "bound vx, vy in [-4, 4] m/s", "goal g: eventually (R1 in a)", "x { y }"]) {
    assert.doesNotMatch(line, more);
  }
  assert.match("  }", less);
  assert.match("]", less);
  assert.doesNotMatch("  bound x in [0, 1] }", less);
});

test("words are names and numbers", () => {
  const words = (text) => text.match(new RegExp(configuration.wordPattern, "g"));
  assert.deepEqual(words("robot R_1: Rover at (4.5, 1e-3)"), ["robot", "R_1", "Rover", "at", "4.5", "1e-3"]);
  assert.deepEqual(words("horizon 1..40"), ["horizon", "1", "40"]);
});

test("folding has marks", () => {
  const { start, end } = configuration.folding.markers;
  assert.match("  // region Robots", new RegExp(start));
  assert.match("// #region", new RegExp(start));
  assert.match("// endregion", new RegExp(end));
  assert.doesNotMatch("region a = box", new RegExp(start));
});

test("every command of the manifest is one that the client has", () => {
  const source = readFileSync(new URL("../src/extension.ts", import.meta.url), "utf8");
  const manifest = read("package.json");
  const has = [...source.matchAll(/command\("(dosmc\.\w+)"/g)].map((match) => match[1]).sort();
  assert.deepEqual(manifest.contributes.commands.map((c) => c.command).sort(), has);
  for (const key of Object.keys(manifest.contributes.configuration.properties)) {
    const short = key.replace("dosmc.", "");
    assert.ok(short === "trace.server" || source.includes(`"${short}"`), key);
  }
});
