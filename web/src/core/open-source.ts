// SPDX-License-Identifier: Apache-2.0
// Chooses the source for a model's URL: the daemon's API, or a .pmesh file on any host.
import { ApiSource } from "./api-source.ts";
import { FileSource } from "./file-source.ts";
import { apiAddress } from "./first-request.ts";
import type { Source, Transport } from "./source.ts";
import { StreamSource } from "./stream-source.ts";

/**
 * Opens the source for the URL of a .pmesh file, a model page or a model in the API. Sends the token only to a
 * daemon. `first` is the response to the first request (first-request.ts), if that request has been sent.
 */
export function openSource(url: string, transport: Transport, token: string, first?: Promise<Response | undefined>): Source {
  const model = apiAddress(url);
  if (!model) return new FileSource(url, first);
  const { api, id } = model;
  return transport === "ws" && !token ? new StreamSource(api, id) : new ApiSource(api, id, token, first);
}
