// The client: starts `nccompile lsp` and shows what it knows of part programs.
"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

// The command of the settings as the server options of the client.
function serverOptions() {
  const [command, ...args] = vscode.workspace.getConfiguration("nccompile").get("command");
  return { command, args };
}

// Programs of files and of documents that are not saved yet.
function clientOptions() {
  return {
    documentSelector: [
      { scheme: "file", language: "din66025" },
      { scheme: "untitled", language: "din66025" },
    ],
  };
}

async function start(status) {
  client = new LanguageClient("nccompile", "nccompile", serverOptions(), clientOptions());
  client.onNotification("nccompile/checked", ({ seconds }) => {
    status.text = `nccompile ${Math.round(1000 * seconds)} ms`;
    status.show();
  });
  try {
    await client.start();
  } catch (error) {
    const [command] = vscode.workspace.getConfiguration("nccompile").get("command");
    vscode.window.showErrorMessage(
      `${command} did not start: ${error?.message ?? "see the output"}. Install it with pip install 'nccompile[lsp]', ` +
        "or name it in the setting nccompile.command.",
    );
  }
}

async function activate(context) {
  const status = vscode.window.createStatusBarItem(vscode.StatusBarAlignment.Right);
  context.subscriptions.push(
    status,
    vscode.commands.registerCommand("nccompile.restart", async () => {
      await deactivate();
      await start(status);
    }),
  );
  await start(status);
}

async function deactivate() {
  const running = client;
  client = undefined;
  if (running !== undefined && running.needsStop()) {
    await running.stop();
  }
}

module.exports = { activate, deactivate };
