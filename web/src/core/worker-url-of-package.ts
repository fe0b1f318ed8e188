// SPDX-License-Identifier: Apache-2.0
// The worker's script in the npm package. build.mjs uses this module there instead of
// worker-url.ts. The script is a file of its own, so a page's security policy need not permit
// blobs.
import type { Assets } from "./assets.ts";

/**
 * Returns a URL of the worker's script. If the script has another origin than the page, the URL is
 * that of a blob that loads the script, because a worker's script must have the origin of the page.
 * The caller must revoke the URL.
 */
export function workerUrl({ worker }: Assets): string {
  const url = new URL(worker ?? new URL("./progressive-mesh-worker.js", import.meta.url), document.baseURI);
  if (url.origin === location.origin) return url.href;
  return URL.createObjectURL(new Blob([`importScripts(${JSON.stringify(url.href)})`], { type: "text/javascript" }));
}
