// SPDX-License-Identifier: Apache-2.0
// Which page an address means: "#/models/01hf…".

/** Words of the address in the places of `:name`, or null where it means another page. */
export function match(pattern: string, hash: string): string[] | null {
  const wanted = pattern.split("/"), given = hash.replace(/^#?\/?/, "").split("/");
  if (wanted.length !== given.length) return null;
  const words: string[] = [];
  for (const [i, part] of wanted.entries()) {
    const word = given[i] ?? "";
    if (part.startsWith(":") && word) words.push(decodeURIComponent(word));
    else if (part !== word) return null;
  }
  return words;
}

/** The first of the routes that the address means. */
export function routed<Target>(routes: readonly (readonly [string, Target])[], hash: string): { target: Target; words: string[] } | null {
  for (const [pattern, target] of routes) {
    const words = match(pattern, hash);
    if (words) return { target, words };
  }
  return null;
}
