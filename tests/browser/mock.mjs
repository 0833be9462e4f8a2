// Pages of invented trials, in the format of docs/replay-format.md: what the viewer must show is known exactly.
//
//   node tests/browser/mock.mjs PAGE.html [arena]

import { readFileSync, writeFileSync } from "node:fs";
import { crc32 } from "node:zlib";

const VIEWER = new URL("../../farsa-view/src/page/viewer/", import.meta.url);
// In the order in which the page has them.
export const SCRIPTS = ["data.js", "camera.js", "scene.js", "view.js", "strips.js", "images.js", "network.js", "film.js", "player.js", "main.js"];
export const viewer = (name) => readFileSync(new URL(name, VIEWER), "utf8");
export const STYLE = viewer("palette.css") + viewer("viewer.css");

export const crc = (bytes) => {
  if (crc32) return crc32(bytes);
  let c = ~0;
  for (const byte of bytes) {
    c ^= byte;
    for (let k = 0; k < 8; k++) c = c & 1 ? (c >>> 1) ^ 0xedb88320 : c >>> 1;
  }
  return ~c >>> 0;
};

// Without indentation, comments and empty lines, as a page has it.
export const lean = (source) => source.split("\n").map((line) => line.trimStart()).filter((line) => line && !line.startsWith("//")).map((line) => `${line}\n`).join("");

// The page of some data, as the Rust writer composes it.
export function compose(data) {
  const json = JSON.stringify(data).replaceAll("<", "\\u003c");
  const title = data.title.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  const parts = { policy: "", title, style: lean(STYLE), script: lean(SCRIPTS.map(viewer).join("\n")), data: json };
  return viewer("page.html").replace(/\{\{(\w+)\}\}/g, (_, name) => parts[name]);
}

const qmul = ([a, b, c, d], [x, y, z, w]) => [
  d * x + a * w + b * z - c * y, d * y - a * z + b * w + c * x, d * z + a * y - b * x + c * w, d * w - a * x - b * y - c * z,
];
const about = (axis, angle) => [...axis.map((x) => x * Math.sin(angle / 2)), Math.cos(angle / 2)];
const turn = (q, v) => qmul(qmul(q, [...v, 0]), [-q[0], -q[1], -q[2], q[3]]).slice(0, 3);
const add = (a, b) => a.map((x, i) => x + b[i]);
const none = [0, 0, 0, 1];
// Numbers that look drawn at random and are the same every time.
const noise = (i) => { const x = Math.sin(i * 12.9898 + 4.1) * 43758.5453; return x - Math.floor(x); };
const smooth = (x) => { const u = Math.min(1, Math.max(0, x)); return u * u * (3 - 2 * u); };

// A capsule along x of the body's frame.
const alongX = (name, body, length, radius, axis = [1, 0, 0]) => ({
  name, body, role: "robot", kind: "capsule", radius, half_length: length / 2,
  position: axis.map((a) => (a * length) / 2), rotation: axis[0] ? about([0, 1, 0], Math.PI / 2) : about([1, 0, 0], -Math.PI / 2),
});

