/** A run as typed columns, filled record by record; sequence number = line number of the trace. */

import { f64, i32, u8, upperBound, type F64, type I32, type U8 } from "./columns";
import type { TraceHeader, TraceRecord } from "./trace_types";

export const KINDS = [
  "inject", "place", "ready", "start", "end", "xstart", "recalc", "xend", "note", "done",
] as const;
export type Kind = (typeof KINDS)[number];
export const K = Object.fromEntries(KINDS.map((kind, code) => [kind, code])) as Record<Kind, number>;

export interface NodeRow { id: string; capacity: number; x: number | null; y: number | null }
export interface LinkRow {
  id: string; source: number; target: number; bandwidth: number; latency: number; medium: string;
}
export interface DagRow {
  id: string; at: number; firstTask: number; tasks: number; firstEdge: number; edges: number;
}
export interface NoteRow { namespace: string; data: unknown }
export interface DoneRow {
  status: string; makespan: number | null; events: number; detail: string; counts: Record<string, number>;
}

const COLUMNS = {
  evTime: f64, evKind: u8, evArg: i32, evLine: i32,
  tkDag: i32, tkCost: f64, tkNode: i32, tkReady: i32, tkStart: i32, tkEnd: i32,
  exDag: i32, exSource: i32, exTarget: i32, exSize: f64, exStart: i32, exEnd: i32,
  exLast: i32, exRoute: i32, exHops: i32, route: i32,
  rcEvent: i32, rcBy: i32, rcIsStart: u8, rcFirst: i32,
  stTransfer: i32, stRate: f64, stLink: i32, stContenders: i32, stHidden: i32, stFactor: f64,
  stFlows: i32, stPrevious: i32, stRecalc: i32,
};
type ColumnName = keyof typeof COLUMNS;

/** What a Worker posts: filled parts of columns, names and rows. */
export interface Packed {
  header: TraceHeader | null;
  columns: Record<string, ArrayLike<number>>;
  taskIds: string[];
  dags: DagRow[];
  notes: NoteRow[];
  done: DoneRow | null;
  lines: number;
  ignored: number;
}

/**
 * Columns by prefix: `ev` events, `tk` tasks, `ex` dependencies (a transfer has the number of its
 * dependency), `rc` recalculations, `st` steps of rates. Instants are microseconds; an entry that
 * points to an event is -1 until it has happened.
 */
export class Run {
  header: TraceHeader | null = null;
  nodes: NodeRow[] = [];
  links: LinkRow[] = [];
  dags: DagRow[] = [];
  taskIds: string[] = [];
  notes: NoteRow[] = [];
  done: DoneRow | null = null;
  lines = 0;
  /** Records of kinds that this reader does not know. */
  ignored = 0;
  /** Whether records may still follow. */
  isLive = false;

  evTime!: F64; evKind!: U8; evArg!: I32; evLine!: I32;
  tkDag!: I32; tkCost!: F64; tkNode!: I32; tkReady!: I32; tkStart!: I32; tkEnd!: I32;
  exDag!: I32; exSource!: I32; exTarget!: I32; exSize!: F64; exStart!: I32; exEnd!: I32;
  exLast!: I32; exRoute!: I32; exHops!: I32; route!: I32;
  rcEvent!: I32; rcBy!: I32; rcIsStart!: U8; rcFirst!: I32;
  stTransfer!: I32; stRate!: F64; stLink!: I32; stContenders!: I32; stHidden!: I32; stFactor!: F64;
  stFlows!: I32; stPrevious!: I32; stRecalc!: I32;

  constructor() {
    for (const name of Object.keys(COLUMNS) as ColumnName[]) {
      (this as Record<string, unknown>)[name] = COLUMNS[name]();
    }
  }

  get events(): number { return this.evTime.length; }
  get tasks(): number { return this.taskIds.length; }
  get transfers(): number { return this.exSize.length; }
  get recalcs(): number { return this.rcEvent.length; }
  get steps(): number { return this.stRate.length; }

  /** Time of the last event so far. */
  get end(): number { return this.events ? this.evTime.data[this.events - 1] : 0; }
  get status(): string { return this.done ? this.done.status : "truncated"; }

