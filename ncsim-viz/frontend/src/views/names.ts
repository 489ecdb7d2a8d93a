/** Names of what can be selected, and tables that several views use. */

import type { Run } from "../data/run";
import { K, KINDS } from "../data/run";
import { number, seconds } from "../draw/format";
import type { Selection } from "../state";
import type { Cell, Context } from "./view";

export function nameOf(run: Run, selection: Selection): string {
  switch (selection.kind) {
    case "task": return `task ${run.taskName(selection.id)}`;
    case "transfer": return `transfer ${run.transferName(selection.id)}`;
    case "link": return `link ${run.links[selection.id]?.id}`;
    case "node": return `node ${run.nodes[selection.id]?.id}`;
    case "recalc": return `recalculation ${selection.id + 1}`;
    case "row": return `run ${selection.id + 1} of the study`;
  }
}

/** Whether a selection names something that exists, as a hand-written address may not. */
export function exists(run: Run, selection: Selection, rows = 0): boolean {
  const counts = {
    row: rows,
    task: run.tasks, transfer: run.transfers, link: run.links.length, node: run.nodes.length, recalc: run.recalcs,
  };
  return selection.id < counts[selection.kind];
}

export const causeOf = (run: Run, recalc: number): string =>
  `${run.rcIsStart.data[recalc] ? "▲ start" : "● finish"} of ${run.transferName(run.rcBy.data[recalc])}`;

/** An event in words. */
export function sentence(run: Run, event: number): string {
  const argument = run.evArg.data[event];
  switch (run.evKind.data[event]) {
    case K.inject: return `DAG ${run.dags[argument].id} enters with ${run.dags[argument].tasks} tasks`;
    case K.place: return `tasks of ${run.dags[argument].id} are placed`;
    case K.ready: return `${run.taskName(argument)} is ready on ${nodeOf(run, argument)}`;
    case K.start: return `${run.taskName(argument)} starts on ${nodeOf(run, argument)}`;
    case K.end: return `${run.taskName(argument)} ends on ${nodeOf(run, argument)}`;
    case K.xstart: return `transfer ${run.transferName(argument)} starts, ${number(run.exSize.data[argument])} MB`;
    case K.xend: return `transfer ${run.transferName(argument)} finishes`;
    case K.recalc: {
      const [from, to] = run.stepRange(argument);
      return `${to - from} ${to - from === 1 ? "rate moves" : "rates move"}, by ${causeOf(run, argument)}`;
    }
    case K.note: return `note of ${run.notes[argument].namespace}: ${JSON.stringify(run.notes[argument].data)}`;
    default: return `the run ends: ${run.status}`;
  }
}

const nodeOf = (run: Run, task: number): string => run.nodes[run.tkNode.data[task]]?.id ?? "–";

export function selectionOf(run: Run, event: number): Selection | null {
  const argument = run.evArg.data[event];
  switch (run.evKind.data[event]) {
    case K.ready: case K.start: case K.end: return { kind: "task", id: argument };
    case K.xstart: case K.xend: return { kind: "transfer", id: argument };
    case K.recalc: return { kind: "recalc", id: argument };
    default: return null;
  }
}

export const kindName = (run: Run, event: number): string => KINDS[run.evKind.data[event]];

/** A transfer's row wherever transfers are listed. */
export const TRANSFER_COLUMNS = [
  "transfer", "from node", "to node", "size MB", "route", "created s", "served from s", "served to s", "solo MB/s", "rate steps",
];
export function transferRow(run: Run, x: number): Cell[] {
  const node = (task: number): string => run.nodes[run.tkNode.data[task]]?.id ?? "";
  const at = (time: number): Cell => (Number.isNaN(time) ? null : time / 1e6);
  return [
    run.transferName(x), node(run.exSource.data[x]), node(run.exTarget.data[x]), run.exSize.data[x],
    Array.from(run.routeOf(x), (link) => run.links[link].id).join(" "), at(run.createdAt(x)), at(run.servedFrom(x)),
    at(run.servedTo(x)), run.soloRate(x), run.stepsOf(x).length,
  ];
}

/** Tasks and transfers of the binding chain, as Python's explanation names them. */
export interface ChainSets { tasks: Set<number>; transfers: Set<number> }
export const chainSets = (ctx: Context): ChainSets => ctx.memo("chain", [ctx.extras], () => makeChainSets(ctx));

function makeChainSets(ctx: Context): ChainSets {
  const tasks = new Set<number>();
  const transfers = new Set<number>();
  for (const item of ctx.extras.explanation?.[0]?.chain ?? []) {
    if (item.kind === "task") tasks.add(item.number);
    if (item.kind === "transfer") transfers.add(item.number);
  }
  return { tasks, transfers };
}

export const nowText = (ctx: Context): string =>
  ctx.ui.event < 0 ? "before the first event"
    : `line ${ctx.run.evLine.data[ctx.ui.event]}, ${seconds(ctx.ui.time)} s: ${sentence(ctx.run, ctx.ui.event)}`;

/** Step that gives a transfer's rate at an instant; -1 outside its service. */
export function stepAt(run: Run, x: number, time: number): number {
  if (!(run.servedFrom(x) <= time) || run.servedTo(x) < time) return -1;
  for (let step = run.exLast.data[x]; step >= 0; step = run.stPrevious.data[step]) if (run.stepTime(step) <= time) return step;
  return -1;
}

export function rateAt(run: Run, x: number, time: number): number | null {
  const step = stepAt(run, x, time);
  return step < 0 ? null : run.stRate.data[step];
}

/** Rows for a table, with a limit that is said. */
export const MAX_ROWS = 5000;
export function limited<T>(all: T[], row: (each: T, i: number) => Cell[], everything = false): { rows: Cell[][]; note?: string } {
  const rows = (everything ? all : all.slice(0, MAX_ROWS)).map(row);
  return all.length > rows.length ? { rows, note: `The first ${MAX_ROWS} of ${all.length} rows; narrow the window to see others.` } : { rows };
}
