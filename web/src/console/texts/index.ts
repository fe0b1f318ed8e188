// SPDX-License-Identifier: Apache-2.0
// The console's texts in the operator's language.
import { language } from "../../ui/texts/index.ts";
import { de } from "./de.ts";
import { en } from "./en.ts";

export const texts = { en, de }[language];

/** Returns the stage of a job in the operator's language. An unknown stage is returned as the daemon names it. */
export function stageName(stage: string): string {
  const [, pose, poses] = /^place the target, pose (\d+) of (\d+)$/.exec(stage) ?? [];
  if (pose && poses) return texts.calibration.place(pose, poses);
  return (texts.jobs.stages as Record<string, string>)[stage] ?? stage;
}
