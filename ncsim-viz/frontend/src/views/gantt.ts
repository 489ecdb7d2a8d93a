/** Who did what when: per node tasks above and outgoing transfers below. */

import { playhead, timeAxis, timeOf, xOf, type Scale } from "../draw/axis";
import { count, number, seconds } from "../draw/format";
import { MANY, type Lane, type Lanes } from "../draw/lanes";
import { fitted, hatch, widthOf, type Painter } from "../draw/painter";
import { rasterImage, type Row } from "../draw/raster";
import { chainSets, limited, rateAt, type ChainSets } from "./names";
import type { Box, Context, Table, View } from "./view";

const LEFT = 110;
const TOP = 24;
/** Height of a row of the legend; where the screen is narrow there are two. */
const LEGEND = 18;
const below = (width: number): number => 8 + LEGEND * (width < 700 ? 2 : 1);
const TALLEST_px = 44;
/** Above so many intervals in the window, pixels are drawn instead of shapes. */
export const PAINTED = 3000;

/** In smaller bars, steps of the rate cannot be seen and are not drawn. */
const STEPS_px = { width: 4, height: 7 };

const lanesOf = (ctx: Context): Lanes => ctx.lanesOf(ctx.ui.lanes);

/** Height of a lane: enough to read, more where there is room, and as little as it takes to fit. */
function laneHeight(ctx: Context, lanes: Lanes, width: number, room: number): number {
  const share = (room - TOP - below(width)) / Math.max(1, lanes.lanes.length);
  const least = ctx.ui.fit ? 1 : lanes.intervals > MANY ? 12 : 20;
  return Math.max(least, Math.min(ctx.ui.fit ? 20 : TALLEST_px, share));
}

const scaleOf = (ctx: Context, box: Box): Scale =>
  ({ from: ctx.window[0], to: ctx.window[1], left: LEFT, right: box.width - 12 });

/** The rows of the seen part. */
function rowsOf(lanes: Lanes, box: Box, height: number): Row[] {
  const first = Math.max(0, Math.floor((box.top - TOP) / height) - 1);
  const last = Math.min(lanes.lanes.length, Math.ceil((box.bottom - TOP) / height) + 1);
  const rows: Row[] = [];
  for (let index = first; index < last; index++) {
    const top = Math.round(TOP + index * height);
    rows.push({ lane: lanes.lanes[index], index, top, height: Math.max(1, Math.round(TOP + (index + 1) * height) - top - 1) });
  }
  return rows;
}

/** Drawings and hits share the height that `height` gave: the box has it. */
const heightIn = (ctx: Context, lanes: Lanes, box: Box): number => laneHeight(ctx, lanes, box.width, box.height);

function draw(p: Painter, ctx: Context, box: Box): void {
  const lanes = lanesOf(ctx);
  const rows = rowsOf(lanes, box, heightIn(ctx, lanes, box));
  const s = scaleOf(ctx, box);
  rows.forEach((row) => ground(p, ctx, lanes, row, box));
  timeAxis(p, s, box.top, box.bottom, ctx.colours);
  if (!lanes.lanes.length) p.text(LEFT, TOP + 20, "Nothing has run yet.", { fill: ctx.colours.muted, size: 13 });
  p.clip(LEFT, box.top + TOP - 4, s.right - LEFT, box.bottom - box.top, () => {
    const isMany = lanes.countIn(rows.map((row) => row.lane), s.from, s.to, PAINTED) > PAINTED;
    if (isMany) {
      const height = Math.ceil(box.bottom - box.top);
      const image = rasterImage(Math.floor(s.right - s.left), height, lanes, rows, { ...s, top: box.top, whole: ctx.run.end }, ctx.colours);
      p.image(s.left, box.top, image.width, height, image);
      paintMarked(p, ctx, lanes, rows, s);
    } else rows.forEach((row) => paintRow(p, ctx, lanes, row, s));
    paintTrigger(p, ctx, s, box);
  });
  legend(p, ctx, box);
}

