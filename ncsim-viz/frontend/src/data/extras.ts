/** What Python computed beyond the trace: shapes of docs/viewer-api.md. */

import type { Study } from "./study";

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
