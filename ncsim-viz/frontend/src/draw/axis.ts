/** The time axis all views share. */

import { seconds, tickSeconds, ticks } from "./format";
import { widthOf, type Painter } from "./painter";
import type { Palette } from "./palette";

export interface Scale { from: number; to: number; left: number; right: number }

export const xOf = (s: Scale, time: number): number =>
  s.left + ((time - s.from) / (s.to - s.from || 1)) * (s.right - s.left);
export const timeOf = (s: Scale, x: number): number =>
  s.from + ((x - s.left) / (s.right - s.left || 1)) * (s.to - s.from);

/** Beside the playhead's time, labels of ticks are covered: half of one is worse than none. */
const HIDDEN_px = 34;

/** The playhead: a line, and its time in the axis. */
export function playhead(p: Painter, s: Scale, time: number, top: number, bottom: number, colours: Palette): void {
  const x = xOf(s, time);
  if (x < s.left || x > s.right) return;
  p.line([x, top, x, bottom], { stroke: colours.select, width: 1.5 });
  const text = `${seconds(time, (s.to - s.from) / 10)} s`;
  const width = widthOf(text, 11, true) + 8;
  const left = Math.max(s.left, Math.min(s.right - width, x - width / 2));
  p.rect(left - HIDDEN_px, top + 1, width + 2 * HIDDEN_px, 17, { fill: colours.paper });
  p.rect(left, top + 1, width, 17, { fill: colours.select });
  p.text(left + width / 2, top + 10, text, { fill: colours.paper, size: 11, anchor: "middle", bold: true });
}

/** Vertical rules and their times; y is the top of the axis, which is 22 high. */
export function timeAxis(p: Painter, s: Scale, y: number, bottom: number, colours: Palette): void {
  const width = s.right - s.left;
  const all = ticks(s.from, s.to, Math.max(2, Math.floor(width / 110)));
  const step = all.length > 1 ? all[1] - all[0] : s.to - s.from;
  for (const at of all) {
    const x = xOf(s, at);
    p.line([x, y + 18, x, bottom], { stroke: colours.grid });
    const text = `${tickSeconds(at, step)} s`;
    const room = x > s.right - 40 ? "end" : x < s.left + 20 ? "start" : "middle";
    p.text(x, y + 9, text, { fill: colours.muted, size: 11, anchor: room });
  }
}
