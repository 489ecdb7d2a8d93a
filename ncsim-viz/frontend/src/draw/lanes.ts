/** Intervals of a run in lanes, sorted, with what is needed to draw and to hit them quickly. */

import { f64, i32, u8, lowerBound, upperBound, type F64, type I32, type U8 } from "../data/columns";
import type { Run } from "../data/run";
import type { LaneMode } from "../state";

export const BINS = 16384;
export const MANY = 20000;
const MAX_PYRAMID_LANES = 2000;

export interface Lane {
  label: string;
  /** Node, link, DAG or transfer that the lane belongs to. */
  owner: number;
  isTasks: boolean;
  /** First of its group: where the label stands. */
  isFirst: boolean;
  /** Range in the columns of intervals. */
  from: number;
  to: number;
}

/** Busy share and dominant colour of a lane per bin; a coarser level has a quarter of the bins. */
export interface Level { bins: number; busy: Uint8Array; colour: Uint8Array }

/** Sublanes of a group: many where few intervals are to be told apart, few where pixels are drawn anyway. */
const MAX_SUBLANES = { few: 40, many: 4 };

export class Lanes {
  readonly lanes: Lane[] = [];
  readonly start: F64 = f64();
  readonly end: F64 = f64();
  /** Greatest end of this and all earlier intervals of the lane: bounds a search backwards. */
  readonly reach: F64 = f64();
  /** Task or transfer. */
  readonly id: I32 = i32();
  /** DAG number: the category. */
  readonly category: U8 = u8();
  private levels: Level[] | null = null;
  private readonly shades: Uint8Array;

  constructor(private readonly run: Run, readonly mode: LaneMode, byLoad: boolean) {
    const groups = this.groups();
    if (byLoad) {
      const loads = new Map<number, number>();
      for (const { owner, spans } of groups) loads.set(owner, spans.reduce((sum, each) => sum + each.to - each.from, loads.get(owner) ?? 0));
      groups.sort((a, b) => (loads.get(b.owner) as number) - (loads.get(a.owner) as number)); // stable: an owner's tasks and transfers stay together
    }
    for (const group of groups) this.place(group);
    let shade = 0;
    this.shades = Uint8Array.from(this.lanes, (lane, i) => {
      if (i === 0 || lane.owner !== this.lanes[i - 1].owner) shade = 1 - shade;
      return shade;
    });
  }

  get intervals(): number { return this.start.length; }

  /** Whether a lane's ground is shaded, so that groups are told apart. */
  shaded(index: number): boolean { return this.shades[index] === 1; }

  /** Intervals of a lane that touch a window: `[first, last)` of which some may end before it. */
  range(lane: Lane, from: number, to: number): [number, number] {
    const first = upperBound(this.reach.data, lane.to, from, lane.from);
    return [first, lowerBound(this.start.data, lane.to, to, first)];
  }

  /** Interval under an instant, the last begun first; -1 if there is none. */
  hit(lane: Lane, time: number, slack = 0): number {
    const { start, end, reach } = this;
    for (let i = upperBound(start.data, lane.to, time + slack, lane.from) - 1; i >= lane.from; i--) {
      if (reach.data[i] < time - slack) break;
      if (start.data[i] <= time + slack && end.data[i] >= time - slack) return i;
    }
    return -1;
  }

  /** Intervals that touch a window in some lanes, counted up to a limit. */
  countIn(lanes: Lane[], from: number, to: number, limit: number): number {
    let total = 0;
    for (const lane of lanes) {
      const [first, last] = this.range(lane, from, to);
      total += last - first;
      if (total > limit) break;
    }
    return total;
  }

  /** The mip pyramid, built once; none for so many lanes that it would be large and each is short anyway. */
  level(wantedBins: number): Level | null {
    if (this.lanes.length > MAX_PYRAMID_LANES) return null;
    this.levels ??= this.buildLevels();
    let best = this.levels[0];
    for (const level of this.levels) if (level.bins >= wantedBins) best = level;
    return best;
  }

  private buildLevels(): Level[] {
    const { lanes, start, end, category } = this;
    const bins = lanes.length > 600 ? BINS / 2 : BINS;
    const span = Math.max(1, this.run.end);
    const busy = new Uint8Array(lanes.length * bins);
    const colour = new Uint8Array(lanes.length * bins);
    const width = span / bins;
    const most = new Float32Array(bins);
    lanes.forEach((lane, row) => {
      most.fill(0);
      const sum = new Float32Array(bins);
      const base = row * bins;
      for (let i = lane.from; i < lane.to; i++) {
        const first = Math.min(bins - 1, Math.floor(start.data[i] / width));
        const last = Math.min(bins - 1, Math.floor(end.data[i] / width));
        for (let bin = first; bin <= last; bin++) {
          const part = Math.min(end.data[i], (bin + 1) * width) - Math.max(start.data[i], bin * width);
          sum[bin] += Math.max(part, width / 512);
          if (part >= most[bin]) {
            most[bin] = part;
            colour[base + bin] = category.data[i];
          }
        }
      }
      for (let bin = 0; bin < bins; bin++) {
        busy[base + bin] = sum[bin] > 0 ? Math.max(1, Math.min(255, Math.round((sum[bin] / width) * 255))) : 0;
      }
    });
    const levels: Level[] = [{ bins, busy, colour }];
    while (levels[levels.length - 1].bins > 1024) levels.push(this.coarser(levels[levels.length - 1]));
    return levels;
  }

