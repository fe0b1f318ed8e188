// SPDX-License-Identifier: Apache-2.0
// The part of the daemon's public interface that the pages read.
export interface ModelRecord {
  id: string;
  title: string;
  creator: string;
  licence: string;
  faces: number;
  bytes: number;
  links: { self: string; page: string };
}

interface ModelPage {
  models: ModelRecord[];
  next: string | null;
}

/** All models, newest pages as the daemon orders them. */
export async function* models(): AsyncGenerator<ModelRecord> {
  let cursor: string | null = null;
  do {
    const query: string = cursor === null ? "" : `?cursor=${encodeURIComponent(cursor)}`;
    const page: ModelPage = await get<ModelPage>(`/api/v1/models${query}`);
    yield* page.models;
    cursor = page.next;
  } while (cursor !== null);
}

export function model(id: string): Promise<ModelRecord> {
  return get<ModelRecord>(`/api/v1/models/${encodeURIComponent(id)}`);
}

async function get<T>(url: string): Promise<T> {
  const response = await fetch(url, { headers: { Accept: "application/json" } });
  if (!response.ok) throw new Error(`${url}: ${response.status}`);
  return (await response.json()) as T;
}
