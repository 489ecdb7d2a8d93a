/** One recalculation: its trigger, and before and after of every transfer it moved. */

import { count, number, seconds } from "../draw/format";
import { fitted, type Painter } from "../draw/painter";
import { causeOf } from "./names";
import type { Box, Context, View } from "./view";

const ROW = 30;
const TOP = 84;

/** The recalculation in focus: selected, or the last one at the playhead. */
export function focus(ctx: Context): number {
  if (ctx.ui.selection?.kind === "recalc") return ctx.ui.selection.id;
  const { data } = ctx.run.rcEvent;
  let found = ctx.run.recalcs > 0 ? 0 : -1;
  for (let i = 0; i < ctx.run.recalcs && data[i] <= ctx.ui.event; i++) found = i;
  return found;
}

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

function draw(p: Painter, ctx: Context, box: Box): void {
  const { run, colours } = ctx;
  const recalc = focus(ctx);
  if (recalc < 0) {
    p.text(20, 40, "No rate was recorded in this run.", { fill: colours.muted, size: 14 });
    return;
  }
  const [from, to] = run.stepRange(recalc);
  const event = run.rcEvent.data[recalc];
  p.text(16, 22, `Recalculation ${recalc + 1} of ${run.recalcs}, line ${run.evLine.data[event]}, at ${seconds(run.evTime.data[event])} s`, { fill: colours.ink, size: 15, bold: true });
  p.text(16, 46, `${causeOf(run, recalc)} → ${count(to - from, "rate")} moved.  Step with [ and ].`, { fill: colours.ink, size: 13 });
  let most = 1e-9;
  for (let step = from; step < to; step++) most = Math.max(most, run.stRate.data[step], before(ctx, step));
  const wide = Math.max(120, box.width - 640);
  const heads: [number, string][] = [[16, "transfer"], [170, "MB/s before (hollow) and after (filled)"], [190 + wide, "before → after"], [330 + wide, "bottleneck, contenders, hidden, flows"]];
  for (const [x, text] of heads) p.text(x, TOP - 14, text, { fill: colours.muted, size: 11 });
  for (let step = from; step < to; step++) {
    const y = TOP + (step - from) * ROW + ROW / 2;
    const old = before(ctx, step);
    const rate = run.stRate.data[step];
    p.text(16, y, fitted(run.transferName(run.stTransfer.data[step]), 145, 12), { fill: colours.ink, size: 12 });
    const at = (value: number): number => 170 + (value / most) * wide;
    p.line([170, y, 170 + wide, y], { stroke: colours.grid });
    p.line([at(old), y, at(rate), y], { stroke: rate < old ? colours.bad : colours.accent, width: 3 });
    p.circle(at(old), y, 5, { fill: colours.paper, stroke: colours.ink });
    p.circle(at(rate), y, 5, { fill: rate < old ? colours.bad : colours.accent, stroke: colours.ink });
    p.text(190 + wide, y, `${number(old, 3)} → ${number(rate, 3)} ${rate < old ? "▼" : "▲"}`, { fill: colours.ink, size: 12 });
    p.text(330 + wide, y, `${run.links[run.stLink.data[step]].id}, ${run.stContenders.data[step]}, ${run.stHidden.data[step]}, ${run.stFlows.data[step]}`, { fill: colours.ink, size: 12 });
  }
}

export const cascade: View = {
  id: "cascade",
  title: "Cascade",
  summary: (ctx) => (focus(ctx) < 0 ? "No recalculation is recorded" : `Recalculation ${focus(ctx) + 1} of ${ctx.run.recalcs}: ${causeOf(ctx.run, focus(ctx))}`),
  draw,
  height: (ctx) => {
    const [from, to] = focus(ctx) < 0 ? [0, 0] : ctx.run.stepRange(focus(ctx));
    return TOP + (to - from) * ROW + 20;
  },
  hit(ctx, _box, _x, y) {
    if (focus(ctx) < 0) return null;
    const [from, to] = ctx.run.stepRange(focus(ctx));
    const step = from + Math.floor((y - TOP) / ROW);
    return y >= TOP && step < to ? { kind: "transfer", id: ctx.run.stTransfer.data[step] } : null;
  },
  table(ctx) {
    const { run } = ctx;
    const recalc = focus(ctx);
    const [from, to] = recalc < 0 ? [0, 0] : run.stepRange(recalc);
    const rows = [];
    for (let step = from; step < to; step++) {
      const end = finish(ctx, step);
      rows.push([run.transferName(run.stTransfer.data[step]), before(ctx, step), run.stRate.data[step], run.links[run.stLink.data[step]].id, run.stContenders.data[step],
        run.stHidden.data[step], run.stFlows.data[step], end === Infinity ? "paused" : seconds(Math.ceil(end))]);
    }
    return { columns: ["transfer", "MB/s before", "MB/s after", "bottleneck", "contenders", "hidden", "flows", "would finish s"], rows,
      pick: (row) => ({ kind: "transfer", id: run.stTransfer.data[from + row] }) };
  },
};
