// SPDX-License-Identifier: Apache-2.0
// The part of the daemon's public interface that the pages read.
export type Unit = "mm" | "cm" | "m" | "in";

/** Texts beyond those that every model has (Dublin Core). */
export type MoreTexts = Partial<Record<
  "contributor" | "coverage" | "date" | "description" | "identifier" | "language" | "publisher" | "relation" | "source" | "subject" | "type",
  string>>;

export interface ModelRecord extends MoreTexts {
  id: string;
  state: "published" | "draft";
  title: string;
  creator: string;
  rights: string;
  licence: string;
  unit: Unit | ""; // empty: unknown
  accuracy: number | null; // in that unit
  public_max_level: number | null;
  created: string;
  vertices: number;
  faces: number;
  bytes: number;
  links: { self: string; page: string; poster: string; file: string; manifest: string };
}

export type ScanState = "waiting" | "scanning" | "paused" | "meshing" | "building" | "done" | "failed" | "cancelled";

export interface ScanRecord {
  id: string;
  state: ScanState;
  step: number;
  steps: number;
  progress: number; // 0 to 1
  eta: number | null; // seconds
  error: string | null; // why it has failed
  note: string | null; // what it waits for
  points: number; // so far
  model: string | null; // its id
  title: string;
}

/** The daemon has answered, but not with what was asked for. */
export class ApiError extends Error {
  constructor(url: string, readonly status: number) {
    super(`${url}: ${status}`);
  }
}

/** Milliseconds after which nobody answers any more. */
const kPatience = 20_000;

export interface ModelPage {
  models: ModelRecord[];
  next: string | null; // the cursor of the next page
}

/** Of one page: rows of two, three and four are whole. */
const kPage = 24;

/** What is on display and has all of `words`, newest first. */
export function models(words: string, cursor: string | null): Promise<ModelPage> {
  return get<ModelPage>(`/api/v1/models?${modelQuery(words, cursor)}`);
}

export function modelQuery(words: string, cursor: string | null): URLSearchParams {
  return new URLSearchParams({ limit: String(kPage), ...(words && { q: words }), ...(cursor !== null && { cursor }) });
}

export function model(id: string): Promise<ModelRecord> {
  return get<ModelRecord>(`/api/v1/models/${encodeURIComponent(id)}`);
}

export function scan(id: string): Promise<ScanRecord> {
  return get<ScanRecord>(`/api/v1/scans/${encodeURIComponent(id)}`);
}

/** x, y and z in mm, z upwards, of the points from number `from` on: no more than one answer holds. */
export async function scanPoints(id: string, from: number): Promise<Float32Array> {
  const answer = await ask(`/api/v1/scans/${encodeURIComponent(id)}/points?from=${from}`, "application/octet-stream");
  const bytes = await answer.arrayBuffer();
  return new Float32Array(bytes, 0, 3 * Math.floor(bytes.byteLength / 12));
}

async function get<T>(url: string): Promise<T> {
  return (await (await ask(url, "application/json")).json()) as T;
}

async function ask(url: string, type: string): Promise<Response> {
  const response = await fetch(url, { headers: { Accept: type }, signal: AbortSignal.timeout(kPatience) });
  if (!response.ok) throw new ApiError(url, response.status);
  return response;
}
