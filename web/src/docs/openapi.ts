// SPDX-License-Identifier: Apache-2.0
// Converts an OpenAPI document to the flat lists that the page /docs shows.
export interface Schema {
  $ref?: string;
  type?: string | string[];
  description?: string;
  properties?: Record<string, Schema>;
  required?: string[];
  items?: Schema;
  enum?: unknown[];
  const?: unknown;
  anyOf?: Schema[];
  allOf?: Schema[];
  default?: unknown;
  minimum?: number;
  maximum?: number;
}

interface Parameter {
  name: string;
  in: string;
  required?: boolean;
  description?: string;
  schema: Schema;
}

interface Media {
  schema?: Schema;
}

interface Operation {
  operationId: string;
  summary: string;
  tags: string[];
  parameters?: { $ref: string }[];
  requestBody?: { content: Record<string, Media> };
  responses: Record<string, { description: string; content?: Record<string, Media> }>;
  "x-role"?: string;
}

export interface Document {
  info: { title: string; description: string };
  paths: Record<string, Record<string, Operation>>;
  components: { schemas: Record<string, Schema>; parameters: Record<string, Parameter> };
}

/** A row of a table: a parameter, or a member of a request or response body. */
export interface FieldRow {
  name: string;
  type: string;
  isRequired: boolean;
  about: string;
}

export interface ApiOperation {
  id: string;
  noun: string;
  method: string;
  path: string;
  summary: string;
  role: string | null;
  parameters: FieldRow[];
  body: FieldRow[];
  status: string;
  answer: string;
  fields: FieldRow[];
}

const nameOf = (ref: string): string => ref.slice(ref.lastIndexOf("/") + 1);

/** Describes a schema in words, such as "integer, 1 to 200, default 50" or "list of Model". */
export function describe(schema: Schema): string {
  if (schema.$ref) return nameOf(schema.$ref);
  if (schema.const !== undefined) return JSON.stringify(schema.const);
  if (schema.enum) return withDefault(schema.enum.map(String).join(" | "), schema);
  if (schema.anyOf) return withDefault(schema.anyOf.map(describe).join(" or "), schema);
  if (schema.items) return `list of ${describe(schema.items)}`;
  const type = Array.isArray(schema.type) ? schema.type.join(" or ") : (schema.type ?? "any");
  const { minimum, maximum } = schema;
  if (minimum !== undefined && maximum !== undefined) return withDefault(`${type}, ${minimum} to ${maximum}`, schema);
  return withDefault(minimum === undefined ? type : `${type}, at least ${minimum}`, schema);
}

function withDefault(text: string, schema: Schema): string {
  return schema.default === undefined ? text : `${text}, default ${String(schema.default)}`;
}

/** Returns the members of an object schema, including those of the schemas in its `allOf`. */
export function fieldsOf(schema: Schema | undefined, document: Document): FieldRow[] {
  if (!schema) return [];
  if (schema.$ref) return fieldsOf(document.components.schemas[nameOf(schema.$ref)], document);
  const own = Object.entries(schema.properties ?? {}).map(([name, value]) => ({
    name,
    type: describe(value),
    isRequired: schema.required?.includes(name) ?? false,
    about: value.description ?? "",
  }));
  return [...own, ...(schema.allOf ?? []).flatMap((part) => fieldsOf(part, document))];
}

export function callsOf(document: Document): ApiOperation[] {
  return Object.entries(document.paths).flatMap(([path, methods]) =>
    Object.entries(methods).map(([method, operation]) => callOf(path, method, operation, document)),
  );
}

function callOf(path: string, method: string, operation: Operation, document: Document): ApiOperation {
  const status = Object.keys(operation.responses).find((key) => key !== "default") ?? "";
  const [type, media] = Object.entries(operation.responses[status]?.content ?? {})[0] ?? ["", {}];
  const schema = (media as Media).schema;
  return {
    id: operation.operationId,
    noun: operation.tags[0] ?? "",
    method: method.toUpperCase(),
    path,
    summary: operation.summary,
    role: operation["x-role"] ?? null,
    parameters: (operation.parameters ?? []).map(({ $ref }) => fieldOf(document.components.parameters[nameOf($ref)])),
    body: fieldsOf(Object.values(operation.requestBody?.content ?? {})[0]?.schema, document),
    status,
    answer: schema ? describe(schema) : type,
    fields: fieldsOf(schema, document),
  };
}

function fieldOf(parameter: Parameter | undefined): FieldRow {
  if (!parameter) throw new Error("a parameter is not in the document");
  const where = parameter.in === "query" ? "" : ` (${parameter.in})`;
  return {
    name: parameter.name,
    type: describe(parameter.schema) + where,
    isRequired: parameter.required ?? false,
    about: parameter.description ?? "",
  };
}
