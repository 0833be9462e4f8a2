// Tests the page of `farsa replay --html` in a real browser.
//
//   node tests/browser/run.mjs [PAGE.html TRIAL.csv [SCREENSHOTS [LIVE.html LESION.json [EVOLVING.html FITNESS.csv [ADDRESS [ARM.html]]]]]]
//
// PAGE.html is a page of a trial, TRIAL.csv what `farsa replay` says of the same trial; without them an invented trial takes
// their place. LIVE.html is a page of `farsa live`, LESION.json what `farsa test --lesion` says of the same agent without one neuron.
// EVOLVING.html is a page of an unfinished run, FITNESS.csv that of the run three generations later.
// ADDRESS is where `farsa serve` serves a run that goes on, once the process SERVED_RUN has been told to, ARM.html a live page of
// `reach-grasp-lift`. Prints a line per check and exits with 1 if one failed. Needs chromium and chromedriver, no package; with
// BROWSER=firefox, Firefox and geckodriver, which leave out other screens, damage and missing parts.

import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { pathToFileURL } from "node:url";
import { elsewhere } from "./elsewhere.mjs";
import { armTrial, arenaTrial, CELLS, compose, csvOf, encode, eyePixel, foragingTrial, lean, pageOf, SCRIPTS, STYLE, viewer } from "./mock.mjs";
import { coloursIn, decode } from "./png.mjs";
import { meshes } from "./meshes.mjs";
import { newcomers, phoned } from "./newcomers.mjs";
import { isFirefox, KEY, startDriver } from "./webdriver.mjs";

// Whatever hangs, the whole does not.
setTimeout(() => {
  console.log("FAILED the tests took longer than forty minutes");
  process.exit(1);
}, 2_400_000).unref();

const [page, csv, shots, livePage, lesionFile, evolvingPage, evolvedLog, servedPage, armPage] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "farsa-pages-"));
let failed = 0;
if (shots) mkdirSync(shots, { recursive: true });

function check(name, ok, detail = "") {
  console.log(`${ok ? "ok    " : "FAILED"} ${name}${ok || detail === "" ? "" : `: ${detail}`}`);
  if (!ok) failed++;
}

// Runs some checks; an exception is a failure and not the end.
async function part(name, run) {
  try {
    await run();
  } catch (error) {
    check(name, false, error.message);
  }
}

const close = (a, b, within) => Math.abs(a - b) <= within * (1 + 1e-9) + 1e-12;

function write(name, text) {
  const path = join(folder, name);
  writeFileSync(path, text);
  return pathToFileURL(path);
}

// What a page holds, and the page with other data.
const mark = '<script type="application/json" id="data">';
const dataOf = (html) => JSON.parse(html.slice(html.lastIndexOf(mark) + mark.length, html.lastIndexOf("</script>")));
const withData = (html, data) => html.slice(0, html.lastIndexOf(mark) + mark.length) + JSON.stringify(data).replaceAll("<", "\\u003c") + "</script>\n</body>\n</html>\n";

// The rows of the trial that the page shows first, by column.
function readCsv(text, trial) {
  const [head, ...rows] = text.trim().split(/\r?\n/).map((line) => line.split(","));
  const wanted = /trial (\d+)/.exec(trial.name)?.[1];
  const numbers = [...new Set(rows.map((row) => row[0]))];
  const number = numbers.includes(wanted) ? wanted : numbers[0];
  return rows.filter((row) => row[0] === number).map((row) => Object.fromEntries(head.map((name, i) => [name, row[i]])));
}

async function opened(browser, url, { motion = "reduce", scheme = "light" } = {}) {
  await browser.media({ "prefers-color-scheme": scheme, "prefers-reduced-motion": motion });
  await browser.go(url);
  await browser.until(() => window.farsa && (farsa.ready || farsa.error));
  // Two pictures later all is drawn.
  await settled(browser);
}

const settled = (browser) => browser.run(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 50)))));
const rectOf = (browser, selector) => browser.run((s) => {
  const { left, top, right, bottom, width, height } = document.querySelector(s).getBoundingClientRect();
  return { left, top, right, bottom, width, height };
}, selector);
const shownValues = (browser) => browser.run(() => [...document.querySelectorAll("#groups section")].flatMap((section) =>
  [...section.querySelectorAll(".row")].map((row) => ({
    group: section.dataset.group, name: row.dataset.name, text: row.querySelector(".value").textContent, unit: row.querySelector(".unit").textContent,
  }))));

async function silent(browser, name) {
  const log = await browser.log();
  check(`${name}: the console is silent`, log.length === 0, log.join(" | "));
}

// ---- The viewer's files.

