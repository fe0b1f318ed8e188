// SPDX-License-Identifier: Apache-2.0
// Files on their way to the daemon (tus 1.0): one after the other, in pieces, and on where they were
// after a lost connection, a pause, or a page that was closed.
import { DetailedError, Upload, defaultOptions, type PreviousUpload } from "tus-js-client";
import { Problem } from "./problem.ts";

const kEndpoint = "/api/v1/uploads";
/** Proxies cap bodies; and between two pieces others get a word in. */
const kPiece = 8 << 20;
const kRetries = [0, 1000, 3000, 5000, 10_000, 20_000, 30_000, 60_000];

export type SendingState = "waiting" | "sending" | "paused" | "failed" | "whole";

/** One file. `whole` resolves to the upload's id once all of it has come. */
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
      onShouldRetry: (error) => mayPass(error instanceof DetailedError ? (error.originalResponse?.getStatus() ?? 0) : 0),
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

  /** In its turn. */
  resume(): void {
    this.#be("waiting");
    this.ended();
  }

  /** What has come is taken away again. */
  async cancel(): Promise<void> {
    this.#be("paused");
    await this.#upload.abort(true).catch(() => undefined); // it expires by itself
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

/** Whether the same piece may be taken at another time. */
function mayPass(status: number): boolean {
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

/** A file of which a part has come before this page was loaded. */
export type Interrupted = PreviousUpload;

export class Uploads {
  readonly #lane: Sending[] = [];

  constructor(private readonly headers: Record<string, string>) {}

  add(file: File): Sending {
    const one = new Sending(file, this.headers, () => this.#next());
    this.#lane.push(one);
    this.#next();
    return one;
  }

  remove(one: Sending): void {
    this.#lane.splice(this.#lane.indexOf(one), 1);
  }

  get all(): readonly Sending[] {
    return this.#lane;
  }

  get isSending(): boolean {
    return this.#lane.some(({ state }) => state === "sending" || state === "waiting");
  }

  /** The browser has kept no file: the operator has to choose it again. */
  async interrupted(): Promise<Interrupted[]> {
    const known = await defaultOptions.urlStorage.findAllUploads();
    return known.filter(({ metadata }) => !this.#lane.some(({ file }) => file.name === metadata["filename"]));
  }

  async forget({ urlStorageKey, uploadUrl }: Interrupted): Promise<void> {
    if (uploadUrl) await Upload.terminate(uploadUrl, { headers: this.headers, retryDelays: [] }).catch(() => undefined);
    await defaultOptions.urlStorage.removeUpload(urlStorageKey);
  }

  #next(): void {
    if (this.#lane.some(({ state }) => state === "sending")) return;
    void this.#lane.find(({ state }) => state === "waiting")?.start();
  }
}
