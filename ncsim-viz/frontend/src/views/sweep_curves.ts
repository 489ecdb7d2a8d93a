/** Means over one factor, a line for each value of another; with their 95 % intervals. */

import { distinct, groupOf, rowOf, type Study, type StudyCell, type StudyGroup } from "../data/study";
import { number, ticks } from "../draw/format";
import { fitted, widthOf, type Painter } from "../draw/painter";
import type { Heat } from "../state";
import type { Box, Context } from "./view";

const LEFT = 70;
const TOP = 70;
const BELOW = 60;
const DASHES = [[], [7, 4], [2, 3], [10, 3, 2, 3]];

interface Point { mean: number; low: number; high: number }
interface Frame { x: (i: number) => number; y: (value: number) => number; floor: number; right: number }

const numeric = (cell: StudyCell | undefined, otherwise: number): number => (typeof cell === "number" ? cell : otherwise);

function pointsOf(group: StudyGroup, across: string, line: string): Map<string, Point> {
  const found = new Map<string, Point>();
  group.table.rows.forEach((_, i) => {
    const row = rowOf(group.table, i);
    const mean = row.get("mean");
    if (typeof mean !== "number") return;
    found.set(JSON.stringify([String(row.get(across)), String(row.get(line))]), { mean, low: numeric(row.get("low"), mean), high: numeric(row.get("high"), mean) });
  });
  return found;
}

export function paintCurves(p: Painter, ctx: Context, study: Study, [across, line, measure]: Heat, box: Box): void {
  const { colours } = ctx;
  const group = groupOf(study, across, line, measure) as StudyGroup;
  const points = pointsOf(group, across, line);
  const columns = distinct(group.table, across);
  const lines = distinct(group.table, line);
  const top = [...points.values()].reduce((most, each) => Math.max(most, each.high), 1e-9);
  const frame: Frame = {
    x: (i) => LEFT + ((i + 0.5) / columns.length) * (box.width - LEFT - 30),
    y: (value) => box.height - BELOW - (value / top) * (box.height - BELOW - TOP), floor: box.height - BELOW, right: box.width - 30,
  };
  p.text(12, 18, fitted(`Mean ${measure.replaceAll("_", " ")} over ${across}, a line for each ${line}; bars are 95 % intervals`, box.width - 24, 13), { fill: colours.ink, size: 13, bold: true });
  for (const value of ticks(0, top, 6)) {
    p.line([LEFT, frame.y(value), frame.right, frame.y(value)], { stroke: colours.grid });
    p.text(LEFT - 8, frame.y(value), number(value), { fill: colours.muted, size: 11, anchor: "end" });
  }
  const room = (box.width - LEFT) / columns.length - 8;
  columns.forEach((value, i) => p.text(frame.x(i), frame.floor + 16, fitted(String(value), Math.max(24, room)), { fill: colours.ink, size: 11, anchor: "middle" }));
  p.text((LEFT + frame.right) / 2, frame.floor + 38, across, { fill: colours.muted, size: 12, anchor: "middle" });
  let x = LEFT;
  lines.forEach((value, k) => {
    const found = columns.map((column, i): [number, Point | undefined] => [i, points.get(JSON.stringify([String(column), String(value)]))]);
    paintLine(p, ctx, frame, found.filter((each): each is [number, Point] => each[1] !== undefined), k, lines.length);
    symbol(p, x + 6, 46, k, colours.categories[k % 8], colours.ink);
    p.text(x + 18, 46, String(value), { fill: colours.ink, size: 12 });
    x += 40 + widthOf(String(value), 12);
  });
}

function paintLine(p: Painter, ctx: Context, frame: Frame, points: [number, Point][], k: number, lines: number): void {
  const { colours } = ctx;
  const stroke = colours.categories[k % 8];
  const aside = (k - (lines - 1) / 2) * 3;
  p.line(points.flatMap(([i, each]) => [frame.x(i) + aside, frame.y(each.mean)]), { stroke, width: 2, dash: DASHES[Math.floor(k / 2) % DASHES.length] });
  for (const [i, each] of points) {
    const x = frame.x(i) + aside;
    p.line([x, frame.y(each.low), x, frame.y(each.high)], { stroke: colours.ink });
    symbol(p, x, frame.y(each.mean), k, stroke, colours.ink);
  }
}

/** A shape per line: never colour alone. */
function symbol(p: Painter, x: number, y: number, k: number, fill: string, stroke: string): void {
  if (k % 4 === 0) p.circle(x, y, 5, { fill, stroke });
  else if (k % 4 === 1) p.rect(x - 5, y - 5, 10, 10, { fill, stroke });
  else if (k % 4 === 2) p.area([x, y - 6, x + 6, y + 5, x - 6, y + 5], { fill, stroke });
  else p.area([x, y - 6, x + 6, y, x, y + 6, x - 6, y], { fill, stroke });
}
