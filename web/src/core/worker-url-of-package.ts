// SPDX-License-Identifier: Apache-2.0
// The worker's script in the npm package. In the npm package, build.mjs replaces worker-url.ts by
// this module. The script is a file of its own, so a page's security policy need not permit blobs.
import type { Assets } from "./assets.ts";

/**
 * Returns a URL of the worker's script. A worker's script must have the origin of the page. If the
 * script has another origin, the URL is that of a blob that loads the script. The caller must
 * revoke the URL.
 */
export function workerUrl({ worker }: Assets): string {
  const url = new URL(worker ?? new URL("./progressive-mesh-worker.js", import.meta.url), document.baseURI);
  if (url.origin === location.origin) return url.href;
  return URL.createObjectURL(new Blob([`importScripts(${JSON.stringify(url.href)})`], { type: "text/javascript" }));
}
