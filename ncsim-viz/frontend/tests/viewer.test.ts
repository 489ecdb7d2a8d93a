import { describe, expect, test } from "vitest";
import { Cursor } from "../src/data/cursor";
import { TraceParser } from "../src/data/parse";
import { K, type Run } from "../src/data/run";
import { csvOf } from "../src/draw/format";
import { layered } from "../src/draw/layers";
import { Lanes } from "../src/draw/lanes";
import { SvgPainter } from "../src/draw/painter";
import { fromHash, hashOf, START } from "../src/state";

function random(seed: number): () => number {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** A made-up trace: tasks on nodes one by one, transfers that come, move and go. */
function made(pairs: number, nodes = 7): string {
  const next = random(5);
  const lines: object[] = [{
    format: "ncsim-trace", version: "1.0", time_unit: "us", level: "full", software: "", scenario: "made", scenario_sha256: "",
    seed: 1, plugins: {}, sections: {}, kinds: {}, nodes: Array.from({ length: nodes }, (_, i) => [`n${i}`, 1, i, 0]),
    links: Array.from({ length: nodes - 1 }, (_, i) => [`l${i}`, i, i + 1, 2, 0, "wireless"]),
  }];
  const tasks = Array.from({ length: pairs * 2 }, (_, i) => [`T${i}`, 1]);
  lines.push({ t: 0, k: "inject", d: 0, dag: "d", i0: 0, x0: 0, tasks, edges: Array.from({ length: pairs }, (_, i) => [2 * i, 2 * i + 1, 1]) });
  lines.push({ t: 0, k: "place", d: 0, n: tasks.map((_, i) => (i + (i >> 1)) % nodes) });
  let t = 0;
  const active: number[] = [];
  for (let x = 0; x < pairs; x++) {
    const n = (2 * x + x) % nodes;
    t += Math.floor(next() * 3);
    lines.push({ t, k: "ready", i: 2 * x, n }, { t, k: "start", i: 2 * x, n });
    t += Math.floor(next() * 5);
    lines.push({ t, k: "end", i: 2 * x, n }, { t, k: "xstart", x, route: [x % (nodes - 1)], size: 1 });
    active.push(x);
    const r = active.map(() => next());
    const zeros = active.map(() => 0);
    lines.push({ t, k: "recalc", by: ["s", x], x: [...active], r, l: zeros, nc: zeros, nh: zeros, fh: zeros, f: zeros });
    if (active.length > 4) lines.push({ t, k: "xend", x: active.splice(Math.floor(next() * 4), 1)[0] });
  }
  return `${lines.map((line) => JSON.stringify(line)).join("\n")}\n`;
}

function read(text: string, piece = 997): Run {
  const parser = new TraceParser();
  for (let at = 0; at < text.length; at += piece) parser.push(text.slice(at, at + piece));
  return parser.finish();
}

/** The state from the start, in the plainest way. */
function replayed(run: Run, event: number): object {
  const running = run.nodes.map(() => -1);
  const queued = run.nodes.map(() => 0);
  const rate = new Map<number, number>();
  for (let i = 0; i <= event; i++) {
    const argument = run.evArg.data[i];
    const node = run.tkNode.data[argument];
    const kind = run.evKind.data[i];
    if (kind === K.ready) queued[node] += 1;
    if (kind === K.start) { queued[node] -= 1; running[node] = argument; }
    if (kind === K.end) running[node] = -1;
    if (kind === K.xstart) rate.set(argument, 0);
    if (kind === K.xend) rate.delete(argument);
    if (kind === K.recalc) {
      const [from, to] = run.stepRange(argument);
      for (let step = from; step < to; step++) rate.set(run.stTransfer.data[step], run.stRate.data[step]);
    }
  }
  return { running, queued, active: [...rate].sort((a, b) => a[0] - b[0]) };
}

const run = read(made(1500));

describe("state by checkpoint and cursor", () => {
  test("equals a replay from the start at 200 random places", () => {
    const cursor = new Cursor(run);
    const next = random(11);
    for (let i = 0; i < 200; i++) {
      const event = Math.floor(next() * run.events);
      cursor.seek(event);
      const active = [...cursor.active].sort((a, b) => a - b).map((x) => [x, cursor.rateOf(x)]);
      expect({ running: [...cursor.running], queued: [...cursor.queued], active }).toEqual(replayed(run, event));
    }
  });
});

describe("lanes", () => {
  test("a hit equals brute force", () => {
    const lanes = new Lanes(run, "node", false);
    const next = random(3);
    for (let i = 0; i < 2000; i++) {
      const lane = lanes.lanes[Math.floor(next() * lanes.lanes.length)];
      const time = Math.floor(next() * run.end);
      let wanted = -1;
      for (let k = lane.from; k < lane.to; k++) if (lanes.start.data[k] <= time && lanes.end.data[k] >= time) wanted = k;
      expect(lanes.hit(lane, time)).toBe(wanted);
    }
  });
});

describe("reading", () => {
  test("where pieces are cut changes nothing", () => {
    expect(read(made(40), 13).pack()).toEqual(read(made(40), 100000).pack());
  });
  test("a torn last line is dropped", () => {
    expect(read(made(3).slice(0, -9)).status).toBe("truncated");
  });
  test("another major version is refused", () => {
    expect(() => read(made(1).replace('"1.0"', '"2.0"'))).toThrow("version 2.0");
  });
  test("unknown kinds are counted and ignored", () => {
    expect(read(`${made(1)}{"t":99,"k":"later"}\n`).ignored).toBe(1);
  });
});

test("a DAG of 1000 tasks is laid out in 200 ms, every edge forward", () => {
  const next = random(7);
  const sources: number[] = [];
  const targets: number[] = [];
  for (let i = 1; i < 1000; i++) for (let k = 0; k < 2; k++) { sources.push(Math.floor(next() * i)); targets.push(i); }
  const started = performance.now();
  const { layer } = layered(1000, sources, targets);
  expect(performance.now() - started).toBeLessThan(200);
  sources.forEach((source, i) => expect(layer[source]).toBeLessThan(layer[targets[i]]));
});

test("a hostile name is harmless in SVG and in CSV", () => {
  const painter = new SvgPainter();
  painter.text(0, 0, "</script><img onerror=alert(1)>", { fill: "#000000" });
  expect(painter.document(9, 9, "#ffffff", "<b>")).not.toMatch(/<img|<b>|<\/script/);
  expect(csvOf(["a"], [["=1+1"], ['x"y']])).toBe("a\r\n'=1+1\r\n\"x\"\"y\"\r\n");
});

test("the state survives the address, and a broken address is left out", () => {
  const ui = { ...START, view: "rates", event: 7, window: [5, 90], selection: { kind: "link", id: 3 }, chain: true } as typeof START;
  expect({ ...START, ...fromHash(hashOf(ui)), time: 0 }).toEqual(ui);
  expect(fromHash("v=nothing&e=-3&w=9-1&s=q1").view).toBeUndefined();
});
