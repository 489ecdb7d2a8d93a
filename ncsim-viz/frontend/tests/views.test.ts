import { describe, expect, test } from "vitest";
import { sorted } from "../src/app/rows";
import { actionOf } from "../src/app/keys";
import { busiest, Page } from "../src/app/page";
import { causesOf } from "../src/app/inspector";
import { moved, stretch } from "../src/app/replay";
import { K, type Run } from "../src/data/run";
import type { Study } from "../src/data/study";
import { activityOf } from "../src/draw/activity";
import { tickSeconds, ticks } from "../src/draw/format";
import { START, Store } from "../src/state";
import { pairsOf } from "../src/views/compare";
import { gantt } from "../src/views/gantt";
import { overview } from "../src/views/overview";
import { marksOf } from "../src/views/marks";
import { inForce, treads } from "../src/views/rates";
import { slackOf } from "../src/views/slack";
import { cellWidth } from "../src/views/sweep_winners";
import { made, random, read } from "./made";

const us = 1e6;

/** Two tasks on node 0, one on node 1; the data of the first takes 3 s, that of the second nothing. */
function small(): Run {
  const lines: object[] = [
    { format: "ncsim-trace", version: "1.0", time_unit: "us", level: "full", software: "", scenario: "small", scenario_sha256: "", seed: 1, plugins: {}, sections: {}, kinds: {},
      nodes: [["a", 1, 0, 0], ["b", 1, 1, 0]], links: [["ab", 0, 1, 2, 0, "wireless"]] },
    { t: 0, k: "inject", d: 0, dag: "d", i0: 0, x0: 0, tasks: [["A", 1], ["B", 1], ["C", 1], ["D", 1]], edges: [[0, 2, 6], [1, 3, 1]] },
    { t: 0, k: "place", d: 0, n: [0, 0, 1, 0] },
    { t: 0, k: "ready", i: 0, n: 0 }, { t: 0, k: "ready", i: 1, n: 0 }, { t: 0, k: "start", i: 0, n: 0 },
    { t: 1 * us, k: "end", i: 0, n: 0 }, { t: 1 * us, k: "start", i: 1, n: 0 },
    { t: 1 * us, k: "xstart", x: 0, route: [0], size: 6 },
    { t: 1 * us, k: "recalc", by: ["s", 0], x: [0], r: [2], l: [0], nc: [0], nh: [0], fh: [1], f: [1] },
    { t: 2 * us, k: "end", i: 1, n: 0 }, { t: 2 * us, k: "ready", i: 3, n: 0 }, { t: 2 * us, k: "start", i: 3, n: 0 },
    { t: 3 * us, k: "end", i: 3, n: 0 },
    { t: 4 * us, k: "xend", x: 0 }, { t: 4 * us, k: "ready", i: 2, n: 1 }, { t: 4 * us, k: "start", i: 2, n: 1 },
    { t: 5 * us, k: "end", i: 2, n: 1 },
  ];
  return read(`${lines.map((line) => JSON.stringify(line)).join("\n")}\n`);
}

describe("staircases of rates", () => {
  test("a rate that was replaced at the instant it was set is not drawn", () => {
    const run = read(made(80));
    let dropped = 0;
    for (let x = 0; x < run.transfers; x++) {
      const steps = run.stepsOf(x);
      const kept = inForce(run, x);
      dropped += steps.length - kept.length;
      expect(new Set(kept.map((step) => run.stepTime(step))).size).toBe(kept.length);
      expect(kept.at(-1)).toBe(steps.at(-1));
    }
    expect(dropped).toBeGreaterThan(0);
  });

  test("a short peak takes one pixel, and the rate after it the rest", () => {
    expect(treads([10, 10.1, 90], [3.3, 0.8])).toEqual([{ x0: 10, x1: 10.5, k: 0 }, { x0: 10.5, x1: 90, k: 1 }]);
  });

  test("a short dip leaves what follows as it is", () => {
    expect(treads([10, 10.1, 90], [0.8, 3.3])).toEqual([{ x0: 10, x1: 90, k: 1 }]);
  });

  test("at places apart, each rate is drawn from its step to the next", () => {
    expect(treads([0, 20, 30], [1, 2])).toEqual([{ x0: 0, x1: 20, k: 0 }, { x0: 20, x1: 30, k: 1 }]);
  });

  test("areas cover the time of service once", () => {
    const next = random(3);
    for (let round = 0; round < 200; round++) {
      const edges = Array.from({ length: 12 }, () => next() * 8).sort((a, b) => a - b);
      const pieces = treads(edges, edges.slice(1).map(() => next()));
      expect(pieces[0].x0).toBe(edges[0]);
      expect(pieces.at(-1)!.x1).toBe(edges.at(-1));
      for (let i = 1; i < pieces.length; i++) expect(pieces[i].x0).toBe(pieces[i - 1].x1);
    }
  });
});

