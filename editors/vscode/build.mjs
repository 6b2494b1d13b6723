// Bundles the client, and writes the licences of what is in the bundle beside it.
//
// Fails when something is bundled whose licence is not one of those below.
import { build } from "esbuild";
import { existsSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const ALLOWED = ["MIT", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "ISC"];

const result = await build({
  entryPoints: ["src/extension.ts"],
  outfile: "dist/extension.js",
  bundle: true,
  minify: true,
  format: "cjs",
  platform: "node",
  target: "node18",
  external: ["vscode"],
  legalComments: "none",
  metafile: true,
  logLevel: "warning",
});

const packages = new Set(
  Object.keys(result.metafile.inputs)
    .map((file) => file.match(/^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//)?.[1])
    .filter(Boolean),
);

const notices = [...packages].sort().map((directory) => {
  const { name, version, license } = JSON.parse(readFileSync(join(directory, "package.json"), "utf8"));
  if (!ALLOWED.includes(license)) throw new Error(`${name} has the licence ${license}`);
  const file = readdirSync(directory).find((entry) => /^licen[cs]e(\.|$)/i.test(entry));
  if (!file || !existsSync(join(directory, file))) throw new Error(`${name} has no licence text`);
  const text = readFileSync(join(directory, file), "utf8").replace(/\r/g, "").trim();
  return `${name} ${version} (${license})\n\n${text}\n`;
});

writeFileSync("dist/THIRD-PARTY.txt", `The client contains these packages.\n\n${notices.join(`\n${"-".repeat(80)}\n\n`)}`);
