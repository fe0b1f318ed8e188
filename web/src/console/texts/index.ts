// SPDX-License-Identifier: Apache-2.0
// The console's texts in the operator's language, or in English if there are none in that language.
import { language as preferred } from "../../ui/texts/index.ts";
import { de } from "./de.ts";
import { en } from "./en.ts";

export const language = preferred === "de" ? "de" : "en";
export const texts = { de, en }[language];

/** Returns the name of a job's stage in the operator's language. Returns an unknown stage as the daemon names it. */
export function stageName(stage: string): string {
  const [, pose, poses] = /^place the target, pose (\d+) of (\d+)$/.exec(stage) ?? [];
  if (pose && poses) return texts.calibration.place(pose, poses);
  return (texts.jobs.stages as Record<string, string>)[stage] ?? stage;
}
