/** The server's requests and shapes: docs/viewer-api.md. */

import type { Extras } from "../data/extras";
import { bytesOfBase64 } from "../data/parse";
import type { Study } from "../data/study";

export interface ServerInfo { api: number; token: string; title: string; software: string; can_run: boolean }
export interface Entry {
  id: string; kind: "run" | "study"; name: string; status: string; is_live: boolean; makespan_s: number | null;
  modified_s: number; bytes: number | null; plugins?: Record<string, string>; planned?: number; ended?: number;
}
export interface Entries { title: string; entries: Entry[]; left_out: number }
export interface Fault {
  message: string; pointer: string; path: string; line: number | null; column: number | null; value: string | null;
  suggestion: string | null;
}
export type Document = Record<string, unknown>;
export interface Validation {
  valid: boolean; faults: Fault[]; document: Document | null; resolved: Document | null;
  summary: Record<string, number> | null; notes: string[];
}
export interface Job {
  id: string; name: string; run: string; state: "queued" | "running" | "ended" | "failed" | "cancelled";
  status: string | null; message: string; waited_s: number; ran_s: number | null;
  progress: { tasks_ended: number; tasks: number; simulated_s: number } | null;
}
export interface Jobs { jobs: Job[]; limits: Record<string, number> }
export type Schema = Record<string, unknown>;
export interface Generator { type: string; summary: string; parameters: Schema; is_random: boolean }
export interface Catalogue {
  kinds: { kind: string; config_key: string; question: string; components: { name: string; summary: string; missing: string[] }[] }[];
  generators: { networks: Generator[]; dags: Generator[] };
  broken: { distribution: string; detail: string }[];
  starter: string;
}
export interface Choice { type: string; [parameter: string]: unknown }

/** A request that the server refused, with its faults if it named some. */
export class Refusal extends Error {
  constructor(message: string, readonly status: number, readonly faults: Fault[]) {
    super(message);
  }
}

/** What the page says about its server; null in a report. */
export function serverInfo(): ServerInfo | null {
  const element = document.querySelector('script[type="application/x-ncsim-server"]');
  if (!element) return null;
  return JSON.parse(new TextDecoder().decode(bytesOfBase64((element.textContent ?? "").trim()))) as ServerInfo;
}

const query = (parameters: Record<string, string>): string => new URLSearchParams(Object.entries(parameters).filter(([, value]) => value)).toString();

export class Api {
  constructor(private readonly token: string) {}

  entries(): Promise<Entries> { return this.json("entries"); }
  extras(run: string, compare = ""): Promise<Extras> { return this.json(`extras?${query({ run, compare })}`); }
  study(study: string): Promise<Study> { return this.json(`study?${query({ study })}`); }
  studyScenario(study: string, run: number): Promise<{ yaml: string }> { return this.json(`study/scenario?${query({ study, run: String(run) })}`); }
  schema(): Promise<Schema> { return this.json("schema"); }
  catalogue(): Promise<Catalogue> { return this.json("catalogue"); }
  jobs(): Promise<Jobs> { return this.json("jobs"); }
  validate(yaml: string): Promise<Validation> { return this.json("validate", { yaml }); }
  yaml(document: Document): Promise<{ yaml: string }> { return this.json("yaml", { document }); }
  preset(network: Choice, dags: Choice, seed: number): Promise<{ yaml: string; document: Document }> { return this.json("preset", { network, dags, seed }); }
  start(yaml: string, name: string): Promise<{ job: Job }> { return this.json("jobs", { yaml, name }); }
  cancel(job: string): Promise<{ job: Job }> { return this.json("jobs/cancel", { job }); }

  async trace(run: string): Promise<Blob> { return (await this.ask(`trace?${query({ run })}`)).blob(); }
  stream(run: string, from: string): EventSource { return new EventSource(`/api/stream?${query({ run, from, token: this.token })}`); }

  private async json<T>(path: string, body?: unknown): Promise<T> {
    return (await this.ask(path, body)).json() as Promise<T>;
  }

  private async ask(path: string, body?: unknown): Promise<Response> {
    const headers: Record<string, string> = { "X-Ncsim-Token": this.token };
    if (body !== undefined) headers["Content-Type"] = "application/json";
    const answer = await fetch(`/api/${path}`, body === undefined ? { headers } : { method: "POST", headers, body: JSON.stringify(body) });
    if (answer.ok) return answer;
    const said = (await answer.json().catch(() => ({}))) as { error?: string; faults?: Fault[] };
    throw new Refusal(said.error ?? `the server answered ${answer.status}`, answer.status, said.faults ?? []);
  }
}

export const wordsOf = (error: unknown): string => (error instanceof Error ? error.message : String(error));
