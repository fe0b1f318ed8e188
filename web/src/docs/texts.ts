// SPDX-License-Identifier: Apache-2.0
// The texts of the page /docs. They are in English, like the documentation of the API itself.
export const texts = {
  title: "API",
  parameters: "Parameters",
  body: "Body (JSON)",
  fields: "Members",
  role: (role: string) => `Requires a token with the role ${role}.`,
  answer: (status: string, what: string) => `Returns ${status}: ${what}`,
  answerOnly: (status: string) => `Returns ${status}.`,
  failed: "The API description cannot be loaded. Reload the page to try again.",
};
