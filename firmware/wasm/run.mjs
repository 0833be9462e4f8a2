// Runs the module that was built: `node run.mjs MODULE STEPS` prints the hash.
import { readFile } from 'node:fs/promises';

const [path, steps] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(await readFile(path), {});
const hash = BigInt.asUintN(64, instance.exports.hash(Number(steps)));
console.log(`steps ${steps}`);
console.log(`hash ${hash.toString(16).padStart(16, '0')}`);
