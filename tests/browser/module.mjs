// Runs the module of live pages apart from its page: every trial of a page must be that of the run, to the bit.
//
//   node tests/browser/module.mjs PAGE.html...
//   node tests/browser/module.mjs [--ticks 100000] [--browser] PAGE.html...
//
// In Node, or with `--browser` in an empty page of Chromium (with BROWSER=firefox of Firefox). Prints a line per page and exits with 1
// if a trial differs, or if with `--ticks` the trials of a page are fewer ticks than that. Then no fresh trials are run, which would be
// as long.

import { readFileSync, statSync } from "node:fs";
import { basename } from "node:path";
import { parseArgs } from "node:util";
import { gunzipSync } from "node:zlib";
import { startDriver } from "./webdriver.mjs";

const { values: options, positionals: pages } = parseArgs({ allowPositionals: true, options: { ticks: { type: "string" }, browser: { type: "boolean" } } });
const long = options.ticks !== undefined;
const least = Number(options.ticks);
if (long && !(least > 0)) throw new Error("--ticks wants a number above 0");
if (pages.length === 0) throw new Error("no page to look at");

const mark = '<script type="application/json" id="data">';

// The data of a page.
function dataOf(page) {
  const html = readFileSync(page, "utf8");
  return JSON.parse(html.slice(html.lastIndexOf(mark) + mark.length, html.lastIndexOf("</script>")));
}

// Makes `answer` of a module's bytes and a session's script; it runs where there is WebAssembly and nothing of Node.
async function openSession(bytes, script) {
  const { instance } = await WebAssembly.instantiate(bytes, {});
  const own = instance.exports;
  const said = (length) => new TextDecoder().decode(new Uint8Array(own.memory.buffer, own.output(), length));
  const give = (text) => {
    const given = new TextEncoder().encode(text);
    const at = own.input(given.length);
    new Uint8Array(own.memory.buffer, at, given.length).set(given);
  };
  give(JSON.stringify(script));
  const wrong = said(own.open());
  if (wrong) throw new Error(wrong);
  globalThis.answer = (request) => {
    give(JSON.stringify(request));
    // Without the film itself, which nobody looks at here, and with a name that drivers do not take for an error of their own.
    const { error: refusal, steps, fitness, success, successes, trials, digests } = JSON.parse(said(own.answer()));
    return { refusal, steps, fitness, success, successes, trials, digests };
  };
}

// The module of a page, open in Node or in the browser.
async function opened({ module, script }, browser) {
  const bytes = gunzipSync(Buffer.from(module, "base64"));
  if (!browser) {
    await openSession(bytes, script);
    return (request) => globalThis.answer(request);
  }
  await browser.go("about:blank");
  await browser.run(`async (text, script) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    await (${openSession})(bytes, script);
  }`, bytes.toString("base64"), script);
  return (request) => browser.run((request) => globalThis.answer(request), request);
}

// Whether fresh trials side by side earn what each earns alone, as it is run when hands are on bodies.
async function freshDiffer(page, ask) {
  const few = await ask({ do: "fresh", individual: 0, seed: 1, first: 3, count: 9 });
  const alone = [];
  for (const [k] of few.fitness.entries()) alone.push(await ask({ do: "film", individual: 0, trial: { fresh: { number: 3 + k, seed: 1 } } }));
  const same = JSON.stringify(few.fitness) === JSON.stringify(alone.map(({ fitness }) => fitness));
  // Without a criterion there is no number of successes.
  if (same && (few.successes ?? 0) === alone.filter(({ success }) => success).length) return 0;
  console.log(`${page}: fresh trials side by side earn ${few.fitness}, alone ${alone.map(({ fitness, refusal }) => refusal ?? fitness)}`);
  return 1;
}

// Fresh trials a second, in parts as a page asks for them.
async function rate(ask) {
  let [trials, since] = [0, performance.now()];
  while (performance.now() - since < 400 && trials < 2000) {
    const { trials: more, refusal } = await ask({ do: "fresh", individual: 0, seed: 1, first: trials, count: 40 });
    if (refusal) throw new Error(refusal);
    trials += more;
  }
  return Math.round(trials / (performance.now() - since) * 1000);
}

// Whether the trials of a page are those of its run.
async function check(page, browser) {
  const { live } = dataOf(page);
  const name = basename(page, ".html");
  const ask = await opened(live, browser);
  let [ticks, differing, took] = [0, 0, 0];
  for (const [individual, { trials }] of live.about.individuals.entries()) {
    for (const [number, told] of trials.entries()) {
      const before = performance.now();
      const found = await ask({ do: "film", individual, trial: { number }, lesion: "" });
      took += performance.now() - before;
      const own = found.digests?.filter((_, t) => (t + 1) % told.stride === 0 || t === found.digests.length - 1);
      const same = JSON.stringify([found.steps, found.fitness, found.success ?? null, own]) === JSON.stringify([told.steps, told.fitness, told.success ?? null, told.digests]);
      if (!same) console.log(`${page}: individual ${individual}, trial ${number} differs: ${found.refusal ?? `${found.steps} steps, fitness ${found.fitness} for ${told.steps}, ${told.fitness}`}`);
      differing += !same;
      ticks += found.digests?.length ?? 0;
    }
  }
  const wrong = (await ask({ do: "film", individual: 0, trial: { number: 0 }, lesion: "nuron:1" })).refusal;
  if (!/nearest is `neuron`|has no controller/.test(wrong)) differing++;
  if (long) {
    differing += ticks < least;
    console.log(`${differing ? "FAILED" : "ok    "} ${name}: ${ticks} ticks, ${least} asked`);
  } else {
    differing += await freshDiffer(page, ask);
    const second = Math.round(ticks / took * 1000);
    console.log(`${differing ? "FAILED" : "ok    "} ${name}: ${ticks} ticks, ${second} a second as films; ${await rate(ask)} fresh trials a second; ${statSync(page).size} bytes`);
  }
  return differing > 0;
}

let failed = 0;
const driver = options.browser ? await startDriver() : null;
const browser = await driver?.open();
try {
  for (const page of pages) failed += await check(page, browser);
} finally {
  await browser?.close();
  driver?.stop();
}
process.exit(failed ? 1 : 0);
