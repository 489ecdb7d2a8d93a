/** The run in numbers, all of them Python's. */

import { number, percent, seconds } from "../draw/format";
import { fitted, hatch, type Painter } from "../draw/painter";
import type { Box, Context, View } from "./view";

const words = (part: string): string => part.replaceAll("_", " ");

function draw(p: Painter, ctx: Context, box: Box): void {
  const { run, colours, extras } = ctx;
  const metrics = extras.metrics?.[0];
  const facts: [string, string][] = [
    ["status", run.status.replaceAll("_", " ")],
    ["makespan", run.done?.makespan != null ? `${seconds(run.done.makespan)} s` : "–"],
    ["critical path alone", metrics?.critical_path_s != null ? `${number(metrics.critical_path_s, 6)} s` : "–"],
    ["tasks ended", metrics ? `${metrics.tasks.ended} of ${metrics.tasks.total}` : String(run.tasks)],
    ["between nodes", metrics ? `${number(metrics.remote_MB)} MB, ${number(metrics.route_work_MB_hops)} MB·hops` : "–"],
    ["mean slowdown", metrics?.mean_transfer_slowdown != null ? `× ${number(metrics.mean_transfer_slowdown)}` : "–"],
  ];
  const wide = (box.width - 32) / facts.length;
  facts.forEach(([label, value], i) => {
    p.rect(16 + i * wide, 14, wide - 10, 58, { fill: colours.panel });
    p.text(26 + i * wide, 30, label, { fill: colours.muted, size: 11 });
    p.text(26 + i * wide, 52, fitted(value, wide - 28, 14), { fill: colours.ink, size: 14, bold: true });
  });
  let y = 100;
  const explanation = extras.explanation?.[0];
  if (explanation) {
    p.text(16, y, "Where the makespan went (binding chain)", { fill: colours.ink, size: 14, bold: true });
    let x = 16;
    const whole = box.width - 32;
    Object.entries(explanation.totals_us).filter(([, spent]) => spent > 0).forEach(([part, spent], i) => {
      const width = (spent / explanation.makespan_us) * whole;
      p.rect(x, y + 16, width, 26, { fill: colours.categories[i % 8] });
      if (i % 2) hatch(p, x, y + 16, width, 26, colours.paper, 7);
      x += width;
      const column = i % 3;
      const row = Math.floor(i / 3);
      p.rect(16 + column * (whole / 3), y + 54 + row * 20, 12, 12, { fill: colours.categories[i % 8] });
      p.text(34 + column * (whole / 3), y + 60 + row * 20, `${words(part)}: ${seconds(spent)} s, ${percent(spent / explanation.makespan_us)}`, { fill: colours.ink, size: 12 });
    });
    y += 130;
  }
  if (!metrics) return;
  const half = (box.width - 48) / 2;
  const bars = (left: number, title: string, rows: { id: string; utilisation: number }[]): void => {
    p.text(left, y, title, { fill: colours.ink, size: 14, bold: true });
    const busy = rows.filter((row) => row.utilisation > 0).sort((a, b) => b.utilisation - a.utilisation).slice(0, 14);
    busy.forEach((row, i) => {
      const top = y + 16 + i * 22;
      p.text(left, top + 8, fitted(row.id, 85, 12), { fill: colours.ink, size: 12 });
      p.rect(left + 90, top, (half - 150) * row.utilisation, 15, { fill: colours.categories[0] });
      p.text(left + 96 + (half - 150) * row.utilisation, top + 8, percent(row.utilisation), { fill: colours.ink, size: 11 });
    });
  };
  bars(16, "Busiest nodes (up to 14)", [...metrics.nodes]);
  bars(32 + half, "Busiest links (up to 14)", [...metrics.links]);
}

export const overview: View = {
  id: "overview", title: "Overview", draw,
  height: () => 570,
  summary: (ctx) => `Run ${ctx.run.status}${ctx.run.done?.makespan != null ? `, makespan ${seconds(ctx.run.done.makespan)} s` : ""}`,
  table: (ctx) => ({
    columns: ["what", "label", "from s", "to s", "spent on"],
    rows: (ctx.extras.explanation?.[0]?.chain ?? []).map((item) => [item.kind, item.label, seconds(item.start_us), seconds(item.end_us),
      Object.entries(item.parts_us).filter(([, us]) => us).map(([part, us]) => `${words(part)} ${seconds(us)}`).join(", ")]),
    note: ctx.extras.note,
  }),
};
