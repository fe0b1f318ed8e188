// SPDX-License-Identifier: Apache-2.0
// Finds the page for a URL fragment such as "#/models/01hf…".

/**
 * Matches a fragment with a pattern such as "models/:id". Returns the parts of the fragment that
 * correspond to the pattern's parts with a colon. Returns null if the fragment does not match.
 */
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

/** Returns the first route whose pattern matches the fragment, or null if none does. */
export function routed<Target>(routes: readonly (readonly [string, Target])[], hash: string): { target: Target; words: string[] } | null {
  for (const [pattern, target] of routes) {
    const words = match(pattern, hash);
    if (words) return { target, words };
  }
  return null;
}
