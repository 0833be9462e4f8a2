// Tests the page of `farsa lab` in Chromium: from an empty folder to a tested run, with the mouse, on a phone and by keys alone.
//
//   node tests/browser/lab.mjs ADDRESS [SCREENSHOTS]
//
// ADDRESS is what `farsa lab` prints for an empty folder. Prints a line per check and exits with 1 if one failed.

import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { KEY, startDriver } from "./webdriver.mjs";

setTimeout(() => {
  console.log("FAILED the tests took longer than twenty minutes");
  process.exit(1);
}, 1_200_000).unref();

const [address, shots] = process.argv.slice(2);
let failed = 0;
if (shots) mkdirSync(shots, { recursive: true });

function check(name, ok, detail = "") {
  console.log(`${ok ? "ok    " : "FAILED"} ${name}${ok || detail === "" ? "" : `: ${detail}`}`);
  if (!ok) failed++;
}

// A visitor who uses the page by a mouse or by keys alone.
class Visitor {
  constructor(browser, name, { keys = false } = {}) {
    Object.assign(this, { browser, name, byKeys: keys });
  }

  async picture(name) {
    if (shots) writeFileSync(join(shots, `${this.name}-${name}.png`), await this.browser.screenshot());
  }

  // Moves the focus to an element, by Tab as often as it takes.
  async reach(selector) {
    await this.browser.until((s) => [...document.querySelectorAll(s)].some((e) => e.checkVisibility() && !e.disabled), selector);
    if (!this.byKeys) return;
    for (let count = 0; count < 400; count++) {
      if (await this.browser.run((s) => document.activeElement?.matches(s), selector)) return;
      await this.browser.keys(KEY.tab);
    }
    throw new Error(`Tab does not reach ${selector}`);
  }

  async press(selector, key = KEY.enter) {
    await this.reach(selector);
    if (this.byKeys) {
      await this.browser.keys(key);
      return;
    }
    const place = () => this.browser.run((s) => {
      const element = [...document.querySelectorAll(s)].find((e) => e.checkVisibility() && !e.disabled);
      element.scrollIntoView({ block: "center" });
      const { left, top, width, height } = element.getBoundingClientRect();
      return [left + width / 2, top + height / 2];
    }, selector);
    // A page that grows moves its parts.
    let at = await place();
    for (let last; last !== String(at); at = await place()) {
      last = String(at);
      await sleep(100);
    }
    await this.browser.drag([at]);
  }

  // Replaces the text of a field.
  async type(selector, text) {
    if (this.byKeys) await this.reach(selector);
    else await this.press(selector);
    await this.browser.run((s) => document.querySelector(s).select(), selector);
    await this.browser.keys(text);
  }

  state(name) {
    return this.browser.until((state) => document.querySelector(`#status .${state}`) && document.querySelector("#status").textContent, name);
  }
}

const wide = (browser) => browser.run(() => document.documentElement.scrollWidth - innerWidth);

