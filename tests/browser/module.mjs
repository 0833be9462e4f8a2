// Runs the module of live pages without a browser: every trial of a page must be that of the run, to the bit.
//
//   node tests/browser/module.mjs PAGE.html...
//   node tests/browser/module.mjs --ticks 100000 PAGE.html...
//
// Prints a line per page and exits with 1 if a trial differs, or if with `--ticks` the trials of a page are fewer ticks than that. Then
// no fresh trials are run, which would be as long.

import { readFileSync } from "node:fs";
import { unpacked } from "./packed.mjs";

const mark = '<script type="application/json" id="data">';

function opened(live) {
  const bytes = unpacked(live.module);
  const own = new WebAssembly.Instance(new WebAssembly.Module(bytes), {}).exports;
  const said = (length) => new TextDecoder().decode(new Uint8Array(own.memory.buffer, own.output(), length));
  const give = (text) => {
    const given = new TextEncoder().encode(text);
    const at = own.input(given.length);
    new Uint8Array(own.memory.buffer, at, given.length).set(given);
  };
  give(JSON.stringify(live.script));
  const wrong = said(own.open());
  if (wrong) throw new Error(wrong);
  return (request) => {
    give(JSON.stringify(request));
    return JSON.parse(said(own.answer()));
  };
}

let failed = 0;
const long = process.argv[2] === "--ticks";
const least = long ? Number(process.argv[3]) : 0;
if (long && !(least > 0)) throw new Error("--ticks wants a number above 0");
for (const page of process.argv.slice(long ? 4 : 2)) {
  const html = readFileSync(page, "utf8");
  const { title, live } = JSON.parse(html.slice(html.lastIndexOf(mark) + mark.length, html.lastIndexOf("</script>")));
  const ask = opened(live);
  let [ticks, differing, took] = [0, 0, 0];
  live.about.individuals.forEach(({ trials }, individual) => trials.forEach((told, number) => {
    const before = performance.now();
    const found = ask({ do: "film", individual, trial: { number }, lesion: "" });
    took += performance.now() - before;
    const own = found.digests?.filter((_, t) => (t + 1) % told.stride === 0 || t === found.digests.length - 1);
    const same = JSON.stringify([found.steps, found.fitness, found.success, own]) === JSON.stringify([told.steps, told.fitness, told.success, told.digests]);
    if (!same) console.log(`${page}: individual ${individual}, trial ${number} differs: ${found.error ?? `${found.steps} steps, fitness ${found.fitness} for ${told.steps}, ${told.fitness}`}`);
    differing += !same;
    ticks += found.digests?.length ?? 0;
  }));
  const wrong = ask({ do: "film", individual: 0, trial: { number: 0 }, lesion: "nuron:1" }).error;
  if (!/nearest is `neuron`|has no controller/.test(wrong)) differing++;
  if (long) {
    differing += ticks < least;
    failed += differing > 0;
    console.log(`${differing ? "FAILED" : "ok    "} ${title}: ${ticks} ticks, ${least} asked`);
    continue;
  }
  // Fresh trials side by side earn what each earns alone, as it is run when hands are on bodies.
  const few = ask({ do: "fresh", individual: 0, seed: 1, first: 3, count: 9 });
  const alone = few.fitness.map((_, k) => ask({ do: "film", individual: 0, trial: { fresh: { number: 3 + k, seed: 1 } } }));
  if (JSON.stringify(few.fitness) !== JSON.stringify(alone.map(({ fitness }) => fitness)) || few.successes !== alone.filter(({ success }) => success).length) {
    console.log(`${page}: fresh trials side by side earn ${few.fitness}, alone ${alone.map(({ fitness, error }) => error ?? fitness)}`);
    differing++;
  }
  failed += differing > 0;
  // Trials a second, in parts as a page asks for them.
  let [trials, since] = [0, performance.now()];
  while (performance.now() - since < 400 && trials < 2000) {
    const { trials: more, error } = ask({ do: "fresh", individual: 0, seed: 1, first: trials, count: 40 });
    if (error) throw new Error(error);
    trials += more;
  }
  const rate = Math.round(trials / (performance.now() - since) * 1000);
  console.log(`${differing ? "FAILED" : "ok    "} ${title}: ${ticks} ticks, ${Math.round(ticks / took * 1000)} a second as films; ${rate} fresh trials a second; ${Buffer.byteLength(html)} bytes`);
}
process.exit(failed ? 1 : 0);
