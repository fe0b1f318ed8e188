// SPDX-License-Identifier: Apache-2.0
// Uploads files to the daemon (tus 1.0), one file at a time and in pieces. An upload can be resumed
// after a lost connection, after a pause, or after the page was closed.
import { DetailedError, Upload, defaultOptions, type PreviousUpload } from "tus-js-client";
import { Problem } from "./problem.ts";

const kEndpoint = "/api/v1/uploads";
/** Maximum number of bytes per request. Proxies limit the size of a request's body. */
const kPiece = 8 << 20;
const kRetries = [0, 1000, 3000, 5000, 10_000, 20_000, 30_000, 60_000];

export type SendingState = "waiting" | "sending" | "paused" | "failed" | "whole";

/** The upload of one file. `whole` resolves to the upload's ID when the server has the whole file. */
export class Sending {
  state: SendingState = "waiting";
  sent = 0;
  error: Problem | null = null;
  onChange: () => void = () => undefined;
  readonly whole: Promise<string>;
  readonly #upload: Upload;
  #settle!: (id: string) => void;

  constructor(readonly file: File, headers: Record<string, string>, private readonly ended: () => void) {
    this.whole = new Promise((resolve) => (this.#settle = resolve));
    this.#upload = new Upload(file, {
      endpoint: kEndpoint, headers, chunkSize: kPiece, retryDelays: kRetries,
      metadata: { filename: file.name }, removeFingerprintOnSuccess: true,
      onShouldRetry: (error) => isRetryable(error instanceof DetailedError ? (error.originalResponse?.getStatus() ?? 0) : 0),
      onProgress: (sent) => this.#be("sending", sent),
      onSuccess: () => this.#finish(),
      onError: (error) => this.#fail(error),
    });
  }

  async start(): Promise<void> {
    this.#be("sending");
    const [before] = await this.#upload.findPreviousUploads();
    if (before) this.#upload.resumeFromPreviousUpload(before);
    if (this.state === "sending") this.#upload.start();
  }

  async pause(): Promise<void> {
    this.#be("paused");
    await this.#upload.abort();
    this.ended();
  }

  /** Puts the upload back into the queue. */
  resume(): void {
    this.#be("waiting");
    this.ended();
  }

  /** Stops the upload and deletes the part of the file that the server has received. */
  async cancel(): Promise<void> {
    this.#be("paused");
    // Ignores an error, because the server later also deletes incomplete uploads by itself.
    await this.#upload.abort(true).catch(() => undefined);
    this.ended();
  }

  #be(state: SendingState, sent = this.sent): void {
    Object.assign(this, { state, sent });
    this.onChange();
  }

  #finish(): void {
    this.#be("whole", this.file.size);
    this.#settle(this.#upload.url?.split("/").pop() ?? "");
    this.ended();
  }

  #fail(error: Error): void {
    const answer = error instanceof DetailedError ? error.originalResponse : null;
    this.error = problemOf(answer?.getStatus() ?? 0, answer?.getBody() ?? "");
    this.#be("failed");
    this.ended();
  }
}

/** Whether sending the same piece again may succeed. */
function isRetryable(status: number): boolean {
  return status === 0 || status === 409 || status === 423 || status === 429 || (status >= 500 && status !== 507);
}

function problemOf(status: number, body: string): Problem {
  try {
    const { title, detail, errors, request_id } = JSON.parse(body);
    return new Problem(status, title, detail, errors, request_id);
  } catch {
    return new Problem(status, "");
  }
}

/** An upload that was interrupted before this page was loaded. */
export type Interrupted = PreviousUpload;

export class Uploads {
  readonly #queue: Sending[] = [];

  constructor(private readonly headers: Record<string, string>) {}

  add(file: File): Sending {
    const one = new Sending(file, this.headers, () => this.#next());
    this.#queue.push(one);
    this.#next();
    return one;
  }

  remove(one: Sending): void {
    this.#queue.splice(this.#queue.indexOf(one), 1);
  }

  get all(): readonly Sending[] {
    return this.#queue;
  }

  get isSending(): boolean {
    return this.#queue.some(({ state }) => state === "sending" || state === "waiting");
  }

  /**
   * Returns the interrupted uploads. To resume one, the operator must choose the file again,
   * because browsers do not keep the file.
   */
  async interrupted(): Promise<Interrupted[]> {
    const known = await defaultOptions.urlStorage.findAllUploads();
    return known.filter(({ metadata }) => !this.#queue.some(({ file }) => file.name === metadata["filename"]));
  }

  async forget({ urlStorageKey, uploadUrl }: Interrupted): Promise<void> {
    if (uploadUrl) await Upload.terminate(uploadUrl, { headers: this.headers, retryDelays: [] }).catch(() => undefined);
    await defaultOptions.urlStorage.removeUpload(urlStorageKey);
  }

  #next(): void {
    if (this.#queue.some(({ state }) => state === "sending")) return;
    void this.#queue.find(({ state }) => state === "waiting")?.start();
  }
}
