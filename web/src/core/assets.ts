// SPDX-License-Identifier: Apache-2.0
// The files that the viewer loads while it runs.

/** Absolute URLs of the files that the viewer loads while it runs. */
export interface Assets {
  /** progressive-mesh-worker.js. The scripts that a daemon serves contain the worker and do not use this URL. */
  worker?: string;
  wasm: string;
}

/**
 * Returns the URLs in `moved`, and the URLs in this module's folder for the other files. Bundlers look for `new
 * URL("literal", import.meta.url)`, copy the file and replace the expression by its new URL. Computes the URLs at each
 * call, because import.meta.url may be missing when the module is loaded on a server.
 */
export function assetsWith(moved: Partial<Assets>): Assets {
  return {
    wasm: moved.wasm ?? new URL("./progressive-mesh.wasm", import.meta.url).href,
    ...(moved.worker === undefined ? {} : { worker: moved.worker }),
  };
}
