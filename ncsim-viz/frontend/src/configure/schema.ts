/** Reading a JSON Schema (draft-07) for a form: nothing here knows a key or a plug-in of ncsim. */

import type { Schema } from "../server/api";

export type Shape = "object" | "table" | "list" | "component" | "choice" | "number" | "boolean" | "text" | "raw";

const is = (value: unknown): value is Schema => value !== null && typeof value === "object" && !Array.isArray(value);
const listOf = (value: unknown): Schema[] => (Array.isArray(value) ? value.filter(is) : []);

/** A schema with its references and conjunctions put in. */
export function resolved(schema: Schema, root: Schema): Schema {
  let found = schema;
  if (typeof found.$ref === "string") {
    const target = found.$ref.replace(/^#\//, "").split("/").reduce<unknown>((at, key) => (is(at) ? at[key] : undefined), root);
    found = { ...(is(target) ? resolved(target, root) : {}), ...found, $ref: undefined };
  }
  for (const part of listOf(found.allOf)) if (!is(part.if)) found = { ...resolved(part, root), ...found };
  return found;
}

export function propertiesOf(schema: Schema, root: Schema): [string, Schema][] {
  return Object.entries(is(schema.properties) ? schema.properties : {}).filter(([, each]) => is(each)).map(([name, each]) => [name, resolved(each as Schema, root)]);
}

export const isRequired = (schema: Schema, name: string): boolean => Array.isArray(schema.required) && schema.required.includes(name);

/** Types that a schema allows, without null. */
export function typesOf(schema: Schema): string[] {
  const all = Array.isArray(schema.type) ? schema.type : [schema.type];
  return all.filter((each): each is string => typeof each === "string" && each !== "null");
}

/** The alternative of a component that has options: an object with `type` and `options`. */
export function objectForm(schema: Schema, root: Schema): Schema | null {
  const found = listOf(schema.anyOf).concat(listOf(schema.oneOf)).map((each) => resolved(each, root)).find((each) => {
    const names = propertiesOf(each, root).map(([name]) => name);
    return names.includes("type") && names.includes("options");
  });
  return found ?? null;
}

/** Names of a choice: those of an `enum`, also inside alternatives. */
export function namesOf(schema: Schema, root: Schema): unknown[] {
  if (Array.isArray(schema.enum)) return schema.enum;
  for (const each of listOf(schema.anyOf).concat(listOf(schema.oneOf))) {
    const found = namesOf(resolved(each, root), root);
    if (found.length) return found;
  }
  return [];
}

/** The schema of a component's options, from the conditions of its object form. */
export function optionsOf(form: Schema, name: string, root: Schema): Schema | null {
  for (const part of listOf(form.allOf)) {
    const when = is(part.if) ? resolved(part.if, root) : null;
    const type = when ? propertiesOf(when, root).find(([key]) => key === "type")?.[1] : undefined;
    const names = type ? (Array.isArray(type.enum) ? type.enum : [type.const]) : [];
    if (!names.includes(name) || !is(part.then)) continue;
    return propertiesOf(part.then, root).find(([key]) => key === "options")?.[1] ?? null;
  }
  return null;
}

/** Columns of a table: the scalar properties of its items, those of nested objects by a dotted path. */
export interface Column { path: string[]; schema: Schema; required: boolean }
export function columnsOf(items: Schema, root: Schema): Column[] | null {
  const columns: Column[] = [];
  for (const [name, each] of propertiesOf(items, root)) {
    const shape = shapeOf(each, root);
    const required = isRequired(items, name);
    if (shape === "object") {
      const inner = columnsOf(each, root);
      if (!inner) return null;
      columns.push(...inner.map((column) => ({ ...column, path: [name, ...column.path], required: required && column.required })));
    } else if (["choice", "number", "boolean", "text"].includes(shape)) columns.push({ path: [name], schema: each, required });
    else return null;
  }
  return columns.length ? columns : null;
}

export function shapeOf(schema: Schema, root: Schema): Shape {
  if (objectForm(schema, root)) return "component";
  if (namesOf(schema, root).length) return "choice";
  const [type] = typesOf(schema);
  switch (type) {
    case "object": return is(schema.properties) ? "object" : "raw";
    case "array": {
      const items = is(schema.items) ? resolved(schema.items, root) : null;
      if (!items || !typesOf(items).includes("object")) return "raw";
      return columnsOf(items, root) ? "table" : "list";
    }
    case "integer": case "number": return typesOf(schema).includes("string") ? "text" : "number";
    case "boolean": return "boolean";
    case "string": return "text";
    default: return "raw";
  }
}

/** What somebody typed as a value: a number where one is meant and it is one, else the text as it is. */
export function valueOf(text: string, schema: Schema): unknown {
  if (text === "") return undefined;
  if (Array.isArray(schema.enum)) return schema.enum.find((each) => String(each) === text) ?? text;
  if (typesOf(schema).includes("boolean") && (text === "true" || text === "false")) return text === "true";
  const isNumeric = typesOf(schema).some((each) => each === "number" || each === "integer");
  return isNumeric && text.trim() !== "" && Number.isFinite(Number(text)) ? Number(text) : text;
}

export const textOf = (value: unknown): string => (value === undefined || value === null ? "" : typeof value === "object" ? JSON.stringify(value) : String(value));

export const describe = (schema: Schema): string => (typeof schema.description === "string" ? schema.description : "");

/** What a field that is left empty means, in words. */
export function emptyMeans(schema: Schema): string {
  return "default" in schema ? (schema.default === null ? "none" : textOf(schema.default)) : "";
}

const COUNT = 4;
const LENGTH = 100;

/** A value to begin with: the default, the first choice, or a small number within bounds. */
export function sampleOf(schema: Schema): unknown {
  if ("default" in schema) return schema.default;
  if (Array.isArray(schema.enum)) return schema.enum[0];
  const [type] = typesOf(schema);
  const least = Number(schema.minimum ?? schema.exclusiveMinimum ?? -Infinity);
  const most = Number(schema.maximum ?? Infinity);
  if (type === "integer") return Math.min(most, Math.max(least, COUNT));
  if (type === "number") return most <= LENGTH && least > -Infinity ? (least + most) / 2 : Math.max(least, LENGTH);
  return type === "boolean" ? false : undefined;
}

export const pointerOf = (path: (string | number)[]): string => path.map((each) => `/${String(each).replaceAll("~", "~0").replaceAll("/", "~1")}`).join("");

/** A copy of a value with one place changed; `undefined` takes the place away. */
export function withValue(whole: unknown, path: (string | number)[], value: unknown): unknown {
  if (!path.length) return value;
  const [key, ...rest] = path;
  if (Array.isArray(whole)) {
    const copy = [...whole];
    const inner = withValue(copy[Number(key)], rest, value);
    if (inner === undefined) copy.splice(Number(key), 1);
    else copy[Number(key)] = inner;
    return copy;
  }
  const copy: Record<string, unknown> = is(whole) ? { ...whole } : {};
  const inner = withValue(copy[key], rest, value);
  if (inner === undefined || (rest.length > 0 && is(inner) && !Object.keys(inner).length)) delete copy[key];
  else copy[key] = inner;
  return copy;
}

export const valueAt = (whole: unknown, path: (string | number)[]): unknown =>
  path.reduce<unknown>((at, key) => (at !== null && typeof at === "object" ? (at as Record<string, unknown>)[key] : undefined), whole);
