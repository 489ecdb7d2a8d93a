/** A list of like objects as a table: editable, and pasteable from a spreadsheet. */

import { useMemo, useState } from "preact/hooks";
import { DraftInput } from "../app/draft";
import type { Fault, Schema } from "../server/api";
import { describe, emptyMeans, pointerOf, textOf, valueAt, valueOf, withValue, type Column } from "./schema";

/** Rows of a table that are on the page at a time. */
const PAGE = 100;

export type Path = (string | number)[];

interface Props {
  title: string; description: string; path: Path; columns: Column[]; rows: unknown[]; faults: Fault[];
  change: (path: Path, value: unknown) => void;
}

/** Text of a clipboard as cells. */
export function cellsOf(text: string): string[][] {
  const lines = text.replace(/\r/g, "").replace(/\n$/, "").split("\n");
  const mark = text.includes("\t") ? "\t" : text.includes(";") ? ";" : ",";
  return lines.map((line) => line.split(mark).map((cell) => cell.trim()));
}

/** Rows with cells put in from a place on; new rows are made as needed. */
export function pasted(rows: unknown[], columns: Column[], row: number, column: number, cells: string[][]): unknown[] {
  const copy = [...rows];
  cells.forEach((line, i) => line.forEach((cell, k) => {
    const target = columns[column + k];
    if (target) copy[row + i] = withValue(copy[row + i] ?? {}, target.path, valueOf(cell, target.schema));
  }));
  return copy;
}

export function EditTable({ title, description, path, columns, rows, faults, change }: Props) {
  const own = pointerOf(path);
  const [page, setPage] = useState(0);
  const pages = Math.max(1, Math.ceil(rows.length / PAGE));
  const first = Math.min(page, pages - 1) * PAGE;
  const atWhole = faults.filter((fault) => fault.pointer === own);
  const paste = (row: number, column: number, event: ClipboardEvent): void => {
    const text = event.clipboardData?.getData("text") ?? "";
    if (!/[\t\n]/.test(text.trim())) return;
    event.preventDefault();
    change(path, pasted(rows, columns, row, column, cellsOf(text)));
  };
  return (
    <details open={rows.length <= 60} class="table-field">
      <summary>{title} ({rows.length})</summary>
      <p class="muted">{description} Paste cells from a spreadsheet into any cell.</p>
      {atWhole.map((fault) => <p class="fault" role="alert" key={fault.message}>{fault.message}</p>)}
      {pages > 1 && (
        <p>
          <button disabled={first === 0} onClick={() => setPage(first / PAGE - 1)}>Earlier rows</button> {first + 1} to {Math.min(rows.length, first + PAGE)} of {rows.length}{" "}
          <button disabled={first + PAGE >= rows.length} onClick={() => setPage(first / PAGE + 1)}>Later rows</button>
        </p>
      )}
      <div class="scroll" tabIndex={0} role="region" aria-label={title} data-pointer={own}>
        <table>
          <thead><tr>{columns.map((column) => (
            <th scope="col" key={column.path.join(".")} title={describe(column.schema)}>{column.path.join(".")}{column.required ? " *" : ""}</th>
          ))}<th scope="col"><span class="hidden">actions</span></th></tr></thead>
          <tbody>{rows.slice(first, first + PAGE).map((row, k) => {
            const i = first + k;
            return <Row key={i} {...{ row, i, path, columns, change, paste, title }} faults={faultsBelow(faults, `${own}/${i}`)} />;
          })}</tbody>
        </table>
      </div>
      <button onClick={() => { change(path, [...rows, {}]); setPage(Math.floor(rows.length / PAGE)); }}>Add a row to {title}</button>
    </details>
  );
}

const NONE: Fault[] = [];
const faultsBelow = (faults: Fault[], pointer: string): Fault[] => {
  const found = faults.filter((fault) => fault.pointer === pointer || fault.pointer.startsWith(`${pointer}/`));
  return found.length ? found : NONE;
};

interface RowProps {
  row: unknown; i: number; path: Path; columns: Column[]; faults: Fault[]; title: string;
  change: (path: Path, value: unknown) => void; paste: (row: number, column: number, event: ClipboardEvent) => void;
}

/** A row is drawn again only when it or its faults have changed. */
function Row(props: RowProps) {
  const { row, i, path, columns, faults, title, change, paste } = props;
  return useMemo(() => (
    <tr>
      {columns.map((column, k) => {
        const place = [...path, i, ...column.path];
        return (
          <td key={k}>
            <Cell column={column} value={valueAt(row, column.path)} label={`${title} ${i + 1}, ${column.path.join(" ")}`} pointer={pointerOf(place)}
              fault={faults.find((fault) => fault.pointer === pointerOf(place) || (k === 0 && fault.pointer === pointerOf([...path, i])))}
              change={(value) => change(place, value)} paste={(event) => paste(i, k, event)} />
          </td>
        );
      })}
      <td><button class="plain" aria-label={`Remove row ${i + 1} of ${title}`} onClick={() => change([...path, i], undefined)}>✕</button></td>
    </tr>
  ), [row, faults, columns, i, change]);
}

interface CellProps {
  column: Column; value: unknown; label: string; pointer: string; fault: Fault | undefined;
  change: (value: unknown) => void; paste: (event: ClipboardEvent) => void;
}

function Cell({ column, value, label, pointer, fault, change, paste }: CellProps) {
  const { schema } = column;
  const marks: Record<string, string | undefined> = { "aria-label": label, "data-pointer": pointer, "aria-invalid": fault ? "true" : undefined, title: fault?.message ?? describe(schema) };
  const error = fault && <span class="fault">{fault.message}</span>;
  const names = choicesOf(schema);
  if (names) {
    return (
      <>
        <select {...marks} value={textOf(value)} onChange={(event) => change(valueOf(event.currentTarget.value, schema))}>
          <option value="">{emptyMeans(schema)}</option>
          {names.map((name) => <option key={name} value={name}>{name}</option>)}
        </select>{error}
      </>
    );
  }
  return (
    <>
      <DraftInput marks={marks} value={textOf(value)} placeholder={emptyMeans(schema)} size={Math.max(6, Math.min(18, textOf(value).length + 1))} paste={paste}
        commit={(text) => change(valueOf(text, schema))} />{error}
    </>
  );
}

function choicesOf(schema: Schema): string[] | null {
  if (Array.isArray(schema.enum)) return schema.enum.map(String);
  return schema.type === "boolean" ? ["true", "false"] : null;
}
