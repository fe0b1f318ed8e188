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

export const texts = {
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
};