test("a key acts in the view that was asked for, though it is not drawn yet", () => {
  const page = new Page(new Store({ ...START, theme: "light" }), { run: small(), other: null, extras: {} });
  const press = (key: string): void => actionOf({ key, shiftKey: false }, page, [overview, gantt])?.();

  press("2");
  press("j");
  expect(page.store.ui.selection).toEqual({ kind: "task", id: 0 });
});

describe("slack", () => {
  test("is zero on the chain that binds, and counts what a node does next", () => {
    expect([...slackOf(small())]).toEqual([0, 2 * us, 0, 2 * us]);
  });

  test("delaying a task by its slack moves the end by nothing, by more it does", () => {
    const run = read(made(60));
    const slack = slackOf(run);
    const end = lastEnd(run, -1, 0);
    for (let task = 0; task < run.tasks; task++) {
      if (Number.isNaN(slack[task])) continue;
      expect(lastEnd(run, task, slack[task])).toBe(end);
      expect(lastEnd(run, task, slack[task] + 1)).toBe(end + 1);
    }
  });
});

/** When the last task ends if one task ends later, durations staying as they were: forwards, event by event. */
function lastEnd(run: Run, late: number, by: number): number {
  const push = new Float64Array(run.tasks);
  const nodeFree = new Map<number, { end: number; push: number }>();
  let last = 0;
  const order = Array.from({ length: run.tasks }, (_, i) => i).filter((i) => run.tkEnd.data[i] >= 0).sort((a, b) => run.tkStart.data[a] - run.tkStart.data[b]);
  for (const task of order) {
    let shift = 0;
    const before = nodeFree.get(run.tkNode.data[task]);
    if (before) shift = Math.max(shift, before.end + before.push - run.startedAt(task));
    for (let x = 0; x < run.transfers; x++) {
      if (run.exTarget.data[x] === task) shift = Math.max(shift, run.arrivedAt(x) + push[run.exSource.data[x]] - run.startedAt(task));
    }
    push[task] = shift + (task === late ? by : 0);
    nodeFree.set(run.tkNode.data[task], { end: run.endedAt(task), push: push[task] });
    last = Math.max(last, run.endedAt(task) + push[task]);
  }
  return last;
}

describe("activity", () => {
  test("has the area of all service", () => {
    const run = read(made(300));
    const { tasks, transfers } = activityOf(run, 97);
    const area = (bins: Float64Array): number => bins.reduce((sum, each) => sum + each, 0) * (run.end / 97);
    let [ran, served] = [0, 0];
    for (let i = 0; i < run.tasks; i++) if (run.tkStart.data[i] >= 0) ran += (run.endedAt(i) || run.end) - run.startedAt(i);
    for (let x = 0; x < run.transfers; x++) if (run.exStart.data[x] >= 0) served += (run.servedTo(x) || run.end) - run.servedFrom(x);
    expect(area(tasks)).toBeCloseTo(ran, 5);
    expect(area(transfers)).toBeCloseTo(served, 5);
  });
});

describe("replay", () => {
  const page = new Page(new Store({ ...START, replaySeconds: 10 }), { run: small(), other: null, extras: {} });

  test("takes the whole run in the seconds that were asked for", () => {
    page.goToTime(0);
    page.goToTime(moved(page, 1000) as number);
    expect(page.store.ui.time).toBe(0.5 * us);
    page.goToTime(4.9 * us);
    expect(moved(page, 1000)).toBeNull();
  });

  test("loops over the window", () => {
    page.setWindow(2 * us, 3 * us);
    page.store.set({ loop: true });
    page.goToTime(2.9 * us);
    expect(stretch(page)).toEqual([2 * us, 3 * us]);
    expect(moved(page, 1000)).toBe(2 * us);
    page.store.set({ loop: false, window: null });
  });

  test("steps by sequence within one instant, and over it by time", () => {
    page.goTo(0);
    page.stepTime(1);
    expect(page.store.ui.time).toBe(1 * us);
    const at = page.store.ui.event;
    page.goTo(at + 1);
    expect([page.store.ui.time, page.store.ui.event]).toEqual([1 * us, at + 1]);
    page.stepRecalculation(1);
    expect(page.run.evKind.data[page.store.ui.event]).toBe(K.recalc);
    expect(page.store.ui.selection).toEqual({ kind: "recalc", id: 0 });
  });

  test("begins where most transfers are in service", () => {
    expect(page.run.evKind.data[busiest(page.run)]).toBe(K.recalc);
  });
});

