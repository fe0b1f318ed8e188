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
  return { ...core, module };
}

/**
 * Opens a model from the bytes of a whole file. Returns a decoder that has the base mesh, and the
 * manifest as `info`.
 */
export async function openFile({ Decoder, module }, file) {
  const decoder = await Decoder.create(module);
  const info = decoder.open(file.subarray(0, decoder.headerLength(file)));
  const base = file.subarray(info.baseOffset, info.baseOffset + info.baseLength);
  decoder.checkBase(base);
  const { atlasOffset = 0, atlasLength = 0 } = info.texture ?? {};
  decoder.start(base, file.subarray(atlasOffset, atlasOffset + atlasLength));
  return { decoder, info };
}