/** What bars mean, below the last lane. */
function legend(p: Painter, ctx: Context, box: Box): void {
  const { colours } = ctx;
  const lanes = lanesOf(ctx);
  let y = TOP + lanes.lanes.length * heightIn(ctx, lanes, box) + 4 + LEGEND / 2;
  if (y > box.bottom || !lanes.lanes.length) return;
  const [blue] = colours.categories;
  const marks: [string, (x: number) => void][] = [
    ["task, coloured by DAG", (x) => p.rect(x, y - 6, 22, 12, { fill: blue })],
    ["waits for its node", (x) => p.line([x, y, x + 22, y], { stroke: colours.muted, dash: [2, 2] })],
    ["transfer: filled as high as its share of the rate it has alone", (x) => {
      p.rect(x, y - 6, 22, 12, { fill: blue, alpha: 0.2 });
      p.rect(x, y + 2, 22, 4, { fill: blue });
    }],
  ];
  if (ctx.ui.chain) marks.push(["binding chain", (x) => p.rect(x, y - 6, 22, 12, { stroke: colours.bind, width: 2, dash: [5, 2] })]);
  const left = box.width < 700 ? 8 : LEFT;
  let x = left;
  for (const [words, mark] of marks) {
    if (x > left && x + 28 + widthOf(words, 11) > box.width) [x, y] = [left, y + LEGEND];
    mark(x);
    p.text(x + 28, y, words, { fill: colours.muted, size: 11, halo: colours.paper });
    x += 48 + widthOf(words, 11);
  }
}

function ground(p: Painter, ctx: Context, lanes: Lanes, row: Row, box: Box): void {
  const { colours, marks, ui } = ctx;
  const { lane } = row;
  if (lanes.shaded(row.index)) p.rect(0, row.top, box.width, row.height + 1, { fill: colours.lane });
  if (!lane.isFirst || row.height < 8) return;
  const isMarked = (ui.lanes === "node" && marks.nodes.has(lane.owner)) || (ui.lanes === "link" && marks.links.has(lane.owner));
  const size = Math.min(12, row.height);
  const fill = isMarked ? colours.select : lane.label ? colours.ink : colours.muted;
  const middle = row.top + row.height / 2;
  if (lane.label) p.text(8, middle, fitted(lane.label, LEFT - 20, size), { fill, size, bold: true });
  else if (!lane.isTasks && row.height >= 10) p.text(18, middle, "sends", { fill: colours.muted, size: 10 });
}

function paintRow(p: Painter, ctx: Context, lanes: Lanes, row: Row, s: Scale): void {
  const [first, last] = lanes.range(row.lane, s.from, s.to);
  const chain = ctx.ui.chain ? chainSets(ctx) : null;
  if (row.lane.isTasks) for (let i = first; i < last; i++) paintWait(p, ctx, lanes, row, s, i);
  for (let i = first; i < last; i++) paintOne(p, ctx, lanes, row, s, i, chain);
}

function paintOne(p: Painter, ctx: Context, lanes: Lanes, row: Row, s: Scale, i: number, chain: ChainSets | null): void {
  const { colours, marks } = ctx;
  const id = lanes.id.data[i];
  const x0 = xOf(s, lanes.start.data[i]);
  const width = Math.max(1, xOf(s, lanes.end.data[i]) - x0);
  if (row.lane.isTasks) paintTask(p, ctx, lanes, row, i, x0, width);
  else paintTransfer(p, ctx, row, s, id, x0, width);
  if (chain && (row.lane.isTasks ? chain.tasks : chain.transfers).has(id)) {
    p.rect(x0 + 1, row.top + 1, Math.max(1, width - 2), row.height - 2, { stroke: colours.bind, width: 2, dash: [5, 2] });
  }
  if ((row.lane.isTasks ? marks.tasks : marks.transfers).has(id)) p.rect(x0, row.top, width, row.height, { stroke: colours.select, width: 2.5 });
}

