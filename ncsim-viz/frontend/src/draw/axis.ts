/** The time axis all views share. */

import { seconds, ticks } from "./format";
import type { Painter } from "./painter";
import type { Palette } from "./palette";

export interface Scale { from: number; to: number; left: number; right: number }

export const xOf = (s: Scale, time: number): number =>
  s.left + ((time - s.from) / (s.to - s.from || 1)) * (s.right - s.left);
export const timeOf = (s: Scale, x: number): number =>
  s.from + ((x - s.left) / (s.right - s.left || 1)) * (s.to - s.from);

/** Vertical rules and their times; y is the top of the axis, which is 22 high. */
export function timeAxis(p: Painter, s: Scale, y: number, bottom: number, colours: Palette): void {
  const width = s.right - s.left;
  for (const at of ticks(s.from, s.to, Math.max(2, Math.floor(width / 110)))) {
    const x = xOf(s, at);
    p.line([x, y + 18, x, bottom], { stroke: colours.grid });
    const text = `${seconds(at, (s.to - s.from) / 10)} s`;
    const room = x > s.right - 40 ? "end" : x < s.left + 20 ? "start" : "middle";
    p.text(x, y + 9, text, { fill: colours.muted, size: 11, anchor: room });
  }
}
