// SPDX-License-Identifier: Apache-2.0
/** The text of a file: a style sheet, or a script that build.mjs bundles separately as a classic script. */
declare module "*?text" {
  const text: string;
  export default text;
}
