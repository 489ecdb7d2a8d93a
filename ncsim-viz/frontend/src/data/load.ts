/** Where a run comes from: this page, a file of the user's, or the server. */

import { bytesOfBase64, parseBytes } from "./parse";
import { Run, type Packed } from "./run";
import TraceWorker from "./worker?worker&inline";

/** Parse in a Worker; on the page itself where Workers are forbidden. */
export async function loadRun(bytes: Blob): Promise<Run> {
  let worker: Worker;
  try {
    worker = new TraceWorker();
  } catch {
    return parseBytes(bytes);
  }
  try {
    return await new Promise<Run>((resolve, reject) => {
      worker.onmessage = (message: MessageEvent<{ packed?: Packed; error?: string }>) => {
        const { packed, error } = message.data;
        if (packed) resolve(Run.unpack(packed));
        else reject(new Error(error));
      };
      worker.onerror = () => parseBytes(bytes).then(resolve, reject);
      worker.postMessage(bytes);
    });
  } finally {
    worker.terminate();
  }
}

/** The n-th embedded trace of this page. */
export function embeddedTrace(index: number): Blob | null {
  const element = document.querySelectorAll('script[type="application/x-ncsim-trace"]')[index];
  return element ? new Blob([bytesOfBase64((element.textContent ?? "").trim())]) : null;
}

/** The JSON that Python computed for this page; see ncsim_viz.extras. */
export async function embeddedExtras(): Promise<Extras> {
  const element = document.querySelector('script[type="application/x-ncsim-extras"]');
  if (!element) return {};
  const bytes = new Blob([bytesOfBase64((element.textContent ?? "").trim())]);
  const stream = bytes.stream().pipeThrough(new DecompressionStream("gzip"));
  return JSON.parse(await new Response(stream).text()) as Extras;
}

export interface MetricsNode { id: string; tasks_ended: number; busy_s: number; utilisation: number; queue_wait_s: number }
export interface MetricsLink { id: string; transfers: number; served_MB: number; busy_s: number; utilisation: number }
export interface Metrics {
  status: string; makespan_s: number | null; ended_s: number; events: number;
  tasks: { total: number; ended: number }; transfers: { total: number; ended: number };
  remote_MB: number; route_work_MB_hops: number; critical_path_s: number | null;
  mean_transfer_slowdown: number | null; max_transfer_slowdown: number | null;
  nodes: MetricsNode[]; links: MetricsLink[];
}
export interface ChainItem {
  kind: "injection" | "task" | "transfer"; label: string; place: string[]; start_us: number; end_us: number;
  parts_us: Record<string, number>; number: number;
}
export interface Explanation { makespan_us: number; totals_us: Record<string, number>; chain: ChainItem[] }
export interface Difference { setting: string; first: string; second: string }
export interface Comparison {
  names: [string, string];
  differences: Difference[]; status: [string, string]; makespan_s: [number | null, number | null];
  makespan_ratio: number | null;
  tasks: { label: string; nodes: [string | null, string | null]; ready_us: number; wait_us: number; compute_us: number; ended_us: number; why: string }[];
  transfers: { label: string; routes: [string[], string[]]; took_us: number; parts_us: Record<string, number>; why: string }[];
  unmatched: string[];
}
/** For each link: who it shares the channel with, and who disturbs it unheard. */
export interface Relations { contenders: number[][]; hidden: number[][]; note: string }
export interface Study {
  name: string; factors: string[]; columns: string[]; rows: (string | number | null)[][];
  reports: StudyReport[];
}
export interface StudyReport {
  title: string; note: string; columns: string[]; rows: (string | number | null)[][];
  kind: "winners" | "regret" | "heat" | "table"; marks?: (string | null)[][];
}
export interface Extras {
  title?: string;
  metrics?: Metrics[];
  explanation?: (Explanation | null)[];
  comparison?: Comparison | null;
  relations?: Relations | null;
  scenario?: string | null;
  study?: Study | null;
  note?: string;
}
