// Tokenizes missions with the grammar, in the engine that VS Code has, and says what is left without a scope.
//
//   node test/tokens.mjs FILE...          prints what is wrong; status 1 if anything is
//   node test/tokens.mjs --json FILE...   prints each file's tokens: line and column from 1, text, innermost scope
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

const require = createRequire(import.meta.url);
const { Registry, INITIAL, parseRawGrammar } = require("vscode-textmate");
const { loadWASM, OnigScanner, OnigString } = require("vscode-oniguruma");

const grammarFile = new URL("../syntaxes/dosm.tmLanguage.json", import.meta.url);

async function load() {
  const wasm = readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
  await loadWASM(wasm.buffer.slice(wasm.byteOffset, wasm.byteOffset + wasm.byteLength));
  const registry = new Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new OnigScanner(patterns),
      createOnigString: (text) => new OnigString(text),
    }),
    loadGrammar: async () => parseRawGrammar(readFileSync(grammarFile, "utf8"), "dosm.tmLanguage.json"),
  });
  return registry.loadGrammar("source.dosm");
}

/** The tokens of a text: line and column from 1, the text, the innermost scopes. */
function* tokens(grammar, text) {
  let state = INITIAL;
  for (const [index, line] of text.split(/\r?\n/).entries()) {
    const result = grammar.tokenizeLine(line, state);
    state = result.ruleStack;
    for (const token of result.tokens) {
      const written = line.slice(token.startIndex, token.endIndex);
      if (written.trim() !== "") {
        yield { line: index + 1, column: token.startIndex + 1, text: written, scopes: token.scopes };
      }
    }
  }
}

/** What is wrong with a token of a mission that parses. */
function fault({ scopes }) {
  const own = scopes.filter((scope) => scope !== "source.dosm" && !scope.startsWith("meta."));
  if (own.length === 0) return "has no scope";
  return own.some((scope) => scope.startsWith("invalid")) ? "is taken for invalid" : undefined;
}

/** Prints what is wrong with the tokens of some files; whether all is well. */
function judge(grammar, files) {
  let wrong = 0;
  let count = 0;
  for (const file of files) {
    for (const token of tokens(grammar, readFileSync(file, "utf8"))) {
      const what = fault(token);
      if (what) console.log(`${file}:${token.line}:${token.column}: ${JSON.stringify(token.text)} ${what}`);
      if (what) wrong += 1;
      count += 1;
    }
  }
  console.log(`${count} tokens, ${wrong} wrong`);
  return wrong === 0 && count > 0;
}

/** The tokens of some files. */
function listed(grammar, files) {
  const list = (file) => [...tokens(grammar, readFileSync(file, "utf8"))];
  const short = ({ line, column, text, scopes }) => [line, column, text, scopes.at(-1)];
  return Object.fromEntries(files.map((file) => [file, list(file).map(short)]));
}

const grammar = await load();
const [first, ...others] = process.argv.slice(2);
if (first === "--json") {
  console.log(JSON.stringify(listed(grammar, others)));
} else {
  process.exit(judge(grammar, [first, ...others]) ? 0 : 1);
}