  private coarser(fine: Level): Level {
    const bins = fine.bins / 4;
    const busy = new Uint8Array(this.lanes.length * bins);
    const colour = new Uint8Array(this.lanes.length * bins);
    for (let at = 0; at < busy.length; at++) {
      let sum = 0;
      let top = 0;
      for (let k = at * 4; k < at * 4 + 4; k++) {
        sum += fine.busy[k];
        if (fine.busy[k] > top) {
          top = fine.busy[k];
          colour[at] = fine.colour[k];
        }
      }
      busy[at] = sum > 0 ? Math.max(1, sum >> 2) : 0;
    }
    return { bins, busy, colour };
  }

  private groups(): Group[] {
    const { run } = this;
    switch (this.mode) {
      case "transfer": return this.transferGroups();
      case "link": {
        const groups = run.links.map((link, i): Group => ({ label: link.id, owner: i, isTasks: false, spans: [] }));
        for (const span of this.transferSpans()) for (const link of run.routeOf(span.id)) groups[link].spans.push(span);
        return groups.filter((group) => group.spans.length > 0);
      }
      case "dag": return this.paired(run.dags.length, (i) => run.dags[i].id, run.tkDag.data, (x) => run.exDag.data[x]);
      case "node":
        return this.paired(run.nodes.length, (i) => run.nodes[i].id, run.tkNode.data,
          (x) => run.tkNode.data[run.exSource.data[x]]);
    }
  }

  private transferGroups(): Group[] {
    return this.transferSpans().map((span) => (
      { label: this.run.transferName(span.id), owner: span.id, isTasks: false, spans: [span] }));
  }

  /** Tasks and below them transfers, for each of some owners. */
  private paired(
    owners: number, label: (owner: number) => string, ofTask: ArrayLike<number>, ofTransfer: (x: number) => number,
  ): Group[] {
    const groups: Group[] = [];
    for (let i = 0; i < owners; i++) {
      groups.push({ label: label(i), owner: i, isTasks: true, spans: [] });
      groups.push({ label: "", owner: i, isTasks: false, spans: [] });
    }
    const { run } = this;
    for (let task = 0; task < run.tasks; task++) {
      const from = run.startedAt(task);
      if (Number.isNaN(from)) continue;
      const to = run.endedAt(task);
      groups[ofTask[task] * 2].spans.push({ id: task, from, to: Number.isNaN(to) ? run.end : to });
    }
    for (const span of this.transferSpans()) groups[ofTransfer(span.id) * 2 + 1].spans.push(span);
    // Who is idle throughout is left out; a lane without tasks stays to carry the name.
    return groups.filter((group, i) => group.spans.length > 0 || (group.isTasks && groups[i + 1].spans.length > 0));
  }

  private transferSpans(): Span[] {
    const { run } = this;
    const spans: Span[] = [];
    for (let x = 0; x < run.transfers; x++) {
      const from = run.servedFrom(x);
      if (Number.isNaN(from)) continue;
      const to = run.servedTo(x);
      spans.push({ id: x, from, to: Number.isNaN(to) ? run.end : to });
    }
    return spans;
  }

  /** Spread a group over sublanes in which nothing overlaps, as far as there are enough. */
  private place(group: Group): void {
    const most = this.run.transfers > MANY ? MAX_SUBLANES.many : MAX_SUBLANES.few;
    group.spans.sort((a, b) => a.from - b.from || a.to - b.to);
    const rows: Span[][] = [[]];
    const ends: number[] = [-1];
    for (const span of group.spans) {
      let row = ends.findIndex((end) => end <= span.from);
      if (row < 0) {
        if (rows.length < most) row = rows.push([]) - 1;
        else row = rows.length - 1;
      }
      rows[row].push(span);
      ends[row] = Math.max(ends[row] ?? -1, span.to);
    }
    rows.forEach((row, i) => this.addLane(group, row, i === 0));
  }

  private addLane(group: Group, spans: Span[], isFirst: boolean): void {
    const from = this.start.length;
    const categories = group.isTasks ? this.run.tkDag.data : this.run.exDag.data;
    let reach = -Infinity;
    for (const span of spans) {
      this.start.push(span.from);
      this.end.push(span.to);
      reach = Math.max(reach, span.to);
      this.reach.push(reach);
      this.id.push(span.id);
      this.category.push(categories[span.id] & 255);
    }
    this.lanes.push({
      label: isFirst ? group.label : "", owner: group.owner, isTasks: group.isTasks, isFirst, from, to: this.start.length,
    });
  }
}

interface Span { id: number; from: number; to: number }
interface Group { label: string; owner: number; isTasks: boolean; spans: Span[] }
