/** The run in numbers, all of them Python's. */

import type { ChainItem } from "../data/extras";
import { timeAxis, xOf } from "../draw/axis";
import { number, percent, seconds } from "../draw/format";
import { fitted, hatch, type Painter } from "../draw/painter";
import type { Box, Context, View } from "./view";

const words = (part: string): string => part.replaceAll("_", " ");

type Fact = [label: string, value: string];

function factsOf({ run, extras }: Context): Fact[] {
  const metrics = extras.metrics?.[0];
  return [
    ["status", words(run.isLive ? "live" : run.status)],
    ["makespan", run.done?.makespan != null ? `${seconds(run.done.makespan)} s` : "–"],
    ["critical path alone", metrics?.critical_path_s != null ? `${number(metrics.critical_path_s, 6)} s` : "–"],
    ["tasks ended", metrics ? `${metrics.tasks.ended} of ${metrics.tasks.total}` : String(run.tasks)],
    ["payload between nodes", metrics ? `${number(metrics.remote_MB)} MB` : "–"],
    ["MB × hops", metrics ? number(metrics.route_work_MB_hops) : "–"],
    ["mean slowdown", metrics?.mean_transfer_slowdown != null ? `× ${number(metrics.mean_transfer_slowdown)}` : "–"],
    ["worst slowdown", metrics?.max_transfer_slowdown != null ? `× ${number(metrics.max_transfer_slowdown)}` : "–"],
  ];
}

const CARD = { width: 160, height: 66 };
const perRow = (width: number): number => Math.max(1, Math.min(8, Math.floor((width - 22) / CARD.width)));

function draw(p: Painter, ctx: Context, box: Box): void {
  let y = paintFacts(p, ctx, box.width);
  const { detail } = ctx.run.done ?? { detail: "" };
  if (detail) {
    p.text(16, y, fitted(detail, box.width - 32, 13), { fill: ctx.colours.bad, size: 13, bold: true });
    y += 28;
  }
  y = paintChain(p, ctx, box.width, y);
  y = paintBusiest(p, ctx, box.width, y);
  paintItems(p, ctx, box, y);
}

function paintFacts(p: Painter, ctx: Context, width: number): number {
  const { colours } = ctx;
  const facts = factsOf(ctx);
  const many = perRow(width);
  const wide = (width - 22) / many;
  facts.forEach(([label, value], i) => {
    const [x, y] = [16 + (i % many) * wide, 14 + Math.floor(i / many) * CARD.height];
    p.rect(x, y, wide - 10, CARD.height - 8, { fill: colours.panel });
    p.text(x + 10, y + 16, label, { fill: colours.muted, size: 11 });
    p.text(x + 10, y + 38, fitted(value, wide - 26, 15), { fill: colours.ink, size: 15, bold: true });
  });
  return 14 + Math.ceil(facts.length / many) * CARD.height + 22;
}

/** Every second part is hatched, so that neighbours differ without colour. */
function swatch(p: Painter, ctx: Context, x: number, y: number, width: number, height: number, i: number): void {
  p.rect(x, y, width, height, { fill: ctx.colours.categories[i % 8] });
  if (i % 2) hatch(p, x, y, width, height, ctx.colours.paper, 6);
}

/** Width of an entry of the legend, which its longest text fits into. */
const LEGEND = 250;
const partsPerRow = (width: number): number => Math.max(1, Math.min(3, Math.floor((width - 32) / LEGEND)));

/** Where the makespan went along the binding chain; Python's numbers. */
function paintChain(p: Painter, ctx: Context, width: number, y: number): number {
  const { colours, extras } = ctx;
  const explanation = extras.explanation?.[0];
  if (!explanation) return y;
  p.text(16, y, fitted("Where the makespan went, along the binding chain", 0.9 * width - 32, 14), { fill: colours.ink, size: 14, bold: true });
  const whole = width - 32;
  const parts = Object.entries(explanation.totals_us).filter(([, spent]) => spent > 0);
  const many = partsPerRow(width);
  let x = 16;
  parts.forEach(([part, spent], i) => {
    const share = spent / explanation.makespan_us;
    swatch(p, ctx, x, y + 16, share * whole, 26, i);
    x += share * whole;
    const [left, row] = [16 + (i % many) * (whole / many), y + 54 + Math.floor(i / many) * 20];
    swatch(p, ctx, left, row, 14, 12, i);
    p.text(left + 20, row + 6, `${words(part)}: ${seconds(spent)} s, ${percent(share)}`, { fill: colours.ink, size: 12 });
  });
  return y + 54 + Math.ceil(parts.length / many) * 20 + 30;
}

const BARS = 14;

