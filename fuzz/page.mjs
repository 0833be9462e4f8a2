// Damaged and forged pages for the reader of farsa-view/src/page/viewer/data.js: each ends in a page whose trials can be asked for
// everything, or in the error that the page shows (Damage). Also bounded: a forged page may not make the reader work for ever.
//
//   node fuzz/page.mjs RUNS SEED
//
// Starts from the pages in fuzz/corpus/page, changes them by a generator of that seed, and prints how many were read and refused.
// What fails is printed with the number by which `node fuzz/page.mjs RUNS SEED NUMBER` makes the page again, and the exit code is 1.

import { readdirSync, readFileSync } from "node:fs";

const folder = new URL("./corpus/page/", import.meta.url);
const source = readFileSync(new URL("../farsa-view/src/page/viewer/data.js", import.meta.url), "utf8");
const { readPage, Damage, crc32 } = new Function(`${source}\nreturn {readPage, Damage, crc32};`)();

// The longest that a page may take [ms], and the objects that it may become: the reader's work is bounded by the page's size.
const LONGEST = 2000;

const runs = Number(process.argv[2] ?? 2000);
const seed = Number(process.argv[3] ?? 1);
const only = process.argv[4] === undefined ? null : Number(process.argv[4]);

// Numbers from 0 to below 1 (mulberry32).
function generator(state) {
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

const ODD = [0, 1, -1, 2, 3, 7, 0.5, 255, 65535, 65536, 1e6, 1e9, 4294967295, 2 ** 53, 1e300, -1e9, null, true, false, "", "a", "-1",
  "constructor", "__proto__", "<b>", [], {}, [0], [0, 1], [1, 0], [0, 1e9], [[0, 1]], { length: 1e9 }, [-1, 1e9]];

// All places of a value, each as the object that it is in and its key there.
function places(value, found = []) {
  if (value && typeof value === "object") {
    for (const key of Object.keys(value)) {
      found.push([value, key]);
      places(value[key], found);
    }
  }
  return found;
}

// Changes numbers in the data of a trial, and makes length and checksum right again.
function changeData(trial, random) {
  if (typeof trial?.data !== "string") return;
  let bytes = Buffer.from(trial.data, "base64");
  for (let n = 1 + Math.floor(random() * 4); n && bytes.length; n--) {
    const at = Math.floor(random() * bytes.length);
    bytes[at] = random() < 0.5 ? 255 * (random() < 0.5) : Math.floor(random() * 256);
  }
  if (random() < 0.1) bytes = bytes.subarray(0, Math.floor(random() * (bytes.length + 1)));
  Object.assign(trial, { data: bytes.toString("base64"), bytes: bytes.length, crc32: crc32(bytes) });
}

function changeOnce(page, random) {
  const all = places(page);
  const [within, key] = all[Math.floor(random() * all.length)] ?? [page, "episodes"];
  const what = random();
  if (what < 0.45) within[key] = structuredClone(ODD[Math.floor(random() * ODD.length)]);
  else if (what < 0.6 && typeof within[key] === "number") within[key] = Math.round(within[key] * 3 * random()) - 1;
  else if (what < 0.7) Array.isArray(within) ? within.splice(key, 1) : delete within[key];
  else if (what < 0.8 && Array.isArray(within)) within.push(...Array(1 + Math.floor(random() * 20)).fill(structuredClone(within[key])));
  else if (what < 0.9) within[key] = structuredClone(all[Math.floor(random() * all.length)]?.[0] ?? null);
  else changeData((page?.episodes ?? page?.lives)?.[0], random);
}

// A page as text.
function changed(seeds, random) {
  const page = structuredClone(seeds[Math.floor(random() * seeds.length)]);
  for (let n = Math.floor(random() * 4); n >= 0; n--) changeOnce(page, random);
  if (random() < 0.3) changeData((page?.episodes ?? page?.lives)?.[0], random);
  let text = JSON.stringify(page);
  if (random() < 0.05) text = text.slice(0, Math.floor(random() * text.length));
  return text;
}

// Asks a trial for what the page draws at some ticks.
function ask(trial) {
  const { ticks, end } = trial;
  for (const tick of new Set([0, ticks >> 1, ticks - 1])) {
    trial.bodies.forEach((_, body) => [trial.pose(tick, body), tick + 1 < ticks && trial.between(tick + 0.5, body)]);
    trial.points.forEach((_, point) => trial.point(tick, point));
    trial.images.forEach((_, image) => trial.image(tick, image));
    [trial.contacts(tick), trial.rays(tick), trial.timeAt(tick)].forEach((value) => value);
  }
  trial.tickAt(end / 2);
}

// "read", or the error that a reader of the page sees; anything else is thrown.
function outcome(text) {
  let page;
  try {
    page = readPage({ textContent: text });
  } catch (error) {
    if (!(error instanceof Damage)) throw error;
    return error.message;
  }
  page.trials.forEach(ask);
  return "read";
}

const names = readdirSync(folder).filter((name) => name.endsWith(".json")).sort();
const texts = names.map((name) => readFileSync(new URL(name, folder), "utf8"));
const whole = texts.filter((_, i) => !names[i].startsWith("refused-"));
// The corpus itself: pages that were written are read, those that once did harm are refused.
texts.forEach((text, i) => {
  const found = outcome(text);
  if ((found === "read") === names[i].startsWith("refused-")) throw new Error(`${names[i]}: ${found}`);
});
const seeds = whole.map((text) => JSON.parse(text));
const counts = { read: 0, refused: 0, failed: 0 };
let slowest = 0;
for (let number = only ?? 0; number < (only === null ? runs : only + 1); number++) {
  const text = changed(seeds, generator((seed * 1_000_003 + number) | 0));
  if (only !== null) console.log(text);
  const started = performance.now();
  try {
    counts[outcome(text) === "read" ? "read" : "refused"]++;
  } catch (error) {
    counts.failed++;
    console.log(`page ${number}: ${error.stack.split("\n").slice(0, 4).join(" ")}`);
  }
  const took = performance.now() - started;
  slowest = Math.max(slowest, took);
  if (took > LONGEST) {
    counts.failed++;
    console.log(`page ${number}: took ${Math.round(took)} ms`);
  }
}
console.log(`page: ${only === null ? runs : 1} pages, ${counts.read} read, ${counts.refused} refused, ${counts.failed} failed, the slowest took ${Math.round(slowest)} ms`);
process.exit(counts.failed ? 1 : 0);
