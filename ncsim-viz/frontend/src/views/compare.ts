/** Two runs on one time axis: each task and transfer twice, and how much later it ended. */

import type { Run } from "../data/run";
import { playhead, timeAxis, xOf, type Scale } from "../draw/axis";
import { number, seconds } from "../draw/format";
import { fitted, hatch, type Painter } from "../draw/painter";
import type { Box, Cell, Context, Table, View } from "./view";

const ROW = 34;
const LEFT = 150;
const RIGHT = 130;
const HEAD = 74;
const SETTING = 16;
const SETTINGS = 6;

/** A task or transfer of the first run, and of the second: -1 where it is missing. */
interface Pair { kind: "task" | "transfer"; label: string; first: number; second: number }
type Side = "first" | "second";

const labelOf = (run: Run, kind: Pair["kind"], id: number): string => {
  const dag = run.dags[kind === "task" ? run.tkDag.data[id] : run.exDag.data[id]]?.id;
  if (kind === "task") return JSON.stringify([dag, run.taskIds[id]]);
  return JSON.stringify([dag, run.taskIds[run.exSource.data[id]], run.taskIds[run.exTarget.data[id]]]);
};

/** What both runs have, by the names of DAG and tasks; in order of start in the first run. */
export function pairsOf(first: Run, second: Run): Pair[] {
  const found: Pair[] = [];
  for (const kind of ["task", "transfer"] as const) {
    const many = (run: Run): number => (kind === "task" ? run.tasks : run.transfers);
    const other = new Map(Array.from({ length: many(second) }, (_, i) => [labelOf(second, kind, i), i]));
    for (let i = 0; i < many(first); i++) {
      const label = labelOf(first, kind, i);
      const match = other.get(label) ?? -1;
      other.delete(label);
      if (kind === "transfer" && first.isLocal(i) && (match < 0 || second.isLocal(match))) continue;
      found.push({ kind, label: kind === "task" ? `task ${first.taskName(i)}` : first.transferName(i), first: i, second: match });
    }
    for (const i of other.values()) {
      if (kind === "transfer" && second.isLocal(i)) continue;
      found.push({ kind, label: kind === "task" ? `task ${second.taskName(i)}` : second.transferName(i), first: -1, second: i });
    }
  }
  const start = (pair: Pair): number => (pair.first < 0 ? Infinity : spanOf(first, pair.kind, pair.first)[0]);
  return found.map((pair, i) => ({ pair, i })).sort((a, b) => (start(a.pair) - start(b.pair) || a.i - b.i)).map(({ pair }) => pair);
}

/** Start and end of a task or transfer; a local transfer takes no time. */
function spanOf(run: Run, kind: Pair["kind"], id: number): [number, number] {
  if (id < 0) return [NaN, NaN];
  if (kind === "task") return [run.startedAt(id), run.endedAt(id)];
  return run.isLocal(id) ? [run.createdAt(id), run.createdAt(id)] : [run.servedFrom(id), run.servedTo(id)];
}

const pairs = (ctx: Context): Pair[] => (ctx.other ? ctx.memo("pairs", [ctx.other], () => pairsOf(ctx.run, ctx.other as Run)) : []);
const runOf = (ctx: Context, side: Side): Run => (side === "first" ? ctx.run : (ctx.other as Run));
const namesOf = (ctx: Context): [string, string] => {
  const names = ctx.extras.comparison?.names ?? ["first", "second"];
  return names[0] === names[1] ? [`${names[0]} (first)`, `${names[1]} (second)`] : names;
};

/** How much later the second ends, and how much longer it takes, in microseconds. */
function delta(ctx: Context, pair: Pair): { later: number; longer: number; ratio: number } {
  const [a, b] = [spanOf(ctx.run, pair.kind, pair.first), spanOf(runOf(ctx, "second"), pair.kind, pair.second)];
  return { later: b[1] - a[1], longer: b[1] - b[0] - (a[1] - a[0]), ratio: (b[1] - b[0]) / (a[1] - a[0]) };
}

