// The form of all settings of an experiment, from the table of `farsa info --json`.

import { h } from "./parts.js";

const SOURCES = { given: "stated by the source", derived: "derived from the source", chosen: "chosen here" };

// Text of a value as `--set` reads it.
function text(setting, value) {
  if (setting.kind === "numbers") return `[${value.join(", ")}]`;
  return String(value);
}

// Argument of `--set`: words and texts in quotes.
function argument(setting, given) {
  if (setting.kind === "word" || setting.kind === "text") return JSON.stringify(given);
  if (setting.kind === "numbers") return given.startsWith("[") ? given : `[${given}]`;
  return given;
}

// The fault of a value, or an empty text.
function fault(setting, given) {
  const range = setting.range;
  const outside = (x) => range && (x < (range[0] ?? -Infinity) || x > (range[1] ?? Infinity));
  if (setting.kind === "whole" && !/^[+-]?\d+$/.test(given)) return "not a whole number";
  if (setting.kind === "number" && (given === "" || !Number.isFinite(Number(given)))) return "not a number";
  if ((setting.kind === "whole" || setting.kind === "number") && outside(Number(given))) return `outside ${setting.allowed}`;
  if (setting.kind === "numbers") {
    const list = given.replace(/^\[|\]$/g, "").split(",").map((part) => part.trim());
    if (list.length !== setting.default.length) return `${list.length} numbers instead of ${setting.default.length}`;
    if (list.some((part) => part === "" || !Number.isFinite(Number(part)))) return "not a list of numbers";
    if (list.some((part) => outside(Number(part)))) return `outside ${setting.allowed}`;
  }
  return "";
}

class Row {
  constructor(setting, changed) {
    this.setting = setting;
    this.default = text(setting, setting.default);
    const [, ...names] = setting.key.split(".");
    const id = `set-${setting.key}`;
    const properties = { id, "aria-describedby": `${id}-help`, oninput: () => (this.check(), changed()) };
    if (setting.kind === "flag" || setting.kind === "word") {
      const choices = setting.kind === "flag" ? ["true", "false"] : setting.choices;
      this.input = h("select", properties, choices.map((choice) => h("option", { value: choice }, choice)));
    } else {
      const mode = setting.kind === "whole" ? "numeric" : setting.kind === "number" ? "decimal" : undefined;
      this.input = h("input", { ...properties, autocomplete: "off", spellcheck: "false", inputmode: mode });
    }
    this.input.value = this.default;
    this.problem = h("span", { class: "problem", role: "alert" });
    this.reset = h("button", { type: "button", class: "plain", hidden: true, "aria-label": `Reset ${setting.key}`, onclick: () => {
      this.input.value = this.default;
      this.check();
      changed();
      this.input.focus();
    } }, "Reset");
    const range = setting.kind === "flag" || setting.kind === "word" || setting.kind === "text" ? "" : `range ${setting.allowed}`;
    const facts = [range, SOURCES[setting.source] || setting.source].filter(Boolean).join(" · ");
    this.element = h("div", { class: "setting", "data-key": setting.key },
      h("label", { for: id }, names.join(".") || setting.key),
      h("span", { class: "entry" }, this.input, setting.unit ? h("span", { class: "unit soft" }, setting.unit) : null, this.reset),
      h("p", { id: `${id}-help`, class: "help" }, setting.doc, h("small", {}, facts), this.problem));
  }

  get given() {
    return this.input.value.trim();
  }

  get isChanged() {
    return this.given !== this.default;
  }

  check() {
    const why = this.isChanged ? fault(this.setting, this.given) : "";
    this.problem.textContent = why && ` ${why}`;
    this.input.setAttribute("aria-invalid", String(Boolean(why)));
    this.reset.hidden = !this.isChanged;
    this.element.classList.toggle("changed", this.isChanged);
    return !why;
  }
}

// Settings in groups by the first part of their keys, with a search.
export class SettingsForm {
  // `skipped` has the keys of fields above the form.
  constructor(settings, skipped, changed = () => {}) {
    this.rows = settings.filter((setting) => !skipped.includes(setting.key)).map((setting) => new Row(setting, () => (this.count(), changed())));
    const groups = new Map();
    for (const row of this.rows) {
      const group = row.setting.key.split(".")[0];
      groups.set(group, [...(groups.get(group) || []), row]);
    }
    this.groups = [...groups].map(([name, rows]) => {
      const badge = h("span", { class: "badge", hidden: true });
      const element = h("details", { class: "group" }, h("summary", {}, h("b", {}, name), h("span", { class: "soft" }, ` ${rows.length}`), badge), rows.map((row) => row.element));
      return { rows, element, badge };
    });
    this.search = h("input", { type: "search", "aria-label": "Search settings", placeholder: "Search settings and their meaning", oninput: () => this.find() });
    this.total = h("span", { class: "soft", "aria-live": "polite" });
    this.element = h("section", { "aria-labelledby": "settings" },
      h("div", { class: "head" }, h("h2", { id: "settings" }, "Settings"), this.search, this.total),
      this.groups.map((group) => group.element));
    this.count();
  }

  find() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const { rows, element } of this.groups) {
      let found = 0;
      for (const row of rows) {
        const { key, doc } = row.setting;
        const fits = words.every((word) => key.toLowerCase().includes(word) || doc.toLowerCase().includes(word));
        row.element.hidden = !fits;
        found += fits;
      }
      element.hidden = !found;
      element.open = words.length > 0 ? found > 0 : rows.some((row) => row.isChanged);
    }
  }

  count() {
    let sum = 0;
    for (const { rows, badge } of this.groups) {
      const changed = rows.filter((row) => row.isChanged).length;
      badge.hidden = !changed;
      badge.textContent = `${changed} changed`;
      sum += changed;
    }
    this.total.textContent = `${this.rows.length} in all, ${sum ? `${sum} changed` : "all at their defaults"}`;
  }

  // Takes the values that were changed in another form, where this one has their keys.
  take(values) {
    for (const row of this.rows) {
      if (!values.has(row.setting.key)) continue;
      row.input.value = values.get(row.setting.key);
      row.check();
    }
    this.find();
    this.count();
  }

  values() {
    return new Map(this.rows.filter((row) => row.isChanged).map((row) => [row.setting.key, row.given]));
  }

  // Pairs for the request, or null with the focus at the first fault.
  checked() {
    const wrong = this.rows.find((row) => !row.check());
    if (wrong) {
      wrong.element.closest("details").open = true;
      wrong.input.focus();
      return null;
    }
    return this.rows.filter((row) => row.isChanged).map((row) => [row.setting.key, argument(row.setting, row.given)]);
  }
}
