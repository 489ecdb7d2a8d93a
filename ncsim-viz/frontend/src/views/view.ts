/** What a view is: a drawing in two layers, and a table that says the same. */

import type { Cursor } from "../data/cursor";
import type { Extras } from "../data/extras";
import type { Run } from "../data/run";
import type { Scale } from "../draw/axis";
import type { Lanes } from "../draw/lanes";
import type { Painter } from "../draw/painter";
import type { Palette } from "../draw/palette";
import type { LaneMode, Selection, Ui, ViewId } from "../state";
import type { Marks } from "./marks";

export type Cell = string | number | boolean | null;

export interface Table {
  columns: string[];
  rows: Cell[][];
  /** What a row stands for. */
  pick?: (row: number) => Selection | null;
  /** Event that a row stands for: choosing it moves the playhead there. */
  event?: (row: number) => number;
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
  /** What the selection stands for, in every view. */
  marks: Marks;
  lanesOf(mode: LaneMode): Lanes;
  /** The value of the last call under a name, if what it depends on is the same. */
  memo<T>(name: string, on: unknown[], make: () => T): T;
  set(change: Partial<Ui>): void;
  /** Put the playhead after an event. */
  goTo(event: number): void;
  select(selection: Selection | null): void;
  /** Open the run behind a row of a study; null where that cannot be. */
  openRow: ((row: number) => void) | null;
}

/** A drawing's size, and the part of its height that is seen. */
export interface Box { width: number; height: number; top: number; bottom: number }

export const boxOf = (width: number, height: number): Box => ({ width, height, top: 0, bottom: height });

export interface View {
  id: ViewId;
  title: string;
  /** Key that opens it. */
  key: string;
  /** One sentence for who cannot see the drawing. */
  summary(ctx: Context): string;
  table(ctx: Context, everything?: boolean): Table;
  /** Whether the table changes with the playhead. */
  tableFollows?: boolean;
  /** What stands still while the playhead moves; the same drawing for screen and export. */
  draw?(p: Painter, ctx: Context, box: Box): void;
  /** Whether there is nothing to draw now, only a table. */
  isTable?(ctx: Context): boolean;
  /** What moves with the playhead, above the still layer. */
  overlay?(p: Painter, ctx: Context, box: Box): void;
  /** Height that the whole drawing wants at a width, where so much room is. */
  height?(ctx: Context, width: number, room: number): number;
  /** What lies under a point. */
  hit?(ctx: Context, box: Box, x: number, y: number): Selection | null;
  /** More to say about a point than the name of what lies there. */
  tip?(ctx: Context, box: Box, x: number, y: number): string;
  /** Whether wheel, drag and + − 0 enlarge and move the drawing itself. */
  isMap?: boolean;
  /** The time axis of the drawing, if it has one: what wheel and drag move. */
  scale?(ctx: Context, box: Box): Scale;
}
