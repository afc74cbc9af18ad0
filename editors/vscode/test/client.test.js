// The extension with a stand-in for the editor: what it starts is a server that answers over stdio.
//
// NCCOMPILE names the command if it is not on the path.
"use strict";

const assert = require("node:assert/strict");
const { spawn } = require("node:child_process");
const Module = require("node:module");
const test = require("node:test");
const rpc = require("vscode-languageserver-protocol/node");

const COMMAND = [process.env.NCCOMPILE || "nccompile", "lsp"];
const made = { clients: [], commands: {}, messages: [], status: { text: "", show() {} } };

const vscode = {
  workspace: { getConfiguration: () => ({ get: () => made.command || COMMAND }) },
  window: {
    createStatusBarItem: () => made.status,
    showErrorMessage: (text) => made.messages.push(text),
  },
  commands: { registerCommand: (name, run) => (made.commands[name] = run) },
  StatusBarAlignment: { Right: 2 },
};

// A client that speaks the protocol as vscode-languageclient does, without the editor's objects.
class StandInClient {
  constructor(id, name, server, options) {
    Object.assign(this, { server, options, notified: {} });
    made.clients.push(this);
  }

  onNotification(method, run) {
    this.notified[method] = run;
  }

  async start() {
    this.process = spawn(this.server.command, this.server.args, { stdio: ["pipe", "pipe", "inherit"] });
    await new Promise((resolve, reject) => this.process.once("spawn", resolve).once("error", reject));
    this.connection = rpc.createProtocolConnection(
      new rpc.StreamMessageReader(this.process.stdout),
      new rpc.StreamMessageWriter(this.process.stdin),
    );
    for (const [method, run] of Object.entries(this.notified)) {
      this.connection.onNotification(method, run);
    }
    this.connection.listen();
    const asked = { processId: process.pid, rootUri: null, capabilities: {} };
    this.result = await this.connection.sendRequest(rpc.InitializeRequest.type, asked);
    await this.connection.sendNotification(rpc.InitializedNotification.type, {});
  }

  needsStop() {
    return this.connection !== undefined;
  }

  async stop() {
    await this.connection.sendRequest(rpc.ShutdownRequest.type);
    const ended = new Promise((resolve) => this.process.once("exit", resolve));
    await this.connection.sendNotification(rpc.ExitNotification.type);
    this.code = await ended;
    this.connection.dispose();
  }
}

const load = Module._load;
Module._load = (name, ...rest) => {
  if (name === "vscode") return vscode;
  if (name === "vscode-languageclient/node") return { LanguageClient: StandInClient };
  return load(name, ...rest);
};
const extension = require("../src/extension.js");

test("the extension starts a server, shows its findings and ends it", async () => {
  const context = { subscriptions: [] };
  await extension.activate(context);
  const [client] = made.clients;
  assert.deepEqual(made.messages, []);
  assert.equal(client.result.serverInfo.name, "nccompile");
  assert.deepEqual(
    client.options.documentSelector.map(({ language }) => language),
    ["din66025", "din66025"],
  );

  const uri = "untitled:Untitled-1";
  const text = "% a\nN10 g1 X1 F20\n";
  const published = new Promise((resolve) => {
    client.connection.onNotification(rpc.PublishDiagnosticsNotification.type, resolve);
  });
  await client.connection.sendNotification(rpc.DidOpenTextDocumentNotification.type, {
    textDocument: { uri, languageId: "din66025", version: 1, text },
  });
  const { diagnostics } = await published;
  assert.deepEqual(diagnostics.map(({ code }) => code), ["NC054"]);
  const hover = await client.connection.sendRequest(rpc.HoverRequest.type, {
    textDocument: { uri },
    position: { line: 1, character: 5 },
  });
  assert.match(hover.contents.value, /\*\*G1\*\*: line/);
  assert.match(made.status.text, /^nccompile \d+ ms$/);

  await made.commands["nccompile.restart"]();
  assert.equal(made.clients.length, 2);
  assert.equal(client.code, 0);
  await extension.deactivate();
  assert.equal(made.clients[1].code, 0);
});

test("a command that is not there is told, with what to do", async () => {
  made.command = ["no-such-nccompile"];
  await extension.activate({ subscriptions: [] });
  assert.match(made.messages.at(-1), /no-such-nccompile did not start.*pip install 'nccompile\[lsp\]'/);
  await extension.deactivate();
});
