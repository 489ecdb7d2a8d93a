/** Which views a page has: what it can show decides. */

import type { Service } from "../server/service";
import { cascade } from "../views/cascade";
import { compare } from "../views/compare";
import { dag } from "../views/dag";
import { gantt } from "../views/gantt";
import { overview } from "../views/overview";
import { rates } from "../views/rates";
import { replay } from "../views/replay";
import { sweep } from "../views/sweep";
import { events, parameters } from "../views/tables";
import { topology } from "../views/topology";
import type { Context, View } from "../views/view";

export const RUN_VIEWS: View[] = [overview, gantt, topology, rates, cascade, replay, dag, compare, events, parameters];

/** A screen that draws itself. */
const screen = (id: View["id"], title: string, key: string): View =>
  ({ id, title, key, summary: () => title, table: () => ({ columns: [], rows: [] }) });

const configure = screen("configure", "New run", "n");
const runs = screen("runs", "Runs", "r");

export function viewsOf(ctx: Context, service: Service | null): View[] {
  const shown: View[] = ctx.run.header || ctx.ui.path ? [...RUN_VIEWS] : [];
  if (ctx.extras.study) shown.push(sweep);
  if (!service) return shown.length ? shown : [parameters];
  return service.canRun ? [...shown, configure, runs] : [...shown, runs];
}
