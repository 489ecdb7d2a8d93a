import { afterEach, beforeEach, expect, test, vi } from "vitest";
import type { Run } from "../src/data/run";
import { Live } from "../src/server/live";
import { made } from "./made";

/** An EventSource in the hand of a test. */
class Source extends EventTarget {
  static readonly CLOSED = 2;
  static all: Source[] = [];
  readyState = 1;
  onmessage: ((message: MessageEvent) => void) | null = null;
  onerror: (() => void) | null = null;
  constructor(readonly from: string) {
    super();
    Source.all.push(this);
  }
  close(): void { this.readyState = 2; }
  send(lines: string[], place: string): void { this.onmessage?.({ data: lines.join("\n"), lastEventId: place } as MessageEvent); }
  emit(type: string, data: string): void { this.dispatchEvent(Object.assign(new Event(type), { data, lastEventId: "" })); }
}

const lines = made(20).trim().split("\n");
const told: string[] = [];
let latest: Run | null = null;

function follow(): Live {
  const keep = (word: string) => (run: Run): void => { told.push(word); latest = run; };
  return new Live((from) => new Source(from) as unknown as EventSource, { opened: keep("opened"), grew: keep("grew"), ended: (_, status) => told.push(status), failed: (words) => told.push(words) });
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("EventSource", Source);
  vi.stubGlobal("window", globalThis);
  vi.stubGlobal("requestAnimationFrame", (act: () => void) => setTimeout(act, 16));
  Source.all = [];
  told.length = 0;
  latest = null;
});
afterEach(() => { vi.useRealTimers(); vi.unstubAllGlobals(); });

test("records are shown as they come, and the end is told", () => {
  follow();
  Source.all[0].send(lines.slice(0, 5), "5");
  vi.advanceTimersByTime(2000);
  Source.all[0].send(lines.slice(5), "9");
  vi.advanceTimersByTime(2000);
  Source.all[0].emit("end", '{"status": "completed"}');
  expect(told).toEqual(["opened", "grew", "grew", "completed"]);
  expect(latest?.lines).toBe(lines.length);
  expect(latest?.isLive).toBe(false);
  expect(Source.all[0].readyState).toBe(2);
});

test("after a refusal it goes on behind the last record", () => {
  follow();
  Source.all[0].send(lines.slice(0, 7), "700-abc");
  Source.all[0].readyState = 2;
  Source.all[0].onerror?.();
  vi.advanceTimersByTime(1500);
  expect(Source.all.map((each) => each.from)).toEqual(["", "700-abc"]);
  Source.all[1].send(lines.slice(7, 9), "900-abc");
  vi.advanceTimersByTime(2000);
  expect(latest?.lines).toBe(9);
});

test("another run takes the place of the first", () => {
  follow();
  Source.all[0].send(lines.slice(0, 7), "7");
  vi.advanceTimersByTime(2000);
  Source.all[0].emit("restart", "{}");
  Source.all[0].send(lines.slice(0, 3), "3");
  vi.advanceTimersByTime(2000);
  expect(told).toEqual(["opened", "opened"]);
  expect(latest?.lines).toBe(3);
});

test("what cannot be read is said, and ends it", () => {
  follow();
  Source.all[0].send([...lines.slice(0, 2), "{no record"], "9");
  expect(told).toEqual(["line 3 of the trace is no JSON: {no record"]);
  expect(Source.all[0].readyState).toBe(2);
});

test("who has closed hears nothing more", () => {
  const live = follow();
  Source.all[0].send(lines.slice(0, 7), "7");
  live.close();
  vi.advanceTimersByTime(5000);
  expect(told).toEqual([]);
  expect(Source.all).toHaveLength(1);
});
