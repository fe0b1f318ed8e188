// SPDX-License-Identifier: Apache-2.0
import { Api } from "@console/api.ts";
import { Problem } from "@console/problem.ts";

interface Asked {
  path: string;
  headers: Record<string, string>;
  signal: AbortSignal;
}

/**
 * Replaces `fetch`. Each request gets the next element of `answers`: a response, an error like that
 * of a broken connection, or no response ("never"). Returns a list to which every request is added.
 */
function network(...answers: (Response | Error | "never")[]): Asked[] {
  const asked: Asked[] = [];
  vi.stubGlobal("fetch", (path: string, { headers, signal }: Asked) => {
    asked.push({ path, headers, signal });
    const answer = answers.shift();
    if (answer === "never") return new Promise((_, reject) => signal.addEventListener("abort", () => reject(signal.reason)));
    return answer instanceof Response ? Promise.resolve(answer) : Promise.reject(answer);
  });
  return asked;
}

const json = (body: object, status = 200) => new Response(JSON.stringify(body), { status });
const never = new AbortController().signal;

afterEach(() => vi.unstubAllGlobals());

test("the token goes into one field, and into no address", async () => {
  const asked = network(json({}));
  await new Api("vtr_secret").get("/jobs", never);
  expect(asked[0]?.headers["Authorization"]).toBe("Bearer vtr_secret");
  expect(asked[0]?.path).toBe("/api/v1/jobs");
});

test("an emergency stop lets go of all that holds a connection, and is not let go itself", async () => {
  const asked = network("never", "never", json({})), api = new Api("t");
  const held = [api.get("/scanners", never), api.blob("/scanners/a/preview", never)];
  await api.stop("a");
  expect((await Promise.allSettled(held)).map(({ status }) => status)).toEqual(["rejected", "rejected"]);
  expect(asked[2]?.path).toBe("/api/v1/scanners/a/stop");
  network(json({ jobs: [] }));
  // The abort of the first request must not affect the next request of the same client.
  expect(await api.get("/jobs", never)).toEqual({ jobs: [] });
});

test("what may have begun is asked for under the same key, until there is an answer", async () => {
  const asked = network(new TypeError("network"), json({ job: "1" }), json({ job: "2" }), json({ title: "Conflict" }, 409), json({ job: "3" })), api = new Api("t");
  const order = () => api.begin("/models", { upload: "u" }).catch((error) => error);
  for (let i = 0; i < 5; ++i) await order();
  const keys = asked.map(({ headers }) => headers["Idempotency-Key"]);
  expect(keys[0]).toBe(keys[1]);
  expect(new Set(keys).size).toBe(4);
});

test("a token that is not in force ends the session", async () => {
  network(json({ title: "Unauthorized", detail: "the token is unknown or revoked; ask for a new one" }, 401));
  const api = new Api("t"), told: Problem[] = [];
  api.onRefused = (problem) => told.push(problem);
  await expect(api.get("/jobs", never)).rejects.toBeInstanceOf(Problem);
  expect(told[0]?.message).toBe("the token is unknown or revoked; ask for a new one");
});
