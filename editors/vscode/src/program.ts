// Where the `dosmc` program is. Nothing here names the editor, so that it can be tested without one.

import * as fs from "node:fs";
import * as path from "node:path";

/** What the search looks at besides the setting. */
export interface Surroundings {
  /** The user's home directory. */
  home: string;
  /** The first folder of the workspace. */
  workspace: string | undefined;
  /** The variable `PATH`. */
  path: string;
  /** The endings that programs have: one empty one, or those of Windows. */
  endings: readonly string[];
}

/** The program that is meant by a setting, or the places where it isn't. */
export type Found = { program: string } | { looked: string[] };

/** Finds the program that a setting names. */
export function findProgram(setting: string, around: Surroundings): Found {
  const written = expand(setting.trim() || "dosmc", around);
  const candidates = isPath(written) ? [absolute(written, around)] : byName(written, around);
  for (const candidate of candidates) {
    for (const ending of around.endings) {
      if (isProgram(candidate + ending)) return { program: candidate + ending };
    }
  }
  return { looked: candidates };
}

/** A sentence for people about a program that isn't there. */
export function notFound(setting: string, looked: readonly string[]): string {
  const name = setting.trim() || "dosmc";
  const [only] = looked;
  if (looked.length === 1 && only !== undefined) return `There is no program ${only}.`;
  return `There is no program \`${name}\` in PATH or in ~/.cargo/bin.`;
}

function expand(setting: string, around: Surroundings): string {
  const home = setting === "~" || /^~[/\\]/.test(setting) ? around.home + setting.slice(1) : setting;
  return home.replace(/\$\{workspaceFolder\}/g, () => around.workspace ?? "");
}

function isPath(written: string): boolean {
  return written.includes("/") || written.includes(path.sep);
}

function absolute(written: string, around: Surroundings): string {
  return path.resolve(around.workspace ?? around.home, written);
}

/** `cargo install` puts programs where an editor that wasn't started from a shell doesn't look. */
function byName(name: string, around: Surroundings): string[] {
  const directories = around.path.split(path.delimiter).filter((directory) => directory !== "");
  const all = [...directories, path.join(around.home, ".cargo", "bin")];
  return [...new Set(all.map((directory) => path.join(directory, name)))];
}

function isProgram(file: string): boolean {
  try {
    fs.accessSync(file, fs.constants.X_OK);
    return fs.statSync(file).isFile();
  } catch {
    return false;
  }
}
