/** One recalculation: its trigger, and before and after of every transfer it moved. */

import { upperBound } from "../data/columns";
import { count, number, seconds } from "../draw/format";
import { fitted, type Painter } from "../draw/painter";
import { causeOf } from "./names";
import { stepText } from "./rates";
import type { Box, Cell, Context, Table, View } from "./view";

const ROW = 30;
const TOP = 96;
/** Width of the list at the left: less where there is little, none where the rates would have no room. */
const sideOf = (box: Box): number => (box.width < 700 ? 0 : box.width < 1000 ? 190 : 250);

/** The recalculation in focus: selected, or the last one at the playhead. */
export function focus(ctx: Context): number {
  const { run, ui } = ctx;
  if (ui.selection?.kind === "recalc" && ui.selection.id < run.recalcs) return ui.selection.id;
  return Math.max(run.recalcs ? 0 : -1, upperBound(run.rcEvent.data, run.recalcs, ui.event) - 1);
}

const stepsOf = (ctx: Context): [number, number] => (focus(ctx) < 0 ? [0, 0] : ctx.run.stepRange(focus(ctx)));

const before = (ctx: Context, step: number): number => {
  const previous = ctx.run.stPrevious.data[step];
  return previous < 0 ? 0 : ctx.run.stRate.data[previous];
};

/** When a transfer would finish if nothing moved its rate again; from what is left, in microseconds. */
function finish(ctx: Context, step: number): number {
  const x = ctx.run.stTransfer.data[step];
  const at = ctx.run.stepTime(step);
  const rate = ctx.run.stRate.data[step];
  return rate > 0 ? at + ((ctx.run.exSize.data[x] - ctx.run.servedBy(x, at)) / rate) * 1e6 : Infinity;
}

const finishText = (ctx: Context, step: number): string => {
  const end = finish(ctx, step);
  return end === Infinity ? "paused" : seconds(Math.ceil(end));
};

/** Where the columns stand at a width. */
interface Columns { name: number; bars: number; wide: number; rates: number; finish: number; why: number }
function columnsOf(box: Box): Columns {
  const left = sideOf(box) + 16;
  const wide = Math.max(60, box.width - left - 600);
  return { name: left, bars: left + 120, wide, rates: left + 138 + wide, finish: left + 262 + wide, why: left + 350 + wide };
}

function draw(p: Painter, ctx: Context, box: Box): void {
  const { run, colours } = ctx;
  const recalc = focus(ctx);
  if (recalc < 0) return p.text(20, 40, "No rate was recorded in this run.", { fill: colours.muted, size: 14 });
  paintList(p, ctx, recalc, box);
  const [from, to] = run.stepRange(recalc);
  const event = run.rcEvent.data[recalc];
  const at = columnsOf(box);
  const title = `Recalculation ${recalc + 1} of ${run.recalcs}, line ${run.evLine.data[event]}, at ${seconds(run.evTime.data[event])} s`;
  p.text(at.name, 22, fitted(title, 0.9 * (box.width - at.name), 15), { fill: colours.ink, size: 15, bold: true });
  p.text(at.name, 46, fitted(`${causeOf(run, recalc)} moved ${count(to - from, "rate")}. Keys [ and ] step by sequence.`, box.width - at.name - 8, 13), { fill: colours.ink, size: 13 });
  const heads: [number, string][] = [[at.name, "transfer"], [at.bars, at.wide > 150 ? "MB/s before ○ and after ●" : "○ → ●"], [at.rates, "before → after MB/s"], [at.finish, "would end s"], [at.why, "bottleneck: contenders, hidden, flows"]];
  for (const [x, text] of heads) p.text(x, TOP - 18, text, { fill: colours.muted, size: 11 });
  let most = 1e-9;
  for (let step = from; step < to; step++) most = Math.max(most, run.stRate.data[step], before(ctx, step));
  for (let step = from; step < to; step++) paintStep(p, ctx, at, step, TOP + (step - from) * ROW + ROW / 2, most);
}

