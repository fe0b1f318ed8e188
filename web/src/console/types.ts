// SPDX-License-Identifier: Apache-2.0
// Types of the API's responses, with only the members that the console reads. /api/v1/openapi.json
// describes all members.
export type { ModelListPage, ModelRecord, ScanRecord, Unit } from "../ui/api.ts";
import type { ScanRecord } from "../ui/api.ts";

export type JobState = "queued" | "running" | "paused" | "done" | "failed" | "cancelled";

export interface Job {
  id: string;
  kind: "scan" | "calibrate" | "reprocess" | "publish";
  state: JobState;
  stage: string | null;
  progress: number; // 0 to 1
  eta: number | null; // remaining time in seconds
  error: string | null;
  note: string | null;
  scanner: string | null;
  scan: string | null;
  model: string | null;
  repairs: string[]; // what the build changed or left out, one line for each kind
  created: string;
  ended: string | null;
}

export interface JobListPage {
  jobs: Job[];
  next: string | null;
}

/** A scan, with the members that only operators receive. */
export interface Scan extends ScanRecord {
  job: string;
  scanner: string;
  created: string;
}

export interface ScanListPage {
  scans: Scan[];
  next: string | null;
}

export type LaserState = "unknown" | "off" | "on";
export type MotorState = "unknown" | "off" | "holding" | "turning";

export interface Scanner {
  name: string;
  state: "idle" | "busy" | "unreachable";
  camera: { vendor: string; model: string; serial: string } | null;
  board: { dialect: string; firmware: string } | null;
  calibration: number | null;
  scan: string | null;
  problem: string | null;
  laser?: { state: LaserState; since: string | null };
  motor?: { state: MotorState; since: string | null };
}

export interface Calibration {
  number: number;
  created: string;
  camera: string;
  rms: number; // RMS error in mm, measured with poses that were not used for the calibration
  p95: number;
  max: number;
  coverage: number; // share of the picture that the calibration covers, 0 to 1
}

export interface Calibrations {
  calibrations: Calibration[]; // newest first
  damaged: { number: number; problem: string }[];
}

export interface Manifest {
  unit: string;
  presentation: { scale: number };
  lattice: { step: number; bits: number };
  bounding_box: { min: number[]; max: number[] };
  levels: { vertices: number; faces: number; cumulative_bytes: number; max_error: number; rms_error: number }[];
}

export type Role = "viewer" | "operator" | "admin";

export interface Token {
  id: string;
  role: Role;
  label: string;
  created: string;
}

/** The visits to each model over some days. Times are in seconds. */
export interface Visits {
  from: string; // a date, such as 2026-11-28
  to: string;
  counted: boolean; // whether the daemon currently counts visits
  models: { model: string; title: string; visits: number; seconds: number; mean_level: number; complete: number }[];
}

export const isOver = ({ state }: { state: JobState }): boolean => state === "done" || state === "failed" || state === "cancelled";
