/** A study: who wins where, what a wrong choice costs, and how means depend on factors. */

import { distinct, groupOf, rowOf, runWhere, type Study, type StudyTable } from "../data/study";
import type { Painter } from "../draw/painter";
import type { Heat } from "../state";
import { paintCurves } from "./sweep_curves";
import { heatHeight, heatRowAt, paintHeat } from "./sweep_heat";
import { byRegret, paintRegret, paintWinners, REGRET_ROW, REGRET_TOP, WINNER_ROW, winnersTop } from "./sweep_winners";
import type { Box, Context, Table, View } from "./view";

export type SheetId = "winners" | "regret" | "heat" | "curves" | "runs";
const SHEETS: [SheetId, string][] = [["winners", "Winners"], ["regret", "Regret"], ["heat", "Heat map"], ["curves", "Curves"], ["runs", "Runs"]];

/** Parts that a study has. */
export function sheetsOf(study: Study): [SheetId, string][] {
  const hasPairs = study.groups.some((each) => each.by.length === 2);
  const has: Record<SheetId, boolean> = { winners: !!study.winners, regret: !!study.winners, heat: hasPairs, curves: hasPairs, runs: true };
  return SHEETS.filter(([id]) => has[id]);
}

export const sheetOf = (ctx: Context): SheetId => {
  const sheets = sheetsOf(ctx.extras.study as Study);
  return (sheets[ctx.ui.sheet] ?? sheets[0])[0];
};

/** Factors and measure of maps and curves: the chosen ones if the study has them, else the first it has. */
export function heatOf(study: Study, wanted: Heat | null): Heat | null {
  if (wanted && groupOf(study, ...wanted)) return wanted;
  const mode = study.roles?.mode;
  const pairs = study.groups.filter((each) => each.by.length === 2);
  const found = pairs.find((each) => each.by.includes(mode ?? "")) ?? pairs[0];
  if (!found) return null;
  const [a, b] = found.by;
  return a === mode ? [b, a, found.measure] : [a, b, found.measure];
}

function draw(p: Painter, ctx: Context, box: Box): void {
  const study = ctx.extras.study as Study;
  const heat = heatOf(study, ctx.ui.heat);
  switch (sheetOf(ctx)) {
    case "winners": return paintWinners(p, ctx, study, box);
    case "regret": return paintRegret(p, ctx, study, box);
    case "heat": return heat ? paintHeat(p, ctx, study, heat, box) : undefined;
    case "curves": return heat ? paintCurves(p, ctx, study, heat, box) : undefined;
    case "runs": return;
  }
}

/** Run behind a row of the winners' table: the full mode's winner, the first of a tie. */
function runOfWinner(study: Study, row: number): number {
  if (!study.winners || !study.roles || !study.winners.rows[row]) return -1;
  const cells = rowOf(study.winners, row);
  const wanted = new Map([...cells].filter(([name]) => study.factors.some((factor) => factor.name === name) || name === "seed"));
  wanted.set(study.roles.policy, String(cells.get("full_winners") ?? "").split("/")[0]);
  wanted.set(study.roles.mode, study.roles.full);
  return runWhere(study, wanted);
}

function rowAt(ctx: Context, box: Box, x: number, y: number): number {
  const study = ctx.extras.study as Study;
  const heat = heatOf(study, ctx.ui.heat);
  switch (sheetOf(ctx)) {
    case "winners": return runOfWinner(study, Math.floor((y - winnersTop(study, box)) / WINNER_ROW));
    case "regret": return runOfWinner(study, byRegret(study.winners as StudyTable)[Math.floor((y - REGRET_TOP) / REGRET_ROW)] ?? -1);
    case "heat": return heat ? heatRowAt(study, heat, box, x, y) : -1;
    default: return -1;
  }
}

/** The table twin of a part. */
function table(ctx: Context): Table {
  const { study } = ctx.extras;
  if (!study) return { columns: ["study"], rows: [] };
  const sheet = sheetOf(ctx);
  const pick = (found: number): { kind: "row"; id: number } | null => (found < 0 ? null : { kind: "row", id: found });
  const note = study.note || undefined;
  if (sheet === "runs") return { columns: study.runs.columns, rows: study.runs.rows, pick: (row) => pick(row), note };
  if (sheet === "winners" || sheet === "regret") {
    const winners = study.winners as StudyTable;
    const order = sheet === "regret" ? byRegret(winners) : winners.rows.map((_, i) => i);
    return { columns: winners.columns, rows: order.map((i) => winners.rows[i]), pick: (row) => pick(runOfWinner(study, order[row])), note };
  }
  const heat = heatOf(study, ctx.ui.heat);
  const group = heat ? groupOf(study, ...heat) : undefined;
  if (!group) return { columns: ["study"], rows: [], note };
  return { columns: group.table.columns, rows: group.table.rows, note,
    pick: (row) => pick(runWhere(study, new Map(group.by.map((name) => [name, rowOf(group.table, row).get(name) ?? null])))) };
}

export const sweep: View = {
  id: "sweep", title: "Study", key: "s",
  summary: (ctx) => `Study ${ctx.extras.study?.name ?? ""}: ${ctx.extras.study?.runs.rows.length ?? 0} runs over ${ctx.extras.study?.factors.map((each) => each.name).join(", ") ?? ""}`,
  draw,
  isTable: (ctx) => sheetOf(ctx) === "runs",
  height(ctx, width, room) {
    const study = ctx.extras.study as Study;
    const rows = study.winners?.rows.length ?? 0;
    const heat = heatOf(study, ctx.ui.heat);
    switch (sheetOf(ctx)) {
      case "winners": return winnersTop(study, { width, height: room, top: 0, bottom: room }) + rows * WINNER_ROW + 40;
      case "regret": return REGRET_TOP + rows * REGRET_ROW + 20;
      case "heat": return heat ? heatHeight(distinct((groupOf(study, ...heat) as { table: StudyTable }).table, heat[1]).length) : room;
      default: return Math.min(room, 560);
    }
  },
  hit(ctx, box, x, y) {
    const found = ctx.extras.study ? rowAt(ctx, box, x, y) : -1;
    return found < 0 ? null : { kind: "row", id: found };
  },
  table,
};
