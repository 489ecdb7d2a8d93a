/** Staircases: the rate of each transfer over time, each step with its cause. */

import { timeAxis, timeOf, xOf, type Scale } from "../draw/axis";
import { count, number, seconds } from "../draw/format";
import { fitted, type Painter } from "../draw/painter";
import { causeOf, limited } from "./names";
import type { Box, Context, View } from "./view";

const ROW = 58;
const LEFT = 150;
const TOP = 24;
const MAX = 400;

const scaleOf = (ctx: Context, box: Box): Scale => ({ from: ctx.window[0], to: ctx.window[1], left: LEFT, right: box.width - 12 });

export function shownTransfers(ctx: Context): number[] {
  const { run, window } = ctx;
  const found: number[] = [];
  for (let x = 0; x < run.transfers; x++) {
    const from = run.servedFrom(x);
    if (Number.isNaN(from) || from > window[1] || run.servedTo(x) < window[0]) continue;
    found.push(x);
  }
  return found.sort((a, b) => run.servedFrom(a) - run.servedFrom(b) || a - b);
}

function draw(p: Painter, ctx: Context, box: Box): void {
  const { run, colours, ui } = ctx;
  const s = scaleOf(ctx, box);
  const all = shownTransfers(ctx);
  timeAxis(p, s, 0, box.height, colours);
  all.slice(0, MAX).forEach((x, row) => {
    const top = TOP + row * ROW;
    const floor = top + ROW - 8;
    const solo = run.soloRate(x);
    const most = run.stepsOf(x).reduce((high, step) => Math.max(high, run.stRate.data[step]), 1e-12);
    const height = ROW - 20;
    const isSelected = ui.selection?.kind === "transfer" && ui.selection.id === x;
    p.text(8, top + 18, fitted(run.transferName(x), LEFT - 14, 12), { fill: isSelected ? colours.select : colours.ink, size: 12, bold: true });
    p.text(8, top + 34, `${number(run.exSize.data[x])} MB, alone ${number(solo, 3)} MB/s`, { fill: colours.muted, size: 10 });
    p.clip(LEFT, top, s.right - LEFT, ROW, () => {
      const from = xOf(s, run.servedFrom(x));
      const end = xOf(s, Number.isNaN(run.servedTo(x)) ? run.end : run.servedTo(x));
      if (solo <= most * 1.05) p.line([from, floor - (height * solo) / most, end, floor - (height * solo) / most], { stroke: colours.muted, dash: [4, 3] });
      const steps = run.stepsOf(x);
      steps.forEach((step, k) => {
        const x0 = xOf(s, run.stepTime(step));
        const x1 = k + 1 < steps.length ? xOf(s, run.stepTime(steps[k + 1])) : end;
        const y = floor - height * (run.stRate.data[step] / most);
        const fill = colours.categories[run.exDag.data[x] % 8];
        p.rect(x0, y, Math.max(0.5, x1 - x0), floor - y, { fill, alpha: 0.75 });
        p.line([x0, y, x1, y], { stroke: colours.ink });
        const label = number(run.stRate.data[step], 2);
        if (x1 - x0 > 8 + label.length * 6) p.text((x0 + x1) / 2, Math.max(top + 8, Math.min(y - 6, floor - 10)), label, { fill: colours.ink, size: 10, anchor: "middle", halo: colours.paper });
        if (run.stRate.data[step] === 0) p.text((x0 + x1) / 2, floor - 8, "⏸", { fill: colours.bad, size: 11, anchor: "middle" });
        p.text(x0, floor + 4, run.rcIsStart.data[run.stRecalc.data[step]] ? "▲" : "●", { fill: colours.muted, size: 8, anchor: "middle" });
      });
    });
    p.line([LEFT, floor, s.right, floor], { stroke: colours.grid });
  });
  const x = xOf(s, ui.time);
  if (ui.event >= 0 && x >= LEFT) p.line([x, 0, x, box.height], { stroke: colours.select, width: 1.5 });
  if (all.length > MAX) p.text(8, TOP + MAX * ROW + 12, `The first ${MAX} of ${all.length} transfers in this window; narrow it to see others.`, { fill: colours.ink, size: 12 });
}

export const rates: View = {
  id: "rates",
  title: "Rates",
  summary: (ctx) => `Rate over time of ${count(shownTransfers(ctx).length, "transfer")}; each row is as high as its own greatest rate; the area is its size; dashed is the rate alone; ▲ a start and ● a finish of a transfer caused the step`,
  height: (ctx) => TOP + Math.min(MAX, shownTransfers(ctx).length) * ROW + 24,
  draw,
  scale: scaleOf,
  hit(ctx, box, x, y) {
    const transfer = shownTransfers(ctx)[Math.floor((y - TOP) / ROW)];
    if (transfer === undefined || y < TOP) return null;
    if (x < LEFT) return { kind: "transfer", id: transfer };
    const at = timeOf(scaleOf(ctx, box), x);
    const step = ctx.run.stepsOf(transfer).filter((each) => ctx.run.stepTime(each) <= at).pop();
    return step === undefined || at > ctx.run.servedTo(transfer) ? null : { kind: "transfer", id: transfer };
  },
  table(ctx) {
    const { run } = ctx;
    const chosen = ctx.ui.selection?.kind === "transfer" ? [ctx.ui.selection.id] : shownTransfers(ctx);
    const steps = chosen.flatMap((x) => run.stepsOf(x));
    return {
      columns: ["transfer", "from s", "MB/s", "bottleneck", "contenders", "hidden", "hidden factor", "flows on link", "cause"],
      ...limited(steps, (step) => [run.transferName(run.stTransfer.data[step]), seconds(run.stepTime(step)), run.stRate.data[step], run.links[run.stLink.data[step]].id,
        run.stContenders.data[step], run.stHidden.data[step], number(run.stFactor.data[step]), run.stFlows.data[step], causeOf(run, run.stRecalc.data[step])]),
      pick: (row) => ({ kind: "recalc", id: run.stRecalc.data[steps[row]] }),
    };
  },
};
