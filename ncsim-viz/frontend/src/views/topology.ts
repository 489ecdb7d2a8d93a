/** The map: rates on links, queues at nodes, conflicts of a selected link. */

import { count, number } from "../draw/format";
import { type Painter } from "../draw/painter";
import type { Box, Context, View } from "./view";

interface Place { x: number; y: number }

export function placesOf(ctx: Context, box: Box): Place[] {
  const { nodes } = ctx.run;
  const has = nodes.every((node) => node.x !== null && node.y !== null);
  const raw = nodes.map((node, i): Place => has ? { x: node.x as number, y: node.y as number }
    : { x: Math.cos((2 * Math.PI * i) / nodes.length), y: Math.sin((2 * Math.PI * i) / nodes.length) });
  let [x0, x1, y0, y1] = [Infinity, -Infinity, Infinity, -Infinity];
  for (const { x, y } of raw) {
    x0 = Math.min(x0, x); x1 = Math.max(x1, x); y0 = Math.min(y0, y); y1 = Math.max(y1, y);
  }
  const scale = Math.min((box.width - 120) / (x1 - x0 || 1), (box.height - 130) / (y1 - y0 || 1));
  return raw.map(({ x, y }) => ({ x: box.width / 2 + (x - (x0 + x1) / 2) * scale, y: box.height / 2 - 10 - (y - (y0 + y1) / 2) * scale }));
}

/** Ends of a link, moved aside so that both directions are seen. */
function segment(ctx: Context, places: Place[], link: number): [number, number, number, number] {
  const { source, target } = ctx.run.links[link];
  const [a, b] = [places[source], places[target]];
  const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
  const [ux, uy] = [(b.x - a.x) / length, (b.y - a.y) / length];
  const [ox, oy] = [-uy * 4, ux * 4];
  return [a.x + ux * 16 + ox, a.y + uy * 16 + oy, b.x - ux * 16 + ox, b.y - uy * 16 + oy];
}

function draw(p: Painter, ctx: Context, box: Box): void {
  const { run, colours, cursor, ui } = ctx;
  const places = placesOf(ctx, box);
  const load = new Float64Array(run.links.length);
  const rate = new Float64Array(run.links.length);
  const flows = new Int32Array(run.links.length);
  if (ui.load) {
    for (let x = 0; x < run.transfers; x++) for (const link of run.routeOf(x)) load[link] += run.exSize.data[x];
  }
  for (const x of cursor.active) {
    for (const link of run.routeOf(x)) {
      rate[link] += cursor.rateOf(x);
      flows[link] += 1;
    }
  }
  const most = load.reduce((a, b) => Math.max(a, b), 1e-9);
  run.links.forEach((_, i) => p.line(segment(ctx, places, i), { stroke: colours.grid, width: 1 }));
  run.links.forEach((link, i) => {
    const points = segment(ctx, places, i);
    const share = ui.load ? load[i] / most : rate[i] / (link.bandwidth || 1);
    if (ui.load ? load[i] > 0 : flows[i] > 0) {
      const isPaused = !ui.load && rate[i] === 0;
      p.line(points, { stroke: isPaused ? colours.bad : colours.accent, width: isPaused ? 2 : 2 + 7 * Math.min(1, share), dash: isPaused ? [2, 4] : [] });
      arrow(p, points, colours.accent);
    }
  });
  overlay(p, ctx, places);
  run.nodes.forEach((node, i) => {
    const { x, y } = places[i];
    const task = cursor.running[i];
    const isSelected = ui.selection?.kind === "node" && ui.selection.id === i;
    p.circle(x, y, 14, { fill: task >= 0 ? colours.categories[run.tkDag.data[task] % 8] : colours.panel, stroke: isSelected ? colours.select : colours.ink, width: isSelected ? 3 : 1 });
    const ink = task >= 0 ? colours.onCategory[run.tkDag.data[task] % 8] : colours.ink;
    p.text(x, y, node.id.slice(0, 5), { fill: ink, size: 10, anchor: "middle", bold: true });
    if (task >= 0) p.text(x, y + 23, `▶ ${run.taskName(task)}`, { fill: colours.ink, size: 11, anchor: "middle", halo: colours.paper });
    if (cursor.queued[i] > 0) {
      p.circle(x + 14, y - 12, 8, { fill: colours.bad });
      p.text(x + 14, y - 12, String(cursor.queued[i]), { fill: colours.paper, size: 10, anchor: "middle", bold: true });
    }
  });
  legend(p, ctx, box);
}

