/** Who did what when: per node tasks above and outgoing transfers below. */

import { timeAxis, xOf, timeOf, type Scale } from "../draw/axis";
import { MANY, type Lane, type Lanes } from "../draw/lanes";
import { fitted, type Painter } from "../draw/painter";
import { rasterize, type Row } from "../draw/raster";
import { count, seconds } from "../draw/format";
import { chainSets, limited } from "./names";
import type { Box, Context, View } from "./view";

const LEFT = 110;
const TOP = 24;
export const PAINTED = 3000;

const laneHeight = (ctx: Context, lanes: Lanes): number =>
  ctx.ui.fit ? Math.max(2, Math.min(20, 560 / lanes.lanes.length)) : lanes.intervals > MANY ? 12 : 20;

const scaleOf = (ctx: Context, box: Box): Scale =>
  ({ from: ctx.window[0], to: ctx.window[1], left: LEFT, right: box.width - 12 });

function rowsOf(ctx: Context, lanes: Lanes): Row[] {
  const height = laneHeight(ctx, lanes);
  return lanes.lanes.map((lane, index) => ({ lane, index, top: Math.round(TOP + index * height), height: Math.max(1, Math.round(height) - 1) }));
}

function draw(p: Painter, ctx: Context, box: Box): void {
  const { colours } = ctx;
  const lanes = ctx.lanesOf(ctx.ui.lanes);
  const rows = rowsOf(ctx, lanes);
  const s = scaleOf(ctx, box);
  let owner = -1;
  let shade = false;
  for (const row of rows) {
    if (row.lane.owner !== owner) {
      owner = row.lane.owner;
      shade = !shade;
    }
    if (shade) p.rect(0, row.top, box.width, row.height + 1, { fill: colours.lane });
    if (row.lane.isFirst && row.height > 7) {
      const name = row.lane.label || (row.lane.isTasks ? "" : "transfers ↗");
      p.text(row.lane.label ? 8 : 18, row.top + row.height / 2, fitted(name, LEFT - 20),
        { fill: row.lane.label ? colours.ink : colours.muted, size: row.lane.label ? 12 : 10, bold: row.lane.isTasks });
    }
  }
  timeAxis(p, s, 0, box.height, colours);
  if (lanes.countIn(lanes.lanes, s.from, s.to, PAINTED) > PAINTED) paintPixels(p, ctx, lanes, rows, s, box);
  else p.clip(LEFT, TOP, s.right - LEFT, box.height, () => rows.forEach((row) => paintRow(p, ctx, lanes, row, s)));
  const x = xOf(s, ctx.ui.time);
  if (ctx.ui.event >= 0 && x >= LEFT && x <= s.right) p.line([x, 0, x, box.height], { stroke: colours.select, width: 1.5 });
}

function paintPixels(p: Painter, ctx: Context, lanes: Lanes, rows: Row[], s: Scale, box: Box): void {
  const width = Math.max(1, Math.floor(s.right - s.left));
  const height = Math.max(1, Math.ceil(box.height));
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  const pen = canvas.getContext("2d") as CanvasRenderingContext2D;
  const image = pen.createImageData(width, height);
  rasterize(new Uint32Array(image.data.buffer), width, lanes, rows, s.from, s.to, ctx.run.end, ctx.colours);
  pen.putImageData(image, 0, 0);
  p.image(s.left, 0, width, height, canvas);
}

