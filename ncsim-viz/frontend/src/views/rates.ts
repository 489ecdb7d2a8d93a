/** Staircases: the rate of each transfer over time, each step with its cause. */

import type { Run } from "../data/run";
import { playhead, timeAxis, timeOf, xOf, type Scale } from "../draw/axis";
import { count, number, seconds } from "../draw/format";
import { fitted, type Painter } from "../draw/painter";
import { causeOf, limited, stepAt } from "./names";
import type { Box, Context, Table, View } from "./view";

const ROW = 58;
const LEFT = 160;
const TOP = 24;
/** Marks of causes and numbers keep this distance. */
const APART_px = 8;
const PIXEL = 0.5;

const scaleOf = (ctx: Context, box: Box): Scale => ({ from: ctx.window[0], to: ctx.window[1], left: LEFT, right: box.width - 12 });

/** Transfers in service in the window, in order of service. */
export function shownTransfers(ctx: Context): number[] {
  const { run, window } = ctx;
  return ctx.memo("shown transfers", [ctx.ui.window], () => {
    const found: number[] = [];
    if (!run.recalcs) return found;
    for (let x = 0; x < run.transfers; x++) {
      const from = run.servedFrom(x);
      if (!Number.isNaN(from) && from <= window[1] && !(run.servedTo(x) < window[0])) found.push(x);
    }
    return found.sort((a, b) => run.servedFrom(a) - run.servedFrom(b) || a - b);
  });
}

function draw(p: Painter, ctx: Context, box: Box): void {
  const s = scaleOf(ctx, box);
  const all = shownTransfers(ctx);
  timeAxis(p, s, box.top, box.bottom, ctx.colours);
  p.text(8, box.top + 9, "▲ start, ● finish: cause", { fill: ctx.colours.muted, size: 10 });
  if (!all.length) p.text(LEFT, TOP + 24, emptyText(ctx), { fill: ctx.colours.muted, size: 13 });
  const first = Math.max(0, Math.floor((box.top - TOP) / ROW));
  const last = Math.min(all.length, Math.ceil((box.bottom - TOP) / ROW));
  p.clip(0, box.top + TOP - 4, box.width, box.bottom - box.top, () => {
    for (let row = first; row < last; row++) paintRow(p, ctx, s, all[row], TOP + row * ROW);
  });
}

const emptyText = (ctx: Context): string => (ctx.run.recalcs ? "No transfer is in service in this window." : "No rate was recorded in this run.");

function paintRow(p: Painter, ctx: Context, s: Scale, x: number, top: number): void {
  const { run, colours, marks } = ctx;
  const floor = top + ROW - 12;
  const solo = run.soloRate(x);
  const steps = inForce(run, x);
  const most = steps.reduce((high, step) => Math.max(high, run.stRate.data[step]), 1e-12);
  const height = ROW - 26;
  const isMarked = marks.transfers.has(x);
  if (isMarked) p.rect(0, top, LEFT - 6, ROW - 4, { fill: colours.lane, stroke: colours.select });
  p.text(8, top + 16, fitted(run.transferName(x), LEFT - 20, 12), { fill: isMarked ? colours.select : colours.ink, size: 12, bold: true });
  p.text(8, top + 32, fitted(`${number(run.exSize.data[x])} MB, alone ${number(solo, 3)} MB/s`, LEFT - 14, 10), { fill: colours.muted, size: 10 });
  p.clip(LEFT - 4, top, s.right - LEFT + 8, ROW, () => {
    const y = (rate: number): number => floor - (height * rate) / most;
    const ends = [xOf(s, run.servedFrom(x)), xOf(s, run.servedTo(x) || run.end)];
    stairs(p, ctx, s, { x, steps, top, floor, y, end: ends[1] });
    if (solo <= most * 1.05) p.line([ends[0], y(solo), ends[1], y(solo)], { stroke: colours.muted, dash: [4, 3] });
  });
  p.line([LEFT, floor, s.right, floor], { stroke: colours.grid });
}

/** The steps that were in force for some time, and the last; what the next one replaced at the same instant served no byte. */
export const inForce = (run: Run, x: number): number[] =>
  run.stepsOf(x).filter((step, k, all) => k + 1 === all.length || run.stepTime(all[k + 1]) > run.stepTime(step));

/** A piece of a staircase between two places on the screen, and which of the rates it shows. */
export interface Tread { x0: number; x1: number; k: number }

/** Pieces to draw: steps that begin in one pixel share it, at their greatest rate; the last of them goes on from there. */
export function treads(edges: number[], rates: number[]): Tread[] {
  const found: Tread[] = [];
  for (let k = 0; k < rates.length; k++) {
    const x0 = edges[k];
    let greatest = k;
    while (k + 1 < rates.length && edges[k + 1] - x0 < PIXEL) if (rates[++k] > rates[greatest]) greatest = k;
    const x1 = Math.max(x0, edges[k + 1]);
    const goesOn = greatest === k ? x0 : Math.min(x0 + PIXEL, x1);
    if (greatest !== k) found.push({ x0, x1: goesOn, k: greatest });
    found.push({ x0: goesOn, x1, k });
  }
  return found;
}

