// SPDX-License-Identifier: Apache-2.0
/** The text of a file: a script that build.mjs bundles separately as a classic script, or a style sheet. */
declare module "*?text" {
  const text: string;
  export default text;
}
