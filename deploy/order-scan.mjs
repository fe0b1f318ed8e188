// SPDX-License-Identifier: Apache-2.0
// Requests a public scan of the object on a scanner's table, and writes the scan's ID to the file KNOWN. Does nothing
// if KNOWN already names a scan that has neither failed nor been cancelled. Usage: node order-scan.mjs VITRINE DATA URL
// SCANNER STEPS TITLE KNOWN
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";

const [vitrine, data, url, scanner, steps, title, known] = process.argv.slice(2);
if (!known) throw new Error("Usage: order-scan.mjs VITRINE DATA URL SCANNER STEPS TITLE KNOWN");

async function isThere() {
  if (!existsSync(known)) return false;
  const answer = await fetch(`${url}/api/v1/scans/${readFileSync(known, "utf8").trim()}`);
  return answer.ok && !["failed", "cancelled"].includes((await answer.json()).state);
}

/** Calls `use` with a new token of the role operator, and revokes the token afterwards. */
async function withToken(use) {
  const token = (...words) => JSON.parse(execFileSync(vitrine, ["token", ...words, "--data", data, "--json"]));
  const { id, token: secret } = token("create", "--role", "operator", "--label", "demo");
  try {
    return await use(secret);
  } finally {
    token("revoke", "--id", id);
  }
}

async function order(token) {
  const answer = await fetch(`${url}/api/v1/scans`, {
    method: "POST",
    headers: { Authorization: `Bearer ${token}`, "Content-Type": "application/json" },
    body: JSON.stringify({ scanner, steps: Number(steps), publish: true, metadata: { title } }),
  });
  const body = await answer.json();
  if (!answer.ok) throw new Error([body.detail, ...(body.errors ?? []).map((error) => `${error.parameter}: ${error.detail}`)].join("; "));
  return body.id;
}

try {
  if (!(await isThere())) writeFileSync(known, `${await withToken(order)}\n`);
} catch (error) {
  console.error(`cannot order the scan: ${error.message}`);
  process.exit(1);
}
