/** The row of settings above a view, and its exports. */

import { LANE_MODES, type Heat, type LaneMode, type Ui } from "../state";
import { heatOf, sheetOf, sheetsOf } from "../views/sweep";
import type { Context, View } from "../views/view";
import { saveCsv, savePng, save, svgOf } from "./save";

type Flag = "byLoad" | "fit" | "chain" | "load" | "conflicts";

const FLAGS: Partial<Record<View["id"], [Flag, string][]>> = {
  gantt: [["byLoad", "busiest first"], ["fit", "all lanes on screen"], ["chain", "binding chain (c)"]],
  dag: [["chain", "only the binding chain in colour (c)"]],
  topology: [["load", "route load"], ["conflicts", "conflicts of a link (x)"]],
};

export function Tools({ view, ctx }: { view: View; ctx: Context }) {
  const { ui, set } = ctx;
  return (
    <div class="tools" role="toolbar" aria-label={`${view.title}: settings and exports`}>
      {view.draw && <button aria-pressed={ui.asTable} onClick={() => set({ asTable: !ui.asTable })}>Table (t)</button>}
      {view.id === "gantt" && (
        <label>Lanes by <select value={ui.lanes} onChange={(event) => set({ lanes: event.currentTarget.value as LaneMode })}>
          {LANE_MODES.map((mode) => <option key={mode} value={mode}>{mode}</option>)}
        </select></label>
      )}
      {FLAGS[view.id]?.map(([flag, words]) => (
        <label key={flag}><input type="checkbox" checked={ui[flag]} onChange={() => set({ [flag]: !ui[flag] } as Partial<Ui>)} /> {words}</label>
      ))}
      {view.id === "dag" && <DagChoice ctx={ctx} />}
      {view.id === "sweep" && <StudyChoice ctx={ctx} />}
      {view.id === "events" && (
        <label>Filter (/) <input type="search" value={ui.search} onInput={(event) => set({ search: event.currentTarget.value })} /></label>
      )}
      <span class="push" />
      <Exports view={view} ctx={ctx} />
    </div>
  );
}

function DagChoice({ ctx }: { ctx: Context }) {
  const { run, ui, set } = ctx;
  if (run.dags.length < 2) return null;
  return (
    <label>DAG <select value={String(ui.dag)} onChange={(event) => set({ dag: Number(event.currentTarget.value) })}>
      <option value="-1">all {run.dags.length}</option>
      {run.dags.map((row, i) => <option key={i} value={String(i)}>{row.id}</option>)}
    </select></label>
  );
}

/** Which part of a study is shown, and over which factors. */
function StudyChoice({ ctx }: { ctx: Context }) {
  const { study } = ctx.extras;
  if (!study) return null;
  const sheet = sheetOf(ctx);
  const heat = heatOf(study, ctx.ui.heat);
  const pairs = study.groups.filter((each) => each.by.length === 2);
  const names = [...new Set(pairs.flatMap((each) => each.by))];
  const measures = [...new Set(pairs.map((each) => each.measure))];
  return (
    <>
      {sheetsOf(study).map(([id, title], i) => (
        <button key={id} aria-pressed={id === sheet} onClick={() => ctx.set({ sheet: i })}>{title}</button>
      ))}
      {(sheet === "heat" || sheet === "curves") && heat && (["across", sheet === "heat" ? "down" : "a line for each", "mean of"] as const).map((words, k) => (
        <label key={words}>{words} <select value={heat[k]} onChange={(event) => ctx.set({ heat: changed(heat, k, event.currentTarget.value) })}>
          {(k === 2 ? measures : names).map((name) => <option key={name} value={name}>{name.replaceAll("_", " ")}</option>)}
        </select></label>
      ))}
    </>
  );
}

/** Choosing the other axis' factor swaps the two. */
function changed(heat: Heat, at: number, name: string): Heat {
  const [x, y, measure] = heat;
  if (at === 2) return [x, y, name];
  if (at === 0) return name === y ? [y, x, measure] : [name, y, measure];
  return name === x ? [y, x, measure] : [x, name, measure];
}

export function Exports({ view, ctx }: { view: View; ctx: Context }) {
  return (
    <>
      {view.draw && <button onClick={() => save(`${view.id}.svg`, "image/svg+xml", svgOf(view, ctx))}>SVG</button>}
      {view.draw && <button onClick={() => savePng(view, ctx)}>PNG</button>}
      <button onClick={() => saveCsv(view, ctx)}>CSV</button>
    </>
  );
}
