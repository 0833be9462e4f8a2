// Text of an experiment file, checked while it is typed.

import { act, change, h, note, read } from "./parts.js";

const PAUSE = 400;

export class Editor {
  // `saved` is called after each save.
  constructor(name, text, readOnly, saved) {
    Object.assign(this, { name, before: text, saved });
    this.area = h("textarea", { id: "text", spellcheck: "false", autocapitalize: "off", autocomplete: "off", wrap: "off", readonly: readOnly,
      "aria-label": `Text of ${name}`, "aria-describedby": "text-state", rows: String(Math.min(40, text.split("\n").length + 2)), value: text,
      oninput: () => this.typed(), onkeydown: (event) => this.key(event) });
    this.numbers = h("pre", { class: "numbers", "aria-hidden": "true" });
    this.area.addEventListener("scroll", () => { this.numbers.scrollTop = this.area.scrollTop; });
    this.state = h("p", { id: "text-state", role: "status", class: "soft" }, "Checking …");
    this.errors = h("ul", { class: "errors" });
    this.save = h("button", { class: "main", disabled: true, onclick: () => this.store() }, "Save");
    this.revert = h("button", { disabled: true, onclick: () => this.reload() }, "Revert");
    this.element = h("section", { "aria-labelledby": "text-title" },
      h("div", { class: "head" }, h("h2", { id: "text-title" }, "Text"), readOnly ? null : [this.save, this.revert], this.state),
      h("div", { class: "editor" }, this.numbers, this.area), this.errors,
      h("p", { class: "soft" }, "Ctrl+S saves. Tab leaves the text, as in every field."));
    this.number();
    this.check();
  }

  get isChanged() {
    return this.area.value !== this.before;
  }

  // Continues with a text that was not saved.
  draft(text) {
    this.area.value = text;
    this.typed();
  }

  number() {
    const count = this.area.value.split("\n").length;
    const lines = Array.from({ length: count }, (_, at) => h("span", { class: this.wrong?.has(at + 1) ? "wrong" : undefined }, `${at + 1}\n`));
    this.numbers.replaceChildren(...lines);
    this.numbers.scrollTop = this.area.scrollTop;
  }

  typed() {
    this.number();
    this.save.disabled = this.revert.disabled = !this.isChanged;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.check(), PAUSE);
  }

  key(event) {
    if ((event.ctrlKey || event.metaKey) && event.key === "s") {
      event.preventDefault();
      if (this.isChanged && !this.area.readOnly) this.store();
    }
  }

  async check() {
    const text = this.area.value;
    let faults = [];
    try {
      await change("/api/check", { name: this.name, text });
    } catch (error) {
      faults = error.message.split("\n").filter(Boolean);
    }
    // A later text is checked on its own.
    if (text !== this.area.value) return;
    this.faults = faults;
    this.wrong = new Set(faults.map((why) => Number(/ line (\d+)/.exec(why)?.[1])).filter(Boolean));
    this.number();
    this.state.textContent = faults.length ? `${faults.length === 1 ? "An error" : `${faults.length} errors`}` : "No errors.";
    this.state.className = faults.length ? "problem" : "good";
    this.errors.replaceChildren(...faults.map((why) => {
      const line = Number(/ line (\d+)/.exec(why)?.[1]);
      return h("li", {}, line ? h("button", { class: "plain", onclick: () => this.go(line) }, `Line ${line}`) : null, h("span", {}, why.replace(/^.*? line \d+: /, "")));
    }));
  }

  // Selects a line.
  go(line) {
    const lines = this.area.value.split("\n");
    const from = lines.slice(0, line - 1).reduce((sum, one) => sum + one.length + 1, 0);
    this.area.focus();
    this.area.setSelectionRange(from, from + lines[line - 1].length);
  }

  store() {
    return act(this.save, async () => {
      const text = this.area.value;
      await change("/api/save", { name: this.name, text, before: this.before });
      this.before = text;
      note(`${this.name} was saved.`);
      this.saved();
    }).finally(() => { this.save.disabled = this.revert.disabled = !this.isChanged; });
  }

  reload() {
    return act(this.revert, async () => {
      const { text } = await read("/api/file", { name: this.name });
      this.before = this.area.value = text;
      this.typed();
    }).finally(() => { this.revert.disabled = !this.isChanged; });
  }
}
