// Tests the pages of a gallery in a real browser.
//
//   farsa list --json | node tests/browser/gallery.mjs FOLDER [SCREENSHOTS]
//
// FOLDER is what docs/gallery/make made; there has to be a page of every experiment that is listed. Every page has to be small, to be up, and to run the trial that it shows as the run did, to
// the bit. Prints a line per check and exits with 1 if one failed. Needs chromium and chromedriver, or with BROWSER=firefox the other two.

import { mkdirSync, readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { startDriver } from "./webdriver.mjs";

const [folder, shots] = process.argv.slice(2);
let failed = 0;
if (shots) mkdirSync(shots, { recursive: true });

function check(name, ok, detail = "") {
  console.log(`${ok ? "ok    " : "FAILED"} ${name}${ok || detail === "" ? "" : `: ${detail}`}`);
  if (!ok) failed++;
}

const silent = async (browser, name) => check(`${name}: the console is silent`, (await browser.log()).length === 0, "it is not");

async function live(browser, name, file) {
  const size = statSync(file).size;
  check(`${name} has ${size} bytes, at most 3000000`, size <= 3_000_000);
  const begin = performance.now();
  await browser.go(pathToFileURL(resolve(file)));
  await browser.until(() => window.farsa && (farsa.ready || farsa.error));
  const error = await browser.run(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(farsa.error)))));
  const first = await browser.run(() => farsa.first);
  check(`${name} shows its first picture after ${Math.round(first)} ms and is up after ${Math.round(performance.now() - begin)} ms`, error === null && first > 0, error);
  await browser.run(() => farsa.pause());
  // In rapier there is a recording alone.
  const found = await browser.run(() => farsa.live?.verify() ?? `a recording of ${farsa.ticks} ticks`);
  check(`${name} runs the run's trial: ${found}`, found.startsWith(name === "push-box" ? "a recording" : "Equal to the run"));
  await browser.run(() => farsa.seek(farsa.ticks / 2));
  if (shots) writeFileSync(join(shots, `${name}.png`), await browser.screenshot());
  await silent(browser, name);
}

async function index(browser, pages) {
  await browser.go(pathToFileURL(resolve(folder, "index.html")));
  const [links, blank] = await browser.run(() => [
    [...document.querySelectorAll("a")].map((a) => a.getAttribute("href")),
    [...document.images].filter((image) => !(image.complete && image.naturalWidth)).map((image) => image.src),
  ]);
  check(`the index links all ${pages.length} pages`, links.toSorted().join() === pages.join(), links.join());
  check("it shows a picture of each", blank.length === 0, blank.join());
  if (shots) writeFileSync(join(shots, "index.png"), await browser.screenshot());
  await silent(browser, "index");
}

const pages = readdirSync(folder).filter((name) => name.endsWith(".html") && name !== "index.html").sort();
const experiments = JSON.parse(readFileSync(0, "utf8")).map(({ name }) => `${name}.html`).sort();
const shown = [...new Set(pages.map((name) => name.replace("-no-labels", "")))];
check(`there is a page of each of ${experiments.length} experiments`, experiments.length > 0 && shown.join() === experiments.join(), pages.join());
let driver;
try {
  driver = await startDriver();
  const browser = await driver.open();
  try {
    for (const page of pages) await live(browser, page.replace(".html", ""), join(folder, page));
    await index(browser, pages);
  } finally {
    await browser.close();
  }
} catch (error) {
  check("the browser runs", false, error.message);
} finally {
  driver?.stop();
}
console.log(failed ? `${failed} checks failed` : "all checks passed");
process.exit(failed ? 1 : 0);
