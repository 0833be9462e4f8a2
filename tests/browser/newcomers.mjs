// What a first look at a page needs: a large scene, a moment in the address, direct inputs and the products of links.

import { armTrial, arenaTrial, compose, pageOf } from "./mock.mjs";

// A walker: two bodies that travel far beyond their own size.
function walkerTrial() {
  const trial = arenaTrial(0);
  const poses = trial.times.map((_, t) => [0, 1].map((k) => ({ position: [0.02 * t + 0.1 * k, 0, 0.3 + 0.2 * k], rotation: [0, 0, 0, 1] })));
  const part = (name, body) => ({ name, body, role: "robot", kind: "sphere", radius: 0.1, position: [0, 0, 0], rotation: [0, 0, 0, 1] });
  const floor = trial.shapes.find(({ name }) => name === "floor");
  return { ...trial, name: "walker", bodies: ["hip", "foot"], shapes: [part("hip", 0), part("foot", 1), floor], poses, rays: trial.times.map(() => []), marks: trial.times.map(() => []), points: [] };
}

// A network of two inputs, each of which is passed to a neuron, and one output.
function directTrial() {
  const trial = arenaTrial(0);
  const nodes = [0, 1, 2, 3, 8].map((channel, i) => ({ channel, layer: [0, 0, 1, 1, 2][i], name: ["left", "right", "of left", "of right", "wheel"][i] }));
  trial.network = { nodes, direct: [[0, 2], [1, 3]], links: [{ from: [2, 4], to: [4, 5], first: 0 }], values: [] };
  trial.weights = [-2, 0.5];
  return trial;
}

async function linked(browser, { check, write, opened, settled, silent }) {
  await opened(browser, write("direct.html", compose(pageOf([directTrial()], "top"))));
  await browser.run(() => farsa.seek(60));
  await settled(browser);
  const found = await browser.run(() => {
    const { nodes, links } = farsa.trials[0].network;
    const canvas = document.querySelector("#graph");
    const box = canvas.getBoundingClientRect();
    const described = links.map((link) => {
      const [x0, y0, x1, y1, x2, y2, x3, y3] = link.curve;
      const [x, y] = [(x0 + 3 * x1 + 3 * x2 + x3) / 8, (y0 + 3 * y1 + 3 * y2 + y3) / 8];
      canvas.dispatchEvent(new PointerEvent("pointermove", { pointerType: "mouse", clientX: box.left + x, clientY: box.top + y }));
      return [link.from.name, link.to.name, canvas.title, document.querySelector("#about").textContent];
    });
    return { described, in: nodes.map((node) => node.links.length), values: nodes.map((node) => farsa.trials[0].channels[node.channel].values[farsa.tick]) };
  });
  check("direct inputs have lines", found.in.join() === "1,1,2,2,2" && found.described.length === 4, JSON.stringify(found));
  const sign = (x) => (x < 0 ? "" : "+") + x.toFixed(3);
  const values = { left: found.values[0], right: found.values[1], "of left": found.values[2], "of right": found.values[3] };
  const weights = { "of left": -2, "of right": 0.5 };
  const wrong = found.described.filter(([from, to, title, about]) => {
    const product = from in weights ? `${sign(weights[from])} × ${values[from].toFixed(3)} = ${sign(weights[from] * values[from])}` : `direct × ${values[from].toFixed(3)} = ${sign(values[from])}`;
    return title !== `${from} → ${to}: ${product}` || !about.includes(product);
  });
  check("a link under the pointer shows weight times activation", wrong.length === 0, JSON.stringify(wrong));
  // More links than a call has room for arguments. Drawing them takes a software renderer a minute.
  const dense = await browser.run(() => {
    const context = document.createElement("canvas").getContext("2d");
    const links = Array.from({ length: 200_000 }, (_, i) => ({ weight: (i % 7) - 3, curve: [0, 0, 1, 1, 2, 2, 3, 3] }));
    const parts = [];
    paintLinks(context, links, links.slice(0, 7), (part) => (parts.push(part.toFixed(2)), part));
    return parts.join();
  });
  check("a network of 200 000 links has a strongest one", dense === "1.00,0.67,0.33,0.00,0.33,0.67,1.00", dense);
  await silent(browser, "direct inputs");
}

