import { describe, expect, test } from "vitest";
import { Cursor } from "../src/data/cursor";
import { K, type Run } from "../src/data/run";
import { csvOf } from "../src/draw/format";
import { layered } from "../src/draw/layers";
import { Lanes, type Level } from "../src/draw/lanes";
import { SvgPainter } from "../src/draw/painter";
import { fromIntervals, fromPyramid } from "../src/draw/raster";
import { fromHash, hashOf, START } from "../src/state";
import { made, random, read } from "./made";

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

test("sorted by load, the tasks and transfers of a node stay together", () => {
  const lanes = new Lanes(run, "node", true).lanes;
  const owners = lanes.map((lane) => lane.owner).filter((owner, i, all) => owner !== all[i - 1]);
  expect(new Set(owners).size).toBe(owners.length);
});

describe("pixels", () => {
  test("from the pyramid cover what those from intervals cover, to two pixels at the ends", () => {
    const lanes = new Lanes(run, "node", false);
    const width = 300;
    const next = random(21);
    for (let i = 0; i < 200; i++) {
      const index = Math.floor(next() * lanes.lanes.length);
      const row = { lane: lanes.lanes[index], index, top: 0, height: 1 };
      const from = Math.floor(next() * run.end * 0.4);
      const part = { from, to: from + run.end * (0.1 + next() * 0.5), top: 0, whole: run.end };
      const [exact, quick] = [new Uint32Array(width), new Uint32Array(width)];
      fromIntervals(exact, width, lanes, row, part, [1, 2]);
      const level = lanes.level(Math.ceil((width * part.whole) / (part.to - part.from)));
      fromPyramid(quick, width, level as Level, row, part, [1, 2]);
      const near = (line: Uint32Array, x: number): boolean => line.subarray(x - 2, x + 3).some((pixel) => pixel > 0);
      for (let x = 2; x < width - 2; x++) {
        if (exact[x]) expect(near(quick, x)).toBe(true);
        if (quick[x]) expect(near(exact, x)).toBe(true);
      }
    }
  });

  test("of tens of thousands of lanes need no pyramid", () => {
    const many = read(made(5000));
    expect(new Lanes(many, "transfer", false).level(1000)).toBeNull();
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

test("a DAG of 1000 tasks is laid out with every edge forward", () => {
  const next = random(7);
  const sources: number[] = [];
  const targets: number[] = [];
  for (let i = 1; i < 1000; i++) for (let k = 0; k < 2; k++) { sources.push(Math.floor(next() * i)); targets.push(i); }
  const { layer } = layered(1000, sources, targets);
  sources.forEach((source, i) => expect(layer[source]).toBeLessThan(layer[targets[i]]));
});

test("a hostile name is harmless in SVG and in CSV", () => {
  const painter = new SvgPainter();
  painter.text(0, 0, "</script><img onerror=alert(1)>", { fill: "#000000" });
  expect(painter.document(9, 9, "#ffffff", "<b>")).not.toMatch(/<img|<b>|<\/script/);
  expect(csvOf(["a"], [["=1+1"], ['x"y']])).toBe("a\r\n'=1+1\r\n\"x\"\"y\"\r\n");
});

test("the state survives the address, and a broken address is left out", () => {
  const ui = { ...START, view: "rates", event: 7, window: [5, 90], selection: { kind: "link", id: 3 }, chain: true, map: { scale: 2.5, x: 0.125, y: -0.25 } } as typeof START;
  expect({ ...START, ...fromHash(hashOf(ui)), time: 0 }).toEqual(ui);
  const broken = fromHash("v=nothing&e=-3&w=9-1&s=q1&z=0.5_9_x&m=[1]");
  expect([broken.view, broken.event, broken.window, broken.selection, broken.map, broken.heat]).toEqual([undefined, -1, null, null, null, null]);
});
