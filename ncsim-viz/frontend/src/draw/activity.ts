/** How much goes on over a whole run: tasks that run and transfers in service, per bin of time. */

import type { Run } from "../data/run";

export interface Activity { tasks: Float64Array; transfers: Float64Array }

/** Mean number of running tasks and of transfers in service in each of some equal bins. */
export function activityOf(run: Run, bins: number): Activity {
  const width = Math.max(1, run.end) / bins;
  const tasks = new Float64Array(bins);
  const transfers = new Float64Array(bins);
  for (let task = 0; task < run.tasks; task++) add(tasks, width, run.startedAt(task), run.endedAt(task), run.end);
  for (let x = 0; x < run.transfers; x++) add(transfers, width, run.servedFrom(x), run.servedTo(x), run.end);
  return { tasks: summed(tasks, width), transfers: summed(transfers, width) };
}

/** Add an interval to second differences of the covered time, so that long intervals cost no more than short ones. */
function add(bins: Float64Array, width: number, from: number, to: number, end: number): void {
  if (Number.isNaN(from)) return;
  const until = Number.isNaN(to) ? end : to;
  const first = Math.min(bins.length - 1, Math.floor(from / width));
  const last = Math.min(bins.length - 1, Math.floor(until / width));
  if (first === last) {
    slope(bins, first, until - from);
    slope(bins, first + 1, -(until - from));
    return;
  }
  const head = (first + 1) * width - from;
  const tail = until - last * width;
  slope(bins, first, head);
  slope(bins, first + 1, width - head);
  slope(bins, last, tail - width);
  slope(bins, last + 1, -tail);
}

function slope(bins: Float64Array, at: number, change: number): void {
  if (at < bins.length) bins[at] += change;
}

function summed(changes: Float64Array, width: number): Float64Array {
  let sum = 0;
  return changes.map((change) => {
    sum += change;
    return Math.max(0, sum / width);
  });
}
