// SPDX-License-Identifier: Apache-2.0
/** A module bundled on its own, as the text of a classic script (build.mjs). */
declare module "*?text" {
  const text: string;
  export default text;
}
