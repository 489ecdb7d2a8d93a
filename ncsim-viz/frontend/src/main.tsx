/** The page: tabs, one view, the playhead's bar, and what is selected. */

import { render } from "preact";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { Cursor } from "./data/cursor";
import { embeddedExtras, embeddedTrace, loadRun, type Extras } from "./data/load";
import type { Run } from "./data/run";
import { K } from "./data/run";
import { timeOf } from "./draw/axis";
import { csvOf, seconds } from "./draw/format";
import { Lanes } from "./draw/lanes";
import { CanvasPainter, SvgPainter } from "./draw/painter";
import { paletteOf } from "./draw/palette";
import { fromHash, hashOf, START, Store, type LaneMode, type Ui } from "./state";
import "./style.css";
import { cascade } from "./views/cascade";
import { dag } from "./views/dag";
import { gantt } from "./views/gantt";
import { exists, nameOf, nowText, TRANSFER_COLUMNS, transferRow } from "./views/names";
import { overview } from "./views/overview";
import { rates } from "./views/rates";
import { compare, events, parameters } from "./views/tables";
import { topology } from "./views/topology";
import type { Context, View } from "./views/view";

const VIEWS: View[] = [overview, gantt, topology, rates, cascade, dag, compare, events, parameters];
const store = new Store({ ...START, ...fromHash(location.hash) });

function useUi(): Ui {
  const [ui, set] = useState(store.ui);
  useEffect(() => store.subscribe(() => set(store.ui)), []);
  return ui;
}

const isDark = (ui: Ui): boolean => (ui.theme === "auto" ? matchMedia("(prefers-color-scheme: dark)").matches : ui.theme === "dark");

