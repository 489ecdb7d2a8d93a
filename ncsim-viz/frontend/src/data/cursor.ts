/** The state of a run after any record: nearest checkpoint, then forward; never from the start. */

import { K, type Run } from "./run";

export const SPACING = 1024;

interface Checkpoint {
  running: Int32Array;
  queued: Int32Array;
  active: Int32Array;
  steps: Int32Array;
}

/**
 * What goes on after event `at` (inclusive; -1 is before the first).
 *
 * `running[node]` is a task or -1, `queued[node]` counts ready tasks that wait, `active` lists
 * transfers in service, and `step[transfer]` is the step that gives an active transfer's rate.
 */
export class Cursor {
  at = -1;
  readonly running: Int32Array;
  readonly queued: Int32Array;
  active: number[] = [];
  step: Int32Array;
  private place: Int32Array;
  private checkpoints: Checkpoint[] = [];

  constructor(readonly run: Run) {
    this.running = new Int32Array(run.nodes.length).fill(-1);
    this.queued = new Int32Array(run.nodes.length);
    this.step = new Int32Array(run.transfers).fill(-1);
    this.place = new Int32Array(run.transfers).fill(-1);
    this.checkpoints.push(this.snapshot());
  }

  seek(event: number): void {
    const target = Math.max(-1, Math.min(event, this.run.events - 1));
    const nearest = Math.min(Math.floor((target + 1) / SPACING), this.checkpoints.length - 1);
    if (target < this.at || nearest * SPACING - 1 > this.at) this.restore(nearest);
    while (this.at < target) this.forward();
  }

  /** A step's rate, or 0 while no rate is recorded. */
  rateOf(transfer: number): number {
    const step = this.step[transfer];
    return step < 0 ? 0 : this.run.stRate.data[step];
  }

  private forward(): void {
    const { run } = this;
    const event = ++this.at;
    const argument = run.evArg.data[event];
    switch (run.evKind.data[event]) {
      case K.ready: this.queued[run.tkNode.data[argument]] += 1; break;
      case K.start:
        this.queued[run.tkNode.data[argument]] -= 1;
        this.running[run.tkNode.data[argument]] = argument;
        break;
      case K.end: this.running[run.tkNode.data[argument]] = -1; break;
      case K.xstart: this.enter(argument); break;
      case K.xend: this.leave(argument); break;
      case K.recalc: {
        const [from, to] = run.stepRange(argument);
        for (let step = from; step < to; step++) this.step[run.stTransfer.data[step]] = step;
        break;
      }
    }
    if ((event + 1) % SPACING === 0 && (event + 1) / SPACING === this.checkpoints.length) {
      this.checkpoints.push(this.snapshot());
    }
  }

  private enter(transfer: number): void {
    if (transfer >= this.place.length) this.widen();
    this.place[transfer] = this.active.push(transfer) - 1;
    this.step[transfer] = -1;
  }

  private leave(transfer: number): void {
    const hole = this.place[transfer];
    const last = this.active.pop() as number;
    if (last !== transfer) {
      this.active[hole] = last;
      this.place[last] = hole;
    }
  }

  /** Make room for dependencies that a live run has brought since. */
  private widen(): void {
    const grown = (old: Int32Array): Int32Array => {
      const larger = new Int32Array(Math.max(this.run.transfers, old.length * 2)).fill(-1);
      larger.set(old);
      return larger;
    };
    this.place = grown(this.place);
    this.step = grown(this.step);
  }

  private snapshot(): Checkpoint {
    return {
      running: this.running.slice(),
      queued: this.queued.slice(),
      active: Int32Array.from(this.active),
      steps: Int32Array.from(this.active, (transfer) => this.step[transfer]),
    };
  }

  private restore(index: number): void {
    const checkpoint = this.checkpoints[index];
    this.running.set(checkpoint.running);
    this.queued.set(checkpoint.queued);
    this.active = Array.from(checkpoint.active);
    this.active.forEach((transfer, i) => {
      this.place[transfer] = i;
      this.step[transfer] = checkpoint.steps[i];
    });
    this.at = index * SPACING - 1;
  }
}
