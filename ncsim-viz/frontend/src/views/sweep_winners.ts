/** The winner matrix and the regret bars of a study. */

import { rowOf, winnerParts, type Study, type StudyCell, type StudyTable } from "../data/study";
import { number, percent } from "../draw/format";
import { magnitude, onMagnitude } from "../draw/palette";
import { fitted, hatch, widthOf, type Painter } from "../draw/painter";
import type { Box, Context } from "./view";

export const WINNER_ROW = 24;
export const REGRET_ROW = 24;
export const REGRET_TOP = 114;
const NARROW = 800;

/** Where labels end, and what the verdict takes, for which there is no room on a narrow screen. */
const labelsOf = (box: Box): number => (box.width < NARROW ? 100 : 250);
const verdictOf = (box: Box): number => (box.width < NARROW ? 12 : 290);

export const cellWidth = (study: Study, box: Box): number =>
  Math.min(110, (box.width - labelsOf(box) - verdictOf(box)) / Math.max(1, winnerParts(study).policies.length));

/** Where the rows begin: below the names of the policies, which stand upright where cells are narrow. */
export function winnersTop(study: Study, box: Box): number {
  const longest = winnerParts(study).policies.reduce((most, name) => Math.max(most, widthOf(name, 11)), 0);
  return longest + 8 <= cellWidth(study, box) ? 60 : 44 + Math.min(150, longest);
}

const labelOf = (study: Study, row: number): string => {
  const cells = rowOf(study.winners as StudyTable, row);
  return winnerParts(study).labels.map((name) => String(cells.get(name))).join(", ");
};
const has = (winners: StudyCell | undefined, policy: string): boolean => String(winners ?? "").split("/").includes(policy);

export function paintWinners(p: Painter, ctx: Context, study: Study, box: Box): void {
  const { colours } = ctx;
  const winners = study.winners as StudyTable;
  const { labels, policies } = winnerParts(study);
  const wide = cellWidth(study, box);
  const top = winnersTop(study, box);
  const start = labelsOf(box);
  const words = `Ratio to the best ${study.roles?.policy ?? "choice"} under ${String(study.roles?.full ?? "")}; ☆ wins under ${String(study.roles?.solo ?? "")}, ★ wins under ${String(study.roles?.full ?? "")}, ◆ the winners differ`;
  p.text(12, 16, fitted(words, box.width - 24, 12), { fill: colours.ink, size: 12 });
  p.text(12, top - 12, fitted(labels.join(", "), start - 20), { fill: colours.muted, size: 11 });
  policies.forEach((name, i) => {
    const x = start + (i + 0.5) * wide;
    if (top === 60) p.text(x, top - 12, name, { fill: colours.ink, size: 11, anchor: "middle", bold: true });
    else p.shift(x, top - 6, () => p.text(0, 0, fitted(name, 150), { fill: colours.ink, size: 11, bold: true }), -90);
  });
  if (box.width >= NARROW) p.text(start + policies.length * wide + 12, top - 12, "☆ → ★, regret", { fill: colours.muted, size: 11 });
  winners.rows.forEach((_, row) => {
    const y = top + row * WINNER_ROW;
    if (y + WINNER_ROW >= box.top && y <= box.bottom) paintRow(p, ctx, study, row, y, box);
  });
}

function paintRow(p: Painter, ctx: Context, study: Study, row: number, y: number, box: Box): void {
  const { colours } = ctx;
  const wide = cellWidth(study, box);
  const start = labelsOf(box);
  const cells = rowOf(study.winners as StudyTable, row);
  const { policies } = winnerParts(study);
  p.text(12, y + 12, fitted(labelOf(study, row), start - 20, 12), { fill: colours.ink, size: 12 });
  policies.forEach((policy, i) => {
    const x = start + i * wide;
    const ratio = cells.get(policy);
    if (typeof ratio !== "number") return p.text(x + wide / 2, y + 12, "–", { fill: colours.muted, size: 11, anchor: "middle" });
    const share = Math.min(1, Math.log2(Math.max(1, ratio)) / 2);
    const marks = `${has(cells.get("solo_winners"), policy) ? "☆" : ""}${has(cells.get("full_winners"), policy) ? "★" : ""}`;
    p.rect(x + 1, y + 1, wide - 2, WINNER_ROW - 2, { fill: magnitude(1 - share), stroke: marks ? colours.ink : undefined, width: 2 });
    const text = wide > 52 ? `${marks} ${ratio.toFixed(2)}` : marks || (wide > 30 ? ratio.toFixed(1) : "");
    p.text(x + wide / 2, y + 12, text, { fill: onMagnitude(1 - share), size: 11, anchor: "middle", bold: marks !== "" });
  });
  if (box.width < NARROW) return;
  const inverted = cells.get("inversion") === true || cells.get("inversion") === 1;
  const regret = cells.get("regret");
  const verdict = `${inverted ? "◆ " : ""}${String(cells.get("solo_winners") ?? "–")} → ${String(cells.get("full_winners") ?? "–")}${typeof regret === "number" ? `, ${percent(regret)}` : ""}`;
  p.text(start + policies.length * wide + 12, y + 12, fitted(verdict, verdictOf(box) - 20, 11), { fill: inverted ? colours.bad : colours.ink, size: 11, bold: inverted });
}

