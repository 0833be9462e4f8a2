// Places of the page: `#/`, `#/experiment/NAME`, `#/run/NAME` and `#/trial/RUN`.

import { experiment } from "./experiment.js";
import { h, show } from "./parts.js";
import { run } from "./run.js";
import { start } from "./start.js";
import { trial } from "./trial.js";

const PLACES = { "": start, experiment, run, trial };
const dark = matchMedia("(prefers-color-scheme: dark)");

function paint() {
  document.documentElement.dataset.theme = dark.matches ? "dark" : "light";
}

// The current place ends what it has opened when another one begins.
let leave = null;
let visit = 0;

async function open() {
  leave?.abort();
  leave = new AbortController();
  const number = ++visit;
  const [kind = "", ...rest] = location.hash.replace(/^#\/?/, "").split("/");
  const name = rest.length ? decodeURIComponent(rest.join("/")) : "";
  const place = PLACES[kind] || start;
  const crumbs = kind && name ? [h("li", {}, h("a", { href: "#/" }, "Start")), h("li", { "aria-current": "page" }, name)] : [];
  document.getElementById("crumbs").replaceChildren(...crumbs);
  document.title = name ? `${name} – farsa lab` : "farsa lab";
  try {
    await place(name, leave.signal, () => number === visit);
  } catch (error) {
    if (number !== visit) return;
    show(h("section", { class: "card" }, h("h1", {}, "This did not work"), h("p", { class: "problem" }, error.message),
      h("div", { class: "bar" }, h("button", { onclick: open }, "Try again"), h("a", { class: "button", href: "#/" }, "Start"))));
  }
  // Keys begin at the content of the new place, but not when the page has just loaded.
  if (number === visit && number > 1) document.getElementById("main").focus({ preventScroll: true });
  if (number > 1) scrollTo(0, 0);
  document.documentElement.dataset.ready = String(number);
}

// The token leaves the address, where a picture of the screen would show it.
history.replaceState(null, "", location.pathname + location.hash);
document.querySelector(".skip").addEventListener("click", (event) => {
  event.preventDefault();
  document.getElementById("main").focus();
});
dark.addEventListener("change", paint);
addEventListener("hashchange", open);
paint();
open();
