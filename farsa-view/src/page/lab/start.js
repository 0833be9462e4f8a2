// The first place: experiments, pages of the gallery and runs of the folder.

import { small } from "./curve.js";
import { act, bytes, change, confirmed, date, field, h, note, number, read, seconds, show, state, success } from "./parts.js";

// Choices that outlast a visit of another place.
const view = { text: "", key: "started", down: true, chosen: new Set(), experiments: { text: "", order: "name" } };

// Orders of the experiments. Built-in ones have no date.
const ORDERS = {
  name: ["name", (a, b) => compared(a.name, b.name)],
  last: ["name, from the end", (a, b) => compared(b.name, a.name)],
  newest: ["date, newest first", (a, b) => compared(b.modified, a.modified)],
  oldest: ["date, oldest first", (a, b) => compared(a.modified, b.modified)],
};

const COLUMNS = [
  ["name", "Run", (run) => run.name],
  ["state", "State", (run) => run.state],
  ["done", "Generations", (run) => run.done],
  ["curve", "Best fitness over generations", null],
  ["best", "Best", (run) => run.best],
  ["success", "Success in test (95% interval)", (run) => (run.success ? run.success.successes / run.success.of : null)],
  ["bytes", "Size", (run) => run.bytes],
  ["started", "Started", (run) => run.started],
];

function compared(a, b) {
  if (a === null || a === undefined) return b === null || b === undefined ? 0 : -1;
  if (b === null || b === undefined) return 1;
  return typeof a === "string" ? a.localeCompare(b, undefined, { numeric: true }) : a - b;
}

const wordsOf = (text) => text.toLowerCase().split(/\s+/).filter(Boolean);
const link = (kind, name) => `#/${kind}/${encodeURIComponent(name)}`;

export async function start(_, signal, isHere) {
  const list = await read("/api/list");
  if (!isHere()) return;
  header(list);
  const runs = new Runs(list);
  const lead = "Open an experiment, change its settings and press Run. Watch the fitness grow, test the champion on new starts, and compare runs. Everything is kept as files in this folder.";
  show(h("h1", { class: "hidden" }, "Laboratory"), list.runs.length ? null : h("p", { class: "lead first" }, lead), new Experiments(list).element, runs.element);
  // Running processes change the list.
  const timer = setInterval(async () => {
    if (document.hidden) return;
    const next = await read("/api/list").catch(() => null);
    if (next && isHere()) runs.update(next);
  }, 2000);
  signal.addEventListener("abort", () => clearInterval(timer));
}

export function header(list) {
  document.getElementById("folder").textContent = list.folder || "";
  document.getElementById("mode").hidden = !list.read_only;
}

// Experiments by their kind, searched and sorted together.
class Experiments {
  constructor(list) {
    const own = list.files.length > 0;
    this.groups = [
      this.group(list.files, "file", null),
      this.group(list.experiments, "built in", (count) => `${count} built-in experiments`, !own && !list.runs.length),
      this.group(list.gallery, "gallery", (count) => `${count} ${count === 1 ? "page" : "pages"} of the gallery`),
    ];
    this.search = h("input", { type: "search", id: "search-experiments", "aria-label": "Search experiments", placeholder: "Search name, summary, condition, kind", value: view.experiments.text,
      oninput: () => {
        view.experiments.text = this.search.value;
        this.draw();
      } });
    this.order = h("select", { id: "order-experiments", "aria-label": "Sort experiments by", onchange: () => {
      view.experiments.order = this.order.value;
      this.draw();
    } }, Object.entries(ORDERS).map(([key, [label]]) => h("option", { value: key }, `Sort by ${label}`)));
    this.order.value = view.experiments.order;
    this.count = h("span", { class: "soft", "aria-live": "polite" });
    this.hint = h("p", { class: "hint" }, "This folder has no experiment file yet. Begin with a template: a short text that describes a robot, its world and its task.");
    this.none = h("p", { class: "hint" }, "No experiment has these words.");
    this.hasFiles = own;
    this.element = h("section", { "aria-labelledby": "experiments" },
      h("div", { class: "head" }, h("h2", { id: "experiments" }, "Experiments"), this.search, this.order, list.read_only ? null : creation(list), this.count),
      this.hint, this.none, this.groups.map((group) => group.element));
    this.draw();
  }

  // Experiments of a kind. Those with a title can be folded.
  group(entries, kind, title, open = false) {
    const tiles = entries.map((entry) => {
      const { name, summary = "", conditions = [], modified } = entry;
      return { name, modified, text: [name, summary, kind, ...conditions].join(" ").toLowerCase(), element: tile(entry, kind) };
    });
    const list = h("ul", { class: "tiles" });
    const element = title ? h("details", { class: "more", open, "data-kind": kind }, h("summary", {}, title(tiles.length)), list) : list;
    return { tiles, list, element, isFolded: title && !open };
  }

