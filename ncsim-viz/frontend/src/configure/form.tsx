/** A form from a JSON Schema and a document: what a plug-in registers appears without a change here. */

import { DraftArea, DraftInput } from "../app/draft";
import type { Fault, Schema } from "../server/api";
import {
  columnsOf, describe, emptyMeans, isRequired, namesOf, objectForm, optionsOf, pointerOf, propertiesOf, resolved, shapeOf, textOf, valueOf, withValue,
} from "./schema";
import { EditTable, type Path } from "./table";

export interface FieldProps {
  name: string; schema: Schema; root: Schema; value: unknown; path: Path; faults: Fault[]; required: boolean;
  change: (path: Path, value: unknown) => void;
}

const at = (value: unknown, key: string): unknown => (value !== null && typeof value === "object" ? (value as Record<string, unknown>)[key] : undefined);

/** Every property of an object. */
export function Fields({ schema, root, value, path, faults, change }: Omit<FieldProps, "name" | "required">) {
  return (
    <>{propertiesOf(schema, root).map(([name, each]) => (
      <Field key={name} name={name} schema={each} root={root} value={at(value, name)} path={[...path, name]} faults={faults}
        required={isRequired(schema, name)} change={change} />
    ))}</>
  );
}

export function Field(props: FieldProps) {
  const { schema, root } = props;
  switch (shapeOf(schema, root)) {
    case "object": return <Group {...props} />;
    case "table": return <Table {...props} />;
    case "list": return <List {...props} />;
    case "component": return <Component {...props} />;
    case "choice": return <Choice {...props} names={namesOf(schema, root)} />;
    case "boolean": return <Choice {...props} names={[true, false]} />;
    case "raw": return <Raw {...props} />;
    default: return <Input {...props} />;
  }
}

const words = (name: string): string => name.replaceAll("_", " ");

/** An object; open where the document says something in it, or must. */
function Group(props: FieldProps) {
  const { name, schema, value, required, path, faults } = props;
  const own = faults.filter((fault) => fault.pointer === pointerOf(path));
  return (
    <details open={required || value !== undefined || path.length <= 2} class="group">
      <summary>{words(name)}</summary>
      {describe(schema) && <p class="muted">{describe(schema)}</p>}
      <Faults faults={own} />
      <Fields {...props} />
    </details>
  );
}

function Table({ name, schema, root, value, path, faults, change }: FieldProps) {
  const items = resolved(schema.items as Schema, root);
  return <EditTable title={words(name)} description={describe(schema)} path={path} columns={columnsOf(items, root) ?? []} faults={faults} change={change}
    rows={Array.isArray(value) ? value : []} />;
}

/** A list of objects that hold tables themselves. */
function List({ name, schema, root, value, path, faults, change }: FieldProps) {
  const items = resolved(schema.items as Schema, root);
  const rows = Array.isArray(value) ? value : [];
  return (
    <fieldset>
      <legend>{words(name)} ({rows.length})</legend>
      <Faults faults={faults.filter((fault) => fault.pointer === pointerOf(path))} />
      {rows.map((row, i) => (
        <fieldset key={i}>
          <legend>{textOf(at(row, "id")) || `${words(name)} ${i + 1}`}</legend>
          <Faults faults={faults.filter((fault) => fault.pointer === pointerOf([...path, i]))} />
          <Fields schema={items} root={root} value={row} path={[...path, i]} faults={faults} change={change} />
          <button onClick={() => change([...path, i], undefined)}>Remove {textOf(at(row, "id")) || `entry ${i + 1}`}</button>
        </fieldset>
      ))}
      <button onClick={() => change(path, [...rows, {}])}>Add to {words(name)}</button>
    </fieldset>
  );
}

