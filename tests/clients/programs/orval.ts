// SPDX-License-Identifier: Apache-2.0
// Calls the daemon through the functions that orval has generated. Usage: URL MODEL
import { getModel } from "./orval-client.js";

const [url, id] = process.argv.slice(2) as [string, string];
const request = globalThis.fetch;
globalThis.fetch = (path, options) => request(new URL(String(path), url), options); // the OpenAPI document has relative URLs (server "/")
const { data, status } = await getModel(id);
const missing = await getModel(id.replace(/./g, "0"));
if (status !== 200) throw new Error(data.title);
console.log(JSON.stringify({ title: data.title, status: missing.status }));
