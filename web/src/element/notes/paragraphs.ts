// SPDX-License-Identifier: Apache-2.0
// Splits the plain text of a note into paragraphs and links.

export type Piece = string | { label: string; url: string };

/**
 * Returns the paragraphs of a text, each as texts and links. An empty line separates paragraphs. A link is written as
 * `[label](https://...)`. Other text, such as HTML, stays as it is.
 */
export function paragraphsOf(text: string): Piece[][] {
  return text.split(/\r?\n\s*\n/).map((part) => part.trim()).filter((part) => part !== "").map(piecesOf);
}

function piecesOf(paragraph: string): Piece[] {
  const pieces: Piece[] = [];
  let end = 0;
  for (const found of paragraph.matchAll(/\[([^[\]]+)\]\((https?:\/\/[^\s()]+)\)/g)) {
    if (found.index > end) pieces.push(paragraph.slice(end, found.index));
    pieces.push({ label: found[1] as string, url: found[2] as string });
    end = found.index + found[0].length;
  }
  if (end < paragraph.length) pieces.push(paragraph.slice(end));
  return pieces;
}

/** Returns the seconds for which a tour shows a note: long enough to read it. */
export function secondsToRead(...texts: string[]): number {
  const words = texts.join(" ").split(/\s+/).filter((word) => word !== "").length;
  return Math.min(60, Math.max(5, 3 + words / 2.5)); // 150 words per minute, and time to look
}
