// An experiment: what runs, its settings, and for a file also its text.

import { Editor } from "./editor.js";
import { act, address, change, command, confirmed, field, h, note, read, show } from "./parts.js";
import { SettingsForm } from "./settings.js";
import { header } from "./start.js";

// Settings that have their own fields.
const OWN = ["evolution.generations", "strategy.name"];
// Changed values of forms and unsaved texts, which outlast a visit of another place.
const kept = new Map();
const drafts = new Map();

// Seeds such as `1`, `1-10` or `3, 17, 99`.
export function seeds(text) {
  const found = [];
  for (const part of text.split(/[\s,]+/).filter(Boolean)) {
    const range = /^(\d+)(?:-(\d+))?$/.exec(part);
    if (!range) return null;
    const [from, to] = [Number(range[1]), Number(range[2] ?? range[1])];
    if (to < from || to - from >= 1000) return null;
    for (let seed = from; seed <= to; seed++) found.push(seed);
  }
  return found.length ? [...new Set(found)] : null;
}

const channels = (groups) => groups.map((group) => `${group.name} (${group.count})`).join(", ") || "none";

function facts(info) {
  const time = info.step_seconds > 0 ? ` (${Number((info.steps * info.step_seconds).toPrecision(4))} s)` : "";
  const rows = [
    ["Sensors", `${info.inputs}: ${channels(info.sensors)}`],
    ["Motors", `${info.outputs}: ${channels(info.motors)}`],
    ["Network", `${info.network}; ${info.parameters} parameters`],
    ["Trials", `${info.trials}, each of at most ${info.steps} steps${time}`],
    ["Fitness", info.fitness_terms.join(", ")],
    ["Protocols", info.protocols.map((one) => one.name).join(", ") || "none"],
  ];
  return h("dl", { class: "facts" }, rows.map(([name, text]) => [h("dt", {}, name), h("dd", {}, text)]));
}

class Form {
  constructor(name, list, strategies, generations) {
    Object.assign(this, { name, list });
    const wide = kept.get(name) || { condition: "", strategy: "", values: new Map() };
    this.kept = wide;
    kept.set(name, wide);
    const again = () => this.load();
    this.condition = h("select", { id: "condition", onchange: () => { wide.condition = this.condition.value; again(); } });
    this.strategy = h("select", { id: "strategy", onchange: () => { wide.strategy = this.strategy.value; again(); } },
      h("option", { value: "" }, "the experiment's"), strategies.map((one) => h("option", { value: one.name, title: one.summary }, one.name)));
    this.strategy.value = wide.strategy;
    this.generations = h("input", { id: "generations", inputmode: "numeric", autocomplete: "off", placeholder: generations });
    this.seeds = h("input", { id: "seeds", value: "1", autocomplete: "off", spellcheck: "false" });
    this.threads = h("input", { id: "threads", inputmode: "numeric", autocomplete: "off", placeholder: "all processors" });
    this.run = h("button", { class: "main", id: "run" }, "Run");
    this.problem = h("p", { class: "problem", role: "alert" });
    this.conditionField = field("Condition", this.condition);
    this.form = h("form", { class: "card launch", onsubmit: (event) => { event.preventDefault(); this.start(); } },
      this.conditionField, field("Strategy", this.strategy), field("Generations", this.generations),
      field("Seeds", this.seeds, "1, 1-10 or 3, 17"), field("Threads of each run", this.threads),
      h("div", { class: "bar" }, this.run), this.problem);
    this.form.hidden = list.read_only;
    this.place = h("div");
    this.about = h("div");
    this.commandPlace = h("div");
  }

