// A run: its curve and champion while it grows, its processes, tests, pages and exports.

import { Curve } from "./curve.js";
import { act, address, bytes, change, command, confirmed, date, field, h, note, number, percent, read, seconds, show, state, success } from "./parts.js";
import { header } from "./start.js";
import { framed } from "./trial.js";

const FORMATS = [
  ["json", "Controller with sensors and motors (JSON)"], ["bytes", "Controller for a board (bytes)"], ["c", "Controller in C99"],
  ["c-integers", "Controller in C99, integers"], ["rust", "Controller in Rust"], ["safetensors", "Weights (safetensors)"],
  ["genotype", "Genes (.gen)"], ["starts", "Starts of trials (JSON)"], ["mjcf", "Robot and scene (MJCF)"], ["urdf", "Robot (URDF)"],
];
const PAGES = { replay: "Replay of recorded trials", report: "Report" };

export async function run(name, signal, isHere) {
  const [list, data] = await Promise.all([read("/api/list"), read("/api/run", { name })]);
  if (!isHere()) return;
  header(list);
  const page = new RunPage(name, list, data, signal);
  show(page.elements);
  page.follow();
}

class RunPage {
  constructor(name, list, data, signal) {
    Object.assign(this, { name, list, data, signal, readOnly: list.read_only });
    this.curve = new Curve();
    this.state = h("div", { class: "status", id: "status", role: "status" });
    this.meter = h("progress", { max: 1, "aria-label": "Finished generations" });
    this.problem = h("p", { class: "problem", role: "alert" });
    this.stop = this.button("Stop", "stop", () => this.send("/api/stop", { run: name }, "The run is saved and stops."));
    this.resume = this.button("Resume", "resume", () => this.send("/api/resume", { run: name }, "The run continues."));
    this.more = h("input", { id: "more", inputmode: "numeric", autocomplete: "off", size: 7, "aria-label": "Generations in all" });
    this.extend = this.button("Add generations", "extend", () => {
      const generations = Number(this.more.value);
      if (!Number.isInteger(generations) || generations <= this.facts.done) throw new Error(`give more than the ${this.facts.done} finished generations`);
      return this.send("/api/resume", { run: name, generations }, "The run continues.");
    });
    this.summary = h("dl", { class: "facts" });
    this.process = h("section", { "aria-label": "Command" });
    this.tests = h("section", { class: "card", "aria-labelledby": "tests" });
    this.pages = h("section", { class: "card", "aria-labelledby": "pages" });
    this.exports = h("section", { class: "card", "aria-labelledby": "exports" });
    this.champion = h("section", { "aria-labelledby": "champion", hidden: true }, h("div", { class: "head" }, h("h2", { id: "champion" }, "Champion"),
      h("span", { class: "soft" }, "The present champion with its network and channels. The button Follow decides if it follows the run.")));
    this.fill();
    this.draw(data.facts);
  }

  button(text, id, action) {
    const button = h("button", { id, onclick: async () => {
      const isHeld = document.activeElement === button;
      await act(button, action);
      // A disabled button loses the keyboard. A hidden one leaves it to the button in its place.
      const here = [button, this.stop, this.resume, this.extend].find((one) => !one.hidden && !one.disabled);
      if (isHeld && document.activeElement === document.body) here?.focus();
    } }, text);
    return button;
  }

  get elements() {
    const actions = this.readOnly ? null : h("div", { class: "bar actions" }, this.stop, this.resume, h("span", { class: "join" }, this.more, this.extend));
    return [
      h("div", { class: "head" }, h("h1", {}, this.name), this.state),
      this.problem,
      h("div", { class: "run" },
        h("div", {}, this.meter, this.curve.element, actions, this.process),
        h("div", { class: "side" }, this.tests, this.pages, this.exports, h("section", { class: "card" }, h("h2", {}, "Facts"), this.summary))),
      this.champion,
    ];
  }

