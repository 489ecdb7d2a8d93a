/** The map: rates on links, queues at nodes, conflicts of a selected link. */

import { count, number } from "../draw/format";
import { fitted, widthOf, type Painter } from "../draw/painter";
import { exists } from "./names";
import type { Box, Context, Table, View } from "./view";

export interface Place { x: number; y: number }
type Segment = [number, number, number, number];

const RADIUS = 15;
/** Above so many nodes, discs are small and names stand only where something happens. */
const CROWDED = 60;
/** Shorter links have no room for a label. */
const LABELLED_px = 70;

/** Whether nodes are too many for their names, at the scale of the map. */
const isCrowded = (ctx: Context): boolean => ctx.run.nodes.length / (ctx.ui.map?.scale ?? 1) ** 2 > CROWDED;
const radiusOf = (ctx: Context): number => (isCrowded(ctx) ? 7 : RADIUS);

export function placesOf(ctx: Context, box: Box): Place[] {
  const { map } = ctx.ui;
  return ctx.memo(`places ${box.width} ${box.height}`, [map], () => {
    const all = makePlaces(ctx, box);
    if (!map) return all;
    const [middleX, middleY] = [box.width / 2, box.height / 2];
    return all.map(({ x, y }) => ({
      x: middleX + (x - middleX - map.x * box.width) * map.scale, y: middleY + (y - middleY - map.y * box.height) * map.scale,
    }));
  });
}

function makePlaces(ctx: Context, box: Box): Place[] {
  const { nodes } = ctx.run;
  const has = nodes.every((node) => node.x !== null && node.y !== null);
  const raw = nodes.map((node, i): Place => (has ? { x: node.x as number, y: node.y as number }
    : { x: Math.cos((2 * Math.PI * i) / nodes.length), y: Math.sin((2 * Math.PI * i) / nodes.length) }));
  let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
  for (const { x, y } of raw) {
    x0 = Math.min(x0, x); x1 = Math.max(x1, x); y0 = Math.min(y0, y); y1 = Math.max(y1, y);
  }
  const scale = Math.min((box.width - 120) / (x1 - x0 || 1), (box.height - 120) / (y1 - y0 || 1));
  return raw.map(({ x, y }) => ({ x: box.width / 2 + (x - (x0 + x1) / 2) * scale, y: box.height / 2 - 10 - (y - (y0 + y1) / 2) * scale }));
}

/** Ends of a link, moved aside so that both directions are seen. */
function segment(ctx: Context, places: Place[], link: number): Segment {
  const { source, target } = ctx.run.links[link];
  const [a, b] = [places[source], places[target]];
  const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
  const [ux, uy] = [(b.x - a.x) / length, (b.y - a.y) / length];
  const gap = radiusOf(ctx) + 2;
  return [a.x + ux * gap - uy * 4, a.y + uy * gap + ux * 4, b.x - ux * gap - uy * 4, b.y - uy * gap + ux * 4];
}

/** A label on the outer side of a link, away from that of the other direction. */
function beside(p: Painter, ctx: Context, [x0, y0, x1, y1]: Segment, words: string, gap: number): void {
  const length = Math.hypot(x1 - x0, y1 - y0) || 1;
  const [nx, ny] = [-(y1 - y0) / length, (x1 - x0) / length];
  const away = gap + 4;
  const x = (x0 + x1) / 2 + nx * (away + widthOf(words, 10) / 2);
  const y = (y0 + y1) / 2 + ny * (away + 6);
  p.text(x, y, words, { fill: ctx.colours.ink, size: 10, anchor: "middle", halo: ctx.colours.paper });
}

interface Loads { MB: Float64Array; transfers: Int32Array; most: number }

/** What every link carries in the whole run. */
function loadsOf(ctx: Context): Loads {
  return ctx.memo("loads", [], () => {
    const { run } = ctx;
    const MB = new Float64Array(run.links.length);
    const transfers = new Int32Array(run.links.length);
    for (let x = 0; x < run.transfers; x++) {
      for (const link of run.routeOf(x)) {
        MB[link] += run.exSize.data[x];
        transfers[link] += 1;
      }
    }
    return { MB, transfers, most: MB.reduce((a, b) => Math.max(a, b), 1e-9) };
  });
}

function draw(p: Painter, ctx: Context, box: Box): void {
  const { run, colours, ui } = ctx;
  const places = placesOf(ctx, box);
  run.links.forEach((_, i) => p.line(segment(ctx, places, i), { stroke: colours.grid, width: 1 }));
  if (ui.load) paintLoads(p, ctx, places);
  relations(p, ctx, places);
  run.nodes.forEach((node, i) => {
    const { x, y } = places[i];
    const isMarked = ctx.marks.nodes.has(i);
    p.circle(x, y, radiusOf(ctx), { fill: colours.panel, stroke: isMarked ? colours.select : colours.muted, width: isMarked ? 3 : 1 });
    if (!isCrowded(ctx) || isMarked) nodeName(p, ctx, node.id, places[i], colours.ink);
  });
  legend(p, ctx, box);
}

