/** What is selected, in numbers, and what it waited for: causes can be followed backwards. */

import type { Run } from "../data/run";
import { number, seconds } from "../draw/format";
import type { Selection } from "../state";
import { causeOf, exists, nameOf } from "../views/names";
import type { Cell, Context } from "../views/view";

type Fact = [string, string];

export function Inspector({ ctx }: { ctx: Context }) {
  const { selection } = ctx.ui;
  if (!selection || !exists(ctx.run, selection, ctx.extras.study?.runs.rows.length)) return null;
  const { openRow } = ctx;
  return (
    <aside aria-label="Selection">
      <h2>{nameOf(ctx.run, selection)}</h2>
      <dl>{factsOf(ctx, selection).map(([name, value]) => <div key={name}><dt>{name}</dt><dd>{value}</dd></div>)}</dl>
      <Causes ctx={ctx} selection={selection} />
      {selection.kind === "row" && openRow && <button onClick={() => openRow(selection.id)}>Run it again and open</button>}
      <button onClick={() => ctx.select(null)}>Clear (Esc)</button>
    </aside>
  );
}

function Causes({ ctx, selection }: { ctx: Context; selection: Selection }) {
  const causes = causesOf(ctx.run, selection);
  if (!causes.length) return null;
  return (
    <ul class="causes">{causes.map(([words, cause]) => (
      <li key={words}>{words} <button class="link" onClick={() => ctx.select(cause)}>{nameOf(ctx.run, cause)}</button></li>
    ))}</ul>
  );
}

/** What had to happen before: the last input, the task before on the node, the producer, the trigger. */
export function causesOf(run: Run, { kind, id }: Selection): [string, Selection][] {
  if (kind === "transfer") {
    const found: [string, Selection][] = [
      ["data of", { kind: "task", id: run.exSource.data[id] }], ["awaited by", { kind: "task", id: run.exTarget.data[id] }],
    ];
    const steps = run.stepsOf(id);
    if (steps.length) found.push(["last rate from", { kind: "recalc", id: run.stRecalc.data[steps[steps.length - 1]] }]);
    return found;
  }
  if (kind === "recalc") return [["trigger:", { kind: "transfer", id: run.rcBy.data[id] }]];
  if (kind !== "task" || Number.isNaN(run.startedAt(id))) return [];
  const before = run.startedAt(id) > run.readyAt(id) ? taskBefore(run, id) : -1;
  if (before >= 0) return [["waited in the queue for", { kind: "task", id: before }]];
  const last = lastInput(run, id);
  return last < 0 ? [] : [["waited for", { kind: "transfer", id: last }]];
}

function taskBefore(run: Run, task: number): number {
  let best = -1;
  for (let each = 0; each < run.tasks; each++) {
    if (run.tkNode.data[each] !== run.tkNode.data[task] || run.tkStart.data[each] >= run.tkStart.data[task] || run.tkStart.data[each] < 0) continue;
    if (best < 0 || run.tkStart.data[each] > run.tkStart.data[best]) best = each;
  }
  return best;
}

function lastInput(run: Run, task: number): number {
  let best = -1;
  let latest = -Infinity;
  for (let x = 0; x < run.transfers; x++) {
    if (run.exTarget.data[x] !== task) continue;
    const at = run.arrivedAt(x);
    if (at > latest) [best, latest] = [x, at];
  }
  return best;
}

function factsOf(ctx: Context, { kind, id }: Selection): Fact[] {
  switch (kind) {
    case "transfer": return transferFacts(ctx.run, id);
    case "task": return taskFacts(ctx.run, id);
    case "link": return linkFacts(ctx, id);
    case "node": return [["capacity", `${number(ctx.run.nodes[id].capacity)} units/s`], ["tasks placed here", String(ctx.marks.tasks.size)], ["waiting now", String(ctx.cursor.queued[id])]];
    case "row": return rowFacts(ctx, id);
    case "recalc": return [["cause", causeOf(ctx.run, id)], ["at", `${seconds(ctx.run.timeOf(ctx.run.rcEvent.data[id]))} s`], ["transfers whose rate moved", String(ctx.marks.transfers.size)]];
  }
}

const shown = (cell: Cell | undefined): string => (typeof cell === "number" ? number(cell, 8) : String(cell ?? "–"));

function rowFacts(ctx: Context, id: number): Fact[] {
  const runs = ctx.extras.study?.runs;
  return (runs?.columns ?? []).map((name, i): Fact => [name, shown(runs?.rows[id]?.[i])]).filter(([, value]) => value !== "–");
}

const nodeName = (run: Run, node: number): string => run.nodes[node]?.id ?? "–";

function taskFacts(run: Run, id: number): Fact[] {
  const wait = run.startedAt(id) - run.readyAt(id);
  return [
    ["node", nodeName(run, run.tkNode.data[id])], ["cost", `${number(run.tkCost.data[id])} units`],
    ["ready", `${seconds(run.readyAt(id))} s`], ["started", `${seconds(run.startedAt(id))} s`],
    ["ended", `${seconds(run.endedAt(id))} s`], ["waited in the queue", `${seconds(wait)} s`],
  ];
}

function transferFacts(run: Run, id: number): Fact[] {
  const from = nodeName(run, run.tkNode.data[run.exSource.data[id]]);
  const to = nodeName(run, run.tkNode.data[run.exTarget.data[id]]);
  const size: Fact = ["size", `${number(run.exSize.data[id])} MB`];
  if (run.isLocal(id)) return [size, ["node", `${from}, nothing is sent`]];
  return [
    size, ["from", from], ["to", to], ["route", Array.from(run.routeOf(id), (link) => run.links[link].id).join(", ") || "–"],
    ["served from", `${seconds(run.servedFrom(id))} s`], ["served to", `${seconds(run.servedTo(id))} s`],
    ["rate alone", `${number(run.soloRate(id))} MB/s`], ["rate changed", `${run.stepsOf(id).length} times`],
  ];
}

function linkFacts(ctx: Context, id: number): Fact[] {
  const { run } = ctx;
  const link = run.links[id];
  const relations = ctx.extras.relations;
  const now = ctx.cursor.active.filter((x) => run.routeOf(x).includes(id));
  return [
    ["from", nodeName(run, link.source)], ["to", nodeName(run, link.target)], ["clean bandwidth", `${number(link.bandwidth)} MB/s`],
    ["medium", link.medium], ["transfers in the run", String(ctx.marks.transfers.size)],
    ["in service now", now.map((x) => `${run.transferName(x)} ${number(ctx.cursor.rateOf(x), 3)} MB/s`).join("; ") || "none"],
    ["shares the channel with", relations ? `${relations.contenders[id]?.length ?? 0} links` : "not recorded"],
    ["hidden interferers", relations ? `${relations.hidden[id]?.length ?? 0} links` : "not recorded"],
  ];
}