  // Name of the experiment or of its file.
  get source() {
    const { experiment } = this.facts;
    return this.list.experiments.some((one) => one.name === experiment) ? experiment : `${experiment}.toml`;
  }

  async send(path, body, text) {
    await change(path, body);
    note(text);
    await this.reload();
  }

  async reload() {
    this.data = await read("/api/run", { name: this.name });
    this.fill();
    this.draw(this.data.facts);
    // An answer may be older than the last event, and the server sends no state that ended between two of its looks.
    clearTimeout(this.again);
    if (this.facts.state !== this.sent && !this.signal.aborted) this.again = setTimeout(() => this.reload().catch(() => {}), 1000);
  }

  // The trial of the present champion. It stays while its page receives new champions.
  showChampion() {
    this.isHeard = false;
    this.frame = framed(this.name, `/files/champion/${encodeURIComponent(this.name)}`, `Champion of ${this.name}`, this.readOnly, this.signal, (data) => {
      if (data?.farsa !== "follows") return;
      this.isHeard = true;
      this.tell("fitness", this.curve.rows.slice(-1));
      if (this.champions) this.tell("champions", this.champions);
    });
    this.frame.loading = "lazy";
    this.champion.append(this.frame);
    this.champion.hidden = false;
  }

  // Passes an event of the run to the page of the champion, which cannot connect to the server.
  tell(farsa, data) {
    if (this.isHeard) this.frame.contentWindow?.postMessage({ farsa, data }, "*");
  }

  // New generations, champions and states, as the files of the run grow.
  follow() {
    const open = () => {
      this.events = new EventSource(address("/events", { run: this.name, from: this.curve.rows.length }));
      this.events.addEventListener("fitness", (event) => {
        const rows = JSON.parse(event.data);
        this.curve.add(rows);
        // The small curve of the frame needs few points.
        this.tell("fitness", rows.slice(-1));
      });
      this.events.addEventListener("champions", (event) => {
        this.champions = JSON.parse(event.data);
        // The first champion is saved after the first generation.
        if (this.frame) this.tell("champions", this.champions);
        else this.showChampion();
      });
      this.events.addEventListener("state", (event) => {
        const facts = JSON.parse(event.data);
        const ended = this.facts.state !== facts.state;
        this.sent = facts.state;
        this.draw(facts);
        if (ended) this.reload().catch(() => {});
      });
      this.events.addEventListener("replaced", () => {
        this.events.close();
        this.curve.clear();
        this.frame?.remove();
        this.frame = this.champions = null;
        this.champion.hidden = true;
        open();
      });
    };
    open();
    this.signal.addEventListener("abort", () => this.events.close());
  }

  draw(facts) {
    this.facts = facts;
    const { done, generations, left } = facts;
    // A run that waits has no experiment yet.
    if (facts.experiment && !this.hasProtocols) {
      this.hasProtocols = true;
      this.protocols();
    }
    const isBusy = ["waiting", "running", "testing"].includes(facts.state);
    const rest = facts.state === "running" && left !== null && done < generations ? `, ${seconds(left)} left` : "";
    const text = facts.state === "waiting" ? "Other processes run. This one starts when there is room." : generations ? `${done} of ${generations} generations${rest}` : "";
    this.state.replaceChildren(state(facts.state), h("span", {}, text));
    this.meter.value = generations ? Math.min(1, done / generations) : 0;
    this.problem.textContent = facts.error || "";
    this.stop.hidden = !isBusy;
    this.stop.disabled = !facts.is_stoppable;
    this.stop.title = facts.is_stoppable ? "" : "Another program continues this run. Stop it there.";
    // A run that was refused has no files.
    const isLost = !facts.experiment;
    this.resume.hidden = isBusy || isLost || facts.state === "finished";
    for (const part of [this.more, this.extend]) part.hidden = isBusy || isLost;
    if (document.activeElement !== this.more) this.more.value = String(Math.max(generations, done) + Math.max(10, Math.round(Math.max(generations, 1) / 2)));
    for (const button of [this.trialButton, ...this.makers, this.exportButton]) button.disabled = !done;
    for (const button of [this.testButton, this.protocolButton]) button.disabled = !done || isBusy;
    this.trash.disabled = isBusy || isLost;
    const rows = [
      ["Experiment", facts.experiment && h("a", { href: `#/experiment/${encodeURIComponent(this.source)}` }, facts.experiment)], ["Condition", facts.condition], ["Strategy", facts.strategy], ["Seed", String(facts.seed)],
      ["Best fitness", number(facts.best)], ["Last generation", number(facts.last)], ["Success in test", success(facts.success)],
      ["Started", date(facts.started)], ["Size", bytes(facts.bytes)], ["Folder", `runs/${facts.name}`],
    ].filter(([, value]) => value);
    this.summary.replaceChildren(...rows.flatMap(([key, value]) => [h("dt", {}, key), h("dd", {}, value)]));
  }

