/** Playing: the playhead moves by the clock; with reduced motion it steps instead. */

import type { Page } from "./page";

export const wantsLessMotion = (): boolean => matchMedia("(prefers-reduced-motion: reduce)").matches;

/** Start or stop; where motion is not wanted, take one step. */
export function play(page: Page): void {
  const { ui } = page.store;
  if (wantsLessMotion()) return page.goTo(ui.event + 1);
  const [from, to] = stretch(page);
  if (!ui.playing && (ui.time >= to || ui.time < from)) page.goToTime(from);
  page.store.set({ playing: !ui.playing });
}

/** What is played: the window if it is to be looped, else the whole run. */
export function stretch(page: Page): [number, number] {
  const { ui } = page.store;
  return ui.loop && ui.window ? ui.window : [0, page.run.end];
}

/** Where the playhead stands after some wall time; null once the end is reached. */
export function moved(page: Page, wall_ms: number): number | null {
  const { ui } = page.store;
  const [from, to] = stretch(page);
  const time = ui.time + (wall_ms / 1000 / ui.replaySeconds) * page.run.end;
  if (time < to) return Math.max(from, time);
  return ui.loop ? from : null;
}

/** Play until stopped; returns what stops it. */
export function playing(page: Page): () => void {
  let last = performance.now();
  let frame = requestAnimationFrame(function step(now: number) {
    const time = moved(page, Math.max(0, now - last));
    last = now;
    if (time === null) {
      page.goTo(page.run.events - 1);
      page.store.set({ playing: false });
      return;
    }
    page.goToTime(time);
    frame = requestAnimationFrame(step);
  });
  return () => cancelAnimationFrame(frame);
}
