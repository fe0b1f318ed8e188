// SPDX-License-Identifier: Apache-2.0
// The worker's script in the builds that a daemon serves. These builds contain the script, so the
// worker starts without a request.
import type { Assets } from "./assets.ts";
import workerText from "./worker.ts?text";

/**
 * Returns a URL of the worker's script. The URL is that of a blob: a worker's script must have the
 * origin of the page, which may differ from the origin of the daemon. The caller must revoke the
 * URL.
 */
export function workerUrl(_assets: Assets): string {
  return URL.createObjectURL(new Blob([workerText], { type: "text/javascript" }));
}
