// SPDX-License-Identifier: Apache-2.0
import { callsOf, describe as words, fieldsOf, type Document } from "@docs/openapi.ts";

const api: Document = {
  info: { title: "", description: "" },
  paths: {
    "/things": {
      post: {
        operationId: "makeThing",
        summary: "Makes one.",
        tags: ["things"],
        parameters: [{ $ref: "#/components/parameters/key" }],
        requestBody: { content: { "application/json": { schema: { $ref: "#/components/schemas/Order" } } } },
        responses: { "202": { description: "", content: { "application/json": { schema: { $ref: "#/components/schemas/Thing" } } } } },
        "x-role": "operator",
      },
    },
  },
  components: {
    parameters: { key: { name: "Idempotency-Key", in: "header", schema: { type: "string" } } },
    schemas: {
      Thing: { type: "object", required: ["id"], properties: { id: { type: "string" }, parts: { type: "array", items: { $ref: "#/components/schemas/Thing" } } } },
      Base: { properties: { bits: { type: "integer", minimum: 10, maximum: 16, default: 12 } } },
      Order: { allOf: [{ $ref: "#/components/schemas/Base" }], properties: { name: { type: "string", description: "Its `name`" } } },
    },
  },
};

describe("the words for a schema", () => {
  test("tell type, bounds, choice and default", () => {
    expect(words({ type: "integer", minimum: 1, maximum: 200, default: 50 })).toBe("integer, 1 to 200, default 50");
    expect(words({ enum: ["a", "b"] })).toBe("a | b");
    expect(words({ type: ["string", "null"] })).toBe("string or null");
    expect(words({ anyOf: [{ $ref: "#/components/schemas/Id" }, { type: "null" }] })).toBe("Id or null");
    expect(words({ type: "array", items: { $ref: "#/x/Thing" } })).toBe("list of Thing");
  });
});

describe("the calls of a document", () => {
  test("have parameters, body and answer", () => {
    const [call] = callsOf(api);
    expect(call).toMatchObject({ method: "POST", path: "/things", role: "operator", status: "202", answer: "Thing" });
    expect(call?.parameters[0]).toMatchObject({ name: "Idempotency-Key", type: "string (header)" });
    expect(call?.body.map(({ name }) => name)).toEqual(["name", "bits"]);
    expect(call?.fields[0]).toMatchObject({ name: "id", isRequired: true });
  });
  test("take the members of what a schema is made of", () => {
    expect(fieldsOf({ $ref: "#/components/schemas/Order" }, api)[1]?.type).toBe("integer, 10 to 16, default 12");
  });
});
