// SPDX-License-Identifier: Apache-2.0
// Measures the warmed-up browser decoder on a whole file. Prints the seconds of decoding, and the
// bytes of memory that the decoder holds after returning the surface:
// node decode_wasm.mjs DECODER.wasm FILE.pmesh
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";

const web = new URL("../../../web/", import.meta.url);
const require = createRequire(new URL("package.json", web));
const { outputFiles } = await require("esbuild").build({
  stdin: {
    contents: 'export { Decoder } from "./decoder.ts";',
    resolveDir: new URL("src/core", web).pathname,
  },
  bundle: true,
  format: "esm",
  target: "node18",
  write: false,
});
const bundle = Buffer.from(outputFiles[0].contents).toString("base64");
const { Decoder } = await import(`data:text/javascript;base64,${bundle}`);

const [wasm, file] = await Promise.all(process.argv.slice(2, 4).map((path) => readFile(path)));
const module = await WebAssembly.compile(wasm);

async function decode() {
  const decoder = await Decoder.create(module);
  const info = decoder.open(file.subarray(0, decoder.headerLength(file)));
  decoder.start(file.subarray(info.baseOffset, info.baseOffset + info.baseLength), new Uint8Array());
  for (const [chunk, { offset, length }] of info.chunks.entries()) {
    decoder.apply(chunk, file.subarray(offset, offset + length));
  }
  return decoder;
}

// Only the last run counts, because the JavaScript engine has compiled the hot code by then.
let seconds;
for (let run = 0; run < 3; ++run) {
  const start = process.cpuUsage();
  await decode();
  seconds = process.cpuUsage(start).user / 1e6;
}
const decoder = await decode();
decoder.surface();
console.log(seconds.toFixed(6), decoder.pages * 65536);
