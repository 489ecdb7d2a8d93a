import { describe, expect, test } from "vitest";
import composed from "../../../schemas/scenario.schema.json";
import { next } from "../src/configure/configure";
import { begun } from "../src/configure/presets";
import { columnsOf, namesOf, objectForm, optionsOf, propertiesOf, resolved, shapeOf, valueAt, valueOf, withValue } from "../src/configure/schema";
import { cellsOf, pasted } from "../src/configure/table";
import type { Schema } from "../src/server/api";

const root = composed as unknown as Schema;
const below = (schema: Schema, name: string): Schema => propertiesOf(schema, root).find(([key]) => key === name)?.[1] as Schema;
const scenario = below(root, "scenario");
const config = below(scenario, "config");

describe("the composed schema", () => {
  test("gives every part of a scenario a field that fits", () => {
    const shapes = Object.fromEntries(propertiesOf(config, root).map(([name, each]) => [name, shapeOf(each, root)]));
    expect(shapes).toMatchObject({ seed: "number", scheduler: "component", routing: "component", interference: "component", rf: "object" });
    expect(shapeOf(below(below(scenario, "network"), "nodes"), root)).toBe("table");
    expect(shapeOf(below(scenario, "dags"), root)).toBe("list");
  });

  test("names the columns of nodes with their position taken apart", () => {
    const nodes = below(below(scenario, "network"), "nodes");
    const columns = columnsOf(resolved(nodes.items as Schema, root), root) ?? [];
    expect(columns.map((each) => [each.path.join("."), each.required])).toEqual([["id", true], ["compute_capacity", true], ["position.x", false], ["position.y", false]]);
  });

  test("offers every component, and those options that it declares", () => {
    const model = below(config, "link_model");
    expect(namesOf(model, root)).toEqual(["static", "wifi"]);
    const options = optionsOf(objectForm(model, root) as Schema, "wifi", root) as Schema;
    expect(propertiesOf(options, root).map(([name]) => name)).toEqual(["rate"]);
    expect(propertiesOf(optionsOf(objectForm(model, root) as Schema, "static", root) as Schema, root)).toEqual([]);
  });
});

describe("documents", () => {
  test("are changed in one place, and the rest is shared", () => {
    const before = { a: { b: [{ c: 1 }, { c: 2 }] }, d: {} };
    const after = withValue(before, ["a", "b", 1, "c"], 5) as typeof before;
    expect(after).toEqual({ a: { b: [{ c: 1 }, { c: 5 }] }, d: {} });
    expect(after.a.b[0]).toBe(before.a.b[0]);
    expect(before.a.b[1].c).toBe(2);
  });

  test("lose what is emptied, rows and objects too", () => {
    expect(withValue({ a: [1, 2, 3] }, ["a", 1], undefined)).toEqual({ a: [1, 3] });
    expect(withValue({ a: { b: 1 } }, ["a", "b"], undefined)).toEqual({});
    expect(withValue({}, ["x", "y"], 1)).toEqual({ x: { y: 1 } });
    expect(valueAt({ x: { y: 1 } }, ["x", "y", "z"])).toBeUndefined();
  });

  test("take what was typed as what is meant, and wrong input as it is", () => {
    expect(valueOf("2.50", { type: "number" })).toBe(2.5);
    expect(valueOf("two", { type: "number" })).toBe("two");
    expect(valueOf("7", { type: "string" })).toBe("7");
    expect(valueOf("20", { enum: [20, 40] })).toBe(20);
    expect(valueOf("true", { type: "boolean" })).toBe(true);
    expect(valueOf("", { type: "number" })).toBeUndefined();
  });
});

describe("tables", () => {
  const columns = [{ path: ["id"], schema: { type: "string" }, required: true }, { path: ["position", "x"], schema: { type: "number" }, required: false }];

  test("take cells of a spreadsheet from a place on, in new rows as needed", () => {
    expect(pasted([{ id: "a" }], columns, 0, 0, cellsOf("b\t1\r\nc\t2\r\n"))).toEqual([{ id: "b", position: { x: 1 } }, { id: "c", position: { x: 2 } }]);
    expect(pasted([{ id: "a" }, { id: "b" }], columns, 1, 1, cellsOf("5\t6"))).toEqual([{ id: "a" }, { id: "b", position: { x: 5 } }]);
  });

  test("take comma- and semicolon-separated text", () => {
    expect(cellsOf("a, b\nc,d")).toEqual([["a", "b"], ["c", "d"]]);
    expect(cellsOf("1,5;2\n")).toEqual([["1,5", "2"]]);
  });
});

test("a generator begins with something in every parameter that it needs", () => {
  const parameters = { type: "object", required: ["rows", "share", "kind"], properties: {
    rows: { type: "integer", minimum: 6 }, share: { type: "number", minimum: 0, maximum: 1 }, kind: { enum: ["x", "y"] }, free: { type: "number" } } };
  expect(begun({ type: "g", summary: "", parameters, is_random: false })).toEqual({ type: "g", rows: 6, share: 0.5, kind: "x" });
});

test("names count on", () => {
  expect([next("run-9"), next("a")]).toEqual(["run-10", "a-2"]);
});
