/** Workflows: tasks by node, dependencies by size, the binding chain, and slack. */

import type { DagRow } from "../data/run";
import { count, number, seconds } from "../draw/format";
import { layered, type Layout } from "../draw/layers";
import { fitted, type Painter } from "../draw/painter";
import { chainSets, limited } from "./names";
import { slackOf } from "./slack";
import { boxOf, type Box, type Cell, type Context, type Table, type View } from "./view";

const ROW = 50;
const MARGIN = 44;
const CELL = { width: 330, height: 220 };

interface Places { x: (task: number) => number; y: (task: number) => number; wide: number; tall: number }

export function layoutOf(ctx: Context, number: number): Layout {
  return ctx.memo(`layout ${number}`, [], () => {
    const { run } = ctx;
    const dag = run.dags[number];
    const own = (all: Int32Array): Int32Array => all.slice(dag.firstEdge, dag.firstEdge + dag.edges).map((task) => task - dag.firstTask);
    return layered(dag.tasks, own(run.exSource.data), own(run.exTarget.data));
  });
}

const widest = (layout: Layout): number => layout.layers.reduce((most, row) => Math.max(most, row.length), 1);

function placesOf(ctx: Context, dag: number, box: Box): Places {
  const layout = layoutOf(ctx, dag);
  const { firstTask } = ctx.run.dags[dag];
  const columns = Math.max(1, layout.layers.length - 1);
  const wide = Math.max(4, Math.min(96, ((box.width - 2 * MARGIN) / (columns + 1)) * 0.72));
  const dx = (box.width - 2 * MARGIN - wide) / columns;
  const dy = Math.min(90, (box.height - 2 * MARGIN) / widest(layout));
  return {
    x: (task) => MARGIN + wide / 2 + layout.layer[task - firstTask] * dx,
    y: (task) => box.height / 2 + layout.order[task - firstTask] * dy,
    wide, tall: Math.max(3, Math.min(34, dy - 8)),
  };
}

const isAll = (ctx: Context): boolean => ctx.ui.dag < 0 && ctx.run.dags.length > 1;
const chosen = (ctx: Context): number => (ctx.run.dags[ctx.ui.dag] ? ctx.ui.dag : 0);
const slacks = (ctx: Context): Float64Array => ctx.memo("slack", [], () => slackOf(ctx.run));

/** Small drawings side by side: how many a row has, and where one stands. */
const perRow = (width: number): number => Math.max(1, Math.floor(width / CELL.width));
const cellOf = (width: number, i: number): [number, number] => [(i % perRow(width)) * CELL.width, Math.floor(i / perRow(width)) * CELL.height];

function draw(p: Painter, ctx: Context, box: Box): void {
  const { run, colours } = ctx;
  if (!run.dags.length) return p.text(20, 40, "No DAG has entered yet.", { fill: colours.muted, size: 14 });
  if (!isAll(ctx)) {
    paintDag(p, ctx, chosen(ctx), box);
    const words = `${run.dags[chosen(ctx)].id}: colour and text say the node; dotted: both ends on one node; thick outline and line: the binding chain; + slack`;
    return p.text(16, box.height - 14, fitted(words, box.width - 20), { fill: colours.muted, size: 11 });
  }
  run.dags.forEach((row, i) => {
    const [x, y] = cellOf(box.width, i);
    if (y + CELL.height < box.top || y > box.bottom) return;
    p.shift(x, y, () => {
      p.rect(4, 4, CELL.width - 8, CELL.height - 8, { stroke: colours.grid });
      p.text(12, 16, fitted(`${row.id}, in at ${seconds(row.at)} s`, CELL.width - 24, 12), { fill: colours.ink, size: 12, bold: true });
      paintDag(p, ctx, i, boxOf(CELL.width, CELL.height));
    });
  });
}

function paintDag(p: Painter, ctx: Context, number: number, box: Box): void {
  const { run } = ctx;
  const dag = run.dags[number];
  const at = placesOf(ctx, number, box);
  let most = 1e-9;
  for (let x = dag.firstEdge; x < dag.firstEdge + dag.edges; x++) most = Math.max(most, run.exSize.data[x]);
  /** Above or below what is seen: -1 or 1. */
  const beyond = (task: number): number => (at.y(task) < box.top - ROW ? -1 : at.y(task) > box.bottom + ROW ? 1 : 0);
  for (let x = dag.firstEdge; x < dag.firstEdge + dag.edges; x++) {
    const side = beyond(run.exSource.data[x]);
    if (side === 0 || side !== beyond(run.exTarget.data[x])) paintEdge(p, ctx, at, x, most);
  }
  const nodes = usedNodes(ctx, dag);
  for (let task = dag.firstTask; task < dag.firstTask + dag.tasks; task++) if (beyond(task) === 0) paintTask(p, ctx, at, task, nodes);
}

function usedNodes(ctx: Context, dag: DagRow): number[] {
  return [...new Set(ctx.run.tkNode.data.subarray(dag.firstTask, dag.firstTask + dag.tasks))].sort((a, b) => a - b);
}

function paintEdge(p: Painter, ctx: Context, at: Places, x: number, most: number): void {
  const { run, colours, marks } = ctx;
  const [source, target] = [run.exSource.data[x], run.exTarget.data[x]];
  const isMarked = marks.transfers.has(x);
  const isBinding = chainSets(ctx).transfers.has(x);
  p.line([at.x(source) + at.wide / 2, at.y(source), at.x(target) - at.wide / 2, at.y(target)], {
    stroke: isMarked ? colours.select : isBinding ? colours.bind : colours.muted,
    width: (isMarked || isBinding ? 2 : 0.6) + run.exSize.data[x] / most, dash: run.isLocal(x) ? [3, 3] : [],
    alpha: ctx.ui.chain && !isBinding && !isMarked ? 0.35 : 1,
  });
}