  draw() {
    const words = wordsOf(view.experiments.text);
    const by = ORDERS[view.experiments.order][1];
    let [shown, all] = [0, 0];
    for (const group of this.groups) {
      const tiles = group.tiles.filter(({ text }) => words.every((word) => text.includes(word)));
      tiles.sort((a, b) => by(a, b) || compared(a.name, b.name));
      group.list.replaceChildren(...tiles.map(({ element }) => element));
      group.element.hidden = !tiles.length;
      // A search opens what was folded, and its end folds it again.
      if (group.element.open !== undefined && this.isSearch !== words.length > 0) {
        if (words.length) group.isFolded = !group.element.open;
        group.element.open = words.length > 0 || !group.isFolded;
      }
      shown += tiles.length;
      all += group.tiles.length;
    }
    this.isSearch = words.length > 0;
    this.hint.hidden = this.hasFiles || this.isSearch;
    this.none.hidden = shown > 0;
    this.count.textContent = this.isSearch ? `${shown} of ${all}` : "";
  }
}

function tile({ name, summary, broken, conditions }, kind) {
  const isPage = kind === "gallery";
  const place = isPage ? { href: `/files/gallery/${encodeURIComponent(name)}`, target: "_blank", rel: "noopener" } : { href: link("experiment", name) };
  return h("li", {}, h("a", { class: "tile", ...place },
    h("b", {}, isPage ? name.replace(/\.html$/, "") : name), h("span", { class: broken ? "problem" : "soft" }, broken ? "The text has an error." : isPage ? "A page of the folder gallery." : summary),
    conditions?.length ? h("small", { class: "soft" }, `Conditions: ${conditions.join(", ")}`) : null, h("i", { class: "kind" }, kind)));
}

function creation(list) {
  if (!list.templates.length) return null;
  const name = h("input", { id: "new-name", required: true, autocomplete: "off", spellcheck: "false", placeholder: "follow" });
  const template = h("select", { id: "new-template" }, list.templates.map((one) => h("option", { value: one.name }, `${one.name}: ${one.summary}`)));
  const button = h("button", { class: "main" }, "Create");
  const form = h("form", { class: "card", hidden: true, onsubmit: (event) => {
    event.preventDefault();
    act(button, async () => {
      const made = await change("/api/new", { name: name.value.trim(), template: template.value });
      note(`${made.name} was created.`);
      location.hash = link("experiment", made.name);
    });
  } }, field("Name of the new file", name), wide(field("Template", template)), h("div", { class: "bar" }, button));
  const toggle = h("button", { class: "main", id: "new", "aria-expanded": "false", onclick: () => {
    form.hidden = !form.hidden;
    toggle.setAttribute("aria-expanded", String(!form.hidden));
    if (!form.hidden) name.focus();
  } }, "New from a template");
  return [toggle, form];
}

function wide(element) {
  element.classList.add("wide");
  return element;
}

class Runs {
  constructor(list) {
    this.list = list;
    this.rows = new Map();
    this.search = h("input", { type: "search", "aria-label": "Search runs", placeholder: "Search name, experiment, condition, state", value: view.text,
      oninput: () => {
        view.text = this.search.value;
        this.draw();
      } });
    this.compare = h("button", { class: "main", id: "compare", onclick: () => this.open() }, "Compare");
    this.count = h("span", { class: "soft", "aria-live": "polite" });
    this.heads = new Map(COLUMNS.map(([key, label, of]) => [key, h("th", { scope: "col" }, of
      ? h("button", { class: "plain", onclick: () => this.sort(key) }, label) : label)]));
    this.all = h("input", { type: "checkbox", "aria-label": "Select all shown runs", onchange: () => {
      for (const run of this.shown) this.all.checked ? view.chosen.add(run.name) : view.chosen.delete(run.name);
      this.draw();
    } });
    // A narrow screen has no heads of columns.
    this.order = h("select", { class: "order", "aria-label": "Sort runs by", onchange: () => this.sort(this.order.value) },
      COLUMNS.filter(([, , of]) => of).map(([key, label]) => h("option", { value: key }, `Sort by ${label.toLowerCase()}`)));
    this.body = h("tbody");
    this.table = h("table", { class: "runs" }, h("thead", {}, h("tr", {}, h("th", {}, this.all), [...this.heads.values()], h("th", {}, h("span", { class: "hidden" }, "Remove")))), this.body);
    this.empty = h("p", { class: "hint" }, "No runs yet. Open an experiment and press Run.");
    this.element = h("section", { "aria-labelledby": "runs" },
      h("div", { class: "head" }, h("h2", { id: "runs" }, "Runs"), this.search, this.order, this.compare, this.count),
      this.empty, h("div", { class: "scroll" }, this.table));
    this.draw();
  }

