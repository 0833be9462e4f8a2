// What is packed in a live page: compressed bytes as text.

import { gunzipSync } from "node:zlib";

// Five letters are four bytes; two letters stand for others.
const value = (letter) => ({ "}": "<", "~": "\\" })[letter] ?? letter;

export function unpacked({ gzip, bytes }) {
  const words = Buffer.alloc(Math.ceil(gzip.length / 5) * 4);
  for (let at = 0; at < gzip.length; at += 5) {
    const letters = [...gzip.slice(at, at + 5)].map((letter) => value(letter).charCodeAt(0) - 40);
    words.writeUInt32BE(letters.reduce((word, letter) => 85 * word + letter, 0), (at / 5) * 4);
  }
  return gunzipSync(words.subarray(0, bytes));
}
