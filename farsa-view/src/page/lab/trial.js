// A trial: the interactive page of a run in a frame without the laboratory's origin. What it has made is kept on request.

import { change, confirmed, h, note, read, show } from "./parts.js";
import { header } from "./start.js";

const KEPT = { genotype: "the genes of the individual", configuration: "the configuration with the changes", script: "the command that repeats the trial", run: "the run with its new generations" };

export async function trial(run, signal, isHere) {
  const list = await read("/api/list");
  if (!isHere()) return;
  header(list);
  const frame = framed(run, `/files/pages/live-${encodeURIComponent(run)}.html`, `Trial of ${run}`, list.read_only, signal);
  show(h("div", { class: "head" }, h("h1", {}, "Trial of ", h("a", { href: `#/run/${encodeURIComponent(run)}` }, run))), frame);
}

// An interactive page of a run in a frame. `hear` receives the messages of the page that ask for nothing to be kept.
export function framed(run, src, title, readOnly, signal, hear = () => {}) {
  const frame = h("iframe", { class: "trial", sandbox: "allow-scripts allow-downloads allow-modals", title, src });
  // A laboratory that keeps nothing leaves saving to the browser.
  if (!readOnly) frame.addEventListener("load", () => frame.contentWindow.postMessage({ farsa: "laboratory" }, "*"));
  addEventListener("message", async ({ source, data }) => {
    if (source !== frame.contentWindow) return;
    if (data?.farsa !== "keep") return hear(data);
    if (readOnly || !Object.hasOwn(KEPT, data.kind) || typeof data.text !== "string") return;
    const text = await kept(run, data).catch((error) => (note(error.message, "wrong"), error.message));
    frame.contentWindow?.postMessage({ farsa: "kept", text }, "*");
  }, { signal });
  return frame;
}

async function kept(run, { kind, text }) {
  if (!(await confirmed(`Keep ${KEPT[kind]} in the folder?`, "Keep"))) return "Nothing was kept.";
  const { file, run: made } = await change("/api/keep", { kind, run, text });
  note(made ? h("span", {}, "The run is evolved as ", h("a", { href: `#/run/${encodeURIComponent(made)}` }, made), ".") : `Kept as ${file}.`);
  return made ? `Kept as the run ${made}.` : `Kept as ${file}.`;
}
