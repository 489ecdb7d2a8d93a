/** A table with only the rows on screen in the page; its headings sort it. */

import { useMemo, useState } from "preact/hooks";
import type { Selection } from "../state";
import type { Cell, Context, Table, View } from "../views/view";

const HEIGHT = 26;
const SHOWN = 80;
const AHEAD = 10;

interface Order { column: number; down: boolean }

/** Numbers of the rows in order of a column; empty cells last. */
export function sorted(rows: Cell[][], order: Order | null): number[] {
  const all = rows.map((_, i) => i);
  if (!order) return all;
  const { column, down } = order;
  const key = (i: number): Cell => {
    const cell = rows[i][column] ?? null;
    return typeof cell === "string" && cell !== "" && Number.isFinite(Number(cell)) ? Number(cell) : cell;
  };
  const compare = (a: Cell, b: Cell): number => {
    if (a === null || b === null) return Number(a === null) - Number(b === null);
    const sign = typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b), "en", { numeric: true });
    return down ? -sign : sign;
  };
  return all.sort((a, b) => compare(key(a), key(b)) || a - b);
}

export function Rows({ view, ctx, version }: { view: View; ctx: Context; version: number }) {
  const { ui } = ctx;
  const table = useMemo(() => view.table(ctx), [view, version, ctx.extras, view.tableFollows ? ui.event : 0, ui.window, ui.search, ui.selection, ui.dag, ui.sheet, ui.heat]);
  const is = (chosen: Selection | null): boolean => chosen !== null && chosen.kind === ui.selection?.kind && chosen.id === ui.selection.id;
  const choose = (row: number): void => {
    const [event, pick] = [table.event?.(row), table.pick?.(row)];
    if (event !== undefined) ctx.goTo(event);
    if (pick) ctx.select(pick);
  };
  const isNow = (row: number): boolean => is(table.pick?.(row) ?? null) || table.event?.(row) === ui.event;
  return <TableRows title={view.title} table={table} isChosen={isNow} choose={choose} />;
}

interface Props {
  title: string; table: Table; isChosen: (row: number) => boolean; choose: (row: number) => void;
}

function TableRows({ title, table, isChosen, choose }: Props) {
  const [top, setTop] = useState(0);
  const [order, setOrder] = useState<Order | null>(null);
  const numbers = useMemo(() => sorted(table.rows, order), [table, order]);
  const first = Math.max(0, Math.floor(top / HEIGHT) - AHEAD);
  const sort = (column: number): void => setOrder(order?.column === column ? (order.down ? null : { column, down: true }) : { column, down: false });
  return (
    <div class="rows" tabIndex={0} role="region" aria-label={`${title}: table`} onScroll={(event) => setTop(event.currentTarget.scrollTop)}>
      {table.note && <p class="note">{table.note}</p>}
      <table aria-rowcount={table.rows.length + 1}>
        <caption>{title}: {table.rows.length} {table.rows.length === 1 ? "row" : "rows"}</caption>
        <thead><tr>{table.columns.map((name, i) => (
          <th scope="col" key={i} aria-sort={order?.column === i ? (order.down ? "descending" : "ascending") : undefined}>
            <button class="plain" onClick={() => sort(i)}>{name}{order?.column === i ? (order.down ? " ▼" : " ▲") : ""}</button>
          </th>
        ))}</tr></thead>
        <tbody>
          <Gap rows={first} />
          {numbers.slice(first, first + SHOWN).map((row) => {
            const isButton = table.event !== undefined || (table.pick?.(row) ?? null) !== null;
            return (
              <tr key={row} aria-current={isChosen(row) ? "true" : undefined}>{table.rows[row].map((cell, k) => (
                <td key={k} class={typeof cell === "number" ? "number" : undefined}>
                  {k === 0 && isButton ? <button class="link" onClick={() => choose(row)}>{shown(cell)}</button> : shown(cell)}
                </td>
              ))}</tr>
            );
          })}
          <Gap rows={Math.max(0, numbers.length - first - SHOWN)} />
        </tbody>
      </table>
    </div>
  );
}

const shown = (cell: Cell): string | number => (typeof cell === "boolean" ? (cell ? "yes" : "no") : (cell ?? ""));

const Gap = ({ rows }: { rows: number }) => <tr aria-hidden="true" class="gap" style={{ height: `${rows * HEIGHT}px` }} />;