/** A plug-in by name, and the options that it declares. */
function Component(props: FieldProps) {
  const { schema, root, value, path, change } = props;
  const form = objectForm(schema, root) as Schema;
  const name = typeof value === "string" ? value : textOf(at(value, "type"));
  const options = name ? optionsOf(form, name, root) : null;
  const pick = (_: Path, changed: unknown): void => change(path, changed);
  /** Without options, a component is its bare name. */
  const setOption = (place: Path, changed: unknown): void => {
    const whole = typeof value === "string" ? { type: name } : value;
    const updated = withValue(whole, place.slice(path.length), changed);
    change(path, at(updated, "options") === undefined ? name : updated);
  };
  const has = options !== null && propertiesOf(options, root).length > 0;
  return (
    <div class="component">
      <Choice {...props} value={name} names={namesOf(schema, root)} change={pick} />
      {options && describe(options) && <p class="muted">{describe(options)}</p>}
      {has && <div class="options"><Fields schema={options} root={root} value={at(value, "options")} path={[...path, "options"]} faults={props.faults} change={setOption} /></div>}
    </div>
  );
}

/** Faults that no deeper field shows. */
function Faults({ faults, id }: { faults: Fault[]; id?: string }) {
  if (!faults.length) return null;
  return <div id={id} class="fault" role="alert">{faults.map((fault) => <p key={fault.message}>{fault.message}{fault.suggestion && ` Did you mean ${fault.suggestion}?`}</p>)}</div>;
}

/** A field's faults: its own, and of a component those of the whole object form. */
function faultsOf({ faults, path }: FieldProps): Fault[] {
  const own = pointerOf(path);
  return faults.filter((fault) => fault.pointer === own || fault.pointer === `${own}/type`);
}

function Labelled({ props, children }: { props: FieldProps; children: (id: string, marks: Record<string, string | undefined>) => preact.ComponentChildren }) {
  const pointer = pointerOf(props.path);
  const id = `f${pointer}`;
  const own = faultsOf(props);
  const help = describe(props.schema);
  const described = [help && `${id}-help`, own.length ? `${id}-fault` : ""].filter(Boolean).join(" ");
  return (
    <div class="field">
      <label for={id}>{words(props.name)}{props.required ? " *" : ""}</label>
      {children(id, { id, "data-pointer": pointer, "aria-invalid": own.length ? "true" : undefined, "aria-describedby": described || undefined })}
      {help && <p id={`${id}-help`} class={help.length > 160 ? "hidden" : "muted"}>{help}</p>}
      <Faults id={`${id}-fault`} faults={own} />
    </div>
  );
}

function Input(props: FieldProps) {
  const { schema, value, path, change } = props;
  const isNumber = shapeOf(schema, props.root) === "number";
  return (
    <Labelled props={props}>{(_, marks) => (
      <DraftInput marks={marks} value={textOf(value)} placeholder={emptyMeans(schema)} isNumber={isNumber} commit={(text) => change(path, valueOf(text, schema))} />
    )}</Labelled>
  );
}

function Choice(props: FieldProps & { names: unknown[] }) {
  const { schema, value, path, change, names, required } = props;
  const byText = new Map(names.map((name) => [String(name), name]));
  const current = textOf(value);
  const empty = emptyMeans(schema);
  return (
    <Labelled props={props}>{(_, marks) => (
      <select {...marks} value={current} onChange={(event) => change(path, byText.get(event.currentTarget.value))}>
        {(!required || !current) && <option value="">{empty ? `default: ${empty}` : "default"}</option>}
        {current && !byText.has(current) && <option value={current}>{current}</option>}
        {names.map((name) => <option key={String(name)} value={String(name)}>{String(name)}</option>)}
      </select>
    )}</Labelled>
  );
}

/** What the form has no field for: JSON as text. */
function Raw(props: FieldProps) {
  const { value, path, change } = props;
  const read = (text: string): unknown => {
    if (!text.trim()) return undefined;
    try {
      return JSON.parse(text);
    } catch {
      return text;
    }
  };
  return (
    <Labelled props={props}>{(_, marks) => (
      <DraftArea marks={marks} placeholder="JSON" value={value === undefined ? "" : JSON.stringify(value)} commit={(text) => change(path, read(text))} />
    )}</Labelled>
  );
}