  timeOf(event: number): number { return event < 0 ? NaN : this.evTime.data[event]; }
  readyAt(task: number): number { return this.timeOf(this.tkReady.data[task]); }
  startedAt(task: number): number { return this.timeOf(this.tkStart.data[task]); }
  endedAt(task: number): number { return this.timeOf(this.tkEnd.data[task]); }
  createdAt(transfer: number): number { return this.endedAt(this.exSource.data[transfer]); }
  servedFrom(transfer: number): number { return this.timeOf(this.exStart.data[transfer]); }
  servedTo(transfer: number): number { return this.timeOf(this.exEnd.data[transfer]); }

  /** When its data is at the node of the waiting task: NaN until then. */
  arrivedAt(transfer: number): number { return this.isLocal(transfer) ? this.createdAt(transfer) : this.servedTo(transfer); }

  /** Last event at or before an instant; -1 before the first. */
  eventAt(time: number): number { return upperBound(this.evTime.data, this.events, time) - 1; }

  isLocal(transfer: number): boolean {
    return this.tkNode.data[this.exSource.data[transfer]] === this.tkNode.data[this.exTarget.data[transfer]];
  }

  routeOf(transfer: number): Int32Array {
    const from = this.exRoute.data[transfer];
    return from < 0 ? new Int32Array(0) : this.route.data.subarray(from, from + this.exHops.data[transfer]);
  }

  /** Least clean bandwidth on the route, MB/s: the rate that a transfer has alone. */
  soloRate(transfer: number): number {
    let least = Infinity;
    for (const link of this.routeOf(transfer)) least = Math.min(least, this.links[link].bandwidth);
    return least === Infinity ? 0 : least;
  }

  /** Steps of a transfer in order of time. */
  stepsOf(transfer: number): number[] {
    const steps: number[] = [];
    for (let step = this.exLast.data[transfer]; step >= 0; step = this.stPrevious.data[step]) steps.push(step);
    return steps.reverse();
  }

  stepTime(step: number): number { return this.timeOf(this.rcEvent.data[this.stRecalc.data[step]]); }
  stepEvent(step: number): number { return this.rcEvent.data[this.stRecalc.data[step]]; }

  /** Steps of a recalculation: from `rcFirst` up to the next one's. */
  stepRange(recalc: number): [number, number] {
    const next = recalc + 1 < this.recalcs ? this.rcFirst.data[recalc + 1] : this.steps;
    return [this.rcFirst.data[recalc], next];
  }

  /** MB served until an instant, from the recorded rates. */
  servedBy(transfer: number, time: number): number {
    let total = 0;
    let until = Math.min(time, this.servedTo(transfer) || time);
    if (Number.isNaN(until)) until = time;
    for (let step = this.exLast.data[transfer]; step >= 0; step = this.stPrevious.data[step]) {
      const from = this.stepTime(step);
      if (from < until) {
        total += (this.stRate.data[step] * (until - from)) / 1e6;
        until = from;
      }
    }
    return total;
  }

  taskName(task: number): string {
    const id = this.taskIds[task] ?? `task ${task}`;
    return this.dags.length > 1 ? `${this.dags[this.tkDag.data[task]]?.id}/${id}` : id;
  }

  transferName(transfer: number): string {
    return `${this.taskName(this.exSource.data[transfer])} → ${this.taskIds[this.exTarget.data[transfer]]}`;
  }

  /** Take in one line of a trace. */
  add(entry: TraceRecord | TraceHeader): void {
    this.lines += 1;
    if (this.header === null) return this.begin(entry as TraceHeader);
    const record = entry as TraceRecord;
    const code = K[record.k];
    if (code === undefined) {
      this.ignored += 1;
      return;
    }
    const event = this.events;
    const argument = this.enter(record, event);
    this.evTime.push(record.t);
    this.evKind.push(code);
    this.evArg.push(argument);
    this.evLine.push(this.lines);
  }

