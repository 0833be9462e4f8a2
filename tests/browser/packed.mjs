// What is packed in a live page: compressed bytes as text.
//
//   node tests/browser/packed.mjs PAGE.html [UNPACKER.wasm.gz]
//
// Prints the module of a page, by the unpacker that the page has or by another one; first it sees that a damaged module is refused.

import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { gunzipSync } from "node:zlib";

const mark = '<script type="application/json" id="data">';

// The data of a page.
export function dataOf(page) {
  const html = readFileSync(page, "utf8");
  return JSON.parse(html.slice(html.lastIndexOf(mark) + mark.length, html.lastIndexOf("</script>")));
}

// Two letters are thirteen bits; two letters stand for others.
const value = (letter) => ({ "!": "<", "~": "\\" })[letter] ?? letter;

function bytesOf(letters, bytes) {
  const found = Buffer.alloc(bytes);
  const digit = (at) => value(letters[at]).charCodeAt(0) - 35;
  let [rest, bits, to] = [0, 0, 0];
  for (let at = 0; at < letters.length; at += 2) {
    rest = (rest << 13) | (91 * digit(at) + digit(at + 1));
    for (bits += 13; bits >= 8 && to < bytes; ) found[to++] = rest >> (bits -= 8);
    rest &= (1 << bits) - 1;
  }
  return found;
}

// What a module of WebAssembly makes of a file by xz; empty where it refuses it.
function unxz(unpacker, file) {
  const own = new WebAssembly.Instance(new WebAssembly.Module(unpacker), {}).exports;
  const at = own.input(file.length);
  new Uint8Array(own.memory.buffer, at, file.length).set(file);
  const length = own.unpack();
  return Buffer.from(own.memory.buffer.slice(own.output(), own.output() + length));
}

export function unpacked({ gzip, xz, bytes }, unpacker) {
  return xz ? unxz(unpacked(unpacker), bytesOf(xz, bytes)) : gunzipSync(bytesOf(gzip, bytes));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const [page, other] = process.argv.slice(2);
  const { module, unpacker } = dataOf(page).live;
  if (!module.xz) throw new Error(`${page}: the module is not packed by xz`);
  const own = other ? gunzipSync(readFileSync(other)) : unpacked(unpacker);
  const file = bytesOf(module.xz, module.bytes);
  for (const at of [0, 20, file.length >> 1, file.length - 30]) {
    const damaged = Buffer.from(file);
    damaged[at] ^= 255;
    if (unxz(own, damaged).length > 0) throw new Error(`byte ${at} is damaged and nobody notices`);
  }
  if (unxz(own, file.subarray(0, -40)).length > 0) throw new Error("the end is missing and nobody notices");
  process.stdout.write(unxz(own, file));
}