const signed = (us: number, window: number): string => (Number.isNaN(us) ? "–" : `${us > 0 ? "+" : us < 0 ? "−" : "±"}${seconds(Math.abs(us), window)} s`);

function whole(ctx: Context): [number, number] {
  return ctx.ui.window ?? [0, Math.max(1, ctx.run.end, ctx.other?.end ?? 0)];
}
const scaleOf = (ctx: Context, box: Box): Scale => ({ from: whole(ctx)[0], to: whole(ctx)[1], left: LEFT, right: box.width - RIGHT });

const topOf = (ctx: Context): number => HEAD + Math.min(SETTINGS, ctx.extras.comparison?.differences.length ?? 0) * SETTING + 26;

function draw(p: Painter, ctx: Context, box: Box): void {
  const { colours } = ctx;
  if (!ctx.other) return p.text(20, 40, "No second run was given: ncsim view A --compare B", { fill: colours.muted, size: 14 });
  const s = scaleOf(ctx, box);
  const top = topOf(ctx);
  timeAxis(p, s, top - 22, box.bottom, colours);
  const all = pairs(ctx);
  const first = Math.max(0, Math.floor((box.top - top) / ROW));
  const last = Math.min(all.length, Math.ceil((box.bottom - top) / ROW));
  for (let i = first; i < last; i++) paintPair(p, ctx, s, all[i], top + i * ROW, i % 2 === 0 ? box.width : 0);
  if (box.top < top) head(p, ctx, box);
}

function head(p: Painter, ctx: Context, box: Box): void {
  const { colours, extras } = ctx;
  const found = extras.comparison;
  const names = namesOf(ctx);
  const isNarrow = box.width < 640;
  (["first", "second"] as const).forEach((side, i) => {
    const makespan = runOf(ctx, side).done?.makespan;
    const y = 18 + i * 22;
    swatch(p, ctx, 16, y - 6, 22, 12, side);
    const words = `${names[i]}: ${runOf(ctx, side).status.replaceAll("_", " ")}, makespan ${makespan == null ? "–" : `${seconds(makespan)} s`}`;
    p.text(46, y, fitted(words, 0.92 * (box.width - (isNarrow ? 130 : 240)), 13), { fill: colours.ink, size: 13, bold: true });
  });
  if (found?.makespan_ratio != null) p.text(box.width - 16, 18, `${isNarrow ? "" : "second / first: "}× ${number(found.makespan_ratio, isNarrow ? 3 : 5)}`, { fill: colours.ink, size: 14, bold: true, anchor: "end" });
  p.text(box.width - 16, 40, isNarrow ? "later by" : "at the right: how much later it ended", { fill: colours.muted, size: 11, anchor: "end" });
  const differences = found?.differences ?? [];
  p.text(16, HEAD - 8, differences.length ? "What differs in the configuration:" : "The configurations are equal.", { fill: colours.muted, size: 11 });
  differences.slice(0, SETTINGS).forEach((each, i) => {
    const more = i === SETTINGS - 1 && differences.length > SETTINGS ? ` … and ${differences.length - SETTINGS} more in the table` : "";
    p.text(30, HEAD + 8 + i * SETTING, fitted(`${each.setting}: ${each.first} → ${each.second}${more}`, box.width - 60, 11), { fill: colours.ink, size: 11 });
  });
}

/** The second run is hatched: never colour alone. */
function swatch(p: Painter, ctx: Context, x: number, y: number, width: number, height: number, side: Side): void {
  const { colours } = ctx;
  p.rect(x, y, width, height, { fill: side === "first" ? colours.categories[0] : colours.categories[1] });
  if (side === "second") hatch(p, x, y, width, height, colours.paper, 7);
}