/** Among pixels, what is selected is still outlined. */
function paintMarked(p: Painter, ctx: Context, lanes: Lanes, rows: Row[], s: Scale): void {
  for (const row of rows) {
    const marked = row.lane.isTasks ? ctx.marks.tasks : ctx.marks.transfers;
    if (!marked.size) continue;
    const [first, last] = lanes.range(row.lane, s.from, s.to);
    for (let i = first; i < last; i++) if (marked.has(lanes.id.data[i])) paintOne(p, ctx, lanes, row, s, i, null);
  }
}

/** From ready to start, below the bars of other tasks. */
function paintWait(p: Painter, ctx: Context, lanes: Lanes, row: Row, s: Scale, i: number): void {
  const ready = ctx.run.readyAt(lanes.id.data[i]);
  const middle = row.top + row.height / 2;
  if (ready < lanes.start.data[i]) p.line([xOf(s, ready), middle, xOf(s, lanes.start.data[i]), middle], { stroke: ctx.colours.muted, dash: [2, 2] });
}

function paintTask(p: Painter, ctx: Context, lanes: Lanes, row: Row, i: number, x0: number, width: number): void {
  const { run, colours } = ctx;
  const id = lanes.id.data[i];
  const category = lanes.category.data[i];
  const shade = category % colours.categories.length;
  const middle = row.top + row.height / 2;
  p.rect(x0, row.top, width, row.height, { fill: colours.categories[shade] });
  if (category >= colours.categories.length) hatch(p, x0, row.top, width, row.height, colours.paper, 6);
  if (width > 3) p.line([x0 + width - 0.5, row.top, x0 + width - 0.5, row.top + row.height], { stroke: colours.paper });
  const name = fitted(run.taskName(id), width - 3, 11) || fitted(run.taskName(id), width - 2, 9);
  if (name) p.text(x0 + width / 2, middle, name, { fill: colours.onCategory[shade], size: width > 30 ? 11 : 9, anchor: "middle" });
}

/** A transfer's bar is filled to the height of rate over solo rate: cascades show as steps. */
function paintTransfer(p: Painter, ctx: Context, row: Row, s: Scale, x: number, x0: number, width: number): void {
  const { run, colours } = ctx;
  const fill = colours.categories[run.exDag.data[x] % colours.categories.length];
  const isSmall = row.height < STEPS_px.height || width < STEPS_px.width;
  p.rect(x0, row.top, width, row.height, { fill, alpha: isSmall ? 0.6 : 0.2 });
  if (isSmall) return;
  const solo = run.soloRate(x) || 1;
  const end = x0 + width;
  const steps = run.stepsOf(x);
  steps.forEach((step, k) => {
    const from = xOf(s, run.stepTime(step));
    const to = k + 1 < steps.length ? xOf(s, run.stepTime(steps[k + 1])) : end;
    const height = row.height * Math.min(1, run.stRate.data[step] / solo);
    p.rect(from, row.top + row.height - height, Math.max(0, to - from), height, { fill });
    if (run.stRate.data[step] === 0) hatch(p, from, row.top, Math.max(0, to - from), row.height, colours.bad, 6);
  });
  const name = fitted(run.transferName(x), width - 6, 10);
  if (name) p.text(Math.max(x0, s.left) + 4, row.top + row.height / 2, name, { fill: colours.ink, size: 10, halo: colours.paper });
}

/** The selected recalculation: where its trigger stands in time. */
function paintTrigger(p: Painter, ctx: Context, s: Scale, box: Box): void {
  const { run, ui, colours } = ctx;
  if (ui.selection?.kind !== "recalc") return;
  const x = xOf(s, run.timeOf(run.rcEvent.data[ui.selection.id]));
  p.line([x, box.top + TOP, x, box.bottom], { stroke: colours.ink, dash: [2, 3] });
  p.text(x + 4, box.top + TOP + 6, run.rcIsStart.data[ui.selection.id] ? "▲" : "●", { fill: colours.ink, size: 10, halo: colours.paper });
}

function laneAt(ctx: Context, lanes: Lanes, box: Box, y: number): Lane | undefined {
  return lanes.lanes[Math.floor((y - TOP) / heightIn(ctx, lanes, box))];
}