  update(list) {
    this.list = list;
    this.draw();
  }

  sort(key) {
    view.down = view.key === key ? !view.down : key !== "name";
    view.key = key;
    this.draw();
  }

  draw() {
    this.order.value = view.key;
    const words = wordsOf(view.text);
    const text = (run) => [run.name, run.experiment, run.condition, run.strategy, run.state].join(" ").toLowerCase();
    const of = COLUMNS.find(([key]) => key === view.key)[2];
    this.shown = this.list.runs.filter((run) => words.every((word) => text(run).includes(word)));
    this.shown.sort((a, b) => (view.down ? -1 : 1) * compared(of(a), of(b)) || compared(a.name, b.name));
    const names = new Set(this.list.runs.map((run) => run.name));
    for (const name of view.chosen) if (!names.has(name)) view.chosen.delete(name);
    for (const [key, head] of this.heads) head.setAttribute("aria-sort", key === view.key ? (view.down ? "descending" : "ascending") : "none");
    // Rows of unchanged runs stay, and with them the focus.
    const rows = this.shown.map((run) => this.row(run));
    if (rows.length !== this.body.children.length || rows.some((row, at) => row !== this.body.children[at])) {
      const focused = document.activeElement;
      this.body.replaceChildren(...rows);
      if (this.body.contains(focused)) focused.focus();
    }
    this.all.checked = this.shown.length > 0 && this.shown.every((run) => view.chosen.has(run.name));
    const chosen = view.chosen.size;
    this.compare.disabled = !chosen || this.list.read_only;
    this.compare.textContent = chosen > 1 ? `Compare ${chosen} runs` : chosen ? "Report of 1 run" : "Compare";
    this.count.textContent = this.shown.length === this.list.runs.length ? `${this.list.runs.length} in all` : `${this.shown.length} of ${this.list.runs.length}`;
    this.empty.hidden = this.list.runs.length > 0;
    this.table.hidden = !this.list.runs.length;
  }

  row(run) {
    const known = this.rows.get(run.name);
    const mark = JSON.stringify(run);
    if (known?.mark === mark) {
      known.box.checked = view.chosen.has(run.name);
      return known.row;
    }
    const box = h("input", { type: "checkbox", "aria-label": `Select ${run.name}`, checked: view.chosen.has(run.name), onchange: () => {
      box.checked ? view.chosen.add(run.name) : view.chosen.delete(run.name);
      this.draw();
    } });
    const cell = (label, ...content) => h("td", { "data-label": label }, ...content);
    const about = [run.condition, run.strategy].filter(Boolean).join(", ");
    const left = run.left !== null && run.state === "running" ? h("small", { class: "soft" }, `${seconds(run.left)} left`) : null;
    const bin = this.list.read_only || ["running", "testing", "waiting"].includes(run.state) ? null
      : h("button", { class: "plain", "aria-label": `Move ${run.name} to the trash`, title: "Move to the trash", onclick: () => this.discard(run.name) }, "×");
    const row = h("tr", { "data-run": run.name },
      h("td", { class: "pick" }, box),
      h("th", { scope: "row" }, h("a", { href: link("run", run.name) }, run.name), about ? h("small", { class: "soft" }, about) : null),
      cell("State", state(run.state), left),
      cell("Generations", run.generations ? `${run.done} of ${run.generations}` : "–"),
      cell("", small(run.curve)),
      cell("Best", number(run.best)),
      cell("Success", success(run.success)),
      cell("Size", bytes(run.bytes)),
      cell("Started", date(run.started)),
      h("td", { class: "bin" }, bin));
    if (known) known.row.replaceWith(row);
    this.rows.set(run.name, { row, box, mark });
    return row;
  }

  async discard(run) {
    if (!(await confirmed(`Move the run ${run} to the folder .trash? You can move it back at any time.`, "Move to the trash"))) return;
    await act(null, async () => {
      const { moved } = await change("/api/trash", { run });
      note(`${run} is now ${moved}.`);
      this.update(await read("/api/list"));
    });
  }

  open() {
    const runs = this.list.runs.map((run) => run.name).filter((name) => view.chosen.has(name));
    // A window that opens after an answer would be blocked.
    const page = window.open("about:blank", "_blank");
    if (page) page.opener = null;
    act(this.compare, async () => {
      try {
        const { file, command } = await change("/api/page", { kind: "report", runs });
        note(command);
        if (page) page.location = `/files/${file}`;
        else location.href = `/files/${file}`;
      } catch (error) {
        page?.close();
        throw error;
      }
    });
  }
}