async function moments(browser, { check, write, opened, silent }) {
  const trials = [armTrial(0), armTrial(1)];
  trials.forEach((trial, i) => (trial.name = `generation 9, individual 3, trial ${i + 4}`));
  const url = write("moments.html", compose(pageOf(trials)));
  const at = () => browser.run(() => [document.querySelector("#trial").selectedOptions[0].textContent, farsa.time.toFixed(2), farsa.playing].join("; "));
  await opened(browser, `${url}#trial=5&t=2.0`, { motion: "no-preference" });
  check("a page opens at the moment in its address", (await at()) === "generation 9, individual 3, trial 5; 2.00; false", await at());
  await browser.run(() => (location.hash = "#trial=4&t=1.5"));
  await browser.until(() => farsa.time.toFixed(2) === "1.50");
  check("it follows another address", (await at()) === "generation 9, individual 3, trial 4; 1.50; false", await at());
  await browser.run(() => document.querySelector("#forward").click());
  // The address names the moment that is shown.
  await browser.until(() => location.hash === "#trial=4&t=1.51");
  await browser.run(() => (location.hash = "#trial=7&t=1"));
  await browser.until(() => !document.querySelector("#message").hidden);
  const message = await browser.run(() => document.querySelector("#message").textContent);
  check("a trial that the page does not hold is named", /trial 7/.test(message), message);
  await browser.run(() => (location.hash = "#trial=5&t=1"));
  await browser.until(() => farsa.time.toFixed(2) === "1.00" && document.querySelector("#message").hidden);
  await silent(browser, "moments");
}

async function followed(browser, { check, write, opened, settled, rectOf, silent }) {
  await opened(browser, write("walker.html", compose(pageOf([walkerTrial()]))));
  const scene = await rectOf(browser, ".scene");
  for (const share of [0, 0.5, 0.99]) {
    await browser.run((share) => farsa.seek(Math.round(share * (farsa.ticks - 1))), share);
    await settled(browser);
    const [hip, foot] = await browser.run(() => ["hip", "foot"].map((body) => farsa.project(farsa.pose(0, body).position)));
    const inside = [hip, foot].every(({ x, y }) => x > scene.left && x < scene.right && y > scene.top && y < scene.bottom);
    const tall = Math.abs(hip.y - foot.y) / scene.height;
    check(`a walker fills the picture at ${share}`, inside && tall > 0.3, JSON.stringify([hip, foot, scene]));
  }
  await silent(browser, "walker");
}

// Each robot's trail has the color of the robot.
async function colored(browser, { check, write, opened, silent }) {
  const trial = arenaTrial(0);
  trial.shapes.find(({ name }) => name === "robot").color = "#d55e00";
  Object.assign(trial.shapes.find(({ name }) => name === "prey"), { role: "robot", color: "#009e73" });
  await opened(browser, write("colors.html", compose(pageOf([trial], "top"))));
  const tints = await browser.run(() => farsa.trials[0].trails.map(({ name, tint }) => `${name} ${tint}`).sort().join());
  check("trails have the colors of their robots", tints === "prey #009e73,robot #d55e00", tints);
  await silent(browser, "colors");
}

export async function newcomers(browser, tools) {
  await linked(browser, tools);
  await moments(browser, tools);
  await followed(browser, tools);
  await colored(browser, tools);
}

// On a phone the controls of an agent come before its strips, and an agent that does not evolve offers no evolution.
export async function phoned(driver, { check, write, opened, silent, dataOf, withData }, html) {
  const browser = await driver.open({ size: [390, 844], phone: true });
  try {
    const data = dataOf(html);
    await opened(browser, write("phone.html", html));
    const tops = await browser.run(() => ["#stage", "#live", "#evolution", "#strips", "#network", "#facts"].map((part) => document.querySelector(part)).filter((part) => part.offsetHeight).map((part) => Math.round(part.getBoundingClientRect().top)));
    check("on a phone the live controls come first", tops.length > 4 && tops.every((top, i) => i === 0 || top >= tops[i - 1]) && tops[1] < 844, tops.join());
    const unevolved = { ...data.live, standing: null, about: { ...data.live.about, history: [], standstill: "nothing evolves in this experiment" } };
    await opened(browser, write("unevolved.html", withData(html, { ...data, live: unevolved })));
    check("where nothing evolves no evolution is offered", (await browser.run(() => document.querySelector("#evolution").offsetHeight)) === 0);
    // A moment of a fresh trial.
    await opened(browser, `${write("fresh.html", html)}#trial=fresh-3&t=1`);
    const at = await browser.run(() => [farsa.trials[0].name.startsWith("fresh trial 3"), farsa.time.toFixed(2)].join());
    check("a live page opens at the moment in its address", at === "true,1.00", at);
    await opened(browser, `${write("changed.html", html)}#trial=0&t=1&change=noise%3A0.1`);
    await browser.until(() => farsa.trials.length === 2 && farsa.time.toFixed(2) === "1.00");
    const chips = await browser.run(() => [...document.querySelectorAll("#live .chips button")].map((chip) => chip.textContent).join());
    check("and with the change in it", chips === "noise:0.1 ×", chips);
    await silent(browser, "live page on a phone");
  } finally {
    await browser.close();
  }
}
