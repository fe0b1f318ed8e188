// SPDX-License-Identifier: Apache-2.0
// Every text that an operator reads.
import { language } from "../../gallery/texts/index.ts";
import { de } from "./de.ts";
import { en } from "./en.ts";

export const texts = { en, de }[language];

/** What a job does, in the operator's language; of what is not known here the daemon's own words. */
export function stageName(stage: string): string {
  const [, pose, poses] = /^place the target, pose (\d+) of (\d+)$/.exec(stage) ?? [];
  if (pose && poses) return texts.calibration.place(pose, poses);
  return (texts.jobs.stages as Record<string, string>)[stage] ?? stage;
}