function paintBusiest(p: Painter, ctx: Context, width: number, y: number): number {
  const { colours, marks, extras } = ctx;
  const metrics = extras.metrics?.[0];
  if (!metrics) return y;
  const half = (width - 48) / 2;
  const bars = (left: number, title: string, rows: { id: string; utilisation: number }[], isMarked: (i: number) => boolean): void => {
    const busy = rows.map((row, i) => ({ ...row, i })).filter((row) => row.utilisation > 0).sort((a, b) => b.utilisation - a.utilisation);
    const more = busy.length > BARS ? `, the first ${BARS} of ${busy.length}` : "";
    p.text(left, y, `${title}${more}`, { fill: colours.ink, size: 14, bold: true });
    busy.slice(0, BARS).forEach((row, k) => {
      const top = y + 16 + k * 22;
      p.text(left, top + 8, fitted(row.id, 85, 12), { fill: isMarked(row.i) ? colours.select : colours.ink, size: 12, bold: isMarked(row.i) });
      p.rect(left + 90, top, (half - 150) * row.utilisation, 15, { fill: colours.categories[0] });
      p.text(left + 96 + (half - 150) * row.utilisation, top + 8, percent(row.utilisation), { fill: colours.ink, size: 11 });
    });
  };
  bars(16, "Busiest nodes", metrics.nodes, (i) => marks.nodes.has(i));
  bars(32 + half, "Busiest links", metrics.links, (i) => marks.links.has(i));
  return y + busiestHeight(ctx);
}

const busyRows = (rows: { utilisation: number }[] = []): number => Math.min(BARS, rows.filter((row) => row.utilisation > 0).length);
const busiestHeight = ({ extras }: Context): number =>
  (extras.metrics?.[0] ? 46 + 22 * Math.max(busyRows(extras.metrics[0].nodes), busyRows(extras.metrics[0].links)) : 0);

const ITEM = 22;
const ITEMS_LEFT = 190;
const itemsOf = ({ extras }: Context): ChainItem[] => (extras.explanation?.[0]?.chain ?? []).filter((item) => item.end_us > item.start_us);

/** The binding chain, one row after the other: when each link of it was, and on what it spent its time. */
function paintItems(p: Painter, ctx: Context, box: Box, y: number): void {
  const { colours, extras, run, marks } = ctx;
  const items = itemsOf(ctx);
  if (!items.length) return;
  p.text(16, y, "The binding chain, step by step", { fill: colours.ink, size: 14, bold: true });
  const order = Object.entries(extras.explanation?.[0]?.totals_us ?? {}).filter(([, spent]) => spent > 0).map(([part]) => part);
  const scale = { from: 0, to: Math.max(1, run.end), left: ITEMS_LEFT, right: box.width - 16 };
  timeAxis(p, scale, y + 10, y + 32 + items.length * ITEM, colours);
  items.forEach((item, k) => {
    const top = y + 34 + k * ITEM;
    if (top > box.bottom || top + ITEM < box.top) return;
    const isMarked = (item.kind === "task" ? marks.tasks : marks.transfers).has(item.number);
    p.text(16, top + 8, fitted(`${item.label} ${item.kind === "task" ? "on" : "over"} ${item.place.join(", ")}`, ITEMS_LEFT - 24, 12), { fill: isMarked ? colours.select : colours.ink, size: 12, bold: isMarked });
    let at = item.start_us;
    for (const [part, spent] of Object.entries(item.parts_us).filter(([, us]) => us > 0)) {
      swatch(p, ctx, xOf(scale, at), top, Math.max(1, xOf(scale, at + spent) - xOf(scale, at)), 15, Math.max(0, order.indexOf(part)));
      at += spent;
    }
  });
}

/** Where the rows of the chain begin. */
function itemsTop(ctx: Context, width: number): number {
  const cards = 14 + Math.ceil(8 / perRow(width)) * CARD.height + 22 + (ctx.run.done?.detail ? 28 : 0);
  const explanation = ctx.extras.explanation?.[0];
  const parts = Object.values(explanation?.totals_us ?? {}).filter((spent) => spent > 0).length;
  return cards + (explanation ? 54 + Math.ceil(parts / partsPerRow(width)) * 20 + 30 : 0) + busiestHeight(ctx);
}

export const overview: View = {
  id: "overview", title: "Overview", key: "1", draw,
  height: (ctx, width) => itemsTop(ctx, width) + 44 + itemsOf(ctx).length * ITEM,
  hit(ctx, box, _x, y) {
    const item = itemsOf(ctx)[Math.floor((y - itemsTop(ctx, box.width) - 34) / ITEM)];
    return item && item.kind !== "injection" && item.number >= 0 ? { kind: item.kind, id: item.number } : null;
  },
  summary: (ctx) => `Run ${ctx.run.status}${ctx.run.done?.makespan != null ? `, makespan ${seconds(ctx.run.done.makespan)} s` : ""}`,
  table: (ctx) => ({
    columns: ["what", "label", "from s", "to s", "spent on"],
    rows: (ctx.extras.explanation?.[0]?.chain ?? []).map((item) => [item.kind, item.label, seconds(item.start_us), seconds(item.end_us),
      Object.entries(item.parts_us).filter(([, us]) => us).map(([part, us]) => `${words(part)} ${seconds(us)}`).join(", ")]),
    note: ctx.extras.note,
  }),
};
