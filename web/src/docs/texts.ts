// SPDX-License-Identifier: Apache-2.0
// What a reader of the page /docs reads around the interface's own words, which are English.
export const texts = {
  title: "Interface",
  parameters: "Parameters",
  body: "Body (JSON)",
  fields: "Members",
  role: (role: string) => `Needs a token with the role ${role}.`,
  answer: (status: string, what: string) => `Answers ${status}: ${what}`,
  answerOnly: (status: string) => `Answers ${status}.`,
  failed: "The description cannot be reached. Reload the page to try again.",
};