  // Reads the description for the condition and strategy, whose defaults differ.
  async load() {
    const { condition, strategy } = this.kept;
    if (this.settings) this.kept.values = this.settings.values();
    this.problem.textContent = "";
    let info;
    try {
      info = await read("/api/info", { experiment: this.name, condition, strategy });
    } catch (error) {
      this.run.disabled = true;
      this.settings = null;
      this.about.replaceChildren(h("p", { class: "problem" }, error.message));
      this.place.replaceChildren();
      this.conditionField.hidden = true;
      return;
    }
    this.run.disabled = false;
    this.info = info;
    this.conditionField.hidden = !info.conditions.length;
    this.condition.replaceChildren(...info.conditions.map((one) => h("option", { value: one }, one)));
    this.condition.value = info.condition;
    const generations = info.settings.find((setting) => setting.key === OWN[0]);
    this.generations.placeholder = generations ? String(generations.default) : "";
    this.settings = new SettingsForm(info.settings, OWN, () => { this.kept.values = this.settings.values(); });
    this.settings.take(this.kept.values);
    this.place.replaceChildren(this.settings.element);
    const graph = h("img", { alt: `Connections of ${this.name}`, src: address("/api/graph", { experiment: this.name, condition: info.condition, t: Date.now() }),
      loading: "lazy", onerror: () => graph.replaceWith(h("p", { class: "soft" }, "This experiment has no graph.")) });
    this.about.replaceChildren(facts(info), h("details", { class: "graph" }, h("summary", {}, "Graph of connections"), h("div", { class: "scroll" }, graph)));
  }

  request() {
    const list = seeds(this.seeds.value);
    const whole = (input, least) => {
      const given = input.value.trim();
      if (!given) return null;
      if (!/^\d+$/.test(given) || Number(given) < least) throw new Error(`${input.id} is not a whole number from ${least}`);
      return Number(given);
    };
    // The process reads the file.
    if (this.editor?.isChanged) throw new Error("save or revert the text first");
    if (!list) throw new Error("seeds are whole numbers, such as 1, 1-10 or 3, 17");
    const settings = this.settings?.checked();
    if (!settings) throw new Error("correct the marked setting first");
    const { condition } = this.info;
    return { experiment: this.name, condition: condition || null, strategy: this.kept.strategy || null, seeds: list,
      generations: whole(this.generations, 1), threads: whole(this.threads, 1), settings };
  }

  start() {
    let request;
    try {
      request = this.request();
    } catch (error) {
      this.problem.textContent = error.message;
      return;
    }
    this.problem.textContent = "";
    act(this.run, async () => {
      const { runs, commands } = await change("/api/run", request);
      if (runs.length === 1) {
        location.hash = `#/run/${encodeURIComponent(runs[0])}`;
        return;
      }
      note(`${runs.length} runs were started or wait.`);
      this.commandPlace.replaceChildren(h("h3", {}, "These commands repeat the runs"), ...commands.map(command));
    });
  }
}

export async function experiment(name, signal, isHere) {
  const isFile = name.endsWith(".toml");
  const [list, strategies, file] = await Promise.all([read("/api/list"), read("/api/strategies"), isFile ? read("/api/file", { name }) : null]);
  if (!isHere()) return;
  header(list);
  const form = new Form(name, list, strategies);
  const editor = file && new Editor(name, file.text, list.read_only, () => form.load());
  form.editor = editor;
  if (editor && drafts.has(name)) editor.draft(drafts.get(name));
  const known = list.experiments.find((one) => one.name === name) || list.files.find((one) => one.name === name);
  const bin = file && !list.read_only ? h("button", { onclick: () => discard(name) }, "Move to the trash") : null;
  show(
    h("h1", {}, name),
    known?.summary ? h("p", { class: "lead" }, known.summary) : null,
    form.form, form.commandPlace,
    h("div", { class: editor ? "columns" : "" }, editor?.element, h("section", { "aria-label": "Description" }, h("h2", {}, "Description"), form.about)),
    form.place, bin && h("div", { class: "bar" }, bin));
  // Leaving with unsaved text asks first.
  const warn = (event) => { if (editor?.isChanged) event.preventDefault(); };
  addEventListener("beforeunload", warn);
  signal.addEventListener("abort", () => {
    removeEventListener("beforeunload", warn);
    if (editor?.isChanged) drafts.set(name, editor.area.value);
    else drafts.delete(name);
  });
  await form.load();
}

async function discard(name) {
  if (!(await confirmed(`Move ${name} to the folder .trash? You can move it back at any time.`, "Move to the trash"))) return;
  await act(null, async () => {
    const { moved } = await change("/api/trash", { file: name });
    note(`${name} is now ${moved}.`);
    location.hash = "#/";
  });
}
