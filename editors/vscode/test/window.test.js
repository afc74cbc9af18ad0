// The packed extension in a real VS Code window and extension host; see support/window.js for what it needs.
//
// SCREENSHOTS names a folder for pictures of it.
"use strict";

const assert = require("node:assert/strict");
const fs = require("node:fs");
const path = require("node:path");
const { after, before, test } = require("node:test");
const { openWindow } = require("./support/window.js");

const PROGRAM = fs.readFileSync(path.join(__dirname, "..", "..", "bracket.nc"), "utf8");

let window;
let page;

before(async () => {
  window = await openWindow({ "bracket.nc": PROGRAM });
  page = window.page;
  page.setDefaultTimeout(30_000);
  await page.dblclick(".explorer-folders-view >> text=bracket.nc");
});

after(async () => window?.close());

const picture = async (name) => {
  const folder = process.env.SCREENSHOTS;
  if (folder) await page.screenshot({ path: path.join(folder, `${name}.png`) });
};

// The texts of all elements, blanks made ordinary.
const texts = async (selector) =>
  (await page.locator(selector).allTextContents()).map((text) => text.replaceAll("\u00a0", " "));

// Waits until a question has the wanted answer.
async function until(what, ask, wanted) {
  let answer;
  for (let tries = 0; tries < 150; tries += 1) {
    answer = await ask();
    if (wanted(answer)) return answer;
    await page.waitForTimeout(200);
  }
  return assert.fail(`${what}: ${JSON.stringify(answer)}`);
}

// The shown lines in their order on the screen; hints stand in them.
async function lines() {
  const rows = await page.locator(".view-lines .view-line").all();
  const found = [];
  for (const row of rows) {
    const box = await row.boundingBox();
    if (box) found.push([box.y, (await row.textContent()).replaceAll("\u00a0", " ")]);
  }
  return found.sort((a, b) => a[0] - b[0]).map(([, text]) => text);
}

// Puts the cursor at a line and column.
async function goTo(line, column) {
  await page.keyboard.press("Control+G");
  await page.waitForSelector(".quick-input-widget input");
  await page.keyboard.type(`${line}:${column}`);
  await page.keyboard.press("Enter");
  await page.waitForFunction(
    (where) => document.body.textContent.replaceAll("\u00a0", " ").includes(where),
    `Ln ${line}, Col ${column}`,
  );
}

test("squiggles, lenses and hints", { timeout: 120_000 }, async () => {
  await page.waitForSelector(".squiggly-info");
  await page.waitForSelector(".squiggly-warning");
  const lenses = await until("lenses", () => texts(".codelens-decoration"), (found) => found.length === 3);
  assert.match(lenses.join("\n"), /13 segments · 175\.921 mm · [\d.]+ s/);
  const shown = await until("hints", lines, (found) => / s$/.test(found.at(-2)));
  assert.match(shown.find((line) => line.startsWith("N50")), /N50 G3 X30 Y30 I-10 J0\s*R10 {2}0\.\d+ s/);
  assert.match(shown.find((line) => line.startsWith("N90")), /→ X0 Y20/);
  await until("status", () => texts(".statusbar-item"), (found) => found.some((text) => /nccompile \d+ ms/.test(text)));
  await picture("window");
});

test("colours of the grammar and the server", async () => {
  const colour = (text) =>
    page.locator(`.view-line span span:text-is("${text}")`).first()
      .evaluate((span) => getComputedStyle(span).color);
  const [comment, instruction, header] = [await colour("(rough)"), await colour("G3"), await colour("% bracket")];
  assert.equal(new Set([comment, instruction, header]).size, 3);
});

test("hover shows the instruction and what is in force", async () => {
  await goTo(12, 6);
  await page.keyboard.press("Control+K");
  await page.keyboard.press("Control+I");
  const [text] = await until(
    "hover", () => texts(".monaco-hover:not(.hidden) .hover-contents"), (found) => found.join().includes("G91"),
  );
  assert.match(text, /G1: line/);
  await picture("hover");
  await page.keyboard.press("Escape");
});

test("a quick fix is offered and taken", async () => {
  await goTo(6, 5);
  await page.keyboard.press("Control+.");
  const menu = ".action-widget .action-item, .action-widget .monaco-list-row";
  const offered = await until("fixes", () => texts(menu), (found) => found.join().includes("upper case"));
  assert.match(offered.join("\n"), /Silence NC054 here/);
  await picture("quick-fix");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".squiggly-info", { state: "detached" });
  assert.ok((await lines()).some((line) => line.startsWith("N40 G1 X40 Y20")));
});

test("renaming a block takes its jumps along, and F12 finds it", async () => {
  await goTo(15, 11);
  await page.keyboard.press("F12");
  await page.waitForFunction(() => document.body.textContent.includes("Ln 12, Col"));
  await page.keyboard.press("F2");
  const box = page.locator(".rename-box input");
  await box.fill("95");
  await box.press("Enter");
  await until("renamed", lines, (found) => found.some((line) => line.startsWith("N120 G20 L95 K$pass$")));
  assert.ok((await lines()).some((line) => line.startsWith("N95 G1 X0 Y-10")));
});

test("completion and errors while typing, formatting", async () => {
  await goTo(18, 1);
  await page.keyboard.type("n150  g9", { delay: 80 });
  await until("completion", () => texts(".suggest-widget .label-name"), (found) => found.includes("G92"));
  await picture("completion");
  await page.keyboard.press("Escape");
  await page.keyboard.type("0X1,5");
  await page.waitForSelector(".squiggly-error");
  await page.keyboard.press("Backspace");
  await page.keyboard.press("Backspace");
  await page.waitForSelector(".squiggly-error", { state: "detached" });
  await page.keyboard.press("Control+Shift+I");
  await until("formatted", lines, (found) => found.some((line) => line.startsWith("N150 G90 X1")));
});

test("the outline names sections and loops", async () => {
  await page.keyboard.press("Control+Shift+O");
  const rows = ".quick-input-list .monaco-list-row";
  const found = await until("outline", () => texts(rows), (shown) => shown.length === 3);
  assert.match(found.join("\n"), /rough[^]*finish[^]*loop N95/);
  await page.keyboard.press("Escape");
});
