/** One playhead over map, service and Gantt at once. */

import { number } from "../draw/format";
import { fitted, type Painter } from "../draw/painter";
import { gantt } from "./gantt";
import { nowText } from "./names";
import { topology } from "./topology";
import { boxOf, type Box, type Context, type View } from "./view";

const HEAD = 28;
const SIDE = 320;
const ROW = 34;

interface Panes { map: Box; chart: Box; chartTop: number; side: { left: number; top: number; width: number; height: number } }

/** The map left, what is in service right of it, the Gantt chart below; one below the other where the screen is narrow. */
function panesOf(box: Box): Panes {
  const height = box.bottom - box.top;
  const isNarrow = box.width < 2 * SIDE;
  const below = Math.round(height * (isNarrow ? 0.36 : 0.42));
  const above = height - HEAD - below;
  const chart = boxOf(box.width, below);
  if (!isNarrow) return { map: boxOf(box.width - SIDE, above), chart, chartTop: HEAD + above, side: { left: box.width - SIDE, top: HEAD, width: SIDE, height: above } };
  const mapHeight = Math.round(above * 0.62);
  return { map: boxOf(box.width, mapHeight), chart, chartTop: HEAD + above, side: { left: 12, top: HEAD + mapHeight, width: box.width - 12, height: above - mapHeight } };
}

/** The chart is pressed into its pane. */
const pressed = (ctx: Context): Context => ({ ...ctx, ui: { ...ctx.ui, fit: true } });

function draw(p: Painter, ctx: Context, box: Box): void {
  const panes = panesOf(box);
  p.shift(0, HEAD, () => topology.draw?.(p, ctx, panes.map));
  p.line([0, panes.chartTop, box.width, panes.chartTop], { stroke: ctx.colours.grid });
  p.shift(0, panes.chartTop, () => gantt.draw?.(p, pressed(ctx), panes.chart));
}

function overlay(p: Painter, ctx: Context, box: Box): void {
  const panes = panesOf(box);
  p.text(12, 15, fitted(nowText(ctx), box.width - 24, 14), { fill: ctx.colours.ink, size: 14, bold: true });
  p.shift(0, HEAD, () => topology.overlay?.(p, ctx, panes.map));
  p.shift(panes.side.left, panes.side.top, () => service(p, ctx, panes.side));
  p.shift(0, panes.chartTop, () => gantt.overlay?.(p, pressed(ctx), panes.chart));
}

/** Transfers in service now: rate as a share of the rate alone. */
function service(p: Painter, ctx: Context, { width, height }: Panes["side"]): void {
  const { run, cursor, colours, marks } = ctx;
  const active = [...cursor.active].sort((a, b) => a - b);
  p.text(0, 12, `In service: ${active.length} (bar: share of the rate alone)`, { fill: colours.muted, size: 11 });
  const fits = Math.max(0, Math.floor((height - 40) / ROW));
  active.slice(0, fits).forEach((x, i) => {
    const y = 30 + i * ROW;
    const solo = run.soloRate(x);
    const share = Math.min(1, cursor.rateOf(x) / (solo || 1));
    p.text(0, y, fitted(run.transferName(x), 150, 12), { fill: marks.transfers.has(x) ? colours.select : colours.ink, size: 12, bold: true });
    p.text(width - 16, y, `${number(cursor.rateOf(x), 3)} of ${number(solo, 3)} MB/s`, { fill: colours.ink, size: 11, anchor: "end" });
    p.rect(0, y + 9, width - 16, 8, { fill: colours.panel, stroke: colours.grid });
    p.rect(0, y + 9, (width - 16) * share, 8, { fill: colours.categories[run.exDag.data[x] % 8] });
  });
  if (active.length > fits) p.text(0, 30 + fits * ROW, `and ${active.length - fits} more`, { fill: colours.muted, size: 11 });
}

/** The pane under a point, its view, and where its corner is. */
function paneAt(box: Box, x: number, y: number): { view: View; pane: Box; left: number; top: number } | null {
  const panes = panesOf(box);
  if (y >= panes.chartTop) return { view: gantt, pane: panes.chart, left: 0, top: panes.chartTop };
  if (y >= HEAD && y < HEAD + panes.map.height && x < panes.map.width) return { view: topology, pane: panes.map, left: 0, top: HEAD };
  return null;
}

export const replay: View = {
  id: "replay", tableFollows: true, title: "Replay", key: "6",
  summary: (ctx) => `Map, transfers in service and Gantt chart at the playhead: ${nowText(ctx)}`,
  draw,
  overlay,
  height: (_ctx, _width, room) => Math.max(520, room),
  scale: (ctx, box) => (gantt.scale as NonNullable<View["scale"]>)(ctx, panesOf(box).chart),
  hit(ctx, box, x, y) {
    const found = paneAt(box, x, y);
    return found?.view.hit?.(pressed(ctx), found.pane, x - found.left, y - found.top) ?? null;
  },
  table(ctx) {
    const { run, cursor } = ctx;
    const active = [...cursor.active].sort((a, b) => a - b);
    return {
      columns: ["in service now", "MB/s", "alone MB/s", "served MB", "of MB"],
      rows: active.map((x) => [run.transferName(x), cursor.rateOf(x), run.soloRate(x), run.servedBy(x, ctx.ui.time), run.exSize.data[x]]),
      pick: (row) => ({ kind: "transfer", id: active[row] }),
      note: nowText(ctx),
    };
  },
};
