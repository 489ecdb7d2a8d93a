/** The runs and studies of the served folder, and what runs now. */

import { useEffect, useState } from "preact/hooks";
import { number } from "../draw/format";
import type { Context } from "../views/view";
import { wordsOf, type Entries, type Entry, type Job, type Jobs } from "./api";
import type { Service } from "./service";

const POLL_ms = 2000;

/** Ask now and again while the page is looked at. */
export function usePolled<T>(ask: () => Promise<T>, every_ms: number): { value: T | null; error: string; again: () => void } {
  const [value, setValue] = useState<T | null>(null);
  const [error, setError] = useState("");
  const poll = (): void => {
    if (!document.hidden) ask().then((found) => { setValue(() => found); setError(""); }, (failure: unknown) => setError(wordsOf(failure)));
  };
  useEffect(() => {
    poll();
    const timer = setInterval(poll, every_ms);
    return () => clearInterval(timer);
  }, []);
  return { value, error, again: poll };
}

export function Runs({ service, ctx }: { service: Service; ctx: Context }) {
  const { value, error } = usePolled<Entries>(() => service.api.entries(), POLL_ms);
  const found = value?.entries ?? [];
  const studies = found.filter((each) => each.kind === "study");
  const runs = found.filter((each) => each.kind === "run");
  return (
    <div class="sheet-page" tabIndex={0} role="region" aria-label="Runs and studies">
      {error && <p role="alert" class="fault">{error}</p>}
      {service.canRun && <JobList service={service} />}
      {value && !found.length && <p>No run is here yet. Make one with: ncsim run scenario.yaml -o {value.title}/first, or by New run (n).</p>}
      {studies.length > 0 && <StudyTable rows={studies} service={service} />}
      {runs.length > 0 && <RunTable rows={runs} service={service} ctx={ctx} />}
      {value && value.left_out > 0 && <p>{value.left_out} more are left out: serve a folder below.</p>}
    </div>
  );
}

const dateOf = (entry: Entry): string => new Date(entry.modified_s * 1000).toISOString().slice(0, 16).replace("T", " ");

function StudyTable({ rows, service }: { rows: Entry[]; service: Service }) {
  return (
    <table>
      <caption>Studies</caption>
      <thead><tr>{["study", "name", "runs ended", "status", "changed (UTC)"].map((name) => <th scope="col" key={name}>{name}</th>)}</tr></thead>
      <tbody>{rows.map((each) => (
        <tr key={each.id}>
          <td><button class="link" onClick={() => service.openStudy(each.id)}>{each.id}</button></td><td>{each.name}</td>
          <td>{each.ended ?? "–"} of {each.planned ?? "–"}</td><td>{each.status.replaceAll("_", " ")}</td><td>{dateOf(each)}</td>
        </tr>
      ))}</tbody>
    </table>
  );
}

function RunTable({ rows, service, ctx }: { rows: Entry[]; service: Service; ctx: Context }) {
  const kinds = [...new Set(rows.flatMap((each) => Object.keys(each.plugins ?? {})))];
  const { path } = ctx.ui;
  return (
    <table>
      <caption>Runs</caption>
      <thead><tr>{["run", "compare", "scenario", "status", "makespan s", ...kinds, "changed (UTC)"].map((name) => <th scope="col" key={name}>{name.replaceAll("_", " ")}</th>)}</tr></thead>
      <tbody>{rows.map((each) => (
        <tr key={each.id} aria-current={each.id === path ? "true" : undefined}>
          <td>{each.bytes === null && !each.is_live ? each.id : <button class="link" onClick={() => service.openPath(each.id)}>{each.id}</button>}</td>
          <td>{path && each.id !== path && !each.is_live && each.bytes !== null && <button onClick={() => service.openPath(path, each.id)}>with {path}</button>}</td>
          <td>{each.name}</td><td>{each.is_live ? "● live" : each.status.replaceAll("_", " ")}</td><td class="number">{number(each.makespan_s, 7)}</td>
          {kinds.map((kind) => <td key={kind}>{each.plugins?.[kind] ?? ""}</td>)}
          <td>{dateOf(each)}</td>
        </tr>
      ))}</tbody>
    </table>
  );
}

const isOn = (job: Job): boolean => job.state === "queued" || job.state === "running";

export function JobList({ service }: { service: Service }) {
  const { value, error, again } = usePolled<Jobs>(() => service.api.jobs(), 1000);
  const jobs = [...(value?.jobs ?? [])].reverse().slice(0, 8);
  if (error) return <p role="alert" class="fault">{error}</p>;
  if (!jobs.length) return null;
  return (
    <table>
      <caption>Started here, the last first</caption>
      <thead><tr>{["run", "state", "progress", "", ""].map((name, i) => <th scope="col" key={i}>{name || <span class="hidden">actions</span>}</th>)}</tr></thead>
      <tbody>{jobs.map((job) => (
        <tr key={job.id}>
          <td>{job.name}</td>
          <td>{job.state === "ended" ? (job.status ?? "ended").replaceAll("_", " ") : job.state}{job.message && `: ${job.message}`}</td>
          <td><Progress job={job} /></td>
          <td>{(job.state === "running" || job.state === "ended") && <button onClick={() => service.openPath(job.run, "", job.state === "running" ? "replay" : "overview")}>{job.state === "running" ? "Watch" : "Open"}</button>}</td>
          <td>{isOn(job) && <button onClick={() => void service.api.cancel(job.id).then(again, (failure: unknown) => service.say(wordsOf(failure)))}>Cancel</button>}</td>
        </tr>
      ))}</tbody>
    </table>
  );
}

function Progress({ job }: { job: Job }) {
  if (!job.progress) return <>{job.ran_s === null ? "" : `${number(job.ran_s)} s`}</>;
  const { tasks, tasks_ended, simulated_s } = job.progress;
  return <><progress max={tasks} value={tasks_ended} aria-label={`progress of ${job.name}`} /> {tasks_ended} of {tasks} tasks, at {number(simulated_s)} s</>;
}
