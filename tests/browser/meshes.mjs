// Meshes of imported models: a mesh of a box looks like the box.

import { armTrial, compose, pageOf } from "./mock.mjs";
import { decode } from "./png.mjs";

// A box as a mesh: its corners, and two triangles for each face.
const base64 = (numbers) => Buffer.from(numbers.buffer).toString("base64");
const CORNERS = Array.from({ length: 8 }, (_, i) => [1, 2, 4].map((bit) => (i & bit ? 32767 : -32767))).flat();
const FACES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].flatMap(([a, b, c, d]) => [a, b, c, a, c, d]);

export async function meshes(browser, { check, write, opened, settled, rectOf, silent }) {
  const page = pageOf([armTrial(0), armTrial(0), armTrial(0)]);
  page.episodes.slice(1).forEach((episode) => {
    episode.shapes = episode.shapes.map((shape) => (shape.kind === "box" && shape.role === "robot" ? { ...shape, kind: "mesh", mesh: 0 } : shape));
  });
  page.episodes[1].meshes = [{ points: base64(Int16Array.from(CORNERS)), triangles: base64(Uint16Array.from(FACES)) }];
  // The third episode has the meshes of the second.
  page.episodes[2].meshes = 1;
  await opened(browser, write("meshes.html", compose(page)));
  const scene = await rectOf(browser, "#views");
  const pictures = [];
  for (const i of [0, 1, 2]) {
    await browser.run((i) => (farsa.show(i), farsa.seek(40), farsa.setView("close")), i);
    await settled(browser);
    pictures.push(decode(await browser.screenshot()));
  }
  let [changed, all] = [[0, 0], 0];
  // The name of the trial is at the lower left.
  for (let y = Math.ceil(scene.top); y < scene.bottom - 40; y++) {
    for (let x = Math.ceil(scene.left); x < scene.right; x++, all++) {
      const [box, ...others] = pictures.map((picture) => picture.pixel(x, y));
      others.forEach((pixel, i) => (changed[i] += Math.max(...pixel.map((part, k) => Math.abs(part - box[k]))) > 40));
    }
  }
  const kinds = await browser.run(() => farsa.trials.map((trial) => trial.shapes.filter(({ kind }) => kind === "mesh").length));
  check("trials have the meshes of their page", kinds[0] === 0 && kinds[1] > 0 && kinds[2] === kinds[1], kinds);
  check("a mesh of a box looks like the box", changed.every((count) => count < 0.0005 * all), `${changed} of ${all} pixels differ`);
  await silent(browser, "meshes");
  page.episodes[1].meshes[0].triangles = base64(Uint16Array.from(FACES, (i) => i + 1));
  await opened(browser, write("damaged-mesh.html", compose(page)));
  const error = await browser.run(() => farsa.error);
  check("a mesh without its points is refused", error === "a mesh is out of range", error);
}
