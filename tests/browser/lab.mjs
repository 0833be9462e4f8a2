// Tests the page of `farsa lab` in Chromium: from an empty folder to a tested run, with the mouse, on a phone and by keys alone.
//
//   node tests/browser/lab.mjs ADDRESS [SCREENSHOTS [FOLDER [VISITS]]]
//
// ADDRESS is what `farsa lab` prints for an empty FOLDER, in which saved commands are run by the `farsa` of PATH. VISITS is a part of the
// names of the visits. Prints a line per check and exits with 1 if one failed.

import { execFileSync } from "node:child_process";
import { mkdirSync, readdirSync, readFileSync, rmSync, utimesSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { KEY, startDriver } from "./webdriver.mjs";

setTimeout(() => {
  console.log("FAILED the tests took longer than forty minutes");
  process.exit(1);
}, 2_400_000).unref();

const [address, shots, folder, visits = ""] = process.argv.slice(2);
let failed = 0;
if (shots) mkdirSync(shots, { recursive: true });

function check(name, ok, detail = "") {
  console.log(`${ok ? "ok    " : "FAILED"} ${name}${ok || detail === "" ? "" : `: ${detail}`}`);
  if (!ok) failed++;
}

const CHAMPION = 'iframe[title^="Champion"]';
const TRIAL = 'iframe[title^="Trial"]';

// A visitor who uses the page by a mouse or by keys alone.
class Visitor {
  constructor(browser, name, { keys = false } = {}) {
    Object.assign(this, { browser, name, byKeys: keys });
  }

  async picture(name) {
    if (!shots) return;
    // On a busy machine Chromium may not take a picture in time. This is no fault of the page.
    const picture = await this.browser.screenshot().catch((error) => console.log(`no picture of ${this.name}-${name}: ${error.message}`));
    if (picture) writeFileSync(join(shots, `${this.name}-${name}.png`), picture);
  }

  // Pauses the trial of a frame. Chromium may not take a picture of a busy frame in time.
  async rest(selector) {
    await this.within(selector, () => this.browser.run(() => farsa.pause()));
    await sleep(500);
  }

  // Moves the focus to an element, by Tab in its direction as often as it takes.
  async reach(selector) {
    await this.browser.until((s) => [...document.querySelectorAll(s)].some((e) => e.checkVisibility() && !e.disabled), selector);
    if (!this.byKeys) return;
    for (let tries = 0; tries < 60; tries++) {
      const steps = await this.browser.run((s) => {
        const here = document.activeElement;
        if (here.matches(s) && document.hasFocus()) return 0;
        const places = [...document.querySelectorAll("a[href], button, input, select, textarea, summary, iframe, [tabindex]")].filter((e) => e.checkVisibility() && !e.disabled);
        const steps = places.findIndex((e) => e.matches(s)) - places.indexOf(here);
        // The number of places in a frame is unknown.
        return here.matches("iframe") ? Math.sign(steps) * 20 : steps;
      }, selector);
      if (!steps) return;
      await this.browser.keys(KEY.tab.repeat(Math.abs(steps)), steps < 0 ? KEY.shift : null);
    }
    throw new Error(`Tab does not reach ${selector}`);
  }

  async press(selector, key = KEY.enter) {
    await this.reach(selector);
    if (this.byKeys) {
      await this.browser.keys(key);
      return;
    }
    const place = async () => {
      const [x, y] = await this.browser.run((s) => {
        const element = [...document.querySelectorAll(s)].find((e) => e.checkVisibility() && !e.disabled);
        const center = () => {
          const { left, top, width, height } = element.getBoundingClientRect();
          return [left + width / 2, top + height / 2];
        };
        // The scene of a narrow page covers what is behind it.
        for (const block of ["center", "end"]) {
          element.scrollIntoView({ block });
          if (element.contains(document.elementFromPoint(...center()))) break;
        }
        return center();
      }, selector);
      // A message covers the lower end of a narrow page for some seconds.
      return this.frame ? this.outside((frame) => this.browser.until((frame, x, y) => {
        const element = document.querySelector(frame);
        const place = () => element.getBoundingClientRect();
        scrollBy(0, place().top + y - innerHeight / 2);
        const at = [place().left + x, place().top + y];
        return document.elementFromPoint(...at) === element && at;
      }, frame, x, y)) : [x, y];
    };
    // A page that grows moves its parts.
    let at = await place();
    for (let last; last !== String(at); at = await place()) {
      last = String(at);
      await sleep(100);
    }
    // Places are those of the outer page.
    await (this.frame ? this.outside(() => this.browser.drag([at])) : this.browser.drag([at]));
  }

  // Replaces the text of a field.
  async type(selector, text) {
    if (this.byKeys) await this.reach(selector);
    else await this.press(selector);
    await this.browser.run((s) => document.querySelector(s).select(), selector);
    await this.browser.keys(text);
  }

  // Presses the visible button with a text.
  async push(text) {
    await this.browser.until((text) => {
      const button = [...document.querySelectorAll("button")].find((one) => one.textContent === text && one.checkVisibility() && !one.disabled);
      button?.setAttribute("data-next", "");
      return !!button;
    }, text);
    await this.press("[data-next]");
    await this.browser.run(() => document.querySelector("[data-next]")?.removeAttribute("data-next"));
  }

  // Chooses an option of a list by its value, with arrows.
  async choose(selector, value) {
    for (let tries = 0; tries < 5; tries++) {
      if (this.byKeys) await this.reach(selector);
      else await this.press(selector);
      const way = await this.browser.run((s, value) => {
        const list = document.querySelector(s);
        return [...list.options].findIndex((option) => option.value === value) - list.selectedIndex;
      }, selector, value);
      await this.browser.keys((way > 0 ? KEY.down : KEY.up).repeat(Math.abs(way)));
      // An open list takes Enter.
      if (!this.byKeys) await this.browser.keys(KEY.enter);
      await sleep(100);
      if (await this.browser.run((s, value) => document.querySelector(s).value === value, selector, value)) return;
    }
    throw new Error(`${value} of ${selector} cannot be chosen`);
  }

  // Acts in a frame.
  async within(selector, act) {
    if (this.byKeys) await this.reach(selector);
    await this.enter(selector);
    try {
      return await act();
    } finally {
      await this.enter(null);
    }
  }

  async enter(selector) {
    const id = selector && (await this.browser.post("element", { using: "css selector", value: selector }));
    await this.browser.post("frame", { id });
    this.frame = selector;
  }

  // Acts in the page around the frame.
  async outside(act) {
    const { frame } = this;
    await this.enter(null);
    try {
      return await act(frame);
    } finally {
      await this.enter(frame);
    }
  }

  state(name) {
    return this.browser.until((state) => document.querySelector(`#status .${state}`) && document.querySelector("#status").textContent, name);
  }
}

const wide = (browser) => browser.run(() => document.documentElement.scrollWidth - innerWidth);

// From an empty folder, or one with the files of the visits before, to a tested run.
async function journey(visitor, file, isThorough) {
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
  await champion(visitor, isThorough);
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
  // The next answer about the run is from before the stop, and arrives after the event of its end.
  await browser.run(async () => {
    const ask = fetch;
    const isOfRun = (path) => String(path).startsWith("/api/run?");
    const before = await (await ask(`/api/run?name=${location.hash.split("/")[2]}`)).text();
    window.fetch = async (path, ...rest) => {
      if (!isOfRun(path)) return ask(path, ...rest);
      window.fetch = ask;
      await new Promise((resolve) => setTimeout(resolve, 2000));
      return new Response(before);
    };
  });
  await visitor.press("#stop");
  await sleep(2500);
  await visitor.state("stopped");
  await visitor.type("#trials", "30");
  check(`${name}: the protocols are offered`, (await browser.until(() => document.querySelector("#protocol")?.textContent)).includes("lesions"));
  await visitor.press("#test");
  const results = await browser.until(() => document.querySelector("#results")?.textContent);
  check(`${name}: the champion is tested`, results.includes("30, seed 1") && results.includes("95% interval"), results);
  await visitor.picture("8-tested");
  check(`${name}: a run fits the screen`, (await wide(browser)) <= 0, String(await wide(browser)));

  await visitor.press("#home");
  if (folder) {
    await browser.until(() => document.querySelector("#search-experiments"));
    await experiments(visitor, readdirSync(folder).filter((name) => name.endsWith(".toml")).sort().join());
  }
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

// Experiments and pages of the gallery are searched and sorted.
async function experiments(visitor, files) {
  const { browser, name } = visitor;
  const names = () => browser.run(() => [...document.querySelectorAll(".tile")].filter((tile) => tile.checkVisibility()).map((tile) => tile.querySelector("b").textContent));
  await visitor.type("#search-experiments", "pole");
  check(`${name}: experiments are searched`, (await names()).join() === "double-pole", (await names()).join());
  await visitor.type("#search-experiments", "gallery");
  check(`${name}: pages of the gallery are found`, (await names()).join() === "dancer,walker", (await names()).join());
  await visitor.picture("gallery");
  await visitor.choose("#order-experiments", "last");
  check(`${name}: they are sorted by name`, (await names()).join() === "walker,dancer", (await names()).join());
  await visitor.choose("#order-experiments", "oldest");
  check(`${name}: they are sorted by date`, (await names()).join() === "walker,dancer" && (await browser.run(() => document.querySelector("[data-kind=gallery] a").getAttribute("href"))) === "/files/gallery/walker.html", (await names()).join());
  await visitor.choose("#order-experiments", "name");
  await visitor.type("#search-experiments", "nothing has this");
  check(`${name}: a search without a result says so`, (await names()).length === 0 && (await browser.run(() => document.querySelector("[aria-labelledby=experiments]").textContent)).includes("No experiment has these words."));
  await visitor.type("#search-experiments", KEY.backspace);
  check(`${name}: without a search the folder's files are shown`, (await names()).join() === files, (await names()).join());
}

// The champion on the page of a running run: it follows new champions in its frame, but not while it is changed.
async function champion(visitor, isThorough) {
  const { browser, name } = visitor;
  const rows = () => Number(/generation (\d+)/.exec(document.querySelector("figcaption output").textContent)[1]);
  await browser.until((s) => document.querySelector(s), CHAMPION);
  await browser.run(() => document.querySelector("#champion").scrollIntoView());
  await visitor.within(CHAMPION, async () => {
    await browser.until(() => window.farsa && (farsa.ready || farsa.error));
    check(`${name}: the champion of a running run is shown`, (await browser.run(() => farsa.error)) === null);
    const parts = await browser.run(() => [farsa.trials[0].ticks > 1, document.querySelector("#graph").clientHeight > 0, document.querySelectorAll("#groups .row").length > 3]);
    check(`${name}: with its trial, network and channels`, parts.every(Boolean), parts.join());
    await browser.run(() => { window.isSame = true; });
  });
  const shown = () => visitor.within(CHAMPION, () => browser.run(() => window.isSame && document.querySelector("#live select").selectedOptions[0].textContent));
  const first = await shown();
  // Nothing is touched for some seconds. A focus in the channels or settings holds a champion back.
  if (visitor.byKeys) await visitor.within(CHAMPION, () => visitor.reach("#live select"));
  const followed = await visitor.within(CHAMPION, () => browser.until((first) => {
    const text = document.querySelector("#live select").selectedOptions[0].textContent;
    return text !== first && text;
  }, first));
  check(`${name}: a new champion follows in the same page`, /^generation \d+, new$/.test(followed) && (await shown()) !== false, `${first} to ${followed}`);
  const graph = await visitor.within(CHAMPION, () => browser.run(() => [farsa.trials.length, document.querySelector("#evolution p").textContent]));
  check(`${name}: alone, with its generation`, graph[0] === 1 && graph[1].startsWith("Generation "), graph.join(" | "));
  await visitor.rest(CHAMPION);
  await visitor.picture("champion");
  if (!isThorough) return;
  await visitor.within(CHAMPION, () => visitor.push("Noise 0.1"));
  await visitor.within(CHAMPION, () => browser.until(() => farsa.trials.length === 2));
  const held = await shown();
  const before = await browser.run(rows);
  await sleep(7500);
  check(`${name}: a changed trial stays`, (await shown()) === held && (await browser.run(rows)) > before, `${held}, ${await shown()}`);
  await visitor.within(CHAMPION, async () => {
    await visitor.push("Follow");
    await visitor.push("Undo all");
    await browser.until(() => farsa.trials.length === 1);
  });
  await sleep(7500);
  check(`${name}: without Follow it stays`, (await shown()) === held, `${held}, ${await shown()}`);
  await visitor.within(CHAMPION, () => visitor.push("Show champion"));
  await visitor.within(CHAMPION, () => browser.until((held) => document.querySelector("#live select").selectedOptions[0].textContent !== held, held));
}

// A trial of any individual: settings in place, a cut neuron, a moved body, a random genome, evolution that becomes a run of the list.
async function trial(visitor, run) {
  const { browser, name } = visitor;
  await browser.go(new URL(`/#/run/${run}`, address));
  await browser.until(() => document.querySelector("#make-live:enabled"));
  await visitor.type("#generation", "1");
  await visitor.type("#individual", "3");
  await visitor.press("#make-live");
  await browser.until(() => document.querySelector('iframe[title^="Trial"]'));
  const page = (script, ...args) => visitor.within(TRIAL, () => browser.run(script, ...args));
  const until = (script, ...args) => visitor.within(TRIAL, () => browser.until(script, ...args));
  const status = (text) => until((text) => [document.querySelector("#live [role=status]").textContent].find((said) => said.includes(text)), text);
  await until(() => window.farsa && (farsa.ready || farsa.error));
  check(`${name}: the page is of the chosen individual`, (await page(() => farsa.error ?? document.querySelector("#title").textContent)).includes(run));
  await visitor.within(TRIAL, () => visitor.push("Verify"));
  check(`${name}: it is equal to the run`, (await status("the run")).startsWith("Equal to the run"));

  const set = (key, value) => visitor.within(TRIAL, async () => {
    if (!(await browser.run(() => document.querySelector("#settings").open))) await visitor.press("#settings > summary");
    await visitor.type("#settings input[type=search]", key);
    await visitor.type(`#settings [aria-label="${key}"]`, value);
    await visitor.press("#apply");
  });
  await set("network.slope", "0.2");
  const settled = await until(() => farsa.trials.length === 2 && farsa.trials.map((trial) => trial.name));
  check(`${name}: a changed setting runs the trial again with the other`, settled[1].includes("network.slope = 0.2"), settled.join(" | "));
  check(`${name}: the form shows the change`, (await page(() => document.querySelector(".setting.changed span").textContent)) === "slope");
  await set("network.hidden", "9");
  const wrong = await status("parameters where");
  check(`${name}: a setting that the genes do not fit is refused`, wrong !== "", wrong);
  check(`${name}: the last valid change stays`, (await page(() => document.querySelector(".chips").textContent)).startsWith("network.slope = 0.2"));
  await visitor.within(TRIAL, () => visitor.push("Undo all"));
  await until(() => farsa.trials.length === 1);

  const neuron = await page(() => [...document.querySelectorAll("[aria-label=Part] option")].map(({ value }) => value).find((value) => value.startsWith("neuron:")));
  await visitor.within(TRIAL, async () => {
    await visitor.choose("[aria-label=Part]", neuron);
    await visitor.push("Silence or cut");
  });
  const cut = await until(() => farsa.trials.length === 2 && farsa.trials[1].name);
  check(`${name}: a neuron is cut`, cut.includes(`with ${neuron}`), cut);
  await visitor.rest(TRIAL);
  await visitor.picture("trial");

  // A body is moved by keys in every visit. Only a command repeats this.
  await visitor.within(TRIAL, async () => {
    await visitor.push("Move bodies");
    await browser.keys(KEY.right + KEY.right + KEY.enter);
    await browser.until(() => document.querySelector(".chips").textContent.includes("moved at"));
    await browser.until(() => farsa.trials[1]?.name.includes("1 moved"));
  });
  const save = async (kind) => {
    await visitor.within(TRIAL, async () => {
      await visitor.choose('[aria-label="What is saved"]', kind);
      await visitor.press("#keep");
    });
  };
  await save("configuration");
  const refused = await status("configuration");
  check(`${name}: a configuration without the move is refused`, refused === "A configuration cannot move or push bodies: save the command.", refused);
  const notes = await browser.run(() => document.querySelectorAll(".note").length);
  const kept = async (kind) => {
    await save(kind);
    await visitor.press("dialog .main");
    return browser.until((kind) => [...document.querySelectorAll(".note")].map((note) => note.textContent).findLast((text) => text.includes(kind)), kind === "run" ? "is evolved as" : `exports/`);
  };
  check(`${name}: nothing was kept`, notes === (await browser.run(() => document.querySelectorAll(".note").length)));
  const script = /exports\/\S+\.sh/.exec(await kept("script"))[0];
  if (folder) {
    const film = await page(() => farsa.trials.map((trial) => trial.json.data));
    execFileSync("sh", [script, `runs/${run}`], { cwd: folder, stdio: "ignore" });
    const html = readFileSync(join(folder, "trial.html"), "utf8");
    const [intact, changed] = JSON.parse(html.slice(html.lastIndexOf('id="data">') + 10, html.lastIndexOf("</script>"))).episodes;
    check(`${name}: the kept command has the bits of the page`, intact.data === film[0] && changed.data === film[1] && film[0] !== film[1]);
    check(`${name}: with the cut and the move`, changed.name.includes(`with ${neuron}, 1 moved`), changed.name);
    rmSync(join(folder, "trial.html"));
  }
  await visitor.within(TRIAL, async () => {
    await visitor.push("Undo all");
    await browser.until(() => farsa.trials.length === 1);
    await visitor.push("Random genome");
  });
  check(`${name}: a random genome is shown`, await until(() => document.querySelector("#live select").selectedOptions[0].textContent === "generation 0, random of seed 2"));

  // Evolution continues until it is stopped.
  await visitor.within(TRIAL, () => visitor.push("Continue evolution"));
  const generation = () => Number(/Generation (\d+)/.exec(document.querySelector("#evolution p").textContent)?.[1]);
  const from = await page(generation);
  await until((from) => Number(/Generation (\d+)/.exec(document.querySelector("#evolution p").textContent)?.[1]) >= from + 3, from);
  await visitor.within(TRIAL, () => visitor.push("Stop"));
  await until(() => [...document.querySelectorAll("#evolution button")].some((button) => button.textContent === "Continue evolution"));
  const last = await page(generation);
  check(`${name}: the changed configuration is kept`, (await kept("configuration")).includes(`exports/${run}`));
  const note = await kept("run");
  const made = /evolved as (\S+)\.$/.exec(note.replace("×", ""))?.[1];
  await visitor.picture("kept");
  await visitor.press("#home");
  const row = await browser.until((made) => {
    const row = document.querySelector(`[data-run="${made}"]`);
    return row && /finished|stopped|failed/.test(row.textContent) && row.textContent;
  }, made);
  check(`${name}: the run of the page is in the list`, row.includes("finished") && row.includes(`${last + 1} of`), row);
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

// A gallery of two pages and the page that shows them.
if (folder) {
  mkdirSync(join(folder, "gallery"));
  for (const [name, date] of [["walker", 1e9], ["dancer", 1.1e9], ["index", 1.2e9]]) {
    const path = join(folder, "gallery", `${name}.html`);
    writeFileSync(path, `<!doctype html><title>${name}</title><p>A page of ${name}.`);
    utimesSync(path, date, date);
  }
}

const driver = await startDriver();
async function visit(name, file, { scheme, then, ...options }) {
  if (!name.includes(visits)) return;
  const browser = await driver.open(options);
  try {
    await browser.media({ "prefers-color-scheme": scheme, "prefers-reduced-motion": "reduce" });
    await browser.go(address);
    const visitor = new Visitor(browser, name, options);
    await journey(visitor, file, !options.keys && !options.phone);
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
await visit("keys, dark", "finder", { size: [1440, 900], scheme: "dark", keys: true, then: (visitor) => trial(visitor, "finder-1") });
// A phone is emulated. For a frame in its own process Chromium would place the click of a finger elsewhere.
const phone = { size: [390, 844], phone: true, flags: ["--disable-features=IsolateSandboxedIframes"] };
await visit("phone, dark", "walker", { ...phone, scheme: "dark", then: (visitor) => trial(visitor, "walker-1") });
await visit("phone, light", "rover", { ...phone, scheme: "light" });
await sleep(0);
driver.stop();
console.log(failed ? `${failed} failed` : "all passed");
process.exit(failed ? 1 : 0);
