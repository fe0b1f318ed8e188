// SPDX-License-Identifier: Apache-2.0
// What a visitor of the pages around the viewer reads.
const number = new Intl.NumberFormat("en");
const short = new Intl.NumberFormat("en", { maximumFractionDigits: 1 });

export function count(value: number): string {
  return number.format(Math.round(value));
}

export function size(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  return bytes < 1e6 ? `${short.format(bytes / 1000)} KB` : `${short.format(bytes / 1e6)} MB`;
}

/** A time to wait, as precise as a guess may be. */
export function timeLeft(seconds: number): string {
  const minutes = Math.round(seconds / 60), hours = Math.round(seconds / 3600);
  if (seconds < 10) return "a few seconds left";
  if (seconds < 45) return "less than a minute left";
  if (minutes <= 1) return "about a minute left";
  if (minutes < 60) return `about ${minutes} minutes left`;
  return hours <= 1 ? "about an hour left" : `about ${hours} hours left`;
}

export const texts = {
  amount: (triangles: string, bytes: string) => `${triangles} triangles, ${bytes}`,
  loading: "Loading",
  galleryTitle: "Collection",
  galleryEmpty: "Nothing is on display yet.",
  galleryHint: "Publish a scan with: vitrine publish scan.ply --data DIR",
  galleryFailed: "The collection cannot be reached. Reload the page to try again.",
  back: "Collection",
  untitled: "Untitled",
  modelFailed: "This object is not on display.",
  scanStates: {
    waiting: "Waiting for the scanner",
    scanning: "Scanning",
    paused: "Paused",
    meshing: "Joining the points to a surface",
    building: "Building the model",
    done: "Scanned",
    failed: "The scan has failed",
    cancelled: "The scan was cancelled",
  },
  step: (step: number, steps: number) => `step ${count(step)} of ${count(steps)}`,
  points: (points: number) => `${count(points)} points`,
  cloudOf: (title: string) => `The points measured so far: ${title}`,
  docs: {
    title: "Interface",
    parameters: "Parameters",
    body: "Body (JSON)",
    fields: "Members",
    role: (role: string) => `Needs a token with the role ${role}.`,
    answer: (status: string, what: string) => `Answers ${status}: ${what}`,
    answerOnly: (status: string) => `Answers ${status}.`,
    failed: "The description cannot be reached. Reload the page to try again.",
  },
  scanLost: "The connection is lost. Trying again\u2026",
  scanMissing: "This scan is not on display.",
};

/** What a scan does, and why it has failed or what it waits for. */
export function scanState({ state, error, note }: { state: keyof typeof texts.scanStates; error: string | null; note: string | null }): string {
  const why = error ?? note;
  return why === null ? texts.scanStates[state] : `${texts.scanStates[state]}: ${why}`;
}
