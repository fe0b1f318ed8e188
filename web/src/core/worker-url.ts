// SPDX-License-Identifier: Apache-2.0
// The worker's script in the builds that a daemon serves: these contain the script, so the worker starts without a request.
import type { Assets } from "./assets.ts";
import workerText from "./worker.ts?text";

/**
 * Returns a URL of the worker's script. It is a blob, because a worker's script must have the origin of the page, and the page may
 * have another origin than the daemon. The caller revokes the URL.
 */
export function workerUrl(_assets: Assets): string {
  return URL.createObjectURL(new Blob([workerText], { type: "text/javascript" }));
}
