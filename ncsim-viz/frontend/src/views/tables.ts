/** Views that are tables: Events, Parameters. */

import { seconds } from "../draw/format";
import { kindName, limited, selectionOf, sentence } from "./names";
import type { Cell, View } from "./view";

export const events: View = {
  id: "events", title: "Events", key: "9",
  summary: (ctx) => `${ctx.run.events} events`,
  table(ctx, everything) {
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
      ...limited(shown, (i) => [run.evLine.data[i], seconds(run.evTime.data[i]), kindName(run, i), sentence(run, i)], everything),
      event: (row) => shown[row],
      pick: (row) => selectionOf(run, shown[row]),
    };
  },
};

export const parameters: View = {
  id: "parameters", title: "Parameters", key: "p",
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
