/** One run on a page: its cursor, its caches, and everything that moves the playhead. */

import { Cursor } from "../data/cursor";
import type { Extras } from "../data/extras";
import { K, Run } from "../data/run";
import { Lanes } from "../draw/lanes";
import { paletteOf } from "../draw/palette";
import { MAX_SCALE, type LaneMode, type MapPart, type Selection, type Store, type Ui } from "../state";
import { marksOf } from "../views/marks";
import { exists } from "../views/names";
import type { Context } from "../views/view";

export interface Source { run: Run; other: Run | null; extras: Extras }

export const EMPTY: Source = { run: new Run(), other: null, extras: {} };

export const isDark = (ui: Ui): boolean =>
  ui.theme === "auto" ? matchMedia("(prefers-color-scheme: dark)").matches : ui.theme === "dark";

const LEAST_WINDOW_us = 10;
export const WHOLE_MAP: MapPart = { scale: 1, x: 0, y: 0 };

/** First event at which most transfers are in service: where a map has something to show. */
export function busiest(run: Run): number {
  let [now, most, at] = [0, 0, run.events - 1];
  for (let event = 0; event < run.events; event++) {
    const kind = run.evKind.data[event];
    if (kind === K.xstart) now += 1;
    if (kind === K.xend) now -= 1;
    if (kind === K.recalc && now > most) [most, at] = [now, event];
  }
  return at;
}

export class Page {
  cursor: Cursor;
  /** Grows whenever the run does. */
  version = 0;
  /** Opens the run behind a row of a study, where a server can. */
  openRow: ((row: number) => void) | null = null;
  private lanes = new Map<string, Lanes>();
  private memos = new Map<string, { on: unknown[]; value: unknown }>();

  constructor(readonly store: Store, public source: Source = EMPTY) {
    this.cursor = new Cursor(source.run);
  }

  get run(): Run { return this.source.run; }

  /** Where the time axis ends: Compare has that of the longer run. */
  get end(): number {
    const other = this.store.ui.view === "compare" ? (this.source.other?.end ?? 0) : 0;
    return Math.max(1, this.run.end, other);
  }

  /** Show another run; the playhead stays where the address says, as far as it can. */
  open(source: Source): void {
    this.source = source;
    this.cursor = new Cursor(source.run);
    this.changed();
    const { event, selection, dag } = this.store.ui;
    const start = event >= 0 ? event : source.run.isLive ? source.run.events - 1 : busiest(source.run);
    const at = Math.min(start, source.run.events - 1);
    this.store.set({
      event: at, time: at < 0 ? 0 : source.run.evTime.data[at], dag: dag < source.run.dags.length ? dag : 0,
      selection: selection && exists(source.run, selection, source.extras.study?.runs.rows.length) ? selection : null,
    });
  }

  /** The run has grown: drop what was computed from less. */
  changed(): void {
    this.version += 1;
    this.lanes.clear();
    this.memos.clear();
  }

  context(): Context {
    const { ui } = this.store;
    const { run, other, extras } = this.source;
    this.cursor.seek(ui.event);
    return {
      run, other, extras, ui, cursor: this.cursor, colours: paletteOf(isDark(ui) ? "dark" : "light"),
      window: ui.window ?? [0, Math.max(1, run.end)],
      marks: this.memo("marks", [ui.selection], () => marksOf(run, ui.selection)),
      lanesOf: (mode) => this.lanesOf(mode, ui.byLoad),
      memo: (name, on, make) => this.memo(name, on, make),
      set: (change) => this.store.set(change),
      goTo: (event) => this.goTo(event),
      select: (selection) => this.select(selection),
      openRow: this.openRow,
    };
  }

  goTo(event: number): void {
    const at = Math.max(-1, Math.min(this.run.events - 1, event));
    this.store.set({ event: at, time: at < 0 ? 0 : this.run.evTime.data[at] });
  }

  /** Put the playhead at an instant, which may lie between two events. */
  goToTime(time: number): void {
    const at = Math.max(0, Math.min(this.run.end, time));
    this.store.set({ time: at, event: this.run.eventAt(at) });
  }

  /** To the nearest event at another instant. */
  stepTime(step: 1 | -1): void {
    const { run } = this;
    const now = run.timeOf(this.store.ui.event);
    let at = this.store.ui.event + step;
    while (at >= 0 && at < run.events - 1 && run.evTime.data[at] === now) at += step;
    this.goTo(at);
  }

  /** To the next recalculation by sequence; several may share an instant. */
  stepRecalculation(step: 1 | -1): void {
    const { run } = this;
    let at = this.store.ui.event + step;
    while (at >= 0 && at < run.events && run.evKind.data[at] !== K.recalc) at += step;
    if (at >= 0 && at < run.events) this.select({ kind: "recalc", id: run.evArg.data[at] });
  }

  select(selection: Selection | null): void {
    this.store.set({ selection });
    if (selection?.kind === "recalc") this.goTo(this.run.rcEvent.data[selection.id]);
  }

  /** Stretch or narrow the window of time around an instant, by default its middle. */
  zoom(factor: number, around?: number): void {
    const [from, to] = this.store.ui.window ?? [0, this.end];
    const at = around ?? (from + to) / 2;
    this.setWindow(at - (at - from) * factor, at + (to - at) * factor);
  }

  /** Enlarge the map around a point, given as parts of its size from its middle. */
  zoomMap(factor: number, x = 0, y = 0): void {
    const now = this.store.ui.map ?? WHOLE_MAP;
    const scale = Math.min(MAX_SCALE, now.scale * factor);
    const gain = 1 / now.scale - 1 / scale;
    this.setMap({ scale, x: now.x + x * gain, y: now.y + y * gain });
  }

  /** Move the map by parts of its size. */
  panMap(from: MapPart, x: number, y: number): void {
    this.setMap({ scale: from.scale, x: from.x - x / from.scale, y: from.y - y / from.scale });
  }

  private setMap({ scale, x, y }: MapPart): void {
    const within = (each: number): number => Math.max(-0.5, Math.min(0.5, each));
    this.store.set({ map: scale <= 1 ? null : { scale, x: within(x), y: within(y) } });
  }

  pan(from: number, to: number, shift: number): void {
    const by = Math.max(-from, Math.min(this.end - to, shift));
    this.setWindow(from + by, to + by);
  }

  setWindow(from: number, to: number): void {
    const { end } = this;
    const [low, high] = [Math.max(0, from), Math.min(end, to)];
    if (high - low < LEAST_WINDOW_us) return;
    this.store.set({ window: low <= 0 && high >= end ? null : [low, high] });
  }

  private lanesOf(mode: LaneMode, byLoad: boolean): Lanes {
    const key = `${mode}${byLoad}`;
    const found = this.lanes.get(key) ?? new Lanes(this.run, mode, byLoad);
    this.lanes.set(key, found);
    return found;
  }

  private memo<T>(name: string, on: unknown[], make: () => T): T {
    const found = this.memos.get(name);
    if (found && found.on.every((each, i) => each === on[i])) return found.value as T;
    const value = make();
    this.memos.set(name, { on, value });
    return value;
  }
}
