// Elements, requests, messages and numbers. Every text of a file is put in as text, never as markup.

const SVG = "http://www.w3.org/2000/svg";

// Properties that are no attributes.
function put(element, properties, children) {
  for (const [name, value] of Object.entries(properties || {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "value" || name === "checked" || name === "disabled" || name === "hidden") element[name] = value;
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat(9).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

export const h = (tag, properties, ...children) => put(document.createElement(tag), properties, children);
export const s = (tag, properties, ...children) => put(document.createElementNS(SVG, tag), properties, children);

export function show(...parts) {
  const main = document.getElementById("main");
  main.replaceChildren(...parts.flat(9).filter(Boolean));
  return main;
}

export class Refused extends Error {
  constructor(status, message) {
    super(message);
    this.status = status;
  }
}

async function answered(answer) {
  const text = await answer.text();
  let data = null;
  try {
    data = JSON.parse(text);
  } catch {
    data = null;
  }
  if (!answer.ok) throw new Refused(answer.status, data?.error || text || `error ${answer.status}`);
  return data;
}

const unreached = () => {
  throw new Refused(0, "The server does not answer. Start `farsa lab` again and open the address that it prints.");
};

export const address = (path, parameters = {}) => {
  const given = Object.entries(parameters).filter(([, value]) => value !== undefined && value !== null && value !== "");
  return given.length ? `${path}?${new URLSearchParams(given)}` : path;
};

export const read = (path, parameters) => fetch(address(path, parameters)).catch(unreached).then(answered);

export const change = (path, body) =>
  fetch(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) }).catch(unreached).then(answered);

// A message that leaves after a while. An error stays until it is closed.
export function note(text, kind = "done") {
  const close = h("button", { "aria-label": "Close", class: "plain", onclick: () => box.remove() }, "×");
  const box = h("div", { class: `note ${kind}`, role: kind === "wrong" ? "alert" : undefined }, h("p", {}, text), close);
  document.getElementById("notes").append(box);
  if (kind !== "wrong") setTimeout(() => box.remove(), 6000);
}

// Runs an action with its button disabled, and shows its error.
export async function act(button, action) {
  const text = button?.textContent;
  if (button) {
    button.disabled = true;
    button.setAttribute("aria-busy", "true");
  }
  try {
    return await action();
  } catch (error) {
    note(error.message, "wrong");
    return null;
  } finally {
    if (button) {
      button.disabled = false;
      button.removeAttribute("aria-busy");
      if (button.textContent !== text && !button.dataset.keep) button.textContent = text;
    }
  }
}

// Four significant digits, as in reports.
export function number(x) {
  if (x === null || x === undefined || !Number.isFinite(x)) return "–";
  if (x !== 0 && (Math.abs(x) >= 1e6 || Math.abs(x) < 1e-3)) return x.toExponential(2);
  return String(Number(x.toPrecision(4)));
}

export const percent = (x) => `${Math.round(1000 * x) / 10}%`;

export function seconds(x) {
  const whole = Math.ceil(x);
  const parts = [[86400, "d"], [3600, "h"], [60, "min"], [1, "s"]];
  const first = parts.findIndex(([size]) => whole >= size);
  if (first < 0) return "0 s";
  const texts = [];
  let rest = whole;
  for (const [size, unit] of parts.slice(first, first + 2)) {
    const count = Math.floor(rest / size);
    if (count) texts.push(`${count} ${unit}`);
    rest -= count * size;
  }
  return texts.join(" ");
}

export function bytes(x) {
  if (x < 1000) return `${x} B`;
  return x < 1e6 ? `${Math.round(x / 1000)} kB` : `${Number((x / 1e6).toPrecision(3))} MB`;
}

export const date = (unix) => (unix ? new Date(1000 * unix).toLocaleString([], { dateStyle: "medium", timeStyle: "short" }) : "–");

// Words and colors of the states of a run.
const STATES = { waiting: "waiting", running: "running", testing: "testing", stopped: "stopped", failed: "failed", finished: "finished" };
export const state = (name) => h("span", { class: `state ${name}` }, h("i", { "aria-hidden": "true" }), STATES[name] || name);

export const success = (found) =>
  found ? `${percent(found.successes / found.of)} (${percent(found.interval[0])} to ${percent(found.interval[1])})` : "–";

// A command line, with a button that copies it.
export function command(line) {
  const copy = h("button", { class: "plain", onclick: () => navigator.clipboard?.writeText(line).then(() => note("The command was copied.")) }, "Copy");
  return h("div", { class: "command" }, h("code", {}, line), copy);
}

export const field = (label, input, help) => h("label", { class: "field" }, h("span", {}, label), input, help && h("small", { class: "soft" }, help));

// Asks before something is moved away. The dialog takes keys and closes by Escape.
export function confirmed(question, yes) {
  return new Promise((resolve) => {
    const dialog = h("dialog", { onclose: () => (resolve(dialog.returnValue === "yes"), dialog.remove()) },
      h("p", {}, question),
      h("div", { class: "bar" },
        h("button", { onclick: () => dialog.close("no") }, "Cancel"),
        h("button", { class: "main", onclick: () => dialog.close("yes") }, yes)));
    document.body.append(dialog);
    dialog.showModal();
  });
}
