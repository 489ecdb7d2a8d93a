/** How much later a task could have ended without the run ending later, all durations staying as they were. */

import type { Run } from "../data/run";

/**
 * Slack of every task in microseconds; NaN for tasks that have not ended.
 *
 * Later is what a task's end pushes: tasks that wait for its data, by as long as its transfer took, and the task that
 * runs next on its node. Sharing is left as it was, so this is a bound, not a forecast.
 */
export function slackOf(run: Run): Float64Array {
  const latest = new Float64Array(run.tasks).fill(NaN);
  const order = Array.from({ length: run.tasks }, (_, i) => i).filter((i) => run.tkEnd.data[i] >= 0);
  order.sort((a, b) => run.tkEnd.data[b] - run.tkEnd.data[a]);
  const end = order.length ? run.endedAt(order[0]) : 0;
  const outgoing = edgesByTask(run);
  const nextOnNode = new Map<number, number>();
  for (const task of order) {
    let limit = end;
    const next = nextOnNode.get(run.tkNode.data[task]);
    if (next !== undefined) limit = latest[next] - (run.endedAt(next) - run.startedAt(next));
    for (const x of outgoing[task]) {
      const waiting = run.exTarget.data[x];
      if (Number.isNaN(latest[waiting])) continue;
      const start = latest[waiting] - (run.endedAt(waiting) - run.startedAt(waiting));
      limit = Math.min(limit, start - (run.arrivedAt(x) - run.endedAt(task)));
    }
    latest[task] = limit;
    nextOnNode.set(run.tkNode.data[task], task);
  }
  return latest.map((limit, task) => limit - run.endedAt(task));
}

function edgesByTask(run: Run): number[][] {
  const outgoing: number[][] = Array.from({ length: run.tasks }, () => []);
  for (let x = 0; x < run.transfers; x++) outgoing[run.exSource.data[x]].push(x);
  return outgoing;
}