function paintPair(p: Painter, ctx: Context, s: Scale, pair: Pair, top: number, shade: number): void {
  const { colours, marks } = ctx;
  if (shade) p.rect(0, top, shade, ROW, { fill: colours.lane });
  const isMarked = (pair.kind === "task" ? marks.tasks : marks.transfers).has(pair.first);
  p.text(8, top + ROW / 2, fitted(pair.label, LEFT - 14, 11), { fill: isMarked ? colours.select : colours.ink, size: 11, bold: pair.kind === "task" });
  p.clip(s.left - 2, top, s.right - s.left + 4, ROW, () => (["first", "second"] as const).forEach((side, i) => {
    const [from, to] = spanOf(runOf(ctx, side), pair.kind, pair[side]);
    if (Number.isNaN(from)) return;
    const end = Number.isNaN(to) ? runOf(ctx, side).end : to;
    const y = top + 4 + i * 13;
    const width = Math.max(2, xOf(s, end) - xOf(s, from));
    swatch(p, ctx, xOf(s, from), y, width, 11, side);
    if (isMarked) p.rect(xOf(s, from), y, width, 11, { stroke: colours.select, width: 2 });
  }));
  const { later, ratio } = delta(ctx, pair);
  const x = s.right + 8;
  if (pair.first < 0 || pair.second < 0) return p.text(x, top + ROW / 2, `only in the ${pair.first < 0 ? "second" : "first"}`, { fill: colours.muted, size: 11 });
  const sign = later > 0 ? "▲" : later < 0 ? "▼" : "=";
  p.text(x, top + 11, `${sign} ${signed(later, (s.to - s.from) / 10)}`, { fill: later > 0 ? colours.bad : colours.ink, size: 11 });
  if (pair.kind === "transfer" && Number.isFinite(ratio)) p.text(x, top + 24, `took × ${number(ratio, 3)}`, { fill: colours.muted, size: 10 });
}

function table(ctx: Context): Table {
  const found = ctx.extras.comparison;
  if (!ctx.other || !found) return { columns: ["compare"], rows: [], note: "No second run was given: ncsim view A --compare B -o report.html" };
  const why = new Map([...found.tasks.map((each): [string, string] => [`task ${each.label}`, each.why]), ...found.transfers.map((each): [string, string] => [each.label, each.why])]);
  const settings = found.differences.map((each): Cell[] => ["setting", each.setting, each.first, each.second, null, null, null]);
  const makespan: Cell[] = ["makespan s", null, found.makespan_s[0], found.makespan_s[1], null, found.makespan_ratio, null];
  const all = pairs(ctx);
  const at = (us: number): Cell => (Number.isNaN(us) ? null : us / 1e6);
  const rows = all.map((pair): Cell[] => {
    const { later, ratio } = delta(ctx, pair);
    return [pair.kind, pair.label, at(spanOf(ctx.run, pair.kind, pair.first)[1]), at(spanOf(runOf(ctx, "second"), pair.kind, pair.second)[1]), at(later),
      Number.isFinite(ratio) ? ratio : null, why.get(pair.label) ?? null];
  });
  const offset = settings.length + 1;
  return {
    columns: ["what", "name", `${namesOf(ctx)[0]}: ends s`, `${namesOf(ctx)[1]}: ends s`, "later by s", "ratio of what it took", "why"],
    rows: [...settings, makespan, ...rows],
    pick: (row) => (row < offset || all[row - offset].first < 0 ? null : { kind: all[row - offset].kind, id: all[row - offset].first }),
  };
}

export const compare: View = {
  id: "compare", title: "Compare", key: "8",
  summary: (ctx) => (ctx.other ? `${namesOf(ctx).join(" and ")} on one time axis; ratio of makespans ${number(ctx.extras.comparison?.makespan_ratio)}` : "No second run was given: ncsim view A --compare B"),
  draw,
  overlay: (p, ctx, box) => {
    if (ctx.other && ctx.ui.event >= 0) playhead(p, scaleOf(ctx, box), ctx.ui.time, topOf(ctx) - 22, box.bottom, ctx.colours);
  },
  height: (ctx) => topOf(ctx) + pairs(ctx).length * ROW + 8,
  scale: scaleOf,
  hit(ctx, _box, _x, y) {
    const pair = ctx.other ? pairs(ctx)[Math.floor((y - topOf(ctx)) / ROW)] : undefined;
    return pair && y >= topOf(ctx) && pair.first >= 0 ? { kind: pair.kind, id: pair.first } : null;
  },
  table,
};