function paintRow(p: Painter, ctx: Context, lanes: Lanes, row: Row, s: Scale): void {
  const { run, colours, ui } = ctx;
  const [first, last] = lanes.range(row.lane, s.from, s.to);
  const chain = ui.chain ? chainSets(ctx) : null;
  for (let i = first; i < last; i++) {
    const id = lanes.id.data[i];
    const x0 = xOf(s, lanes.start.data[i]);
    const width = Math.max(1, xOf(s, lanes.end.data[i]) - x0);
    const category = lanes.category.data[i] % colours.categories.length;
    const fill = colours.categories[category];
    const middle = row.top + row.height / 2;
    if (row.lane.isTasks) {
      const ready = run.readyAt(id);
      if (ready < lanes.start.data[i]) p.line([xOf(s, ready), middle, x0, middle], { stroke: colours.muted, dash: [2, 2] });
      p.rect(x0, row.top, width, row.height, { fill });
      const name = fitted(run.taskName(id), width - 4);
      if (name) p.text(x0 + width / 2, middle, name, { fill: colours.onCategory[category], size: 11, anchor: "middle" });
    } else paintTransfer(p, ctx, row, s, id, x0, width, fill);
    const isSelected = ui.selection?.id === id && ui.selection.kind === (row.lane.isTasks ? "task" : "transfer");
    const isChain = chain && (row.lane.isTasks ? chain.tasks : chain.transfers).has(id);
    if (isChain) p.rect(x0, row.top, width, row.height, { stroke: colours.bind, width: 2, dash: [5, 2] });
    if (isSelected) p.rect(x0, row.top, width, row.height, { stroke: colours.select, width: 3 });
  }
}

/** A transfer's bar is filled to the height of rate over solo rate: cascades show as steps. */
function paintTransfer(p: Painter, ctx: Context, row: Row, s: Scale, x: number, x0: number, width: number, fill: string): void {
  const { run, colours } = ctx;
  p.rect(x0, row.top, width, row.height, { fill, alpha: 0.22 });
  const solo = run.soloRate(x) || 1;
  const end = x0 + width;
  const steps = run.stepsOf(x);
  steps.forEach((step, k) => {
    const from = xOf(s, run.stepTime(step));
    const to = k + 1 < steps.length ? xOf(s, run.stepTime(steps[k + 1])) : end;
    const height = row.height * Math.min(1, run.stRate.data[step] / solo);
    p.rect(from, row.top + row.height - height, Math.max(0, to - from), height, { fill });
  });
  const name = fitted(run.transferName(x), width - 6, 10);
  if (name) p.text(x0 + width / 2, row.top + row.height / 2, name, { fill: colours.ink, size: 10, anchor: "middle", halo: colours.paper });
}

const laneAt = (ctx: Context, lanes: Lanes, y: number): Lane | undefined =>
  rowsOf(ctx, lanes).find((row) => y >= row.top && y < row.top + row.height + 1)?.lane;

export const gantt: View = {
  id: "gantt",
  title: "Gantt",
  summary: (ctx) => `Gantt chart: ${count(ctx.run.tasks, "task")} and ${count(ctx.run.transfers, "dependency", "dependencies")} on ${count(ctx.run.nodes.length, "node")}; a transfer's bar is as high as its share of the rate it would have alone`,
  height: (ctx) => TOP + ctx.lanesOf(ctx.ui.lanes).lanes.length * laneHeight(ctx, ctx.lanesOf(ctx.ui.lanes)) + 8,
  draw,
  scale: scaleOf,
  hit(ctx, box, x, y) {
    const lanes = ctx.lanesOf(ctx.ui.lanes);
    const lane = laneAt(ctx, lanes, y);
    const s = scaleOf(ctx, box);
    if (!lane || x < LEFT) return null;
    const found = lanes.hit(lane, timeOf(s, x), (2 * (s.to - s.from)) / (s.right - s.left));
    return found < 0 ? null : { kind: lane.isTasks ? "task" : "transfer", id: lanes.id.data[found] };
  },
  table(ctx) {
    const { run } = ctx;
    const at = (value: number): string | null => (Number.isNaN(value) ? null : seconds(value));
    const shown = Array.from({ length: run.tasks }, (_, i) => i).filter((i) => !(run.startedAt(i) > ctx.window[1] || run.endedAt(i) < ctx.window[0]));
    return {
      columns: ["task", "node", "ready s", "started s", "ended s"],
      ...limited(shown, (i) => [run.taskName(i), run.nodes[run.tkNode.data[i]]?.id ?? null, at(run.readyAt(i)), at(run.startedAt(i)), at(run.endedAt(i))]),
      pick: (row) => ({ kind: "task", id: shown[row] }),
    };
  },
};
