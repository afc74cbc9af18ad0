// The extension with vscode-languageclient and the real server over stdio, in Node with a stand-in for the editor.
//
// NCCOMPILE names the command if it is not on the path.
"use strict";

const assert = require("node:assert/strict");
const Module = require("node:module");
const test = require("node:test");
const { CancellationTokenSource, Document, Position, Range, standIn } = require("./support/vscode.js");

const settings = { command: [process.env.NCCOMPILE || "nccompile", "lsp"] };
const editor = standIn(settings);

const load = Module._load;
Module._load = (name, ...rest) => (name === "vscode" ? editor.vscode : load(name, ...rest));
const extension = require("../src/extension.js");

const token = () => new CancellationTokenSource().token;

// Waits until the findings of a document are as wanted.
async function findings(uri, wanted) {
  for (;;) {
    const found = (editor.diagnostics.get(uri) || []).map(({ code }) => code?.value ?? code);
    if (wanted(found)) return found;
    await new Promise((resolve) => editor.published.event(resolve));
  }
}

test("findings, edits, hover, definition, hints and lenses", { timeout: 60_000 }, async () => {
  await extension.activate({ subscriptions: [] });
  assert.deepEqual(editor.messages, []);

  const uri = "untitled:Untitled-1";
  const document = new Document(uri, "% a\nN10 g1 X1 F20\nN20 G20 L10 K0\n");
  editor.documents.push(document);
  await editor.events.open.fire(document);
  assert.deepEqual(await findings(uri, (codes) => codes.length > 0), ["NC054", "NC159"]);

  const hover = await editor.providers.Hover.provideHover(document, new Position(1, 5), token());
  assert.match(JSON.stringify(hover), /\*\*G1\*\*: line/);
  const [target] = await editor.providers.Definition.provideDefinition(document, new Position(2, 9), token());
  assert.equal(target.range.start.line, 1);
  const lenses = await editor.providers.CodeLens.provideCodeLenses(document, token());
  assert.match(JSON.stringify(lenses), /1 segment · 1 mm · /);

  document.text = document.text.replace("g1", "G1");
  document.version = 2;
  await editor.events.change.fire({
    document,
    contentChanges: [{ range: new Range(1, 4, 1, 6), rangeOffset: 8, rangeLength: 2, text: "G1" }],
  });
  assert.deepEqual(await findings(uri, (codes) => !codes.includes("NC054")), ["NC159"]);
});

test("the time of the check is shown, and the server can be started again", { timeout: 60_000 }, async () => {
  assert.match(editor.status.text, /^nccompile \d+ ms$/);
  editor.diagnostics.clear();
  await editor.commands["nccompile.restart"]();
  assert.deepEqual(await findings("untitled:Untitled-1", (codes) => codes.length > 0), ["NC159"]);
  await extension.deactivate();
});

test("a command that is not there is told, with what to do", { timeout: 60_000 }, async () => {
  settings.command = ["no-such-nccompile"];
  await extension.activate({ subscriptions: [] });
  assert.match(editor.messages.join("\n"), /no-such-nccompile did not start.*pip install 'nccompile\[lsp\]'/);
  await extension.deactivate();
});
