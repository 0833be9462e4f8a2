// Reads the PNGs that a browser makes: 8 bits, RGB or RGBA, not interlaced.

import { inflateSync } from "node:zlib";

export function decode(png) {
  const parts = [];
  let head;
  for (let at = 8; at < png.length; ) {
    const size = png.readUInt32BE(at);
    const kind = png.toString("latin1", at + 4, at + 8);
    const body = png.subarray(at + 8, at + 8 + size);
    if (kind === "IHDR") head = body;
    if (kind === "IDAT") parts.push(body);
    at += 12 + size;
  }
  const [width, height] = [head.readUInt32BE(0), head.readUInt32BE(4)];
  const bytes = { 2: 3, 6: 4 }[head[9]];
  if (head[8] !== 8 || !bytes || head[12]) throw new Error("a PNG of another kind");
  const raw = inflateSync(Buffer.concat(parts));
  const line = width * bytes;
  const pixels = new Uint8Array(line * height);
  for (let y = 0; y < height; y++) {
    const filter = raw[y * (line + 1)];
    for (let x = 0; x < line; x++) {
      const at = y * line + x;
      const a = x >= bytes ? pixels[at - bytes] : 0;
      const b = y > 0 ? pixels[at - line] : 0;
      const c = x >= bytes && y > 0 ? pixels[at - line - bytes] : 0;
      const [da, db, dc] = [Math.abs(b - c), Math.abs(a - c), Math.abs(a + b - 2 * c)];
      const paeth = da <= db && da <= dc ? a : db <= dc ? b : c;
      pixels[at] = raw[y * (line + 1) + 1 + x] + [0, a, b, (a + b) >> 1, paeth][filter];
    }
  }
  return { width, height, pixel: (x, y) => [...pixels.subarray((y * width + x) * bytes, (y * width + x) * bytes + 3)] };
}

// How many colours there are in a part of a picture.
export function coloursIn(picture, { left, top, right, bottom }) {
  const found = new Set();
  for (let y = Math.max(0, Math.ceil(top)); y < Math.min(picture.height, bottom); y++) {
    for (let x = Math.max(0, Math.ceil(left)); x < Math.min(picture.width, right); x++) {
      const [r, g, b] = picture.pixel(x, y);
      found.add((r << 16) | (g << 8) | b);
    }
  }
  return found.size;
}