// An arm of seven joints with a hand of five fingers, that takes a sphere from a table and raises it.
export function armTrial(number) {
  const ticks = 600;
  const bodies = ["shoulder_base", "shoulder", "upper_arm", "elbow", "forearm", "wrist", "palm"];
  const parents = [-1, 0, 1, 2, 3, 4, 5];
  const offsets = [[-0.025, -0.108, 0.21], [0, 0, 0], [0, 0, 0], [0.152, 0, 0], [0, 0, 0], [0.137, 0, 0], [0, 0, 0]];
  const axes = [[0, 0, 1], [0, -1, 0], [-1, 0, 0], [0, 0, -1], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const shapes = [alongX("upper_arm", 2, 0.152, 0.025), alongX("forearm", 4, 0.13, 0.02)];
  shapes.push({ name: "palm", body: 6, role: "robot", kind: "box", half: [0.03, 0.031, 0.01], position: [0.05, 0, 0], rotation: none });
  const lengths = [[0.026, 0.022, 0.0168], [0.0259, 0.022, 0.0168], [0.0285, 0.024, 0.0168], [0.0259, 0.022, 0.0168], [0.0219, 0.019, 0.0168]];
  const bases = [[0.028, 0.02, -0.002], [0.08, 0.025, 0], [0.08, 0.008, 0], [0.08, -0.008, 0], [0.08, -0.024, 0]];
  ["thumb", "index", "middle", "ring", "little"].forEach((finger, f) => {
    let at = bases[f];
    let parent = 6;
    ["knuckle", "proximal", "middle", "distal"].forEach((part, k) => {
      const thumb = f === 0;
      bodies.push(`${finger}_${part}`);
      parents.push(parent);
      parent = bodies.length - 1;
      offsets.push(at);
      axes.push(k === 0 ? (thumb ? [1, 0, 0] : [0, 0, 1]) : thumb ? [0, 0, 1] : [0, -1, 0]);
      at = k === 0 ? (thumb ? [0, 0.01, 0] : [0, 0, 0]) : thumb ? [0, lengths[f][k - 1], 0] : [lengths[f][k - 1], 0, 0];
      if (k) shapes.push(alongX(bodies[parent], parent, lengths[f][k - 1], 0.0065 - 0.0005 * (k - 1), thumb ? [0, 1, 0] : [1, 0, 0]));
    });
  });
  bodies.push("sphere");
  shapes.push({ name: "sphere", body: 27, role: "thing", kind: "sphere", radius: 0.025, position: [0, 0, 0], rotation: none });
  shapes.push({ name: "table", body: -1, role: "ground", kind: "box", half: [0.5, 0.5, 0.1], position: [0.3, 0, -0.1], rotation: none });

  const times = Array.from({ length: ticks }, (_, t) => 0.01 * (t + 1));
  const joints = times.map((_, t) => {
    const u = t / ticks;
    const [reach, grasp, lift] = [smooth(u / 0.4), smooth((u - 0.4) / 0.2), smooth((u - 0.62) / 0.25)];
    return bodies.slice(0, 27).map((_, j) => {
      if (j < 7) {
        const from = [-0.6, -0.2, 0.5, -1.6, 0.3, 0.1, 0][j];
        const to = [0.35, -0.5, 0.15, -0.55, 0.1, 0.05, 0.1][j];
        return from + (to - from) * reach + [0, 0.35, 0, 0.1, 0, -0.15, 0][j] * lift + 0.02 * Math.sin(u * 40 + j + number);
      }
      const k = (j - 7) % 4;
      if (j < 11) return k === 0 ? -1.8 * grasp : -0.5 * grasp;
      return k === 0 ? 0 : -(0.75 + 0.1 * k - 0.05 * number) * grasp;
    });
  });
  const poses = joints.map((angles) => {
    const made = [];
    angles.forEach((angle, j) => {
      const parent = parents[j] < 0 ? { position: [0, 0, 0], rotation: none } : made[parents[j]];
      made.push({ position: add(parent.position, turn(parent.rotation, offsets[j])), rotation: qmul(parent.rotation, about(axes[j], angle)) });
    });
    return made;
  });
  const hold = [0.095, 0.012, -0.034];
  const inHand = (t) => add(poses[t][6].position, turn(poses[t][6].rotation, hold));
  const rest = [...inHand(360).slice(0, 2), 0.025];
  // The arm is too high for its table: everything of the arm comes down by what is missing.
  const down = inHand(360)[2] - 0.025;
  for (const pose of poses) for (const body of pose) body.position = add(body.position, [0, 0, -down]);
  poses.forEach((pose, t) => {
    const position = t < 360 ? rest : inHand(t);
    pose.push({ position, rotation: about([0, 0, 1], t < 360 ? 0 : 0.002 * (t - 360)) });
  });

  const pairs = [["palm", "sphere"], ["thumb_distal", "sphere"], ["index_distal", "sphere"], ["middle_distal", "sphere"], ["sphere", "table"]];
  const contacts = poses.map((pose, t) => {
    const at = pose[27].position;
    const found = [];
    if (t < 380) found.push([4, [at[0], at[1], 0], [0, 0, 0.78]]);
    if (t > 340) {
      [[0, [0, 0, 0.025]], [1, [-0.01, 0.02, -0.01]], [2, [0.02, -0.01, -0.012]], [3, [0.018, -0.012, -0.008]]].forEach(([pair, d]) => {
        found.push([pair, add(at, d), d.map((x) => x * 90 * (1 + 0.4 * Math.sin(t / 9 + pair)))]);
      });
    }
    return found;
  });
  const phase = (t) => (t < 240 ? 0 : t < 375 ? 1 : 2);
  const channels = [];
  const channel = (group, name, unit, value, more = {}) => channels.push({ group, name, unit, ...more, values: times.map((_, t) => value(t)) });
  channel("phase", "phase", "", phase, { words: ["reach", "grasp", "lift"] });
  ["reach", "grasp", "lift"].forEach((term, i) => channel("fitness", `reward.${term}`, "", (t) => (phase(t) === i ? 0.2 + 0.8 * smooth((t - 100 * i) / 300) : 0)));
  channel("fitness", "ds", "cm", (t) => 30 * Math.exp(-t / 120) + noise(number));
  channel("fitness", "height", "cm", (t) => 100 * poses[t][27].position[2]);
  channel("fitness", "energy", "J", (t) => (t < 20 ? NaN : 0.001 * t * t));
  const sensors = ["J1", "J2", "J3", "J4", "J5", "J6", "J7", "J8", "J9", "J10", "J13", "J14", "J17", "J18", "J21", "J22", "J16",
    "thumb", "index", "middle", "ring", "little", "palm", "sphere.x", "sphere.y", "sphere.z", "label.reach", "label.grasp", "label.lift"];
  const first = channels.length;
  sensors.forEach((name, i) => {
    if (i < 17) channel("sensor", name, "", (t) => 0.5 + 0.45 * Math.sin(joints[t][i % 27] * 1.4 + i), { range: [0, 1] });
    else if (i < 23) channel("sensor", name, "", (t) => (t > 340 + 4 * i && noise(t >> 4) > 0.2 ? 1 : 0), { range: [0, 1] });
    else if (i < 26) channel("sensor", name, "cm", (t) => 100 * (poses[t][27].position[i - 23] - poses[t][6].position[i - 23]));
    else channel("sensor", name, "", (t) => (phase(t) === i - 26 ? 1 : 0), { range: [0, 1] });
  });
  for (let n = 0; n < 12; n++) channel("neuron", `hidden.${n + 1}`, "", (t) => 0.5 + 0.5 * Math.sin(t / (20 + 5 * n) + n + number), { range: [0, 1] });
  for (let n = 0; n < 23; n++) {
    const name = n < 14 ? `J${(n >> 1) + 1}.${n % 2 ? "antagonist" : "agonist"}` : `servo.${n - 13}`;
    channel("output", name, "", (t) => 1 / (1 + Math.exp(-4 * Math.sin(t / (15 + 3 * n) + 2 * n))), { range: [0, 1] });
  }
  for (let j = 0; j < 27; j++) channel("joint", `J${j + 1}`, "rad", (t) => joints[t][j]);
  for (let j = 0; j < 14; j++) channel("actuator", `torque J${j + 1}`, "N m", (t) => 2 * Math.sin(t / 30 + j) * noise(j));
  pairs.forEach(([a, b], p) => channel("force", `${a} on ${b}`, "N", (t) => contacts[t].filter((c) => c[0] === p).reduce((s, c) => s + Math.hypot(...c[2]), 0)));

  const nodes = [];
  const layer = (from, count, layer) => { for (let i = 0; i < count; i++) nodes.push({ name: channels[from + i].name, layer, channel: from + i }); };
  layer(first, 29, 0);
  layer(first + 29, 12, 1);
  layer(first + 41, 23, 2);
  const links = [{ from: [0, 29], to: [29, 41], first: 0 }, { from: [29, 41], to: [29, 41], first: 348 }, { from: [29, 41], to: [41, 64], first: 492 }];
  const values = [{ name: "bias", nodes: [29, 64], first: 768 }, { name: "leak", nodes: [29, 41], first: 803 }];
  const weights = Array.from({ length: 815 }, (_, i) => (i < 803 ? 5 * (noise(i + number) * 2 - 1) ** 3 : noise(i)));
  const table = poses.map((pose) => add(pose[27].position, [0, 0, 0.05]));
  return {
    name: `invented ${number}: generation 99, individual ${5 + number}, trial 0`,
    facts: [["fitness", (812.3 + number).toFixed(1)], ["success", "yes"], ["phase at the end", "lift"], ["held [s]", "1.85"], ["highest [cm]", "11.2"],
      ["seed", "1"], ["experiment", "reach-grasp-lift <labels>"]],
    bodies, shapes, channels, pairs, points: ["reach target"], times, poses, marks: table.map((p) => [p]), contacts,
    images: [{ name: "left eye", size: [8, 6], frames: times.map((_, t) => (t < 20 ? null : Array.from({ length: 48 }, (_, k) => eyePixel(t, k, number)))) }],
    rays: times.map(() => []), network: { nodes, links, values }, weights,
  };
}

// A pixel of the eye of an arm: red, green and blue in counts of 5, 6 and 5 bits. The image changes every ten ticks.
export const eyePixel = (t, k, number) => [k % 8 === Math.floor(t / 10) % 8 ? 31 : 0, k === 0 ? 63 : 20, number ? 31 : 4];

// A wheeled robot that finds its way between walls in the plane, with distance rays.
export function arenaTrial(number) {
  const ticks = 400;
  const times = Array.from({ length: ticks }, (_, t) => 0.05 * t);
  const path = (t) => [0.6 * Math.cos(t / 60 + number) + 0.2 * Math.cos(t / 23), 0.45 * Math.sin(t / 60 + number) + 0.15 * Math.sin(t / 31), 0.03];
  const poses = times.map((_, t) => {
    const [a, b] = [path(t), path(t + 1)];
    const heading = Math.atan2(b[1] - a[1], b[0] - a[0]);
    const rotation = about([0, 0, 1], heading);
    const other = [0.3 * Math.sin(t / 90), -0.5 + 0.001 * t, 0.05];
    return [{ position: a, rotation }, { position: other, rotation: none }];
  });
  const wall = (name, half, position) => ({ name, body: -1, role: "ground", kind: "box", half, position, rotation: none });
  const shapes = [
    { name: "robot", body: 0, role: "robot", kind: "cylinder", radius: 0.055, half_length: 0.03, position: [0, 0, 0], rotation: none },
    { name: "nose", body: 0, role: "robot", kind: "sphere", radius: 0.015, color: "#d55e00", position: [0.05, 0, 0.02], rotation: none },
    { name: "prey", body: 1, role: "thing", kind: "cylinder", radius: 0.04, half_length: 0.05, position: [0, 0, 0], rotation: none },
    { name: "floor", body: -1, role: "ground", kind: "plane", position: [0, 0, 0], rotation: none },
    { name: "nest", body: -1, role: "area", kind: "cylinder", radius: 0.2, half_length: 0.001, position: [-0.6, 0.4, 0.001], rotation: none },
    { name: "food", body: -1, role: "area", kind: "box", half: [0.15, 0.15, 0.001], color: "#e6c34a", position: [0.7, -0.4, 0.001], rotation: none },
    wall("north", [1.02, 0.02, 0.08], [0, 0.82, 0.08]), wall("south", [1.02, 0.02, 0.08], [0, -0.82, 0.08]),
    wall("east", [0.02, 0.82, 0.08], [1.02, 0, 0.08]), wall("west", [0.02, 0.82, 0.08], [-1.02, 0, 0.08]),
  ];
  const rays = poses.map(([{ position, rotation }], t) => Array.from({ length: 8 }, (_, k) => {
    const direction = turn(qmul(rotation, about([0, 0, 1], ((k - 3.5) * Math.PI) / 8)), [1, 0, 0]);
    const reach = 0.15 + 0.25 * noise((t >> 3) + k);
    return { from: add(position, direction.map((x) => x * 0.055)), to: add(position, direction.map((x) => x * reach)), met: reach < 0.25 };
  }));
  const channels = [];
  for (let k = 0; k < 8; k++) channels.push({ group: "sensor", name: `ir.${k}`, unit: "", range: [0, 1], values: times.map((_, t) => (rays[t][k].met ? 1 - k / 16 : 0.1)) });
  ["left", "right"].forEach((name, k) => channels.push({ group: "output", name, unit: "", range: [-1, 1], values: times.map((_, t) => Math.sin(t / 25 + k)) }));
  return {
    name: `arena ${number}`, facts: [["fitness", "0.71"]], bodies: ["robot", "prey"], shapes, channels, pairs: [], points: ["goal"], times, poses,
    marks: times.map(() => [[0.7, -0.4, 0]]), contacts: times.map(() => []), rays, network: null, weights: [],
  };
}

// What lies in a cell of 5 times 4 at a tick, in counts of 5, 6 and 5 bits: the cells are emptied one after the other, the first one gets more.
const cellAt = (t, k) => (t < 15 * (k + 1) || (k === 0 && t >= 200) ? (k % 5 ? [0, 63, 0] : [31, 0, 0]) : [0, 0, 0]);
export const CELLS = { size: [5, 4], ground: [-0.9, 0.7, 0.9, -0.7], at: cellAt };

// The arena with what lies on its ground, and a ball that the robot has at times.
export function foragingTrial() {
  const trial = arenaTrial(0);
  const load = trial.times.map((_, t) => Math.floor(t / 50) % 4);
  const ball = { name: "load", body: 0, role: "robot", kind: "sphere", radius: 0.05, color: "#ff00ff", position: [0, 0, 0.1], rotation: none };
  const food = { name: "food", size: CELLS.size, ground: CELLS.ground, frames: trial.times.map((_, t) => Array.from({ length: 20 }, (_, k) => cellAt(t, k))) };
  const channels = [...trial.channels, { group: "food", name: "load", unit: "", values: load }];
  const shapes = [...trial.shapes.filter(({ role }) => role !== "area"), { ...ball, shown: [trial.channels.length, 1, 2] }];
  return { ...trial, name: "foraging", shapes, channels, grounds: [food] };
}

// Encodes a trial; `exact` goes along for whoever compares.
export function encode(trial) {
  const { times, poses, channels, marks, contacts, rays, weights } = trial;
  const ticks = times.length;
  const everywhere = [...poses.flat().map((p) => p.position), ...marks.flat(), ...contacts.flat().map((c) => c[1]), ...rays.flat().flatMap((r) => [r.from, r.to])];
  const low = [0, 1, 2].map((i) => everywhere.reduce((m, p) => Math.min(m, p[i]), Infinity));
  const span = Math.max(1e-9, ...[0, 1, 2].map((i) => everywhere.reduce((m, p) => Math.max(m, p[i]), -Infinity) - low[i]));
  const unit = span / 65535;
  const place = (p) => p.map((x, i) => Math.round((x - low[i]) / unit));
  const forces = contacts.flat().flatMap((c) => c[2].map(Math.abs));
  const force_unit = Math.max(1e-9, ...forces) / 32767;
  const blocks = {};
  const parts = [];
  let bytes = 0;
  const block = (name, array) => {
    blocks[name] = bytes;
    const raw = Buffer.from(array.buffer, array.byteOffset, array.byteLength);
    parts.push(raw, Buffer.alloc((4 - (raw.length % 4)) % 4));
    bytes += raw.length + parts.at(-1).length;
  };
  const signed = (x) => x & 0xffff;
  block("times", Float32Array.from(times));
  block("poses", Uint16Array.from(poses.flat().flatMap((p) => [...place(p.position), ...p.rotation.map((x) => signed(Math.round(32767 * x)))])));
  const headers = channels.map(({ values, ...head }) => {
    const finite = values.filter((x) => !Number.isNaN(x));
    const minimum = Math.min(...finite);
    // Whole numbers stay exact, as the Rust writer keeps them.
    const whole = finite.every(Number.isInteger);
    const scale = whole ? 1 : (Math.max(...finite) - minimum) / 65534;
    return { ...head, minimum, scale };
  });
  block("channels", Uint16Array.from(channels.flatMap(({ values }, c) => values.map((x) => {
    if (Number.isNaN(x)) return 65535;
    return headers[c].scale > 0 ? Math.round((x - headers[c].minimum) / headers[c].scale) : 0;
  }))));
  block("points", Uint16Array.from(marks.flat().flatMap(place)));
  block("contacts", Uint16Array.from(contacts.flatMap((some) => [some.length, ...some.flatMap(([pair, p, f]) => [pair, ...place(p), ...f.map((x) => signed(Math.round(x / force_unit)))])])));
  block("rays", Uint16Array.from(rays.flatMap((some) => [some.length, ...some.flatMap((r) => [...place(r.from), ...place(r.to), Number(r.met)])])));
  // Images are left out where there are none, as in pages of before.
  const { images } = trial;
  if (images) {
    const pixels = [];
    const starts = images.flatMap(({ frames }) => frames.map((frame) => {
      if (!frame) return 0xffffffff;
      pixels.push(...frame.map(([r, g, b]) => (r << 11) | (g << 5) | b));
      return pixels.length - frame.length;
    }));
    block("image_starts", Uint32Array.from(starts));
    block("pixels", Uint16Array.from(pixels));
  }
  const { grounds } = trial;
  if (grounds) {
    const changes = ({ frames, size: [columns, rows] }) => {
      let last = Array(columns * rows).fill(0);
      return frames.flatMap((frame) => {
        const now = frame.map(([r, g, b]) => (r << 11) | (g << 5) | b);
        const changed = now.flatMap((pixel, k) => (pixel === last[k] ? [] : [k, pixel]));
        last = now;
        return [changed.length / 2, ...changed];
      });
    };
    block("ground_pixels", Uint16Array.from(grounds.flatMap(changes)));
  }
  block("weights", Float32Array.from(weights));
  const data = Buffer.concat(parts);
  return {
    name: trial.name, facts: trial.facts, ticks, bodies: trial.bodies, shapes: trial.shapes, channels: headers, pairs: trial.pairs, points: trial.points,
    ...(images ? { images: images.map(({ name, size }) => ({ name, size })) } : {}),
    ...(grounds ? { ground_images: grounds.map(({ name, size, ground }) => ({ name, size, ground })) } : {}),
    ...(trial.network ? { network: trial.network } : {}),
    position_origin: low, position_unit: unit, force_unit, blocks, bytes, crc32: crc(data), data: data.toString("base64"),
  };
}

export const pageOf = (trials, view = "free", title = "An invented trial") =>
  ({ format: "farsa-replay", version: 1, made_by: "mock.mjs", title, view, episodes: trials.map(encode) });

// What `farsa replay` would print of the trial.
export function csvOf(trial) {
  const some = ["palm", "sphere"].filter((name) => trial.bodies.includes(name)).map((name) => [name, trial.bodies.indexOf(name)]);
  const head = ["trial", "step", "time [s]", ...some.flatMap(([name]) => ["x", "y", "z"].map((x) => `${name}.${x} [m]`)),
    ...trial.channels.map(({ group, name, unit }) => (group === "sensor" ? `sensor.${name}` : unit ? `${name} [${unit}]` : name))];
  const rows = trial.times.map((time, t) => [0, t, time, ...some.flatMap(([, b]) => trial.poses[t][b].position), ...trial.channels.map((c) => c.values[t])]);
  return [head, ...rows].map((row) => row.join(",")).join("\n") + "\n";
}

if (process.argv[1] === new URL(import.meta.url).pathname) {
  const arena = process.argv[3] === "arena";
  const trials = arena ? [arenaTrial(0), arenaTrial(1)] : [armTrial(0), armTrial(1)];
  writeFileSync(process.argv[2], compose(pageOf(trials, arena ? "top" : "free")));
}