function files() {
  const template = viewer("page.html");
  const size = [template, ...[STYLE, ...SCRIPTS.map(viewer)].map(lean)].reduce((sum, text) => sum + Buffer.byteLength(text), 0);
  check(`the viewer has ${size} bytes, at most 98304`, size <= 98304);
  for (const name of ["title", "style", "script", "data"]) {
    check(`page.html has one {{${name}}}`, template.split(`{{${name}}}`).length === 2);
  }
  const rest = [STYLE, ...SCRIPTS.map(viewer)].join("");
  check("style and scripts can stand in a page", !/<\/(script|style)|<!--|\{\{/.test(rest));
  check("nothing is asked of a network", !/https?:|\bfetch\(|XMLHttpRequest|import\(|@import|url\(/.test(template + rest));
}

// ---- An invented trial, of which every number is known.

async function arithmetic(browser) {
  const trials = [armTrial(0), armTrial(1)];
  trials[1].times = trials[1].times.slice(0, 400);
  for (const key of ["poses", "marks", "contacts", "rays"]) trials[1][key] = trials[1][key].slice(0, 400);
  trials[1].channels = trials[1].channels.map((c) => ({ ...c, values: c.values.slice(0, 400) }));
  await opened(browser, write("invented.html", compose(pageOf(trials))));
  const encoded = trials.map(encode);
  let worst = { position: 0, rotation: 0, force: 0, value: 0 };
  let same = true;
  for (const tick of [0, 1, 150, 361, 399, 599]) {
    const found = await browser.run((tick) => {
      farsa.seek(tick);
      return farsa.trials.map((trial) => ({
        poses: trial.bodies.map((body) => farsa.pose(trial, body)), contacts: farsa.contacts(trial),
        values: trial.channels.map((c) => [farsa.value(trial, c.name, c.group)].map((x) => (Number.isNaN(x) ? "NaN" : x))[0]),
      }));
    }, tick);
    trials.forEach((trial, n) => {
      const t = Math.min(tick, trial.times.length - 1);
      trial.poses[t].forEach((pose, b) => {
        const { position, rotation } = found[n].poses[b];
        position.forEach((x, i) => (worst.position = Math.max(worst.position, Math.abs(x - pose.position[i]) / (encoded[n].position_unit / 2))));
        const dot = Math.abs(rotation.reduce((sum, x, i) => sum + x * pose.rotation[i], 0));
        worst.rotation = Math.max(worst.rotation, 2 * Math.acos(Math.min(1, dot)));
      });
      same &&= found[n].contacts.length === trial.contacts[t].length;
      trial.contacts[t].forEach(([pair, point, force], i) => {
        const contact = found[n].contacts[i];
        same &&= contact.pair.join() === trial.pairs[pair].join() && contact.point.every((x, k) => close(x, point[k], encoded[n].position_unit / 2));
        contact.force.forEach((f, k) => (worst.force = Math.max(worst.force, Math.abs(f - force[k]) / (encoded[n].force_unit / 2))));
      });
      trial.channels.forEach((channel, c) => {
        const value = found[n].values[c];
        if (Number.isNaN(channel.values[t])) same &&= value === "NaN";
        else if (encoded[n].channels[c].scale > 0) worst.value = Math.max(worst.value, Math.abs(value - channel.values[t]) / (encoded[n].channels[c].scale / 2));
      });
    });
  }
  check("invented trials: positions within the stated precision", worst.position <= 1.0001, `${worst.position} times it`);
  check("invented trials: rotations within 0.1 mrad", worst.rotation < 1e-4, worst.rotation);
  check("invented trials: forces within the stated precision", worst.force <= 1.0001, `${worst.force} times it`);
  check("invented trials: values within the stated precision", worst.value <= 1.0001, `${worst.value} times it`);
  check("invented trials: contacts and missing values are those written", same);

  // A shorter trial stands still at its end; both keep in step by time.
  const step = await browser.run(() => (farsa.show(0, 1), farsa.seek(599), [farsa.ticks, farsa.value(1, "reward.lift"), farsa.trials[1].channels.find((c) => c.name === "reward.lift").values[399]]));
  check("the clock is that of the longer trial", step[0] === 600 && step[1] === step[2], step.join());

  const node = await browser.run(() => {
    const { nodes, links } = farsa.trials[0].network;
    const from = nodes[3];
    const to = nodes[31];
    return { weight: links.find((l) => l.from === from && l.to === to).weight, recurrent: links.find((l) => l.from === nodes[30] && l.to === nodes[29]).weight, bias: to.values };
  });
  const { weights } = trials[0];
  check("weights are those of their links", close(node.weight, weights[3 * 12 + 2], 1e-6) && close(node.recurrent, weights[348 + 12], 1e-6));
  check("biases and leaks are those of their neurons", node.bias.length === 2 && close(node.bias[0][1], weights[768 + 2], 1e-6) && close(node.bias[1][1], weights[803 + 2], 1e-6));
  const half = await browser.run(() => farsa.trials[0].between(400.5, 27).position);
  const middle = [0, 1, 2].map((i) => (trials[0].poses[400][27].position[i] + trials[0].poses[401][27].position[i]) / 2);
  check("between two ticks bodies are between two poses", half.every((x, i) => close(x, middle[i], encoded[0].position_unit)));
  await images(browser);
  await silent(browser, "invented trials");

  await opened(browser, write("arena.html", compose(pageOf([arenaTrial(0)], "top"))));
  const arena = await browser.run(() => [farsa.view, document.querySelector("#camera").value, document.querySelector("#trails").ariaPressed, document.querySelector("#forces").hidden, document.querySelector("#network").hidden]);
  check("a page without images shows none", await browser.run(() => document.querySelector("#images").hidden));
  check("an arena is seen from above with trails, without what it has not", arena.join() === "top,top,true,true,true", arena.join());
  await silent(browser, "arena");

  // A network whose sensors drive its outputs, without neurons in between.
  const reflex = arenaTrial(0);
  const nodes = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9].map((channel) => ({ channel, layer: channel < 8 ? 0 : 2, name: `node ${channel}` }));
  reflex.network = { nodes, links: [{ from: [0, 8], to: [8, 10], first: 0 }], values: [{ name: "bias", nodes: [8, 10], first: 16 }] };
  reflex.weights = Array.from({ length: 18 }, (_, i) => Math.sin(i));
  await opened(browser, write("reflex.html", compose(pageOf([reflex], "top"))));
  const drawn = await browser.run(() => [farsa.ready, farsa.error, document.querySelector("#message").hidden, document.querySelector("#network").hidden]);
  check("a network without neurons is drawn", drawn.join() === "true,,true,false", drawn.join());
  await silent(browser, "reflexes");
}

// What the canvases show is what the eyes of the invented trials saw, each beside the strips in squares.
async function images(browser) {
  for (const tick of [599, 20, 395, 394, 3]) {
    const found = await browser.run((tick) => new Promise((done) => {
      farsa.seek(tick);
      requestAnimationFrame(() => requestAnimationFrame(() => done([...document.querySelectorAll("#images div")].map((element) => {
        const canvas = element.querySelector("canvas");
        const { width, height } = canvas;
        return { name: element.dataset.name, note: element.querySelector(".soft").textContent, size: [width, height],
          colors: [...canvas.getContext("2d").getImageData(0, 0, width, height).data], told: farsa.image(0, "left eye").colors === null };
      }))));
    }), tick);
    const expected = [0, 1].map((number) => {
      const t = Math.min(tick, number ? 399 : 599);
      const pixel = (k) => [...eyePixel(t, k, number).map((count, i) => Math.round(count * 255 / [31, 63, 31][i])), 255];
      return Array.from({ length: 48 }, (_, k) => (t < 20 ? [0, 0, 0, 0] : pixel(k))).flat();
    });
    const same = found.length === 2 && found.every(({ name, size, colors, note, told }, i) =>
      name === "left eye" && size.join() === "8,6" && colors.join() === expected[i].join() && told === tick < 20 && /×/.test(note) === tick >= 20);
    check(`images at tick ${tick} are those written`, same, JSON.stringify(found).slice(0, 300));
  }
  const [eye, strips, list] = [await rectOf(browser, "#images canvas"), await rectOf(browser, "#strips"), await rectOf(browser, "#list")];
  check("images are beside the strips", eye.left >= list.right - 1 && eye.top >= strips.top && eye.bottom <= strips.bottom && eye.width > 100, JSON.stringify([eye, strips, list]));
  check("their pixels are squares", Math.abs(eye.width / 8 - eye.height / 6) < 0.1);
}

// ---- The page itself.

async function against(browser, url, table, trial) {
  await opened(browser, url);
  check("the page is up and says nothing is wrong", await browser.run(() => farsa.ready && farsa.error === null && document.querySelector("#message").hidden));
  check("reduced motion: it does not play by itself", !(await browser.run(() => farsa.playing)));
  check("the page has as many ticks as the table has rows", (await browser.run(() => farsa.ticks)) === table.length, table.length);
  const unit = trial.position_unit / 2;
  const said = await browser.run(() => document.querySelector("#facts").textContent);
  check("facts and precision are shown", trial.facts.every(([name, text]) => said.includes(name) && said.includes(text)) && /Positions within [\d.]+ (mm|cm|m)/.test(said), said);

  const bodies = ["sphere", "palm"].filter((name) => trial.bodies.includes(name) && `${name}.x [m]` in table[0]);
  check("sphere and palm are in page and table", bodies.length === 2, bodies.join());
  const slider = await rectOf(browser, "#slider");
  const ticks = new Set();
  let compared = 0;
  const wrong = [];
  for (const share of [0.08, 0.3, 0.52, 0.7, 0.94]) {
    await browser.drag([[slider.left + share * slider.width, slider.top + slider.height / 2]]);
    await settled(browser);
    const found = await browser.run((bodies) => ({ tick: farsa.tick, time: farsa.time, clock: document.querySelector("#clock").textContent, poses: bodies.map((b) => farsa.pose(0, b)) }), bodies);
    ticks.add(found.tick);
    const row = table[found.tick];
    check(`the slider at ${share}: tick ${found.tick}`, Math.abs(found.tick - share * (table.length - 1)) < 0.03 * table.length && found.clock.includes(`tick ${found.tick} of`), found.clock);
    check(`tick ${found.tick}: the time is the table's`, close(found.time, Number(row["time [s]"]), 1e-6 * (1 + found.time)), found.time);
    bodies.forEach((body, i) => {
      const way = ["x", "y", "z"].map((axis, k) => Math.abs(found.poses[i].position[k] - Number(row[`${body}.${axis} [m]`])));
      check(`tick ${found.tick}: ${body} within ${(unit * 1e3).toFixed(4)} mm of the table's place`, Math.max(...way) <= unit * 1.01 + 1e-7, way.join());
    });
    const channels = await shownValues(browser);
    for (const { group, name, text, unit } of channels) {
      const titles = [name, `${name} [${unit}]`, `${group}.${name}`, `${group}.${name} [${unit}]`];
      const title = titles.find((title) => title in row);
      if (!title) continue;
      compared++;
      const channel = trial.channels.find((c) => c.group === group && c.name === name);
      const value = Number(row[title]);
      if (channel.words) {
        if (text !== channel.words[value] && text !== row[title]) wrong.push(`${title} ${text} for ${row[title]}`);
      } else if (Number.isNaN(value)) {
        if (text !== "–") wrong.push(`${title} ${text} for NaN`);
      } else {
        const digits = text.split(".")[1]?.length ?? 0;
        if (!close(Number(text), value, channel.scale / 2 + 0.5 * 10 ** -digits + 1e-6 * Math.abs(value))) wrong.push(`${title} ${text} for ${row[title]}`);
      }
    }
  }
  check("five places of the slider are five ticks", ticks.size === 5);
  check(`${compared} values in the strips are the table's, at least ten at each tick`, compared >= 50 && wrong.length === 0, wrong.slice(0, 5).join(", "));
  await silent(browser, "scrubbing");
}

async function handled(browser, url, trial) {
  await opened(browser, url, { motion: "no-preference" });
  // Firefox keeps to what its session prefers: less motion.
  if (isFirefox) await browser.run(() => farsa.play());
  check("it plays by itself", await browser.run(() => farsa.playing));
  const before = await browser.run(() => farsa.tick);
  await browser.until((before) => farsa.tick > before + 5, before);
  const click = async (selector) => {
    const { left, top, width, height } = await rectOf(browser, selector);
    await browser.drag([[left + width / 2, top + height / 2]]);
    await settled(browser);
  };
  await click("#play");
  const stopped = await browser.run(() => [farsa.playing, farsa.tick]);
  await sleep(300);
  check("pause stops", !stopped[0] && (await browser.run(() => farsa.tick)) === stopped[1]);
  await browser.run(() => farsa.seek(10));
  await click("#forward");
  await click("#forward");
  await click("#back");
  check("steps go forward and back", (await browser.run(() => farsa.tick)) === 11);
  await browser.run(() => (farsa.speed = 4));
  await browser.run(() => (farsa.seek(farsa.ticks - 20), farsa.play()));
  await browser.until(() => !farsa.playing);
  check("it stops at the end", await browser.run(() => farsa.tick === farsa.ticks - 1));
  await browser.run(() => (farsa.speed = 1));

  const state = () => browser.run(() => [farsa.tick, farsa.playing, farsa.speed, farsa.view, ...["forces", "trails"].map((id) => document.querySelector(`#${id}`).ariaPressed)].join());
  await browser.keys(KEY.home);
  await browser.keys(KEY.right + KEY.right + KEY.right + KEY.left);
  const start = await state();
  check("keys: home and arrows", start.startsWith("2,false,1,"), start);
  await browser.keys("+trf");
  const keyed = (await state()).split(",");
  const earlier = start.split(",");
  check("keys: + t r f", keyed[2] === "2" && keyed.slice(3).every((x, i) => x !== earlier[3 + i]), keyed.join());
  await browser.keys("-trf");
  check("keys: - and back again", (await state()) === start, await state());
  await browser.keys(" ");
  check("keys: space plays", await browser.run(() => farsa.playing));
  await browser.keys(" ");
  check("keys: space pauses", !(await browser.run(() => farsa.playing)));
  await browser.keys(KEY.end);
  check("keys: end", await browser.run(() => farsa.tick === farsa.ticks - 1));
  await browser.keys("?");
  check("keys: ? shows the keys", await browser.run(() => document.querySelector("#keys").open));
  await browser.keys(KEY.escape);
  const dark = await browser.run(() => document.documentElement.dataset.theme);
  await click("#theme");
  check("the button changes dark and light", (await browser.run(() => document.documentElement.dataset.theme)) !== dark);

  const plot = await rectOf(browser, ".plot");
  await browser.drag([[plot.left + plot.width / 4, plot.top + plot.height / 2]]);
  await settled(browser);
  const quarter = await browser.run(() => farsa.tick / (farsa.ticks - 1));
  check("a click on a strip seeks", Math.abs(quarter - 0.25) < 0.02, quarter);
  await browser.drag([[plot.left + plot.width / 4, plot.top + plot.height / 2], [plot.left + plot.width / 2, plot.top + plot.height / 2], [plot.left + plot.width * 0.75, plot.top + plot.height / 2]]);
  await settled(browser);
  const [at, cursor] = await browser.run(() => [farsa.tick / (farsa.ticks - 1), document.querySelector("#cursor").getBoundingClientRect().left]);
  check("dragging along a strip seeks", Math.abs(at - 0.75) < 0.02, at);
  check("the cursor stands there", Math.abs(cursor + 1 - (plot.left + at * plot.width)) < 2, cursor);

  const scene = await rectOf(browser, ".scene");
  const [x, y] = [(scene.left + scene.right) / 2, (scene.top + scene.bottom) / 2];
  const seen = () => browser.run((p) => farsa.project(p), trial.position_origin);
  const views = [await seen()];
  for (const act of [() => browser.drag([[x, y], [x + 60, y + 20]]), () => browser.drag([[x, y], [x + 60, y]], { button: 2 }), () => browser.wheel(x, y, 300)]) {
    await act();
    await settled(browser);
    views.push(await seen());
  }
  const moved = views.slice(1).map((v, i) => Math.hypot(v.x - views[i].x, v.y - views[i].y) > 3);
  check("drag turns, right drag moves, the wheel zooms", moved.every(Boolean), moved.join());
  await browser.keys("c");
  await settled(browser);
  const back = await seen();
  check("c brings the camera back", Math.hypot(back.x - views[0].x, back.y - views[0].y) < 1);
  await looked(browser, scene);
  // A slow renderer shows few frames of a film.
  await browser.run(() => farsa.seek(0));
  await click("#record");
  check("a film begins", await browser.run(() => farsa.playing && document.querySelector("#record").ariaPressed === "true"));
  await browser.until(() => farsa.tick > 0);
  await click("#record");
  await browser.until(() => farsa.filmed > 0);
  check("and the film is over", await browser.run(() => !farsa.playing && document.querySelector("#record").ariaPressed === "false"));

  if (trial.network) {
    const graph = await rectOf(browser, "#graph");
    const node = await browser.run(() => farsa.trials[0].network.nodes.map(({ x, y, name }) => ({ x, y, name })).at(-1));
    await browser.drag([[graph.left + node.x, graph.top + node.y]]);
    await settled(browser);
    const about = await browser.run(() => document.querySelector("#about").textContent);
    const numbers = await browser.run(() => [...document.querySelectorAll("#about tr:not(.soft) td:nth-child(2)")].map((cell) => Math.abs(Number(cell.textContent))));
    check("the strongest link comes first", numbers.length > 2 && numbers.slice(1, 6).every((x, i) => x <= numbers[i]), numbers.join());
    check("a click on a node tells its name and its links", about.includes(node.name) && /strongest in \(\d+\)/.test(about), about);
  }
  await browser.run(() => document.querySelector(".fold").click());
  await tabbed(browser, "page");
  check("a group folds", await browser.run(() => document.querySelector(".rows").hidden && document.querySelector(".fold").ariaExpanded === "false"));
  await silent(browser, "mouse and keys");
}

// The camera by name and by what it follows, and the mouse in the scene.
async function looked(browser, scene) {
  const middle = { x: (scene.left + scene.right) / 2, y: (scene.top + scene.bottom) / 2 };
  const at = (body = "sphere") => browser.run((body) => farsa.project(farsa.pose(0, body).position), body);
  const choose = async (id, value) => {
    await browser.run((id, value) => {
      const list = document.getElementById(id);
      list.value = value;
      list.dispatchEvent(new Event("change"));
    }, id, value);
    await settled(browser);
  };
  const away = (a, b) => Math.hypot(a.x - b.x, a.y - b.y);
  const seen = [];
  for (const name of ["overview", "three-quarter", "front", "side", "top", "close"]) {
    await choose("camera", name);
    seen.push(await at());
    check(`camera ${name}: the page says so`, await browser.run((name) => document.querySelector("#camera").value === name && farsa.view === (name === "top" ? "top" : "free"), name));
  }
  check("every camera looks from elsewhere", seen.every((a, i) => seen.every((b, k) => i === k || away(a, b) > 2)), JSON.stringify(seen));
  await browser.run(() => farsa.seek(0));
  await choose("camera", "close");
  check("close: the thing is in the middle", away(await at(), middle) < 3, JSON.stringify([await at(), middle]));

  for (const name of ["overview", "top"]) {
    await choose("camera", name);
    // The place under the mouse stays there while it zooms.
    const place = await at();
    await browser.wheel(place.x, place.y, -400);
    await settled(browser);
    check(`${name}: the wheel zooms to the mouse`, away(await at(), place) < 8, JSON.stringify([await at(), place]));
    await browser.run((p) => document.querySelector(".scene").dispatchEvent(new MouseEvent("dblclick", { clientX: p.x, clientY: p.y })), place);
    await settled(browser);
    check(`${name}: a double click brings it into the middle`, away(await at(), middle) < 40, JSON.stringify([await at(), middle]));
  }

  await choose("camera", "overview");
  // The palm always moves; the sphere does where it is touched.
  await choose("follow", "palm");
  for (const share of [0, 0.4, 0.99]) {
    await browser.run((share) => farsa.seek(Math.round(share * (farsa.ticks - 1))), share);
    await settled(browser);
    check(`followed, at ${share}: the body stays in the middle`, away(await at("palm"), middle) < 3, JSON.stringify(await at("palm")));
  }
  await choose("follow", "");
  await browser.run(() => farsa.seek(0));
  await settled(browser);
  const left = await at("palm");
  await browser.run(() => farsa.seek(farsa.ticks - 1));
  await settled(browser);
  check("left alone it moves in the picture", away(await at("palm"), left) > 10, JSON.stringify([await at("palm"), left]));
  await choose("camera", "overview");
}

// Strips of invented values: what is constant lies in the middle, whole numbers are told whole, rounding fills no strip.
async function scales(browser) {
  const trial = arenaTrial(0);
  const ticks = trial.times.length;
  const add = (name, value, more = {}) => trial.channels.push({ group: "scales", name, unit: "", values: Array.from({ length: ticks }, (_, t) => value(t)), ...more });
  add("a name longer than others", () => 0.25);
  add("counted", (t) => t % 4);
  add("nearly one", (t) => 1 + 1e-7 * (t % 2));
  add("state", (t) => t % 3, { words: ["waits", "goes", "sleeps"] });
  await opened(browser, write("scales.html", compose(pageOf([trial], "top"))));
  await browser.run(() => (farsa.seek(7), document.querySelector("[data-group=scales]").scrollIntoView()));
  await settled(browser);
  const rows = await browser.run(() => Object.fromEntries([...document.querySelectorAll("[data-group=scales] .row")].map((row) => {
    const [name, canvas] = [row.querySelector(".name"), row.querySelector(".plot")];
    const { width, height } = canvas;
    const pixels = canvas.getContext("2d").getImageData(0, 0, width, height).data;
    const used = Array.from({ length: height }, (_, y) => y).filter((y) => pixels[4 * (y * width + (width >> 1)) + 3] > 60);
    return [row.dataset.name, { text: row.querySelector(".value").textContent, scale: [...row.querySelectorAll(".unit")].at(-1).textContent, clipped: name.scrollWidth > name.clientWidth, middle: (used[0] + used.at(-1)) / 2 / height, tall: (used.at(-1) - used[0]) / height }];
  })));
  const constant = rows["a name longer than others"];
  check("a constant is drawn in the middle, and told once", Math.abs(constant.middle - 0.5) < 0.1 && constant.scale === "0.25", JSON.stringify(constant));
  check("a long name is shown whole", !constant.clipped);
  check("whole numbers are told whole", rows.counted.text === "3" && rows.counted.scale === "0 … 3", JSON.stringify(rows.counted));
  check("rounding does not fill a strip", rows["nearly one"].tall < 0.3, JSON.stringify(rows["nearly one"]));
  const legend = await browser.run(() => [...document.querySelectorAll("[data-group=scales] .key")].map((key) => [key.textContent, key.firstChild.style.background]));
  check("bands have a legend", legend.map((key) => key[0]).join() === "waits,goes,sleeps" && new Set(legend.map((key) => key[1])).size === 3, JSON.stringify(legend));
  await silent(browser, "scales");
}

// What has a label is shown by it and known by its name.
async function labelled(browser) {
  const hostile = '<img src=x onerror="window.struck = 1">';
  const labels = { J1: "shoulder adduction", J4: "elbow extension", J7: hostile, "J4.agonist": "elbow flexor", "torque J1": "forearm supination torque" };
  const trials = [armTrial(0), armTrial(1)];
  for (const channel of trials.flatMap((trial) => trial.channels)) {
    if (channel.name in labels) channel.label = labels[channel.name];
    if (channel.name === "ds") channel.about = "distance to the target";
  }
  await opened(browser, write("labels.html", compose(pageOf(trials))));
  const rows = () => browser.run(() => [...document.querySelectorAll(".row")].map((row) => {
    const name = row.querySelector(".name");
    return { group: row.parentNode.parentNode.dataset.group, name: row.dataset.name, text: name.title || name.textContent, title: row.title, clipped: name.scrollWidth > name.clientWidth };
  }));
  for (const other of [null, 1]) {
    await browser.run((other) => farsa.show(0, other), other);
    await settled(browser);
    const [named, plain] = [[], []];
    for (const row of await rows()) (row.name in labels ? named : plain).push(row);
    const what = other === null ? "a trial" : "two trials";
    // J1, J4 and J7 are joints and sensors.
    check(`${what}: strips show labels`, named.length === 8 && named.every(({ name, text }) => text === labels[name]), JSON.stringify(named));
    check(`${what}: and have the names at the pointer`, named.every(({ group, name, title }) => title.startsWith(`${group} ${name} within `)), JSON.stringify(named));
    const explained = plain.find(({ name }) => name === "ds").title;
    check(`${what}: an explanation is at the pointer`, /^fitness ds within .* cm: distance to the target$/.test(explained), explained);
    check(`${what}: labels are shown whole`, named.every(({ clipped, text }) => !clipped || text === hostile), JSON.stringify(named));
    check(`${what}: what has no label is shown by its name`, plain.length > 80 && plain.every(({ name, text }) => name.endsWith(text) && text), JSON.stringify(plain));
  }
  const values = await browser.run(() => {
    let told = "a value";
    try {
      farsa.value(0, "elbow extension");
    } catch (error) {
      told = error.message;
    }
    return [Number.isFinite(farsa.value(0, "J4", "joint")), told];
  });
  check("values are found by names alone", values.join() === "true,there is no elbow extension", values.join());
  const chosen = (name) => browser.run((name) => {
    const list = document.querySelector("#node");
    list.value = farsa.trials[0].network.nodes.findIndex((node) => node.name === name);
    list.dispatchEvent(new Event("change"));
    return { option: list.selectedOptions[0].textContent, title: document.querySelector("#about h3").firstChild.data, text: document.querySelector("#about p").textContent };
  }, name);
  for (const name of ["J4.agonist", "J7", "J2"]) {
    const { option, title, text } = await chosen(name);
    const label = labels[name] ?? name;
    check(`node ${name}: it is called ${label}, and its name is told`, option === label && title === label && text.startsWith(name) === name in labels, JSON.stringify({ option, title, text }));
  }
  const [struck, images] = await browser.run(() => [window.struck, document.querySelectorAll("img").length]);
  check("a hostile label is text", struck == null && images === 0, `${struck} ${images}`);
  await silent(browser, "labels");
}

// Names that anatomy gives are long: on low screens, too, they are read in strips and network, if not whole then from both ends.
async function lettered(driver) {
  const labels = { J1: "shoulder adduction", J3: "internal rotation", J5: "forearm supination", "J1.agonist": "shoulder abductor", "J1.antagonist": "shoulder adductor",
    "J5.agonist": "forearm supinator", "torque J1": "shoulder adduction torque", "torque J5": "forearm supination torque", "torque J7": "shoulder extensor length" };
  const trials = [armTrial(0), armTrial(1)];
  for (const channel of trials.flatMap((trial) => trial.channels)) if (channel.name in labels) channel.label = labels[channel.name];
  const url = write("lettered.html", compose(pageOf(trials)));
  for (const [size, phone] of [[[900, 500], false], [[844, 390], true]]) {
    const browser = await driver.open({ size, phone });
    try {
      await opened(browser, url);
      for (const other of [null, 1]) {
        const what = `names at ${size.join("x")}, ${other === null ? "a trial" : "two trials"}`;
        await browser.run((other) => farsa.show(0, other), other);
        await settled(browser);
        const rows = await browser.run(() => [...document.querySelectorAll(".row")].map((row) => {
          const name = row.querySelector(".name");
          return { name: row.dataset.name, text: name.textContent, title: name.title, clipped: name.scrollWidth > name.clientWidth };
        }));
        const wrong = rows.filter(({ name, text, title, clipped }) => {
          const whole = labels[name] ?? (title || text);
          const [begin, end] = text.split("…");
          return clipped || (end === undefined ? text !== whole : title !== whole || begin.length < 2 || end.length < 2 || !whole.startsWith(begin) || !whole.endsWith(end));
        });
        check(`${what}: no strip's is cut off, and the pointer has what is not shown whole`, rows.length > 90 && wrong.length === 0, JSON.stringify(wrong.slice(0, 4)));
        check(`${what}: most are shown whole`, rows.filter(({ title }) => !title).length > (other === null ? 0.97 : 0.85) * rows.length, rows.filter(({ title }) => title).map(({ text }) => text).join());
      }
      const drawn = await browser.run(() => new Promise((done) => {
        const own = document.querySelector("#graph").getContext("2d");
        const texts = [];
        own.fillText = (...all) => (texts.push(all[0]), CanvasRenderingContext2D.prototype.fillText.apply(own, all));
        farsa.seek(farsa.tick + 5);
        requestAnimationFrame(() => requestAnimationFrame(() => (delete own.fillText, done(texts))));
      }));
      const wanted = Object.entries(labels).filter(([name]) => !name.startsWith("torque")).map(([, label]) => label);
      const missing = wanted.filter((label) => !drawn.includes(label));
      check(`names at ${size.join("x")}: the network's are whole`, drawn.length > 50 && missing.length === 0, `${missing} of ${drawn}`);
      await browser.run(() => document.querySelector("[data-group=actuator]").scrollIntoView());
      await settled(browser);
      if (shots) writeFileSync(join(shots, `names-${size.join("x")}.png`), await browser.screenshot());
      await silent(browser, `names at ${size.join("x")}`);
    } finally {
      await browser.close();
    }
  }
}

// What lies on the ground and what is shown at times are seen when they are there, and only then.
async function foraged(browser) {
  const trial = foragingTrial();
  const name = "foraging";
  await browser.go("about:blank");
  await opened(browser, write("foraging.html", compose(pageOf([trial], "top"))));
  await browser.run(() => ["trails", "rays"].forEach((id) => document.querySelector(`#${id}`).click()));
  const { size: [columns, rows], ground: [x, y, u, v], at } = CELLS;
  const places = Array.from({ length: 20 }, (_, k) => [x + ((k % columns) + 0.5) / columns * (u - x), y + (Math.floor(k / columns) + 0.5) / rows * (v - y), 0]);
  const shown = [];
  let seen = 0;
  for (const tick of [0, 14, 15, 60, 160, 199, 200, 299, 320, 399]) {
    await browser.run((tick) => farsa.seek(tick), tick);
    const { picture } = await pictured(browser, `${name.replace("#", "-")}-${tick}`);
    const colour = async (place) => {
      const { x, y } = await browser.run((place) => farsa.project(place), place);
      return picture.pixel(Math.round(x), Math.round(y));
    };
    const wrong = [];
    for (const [k, place] of places.entries()) {
      if (trial.poses[tick].some(({ position }) => Math.hypot(position[0] - place[0], position[1] - place[1]) < 0.12)) continue;
      const [r, g, b] = await colour(place);
      const [red, green] = at(tick, k);
      if ((r - Math.max(g, b) > 60) !== red > 0 || (g - Math.max(r, b) > 60) !== green > 0) wrong.push(`${k}: ${[r, g, b]}`);
      seen++;
    }
    check(`${name}: what lies on the ground at tick ${tick}`, wrong.length === 0, wrong.join(" "));
    const [r, g, b] = await colour(trial.poses[tick][0].position);
    const load = trial.channels.at(-1).values[tick];
    shown.push(load >= 1 && load <= 2);
    check(`${name}: the ball at tick ${tick} is ${shown.at(-1) ? "" : "not "}shown`, (Math.min(r, b) - g > 60) === shown.at(-1), [r, g, b].join());
  }
  check(`${name}: ${seen} cells were seen, and the ball with and without`, seen > 170 && shown.includes(true) && shown.includes(false), `${seen} ${shown}`);
  check(`${name}: what lies on the ground is not beside the strips`, await browser.run(() => document.querySelector("#images").hidden));
  await silent(browser, name);
  const data = pageOf([trial], "top");
  data.episodes[0].blocks.ground_pixels = data.episodes[0].bytes;
  await opened(browser, write("foraging-damaged.html", compose(data)));
  const error = await browser.run(() => farsa.error);
  check(`${name}: changes that are not there are damage`, /ground_pixels of trial 0 is out of range/.test(error), error);
  await browser.log();
}

// ---- The picture.

// The scene as it is seen, without words and controls.
async function pictured(browser, name = "") {
  await browser.run(() => document.querySelectorAll("#tools, figcaption, .labels").forEach((one) => (one.style.visibility = "hidden")));
  await settled(browser);
  const png = await browser.screenshot();
  if (shots && name) writeFileSync(join(shots, `${name}.png`), png);
  return { picture: decode(png), scene: await rectOf(browser, ".scene") };
}

const CAMERAS = ["overview", "three-quarter", "front", "side", "top", "close"];

// Every camera shows the scene.
async function cameras(browser, name, data) {
  await opened(browser, write(`cameras-${name}.html`, compose(data)));
  await browser.run(() => farsa.seek(Math.round(farsa.ticks * 0.7)));
  for (const camera of CAMERAS) {
    await browser.run((camera) => farsa.setView(camera), camera);
    const { picture, scene } = await pictured(browser, `${name}-${camera}`);
    const colours = coloursIn(picture, scene);
    check(`${name} ${camera}: the scene has ${colours} colors`, colours > 100);
  }
  await silent(browser, `cameras of ${name}`);
}

// A double click centers a body, and a recording of the scene is a file.
async function filmed(browser) {
  await opened(browser, write("filmed.html", compose(pageOf([armTrial(0)]))));
  const scene = await rectOf(browser, ".scene");
  const middle = { x: (scene.left + scene.right) / 2, y: (scene.top + scene.bottom) / 2 };
  const at = () => browser.run(() => farsa.project(farsa.pose(0, "sphere").position));
  const away = ({ x, y }) => Math.hypot(x - middle.x, y - middle.y);
  const before = away(await at());
  await browser.run((p) => document.querySelector(".scene").dispatchEvent(new MouseEvent("dblclick", { clientX: p.x, clientY: p.y })), await at());
  await settled(browser);
  check("a double click brings a thing into the middle", before > 40 && away(await at()) < 40, `${before} ${away(await at())}`);
  await browser.run(() => farsa.seek(farsa.ticks - 20));
  // Brightness of the middle of each film's first frame.
  await browser.run(() => {
    const { drawImage } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.drawImage = function (image, ...place) {
      drawImage.call(this, image, ...place);
      if (image.className === "scene") window.lit ??= this.getImageData(this.canvas.width >> 1, this.canvas.height >> 1, 1, 1).data.slice(0, 3).reduce((a, b) => a + b);
    };
  });
  await browser.run(() => document.querySelector("#record").click());
  check("a film is a file", (await browser.until(() => farsa.filmed)) > 1000);
  const lit = await browser.run(() => window.lit);
  check("its first frame shows the scene", lit > 30, lit);
  await silent(browser, "filmed");
}

// Trails are seen where bodies were, and fainter where they will be.
async function trailed(browser) {
  const name = "trails";
  await browser.go("about:blank");
  await opened(browser, write("trails.html", compose(pageOf([arenaTrial(0)], "top"))));
  await browser.run(() => farsa.seek(250));
  const compared = async (camera) => {
    await browser.run((camera) => farsa.setView(camera), camera);
    const pictures = [];
    for (const on of [true, false]) {
      await browser.run((on) => document.querySelector("#trails").ariaPressed === String(on) || document.querySelector("#trails").click(), on);
      pictures.push((await pictured(browser, `${name}-${camera}-${on}`)).picture);
    }
    const places = await browser.run(() => {
      const { path, body } = farsa.trials[0].trails.find((trail) => !trail.thing);
      const here = farsa.trials[0].pose(farsa.tick, body).position;
      return path.filter(({ at }) => Math.hypot(...at.map((x, i) => x - here[i])) > 0.15).map(({ t, at }) => ({ past: t <= farsa.tick, ...farsa.project(at) }));
    });
    const changes = (past) => places.filter((place) => place.past === past).map(({ x, y }) => {
      const [a, b] = pictures.map((picture) => picture.pixel(Math.floor(x), Math.floor(y)));
      return a.reduce((sum, value, i) => sum + Math.abs(value - b[i]), 0);
    });
    const [past, rest] = [changes(true), changes(false)];
    const seen = (some) => some.filter((change) => change > 10).length / some.length;
    const mean = (some) => some.reduce((sum, change) => sum + change, 0) / some.length;
    const told = [past.length, rest.length, seen(past), seen(rest), mean(past), mean(rest)].join();
    check(`${name} ${camera}: the way is seen where the body was`, past.length > 100 && seen(past) > 0.9, told);
    check(`${name} ${camera}: and fainter where it will be`, rest.length > 50 && seen(rest) > 0.8 && mean(rest) < 0.8 * mean(past), told);
  };
  for (const camera of ["top", "side"]) await compared(camera);
  // A lost and restored context draws the same scene.
  await browser.run(() => (window.lost = document.querySelector(".scene").getContext("webgl2").getExtension("WEBGL_lose_context")).loseContext());
  await settled(browser);
  await browser.run(() => lost.restoreContext());
  await settled(browser);
  await compared("top");
  check(`${name}: no uncaught exception`, !(await browser.log()).some((line) => /SEVERE/.test(line)) && (await browser.run(() => farsa.error === null)));
}

async function looks(driver, url, name, size, phone) {
  const browser = await driver.open({ size, phone });
  try {
    for (const scheme of ["dark", "light"]) {
      const title = `${name} at ${size.join("x")}, ${scheme}`;
      await opened(browser, url, { scheme });
      await browser.run(() => farsa.seek(Math.round(farsa.ticks * 0.7)));
      await settled(browser);
      const png = await browser.screenshot();
      if (shots) writeFileSync(join(shots, `${name}-${size.join("x")}-${scheme}.png`), png);
      const picture = decode(png);
      const ratio = picture.width / size[0];
      const scene = await rectOf(browser, ".scene");
      const colours = coloursIn(picture, Object.fromEntries(Object.entries(scene).map(([k, v]) => [k, v * ratio])));
      check(`${title}: the scene has ${colours} colours`, colours > 300);
      if (size[1] > 560 && size[0] > 820) check(`${title}: the scene has 60 % of the height`, scene.height >= 0.6 * size[1], scene.height / size[1]);
      // Words in the scene stand beside its middle, which they would hide.
      const [caption, tools] = [await rectOf(browser, "figcaption"), await rectOf(browser, "#tools")];
      const free = (caption.top - tools.bottom) / scene.height;
      check(`${title}: two thirds of the scene are free of words`, free > 0.66, free);
      const strips = await rectOf(browser, "#strips");
      const drawn = coloursIn(picture, { left: 0, right: picture.width, top: strips.top * ratio, bottom: Math.min(strips.bottom, size[1]) * ratio });
      check(`${title}: the strips are drawn, ${drawn} colours`, drawn > 30);
      const [wide, parts, low] = await browser.run(() => [
        document.documentElement.scrollWidth,
        ["header", "#stage", ".scene", "#tools", "#transport", "#slider", "#clock", "#strips", ".plot", "aside", "#graph"].flatMap((s) => [...document.querySelectorAll(s)].map((e) => [s, e.getBoundingClientRect()]))
          .filter(([, r]) => r.width && (r.left < -0.5 || r.right > innerWidth + 0.5)).map(([s]) => s),
        [...document.querySelectorAll("button, select, input")].filter((e) => e.offsetHeight && e.offsetHeight < 32).map((e) => e.id || e.textContent),
      ]);
      check(`${title}: nothing is wider than the screen`, wide <= size[0] && parts.length === 0, `${wide} ${parts}`);
      check(`${title}: the controls are at least 32 pixels high`, low.length === 0, low.join());
      const small = await browser.run(() => [...document.querySelectorAll("#app *")].filter((e) => e.offsetHeight && [...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()) && (parseFloat(getComputedStyle(e).fontSize) || 12) < 12).map((e) => e.tagName + e.className));
      check(`${title}: no text is smaller than 12 pixels`, small.length === 0, small.slice(0, 3).join());

      // The sphere is drawn where it is: orange at its place, at the first tick, when nothing holds it.
      if (scheme === "light" && (await browser.run(() => farsa.trials[0].bodies.includes("sphere")))) {
        await browser.run(() => farsa.seek(0));
        await settled(browser);
        const first = decode(await browser.screenshot());
        const at = await browser.run(() => farsa.project(farsa.pose(0, "sphere").position));
        let orange = 0;
        for (let dy = -4; dy <= 4; dy++) {
          for (let dx = -4; dx <= 4; dx++) {
            const [r, g, b] = first.pixel(Math.round(at.x * ratio) + dx, Math.round(at.y * ratio) + dy);
            if (r > g + 20 && g > b + 20) orange++;
          }
        }
        check(`${title}: the sphere is seen at its place`, orange > 40, `${orange} of 81 pixels at ${JSON.stringify(at)}`);
      }
    }
    if (phone) {
      const plot = await rectOf(browser, ".plot");
      await browser.drag([[plot.left + plot.width / 2, plot.top + plot.height / 2]], { touch: true });
      await settled(browser);
      const at = await browser.run(() => farsa.tick / (farsa.ticks - 1));
      check(`${name}: a finger on a strip seeks`, Math.abs(at - 0.5) < 0.03, at);
      const button = await rectOf(browser, "#play");
      await browser.drag([[button.left + 10, button.top + 10]], { touch: true });
      check(`${name}: a finger plays`, await browser.until(() => farsa.playing));
      await browser.run(() => farsa.pause());
      const scene = await rectOf(browser, ".scene");
      const seen = () => browser.run(() => farsa.project(farsa.trials[0].json.position_origin));
      const before = await seen();
      await browser.drag([[200, scene.top + 150], [120, scene.top + 170], [80, scene.top + 170]], { touch: true });
      await settled(browser);
      const after = await seen();
      check(`${name}: a finger turns the scene`, Math.hypot(after.x - before.x, after.y - before.y) > 3);
      await browser.run(() => window.scrollTo(0, 600));
      await settled(browser);
      const stage = await rectOf(browser, "#stage");
      check(`${name}: the scene stays in sight`, Math.abs(stage.top) < 1, stage.top);
      if (shots) writeFileSync(join(shots, `${name}-${size.join("x")}-scrolled.png`), await browser.screenshot());
    }
    await silent(browser, `${name} at ${size.join("x")}`);
  } finally {
    await browser.close();
  }
}

// ---- Pages that were cut or changed.

// A page of an invented trial with an eye, with another size.
function resizedEye(size) {
  const data = pageOf([armTrial(0)]);
  data.episodes[0].images[0].size = size;
  return compose(data);
}

async function damaged(browser, html, name) {
  const start = html.lastIndexOf(mark) + mark.length;
  const inside = (share) => html.slice(0, Math.round(start + share * (html.length - start)));
  const script = html.indexOf("<script>");
  const base = html.indexOf('"data":"', start) + 8;
  const other = (at) => html.slice(0, at) + (html[at] === "A" ? "B" : "A") + html.slice(at + 1);
  const changed = (change) => {
    const data = dataOf(html);
    change(data);
    return withData(html, data);
  };
  const cases = [
    ["cut in the style", html.slice(0, html.indexOf("<style>") + 900), /did not load completely/],
    ["cut in the body", html.slice(0, script - 400), /did not load completely/],
    ["cut in the script", html.slice(0, Math.round((script + start) / 2)), /did not load completely/],
    ["cut before the data", html.slice(0, start - mark.length), /data is missing/],
    ["cut where the data begins", html.slice(0, start), /data is missing/],
    ["cut early in the data", inside(0.05), /not valid JSON/],
    ["cut in the middle of the data", inside(0.5), /not valid JSON/],
    ["cut just before the end of the data", html.slice(0, html.lastIndexOf("</script>") - 1), /not valid JSON/],
    ["a character of the base64 changed", other(base + 20_001), /crc32/],
    ["a character that is no base64", `${html.slice(0, base + 100)}!${html.slice(base + 101)}`, /not base64/],
    ["another version", changed((d) => (d.version = 2)), /version 2/],
    ["another format", changed((d) => (d.format = "film")), /farsa-replay/],
    ["another length", changed((d) => (d.episodes[0].bytes += 4)), /bytes where/],
    ["a block out of range", changed((d) => (d.episodes[0].blocks.channels = 4 * (d.episodes[0].bytes >> 2))), /block channels .* out of range/],
    ["a block that is not there", changed((d) => delete d.episodes[0].blocks.poses), /block poses .* out of range/],
    ["contacts that are none", changed((d) => (d.episodes[0].blocks.contacts = d.episodes[0].blocks.times)), /block contacts .* out of range|cannot be shown/],
    ["an image out of range", resizedEye([9, 9000]), /image .* out of range/],
    ["an image without size", resizedEye([0, 6]), /image .* out of range/],
    ["no trial", changed((d) => (d.episodes = [])), /no trial/],
    ["no shapes", changed((d) => delete d.episodes[0].shapes), /lacks something|cannot be shown/],
    ["data that is no page", withData(html, 7), /farsa-replay/],
  ];
  for (const [what, text, message] of cases) {
    await browser.go(write("damaged.html", text));
    let said = {};
    // The message fades in, which takes longer on a busy machine.
    for (let wait = 0; !said.seen && wait < 50; wait++) {
      await sleep(wait ? 200 : 700);
      said = await browser.run(() => {
        const element = document.querySelector("#message");
        const { width, height } = element?.getBoundingClientRect() ?? {};
        return { text: element?.textContent ?? "", seen: width > 50 && height > 10 && getComputedStyle(element).opacity === "1", app: document.querySelector("#app:not([hidden])") !== null };
      });
    }
    const colours = coloursIn(decode(await browser.screenshot()), { left: 0, top: 0, right: 800, bottom: 200 });
    check(`${name}, ${what}: it says so`, said.seen && message.test(said.text) && colours > 5, `${JSON.stringify(said)} ${colours} colours`);
    const errors = (await browser.log()).filter((line) => /SEVERE/.test(line));
    check(`${name}, ${what}: no uncaught exception`, errors.length === 0, errors.join(" | "));
  }
}

async function compared(browser, html) {
  const data = dataOf(html);
  const [trial] = data.episodes;
  const url = write("two.html", withData(html, { ...data, episodes: [trial, data.episodes[1] ?? { ...trial, name: "the same again" }] }));
  await opened(browser, url);
  const options = await browser.run(() => [...document.querySelectorAll("#trial option")].length);
  check("a page of two trials offers both", options === 2, options);
  const beside = async (value) => {
    await browser.run((value) => {
      const list = document.querySelector("#beside");
      list.value = value;
      list.dispatchEvent(new Event("change"));
      farsa.seek(40);
    }, value);
    await settled(browser);
  };
  const bothColoured = async (what) => {
    const picture = decode(await browser.screenshot());
    for (const i of [0, 1]) {
      const rect = await browser.run((i) => {
        const { left, top, right, bottom } = document.querySelectorAll(".scene")[i].getBoundingClientRect();
        return { left, top, right, bottom };
      }, i);
      const colours = coloursIn(picture, rect);
      check(`${what}: view ${i} has ${colours} colours`, colours > 300);
    }
  };
  await beside("1");
  const [views, values] = await browser.run(() => [[...document.querySelectorAll("figure")].filter((f) => f.offsetWidth).length, [...document.querySelectorAll(".row")].map((r) => r.querySelectorAll(".value").length)]);
  check("beside: two views, and two values in every strip", views === 2 && values.every((n) => n === 2), views);
  await bothColoured("beside");
  if (shots) writeFileSync(join(shots, "two.png"), await browser.screenshot());
  await beside("");
  check("beside nothing: one view again", (await browser.run(() => [...document.querySelectorAll("figure")].filter((f) => f.offsetWidth).length)) === 1);
  await silent(browser, "two trials");
  // A page that says so opens with both.
  await opened(browser, write("both.html", withData(html, { ...data, episodes: [trial, data.episodes[1] ?? trial], beside: 1 })));
  check("a page opens with the trial beside that it names", (await browser.run(() => document.querySelector("#beside").value)) === "1");
  await bothColoured("opened with both");
  await silent(browser, "opened with both");
}

// Pages of earlier versions call the episodes `lives`.
async function earlier(browser) {
  const { episodes, ...rest } = pageOf([armTrial(0)]);
  await opened(browser, write("earlier.html", compose({ ...rest, lives: episodes })));
  check("the data of an earlier version are read", await browser.run(() => farsa.ready && farsa.trials.length === 1));
  await silent(browser, "earlier page");
}

async function withoutWebGL(driver, url) {
  const browser = await driver.open({ flags: ["--disable-3d-apis"] });
  try {
    await opened(browser, url);
    const [ready, text] = await browser.run(() => [farsa.ready, document.querySelector("#message").textContent]);
    check("without WebGL the page says so", !ready && text === "This page cannot be shown: it needs a browser with WebGL 2.", text);
    const severe = (await browser.log()).filter((line) => /SEVERE/.test(line));
    check("without WebGL there is no uncaught exception", severe.length === 0, severe.join(" | "));
  } finally {
    await browser.close();
  }
}

// Every control that can be seen is reached by the tab key, and none holds it.
async function tabbed(browser, name) {
  const count = await browser.run(() => {
    // From the start of the page, not from what was clicked last.
    document.body.tabIndex = -1;
    document.body.focus();
    document.body.removeAttribute("tabindex");
    window.reached = new Set();
    document.addEventListener("focusin", (event) => reached.add(event.target));
    window.controls = [...document.querySelectorAll("button, select, input, summary")].filter((one) => one.offsetHeight && one.checkVisibility() && !one.disabled);
    return controls.length;
  });
  await browser.keys(KEY.tab.repeat(count + 3));
  const missed = await browser.run(() => controls.filter((one) => !reached.has(one)).map((one) => one.id || one.textContent.slice(0, 20)));
  check(`${name}: all ${count} controls are reached by keys`, count > 10 && missed.length === 0, missed.join());
}

// ---- A page that runs its agent.

async function lives(browser) {
  await opened(browser, pathToFileURL(resolve(livePage)));
  check("a live page is up", await browser.run(() => farsa.ready && farsa.error === null && !document.querySelector("#live").hidden));
  const first = await browser.run(() => farsa.ticks);
  const press = (text) => browser.run((text) => [...document.querySelectorAll("#live button")].find((one) => one.textContent === text).click(), text);
  const status = () => browser.run(() => document.querySelector("#live p.soft").textContent);
  const until = (test) => browser.until(new Function(`return ${test}`));
  await press("Verify");
  await until("/Equal to the run|Differs/.test(document.querySelector('#live p.soft').textContent)");
  check("the trial that it runs is that of the run, to the bit", (await status()).startsWith(`Equal to the run, bit by bit: ${first} ticks`), await status());

  const cases = JSON.parse(readFileSync(lesionFile, "utf8")).cases;
  const part = cases[1].row;
  await browser.run((part) => {
    const list = document.querySelector("#live select[aria-label=Part]");
    list.value = part;
    list.dispatchEvent(new Event("change"));
  }, part);
  await press("Silence or cut");
  await until("farsa.trials.length === 2 && farsa.trials[1].name.includes('; with ')");
  const [names, views] = await browser.run(() => [farsa.trials.map((trial) => trial.name), [...document.querySelectorAll("figure")].filter((figure) => figure.offsetWidth).length]);
  check("a change runs beside the whole agent", views === 2 && names[1].endsWith(`; with ${part}`), JSON.stringify(names));
  await press("100 fresh trials");
  await until("/with the change: \\d+ of 100$/.test(document.querySelector('#live p.soft').previousSibling.textContent)");
  const earned = await browser.run(() => [...document.querySelector("#live").textContent.matchAll(/(\d+) of 100/g)].map((found) => Number(found[1])));
  check("fresh trials with the change and without are those of `farsa test --lesion`", earned.join() === cases.map((one) => one.successes).join(), `${earned} ${cases.map((one) => one.successes)}`);
  if (shots) writeFileSync(join(shots, "live.png"), await browser.screenshot());

  await browser.run(() => void farsa.live.undo());
  await until("farsa.trials.length === 1");
  const summary = await browser.run(async () => {
    const { successes } = await farsa.live.summarize(20);
    const counted = JSON.parse(JSON.stringify([successes, document.querySelectorAll("#summary path").length, document.querySelector("#summary p").textContent]));
    document.querySelectorAll("#summary path")[7].dispatchEvent(new MouseEvent("click", { bubbles: true }));
    return counted;
  });
  check("fresh trials are summarized by start", summary[1] === 20 && summary[2].startsWith(`Intact: success in ${summary[0]} of 20 fresh trials, mean fitness 0.`), summary.join());
  // A click on a start opens its trial.
  await until("farsa.trials[0].name.startsWith('fresh trial 7')");
  await browser.run((part) => farsa.live.set(part, ""), part);

  await browser.run(() => farsa.live.start({ number: 0 }));
  await press("New start");
  await until("farsa.trials.length === 2 && farsa.trials[0].name.startsWith('fresh trial 0')");
  await press("Undo all");
  await until("farsa.trials.length === 1 && farsa.trials[0].name.startsWith('fresh trial 0')");
  await browser.run(() => farsa.live.set("neuron:nobody", ""));
  check("a part that there is not is refused by name", /unknown neuron `nobody`; there are `inner 1`/.test(await status()), await status());
  check("and nothing has changed", await browser.run(() => farsa.trials.length === 1 && document.querySelectorAll("#live .chips button").length === 0));
  await browser.run(async () => (await farsa.live.set("neuron:inner 1", "0.5"), await farsa.live.set("neuron:inner 2", ""), farsa.live.set("neuron:inner 1", "much")));
  const kept = await browser.run(() => [...document.querySelectorAll("#live .chips button")].map((chip) => chip.textContent));
  check("a value that is none leaves what was there", kept.join() === "neuron:inner 1 = 0.5 ×,neuron:inner 2 ×", kept.join());
  await browser.run(() => farsa.live.undo());
  const named = await browser.run(() => {
    const { nodes } = farsa.trials[0].network;
    const list = document.querySelector("#node");
    list.value = nodes.findIndex((node) => node.layer === 1);
    list.dispatchEvent(new Event("change"));
    return document.querySelector("#live p b").textContent;
  });
  check("a node of the drawing is a part to change", /^neuron:/.test(named), named);
  const small = await browser.run(() => [...document.querySelectorAll("#live button, #live select, #live input")].filter((one) => one.offsetHeight && one.offsetHeight < 32).length);
  check("its controls are at least 32 pixels high", small === 0, small);
  await tabbed(browser, "live");
  await silent(browser, "live");

  // Names and configurations of strangers are shown as they are and do nothing.
  const hostile = '<img src=x onerror="window.struck = 1">';
  const html = readFileSync(livePage, "utf8");
  const data = dataOf(html);
  const script = { ...data.live.script, config: `${data.live.script.config}\n# ${hostile}\n` };
  await opened(browser, write("hostile.html", withData(html, { ...data, title: hostile, live: { ...data.live, script } })));
  await settled(browser);
  const [struck, title, config, images] = await browser.run(() => [window.struck, document.querySelector("#title").textContent, document.querySelector("#live pre").textContent, document.querySelectorAll("img").length]);
  check("hostile names are text", struck == null && title === hostile && config.includes(hostile) && images === 0, `${struck} ${title} ${images}`);
  await silent(browser, "hostile names");
}

// Evolution in the page is the command's, number for number.
async function evolves(browser) {
  await opened(browser, pathToFileURL(resolve(evolvingPage)));
  const log = readFileSync(evolvedLog, "utf8").trim().split("\n").slice(1).map((row) => row.split(",").map(Number));
  const known = await browser.run(() => farsa.live.rows.length);
  const press = (text) => browser.run((text) => [...document.querySelectorAll("#evolution button")].find((one) => one.textContent === text).click(), text);
  // As text: a driver may round numbers.
  const bred = await browser.run(async (count) => JSON.stringify((await farsa.live.evolve(count)).map(({ generation, line }) => [generation, ...line.row, line.evaluations, line.failed, ...line.each.flat()])), log.length - known);
  check("evolution in the page is that of `farsa run --resume`", known > 0 && log.length - known === 3 && bred === JSON.stringify(log.slice(known)), `${bred} ${JSON.stringify(log.slice(known))}`);
  const [said, points] = await browser.run(() => [document.querySelector("#evolution p").textContent, [...document.querySelectorAll("#evolution polyline")].map((line) => line.getAttribute("points").split(" ").length)]);
  check("its fitness is told and drawn", said.startsWith(`Generation ${log.length - 1}: best `) && points.join() === `${log.length},${log.length}`, `${said} ${points}`);
  await press("Show champion");
  await browser.until(new Function(`return document.querySelector("#live select").selectedOptions[0]?.textContent.startsWith("generation ${log.length - 1}, evolved here") && document.querySelector("#live p.soft").textContent === ""`));
  const champion = await browser.run(() => [farsa.trials.length, document.querySelectorAll("#live select")[0].options.length]);
  check("its champions are there to be looked at", champion[0] === 1 && champion[1] > 1, champion.join());
  await browser.run(() => farsa.pause());
  await browser.until(() => location.hash.startsWith("#agent="));
  if (shots) writeFileSync(join(shots, "evolution.png"), await browser.screenshot());
  const robots = await browser.run(() => {
    const list = document.querySelector('#live select[aria-label="Robot that is recorded"]');
    list.value = list.options[2].value;
    list.dispatchEvent(new Event("change"));
    return [...list.options].map((option) => option.textContent);
  });
  await browser.until(() => farsa.trials[0].name.endsWith("is recorded"));
  const name = await browser.run(() => farsa.trials[0].name);
  check("any robot can be recorded", robots.length === 3 && name.endsWith(`; ${robots[2]} is recorded`), `${name} ${robots}`);
  await press("Continue evolution");
  await browser.until(new Function(`return farsa.live.rows.length > ${log.length}`));
  await press("Stop");
  await browser.until(new Function(`return [...document.querySelectorAll("#evolution button")].some((one) => one.textContent === "Continue evolution" && !one.disabled)`));
  const stopped = await browser.run(() => farsa.live.rows.length);
  await new Promise((done) => setTimeout(done, 300));
  check("it stops", (await browser.run(() => farsa.live.rows.length)) === stopped);
  await tabbed(browser, "evolution");
  await silent(browser, "evolution");
}

// A run that goes on is seen in the page that is served.
async function serves(browser) {
  await opened(browser, new URL(servedPage));
  // Halted until it is looked at, so that it takes no time from the other checks.
  const told = (signal) => process.env.SERVED_RUN && process.kill(Number(process.env.SERVED_RUN), signal);
  told("SIGCONT");
  const first = await browser.run(() => farsa.live.rows.at(-1)[0]);
  await browser.until(new Function(`return farsa.live.rows.at(-1)[0] > ${first + 2} && !document.querySelectorAll("#evolution button")[1].disabled`));
  const rows = await browser.run(() => farsa.live.rows.map(([number]) => number));
  const added = rows.slice(rows.indexOf(first));
  check("a served page sees its run go on, generation after generation", added.length > 2 && added.every((number, i) => number === first + i), added.join());
  check("it does not go on by itself", await browser.run(() => document.querySelector("#evolution button").hidden));
  await browser.run(() => document.querySelectorAll("#evolution button")[1].click());
  await browser.until(new Function(`return document.querySelector("#live select").selectedOptions[0]?.textContent.includes(", new") && document.querySelector("#live p.soft").textContent === ""`));
  check("it shows the champion that the run has come to", await browser.run(() => farsa.error === null && farsa.ticks > 1));
  const found = await browser.run(() => [...document.querySelectorAll("#live select")[0].options].map((one) => one.textContent).filter((text) => text.includes(", new")));
  check("of each population", found.length === 2 && ["predator", "prey"].every((name, i) => found[i].endsWith(name)), found.join());
  if (shots) writeFileSync(join(shots, "served.png"), await browser.screenshot());
  told("SIGSTOP");
  await silent(browser, "served");
}

// A body that is pulled at is pushed for a tenth of a second, in a trial beside the one of the run.
async function pushes(browser, { press, seen }) {
  await press("Push bodies");
  const pressed = await browser.run(() => ["Move bodies", "Push bodies"].map((text) => [...document.querySelectorAll("#live button")].find((one) => one.textContent === text).getAttribute("aria-pressed")));
  check("a body is moved or pushed, not both", pressed.join() === "false,true", pressed.join());
  await browser.run(() => farsa.setView("overview"));
  await browser.run(() => farsa.seek(100));
  await settled(browser);
  const { x, y } = await seen();
  await browser.drag([[x, y], [x - 20, y + 5], [x - 60, y + 10]]);
  await browser.until(() => farsa.trials.length === 2 && document.querySelector("#live p.soft").textContent.startsWith("With the change"));
  const [name, chips] = await browser.run(() => [farsa.trials[1].name, document.querySelector("#live .chips").textContent]);
  check("the page says what was pushed, how hard and when", name.endsWith("; 1 pushed") && /^sphere pushed by [\d.]+ N at \d\.\d\d s/.test(chips), `${name} ${chips}`);
  const found = await browser.run(() => {
    const [whole, pushed] = farsa.trials;
    const step = farsa.tick + 1;
    const at = (trial, tick) => trial.pose(tick, trial.bodies.indexOf("sphere")).position;
    const outside = (tick) => pushed.contacts(tick).filter(({ pair }) => pair[1] === "outside").length;
    farsa.seek(step + 5);
    return { unit: whole.position_unit + pushed.position_unit, before: [at(whole, step - 1), at(pushed, step - 1)], way: [0, 1, 2].map((k) => at(pushed, step + 12)[k] - at(whole, step + 12)[k]), force: pushed.pushes[0].force, arrows: [outside(step - 1), outside(step), outside(step + 9), outside(step + 10)] };
  });
  const same = found.before[0].every((p, i) => Math.abs(p - found.before[1][i]) <= found.unit);
  const along = found.way.reduce((sum, w, k) => sum + w * found.force[k], 0) / Math.hypot(...found.force);
  check("a body that is pushed goes that way from the next step on", same && along > 0.002, JSON.stringify(found));
  check("the force is shown while it acts", found.arrows.join() === "0,1,1,0", found.arrows.join());
  await settled(browser);
  if (shots) writeFileSync(join(shots, "pushed.png"), await browser.screenshot());
  await press("Undo all");
  await browser.until(() => farsa.trials.length === 1);
}

// What can be done to bodies with the pointer is done by keys.
async function keyed(browser, { press }) {
  const said = () => browser.run(() => document.querySelector("#live p.soft").textContent);
  const chips = () => browser.run(() => document.querySelector("#live .chips").textContent);
  const changed = () => browser.until(() => farsa.trials.length === 2 && document.querySelector("#live p.soft").textContent.startsWith("With the change"));
  // The hand is far from the sphere then.
  await browser.run(() => (farsa.setView("overview"), farsa.seek(2)));
  await press("Move bodies");
  const choice = () => browser.run(() => {
    const list = document.querySelector("#live select[aria-label='Body that keys move or push']");
    return [list.offsetHeight > 0, list.selectedOptions[0].textContent].join();
  });
  check("keys: a thing is what is moved first", (await choice()) === "true,sphere", await choice());
  await browser.keys("]");
  check("keys: ] chooses another body and says so", (await choice()) === `true,${await said()}` && (await said()) !== "sphere", await choice());
  await browser.keys("[" + KEY.right.repeat(3));
  check("keys: arrows move it, and the page says how far", /^sphere, [\d.]+ (mm|cm): Enter applies it/.test(await said()), await said());
  await browser.keys(KEY.escape);
  await settled(browser);
  check("keys: escape leaves it", (await browser.run(() => farsa.trials.length === 1 && !farsa.trials[0].held)) && (await chips()) === "");
  check("keys: and time stands still", (await browser.run(() => farsa.tick)) === 2);

  await browser.keys(KEY.right.repeat(3) + KEY.pageUp);
  const far = await browser.run(() => farsa.trials[0].held.way);
  await browser.keys(KEY.enter);
  await changed();
  const [name, [before, same, moved]] = await browser.run(() => {
    const [whole, other] = farsa.trials;
    const at = (trial, tick) => trial.pose(tick, trial.bodies.indexOf("sphere")).position;
    return [other.name, [at(whole, farsa.tick), at(other, farsa.tick), at(other, farsa.tick + 1)]];
  });
  const off = moved.map((x, k) => x - before[k] - far[k]);
  check("keys: the body is moved as by dragging, from the next step on", Math.hypot(...far) > 0.01 && far[2] > 0 && Math.hypot(...same.map((x, k) => x - before[k])) < 1e-4 && Math.hypot(...off) < 1e-3,
    JSON.stringify([far, before, same, moved]));
  check("keys: the page says what was moved and when", name.endsWith("; 1 moved") && /^sphere moved at \d\.\d\d s/.test(await chips()), `${name} ${await chips()}`);
  await press("Undo all");
  await browser.until(() => farsa.trials.length === 1);

  await press("Push bodies");
  await browser.keys(KEY.left.repeat(5));
  const pull = await browser.run(() => farsa.trials[0].contacts(farsa.tick).filter(({ pair }) => pair.join() === "sphere,outside").length);
  check("keys: what pulls is shown as a force", pull === 1 && /^sphere, [\d.]+ N: Enter applies it/.test(await said()), `${pull} ${await said()}`);
  await browser.keys(KEY.enter);
  await changed();
  const found = await browser.run(() => {
    const [whole, pushed] = farsa.trials;
    const at = (trial) => trial.pose(farsa.tick + 13, trial.bodies.indexOf("sphere")).position;
    return { force: pushed.pushes[0].force, way: at(pushed).map((x, k) => x - at(whole)[k]), name: pushed.name };
  });
  const along = found.way.reduce((sum, w, k) => sum + w * found.force[k], 0) / Math.hypot(...found.force);
  check("keys: the body is pushed as by pulling at it", found.name.endsWith("; 1 pushed") && found.force[2] === 0 && along > 0.002 && /^sphere pushed by [\d.]+ N at/.test(await chips()), `${JSON.stringify(found)} ${await chips()}`);

  // Every one of the fresh trials meets the push.
  await browser.run(() => {
    const send = Worker.prototype.postMessage;
    window.sent = [];
    Worker.prototype.postMessage = function (message) {
      sent.push(message);
      return send.apply(this, arguments);
    };
  });
  await press("100 fresh trials");
  await browser.until(() => /with the change: \d+ of ([5-9]|\d\d) /.test(document.querySelector("#live p.soft").previousSibling.textContent));
  const asked = await browser.run(() => window.sent.map(({ act, request }) => [act, request.do, request.trial?.fresh.number ?? request.first, request.pushes?.length ?? 0].join(" ")));
  const wanted = [...Array.from({ length: 10 }, (_, k) => `ask fresh ${10 * k} 0`), ...Array.from({ length: asked.length - 10 }, (_, k) => `earned film ${k} 1`)];
  check("fresh trials with a push are pushed, those without are not", asked.length > 14 && asked.join() === wanted.join(), asked.join());
}

// The first step is shown before the trial has run, and is that of the trial.
async function begins(browser) {
  if (isFirefox) return opened(browser, pathToFileURL(resolve(armPage)));
  const source = `(() => {
    const watch = () => {
      if (!window.farsa?.trials?.length) return requestAnimationFrame(watch);
      const [trial] = farsa.trials;
      window.begun = { ticks: farsa.ticks, ready: farsa.ready, name: trial.name, shown: !document.querySelector("#app").hidden, places: trial.bodies.map((body) => farsa.pose(0, body).position) };
    };
    requestAnimationFrame(watch);
  })()`;
  const { identifier } = await browser.cdp("Page.addScriptToEvaluateOnNewDocument", { source });
  await opened(browser, pathToFileURL(resolve(armPage)));
  await browser.cdp("Page.removeScriptToEvaluateOnNewDocument", { identifier });
  const [begun, places, ticks, first, unit] = await browser.run(() => [window.begun, farsa.trials[0].bodies.map((body) => farsa.pose(0, body).position), farsa.ticks, farsa.first, farsa.trials[0].position_unit]);
  check(`a live page shows the first of ${ticks} steps before they have run, seen after ${Math.round(first)} ms`, begun.ticks === 1 && begun.ready === false && begun.shown && ticks > 1 && first > 0, JSON.stringify(begun).slice(0, 200));
  const off = Math.max(...places.map((place, i) => Math.hypot(...place.map((x, k) => x - begun.places[i][k]))));
  // In that of one step numbers have steps of their own.
  check("it is the trial's own", places.length === begun.places.length && off < 2 * unit, off);
}

// A body that is dragged is elsewhere in a trial beside the one of the run, and only then.
async function moves(browser) {
  await begins(browser);
  const press = (text) => browser.run((text) => [...document.querySelectorAll("#live button")].find((one) => one.textContent === text).click(), text);
  const poses = () => browser.run(() => farsa.trials.map((trial) => [farsa.tick, farsa.tick + 1].map((tick) => trial.pose(tick, trial.bodies.indexOf("sphere")).position)));
  const seen = () => browser.run(() => farsa.project(farsa.pose(0, "sphere").position));
  await browser.run(() => farsa.pause());
  await browser.run(() => farsa.seek(100));
  await press("Move bodies");
  await settled(browser);
  const [[before]] = await poses();
  const { x, y } = await seen();
  await browser.drag([[x, y], [x + 10, y + 4], [x + 40, y + 10]]);
  await browser.until(() => farsa.trials.length === 2 && document.querySelector("#live p.soft").textContent.startsWith("With the change"));
  const [[whole], [same, moved]] = await poses();
  const way = moved.map((at, i) => at - before[i]);
  // A film of other places has other steps between its numbers.
  const near = (other) => Math.hypot(...other.map((at, i) => at - before[i])) < 1e-4;
  check("a body that is dragged is elsewhere from the next step on", near(whole) && near(same) && Math.hypot(way[0], way[1]) > 0.01 && Math.abs(way[2]) < 0.02, JSON.stringify([before, whole, same, moved]));
  const names = await browser.run(() => [farsa.trials[1].name, document.querySelector("#live .chips").textContent]);
  check("the page says what was moved and when", names[0].endsWith("; 1 moved") && /^sphere moved at \d\.\d\d s/.test(names[1]), names.join());
  if (shots) writeFileSync(join(shots, "moved.png"), await browser.screenshot());
  // The hand hangs on the arm.
  await browser.run(() => farsa.live.put({ step: 10, body: farsa.trials[0].bodies.indexOf("palm"), position: [0, 0, 1], rotation: [0, 0, 0, 1] }));
  const said = await browser.run(() => document.querySelector("#live p.soft").textContent);
  check("a body that hangs on others says so", /palm is attached/.test(said), said);
  const [called, changed] = await browser.run(() => {
    const list = document.querySelector("#node");
    list.value = farsa.trials[0].network.nodes.findIndex((node) => node.name === "J4 agonist");
    list.dispatchEvent(new Event("change"));
    return [document.querySelector("#about h3").firstChild.data, document.querySelector("#live p b").textContent];
  });
  check("a node with a label is changed by its name", called === "elbow flexor" && changed === "output:J4 agonist", `${called} ${changed}`);
  await press("Undo all");
  await browser.until(() => farsa.trials.length === 1);
  await press("Verify");
  await browser.until(() => /Equal to the run|Differs/.test(document.querySelector("#live p.soft").textContent));
  check("without the moves the trial is that of the run again", (await browser.run(() => document.querySelector("#live p.soft").textContent)).startsWith("Equal to the run"));
  const summary = await browser.run(async () => {
    const { phases, trials } = await farsa.live.summarize(2);
    document.querySelectorAll("#summary path")[1].dispatchEvent(new MouseEvent("click", { bubbles: true }));
    return { phases, words: trials[0].words, times: trials.map(({ counts, step }) => [...counts].map((count) => count * step)) };
  });
  await browser.until(() => farsa.trials[0].name.startsWith("fresh trial 1"));
  const counted = await browser.run(() => {
    const [trial] = farsa.trials;
    const values = [...trial.channels.find(({ words }) => words).values];
    return [0, 1, 2].map((phase) => values.filter((value) => value === phase).length * (trial.times[1] - trial.times[0]));
  });
  const agree = (time, other) => Math.abs(time - other) < 0.001;
  const means = summary.phases.every(({ seconds }, i) => agree(seconds, (summary.times[0][i] + summary.times[1][i]) / 2));
  check("the summary shows the mean time in each phase", summary.words.join() === "reach,grasp,lift" && means && counted.every((time, i) => agree(time, summary.times[1][i])), JSON.stringify([summary, counted]));
  await browser.run(() => farsa.live.start({ number: 0 }));
  await browser.until(() => farsa.trials[0].name.startsWith("trial 0"));
  await pushes(browser, { press, seen });
  await keyed(browser, { press });
  await silent(browser, "moves");
}

async function withoutWebAssembly(driver) {
  const browser = await driver.open();
  try {
    await browser.cdp("Page.addScriptToEvaluateOnNewDocument", { source: "delete globalThis.WebAssembly" });
    await opened(browser, pathToFileURL(resolve(livePage)));
    const [error, seen] = await browser.run(() => [farsa.error, !document.querySelector("#message").hidden && document.querySelector("#message").textContent]);
    check("without WebAssembly a live page says so", /needs a browser with WebAssembly/.test(error) && /needs a browser with WebAssembly/.test(seen), `${error} ${seen}`);
  } finally {
    await browser.close();
  }
}

// A worker that takes its time is nothing wrong; a module that is damaged is.
async function beginning(driver) {
  const browser = await driver.open();
  try {
    const source = `globalThis.Worker = class extends Worker {
      constructor(...given) {
        super(...given);
        this.addEventListener("message", (event) => event.stopImmediatePropagation());
      }
    };`;
    const { identifier } = await browser.cdp("Page.addScriptToEvaluateOnNewDocument", { source });
    await browser.go(pathToFileURL(resolve(livePage)));
    await browser.until(() => window.farsa && document.readyState === "complete");
    // A message waits for half a second.
    await sleep(1000);
    const begun = await browser.run(() => [farsa.ready, farsa.error, document.querySelector("#message").hidden, document.querySelector("#app").hidden]);
    check("a page whose worker still begins does not say that anything is wrong", begun.join() === "false,,true,false", JSON.stringify(begun));
    await browser.cdp("Page.removeScriptToEvaluateOnNewDocument", { identifier });
    const live = readFileSync(livePage, "utf8");
    const data = dataOf(live);
    const { module } = data.live;
    const at = module.length >> 1;
    data.live.module = module.slice(0, at) + (module[at] === "A" ? "B" : "A") + module.slice(at + 1);
    await opened(browser, write("damaged-module.html", withData(live, data)));
    const [error, seen] = await browser.run(() => [farsa.error, !document.querySelector("#message").hidden && document.querySelector("#message").textContent]);
    check("a page whose module is damaged says so", /cannot be unpacked/.test(error) && /cannot be unpacked/.test(seen), `${error} ${seen}`);
  } finally {
    await browser.close();
  }
}

const invented = compose(pageOf([armTrial(0)]));
const html = page ? readFileSync(page, "utf8") : invented;
const url = page ? pathToFileURL(resolve(page)) : write("page.html", html);
const [trial] = dataOf(html).episodes;
const table = readCsv(csv ? readFileSync(csv, "utf8") : csvOf(armTrial(0)), trial);

files();
let driver;
try {
  driver = await startDriver();
  const browser = await driver.open();
  try {
    await part("arithmetic", () => arithmetic(browser));
    await part("against the table", () => against(browser, url, table, trial));
    await part("mouse and keys", () => handled(browser, url, trial));
    await part("scales", () => scales(browser));
    await part("labels", () => labelled(browser));
    await part("layout and moments", () => newcomers(browser, { check, write, opened, settled, rectOf, silent }));
    await part("meshes", () => meshes(browser, { check, write, opened, settled, rectOf, silent }));
    if (livePage) await part("live", () => lives(browser));
    if (evolvingPage) await part("evolution", () => evolves(browser));
    if (servedPage) await part("served", () => serves(browser));
    if (servedPage) await part("elsewhere", () => elsewhere(browser, servedPage, check));
    if (armPage) await part("moves", () => moves(browser));
    await part("cameras of an arm", () => cameras(browser, "arm", pageOf([armTrial(0)])));
    await part("cameras of an arena", () => cameras(browser, "arena", pageOf([arenaTrial(0)], "top")));
    await part("double click and film", () => filmed(browser));
    await part("trails", () => trailed(browser));
    await part("foraging", () => foraged(browser));
    await part("earlier page", () => earlier(browser));
    await part("two trials", () => compared(browser, html));
    // What follows needs what Chromium's driver alone can do.
    if (!isFirefox) await part("damage", () => damaged(browser, html, "page"));
  } finally {
    await browser.close();
  }
  for (const [size, phone] of [[[1280, 800], false], [[1920, 1080], false], [[900, 500], false], [[390, 844], true], [[844, 390], true]].filter(() => !isFirefox)) {
    await part("looks", () => looks(driver, url, "page", size, phone));
    await part("looks of an arena", () => looks(driver, write("arena.html", compose(pageOf([arenaTrial(0)], "top"))), "arena", size, phone));
  }
  if (livePage && !isFirefox) await part("phone", () => phoned(driver, { check, write, opened, silent, dataOf, withData }, readFileSync(livePage, "utf8")));
  if (!isFirefox) await part("names on low screens", () => lettered(driver));
  if (!isFirefox) await part("without WebGL", () => withoutWebGL(driver, url));
  if (livePage && !isFirefox) await part("without WebAssembly", () => withoutWebAssembly(driver));
  if (livePage && !isFirefox) await part("beginning", () => beginning(driver));
} catch (error) {
  check("the browser runs", false, error.message);
} finally {
  driver?.stop();
  rmSync(folder, { recursive: true, force: true });
}
console.log(failed ? `${failed} checks failed` : "all checks passed");
process.exit(failed ? 1 : 0);