/** Rows of the regret bars: largest first. */
export function byRegret(winners: StudyTable): number[] {
  const at = winners.columns.indexOf("regret");
  const regret = (row: number): number => Number(winners.rows[row][at] ?? -1);
  return winners.rows.map((_, i) => i).sort((a, b) => regret(b) - regret(a) || a - b);
}

/** Pieces of text in two lines, the second cut where it is too long. */
function lines(parts: string[], width: number): string[] {
  let many = parts.length;
  while (many > 1 && widthOf(parts.slice(0, many).join(" · "), 12) > width) many -= 1;
  const rest = parts.slice(many).join(" · ");
  return [parts.slice(0, many).join(" · "), ...(rest ? [fitted(rest, width, 12)] : [])];
}

export function paintRegret(p: Painter, ctx: Context, study: Study, box: Box): void {
  const { colours } = ctx;
  const winners = study.winners as StudyTable;
  const order = byRegret(winners);
  const regret = (row: number): number => Number(rowOf(winners, row).get("regret") ?? 0);
  const most = Math.max(1e-9, ...order.slice(0, 1).map(regret));
  p.text(12, 16, fitted(`Regret: how much longer the winner under ${String(study.roles?.solo ?? "")} takes than the winner under ${String(study.roles?.full ?? "")}`, box.width - 24, 13), { fill: colours.ink, size: 13, bold: true });
  const totals = study.totals?.rows.map((row) => `${String(row[0]).replaceAll("_", " ")} ${typeof row[1] === "number" ? number(row[1], 3) : String(row[1])}`) ?? [];
  lines(totals, box.width - 24).forEach((line, i) => p.text(12, 38 + i * 18, line, { fill: colours.ink, size: 12 }));
  p.rect(12, 78, 24, 12, { fill: colours.categories[5] });
  hatch(p, 12, 78, 24, 12, colours.paper, 6);
  p.text(42, 84, "◆ hatched: rank inversion, another policy wins", { fill: colours.ink, size: 11 });
  const [x, y] = box.width < NARROW ? [12, 94] : [342, 78];
  p.rect(x, y, 24, 12, { fill: colours.categories[0] });
  p.text(x + 30, y + 6, "plain: the same policy wins", { fill: colours.ink, size: 11 });
  const left = labelsOf(box) + 20;
  const wide = Math.max(40, box.width - left - 120);
  order.forEach((row, i) => {
    const y = REGRET_TOP + i * REGRET_ROW;
    if (y + REGRET_ROW < box.top || y > box.bottom) return;
    const inverted = rowOf(winners, row).get("inversion") === true || rowOf(winners, row).get("inversion") === 1;
    const width = Math.max(1, (wide * Math.max(0, regret(row))) / most);
    p.text(12, y + 11, fitted(`${inverted ? "◆ " : ""}${labelOf(study, row)}`, left - 20, 12), { fill: colours.ink, size: 12, bold: inverted });
    p.rect(left, y + 3, width, REGRET_ROW - 8, { fill: inverted ? colours.categories[5] : colours.categories[0] });
    if (inverted) hatch(p, left, y + 3, width, REGRET_ROW - 8, colours.paper, 7);
    p.text(left + width + 8, y + 11, percent(regret(row)), { fill: colours.ink, size: 11 });
  });
}