interface Stairs { x: number; steps: number[]; top: number; floor: number; y: (rate: number) => number; end: number }

/** Areas first, numbers and causes above them. */
function stairs(p: Painter, ctx: Context, s: Scale, { x, steps, top, floor, y, end }: Stairs): void {
  const { run, colours } = ctx;
  const fill = colours.categories[run.exDag.data[x] % 8];
  const edges = steps.map((step) => xOf(s, run.stepTime(step)));
  edges.push(end);
  let lastMark = -Infinity;
  let lastText = -Infinity;
  for (const { x0, x1, k } of treads(edges, steps.map((step) => run.stRate.data[step]))) {
    const rate = run.stRate.data[steps[k]];
    if (x1 < s.left - 20 || x0 > s.right + 20) continue;
    p.rect(x0, y(rate), Math.max(PIXEL, x1 - x0), floor - y(rate), { fill, alpha: 0.75 });
    p.line([x0, y(rate), x1, y(rate)], { stroke: colours.ink });
    if (rate === 0) p.text((x0 + x1) / 2, floor - 8, "paused", { fill: colours.bad, size: 10, anchor: "middle", halo: colours.paper });
    const label = number(rate, 2);
    if (rate > 0 && x1 - x0 > 8 + label.length * 6 && x0 > lastText) {
      p.text((x0 + x1) / 2, Math.max(top + 7, y(rate) - 7), label, { fill: colours.ink, size: 10, anchor: "middle", halo: colours.paper });
      lastText = x1 - 4;
    }
    if (x0 - lastMark >= APART_px) {
      p.text(x0, floor + 6, run.rcIsStart.data[run.stRecalc.data[steps[k]]] ? "▲" : "●", { fill: colours.muted, size: 8, anchor: "middle" });
      lastMark = x0;
    }
  }
}

const transferAt = (ctx: Context, box: Box, y: number): number | undefined =>
  (y < box.top + TOP - 4 ? undefined : shownTransfers(ctx)[Math.floor((y - TOP) / ROW)]);

function stepUnder(ctx: Context, box: Box, x: number, y: number): number {
  const transfer = transferAt(ctx, box, y);
  return transfer === undefined || x < LEFT ? -1 : stepAt(ctx.run, transfer, timeOf(scaleOf(ctx, box), x));
}

function table(ctx: Context, everything = false): Table {
  const { run } = ctx;
  const chosen = ctx.ui.selection?.kind === "transfer" ? [ctx.ui.selection.id] : shownTransfers(ctx);
  const steps = chosen.flatMap((x) => run.stepsOf(x));
  return {
    columns: ["transfer", "from s", "MB/s", "bottleneck", "contenders", "hidden", "hidden factor", "flows on link", "cause"],
    ...limited(steps, (step) => [run.transferName(run.stTransfer.data[step]), seconds(run.stepTime(step)), run.stRate.data[step],
      run.links[run.stLink.data[step]]?.id ?? null, run.stContenders.data[step], run.stHidden.data[step], number(run.stFactor.data[step]),
      run.stFlows.data[step], causeOf(run, run.stRecalc.data[step])], everything),
    pick: (row) => ({ kind: "recalc", id: run.stRecalc.data[steps[row]] }),
  };
}

export const rates: View = {
  id: "rates",
  title: "Rates",
  key: "4",
  summary: (ctx) => `Rate over time of ${count(shownTransfers(ctx).length, "transfer")}; each row is as high as its own greatest rate; the area is its size; dashed is the rate alone; ▲ a start and ● a finish of a transfer caused the step`,
  height: (ctx) => TOP + shownTransfers(ctx).length * ROW + 8,
  draw,
  overlay: (p, ctx, box) => {
    if (ctx.ui.event >= 0) playhead(p, scaleOf(ctx, box), ctx.ui.time, box.top, box.bottom, ctx.colours);
  },
  scale: scaleOf,
  hit(ctx, box, x, y) {
    const transfer = transferAt(ctx, box, y);
    if (transfer === undefined || (x >= LEFT && stepUnder(ctx, box, x, y) < 0)) return null;
    return { kind: "transfer", id: transfer };
  },
  tip(ctx, box, x, y) {
    const step = stepUnder(ctx, box, x, y);
    return step < 0 ? "" : stepText(ctx, step);
  },
  table,
};

/** A step in words: old and new rate, and what decides it. */
export function stepText(ctx: Context, step: number): string {
  const { run } = ctx;
  const previous = run.stPrevious.data[step];
  const old = previous < 0 ? 0 : run.stRate.data[previous];
  return [
    `${run.transferName(run.stTransfer.data[step])}: ${number(old)} → ${number(run.stRate.data[step])} MB/s`,
    `by ${causeOf(run, run.stRecalc.data[step])} at ${seconds(run.stepTime(step))} s`,
    `bottleneck ${run.links[run.stLink.data[step]]?.id ?? "–"}: ${count(run.stContenders.data[step], "contender")}, ` +
      `${count(run.stHidden.data[step], "hidden interferer")} (factor ${number(run.stFactor.data[step], 3)}), ${count(run.stFlows.data[step], "flow")}`,
  ].join("\n");
}