test("what lies under the pointer stays there when the map is enlarged, and 1 shows all", () => {
  const page = new Page(new Store(START), { run: small(), other: null, extras: {} });
  const under = (x: number): number => { const { scale, x: middle } = page.store.ui.map ?? { scale: 1, x: 0 }; return x / scale + middle; };
  page.zoomMap(2, 0.3, -0.2);
  expect(under(0.3)).toBeCloseTo(0.3, 12);
  page.zoomMap(1.7, -0.1, 0);
  expect(page.store.ui.map?.scale).toBeCloseTo(3.4, 12);
  const before = under(0.2);
  page.panMap(page.store.ui.map as never, 0.1, 0);
  expect(under(0.3)).toBeCloseTo(before, 12);
  page.zoomMap(0.01);
  expect(page.store.ui.map).toBeNull();
});

describe("selection", () => {
  const run = small();

  test("of a link marks the transfers over it, of a node its tasks", () => {
    expect([...marksOf(run, { kind: "link", id: 0 }).transfers]).toEqual([0]);
    expect([...marksOf(run, { kind: "node", id: 0 }).tasks]).toEqual([0, 1, 3]);
    expect([...marksOf(run, { kind: "recalc", id: 0 }).links]).toEqual([0]);
  });

  test("leads backwards: to the last input, or to the task that had the node", () => {
    expect(causesOf(run, { kind: "task", id: 2 })[0][1]).toEqual({ kind: "transfer", id: 0 });
    expect(causesOf(run, { kind: "task", id: 1 })[0][1]).toEqual({ kind: "task", id: 0 });
    expect(causesOf(run, { kind: "transfer", id: 0 })[0][1]).toEqual({ kind: "task", id: 0 });
    expect(causesOf(run, { kind: "recalc", id: 0 })[0][1]).toEqual({ kind: "transfer", id: 0 });
  });
});

test("runs are compared by names, and what only one has is kept", () => {
  const [first, second] = [small(), small()];
  second.taskIds[1] = "other";
  const pairs = pairsOf(first, second);
  expect(pairs.filter((each) => each.kind === "task").map((each) => [each.first, each.second])).toEqual([[0, 0], [1, -1], [3, 3], [2, 2], [-1, 1]]);
  expect(pairs.filter((each) => each.kind === "transfer").map((each) => each.label)).toEqual(["A → C"]);
});

test("a table is sorted by numbers as numbers, empty cells last", () => {
  const rows = [["10"], [null], ["9"], [2]];
  expect(sorted(rows, { column: 0, down: false })).toEqual([3, 2, 0, 1]);
  expect(sorted(rows, { column: 0, down: true })).toEqual([0, 2, 3, 1]);
  expect(sorted(rows, null)).toEqual([0, 1, 2, 3]);
});

test("ticks differ in their printed digits, however small their distance", () => {
  const next = random(9);
  for (let i = 0; i < 200; i++) {
    const from = next() * 1e8;
    const all = ticks(from, from + 10 ** (1 + next() * 6), 8);
    const words = all.map((at) => tickSeconds(at, all[1] - all[0]));
    expect(new Set(words).size).toBe(all.length);
  }
});

test("the winners of a study have room on a narrow screen, too", () => {
  const policies = ["heft", "cpop", "round_robin", "dice"];
  const columns = ["seed", ...policies, "solo_winners", "full_winners", "inversion", "regret", "slowdown"];
  const study = { factors: [], winners: { columns, rows: [[1, 1, 1, 2, 3, "heft", "heft", false, 0, 2]], heads: 1 } } as unknown as Study;
  for (const width of [320, 420, 799, 800, 1400]) {
    expect(cellWidth(study, { width, height: 500, top: 0, bottom: 500 })).toBeGreaterThan(40);
  }
});