  // Parts that change when a process ends.
  fill() {
    const { data } = this;
    const last = (data.printed || "").trim();
    this.process.replaceChildren(...[
      data.command ? h("h2", {}, "Command of the last process") : null,
      data.command ? command(data.command) : null,
      last ? h("details", {}, h("summary", {}, "What it printed"), h("pre", {}, last)) : null,
    ].filter(Boolean));
    this.fillTests();
    this.fillPages();
    this.fillExports();
  }

  fillTests() {
    const { test } = this.data;
    const results = test?.results;
    const rows = results ? [
      ["Trials", `${results.trials}, seed ${test.seed}`],
      results.successes === null ? null : ["Success", `${results.successes} of ${results.trials}: ${percent(results.rate)} (95% interval ${percent(results.interval[0])} to ${percent(results.interval[1])})`],
      ["Mean fitness", `${number(results.fitness)}${results.fitness_interval?.[0] == null ? "" : ` (95% interval ${number(results.fitness_interval[0])} to ${number(results.fitness_interval[1])})`}`],
    ].filter(Boolean) : [];
    this.trials ||= h("input", { id: "trials", value: "100", inputmode: "numeric", autocomplete: "off" });
    this.testSeed ||= h("input", { id: "test-seed", value: "1", inputmode: "numeric", autocomplete: "off" });
    this.testButton ||= this.button("Test", "test", () => this.test(null));
    this.protocol ||= h("select", { id: "protocol" });
    this.protocolButton ||= this.button("Test by protocol", "test-protocol", () => this.test(this.protocol.value));
    this.protocolPart ||= h("div", { class: "bar", hidden: true }, field("Protocol", this.protocol), this.protocolButton);
    this.tests.replaceChildren(...[
      h("h2", { id: "tests" }, "Test"),
      rows.length ? h("dl", { class: "facts", id: "results" }, rows.map(([key, value]) => [h("dt", {}, key), h("dd", {}, value)])) : h("p", { class: "soft" }, "The champion was not tested on new starts yet."),
      this.readOnly ? null : h("div", { class: "bar" }, field("Trials", this.trials), field("Seed", this.testSeed), this.testButton),
      this.readOnly ? null : this.protocolPart,
      this.data.protocols.length ? h("p", { class: "soft" }, `Tested by ${this.data.protocols.join(", ")}: see the report.`) : null,
    ].filter(Boolean));
  }

  test(protocol) {
    const body = { run: this.name, trials: protocol ? null : Number(this.trials.value), seed: Number(this.testSeed.value), protocol };
    if (![body.trials ?? 1, body.seed].every((x) => Number.isInteger(x) && x >= 0)) throw new Error("trials and seed are whole numbers");
    return this.send("/api/test", body, "The test has started.");
  }

