/** A workflow: tasks by node, dependencies by size, the binding chain. */

import { count, number, seconds } from "../draw/format";
import { layered } from "../draw/layers";
import { fitted, type Painter } from "../draw/painter";
import { chainSets } from "./names";
import type { Box, Context, View } from "./view";

function placed(ctx: Context, box: Box): { x: (task: number) => number; y: (task: number) => number; size: number } {
  const dag = ctx.run.dags[ctx.ui.dag] ?? ctx.run.dags[0];
  const own = (all: Int32Array): Int32Array => all.slice(dag.firstEdge, dag.firstEdge + dag.edges).map((task) => task - dag.firstTask);
  const { layer, order, layers } = layered(dag.tasks, own(ctx.run.exSource.data), own(ctx.run.exTarget.data));
  const widest = Math.max(...layers.slice(0, 5000).map((row) => row.length), 1);
  const dx = (box.width - 110) / Math.max(1, layers.length - 1);
  const dy = Math.min(90, (box.height - 70) / widest);
  return {
    x: (task) => 55 + layer[task - dag.firstTask] * dx,
    y: (task) => (box.height - 20) / 2 + order[task - dag.firstTask] * dy,
    size: Math.min(dx * 0.7, 64),
  };
}

function draw(p: Painter, ctx: Context, box: Box): void {
  const { run, colours, ui } = ctx;
  const dag = run.dags[ui.dag] ?? run.dags[0];
  if (!dag) return;
  const at = placed(ctx, box);
  const chain = chainSets(ctx);
  const used = [...new Set(run.tkNode.data.subarray(dag.firstTask, dag.firstTask + dag.tasks))].sort((a, b) => a - b);
  let most = 1e-9;
  for (let x = dag.firstEdge; x < dag.firstEdge + dag.edges; x++) most = Math.max(most, run.exSize.data[x]);
  for (let x = dag.firstEdge; x < dag.firstEdge + dag.edges; x++) {
    const [source, target] = [run.exSource.data[x], run.exTarget.data[x]];
    const isSelected = ui.selection?.kind === "transfer" && ui.selection.id === x;
    const isBinding = chain.transfers.has(x);
    p.line([at.x(source), at.y(source), at.x(target), at.y(target)], {
      stroke: isSelected ? colours.select : isBinding ? colours.bind : colours.muted, width: (isSelected || isBinding ? 2 : 0.6) + run.exSize.data[x] / most, dash: run.isLocal(x) ? [3, 3] : [],
    });
  }
  for (let task = dag.firstTask; task < dag.firstTask + dag.tasks; task++) {
    const [x, y] = [at.x(task), at.y(task)];
    const node = run.tkNode.data[task];
    const category = Math.max(0, used.indexOf(node)) % colours.categories.length;
    const isSelected = ui.selection?.kind === "task" && ui.selection.id === task;
    p.rect(x - at.size / 2, y - 15, at.size, 30, { fill: colours.categories[category], stroke: isSelected ? colours.select : chain.tasks.has(task) ? colours.bind : colours.paper, width: isSelected || chain.tasks.has(task) ? 3 : 1 });
    const ink = colours.onCategory[category];
    p.text(x, y - 6, fitted(run.taskIds[task], at.size - 4), { fill: ink, anchor: "middle", bold: true });
    p.text(x, y + 7, fitted(`on ${run.nodes[node]?.id ?? "–"}`, at.size - 4, 10), { fill: ink, size: 10, anchor: "middle" });
  }
  p.text(16, box.height - 14, `${dag.id}: colour and text say the node; dotted: both ends on one node; thick outline and line: the binding chain`, { fill: colours.muted, size: 11 });
}

export const dag: View = {
  id: "dag",
  title: "DAG",
  summary: (ctx) => `Workflow ${ctx.run.dags[ctx.ui.dag]?.id ?? ""} of ${count(ctx.run.dags[ctx.ui.dag]?.tasks ?? 0, "task")}, one of ${count(ctx.run.dags.length, "DAG")}`,
  draw,
  hit(ctx, box, x, y) {
    const row = ctx.run.dags[ctx.ui.dag] ?? ctx.run.dags[0];
    if (!row) return null;
    const at = placed(ctx, box);
    for (let task = row.firstTask; task < row.firstTask + row.tasks; task++) {
      if (Math.abs(at.x(task) - x) < at.size / 2 && Math.abs(at.y(task) - y) < 15) return { kind: "task", id: task };
    }
    return null;
  },
  table(ctx) {
    const { run } = ctx;
    const row = run.dags[ctx.ui.dag] ?? run.dags[0];
    const first = row?.firstEdge ?? 0;
    return {
      columns: ["from", "to", "MB", "from node", "to node", "arrived s"],
      rows: Array.from({ length: row?.edges ?? 0 }, (_, i) => first + i).map((x) => [run.taskIds[run.exSource.data[x]], run.taskIds[run.exTarget.data[x]], number(run.exSize.data[x]),
        run.nodes[run.tkNode.data[run.exSource.data[x]]]?.id ?? null, run.nodes[run.tkNode.data[run.exTarget.data[x]]]?.id ?? null, seconds(run.isLocal(x) ? run.createdAt(x) : run.servedTo(x))]),
      pick: (index) => ({ kind: "transfer", id: first + index }),
    };
  },
};