function paintStep(p: Painter, ctx: Context, at: Columns, step: number, y: number, most: number): void {
  const { run, colours, ui } = ctx;
  const old = before(ctx, step);
  const rate = run.stRate.data[step];
  const x = run.stTransfer.data[step];
  const isChosen = ui.selection?.kind === "transfer" && ui.selection.id === x;
  const colour = rate < old ? colours.bad : colours.accent;
  const place = (value: number): number => at.bars + (value / most) * at.wide;
  p.text(at.name, y, fitted(run.transferName(x), 112, 12), { fill: isChosen ? colours.select : colours.ink, size: 12, bold: isChosen });
  p.line([at.bars, y, at.bars + at.wide, y], { stroke: colours.grid });
  p.line([place(old), y, place(rate), y], { stroke: colour, width: 3 });
  p.circle(place(old), y, 5, { fill: colours.paper, stroke: colours.ink });
  p.circle(place(rate), y, 5, { fill: colour, stroke: colours.ink });
  const arrow = rate < old ? "▼" : rate > old ? "▲" : "=";
  p.text(at.rates, y, `${number(old, 3)} → ${number(rate, 3)} ${arrow}`, { fill: colours.ink, size: 12 });
  p.text(at.finish, y, finishText(ctx, step), { fill: colours.ink, size: 12 });
  const why = `${run.links[run.stLink.data[step]]?.id ?? "–"}: ${run.stContenders.data[step]}, ${run.stHidden.data[step]}, ${run.stFlows.data[step]}`;
  p.text(at.why, y, why, { fill: colours.ink, size: 12 });
}

const LIST_ROW = 22;

/** Recalculations around the one in focus, by sequence. */
function listed(box: Box, recalc: number, recalcs: number): [number, number] {
  const fits = Math.max(3, Math.floor((box.bottom - box.top - 40) / LIST_ROW));
  const first = Math.max(0, Math.min(recalc - Math.floor(fits / 2), recalcs - fits));
  return [first, Math.min(recalcs, first + fits)];
}

function paintList(p: Painter, ctx: Context, recalc: number, box: Box): void {
  const { run, colours } = ctx;
  const [first, last] = listed(box, recalc, run.recalcs);
  const side = sideOf(box);
  if (!side) return;
  p.rect(0, box.top, side, box.bottom - box.top, { fill: colours.panel });
  p.text(12, box.top + 18, "time s, trigger, rates moved", { fill: colours.muted, size: 11 });
  for (let i = first; i < last; i++) {
    const y = box.top + 40 + (i - first) * LIST_ROW;
    if (i === recalc) p.rect(4, y - LIST_ROW / 2, side - 8, LIST_ROW, { fill: colours.paper, stroke: colours.select, width: 2 });
    const [from, to] = run.stepRange(i);
    const mark = run.rcIsStart.data[i] ? "▲" : "●";
    p.text(12, y, fitted(seconds(run.timeOf(run.rcEvent.data[i]), run.end / 20), 60, 11), { fill: colours.ink, size: 11 });
    p.text(76, y, fitted(`${mark} ${run.transferName(run.rcBy.data[i])}`, side - 112, 11), { fill: colours.ink, size: 11 });
    p.text(side - 14, y, String(to - from), { fill: colours.ink, size: 11, anchor: "end" });
  }
}

function stepUnder(ctx: Context, box: Box, x: number, y: number): number {
  const [from, to] = stepsOf(ctx);
  const step = from + Math.floor((y - TOP) / ROW);
  return x > sideOf(box) && y >= TOP && step < to ? step : -1;
}

function table(ctx: Context): Table {
  const { run } = ctx;
  const [from, to] = stepsOf(ctx);
  const rows: Cell[][] = [];
  for (let step = from; step < to; step++) {
    rows.push([run.transferName(run.stTransfer.data[step]), before(ctx, step), run.stRate.data[step], run.links[run.stLink.data[step]]?.id ?? null,
      run.stContenders.data[step], run.stHidden.data[step], run.stFlows.data[step], finishText(ctx, step)]);
  }
  return {
    columns: ["transfer", "MB/s before", "MB/s after", "bottleneck", "contenders", "hidden", "flows", "would finish s"], rows,
    pick: (row) => ({ kind: "transfer", id: run.stTransfer.data[from + row] }),
  };
}

export const cascade: View = {
  id: "cascade", tableFollows: true,
  title: "Cascade",
  key: "5",
  summary: (ctx) => (focus(ctx) < 0 ? "No recalculation is recorded" : `Recalculation ${focus(ctx) + 1} of ${ctx.run.recalcs}: ${causeOf(ctx.run, focus(ctx))}`),
  overlay: draw,
  draw: () => {},
  height: (ctx) => TOP + (stepsOf(ctx)[1] - stepsOf(ctx)[0]) * ROW + 20,
  hit(ctx, box, x, y) {
    const step = stepUnder(ctx, box, x, y);
    if (step >= 0) return { kind: "transfer", id: ctx.run.stTransfer.data[step] };
    if (x >= sideOf(box) || focus(ctx) < 0) return null;
    const [first, last] = listed(box, focus(ctx), ctx.run.recalcs);
    const row = first + Math.floor((y - box.top - 40 + LIST_ROW / 2) / LIST_ROW);
    return row >= first && row < last ? { kind: "recalc", id: row } : null;
  },
  tip(ctx, box, x, y) {
    const step = stepUnder(ctx, box, x, y);
    return step < 0 ? "" : stepText(ctx, step);
  },
  table,
};
