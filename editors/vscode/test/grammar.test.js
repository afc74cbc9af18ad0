// The TextMate grammar in the tokenizer that VS Code uses.
"use strict";

const assert = require("node:assert/strict");
const fs = require("node:fs");
const path = require("node:path");
const test = require("node:test");
const oniguruma = require("vscode-oniguruma");
const textmate = require("vscode-textmate");

const GRAMMAR = path.join(__dirname, "..", "syntaxes", "din66025.tmLanguage.json");

async function load() {
  const wasm = fs.readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
  await oniguruma.loadWASM(wasm);
  const registry = new textmate.Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async () => textmate.parseRawGrammar(fs.readFileSync(GRAMMAR, "utf8"), GRAMMAR),
  });
  return registry.loadGrammar("source.din66025");
}

const grammar = load();

// The tokens of a line as [text, innermost scope without the language's name]; blanks are left out.
async function tokens(line) {
  const { tokens: found } = (await grammar).tokenizeLine(line, textmate.INITIAL);
  return found
    .map(({ startIndex, endIndex, scopes }) => [
      line.slice(startIndex, endIndex),
      scopes[scopes.length - 1].replace(/\.?din66025$/, ""),
    ])
    .filter(([text]) => text.trim() !== "");
}

test("a block", async () => {
  assert.deepEqual(await tokens("N10 G01 X-1.5 F$feed$ (rough)"), [
    ["N10", "entity.name.label"],
    ["G01", "keyword.control.drive"],
    ["X", "variable.parameter.axis"],
    ["-1.5", "constant.numeric"],
    ["F", "entity.other.attribute-name"],
    ["$feed$", "variable.other"],
    ["(rough)", "comment.block"],
  ]);
});

test("a header, a skipped block, glued words in small letters", async () => {
  assert.deepEqual(await tokens("% bracket"), [
    ["%", "punctuation.definition.program"],
    [" bracket", "entity.name.section"],
  ]);
  assert.deepEqual(await tokens("/n20g20l10k$n$"), [
    ["/", "keyword.operator.skip"],
    ["n20", "entity.name.label"],
    ["g20", "keyword.control.flow"],
    ["l", "entity.other.attribute-name"],
    ["10", "constant.numeric"],
    ["k", "entity.other.attribute-name"],
    ["$n$", "variable.other"],
  ]);
});

test("modes, assignments, M functions and switches", async () => {
  const first = async (line) => (await tokens(line))[0][1];
  assert.equal(await first("G91"), "keyword.other.mode");
  assert.equal(await first("G36 O$n$ D1"), "keyword.operator.assignment");
  assert.equal(await first("M8"), "support.function.m");
  assert.equal(await first("H1 O.5"), "support.function.switch");
});

test("instructions that do not exist are marked, longer ones are not cut", async () => {
  assert.deepEqual(await tokens("G7"), [["G7", "invalid.illegal.instruction"]]);
  assert.deepEqual(await tokens("G901"), [["G901", "invalid.illegal.instruction"]]);
  assert.deepEqual(await tokens("G00"), [["G00", "keyword.control.drive"]]);
});

test("comments hide words", async () => {
  assert.deepEqual(await tokens("(N10 G1) G1"), [
    ["(N10 G1)", "comment.block"],
    ["G1", "keyword.control.drive"],
  ]);
});