// From an empty folder, or one with the files of the visits before, to a tested run.
async function journey(visitor, file) {
  const { browser, name } = visitor;
  await browser.until(() => document.documentElement.dataset.ready);
  check(`${name}: the token has left the address`, !(await browser.run(() => location.href)).includes("token"));
  await visitor.picture("1-start");
  await visitor.press("#new");
  await visitor.type("#new-name", file);
  await visitor.picture("2-new");
  await visitor.press("#new-name ~ *, form .main");
  await browser.until((file) => document.querySelector("h1")?.textContent === `${file}.toml` && document.querySelector(".setting"), file);
  check(`${name}: the file has no errors`, await browser.until(() => document.querySelector("#text-state.good")?.textContent) === "No errors.");
  await visitor.picture("3-experiment");

  // The form of settings: a value out of range is named, and a right one is taken.
  for (const [key, value] of [["episode.steps", "30"], ["episode.trials", "6"], ["evolution.population", "20"], ["evolution.parents", "2"]]) {
    const row = `[data-key="${key}"]`;
    const isOpen = await browser.run((row) => document.querySelector(row).closest("details").open, row);
    if (!isOpen) {
      const at = await browser.run((row) => [...document.querySelectorAll(".group")].indexOf(document.querySelector(row).closest("details")), row);
      await browser.run((at) => document.querySelectorAll(".group > summary")[at].setAttribute("data-next", ""), at);
      await visitor.press("[data-next]");
      await browser.run(() => document.querySelector("[data-next]").removeAttribute("data-next"));
    }
    if (key === "episode.steps") {
      await visitor.type(`${row} input`, "0");
      check(`${name}: a value out of range is named`, (await browser.run((row) => document.querySelector(`${row} .problem`).textContent, row)).includes("outside 1 to"));
      await visitor.picture("4-wrong");
    }
    await visitor.type(`${row} input`, value);
  }
  check(`${name}: changed settings are counted`, (await browser.run(() => document.querySelector("#settings").parentElement.textContent)).includes("4 changed"));
  await visitor.picture("5-settings");
  await visitor.type("#generations", "1000000");
  await visitor.press("#run");

  await visitor.state("running");
  await browser.until(() => document.querySelectorAll(".curve polyline").length === 2);
  check(`${name}: the run is watched`, (await browser.run(() => document.querySelector("figcaption output").textContent)).startsWith("generation "));
  check(`${name}: its command can be repeated`, (await browser.run(() => document.querySelector(".command code").textContent)).includes(`farsa run ${file}.toml --seed 1 --generations 1000000 --set evolution.population=20`));
  await visitor.picture("6-running");
  await visitor.press("#stop");
  // No machine ends this run before it is stopped.
  const stopped = await visitor.state("stopped");
  check(`${name}: it stops before its end`, /^stopped\d+ of 1000000 generations$/.test(stopped), stopped);
  await visitor.picture("7-stopped");
  await visitor.press("#resume");
  await visitor.state("running");
  await visitor.press("#stop");
  await visitor.state("stopped");
  await visitor.type("#more", "1000100");
  await visitor.press("#extend");
  await browser.until(() => /^running\d+ of 1000100/.test(document.querySelector("#status").textContent));
  await visitor.press("#stop");
  await visitor.state("stopped");
  await visitor.type("#trials", "30");
  check(`${name}: the protocols are offered`, (await browser.until(() => document.querySelector("#protocol")?.textContent)).includes("lesions"));
  await visitor.press("#test");
  const results = await browser.until(() => document.querySelector("#results")?.textContent);
  check(`${name}: the champion is tested`, results.includes("30, seed 1") && results.includes("95% interval"), results);
  await visitor.picture("8-tested");
  check(`${name}: a run fits the screen`, (await wide(browser)) <= 0, String(await wide(browser)));

  await visitor.press("#home");
  const row = await browser.until((run) => {
    const row = document.querySelector(`[data-run="${run}"]`);
    return row?.textContent.includes("stopped") && row.textContent.includes("% (") && row.textContent;
  }, `${file}-1`);
  check(`${name}: the list has the run`, row.includes("of 1000100"), row);
  check(`${name}: the list fits the screen`, (await wide(browser)) <= 0, String(await wide(browser)));
  await visitor.press("thead input, .runs .pick input", " ");
  await visitor.press("#compare");
  const compared = await browser.until(() => [...document.querySelectorAll(".note")].map((note) => note.textContent).find((text) => text.includes("report")));
  check(`${name}: chosen runs are compared`, compared.includes("farsa report runs/") && compared.includes(".html"), compared);
  await visitor.picture("9-list");
  const log = (await browser.log()).filter((line) => !line.includes("422"));
  check(`${name}: the console is silent`, log.length === 0, log.join(" | "));
}

// A trial of any individual: settings in place, a cut neuron, a random genome, evolution that becomes a run of the list.
async function trial(visitor, run) {
  const { browser, name } = visitor;
  await browser.go(new URL(`/#/run/${run}`, address));
  await browser.until(() => document.querySelector("#make-live:enabled"));
  await visitor.type("#generation", "1");
  await visitor.type("#individual", "3");
  await visitor.press("#make-live");
  await browser.until(() => document.querySelector("iframe.trial"));
  const within = async (script, ...args) => {
    await browser.post("frame", { id: await browser.post("element", { using: "css selector", value: "iframe.trial" }) });
    try {
      return await script(...args);
    } finally {
      await browser.post("frame", { id: null });
    }
  };
  await within(() => browser.until(() => window.farsa && (farsa.ready || farsa.error)));
  const page = (script, ...args) => within(() => browser.run(script, ...args));
  check(`${name}: the page is of the chosen individual`, (await page(() => farsa.error ?? document.querySelector("#title").textContent)).includes(run));
  check(`${name}: it is equal to the run`, (await page(() => farsa.live.verify())).startsWith("Equal to the run"));
  await page(() => farsa.live.settle({ "network.slope": "0.2" }));
  const settled = await page(() => farsa.trials.map((trial) => trial.name));
  check(`${name}: a changed setting runs the trial again beside the other`, settled.length === 2 && settled[1].includes("network.slope = 0.2"), settled.join(" | "));
  check(`${name}: the form shows the change`, (await page(() => document.querySelector(".setting.changed span").textContent)) === "slope");
  await page(() => farsa.live.settle({ "network.hidden": "9" }));
  const wrong = await page(() => document.querySelector("#live [role=status]").textContent);
  check(`${name}: a setting that the genes do not fit is refused`, wrong.includes("parameters where"), wrong);
  check(`${name}: the last valid change stays`, (await page(() => document.querySelector(".chips").textContent)).startsWith("network.slope = 0.2"));
  const neuron = await page(() => [...document.querySelectorAll("[aria-label=Part] option")].map(({ value }) => value).find((value) => value.startsWith("neuron:")));
  await page((neuron) => farsa.live.set(neuron, ""), neuron);
  const cut = await page(() => farsa.trials[1].name);
  check(`${name}: a neuron is cut`, cut.includes(`with ${neuron}`), cut);
  await visitor.picture("trial");
  await page(() => farsa.live.undo());
  await page(() => farsa.live.random());
  check(`${name}: a random genome is shown`, (await page(() => document.querySelector("#live select").selectedOptions[0].textContent)) === "generation 0, random of seed 2");
  const before = await page(async () => (await farsa.live.evolve(3)).at(-1).generation);
  const kept = async (kind) => {
    await page((kind) => void farsa.live.keep(kind), kind);
    await visitor.press("dialog .main");
    return browser.until((kind) => [...document.querySelectorAll(".note")].map((note) => note.textContent).findLast((text) => text.includes(kind === "run" ? "is evolved as" : "Kept as")), kind);
  };
  check(`${name}: the changed configuration is kept`, (await kept("configuration")).includes(`exports/${run}.toml`));
  const note = await kept("run");
  const made = /evolved as (\S+?)\./.exec(note)?.[1] + (/\.(\d+)\./.exec(note) ? `.${/\.(\d+)\./.exec(note)[1]}` : "");
  await visitor.press("#home");
  const row = await browser.until((made) => {
    const row = document.querySelector(`[data-run="${made}"]`);
    return row && /finished|stopped|failed/.test(row.textContent) && row.textContent;
  }, made);
  check(`${name}: the run of the page is in the list`, row.includes(`${before + 1} of`), row);
  await browser.log();
}

