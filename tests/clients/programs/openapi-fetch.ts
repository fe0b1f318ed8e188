// SPDX-License-Identifier: Apache-2.0
// Calls the daemon through openapi-fetch and the types that openapi-typescript has generated. Usage: URL MODEL
import createClient from "openapi-fetch";
import type { paths } from "./openapi.js";

const [url, id] = process.argv.slice(2) as [string, string];
const client = createClient<paths>({ baseUrl: url });
const { data, error } = await client.GET("/api/v1/models/{id}", { params: { path: { id } } });
if (!data) throw new Error(error.title);
const missing = await client.GET("/api/v1/models/{id}", { params: { path: { id: id.replace(/./g, "0") } } });
console.log(JSON.stringify({ title: data.title, problem: missing.error?.title, status: missing.response.status }));
