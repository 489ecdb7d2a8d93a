/** Made-up traces for tests. */

import { TraceParser } from "../src/data/parse";
import type { Run } from "../src/data/run";

export function random(seed: number): () => number {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** A made-up trace: tasks on nodes one by one, transfers that come, move and go. */
export function made(pairs: number, nodes = 7): string {
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

export function read(text: string, piece = 997): Run {
  const parser = new TraceParser();
  for (let at = 0; at < text.length; at += piece) parser.push(text.slice(at, at + piece));
  return parser.finish();
}
