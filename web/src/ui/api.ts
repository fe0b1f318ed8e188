// SPDX-License-Identifier: Apache-2.0
// Client of the part of the daemon's API that visitors' pages use.
import type { Presentation } from "../core/presentation.ts";

export type Unit = "mm" | "cm" | "m" | "in";

/** Optional metadata: Dublin Core terms, and facts about the object and its scan. */
export type MoreTexts = Partial<Record<
  | "contributor" | "coverage" | "date" | "description" | "identifier" | "language" | "publisher" | "relation" | "source" | "subject" | "type"
  | "material" | "technique" | "period" | "place" | "collection" | "provenance" | "rights_statement" | "persistent_identifier" | "doi"
  | "scan_device" | "scan_calibration" | "scan_date" | "scan_software",
  string>>;

/** The size of a mesh in its unit. */
export interface Dimensions {
  width: number;
  height: number;
  depth: number;
  unit: Unit;
}

export interface ModelRecord extends MoreTexts {
  id: string;
  state: "published" | "draft";
  title: string;
  creator: string;
  rights: string;
  licence: string;
  unit: Unit | ""; // "" if unknown
  accuracy: number | null; // in the model's `unit`
  dimensions?: Dimensions | null; // null if the unit is unknown; missing in lists
  citation?: { apa: string; chicago: string; mla: string }; // missing in lists
  public_max_level: number | null;
  presentation: Presentation;
  created: string;
  vertices: number;
  faces: number;
  bytes: number;
  repairs?: string[]; // what the build changed or left out; only for clients with a token
  links: { self: string; page: string; poster: string; file: string; manifest: string };
}

export type ScanState = "waiting" | "scanning" | "paused" | "meshing" | "building" | "done" | "failed" | "cancelled";

export interface ScanRecord {
  id: string;
  state: ScanState;
  step: number;
  steps: number;
  progress: number; // 0 to 1
  eta: number | null; // remaining time in seconds
  error: string | null; // the reason if the scan failed
  note: string | null; // what the scan is waiting for, if anything
  points: number; // number of points measured so far
  model: string | null; // ID of the scan's model
  title: string;
}

/** Thrown when the daemon has responded with an error status. */
export class ApiError extends Error {
  constructor(url: string, readonly status: number) {
    super(`${url}: ${status}`);
  }
}

/** Timeout of a request in milliseconds. */
const kTimeout = 20_000;

export interface ModelListPage {
  models: ModelRecord[];
  next: string | null; // cursor of the next page; null on the last page
}

/** Models per page. A multiple of 2, 3 and 4, so that the last row is full with 2, 3 or 4 models per row. */
const kPage = 24;

/**
 * Returns a page of the published models that contain all `words`, newest first. `narrowed` holds further query
 * parameters.
 */
export function models(words: string, cursor: string | null, narrowed: Record<string, string> = {}): Promise<ModelListPage> {
  const query = modelQuery(words, cursor);
  for (const [name, value] of Object.entries(narrowed)) query.set(name, value);
  return get<ModelListPage>(`/api/v1/models?${query}`);
}

export type FacetName = "subject" | "creator" | "period" | "material" | "licence" | "collection";

export interface Facets {
  models: number; // number of all models that the search finds
  facets: Record<FacetName, { value: string; models: number }[]>;
}

/** Returns the facets of a search: the most frequent values over all models that it finds. */
export function facets(words: string, narrowed: Record<string, string>): Promise<Facets> {
  return get<Facets>(`/api/v1/facets?${new URLSearchParams({ ...(words && { q: words }), ...narrowed })}`);
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

/**
 * Returns x, y and z of a scan's points, starting at point number `from`. One response may contain
 * only some of the points. Coordinates are in mm, with z upwards.
 */
export async function scanPoints(id: string, from: number): Promise<Float32Array> {
  const answer = await ask(`/api/v1/scans/${encodeURIComponent(id)}/points?from=${from}`, "application/octet-stream");
  const bytes = await answer.arrayBuffer();
  return new Float32Array(bytes, 0, 3 * Math.floor(bytes.byteLength / 12));
}

async function get<T>(url: string): Promise<T> {
  return (await (await ask(url, "application/json")).json()) as T;
}

async function ask(url: string, type: string): Promise<Response> {
  const response = await fetch(url, { headers: { Accept: type }, signal: AbortSignal.timeout(kTimeout) });
  if (!response.ok) throw new ApiError(url, response.status);
  return response;
}