function arrow(p: Painter, [x0, y0, x1, y1]: [number, number, number, number], fill: string): void {
  const length = Math.hypot(x1 - x0, y1 - y0) || 1;
  const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
  p.area([x1, y1, x1 - ux * 9 - uy * 5, y1 - uy * 9 + ux * 5, x1 - ux * 9 + uy * 5, y1 - uy * 9 - ux * 5], { fill });
}

function overlay(p: Painter, ctx: Context, places: Place[]): void {
  const { ui, run, colours } = ctx;
  if (ui.selection?.kind === "transfer") {
    for (const link of run.routeOf(ui.selection.id)) p.line(segment(ctx, places, link), { stroke: colours.select, width: 3 });
  }
  if (ui.selection?.kind !== "link") return;
  const chosen = ui.selection.id;
  const relations = ctx.extras.relations;
  if (relations && ui.conflicts) {
    for (const link of relations.contenders[chosen] ?? []) p.line(segment(ctx, places, link), { stroke: colours.categories[1], width: 2.5 });
    for (const link of relations.hidden[chosen] ?? []) p.line(segment(ctx, places, link), { stroke: colours.categories[3], width: 2.5, dash: [6, 4] });
  }
  p.line(segment(ctx, places, chosen), { stroke: colours.select, width: 5 });
}

function legend(p: Painter, ctx: Context, box: Box): void {
  const { colours, ui, extras } = ctx;
  const y = box.height - 16;
  const words: [string, string, number[]][] = ui.load
    ? [[colours.accent, "MB carried in the whole run, by width", []]]
    : [[colours.accent, "rate, by width up to the clean bandwidth", []], [colours.bad, "paused at zero rate", [2, 4]]];
  if (ui.selection?.kind === "link") {
    words.push([colours.categories[1], "shares the channel", []], [colours.categories[3], "hidden interferer", [6, 4]]);
    if (!extras.relations) words.push([colours.muted, "(relations are not recorded)", []]);
  }
  let x = 16;
  for (const [stroke, text, dash] of words) {
    p.line([x, y, x + 24, y], { stroke, width: 3, dash });
    p.text(x + 30, y, text, { fill: colours.muted, size: 11 });
    x += 50 + text.length * 6.2;
  }
  if (!ui.load) {
    p.circle(x + 6, y, 7, { fill: colours.bad });
    p.text(x + 18, y, "tasks waiting", { fill: colours.muted, size: 11 });
  }
}

export const topology: View = {
  id: "topology",
  title: "Topology",
  summary: (ctx) => `Map of ${count(ctx.run.nodes.length, "node")} and ${count(ctx.run.links.length, "link")}; ${count(ctx.cursor.active.length, "transfer")} in service now`,
  draw,
  hit(ctx, box, x, y) {
    const places = placesOf(ctx, box);
    const node = places.findIndex((each) => Math.hypot(each.x - x, each.y - y) < 15);
    if (node >= 0) return { kind: "node", id: node };
    let best = -1;
    let least = 6;
    ctx.run.links.forEach((_, i) => {
      const [x0, y0, x1, y1] = segment(ctx, places, i);
      const along = Math.max(0, Math.min(1, ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / ((x1 - x0) ** 2 + (y1 - y0) ** 2 || 1)));
      const distance = Math.hypot(x0 + along * (x1 - x0) - x, y0 + along * (y1 - y0) - y);
      if (distance < least) {
        least = distance;
        best = i;
      }
    });
    return best < 0 ? null : { kind: "link", id: best };
  },
  table(ctx) {
    const { run, cursor } = ctx;
    const rate = new Float64Array(run.links.length);
    const flows = new Int32Array(run.links.length);
    for (const x of cursor.active) for (const link of run.routeOf(x)) {
      rate[link] += cursor.rateOf(x);
      flows[link] += 1;
    }
    return {
      columns: ["link", "from", "to", "clean MB/s", "transfers now", "rate now MB/s", "shares the channel with", "hidden interferers"],
      rows: run.links.map((link, i) => [link.id, run.nodes[link.source].id, run.nodes[link.target].id, number(link.bandwidth), flows[i], number(rate[i]),
        ctx.extras.relations ? ctx.extras.relations.contenders[i].length : null, ctx.extras.relations ? ctx.extras.relations.hidden[i].length : null]),
      pick: (row) => ({ kind: "link", id: row }),
    };
  },
};
