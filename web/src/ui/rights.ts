// SPDX-License-Identifier: Apache-2.0
// The licences of Creative Commons and the statements of RightsStatements.org, with their labels. The labels are the same in all
// languages, because the names in both vocabularies are legal terms.

/** Licences for new models, as SPDX identifiers. */
export const kLicences: readonly [id: string, label: string][] = [
  ["CC0-1.0", "CC0 1.0"],
  ["CC-PDM-1.0", "Public Domain Mark 1.0"],
  ...["BY", "BY-SA", "BY-ND", "BY-NC", "BY-NC-SA", "BY-NC-ND"].map((terms): [string, string] => [`CC-${terms}-4.0`, `CC ${terms} 4.0`]),
];

const kStatements: Record<string, string> = {
  InC: "In Copyright",
  "InC-OW-EU": "In Copyright – EU Orphan Work",
  "InC-EDU": "In Copyright – Educational Use Permitted",
  "InC-NC": "In Copyright – Non-Commercial Use Permitted",
  "InC-RUU": "In Copyright – Rights-holder(s) Unlocatable or Unidentifiable",
  "NoC-CR": "No Copyright – Contractual Restrictions",
  "NoC-NC": "No Copyright – Non-Commercial Use Only",
  "NoC-OKLR": "No Copyright – Other Known Legal Restrictions",
  "NoC-US": "No Copyright – United States",
  CNE: "Copyright Not Evaluated",
  UND: "Copyright Undetermined",
  NKC: "No Known Copyright",
};

/** The statements of RightsStatements.org. */
export const kRightsStatements: readonly [uri: string, label: string][] =
  Object.entries(kStatements).map(([name, label]) => [`http://rightsstatements.org/vocab/${name}/1.0/`, label]);

/**
 * Returns the label of a statement of RightsStatements.org, given by its URI or the address of its page, or `uri` itself if the
 * statement is unknown.
 */
export function rightsLabel(uri: string): string {
  const [, name = ""] = /^https?:\/\/(?:www\.)?rightsstatements\.org\/(?:vocab|page)\/([A-Za-z-]+)\/1\.0(?:[/?#]|$)/.exec(uri) ?? [];
  return kRightsStatements.find(([known]) => known.endsWith(`/vocab/${name}/1.0/`))?.[1] ?? uri;
}
