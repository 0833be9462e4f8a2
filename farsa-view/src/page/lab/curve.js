// Curves of fitness: a small one of a list, and the growing one of a run.

import { h, number, s } from "./parts.js";

const WIDTH = 120;
const HEIGHT = 32;

// Groups of neighbors without gaps.
function pieces(points) {
  const found = [[]];
  for (const point of points) {
    if (Number.isFinite(point[1])) found.at(-1).push(point);
    else if (found.at(-1).length) found.push([]);
  }
  return found.filter((piece) => piece.length);
}

export function small(values) {
  const finite = values.filter((value) => value !== null);
  const label = finite.length ? `best fitness from ${number(finite[0])} to ${number(finite.at(-1))}` : "no generation yet";
  const svg = s("svg", { class: "small", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": label, preserveAspectRatio: "none" });
  if (!finite.length) return svg;
  const low = Math.min(...finite), high = Math.max(...finite);
  const x = (at) => (values.length > 1 ? (at / (values.length - 1)) * (WIDTH - 4) + 2 : WIDTH / 2);
  const y = (value) => (high > low ? HEIGHT - 3 - ((value - low) / (high - low)) * (HEIGHT - 6) : HEIGHT / 2);
  for (const piece of pieces(values.map((value, at) => [at, value === null ? NaN : value]))) {
    const line = piece.map(([at, value]) => `${x(at).toFixed(1)},${y(value).toFixed(1)}`).join(" ");
    svg.append(piece.length > 1 ? s("polyline", { points: line }) : s("circle", { cx: x(piece[0][0]), cy: y(piece[0][1]), r: 2 }));
  }
  return svg;
}

// Rounded values of an axis.
function ticks(low, high, count) {
  if (!(high > low)) return [low];
  const rough = (high - low) / count;
  const size = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * size).find((step) => step >= rough);
  const found = [];
  for (let at = Math.ceil(low / step - 1e-9); at * step <= high + 1e-9 * step; at++) found.push(at * step);
  return found;
}

// A curve that takes rows [generation, best, mean] and draws itself once a frame.
export class Curve {
  constructor() {
    this.rows = [];
    this.svg = s("svg", { class: "curve", role: "img", "aria-label": "Best and mean fitness of every generation" });
    this.value = h("output", { class: "soft" });
    this.element = h("figure", { class: "chart" }, this.svg,
      h("figcaption", {}, h("span", { class: "best" }, "best"), h("span", { class: "mean" }, "mean"), this.value));
    this.svg.addEventListener("pointermove", (event) => this.point(event));
    this.svg.addEventListener("pointerleave", () => this.caption(this.rows.at(-1)));
    new ResizeObserver(() => this.draw()).observe(this.svg);
  }

  add(rows) {
    // A stream that was interrupted sends its last rows again.
    for (const row of rows) if (row[0] >= this.rows.length) this.rows.push(row);
    this.caption(this.rows.at(-1));
    this.later();
  }

  clear() {
    this.rows = [];
    this.later();
  }

  later() {
    if (this.waits) return;
    this.waits = true;
    requestAnimationFrame(() => {
      this.waits = false;
      this.draw();
    });
  }

  caption(row) {
    this.value.textContent = row ? `generation ${row[0]}: best ${number(row[1])}, mean ${number(row[2])}` : "no generation yet";
  }

  point(event) {
    if (!this.rows.length || !this.scale) return;
    const { left, width } = this.scale;
    const box = this.svg.getBoundingClientRect();
    const at = Math.round(((event.clientX - box.left - left) / width) * Math.max(1, this.last()));
    this.caption(this.rows[Math.min(this.rows.length - 1, Math.max(0, at))]);
  }

  last() {
    return Math.max(this.rows.length - 1, 1);
  }

  draw() {
    const box = this.svg.getBoundingClientRect();
    const [wide, tall] = [box.width || 600, box.height || 260];
    this.svg.setAttribute("viewBox", `0 0 ${wide} ${tall}`);
    const left = 54, top = 10, width = wide - left - 26, height = tall - top - 46;
    this.scale = { left, width };
    const values = this.rows.flatMap((row) => [row[1], row[2]]).filter((x) => x !== null);
    let low = Math.min(...sample(values)), high = Math.max(...sample(values));
    if (!values.length) [low, high] = [0, 1];
    if (low === high) [low, high] = [low - 0.5, high + 0.5];
    const x = (at) => left + (at / this.last()) * width;
    const y = (value) => top + height - ((value - low) / (high - low)) * height;
    const parts = [];
    for (const value of ticks(low, high, 4)) {
      parts.push(s("line", { class: "grid", x1: left, x2: left + width, y1: y(value), y2: y(value) }));
      parts.push(s("text", { x: left - 8, y: y(value) + 4, "text-anchor": "end" }, number(value)));
    }
    for (const value of ticks(0, this.last(), Math.max(2, Math.floor(width / 110))).filter(Number.isInteger)) {
      parts.push(s("text", { x: x(value), y: top + height + 18, "text-anchor": "middle" }, String(value)));
    }
    parts.push(s("text", { x: left + width / 2, y: tall - 4, "text-anchor": "middle" }, "generation"));
    for (const [column, name] of [[2, "mean"], [1, "best"]]) {
      const points = thinned(this.rows, column, Math.max(100, width));
      for (const piece of pieces(points)) {
        const line = piece.map(([at, value]) => `${x(at).toFixed(1)},${y(value).toFixed(1)}`).join(" ");
        parts.push(piece.length > 1 ? s("polyline", { class: name, points: line }) : s("circle", { class: name, cx: x(piece[0][0]), cy: y(piece[0][1]), r: 3 }));
      }
    }
    this.svg.replaceChildren(...parts);
  }
}

// Arguments of a function are limited.
const sample = (values) => (values.length < 50_000 ? values : [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))]);

// At most two points of each column of pixels, its least and largest value.
function thinned(rows, column, width) {
  const value = (row) => (row[column] === null ? NaN : row[column]);
  if (rows.length <= 2 * width) return rows.map((row) => [row[0], value(row)]);
  const size = Math.ceil(rows.length / width);
  const found = [];
  for (let at = 0; at < rows.length; at += size) {
    const part = rows.slice(at, at + size).map((row) => [row[0], value(row)]).filter((point) => Number.isFinite(point[1]));
    if (!part.length) continue;
    const low = part.reduce((a, b) => (b[1] < a[1] ? b : a)), high = part.reduce((a, b) => (b[1] > a[1] ? b : a));
    found.push(...(low[0] < high[0] ? [low, high] : [high, low]));
  }
  return found;
}