function nodeName(p: Painter, ctx: Context, id: string, { x, y }: Place, fill: string): void {
  const name = fitted(id, 2 * RADIUS - 4, 10);
  if (name && !isCrowded(ctx)) p.text(x, y, name, { fill, size: 10, anchor: "middle", bold: true });
  else p.text(x, y - radiusOf(ctx) - 7, id, { fill: ctx.colours.ink, size: 10, anchor: "middle", halo: ctx.colours.paper });
}

function paintLoads(p: Painter, ctx: Context, places: Place[]): void {
  const { colours, run } = ctx;
  const { MB, most } = loadsOf(ctx);
  run.links.forEach((_, i) => {
    if (MB[i] <= 0) return;
    const points = segment(ctx, places, i);
    p.line(points, { stroke: colours.accent, width: 2 + (8 * MB[i]) / most });
    arrow(p, points, colours.accent);
  });
  if (isCrowded(ctx)) return;
  run.links.forEach((_, i) => {
    if (MB[i] <= 0) return;
    const points = segment(ctx, places, i);
    if (Math.hypot(points[2] - points[0], points[3] - points[1]) < LABELLED_px) return;
    beside(p, ctx, points, `${number(MB[i], 3)} MB`, 6);
  });
}

/** What moves: transfers in service, running tasks and queues at the playhead. */
function overlay(p: Painter, ctx: Context, box: Box): void {
  const places = placesOf(ctx, box);
  if (!ctx.ui.load) paintRates(p, ctx, places);
  ctx.run.nodes.forEach((node, i) => paintNode(p, ctx, node.id, i, places[i]));
}

function paintRates(p: Painter, ctx: Context, places: Place[]): void {
  const { run, colours, cursor } = ctx;
  const now = new Map<number, { rate: number; flows: number }>();
  for (const x of cursor.active) {
    for (const link of run.routeOf(x)) {
      const sum = now.get(link) ?? { rate: 0, flows: 0 };
      now.set(link, { rate: sum.rate + cursor.rateOf(x), flows: sum.flows + 1 });
    }
  }
  for (const [link, { rate, flows }] of now) {
    const points = segment(ctx, places, link);
    const share = Math.min(1, rate / (run.links[link].bandwidth || 1));
    const isPaused = rate === 0;
    const stroke = isPaused ? colours.bad : colours.accent;
    p.line(points, { stroke, width: isPaused ? 2 : 2 + 7 * share, dash: isPaused ? [2, 4] : [] });
    arrow(p, points, stroke);
    if (isCrowded(ctx) || Math.hypot(points[2] - points[0], points[3] - points[1]) < LABELLED_px) continue;
    beside(p, ctx, points, isPaused ? "paused" : `${number(rate, 2)} MB/s${flows > 1 ? ` (${flows})` : ""}`, 2 + 4 * share);
  }
}

function paintNode(p: Painter, ctx: Context, id: string, i: number, { x, y }: Place): void {
  const { cursor, run, colours } = ctx;
  const task = cursor.running[i];
  const isMarked = ctx.marks.nodes.has(i);
  const radius = radiusOf(ctx);
  if (task >= 0) {
    const shade = run.tkDag.data[task] % 8;
    p.circle(x, y, radius, { fill: colours.categories[shade], stroke: isMarked ? colours.select : colours.ink, width: isMarked ? 3 : 1.5 });
    if (!isCrowded(ctx)) {
      nodeName(p, ctx, id, { x, y }, colours.onCategory[shade]);
      p.text(x, y + radius + 10, `▶ ${run.taskName(task)}`, { fill: colours.ink, size: 11, anchor: "middle", halo: colours.paper });
    }
  }
  if (cursor.queued[i] <= 0) return;
  p.circle(x + radius, y - radius, 8, { fill: colours.bad });
  p.text(x + radius, y - radius, String(cursor.queued[i]), { fill: colours.paper, size: 10, anchor: "middle", bold: true });
}

function arrow(p: Painter, [x0, y0, x1, y1]: Segment, fill: string): void {
  const length = Math.hypot(x1 - x0, y1 - y0) || 1;
  const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
  p.area([x1, y1, x1 - ux * 9 - uy * 5, y1 - uy * 9 + ux * 5, x1 - ux * 9 + uy * 5, y1 - uy * 9 - ux * 5], { fill });
}