// Pages that the server opens, with the agent in its own workers and without the origin of the laboratory.
async function pages(browser, run) {
  for (const kind of ["live", "report"]) {
    await browser.go(new URL("/", address));
    await browser.until(() => document.documentElement.dataset.ready);
    await browser.run(async (kind, run) => {
      const answer = await fetch("/api/page", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ kind, runs: [run] }) });
      return answer.json();
    }, kind, run);
    await browser.go(new URL(`/files/pages/${kind}-${run}.html`, address));
    if (kind === "live") {
      await browser.until(() => window.farsa && (farsa.ready || farsa.error));
      check("pages: the agent runs in the page", (await browser.run(() => farsa.error || "")) === "");
      const refused = await browser.run(() => fetch("/api/list").then((answer) => answer.status, () => 0));
      check("pages: a page of the folder does not reach the server", refused === 0, String(refused));
    } else {
      check("pages: the report is shown", (await browser.run(() => document.querySelectorAll("svg").length)) > 0);
    }
  }
  await browser.log();
}

// The text of a file is checked while it is typed, and saved.
async function text(visitor, file) {
  const { browser } = visitor;
  await browser.go(new URL(`/#/experiment/${file}.toml`, address));
  await browser.until(() => document.querySelector("#text-state.good"));
  const select = (part) => browser.run((part) => {
    const area = document.querySelector("#text");
    const at = area.value.indexOf(part);
    area.focus();
    area.setSelectionRange(at, at + part.length);
  }, part);
  await select('kind = "e-puck"');
  await browser.keys('kind = "e-pukc"');
  const why = await browser.until(() => document.querySelector(".errors li")?.textContent);
  check("text: an error has its line and the nearest word", why.includes("Line ") && why.includes("`e-puck`"), why);
  await visitor.picture("text-wrong");
  await visitor.press("#run");
  check("text: an unsaved text does not run", (await browser.until(() => document.querySelector(".launch .problem").textContent)).includes("save or revert"));
  await browser.run(() => { location.hash = "#/"; });
  await browser.until(() => document.querySelector("[data-run]"));
  await browser.run((file) => { location.hash = `#/experiment/${file}.toml`; }, file);
  await browser.until(() => document.querySelector(".errors li"));
  check("text: an unsaved text is kept", await browser.run(() => document.querySelector("#text").value.includes("e-pukc")));
  await select("e-pukc");
  await browser.keys("e-puck");
  await browser.until(() => document.querySelector("#text-state.good"));
  await select("hidden = 4");
  await browser.keys("hidden = 5");
  await visitor.press("#text-title ~ .main");
  await browser.until(() => document.querySelector(".note")?.textContent.includes("was saved"));
  const saved = await browser.run((file) => fetch(`/api/file?name=${file}.toml`).then((answer) => answer.json()).then((data) => data.text), file);
  check("text: it is saved", saved.includes("hidden = 5"));
  await browser.log();
}

const driver = await startDriver();
async function visit(name, file, { scheme, then, ...options }) {
  const browser = await driver.open(options);
  try {
    await browser.media({ "prefers-color-scheme": scheme, "prefers-reduced-motion": "reduce" });
    await browser.go(address);
    const visitor = new Visitor(browser, name, options);
    await journey(visitor, file);
    await then?.(visitor);
  } catch (error) {
    check(name, false, error.message);
    await new Visitor(browser, name).picture("failed").catch(() => {});
  } finally {
    await browser.close();
  }
}
await visit("mouse, light", "seeker", { size: [1440, 900], scheme: "light", then: async (visitor) => {
  await text(visitor, "seeker");
  await trial(visitor, "seeker-1");
  await pages(visitor.browser, "seeker-1");
} });
await visit("keys, dark", "finder", { size: [1440, 900], scheme: "dark", keys: true });
await visit("phone, dark", "walker", { size: [390, 844], phone: true, scheme: "dark" });
await sleep(0);
driver.stop();
console.log(failed ? `${failed} failed` : "all passed");
process.exit(failed ? 1 : 0);
