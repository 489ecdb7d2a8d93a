/** The playhead: step, play, speed, and what happens now in words. */

import { number, seconds } from "../draw/format";
import { nowText } from "../views/names";
import type { Context } from "../views/view";
import { DraftInput } from "./draft";
import type { Page } from "./page";
import { play, wantsLessMotion } from "./replay";
import { Strip } from "./strip";

/** How many seconds of the run pass in one second of the replay. */
export const speedOf = (end_us: number, replaySeconds: number): string => `× ${number(end_us / 1e6 / replaySeconds, 3)}`;

export function Playbar({ ctx, page }: { ctx: Context; page: Page }) {
  const { ui, run, set } = ctx;
  return (
    <footer>
      <Strip ctx={ctx} page={page} />
      <div class="line">
        <button onClick={() => page.goTo(ui.event - 1)} aria-label="One event back">◀</button>
        <button onClick={() => play(page)}>{wantsLessMotion() ? "Step" : ui.playing ? "Pause" : "Play"}</button>
        <button onClick={() => page.goTo(ui.event + 1)} aria-label="One event on">▶</button>
        <input type="range" aria-label="Playhead, by event" aria-valuetext={nowText(ctx)} min={-1} max={run.events - 1} value={ui.event}
          onInput={(event) => page.goTo(Number(event.currentTarget.value))} />
        <label>whole run in <DraftInput marks={{ type: "number", min: "1", max: "3600" }} placeholder="" value={String(ui.replaySeconds)}
          commit={(text) => set({ replaySeconds: Math.max(1, Math.min(3600, Number(text) || 20)) })} /> s</label>
        <span class="muted" title="seconds of the run per second of the replay">{speedOf(run.end, ui.replaySeconds)}</span>
        <label title="play the window again and again"><input type="checkbox" checked={ui.loop} onChange={() => set({ loop: !ui.loop })} /> loop (l)</label>
        {ui.window && <button onClick={() => set({ window: null })} title={`${seconds(ui.window[0])} to ${seconds(ui.window[1])} s`}>Whole run (0)</button>}
        <span class="now" aria-live={ui.playing ? "off" : "polite"} title={nowText(ctx)}>{nowText(ctx)}</span>
      </div>
    </footer>
  );
}