function save(name: string, type: string, data: BlobPart): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([data], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function svgOf(view: View, ctx: Context, width: number, height: number): string {
  const painter = new SvgPainter();
  view.draw?.(painter, ctx, { width, height });
  return painter.document(width, height, ctx.colours.paper, view.summary(ctx));
}

function Drawing({ view, ctx }: { view: View; ctx: Context }) {
  const holder = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [size, setSize] = useState({ width: 900, height: 500 });
  const drag = useRef<{ x: number; window: [number, number]; moved: boolean } | null>(null);
  useEffect(() => {
    const element = holder.current as HTMLDivElement;
    const watch = new ResizeObserver(() => setSize({ width: element.clientWidth, height: element.clientHeight }));
    watch.observe(element);
    return () => watch.disconnect();
  }, []);
  const box = { width: size.width, height: Math.max(size.height - 4, view.height?.(ctx, size.width) ?? 0) };
  useEffect(() => {
    const element = canvas.current as HTMLCanvasElement;
    const ratio = Math.min(2, devicePixelRatio || 1);
    element.width = box.width * ratio;
    element.height = box.height * ratio;
    const pen = element.getContext("2d") as CanvasRenderingContext2D;
    pen.scale(ratio, ratio);
    pen.fillStyle = ctx.colours.paper;
    pen.fillRect(0, 0, box.width, box.height);
    view.draw?.(new CanvasPainter(pen), ctx, box);
  });
  const zoom = (factor: number, x: number): void => {
    const scale = view.scale?.(ctx, box);
    if (!scale) return;
    const at = timeOf(scale, x);
    const whole: [number, number] = [0, Math.max(1, ctx.run.end)];
    const from = Math.max(0, at - (at - scale.from) * factor);
    const to = Math.min(whole[1], at + (scale.to - at) * factor);
    if (to - from >= 10) ctx.set({ window: from <= 0 && to >= whole[1] ? null : [from, to] });
  };
  useEffect(() => {
    const element = canvas.current as HTMLCanvasElement;
    const wheel = (event: WheelEvent): void => {
      if (!view.scale || (box.height > size.height && !event.ctrlKey && !event.altKey)) return;
      event.preventDefault();
      zoom(event.deltaY > 0 ? 1.25 : 0.8, event.offsetX);
    };
    element.addEventListener("wheel", wheel, { passive: false });
    return () => element.removeEventListener("wheel", wheel);
  });
  return (
    <div class="drawing" ref={holder} tabIndex={0}>
      <canvas ref={canvas} role="img" aria-label={view.summary(ctx)} style={{ width: `${box.width}px`, height: `${box.height}px` }}
        onPointerDown={(event) => { drag.current = { x: event.offsetX, window: ctx.window, moved: false }; }}
        onPointerMove={(event) => {
          const scale = view.scale?.(ctx, box);
          if (!drag.current || !scale || !(event.buttons & 1)) return;
          const dx = event.offsetX - drag.current.x;
          if (Math.abs(dx) < 4 && !drag.current.moved) return;
          drag.current.moved = true;
          const [from, to] = drag.current.window;
          const shift = Math.max(-from, Math.min(ctx.run.end - to, (-dx / (scale.right - scale.left)) * (to - from)));
          ctx.set({ window: [from + shift, to + shift] });
        }}
        onPointerUp={(event) => {
          const moved = drag.current?.moved;
          drag.current = null;
          if (!moved) ctx.select(view.hit?.(ctx, box, event.offsetX, event.offsetY) ?? null);
        }} />
    </div>
  );
}

function Rows({ view, ctx }: { view: View; ctx: Context }) {
  const table = useMemo(() => view.table(ctx), [view, ctx.ui.event, ctx.ui.window, ctx.ui.search, ctx.ui.selection, ctx.ui.dag]);
  const [top, setTop] = useState(0);
  const first = Math.max(0, Math.floor(top / 26) - 10);
  const shown = table.rows.slice(first, first + 80);
  return (
    <div class="rows" tabIndex={0} onScroll={(event) => setTop(event.currentTarget.scrollTop)}>
      {table.note && <p>{table.note}</p>}
      <table aria-rowcount={table.rows.length}>
        <caption>{view.title}: {table.rows.length} rows</caption>
        <thead><tr>{table.columns.map((each) => <th scope="col" key={each}>{each}</th>)}</tr></thead>
        <tbody>
          <tr aria-hidden="true" style={{ height: `${first * 26}px` }} />
          {shown.map((row, i) => {
            const pick = table.pick?.(first + i);
            return (
              <tr key={first + i}>{row.map((cell, k) => (
                <td key={k}>{k === 0 && pick ? <button class="link" onClick={() => ctx.select(pick)}>{cell}</button> : cell}</td>
              ))}</tr>
            );
          })}
          <tr aria-hidden="true" style={{ height: `${Math.max(0, table.rows.length - first - 80) * 26}px` }} />
        </tbody>
      </table>
    </div>
  );
}

function Selected({ ctx }: { ctx: Context }) {
  const { selection } = ctx.ui;
  if (!selection || !exists(ctx.run, selection)) return null;
  const { run } = ctx;
  const { id, kind } = selection;
  let facts: [string, string][] = [];
  if (kind === "transfer") facts = TRANSFER_COLUMNS.map((name, i) => [name, String(transferRow(run, id)[i] ?? "–")]);
  if (kind === "task") facts = [["node", run.nodes[run.tkNode.data[id]]?.id ?? "–"], ["ready s", seconds(run.readyAt(id))], ["started s", seconds(run.startedAt(id))], ["ended s", seconds(run.endedAt(id))]];
  if (kind === "link") {
    const link = run.links[id];
    facts = [["from", run.nodes[link.source].id], ["to", run.nodes[link.target].id], ["clean MB/s", String(link.bandwidth)], ["medium", link.medium],
      ["shares the channel with", String(ctx.extras.relations?.contenders[id]?.length ?? "not recorded")], ["hidden interferers", String(ctx.extras.relations?.hidden[id]?.length ?? "not recorded")]];
  }
  if (kind === "node") facts = [["capacity units/s", String(run.nodes[id].capacity)], ["waiting now", String(ctx.cursor.queued[id])]];
  return (
    <aside aria-label="Selection">
      <h2>{nameOf(run, selection)}</h2>
      <dl>{facts.map(([name, value]) => <div key={name}><dt>{name}</dt><dd>{value}</dd></div>)}</dl>
      <button onClick={() => ctx.select(null)}>Clear (Esc)</button>
    </aside>
  );
}

function App({ run, other, extras }: { run: Run; other: Run | null; extras: Extras }) {
  const ui = useUi();
  const cursor = useMemo(() => new Cursor(run), [run]);
  const cache = useRef(new Map<string, Lanes>());
  const view = VIEWS.find((each) => each.id === ui.view) ?? overview;
  cursor.seek(ui.event);
  const goTo = (event: number): void => {
    const at = Math.max(-1, Math.min(run.events - 1, event));
    store.set({ event: at, time: at < 0 ? 0 : run.evTime.data[at] });
  };
  const ctx: Context = {
    run, other, extras, ui, cursor, colours: paletteOf(isDark(ui) ? "dark" : "light"),
    window: ui.window ?? [0, Math.max(1, run.end)],
    lanesOf: (mode: LaneMode) => {
      const key = `${mode}${ui.byLoad}`;
      const found = cache.current.get(key) ?? new Lanes(run, mode, ui.byLoad);
      cache.current.set(key, found);
      return found;
    },
    set: (change) => store.set(change),
    goTo,
    select: (selection) => {
      store.set({ selection });
      if (selection?.kind === "recalc") goTo(run.rcEvent.data[selection.id]);
    },
  };
  useEffect(() => {
    document.documentElement.dataset.theme = ctx.colours.name;
    try {
      history.replaceState(null, "", `#${hashOf(ui)}`);
    } catch { /* an iframe without an address */ }
  });
  useEffect(() => {
    if (!ui.playing) return;
    let last = performance.now();
    let frame = requestAnimationFrame(function step(now: number) {
      const time = store.ui.time + ((now - last) / 1000 / store.ui.replaySeconds) * run.end;
      last = now;
      if (time >= run.end) store.set({ time: run.end, event: run.events - 1, playing: false });
      else {
        store.set({ time, event: run.eventAt(time) });
        frame = requestAnimationFrame(step);
      }
    });
    return () => cancelAnimationFrame(frame);
  }, [ui.playing]);
  useEffect(() => {
    const otherTime = (step: 1 | -1): void => {
      let at = store.ui.event + step;
      const now = run.timeOf(store.ui.event);
      while (at >= 0 && at < run.events - 1 && run.evTime.data[at] === now) at += step;
      goTo(at);
    };
    const trigger = (step: 1 | -1): void => {
      let at = store.ui.event + step;
      while (at >= 0 && at < run.events && run.evKind.data[at] !== K.recalc) at += step;
      if (at >= 0 && at < run.events) ctx.select({ kind: "recalc", id: run.evArg.data[at] });
    };
    const key = (event: KeyboardEvent): void => {
      if ((event.target as HTMLElement).matches("input, select, textarea") || event.ctrlKey || event.metaKey) return;
      const { ui: now } = store;
      const [from, to] = now.window ?? [0, run.end];
      const zoomed = (factor: number): [number, number] => {
        const middle = (from + to) / 2;
        return [Math.max(0, middle - ((to - from) / 2) * factor), Math.min(run.end, middle + ((to - from) / 2) * factor)];
      };
      const actions: Record<string, () => void> = {
        " ": () => play(), ArrowRight: () => (event.shiftKey ? otherTime(1) : goTo(now.event + 1)),
        ArrowLeft: () => (event.shiftKey ? otherTime(-1) : goTo(now.event - 1)),
        "[": () => trigger(-1), "]": () => trigger(1), "+": () => store.set({ window: zoomed(0.5) }), "-": () => store.set({ window: zoomed(2) }),
        "0": () => store.set({ window: null }), c: () => store.set({ chain: !now.chain }), x: () => store.set({ conflicts: !now.conflicts }),
        d: () => store.set({ theme: isDark(now) ? "light" : "dark" }), t: () => store.set({ asTable: !now.asTable }),
        "?": () => store.set({ help: !now.help }), Escape: () => store.set({ selection: null, help: false }),
      };
      const action = actions[event.key] ?? (/^[1-9]$/.test(event.key) ? () => store.set({ view: VIEWS[Number(event.key) - 1].id }) : undefined);
      if (!action || (event.key === " " && (event.target as HTMLElement).matches("button"))) return;
      event.preventDefault();
      action();
    };
    addEventListener("keydown", key);
    return () => removeEventListener("keydown", key);
  });
  const play = (): void => {
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) return goTo(store.ui.event + 1);
    if (store.ui.event >= run.events - 1) goTo(-1);
    store.set({ playing: !store.ui.playing });
  };
  Object.assign(window, { ncsimViewer: { run, goTo, state: () => ({
    event: cursor.at, running: Array.from(cursor.running), queued: Array.from(cursor.queued),
    active: [...cursor.active].sort((a, b) => a - b).map((x) => [x, cursor.rateOf(x)]),
  }), seek: (event: number) => cursor.seek(event), svg: (id: string) => svgOf(VIEWS.find((each) => each.id === id) ?? overview, ctx, 1200, 700) } });
  const asTable = ui.asTable || !view.draw;
  const size = (): [number, number] => [1200, Math.max(700, view.height?.(ctx, 1200) ?? 0)];
  const png = (): void => {
    const [width, height] = size();
    const sheet = document.createElement("canvas");
    sheet.width = width * 2;
    sheet.height = height * 2;
    const pen = sheet.getContext("2d") as CanvasRenderingContext2D;
    pen.scale(2, 2);
    pen.fillStyle = ctx.colours.paper;
    pen.fillRect(0, 0, width, height);
    view.draw?.(new CanvasPainter(pen), ctx, { width, height });
    sheet.toBlob((blob) => { if (blob) save(`${view.id}.png`, "image/png", blob); });
  };
  return (
    <>
      <header>
        <h1>{run.header?.scenario || "ncsim run"}</h1><span class="status">{run.status.replaceAll("_", " ")}</span>
        <button onClick={() => store.set({ theme: isDark(ui) ? "light" : "dark" })}>Theme (d)</button>
        <button aria-expanded={ui.help} onClick={() => store.set({ help: !ui.help })}>Help (?)</button>
      </header>
      <nav aria-label="Views">{VIEWS.map((each, i) => (
        <button key={each.id} aria-current={each.id === view.id ? "page" : undefined} onClick={() => store.set({ view: each.id })}>{i + 1} {each.title}</button>
      ))}</nav>
      <div class="tools">
        {view.draw && <button aria-pressed={ui.asTable} onClick={() => store.set({ asTable: !ui.asTable })}>Show as table (t)</button>}
        {view.id === "gantt" && <label>Lanes <select value={ui.lanes} onChange={(event) => store.set({ lanes: event.currentTarget.value as LaneMode })}>
          {["node", "link", "dag", "transfer"].map((mode) => <option key={mode} value={mode}>{mode}</option>)}</select></label>}
        {view.id === "gantt" && <label><input type="checkbox" checked={ui.byLoad} onChange={() => store.set({ byLoad: !ui.byLoad })} /> busiest first</label>}
        {view.id === "gantt" && <label><input type="checkbox" checked={ui.chain} onChange={() => store.set({ chain: !ui.chain })} /> binding chain (c)</label>}
        {view.id === "topology" && <label><input type="checkbox" checked={ui.load} onChange={() => store.set({ load: !ui.load })} /> route load</label>}
        {view.id === "dag" && run.dags.length > 1 && <label>DAG <select value={String(ui.dag)} onChange={(event) => store.set({ dag: Number(event.currentTarget.value) })}>
          {run.dags.map((row, i) => <option key={i} value={String(i)}>{row.id}</option>)}</select></label>}
        {view.id === "events" && <label>Filter <input type="search" value={ui.search} onInput={(event) => store.set({ search: event.currentTarget.value })} /></label>}
        <span class="push" />
        {view.draw && <button onClick={() => save(`${view.id}.svg`, "image/svg+xml", svgOf(view, ctx, ...size()))}>SVG</button>}
        {view.draw && <button onClick={png}>PNG</button>}
        <button onClick={() => { const table = view.table(ctx); save(`${view.id}.csv`, "text/csv", csvOf(table.columns, table.rows)); }}>CSV</button>
      </div>
      <main>
        {asTable ? <Rows view={view} ctx={ctx} /> : <Drawing key={view.id} view={view} ctx={ctx} />}
        <Selected ctx={ctx} />
      </main>
      <footer>
        <button onClick={() => goTo(ui.event - 1)} aria-label="One event back">◀</button>
        <button onClick={play}>{ui.playing ? "Pause" : "Play"}</button>
        <button onClick={() => goTo(ui.event + 1)} aria-label="One event on">▶</button>
        <input type="range" aria-label="Playhead" min={-1} max={run.events - 1} value={ui.event} onInput={(event) => goTo(Number(event.currentTarget.value))} />
        <label>whole run in <input type="number" min={1} max={600} value={ui.replaySeconds} onChange={(event) => store.set({ replaySeconds: Math.max(1, Number(event.currentTarget.value) || 20) })} /> s</label>
        <span class="now" aria-live={ui.playing ? "off" : "polite"}>{nowText(ctx)}</span>
        {ui.window && <button onClick={() => store.set({ window: null })}>whole run (0)</button>}
      </footer>
      {ui.help && <dialog open><h2>Keys</h2><p>1–9 views · space play · ← → event · shift+← → next time · [ ] recalculation · + − 0 zoom · c binding chain · x conflicts · t table · d theme · Esc clear</p>
        <p>Drag moves the window of time; ctrl+wheel zooms it; a click selects.</p><button onClick={() => store.set({ help: false })}>Close</button></dialog>}
    </>
  );
}

async function boot(): Promise<void> {
  const root = document.getElementById("app") as HTMLElement;
  const bytes = embeddedTrace(0);
  if (!bytes) {
    root.textContent = "This page holds no run. Make a report with: ncsim view RUN -o report.html";
    return;
  }
  try {
    const second = embeddedTrace(1);
    const [run, extras, other] = await Promise.all([loadRun(bytes), embeddedExtras(), second ? loadRun(second) : null]);
    const { event, selection } = store.ui;
    const at = Math.min(event < 0 && !location.hash ? run.events - 1 : event, run.events - 1);
    store.set({ event: at, time: at < 0 ? 0 : run.evTime.data[at], selection: selection && exists(run, selection) ? selection : null });
    render(<App run={run} other={other} extras={extras} />, root);
    requestAnimationFrame(() => { document.documentElement.dataset.ready = String(Math.round(performance.now())); });
  } catch (error) {
    root.textContent = `This run cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
  }
}
void boot();
