/** Start: a report shows what is inside it, a served page what its server has. */

import { render } from "preact";
import { App } from "./app/app";
import { EMPTY, Page } from "./app/page";
import { sheetOf, svgOf } from "./app/save";
import { RUN_VIEWS } from "./app/views";
import { embeddedExtras, embeddedTrace, loadRun } from "./data/load";
import { serverInfo } from "./server/api";
import { Service } from "./server/service";
import { fromHash, START, Store } from "./state";
import "./style.css";
import { sweep } from "./views/sweep";

const page = new Page(new Store({ ...START, ...fromHash(location.hash) }));

/** What tests and scripts ask of a page. */
function offer(service: Service | null): void {
  const viewOf = (id: string) => [...RUN_VIEWS, sweep].find((each) => each.id === id) ?? RUN_VIEWS[0];
  Object.assign(window, { ncsimViewer: {
    page, service,
    get run() { return page.run; },
    goTo: (event: number) => page.goTo(event),
    seek: (event: number) => page.cursor.seek(event),
    state: () => ({
      event: page.cursor.at, running: Array.from(page.cursor.running), queued: Array.from(page.cursor.queued),
      active: [...page.cursor.active].sort((a, b) => a - b).map((x) => [x, page.cursor.rateOf(x)]),
    }),
    view: (id: string) => viewOf(id),
    svg: (id: string) => svgOf(viewOf(id), page.context()),
    sheet: (id: string) => sheetOf(viewOf(id), page.context()),
  } });
}

async function fill(): Promise<Service | null> {
  const info = serverInfo();
  if (info) {
    const service = new Service(info, page);
    const { path, study, view } = page.store.ui;
    if (!path && !study && view !== "configure") page.store.set({ view: "runs" });
    await service.follow();
    return service;
  }
  const [bytes, second] = [embeddedTrace(0), embeddedTrace(1)];
  const [run, extras, other] = await Promise.all([bytes ? loadRun(bytes) : EMPTY.run, embeddedExtras(), second ? loadRun(second) : null]);
  if (!bytes && !extras.study) throw new Error("the page holds no run. Make a report with: ncsim view RUN -o report.html");
  page.open({ run, other, extras });
  if (!bytes) page.store.set({ view: "sweep" });
  return null;
}

async function boot(): Promise<void> {
  const root = document.getElementById("app") as HTMLElement;
  try {
    const service = await fill();
    offer(service);
    root.textContent = "";
    render(<App page={page} service={service} />, root);
    addEventListener("hashchange", () => {
      page.store.set(fromHash(location.hash));
      page.goTo(page.store.ui.event);
    });
    requestAnimationFrame(() => { document.documentElement.dataset.ready = String(Math.round(performance.now())); });
  } catch (error) {
    root.textContent = `Nothing can be shown: ${error instanceof Error ? error.message : String(error)}`;
  }
}
void boot();
