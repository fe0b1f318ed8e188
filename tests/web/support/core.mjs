// SPDX-License-Identifier: Apache-2.0
// Bundles the web client's TypeScript core for Node, and loads the real decoder.
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";

const web = new URL("../../../web/", import.meta.url);
const require = createRequire(new URL("package.json", web));

export async function loadCore(wasmPath) {
  const { outputFiles } = await require("esbuild").build({
    stdin: {
      contents: `export { Decoder } from "./decoder.ts";
                 export { decodeBase } from "./draco.ts";
                 export { Session } from "./session.ts";`,
      resolveDir: new URL("src/core", web).pathname,
    },
    bundle: true,
    format: "esm",
    target: "node18",
    write: false,
  });
  const core = await import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
  const module = await WebAssembly.compile(await readFile(wasmPath));
  const draco = await require("draco3d").createDecoderModule({});
  return { ...core, module, draco };
}

/**
 * Opens the model in the bytes of a whole file. Returns its decoder, which has the base mesh, and its manifest as
 * `info`.
 */
export async function openFile({ Decoder, decodeBase, module, draco }, file) {
  const decoder = await Decoder.create(module);
  const info = decoder.open(file.subarray(0, decoder.headerLength(file)));
  const base = file.subarray(info.baseOffset, info.baseOffset + info.baseLength);
  decoder.checkBase(base);
  decoder.start(decodeBase(draco, base, info));
  return { decoder, info };
}
