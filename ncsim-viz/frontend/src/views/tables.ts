/** Views that are tables: Compare, Events, Parameters. */

import { seconds } from "../draw/format";
import { kindName, limited, selectionOf, sentence } from "./names";
import type { Cell, View } from "./view";

export const events: View = {
  id: "events", title: "Events",
  summary: (ctx) => `${ctx.run.events} events`,
  table(ctx) {
    const { run, ui } = ctx;
    const wanted = ui.search.toLowerCase();
    const shown: number[] = [];
    for (let i = 0; i < run.events; i++) {
      const at = run.evTime.data[i];
      if (at < ctx.window[0] || at > ctx.window[1]) continue;
      if (wanted && !`${kindName(run, i)} ${sentence(run, i)}`.toLowerCase().includes(wanted)) continue;
      shown.push(i);
    }
    return {
      columns: ["line", "time s", "kind", "what"],
      ...limited(shown, (i) => [run.evLine.data[i], seconds(run.evTime.data[i]), kindName(run, i), sentence(run, i)]),
      pick: (row) => selectionOf(run, shown[row]),
    };
  },
};

export const compare: View = {
  id: "compare", title: "Compare",
  summary: (ctx) => (ctx.extras.comparison ? `Changes from ${ctx.extras.comparison.names.join(" to ")}` : "No second run was given: ncsim view A --compare B"),
  table(ctx) {
    const found = ctx.extras.comparison;
    if (!found) return { columns: ["compare"], rows: [], note: "No second run was given: ncsim view A --compare B -o report.html" };
    const rows: Cell[][] = [
      ...found.differences.map((each): Cell[] => ["setting", each.setting, each.first, each.second, ""]),
      ["makespan s", "", found.makespan_s[0], found.makespan_s[1], found.makespan_ratio === null ? "" : `ratio ${found.makespan_ratio.toFixed(6)}`],
      ...found.tasks.map((each): Cell[] => ["task", each.label, each.nodes[0], each.nodes[1], `${each.ended_us >= 0 ? "+" : ""}${seconds(each.ended_us)} s: ${each.why}`]),
      ...found.transfers.map((each): Cell[] => ["transfer", each.label, each.routes[0].join(" "), each.routes[1].join(" "), `${each.took_us >= 0 ? "+" : ""}${seconds(each.took_us)} s: ${each.why}`]),
      ...found.unmatched.map((each): Cell[] => ["only in one", each, "", "", ""]),
    ];
    return { columns: ["what", "name", ...found.names, "change, second minus first"], rows };
  },
};

export const parameters: View = {
  id: "parameters", title: "Parameters",
  summary: () => "Resolved configuration, plug-ins and hashes",
  table(ctx) {
    const header = ctx.run.header;
    const rows: Cell[][] = [];
    const add = (name: string, value: unknown): void => {
      if (value !== null && typeof value === "object" && !Array.isArray(value) && Object.keys(value).length) {
        for (const [key, each] of Object.entries(value)) add(`${name}.${key}`, each);
      } else rows.push([name, typeof value === "string" ? value : JSON.stringify(value)]);
    };
    for (const key of ["scenario", "scenario_sha256", "seed", "software", "version", "level", "plugins", "sections"] as const) add(key, header?.[key]);
    return { columns: ["parameter", "value"], rows, note: ctx.run.ignored ? `${ctx.run.ignored} records of unknown kinds were ignored.` : undefined };
  },
};