/** Interval under a point: its lane and number, or null. */
function intervalAt(ctx: Context, box: Box, x: number, y: number): { lane: Lane; id: number } | null {
  const lanes = lanesOf(ctx);
  const lane = laneAt(ctx, lanes, box, y);
  const s = scaleOf(ctx, box);
  if (!lane || x < LEFT || y < box.top + TOP - 4) return null;
  const found = lanes.hit(lane, timeOf(s, x), (2 * (s.to - s.from)) / (s.right - s.left));
  return found < 0 ? null : { lane, id: lanes.id.data[found] };
}

function table(ctx: Context, everything = false): Table {
  const { run } = ctx;
  const at = (value: number): string | null => (Number.isNaN(value) ? null : seconds(value));
  const inWindow = (from: number, to: number): boolean => !(from > ctx.window[1] || to < ctx.window[0]);
  const tasks = Array.from({ length: run.tasks }, (_, i) => i).filter((i) => inWindow(run.startedAt(i), run.endedAt(i)));
  const transfers = Array.from({ length: run.transfers }, (_, x) => x).filter((x) => !run.isLocal(x) && inWindow(run.servedFrom(x), run.servedTo(x)));
  const node = (task: number): string | null => run.nodes[run.tkNode.data[task]]?.id ?? null;
  return {
    columns: ["what", "kind", "node", "to", "ready or created s", "started s", "ended s"],
    ...limited([...tasks, ...transfers], (id, i) => (i < tasks.length
      ? [run.taskName(id), "task", node(id), null, at(run.readyAt(id)), at(run.startedAt(id)), at(run.endedAt(id))]
      : [run.transferName(id), "transfer", node(run.exSource.data[id]), node(run.exTarget.data[id]), at(run.createdAt(id)), at(run.servedFrom(id)), at(run.servedTo(id))]), everything),
    pick: (row) => (row < tasks.length ? { kind: "task", id: tasks[row] } : { kind: "transfer", id: transfers[row - tasks.length] }),
  };
}

export const gantt: View = {
  id: "gantt",
  title: "Gantt",
  key: "2",
  summary: (ctx) => `Gantt chart: ${count(ctx.run.tasks, "task")} and ${count(ctx.run.transfers, "dependency", "dependencies")} on ${count(ctx.run.nodes.length, "node")}; a transfer's bar is as high as its share of the rate it would have alone`,
  height: (ctx, width, room) => TOP + lanesOf(ctx).lanes.length * laneHeight(ctx, lanesOf(ctx), width, room) + below(width),
  draw,
  overlay: (p, ctx, box) => {
    if (ctx.ui.event >= 0) playhead(p, scaleOf(ctx, box), ctx.ui.time, box.top, box.bottom, ctx.colours);
  },
  scale: scaleOf,
  hit(ctx, box, x, y) {
    const found = intervalAt(ctx, box, x, y);
    if (found) return { kind: found.lane.isTasks ? "task" : "transfer", id: found.id };
    const lane = x < LEFT && y > box.top + TOP ? laneAt(ctx, lanesOf(ctx), box, y) : undefined;
    if (!lane || ctx.ui.lanes === "dag") return null;
    return { kind: ctx.ui.lanes, id: lane.owner };
  },
  tip(ctx, box, x, y) {
    const found = intervalAt(ctx, box, x, y);
    if (!found) return "";
    const { run } = ctx;
    const { id } = found;
    if (found.lane.isTasks) {
      return `task ${run.taskName(id)} on ${run.nodes[run.tkNode.data[id]]?.id}\nready ${seconds(run.readyAt(id))}, ran ${seconds(run.startedAt(id))} to ${seconds(run.endedAt(id))} s`;
    }
    const at = timeOf(scaleOf(ctx, box), x);
    return `transfer ${run.transferName(id)}, ${number(run.exSize.data[id])} MB\nserved ${seconds(run.servedFrom(id))} to ${seconds(run.servedTo(id))} s\nhere ${number(rateAt(run, id, at))} of ${number(run.soloRate(id))} MB/s alone`;
  },
  table,
};