function paintTask(p: Painter, ctx: Context, at: Places, task: number, nodes: number[]): void {
  const { run, colours, marks } = ctx;
  const [x, y] = [at.x(task), at.y(task)];
  const node = run.tkNode.data[task];
  const shade = Math.max(0, nodes.indexOf(node)) % colours.categories.length;
  const isBinding = chainSets(ctx).tasks.has(task);
  const isPale = ctx.ui.chain && !isBinding;
  const stroke = marks.tasks.has(task) ? colours.select : isBinding ? colours.bind : colours.paper;
  p.rect(x - at.wide / 2, y - at.tall / 2, at.wide, at.tall, {
    fill: isPale ? colours.panel : colours.categories[shade], stroke: isPale && stroke === colours.paper ? colours.muted : stroke,
    width: stroke === colours.paper ? 1 : 3,
  });
  if (at.tall < 12) return;
  const fill = isPale ? colours.ink : colours.onCategory[shade];
  const two = at.tall >= 28;
  p.text(x, two ? y - 7 : y, fitted(run.taskIds[task], at.wide - 4), { fill, anchor: "middle", bold: true });
  if (!two) return;
  const slack = slacks(ctx)[task];
  p.text(x, y + 7, fitted(`on ${run.nodes[node]?.id ?? "–"}`, at.wide - 4, 10), { fill, size: 10, anchor: "middle" });
  if (slack > 0) p.text(x, y + at.tall / 2 + 8, `+ ${seconds(slack, run.end / 4)} s`, { fill: colours.muted, size: 10, anchor: "middle", halo: colours.paper });
}

function hitIn(ctx: Context, number: number, box: Box, x: number, y: number): number {
  const dag = ctx.run.dags[number];
  const at = placesOf(ctx, number, box);
  for (let task = dag.firstTask; task < dag.firstTask + dag.tasks; task++) {
    if (Math.abs(at.x(task) - x) <= at.wide / 2 && Math.abs(at.y(task) - y) <= at.tall / 2) return task;
  }
  return -1;
}

function taskAt(ctx: Context, box: Box, x: number, y: number): number {
  if (!ctx.run.dags.length) return -1;
  if (!isAll(ctx)) return hitIn(ctx, chosen(ctx), box, x, y);
  const i = Math.floor(y / CELL.height) * perRow(box.width) + Math.floor(x / CELL.width);
  if (!ctx.run.dags[i] || x > perRow(box.width) * CELL.width) return -1;
  const [left, top] = cellOf(box.width, i);
  return hitIn(ctx, i, boxOf(CELL.width, CELL.height), x - left, y - top);
}

function table(ctx: Context, everything = false): Table {
  const { run } = ctx;
  const slack = slacks(ctx);
  const rows = isAll(ctx) ? run.dags : run.dags.slice(chosen(ctx), chosen(ctx) + 1);
  const from = (first: number, many: number): number[] => Array.from({ length: many }, (_, i) => first + i);
  const tasks = rows.flatMap((row) => from(row.firstTask, row.tasks));
  const edges = rows.flatMap((row) => from(row.firstEdge, row.edges));
  const node = (task: number): Cell => run.nodes[run.tkNode.data[task]]?.id ?? null;
  const chain = chainSets(ctx);
  return {
    columns: ["what", "kind", "on or from node", "to node", "cost units or MB", "ended or arrived s", "slack s", "binding chain"],
    ...limited([...tasks, ...edges], (id, i): Cell[] => (i < tasks.length
      ? [run.taskName(id), "task", node(id), null, number(run.tkCost.data[id]), seconds(run.endedAt(id)), seconds(slack[id]), chain.tasks.has(id) ? "yes" : null]
      : [run.transferName(id), run.isLocal(id) ? "local" : "transfer", node(run.exSource.data[id]), node(run.exTarget.data[id]), number(run.exSize.data[id]),
        seconds(run.arrivedAt(id)), null, chain.transfers.has(id) ? "yes" : null]), everything),
    pick: (row) => (row < tasks.length ? { kind: "task", id: tasks[row] } : { kind: "transfer", id: edges[row - tasks.length] }),
  };
}

export const dag: View = {
  id: "dag",
  title: "DAG",
  key: "7",
  summary: (ctx) => (isAll(ctx) ? `All ${count(ctx.run.dags.length, "workflow")}`
    : `Workflow ${ctx.run.dags[chosen(ctx)]?.id ?? ""} of ${count(ctx.run.dags[chosen(ctx)]?.tasks ?? 0, "task")}, one of ${count(ctx.run.dags.length, "DAG")}`),
  draw,
  height(ctx, width, room) {
    if (isAll(ctx)) return Math.ceil(ctx.run.dags.length / perRow(width)) * CELL.height;
    if (!ctx.run.dags.length) return room;
    const many = widest(layoutOf(ctx, chosen(ctx)));
    return Math.max(Math.min(room, 2 * MARGIN + many * 90), 2 * MARGIN + many * (many > 60 ? 14 : ROW));
  },
  hit(ctx, box, x, y) {
    const task = taskAt(ctx, box, x, y);
    return task < 0 ? null : { kind: "task", id: task };
  },
  tip(ctx, box, x, y) {
    const task = taskAt(ctx, box, x, y);
    if (task < 0) return "";
    const { run } = ctx;
    const slack = slacks(ctx)[task];
    return `${run.taskName(task)} on ${run.nodes[run.tkNode.data[task]]?.id ?? "–"}\nended ${seconds(run.endedAt(task))} s, slack ${seconds(slack)} s`;
  },
  table,
};
