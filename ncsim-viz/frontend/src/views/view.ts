/** What a view is: a drawing, a table that says the same, and a screen. */

import type { Cursor } from "../data/cursor";
import type { Extras } from "../data/load";
import type { Run } from "../data/run";
import type { Scale } from "../draw/axis";
import type { Lanes } from "../draw/lanes";
import type { Painter } from "../draw/painter";
import type { Palette } from "../draw/palette";
import type { LaneMode, Selection, Ui, ViewId } from "../state";

export type Cell = string | number | null;

export interface Table {
  columns: string[];
  rows: Cell[][];
  /** What a row stands for. */
  pick?: (row: number) => Selection | null;
  /** What the table leaves out, said; nothing is cut silently. */
  note?: string;
}

export interface Context {
  run: Run;
  other: Run | null;
  extras: Extras;
  ui: Ui;
  colours: Palette;
  cursor: Cursor;
  window: [number, number];
  lanesOf(mode: LaneMode): Lanes;
  set(change: Partial<Ui>): void;
  /** Put the playhead after an event. */
  goTo(event: number): void;
  select(selection: Selection | null): void;
}

export interface Box { width: number; height: number }

export interface View {
  id: ViewId;
  title: string;
  /** One sentence for who cannot see the drawing. */
  summary(ctx: Context): string;
  table(ctx: Context): Table;
  /** The same drawing for screen and export. */
  draw?(p: Painter, ctx: Context, box: Box): void;
  /** Height that the whole drawing wants at a width. */
  height?(ctx: Context, width: number): number;
  /** What lies under a point. */
  hit?(ctx: Context, box: Box, x: number, y: number): Selection | null;
  /** The time axis of the drawing, if it has one: what wheel and drag move. */
  scale?(ctx: Context, box: Box): Scale;
}
