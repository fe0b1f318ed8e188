// SPDX-License-Identifier: Apache-2.0
// Chooses the source for a model's URL: the daemon's API, or a .pmesh file on any host.
import { ApiSource } from "./api-source.ts";
import { FileSource } from "./file-source.ts";
import type { Source, Transport } from "./source.ts";
import { StreamSource } from "./stream-source.ts";

/**
 * Opens the source for the URL of a .pmesh file, a model page or a model in the API. Sends the
 * token only to a daemon.
 */
export function openSource(url: string, transport: Transport, token: string): Source {
  const address = new URL(url);
  // A model ID contains no dot. /models/bust.pmesh is therefore not a model page, but a file in a
  // folder named "models".
  const model = /^(.*?)\/(?:api\/v1\/)?models\/([^/.]+)\/?$/.exec(address.pathname);
  if (!model) return new FileSource(url);
  const api = `${address.origin}${model[1]}/api/v1`, id = model[2] ?? "";
  return transport === "ws" && !token ? new StreamSource(api, id) : new ApiSource(api, id, token);
}