  // Protocols of the experiment, where it is still in the folder.
  async protocols() {
    const { experiment, condition } = this.facts;
    if (!experiment || this.readOnly) return;
    const info = await read("/api/info", { experiment: this.source, condition }).catch(() => null);
    if (!info?.protocols.length) return;
    this.protocol.replaceChildren(...info.protocols.map((one) => h("option", { value: one.name }, `${one.name}: ${one.summary}`)));
    this.protocolPart.hidden = false;
  }

  fillPages() {
    this.makers ||= Object.entries(PAGES).map(([kind, text]) => {
      const button = h("button", { id: `make-${kind}`, onclick: () => this.make(kind, button) }, text);
      return button;
    });
    this.generation ||= h("input", { id: "generation", inputmode: "numeric", autocomplete: "off", placeholder: "the champion's", size: 9 });
    this.individual ||= h("input", { id: "individual", inputmode: "numeric", autocomplete: "off", placeholder: "the best", size: 6 });
    this.trialButton ||= this.button("Open the trial", "make-live", () => this.openTrial());
    this.pages.replaceChildren(...[
      h("h2", { id: "pages" }, "Trials and pages"),
      this.readOnly ? null : h("div", { class: "bar" }, field("Generation", this.generation), field("Individual", this.individual), this.trialButton),
      this.readOnly ? null : h("div", { class: "stack" }, this.makers),
      this.data.pages.length ? h("ul", { class: "files" }, this.data.pages.map((file) =>
        h("li", {}, file === `live-${this.name}.html` ? h("a", { href: `#/trial/${encodeURIComponent(this.name)}` }, file)
          : h("a", { href: `/files/pages/${encodeURIComponent(file)}`, target: "_blank", rel: "noopener" }, file)))) : null,
    ].filter(Boolean));
  }

  // A page with the agent itself: another generation or individual, other settings, lesions, evolution.
  async openTrial() {
    const whole = (input, what) => {
      const given = input.value.trim();
      if (given && !/^\d{1,9}$/.test(given)) throw new Error(`${what} is a whole number from 0`);
      return given ? Number(given) : null;
    };
    const [generation, individual] = [whole(this.generation, "the generation"), whole(this.individual, "the individual")];
    const { command: line } = await change("/api/page", { kind: "live", runs: [this.name], generations: generation === null ? [] : [generation], individual });
    note(line);
    location.hash = `#/trial/${encodeURIComponent(this.name)}`;
  }

  make(kind, button) {
    // A window that opens after an answer would be blocked.
    const page = window.open("about:blank", "_blank");
    if (page) page.opener = null;
    return act(button, async () => {
      try {
        const { file, command: line } = await change("/api/page", { kind, runs: [this.name] });
        note(line);
        if (page) page.location = `/files/${file.split("/").map(encodeURIComponent).join("/")}`;
        await this.reload();
      } catch (error) {
        page?.close();
        throw error;
      }
    });
  }

  fillExports() {
    this.format ||= h("select", { id: "format" }, FORMATS.map(([value, text]) => h("option", { value }, text)));
    this.exportButton ||= this.button("Export", "export", async () => {
      const { command: line } = await change("/api/export", { run: this.name, format: this.format.value });
      note(line);
      await this.reload();
    });
    this.trash ||= this.button("Move to the trash", "trash", async () => {
      if (!(await confirmed(`Move the run ${this.name} to the folder .trash? You can move it back at any time.`, "Move to the trash"))) return;
      const { moved } = await change("/api/trash", { run: this.name });
      note(`${this.name} is now ${moved}.`);
      location.hash = "#/";
    });
    this.exports.replaceChildren(...[
      h("h2", { id: "exports" }, "Export"),
      this.readOnly ? null : h("div", { class: "bar" }, field("Format", this.format), this.exportButton),
      this.data.exports.length ? h("ul", { class: "files" }, this.data.exports.map((file) =>
        h("li", {}, h("a", { href: `/files/exports/${encodeURIComponent(file)}`, download: file }, file)))) : null,
      this.readOnly ? null : h("div", { class: "bar" }, this.trash),
    ].filter(Boolean));
  }
}
