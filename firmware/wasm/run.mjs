// Runs the module that was built: `node run.mjs MODULE STEPS` prints the hashes, in floats and in integers.
import { readFile } from 'node:fs/promises';

const [path, steps] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(await readFile(path), {});
console.log(`steps ${steps}`);
for (const [name, compute] of [['hash', instance.exports.hash], ['hash-fixed', instance.exports.hash_fixed]]) {
  console.log(`${name} ${BigInt.asUintN(64, compute(Number(steps))).toString(16).padStart(16, '0')}`);
}
