/** The page: tabs, one view, what is selected, and the playhead. */

import { useEffect, useReducer } from "preact/hooks";
import { Configure } from "../configure/configure";
import { Runs } from "../server/runs";
import type { Service } from "../server/service";
import { hashOf } from "../state";
import type { Context, View } from "../views/view";
import { Drawing } from "./drawing";
import { Help } from "./help";
import { Inspector } from "./inspector";
import { actionOf, belongsToField } from "./keys";
import { isDark, type Page } from "./page";
import { Playbar } from "./playbar";
import { playing } from "./replay";
import { Rows } from "./rows";
import { Tools } from "./tools";
import { viewsOf } from "./views";

const ADDRESS_ms = 120;

export function App({ page, service }: { page: Page; service: Service | null }) {
  const [, redraw] = useReducer((count: number) => count + 1, 0);
  useEffect(() => page.store.subscribe(() => redraw(0)), [page]);
  const ctx = page.context();
  const { ui } = ctx;
  const views = viewsOf(ctx, service);
  const view = views.find((each) => each.id === ui.view) ?? views[0];
  useAddress(page);
  useTheme(ctx);
  useEffect(() => (ui.playing ? playing(page) : undefined), [ui.playing]);
  useKeys(page, views);
  return (
    <>
      <Header ctx={ctx} service={service} />
      <nav aria-label="Views">{views.map((each) => (
        <button key={each.id} aria-current={each.id === view.id ? "page" : undefined} onClick={() => page.store.set({ view: each.id })}>
          <kbd>{each.key}</kbd> {each.title}
        </button>
      ))}</nav>
      <Body view={view} ctx={ctx} page={page} service={service} />
      {ui.help && <Help close={() => page.store.set({ help: false })} />}
    </>
  );
}

function Header({ ctx, service }: { ctx: Context; service: Service | null }) {
  const { ui, run, set } = ctx;
  const title = run.header?.scenario || ctx.extras.study?.name || service?.title || "ncsim run";
  return (
    <header>
      <h1 title={title}>{title}</h1>
      {run.header && <span class="status">{run.isLive ? "live" : run.status.replaceAll("_", " ")}</span>}
      {service?.note && <span class="note" role="status">{service.note}</span>}
      <span class="push" />
      <button onClick={() => set({ theme: isDark(ui) ? "light" : "dark" })}>Theme (d)</button>
      <button aria-expanded={ui.help} onClick={() => set({ help: !ui.help })}>Help (?)</button>
    </header>
  );
}

function Body({ view, ctx, page, service }: { view: View; ctx: Context; page: Page; service: Service | null }) {
  if (service && view.id === "configure") return <main><Configure service={service} /></main>;
  if (service && view.id === "runs") return <main><Runs service={service} ctx={ctx} /></main>;
  const hasRun = ctx.run.header !== null;
  return (
    <>
      <Tools view={view} ctx={ctx} />
      <main>
        {isTable(view, ctx) ? <Rows key={view.id} view={view} ctx={ctx} version={page.version} /> : <Drawing key={view.id} view={view} ctx={ctx} page={page} />}
        <Inspector ctx={ctx} />
      </main>
      {hasRun && <Playbar ctx={ctx} page={page} />}
    </>
  );
}

const isTable = (view: View, ctx: Context): boolean => ctx.ui.asTable || !view.draw || (view.isTable?.(ctx) ?? false);

/** The state follows into the address, a little later so that a drag does not flood it, and back. */
function useAddress(page: Page): void {
  useEffect(() => {
    let timer = 0;
    const write = (): void => {
      timer = 0;
      try {
        history.replaceState(null, "", `#${hashOf(page.store.ui)}`);
      } catch { /* an iframe without an address */ }
    };
    return page.store.subscribe(() => {
      if (!timer) timer = window.setTimeout(write, ADDRESS_ms);
    });
  }, [page]);
}

function useTheme(ctx: Context): void {
  useEffect(() => {
    document.documentElement.dataset.theme = ctx.colours.name;
  }, [ctx.colours]);
  useEffect(() => {
    const query = matchMedia("(prefers-color-scheme: dark)");
    const follow = (): void => ctx.set({});
    query.addEventListener("change", follow);
    return () => query.removeEventListener("change", follow);
  }, []);
}

function useKeys(page: Page, views: View[]): void {
  useEffect(() => {
    const listen = (event: KeyboardEvent): void => {
      if (belongsToField(event) && event.key !== "Escape") return;
      const action = actionOf(event, page, views);
      if (!action) return;
      event.preventDefault();
      action();
    };
    addEventListener("keydown", listen);
    return () => removeEventListener("keydown", listen);
  });
}
