/** What a selection stands for, so that every view marks the same things. */

import type { Run } from "../data/run";
import type { Selection } from "../state";

export interface Marks { tasks: Set<number>; transfers: Set<number>; links: Set<number>; nodes: Set<number> }

export const NO_MARKS: Marks = { tasks: new Set(), transfers: new Set(), links: new Set(), nodes: new Set() };

/** Tasks, transfers, links and nodes that a selection is about. */
export function marksOf(run: Run, selection: Selection | null): Marks {
  if (!selection) return NO_MARKS;
  const marks: Marks = { tasks: new Set(), transfers: new Set(), links: new Set(), nodes: new Set() };
  const { id } = selection;
  switch (selection.kind) {
    case "task":
      marks.tasks.add(id);
      marks.nodes.add(run.tkNode.data[id]);
      break;
    case "transfer":
      marks.transfers.add(id);
      for (const link of run.routeOf(id)) marks.links.add(link);
      break;
    case "link":
      marks.links.add(id);
      for (let x = 0; x < run.transfers; x++) if (run.routeOf(x).includes(id)) marks.transfers.add(x);
      break;
    case "node":
      marks.nodes.add(id);
      for (let task = 0; task < run.tasks; task++) if (run.tkNode.data[task] === id) marks.tasks.add(task);
      break;
    case "row": break;
    case "recalc": {
      const [from, to] = run.stepRange(id);
      for (let step = from; step < to; step++) {
        marks.transfers.add(run.stTransfer.data[step]);
        marks.links.add(run.stLink.data[step]);
      }
      break;
    }
  }
  return marks;
}
