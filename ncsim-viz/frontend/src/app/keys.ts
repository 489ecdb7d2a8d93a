/** The keyboard: everything that the mouse can do. */

import type { View } from "../views/view";
import { isDark, type Page } from "./page";
import { play } from "./replay";

/** Keys and what they do, for the help. */
export const KEYS: [string, string][] = [
  ["1 … 9, p, s, n, r", "open a view; its key stands on its tab"],
  ["space", "play or pause"],
  ["← →", "one event back or on, by sequence"],
  ["shift ← →", "to another instant"],
  ["[ ]", "previous or next recalculation"],
  ["+ − 0", "zoom in, out, whole run; in Topology the map"],
  ["< >", "move the window of time"],
  ["j k", "select the next or previous row of the view"],
  ["b", "window of time = the selection"],
  ["l", "loop over the window"],
  ["c, x", "binding chain, conflicts of a link"],
  ["t, d", "table instead of drawing, dark or light"],
  ["/", "search events"],
  ["Esc", "clear the selection"],
];

type Action = () => void;

/** What a key does in the view that was asked for last, drawn or not yet. */
export function actionOf(event: Pick<KeyboardEvent, "key" | "shiftKey">, page: Page, views: View[]): Action | undefined {
  const { store } = page;
  const { ui } = store;
  const view = views.find((each) => each.id === ui.view) ?? views[0];
  const step = event.shiftKey ? (by: 1 | -1) => page.stepTime(by) : (by: 1 | -1) => page.goTo(ui.event + by);
  const actions: Record<string, Action> = {
    " ": () => play(page),
    ArrowRight: () => step(1),
    ArrowLeft: () => step(-1),
    "[": () => page.stepRecalculation(-1),
    "]": () => page.stepRecalculation(1),
    "+": () => zoom(page, view, 2),
    "=": () => zoom(page, view, 2),
    "-": () => zoom(page, view, 0.5),
    "0": () => store.set(view.isMap ? { map: null } : { window: null }),
    "<": () => slide(page, -0.25),
    ">": () => slide(page, 0.25),
    j: () => nextRow(page, view, 1),
    k: () => nextRow(page, view, -1),
    b: () => brushSelection(page),
    l: () => store.set({ loop: !ui.loop }),
    c: () => store.set({ chain: !ui.chain }),
    x: () => store.set({ conflicts: !ui.conflicts }),
    d: () => store.set({ theme: isDark(ui) ? "light" : "dark" }),
    t: () => store.set({ asTable: !ui.asTable }),
    "?": () => store.set({ help: !ui.help }),
    "/": () => search(page),
    Escape: () => store.set({ selection: null, help: false }),
  };
  const wanted = views.find((each) => each.key === event.key);
  return wanted ? () => store.set({ view: wanted.id }) : actions[event.key];
}

/** Enlarge the map where there is one, else the window of time. */
const zoom = (page: Page, view: View, factor: number): void => (view.isMap ? page.zoomMap(factor) : page.zoom(1 / factor));

function slide(page: Page, share: number): void {
  const [from, to] = page.store.ui.window ?? [0, page.run.end];
  page.pan(from, to, (to - from) * share);
}

function search(page: Page): void {
  page.store.set({ view: "events" });
  requestAnimationFrame(() => document.querySelector<HTMLInputElement>("input[type=search]")?.focus());
}

function nextRow(page: Page, view: View, step: 1 | -1): void {
  const { pick, rows } = view.table(page.context());
  const now = page.store.ui.selection;
  if (!pick || !rows.length) return;
  let at = rows.findIndex((_, i) => {
    const each = pick(i);
    return each !== null && now !== null && each.kind === now.kind && each.id === now.id;
  });
  for (at += at < 0 && step < 0 ? 0 : step; at >= 0 && at < rows.length; at += step) {
    const found = pick(at);
    if (found) return page.select(found);
  }
}

/** The stretch of time that the selection takes. */
function brushSelection(page: Page): void {
  const { run } = page;
  const chosen = page.store.ui.selection;
  if (chosen?.kind === "task") page.setWindow(run.readyAt(chosen.id), run.endedAt(chosen.id) || run.end);
  if (chosen?.kind === "transfer") page.setWindow(run.servedFrom(chosen.id), run.servedTo(chosen.id) || run.end);
}

/** Whether a key is meant for what has the focus. */
export function belongsToField(event: KeyboardEvent): boolean {
  const target = event.target as HTMLElement;
  if (event.ctrlKey || event.metaKey || event.altKey) return true;
  if (target.matches("input:not([type=checkbox]):not([type=range]), select, textarea, [contenteditable]")) return true;
  if (target.matches("input[type=range]") && event.key.startsWith("Arrow")) return true;
  return (event.key === " " || event.key === "Enter") && target.matches("button, a, input, summary");
}