  private begin(header: TraceHeader): void {
    if (header.format !== "ncsim-trace") throw new Error("this is no ncsim trace: its first line names no such format");
    if (!String(header.version).startsWith("1.")) {
      throw new Error(`version ${String(header.version)} of the trace format cannot be read, only 1.x`);
    }
    this.header = header;
    this.nodes = header.nodes.map(([id, capacity, x, y]) => ({ id, capacity, x, y }));
    this.links = header.links.map(([id, source, target, bandwidth, latency, medium]) => (
      { id, source, target, bandwidth, latency, medium }));
  }

  private enter(record: TraceRecord, event: number): number {
    switch (record.k) {
      case "inject": return this.inject(record);
      case "place": {
        const dag = this.dags[record.d];
        record.n.forEach((node, i) => { this.tkNode.data[dag.firstTask + i] = node; });
        return record.d;
      }
      case "ready": this.tkReady.data[record.i] = event; return record.i;
      case "start": this.tkStart.data[record.i] = event; return record.i;
      case "end": this.tkEnd.data[record.i] = event; return record.i;
      case "xstart":
        this.exStart.data[record.x] = event;
        this.exRoute.data[record.x] = this.route.length;
        this.exHops.data[record.x] = record.route.length;
        for (const link of record.route) this.route.push(link);
        return record.x;
      case "xend": this.exEnd.data[record.x] = event; return record.x;
      case "recalc": return this.recalc(record, event);
      case "note": return this.notes.push({ namespace: record.ns, data: record.data }) - 1;
      case "done":
        this.done = {
          status: record.status, makespan: record.makespan_us, events: record.events,
          detail: record.detail, counts: record.counts,
        };
        return 0;
    }
  }

  private inject(record: Extract<TraceRecord, { k: "inject" }>): number {
    this.dags[record.d] = {
      id: record.dag, at: record.t, firstTask: record.i0, tasks: record.tasks.length,
      firstEdge: record.x0, edges: record.edges.length,
    };
    for (const [id, cost] of record.tasks) {
      this.taskIds.push(id);
      this.tkDag.push(record.d);
      this.tkCost.push(cost);
      for (const column of [this.tkNode, this.tkReady, this.tkStart, this.tkEnd]) column.push(-1);
    }
    for (const [source, target, size] of record.edges) {
      this.exDag.push(record.d);
      this.exSource.push(source);
      this.exTarget.push(target);
      this.exSize.push(size);
      for (const column of [this.exStart, this.exEnd, this.exLast, this.exRoute]) column.push(-1);
      this.exHops.push(0);
    }
    return record.d;
  }

  private recalc(record: Extract<TraceRecord, { k: "recalc" }>, event: number): number {
    const recalc = this.rcEvent.push(event);
    this.rcBy.push(record.by[1]);
    this.rcIsStart.push(record.by[0] === "s" ? 1 : 0);
    this.rcFirst.push(this.steps);
    for (let i = 0; i < record.x.length; i++) {
      const transfer = record.x[i];
      this.stTransfer.push(transfer);
      this.stRate.push(record.r[i]);
      this.stLink.push(record.l[i]);
      this.stContenders.push(record.nc[i]);
      this.stHidden.push(record.nh[i]);
      this.stFactor.push(record.fh[i]);
      this.stFlows.push(record.f[i]);
      this.stPrevious.push(this.exLast.data[transfer]);
      this.exLast.data[transfer] = this.stRecalc.push(recalc);
    }
    return recalc;
  }

  pack(): Packed {
    const columns: Record<string, ArrayLike<number>> = {};
    for (const name of Object.keys(COLUMNS) as ColumnName[]) columns[name] = this[name].view().slice();
    const { header, taskIds, dags, notes, done, lines, ignored } = this;
    return { header, columns, taskIds, dags, notes, done, lines, ignored };
  }

  static unpack(packed: Packed): Run {
    const run = new Run();
    if (packed.header) run.begin(packed.header);
    for (const name of Object.keys(COLUMNS) as ColumnName[]) {
      const column = run[name];
      column.data = packed.columns[name] as never;
      column.length = packed.columns[name].length;
    }
    const { taskIds, dags, notes, done, lines, ignored } = packed;
    Object.assign(run, { taskIds, dags, notes, done, lines, ignored });
    return run;
  }
}