/** What the selection is about: a route, the bottlenecks of a recalculation, the conflicts of a link. */
function relations(p: Painter, ctx: Context, places: Place[]): void {
  const { ui, colours, run } = ctx;
  if (!ui.selection || !exists(run, ui.selection)) return;
  const known = ctx.extras.relations;
  if (ui.selection.kind === "link" && known && ui.conflicts) {
    for (const link of known.contenders[ui.selection.id] ?? []) p.line(segment(ctx, places, link), { stroke: colours.categories[1], width: 1.5 });
    for (const link of known.hidden[ui.selection.id] ?? []) p.line(segment(ctx, places, link), { stroke: colours.categories[3], width: 2, dash: [6, 4] });
  }
  for (const link of ctx.marks.links) {
    const points = segment(ctx, places, link);
    p.line(points, { stroke: colours.select, width: ui.selection.kind === "link" ? 5 : 3 });
    arrow(p, points, colours.select);
  }
}

type Entry = [stroke: string, words: string, dash: number[]];

function entriesOf(ctx: Context): Entry[] {
  const { colours, ui, extras } = ctx;
  const entries: Entry[] = ui.load ? [[colours.accent, "MB carried in the whole run, by width", []]]
    : [[colours.accent, "rate now, by width up to the clean bandwidth", []], [colours.bad, "paused at zero rate", [2, 4]]];
  if (ui.selection?.kind !== "link") {
    if (ctx.marks.links.size) entries.push([colours.select, "the selection's links", []]);
    return entries;
  }
  if (!extras.relations) return [...entries, [colours.muted, "(relations of links are not recorded)", [1, 3]]];
  if (!ui.conflicts) return entries;
  return [...entries, [colours.categories[1], "shares the channel", []], [colours.categories[3], "hidden interferer", [6, 4]]];
}

/** What lines and badges mean, in as many rows as it takes. */
function legend(p: Painter, ctx: Context, box: Box): void {
  const { colours, ui } = ctx;
  const entries: [string, (x: number, y: number) => void][] = entriesOf(ctx).map(([stroke, words, dash]) => (
    [words, (x, y) => p.line([x, y, x + 24, y], { stroke, width: 3, dash })]));
  if (!ui.load) entries.push(["tasks waiting", (x, y) => p.circle(x + 12, y, 7, { fill: colours.bad })]);
  const rows: [string, (x: number, y: number) => void, number][][] = [[]];
  let x = 16;
  for (const [words, mark] of entries) {
    const width = 50 + widthOf(words, 11);
    if (x + width > box.width && rows[rows.length - 1].length) {
      rows.push([]);
      x = 16;
    }
    rows[rows.length - 1].push([words, mark, x]);
    x += width;
  }
  rows.forEach((row, i) => row.forEach(([words, mark, left]) => {
    const y = box.height - 14 - (rows.length - 1 - i) * 18;
    mark(left, y);
    p.text(left + 30, y, words, { fill: colours.muted, size: 11, halo: colours.paper });
  }));
}

/** Link nearest to a point, within reach; -1 if there is none. */
function linkAt(ctx: Context, places: Place[], x: number, y: number): number {
  let best = -1;
  let least = 6;
  ctx.run.links.forEach((_, i) => {
    const [x0, y0, x1, y1] = segment(ctx, places, i);
    const along = Math.max(0, Math.min(1, ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / ((x1 - x0) ** 2 + (y1 - y0) ** 2 || 1)));
    const distance = Math.hypot(x0 + along * (x1 - x0) - x, y0 + along * (y1 - y0) - y);
    if (distance < least) [best, least] = [i, distance];
  });
  return best;
}

function table(ctx: Context): Table {
  const { run, cursor, extras } = ctx;
  const loads = loadsOf(ctx);
  const rate = new Float64Array(run.links.length);
  const flows = new Int32Array(run.links.length);
  for (const x of cursor.active) {
    for (const link of run.routeOf(x)) {
      rate[link] += cursor.rateOf(x);
      flows[link] += 1;
    }
  }
  return {
    columns: ["link", "from", "to", "clean MB/s", "transfers now", "rate now MB/s", "transfers in the run", "MB in the run", "shares the channel with", "hidden interferers"],
    rows: run.links.map((link, i) => [link.id, run.nodes[link.source].id, run.nodes[link.target].id, number(link.bandwidth), flows[i], number(rate[i]),
      loads.transfers[i], number(loads.MB[i]), extras.relations?.contenders[i]?.length ?? null, extras.relations?.hidden[i]?.length ?? null]),
    pick: (row) => ({ kind: "link", id: row }),
  };
}

export const topology: View = {
  id: "topology", tableFollows: true,
  title: "Topology",
  key: "3",
  summary: (ctx) => `Map of ${count(ctx.run.nodes.length, "node")} and ${count(ctx.run.links.length, "link")}; ${count(ctx.cursor.active.length, "transfer")} in service now`,
  draw,
  overlay,
  isMap: true,
  hit(ctx, box, x, y) {
    const places = placesOf(ctx, box);
    const node = places.findIndex((each) => Math.hypot(each.x - x, each.y - y) <= radiusOf(ctx));
    if (node >= 0) return { kind: "node", id: node };
    const link = linkAt(ctx, places, x, y);
    return link < 0 ? null : { kind: "link", id: link };
  },
  table,
};
