// SPDX-License-Identifier: Apache-2.0
// The first request for a model. The page sends it before the worker runs, and passes the response
// on to the worker. This saves the time that a worker takes to start.
import type { Transport } from "./source.ts";

/**
 * Bytes of the first request for a file. They are enough for the head of most models: header, base mesh and first pictures.
 * More bytes would delay the viewer's code, which arrives at the same time on a first visit.
 */
export const kStart = 16 * 1024;

export interface FirstRequest {
  url: string;
  headers: Record<string, string>;
}

/** The field of a head's response that has the presentation of the model as JSON. */
export const kPresentation = "Vitrine-Presentation";

/**
 * A part of a response. The status comes first. If there is a body, its bytes and "end" follow. "lost" may come at any time and
 * means that the connection has failed.
 */
export type ResponsePart = { status: number; hasBody: boolean; presentation: string } | Uint8Array<ArrayBuffer> | "end" | "lost";

/** Returns the URL of the API and the model's ID. Returns undefined if `url` is that of a file. */
export function apiAddress(url: string): { api: string; id: string } | undefined {
  const { origin, pathname } = new URL(url);
  // A model ID contains no dot. /models/bust.pmesh is therefore not a model page, but a file in a
  // folder named "models".
  const [, folder, id] = /^(.*?)\/(?:api\/v1\/)?models\/([^/.]+)\/?$/.exec(pathname) ?? [];
  return id === undefined ? undefined : { api: `${origin}${folder}/api/v1`, id };
}

/** Returns the request for the head (header, base mesh, first pictures) of a model in the API. */
export function headRequest(api: string, id: string, token: string): FirstRequest {
  return { url: `${api}/models/${id}/head`, headers: token ? { Authorization: `Bearer ${token}` } : {} };
}

/** Returns the first request for a model. Returns undefined if the model's head comes by WebSocket. */
export function firstRequest(url: string, transport: Transport, token: string): FirstRequest | undefined {
  const model = apiAddress(url);
  if (!model) return { url, headers: { Range: `bytes=0-${kStart - 1}` } };
  return transport === "ws" && !token ? undefined : headRequest(model.api, model.id, token);
}

/**
 * Sends `request`, and calls `pass` for each part of the response. Does not read the body of an error response. Passes
 * "lost" if the connection fails. Passes nothing more after `signal` is aborted.
 */
export async function relay({ url, headers }: FirstRequest, signal: AbortSignal, pass: (part: ResponsePart) => void): Promise<void> {
  try {
    const response = await fetch(url, { headers, signal });
    const reader = response.ok ? response.body?.getReader() : void response.body?.cancel();
    pass({ status: response.status, hasBody: reader !== undefined, presentation: response.headers.get(kPresentation) ?? "" });
    for (let part = await reader?.read(); part && !part.done; part = await reader?.read()) pass(part.value);
    if (reader) pass("end");
  } catch {
    if (!signal.aborted) pass("lost");
  }
}

/** Rebuilds, in the worker, the response whose parts the page passes on. */
export class RelayedResponse {
  /** Resolves to undefined if the page got no response. The request should then be repeated, to find out the reason. */
  readonly response: Promise<Response | undefined>;
  #respond: (response: Response | undefined) => void = () => undefined;
  #body: ReadableStreamDefaultController<Uint8Array> | undefined;

  constructor() {
    this.response = new Promise((resolve) => (this.#respond = resolve));
  }

  receive(part: ResponsePart): void {
    if (part === "end") this.#body?.close();
    else if (part === "lost") this.#lose();
    else if (part instanceof Uint8Array) this.#body?.enqueue(part);
    else this.#start(part);
  }

  #start({ status, hasBody, presentation }: Extract<ResponsePart, { status: number }>): void {
    const body = hasBody ? new ReadableStream({ start: (bytes) => void (this.#body = bytes) }) : null;
    this.#respond(new Response(body, { status, headers: { [kPresentation]: presentation } }));
  }

  #lose(): void {
    this.#body?.error(new TypeError("the connection was lost"));
    this.#respond(undefined); // no effect if there is a response
  }
}
