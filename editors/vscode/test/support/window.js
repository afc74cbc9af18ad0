// A VS Code window in a browser: code-server with the packed extension, driven by playwright-core.
//
// CODE_SERVER   the command of code-server, or the path of its out/node/entry.js
// CHROMIUM      the browser; /usr/bin/chromium if not given
// NCCOMPILE     the command of nccompile, if it is not on the path
"use strict";

const { spawn, execFileSync } = require("node:child_process");
const fs = require("node:fs");
const net = require("node:net");
const os = require("node:os");
const path = require("node:path");
const { setTimeout: sleep } = require("node:timers/promises");
const { chromium } = require("playwright-core");

const VSIX = path.join(__dirname, "..", "..", "nccompile.vsix");
const FLAGS = [
  "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];

function settings() {
  return {
    "nccompile.command": [process.env.NCCOMPILE || "nccompile", "lsp"],
    "security.workspace.trust.enabled": false,
    "workbench.startupEditor": "none",
    "workbench.colorTheme": "Default Light Modern",
    "editor.minimap.enabled": false,
    "editor.fontSize": 14,
    "files.autoSave": "off",
    "extensions.autoUpdate": false,
    "telemetry.telemetryLevel": "off",
    "update.mode": "none",
    "window.commandCenter": false,
  };
}

function freePort() {
  return new Promise((resolve) => {
    const server = net.createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

// Starts code-server with the extension, in folders of its own, and shows a folder with the given files.
async function openWindow(files) {
  const home = fs.mkdtempSync(path.join(os.tmpdir(), "nccompile-window-"));
  const folder = path.join(home, "work");
  fs.mkdirSync(path.join(home, "data", "User"), { recursive: true });
  fs.mkdirSync(folder);
  fs.writeFileSync(path.join(home, "data", "User", "settings.json"), JSON.stringify(settings()));
  for (const [name, text] of Object.entries(files)) fs.writeFileSync(path.join(folder, name), text);
  const command = process.env.CODE_SERVER;
  const [program, first] = command.endsWith(".js") ? [process.execPath, [command]] : [command, []];
  const places = [
    "--config", path.join(home, "none.yaml"), "--user-data-dir", path.join(home, "data"),
    "--extensions-dir", path.join(home, "extensions"),
  ];
  fs.writeFileSync(path.join(home, "none.yaml"), "");
  execFileSync(program, [...first, ...places, "--install-extension", VSIX], { stdio: "pipe" });
  const port = await freePort();
  const server = spawn(
    program,
    [...first, ...places, "--auth", "none", "--bind-addr", `127.0.0.1:${port}`, "--disable-telemetry",
      "--disable-update-check", folder],
    { stdio: "ignore" },
  );
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM || "/usr/bin/chromium", args: FLAGS,
  });
  const page = await browser.newPage({ viewport: { width: 1000, height: 560 } });
  await reach(page, `http://127.0.0.1:${port}/?folder=${folder}`);
  const close = async () => {
    await browser.close();
    server.kill();
    await new Promise((resolve) => server.once("exit", resolve));
    fs.rmSync(home, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
  };
  return { page, folder, close };
}

// Loads the page as soon as the server listens.
async function reach(page, address) {
  for (let tries = 0; ; tries += 1) {
    try {
      await page.goto(address);
      return await page.waitForSelector(".explorer-folders-view .monaco-list-row", { timeout: 60_000 });
    } catch (error) {
      if (tries === 40 || !/ERR_CONNECTION_REFUSED/.test(error.message)) throw error;
      await sleep(500);
    }
  }
}

module.exports = { openWindow };
