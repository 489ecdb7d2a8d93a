/** A heat map over two factors of a study. */

import { distinct, groupOf, rowOf, runWhere, type Study, type StudyCell, type StudyGroup } from "../data/study";
import { number } from "../draw/format";
import { magnitude, onMagnitude } from "../draw/palette";
import { fitted, type Painter } from "../draw/painter";
import type { Heat } from "../state";
import type { Box, Context } from "./view";

const LEFT = 170;
const TOP = 76;
const ROW = 46;
const LEGEND = 40;

export const heatHeight = (rows: number): number => TOP + rows * ROW + LEGEND;

interface Grid { group: StudyGroup; columns: StudyCell[]; rows: StudyCell[]; wide: number; cells: Map<string, number> }

const keyOf = (column: StudyCell, row: StudyCell): string => JSON.stringify([String(column), String(row)]);

function gridOf(study: Study, [x, y, measure]: Heat, box: Box): Grid {
  const group = groupOf(study, x, y, measure) as StudyGroup;
  const columns = distinct(group.table, x);
  const cells = new Map(group.table.rows.map((_, i) => {
    const row = rowOf(group.table, i);
    return [keyOf(row.get(x) ?? null, row.get(y) ?? null), i];
  }));
  return { group, columns, rows: distinct(group.table, y), wide: Math.min(180, (box.width - LEFT - 20) / Math.max(1, columns.length)), cells };
}

/** Range of the means. */
export function rangeOf(group: StudyGroup): [number, number] {
  const at = group.table.columns.indexOf("mean");
  const means = group.table.rows.map((row) => row[at]).filter((each): each is number => typeof each === "number");
  return [means.reduce((a, b) => Math.min(a, b), Infinity), means.reduce((a, b) => Math.max(a, b), -Infinity)];
}

export function paintHeat(p: Painter, ctx: Context, study: Study, heat: Heat, box: Box): void {
  const { colours } = ctx;
  const grid = gridOf(study, heat, box);
  const [low, high] = rangeOf(grid.group);
  p.text(12, 18, fitted(`Mean ${heat[2].replaceAll("_", " ")} by ${heat[0]} (across) and ${heat[1]} (down); below it the 95 % interval and the number of runs`, box.width - 24, 13), { fill: colours.ink, size: 13, bold: true });
  p.text(LEFT, 44, heat[0], { fill: colours.muted, size: 11 });
  p.text(12, TOP - 12, heat[1], { fill: colours.muted, size: 11 });
  grid.columns.forEach((value, i) => p.text(LEFT + (i + 0.5) * grid.wide, TOP - 12, fitted(String(value), grid.wide - 6), { fill: colours.ink, size: 11, anchor: "middle", bold: true }));
  grid.rows.forEach((value, j) => {
    p.text(12, TOP + (j + 0.5) * ROW, fitted(String(value), LEFT - 20, 12), { fill: colours.ink, size: 12, bold: true });
    grid.columns.forEach((column, i) => paintCell(p, ctx, grid, grid.cells.get(keyOf(column, value)), LEFT + i * grid.wide, TOP + j * ROW, [low, high]));
  });
  legend(p, ctx, TOP + grid.rows.length * ROW + 16, low, high);
}

function paintCell(p: Painter, ctx: Context, grid: Grid, index: number | undefined, x: number, y: number, [low, high]: [number, number]): void {
  const { colours } = ctx;
  const cells = index === undefined ? null : rowOf(grid.group.table, index);
  const mean = cells?.get("mean");
  if (!cells || typeof mean !== "number") {
    p.rect(x + 1, y + 1, grid.wide - 2, ROW - 2, { stroke: colours.grid });
    return p.text(x + grid.wide / 2, y + ROW / 2, "–", { fill: colours.muted, size: 12, anchor: "middle" });
  }
  const share = (mean - low) / (high - low || 1);
  p.rect(x + 1, y + 1, grid.wide - 2, ROW - 2, { fill: magnitude(share) });
  const fill = onMagnitude(share);
  p.text(x + grid.wide / 2, y + 17, fitted(number(mean), grid.wide - 4, 12), { fill, size: 12, anchor: "middle", bold: true });
  const [from, to] = [cells.get("low"), cells.get("high")];
  const interval = typeof from === "number" && typeof to === "number" ? `${number(from, 3)}–${number(to, 3)}` : "";
  p.text(x + grid.wide / 2, y + 33, fitted(`${interval} n=${String(cells.get("runs"))}`.trim(), grid.wide - 6, 10), { fill, size: 10, anchor: "middle" });
}

function legend(p: Painter, ctx: Context, y: number, low: number, high: number): void {
  const { colours } = ctx;
  if (!Number.isFinite(low)) return;
  p.text(LEFT - 8, y + 6, number(low), { fill: colours.muted, size: 11, anchor: "end" });
  for (let i = 0; i < 10; i++) p.rect(LEFT + i * 16, y, 16, 12, { fill: magnitude(i / 9) });
  p.text(LEFT + 168, y + 6, number(high), { fill: colours.muted, size: 11 });
}

/** A run of the cell under a point; -1 if there is none. */
export function heatRowAt(study: Study, heat: Heat, box: Box, x: number, y: number): number {
  const grid = gridOf(study, heat, box);
  const column = grid.columns[Math.floor((x - LEFT) / grid.wide)];
  const row = grid.rows[Math.floor((y - TOP) / ROW)];
  if (column === undefined || row === undefined) return -1;
  return runWhere(study, new Map([[heat[0], column], [heat[1], row]]));
}
