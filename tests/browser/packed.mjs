// What is packed in a live page: compressed bytes as text.

import { gunzipSync } from "node:zlib";

// Two letters are thirteen bits; two letters stand for others.
const value = (letter) => ({ "!": "<", "~": "\\" })[letter] ?? letter;

export function unpacked({ gzip, bytes }) {
  const found = Buffer.alloc(bytes);
  const digit = (at) => value(gzip[at]).charCodeAt(0) - 35;
  let [rest, bits, to] = [0, 0, 0];
  for (let at = 0; at < gzip.length; at += 2) {
    rest = (rest << 13) | (91 * digit(at) + digit(at + 1));
    for (bits += 13; bits >= 8 && to < bytes; ) found[to++] = rest >> (bits -= 8);
    rest &= (1 << bits) - 1;
  }
  return gunzipSync(found);
}
