/** The whole run in one strip below every view: what goes on, the window that all views show, the playhead. */

import { useEffect, useRef } from "preact/hooks";
import { activityOf, type Activity } from "../draw/activity";
import { seconds } from "../draw/format";
import { FONT } from "../draw/painter";
import type { Context } from "../views/view";
import { penOf, useSize } from "./drawing";
import type { Page } from "./page";

const BINS = 600;
const HEIGHT = 40;

function area(pen: CanvasRenderingContext2D, values: Float64Array, most: number, width: number): void {
  pen.beginPath();
  pen.moveTo(0, HEIGHT);
  values.forEach((value, i) => {
    const y = HEIGHT - (value / most) * (HEIGHT - 15);
    pen.lineTo((i / values.length) * width, y);
    pen.lineTo(((i + 1) / values.length) * width, y);
  });
  pen.lineTo(width, HEIGHT);
  pen.closePath();
}

function draw(pen: CanvasRenderingContext2D, ctx: Context, activity: Activity, width: number): void {
  const { colours, ui, run } = ctx;
  const most = Math.max(1e-9, activity.tasks.reduce((a, b) => Math.max(a, b), 0), activity.transfers.reduce((a, b) => Math.max(a, b), 0));
  pen.fillStyle = colours.panel;
  pen.fillRect(0, 0, width, HEIGHT);
  area(pen, activity.transfers, most, width);
  pen.fillStyle = colours.categories[4];
  pen.globalAlpha = 0.55;
  pen.fill();
  pen.globalAlpha = 1;
  area(pen, activity.tasks, most, width);
  pen.strokeStyle = colours.ink;
  pen.lineWidth = 1;
  pen.stroke();
  pen.font = `10px ${FONT}`;
  pen.textBaseline = "top";
  pen.fillStyle = colours.muted;
  pen.fillText("transfers in service (area), running tasks (line); drag: window of all views", 8, 3);
  const x = (time: number): number => (time / Math.max(1, run.end)) * width;
  if (ui.window) {
    pen.fillStyle = colours.paper;
    pen.globalAlpha = 0.7;
    pen.fillRect(0, 0, x(ui.window[0]), HEIGHT);
    pen.fillRect(x(ui.window[1]), 0, width, HEIGHT);
    pen.globalAlpha = 1;
    pen.strokeStyle = colours.accent;
    pen.lineWidth = 2;
    pen.strokeRect(x(ui.window[0]), 1, x(ui.window[1]) - x(ui.window[0]), HEIGHT - 2);
  }
  pen.fillStyle = colours.select;
  pen.fillRect(x(ui.time) - 1, 0, 2, HEIGHT);
}

export function Strip({ ctx, page }: { ctx: Context; page: Page }) {
  const [holder, size] = useSize({ width: 900, height: HEIGHT });
  const canvas = useRef<HTMLCanvasElement>(null);
  const drag = useRef<{ from: number; moved: boolean } | null>(null);
  const activity = ctx.memo("activity", [], () => activityOf(ctx.run, BINS));
  useEffect(() => draw(penOf(canvas.current as HTMLCanvasElement, size.width, HEIGHT), ctx, activity, size.width));
  const at = (event: PointerEvent): number => (event.offsetX / Math.max(1, size.width)) * ctx.run.end;
  const window = ctx.ui.window ? `window ${seconds(ctx.ui.window[0])} to ${seconds(ctx.ui.window[1])} s` : "no window";
  return (
    <div class="strip" ref={holder} title="Drag to set the window of time of all views; click to move the playhead">
      <canvas ref={canvas} role="img"
        aria-label={`The whole run: transfers in service (area) and running tasks (line); ${window}; keys + − 0 < > set it`}
        onPointerDown={(event) => {
          drag.current = { from: at(event), moved: false };
          event.currentTarget.setPointerCapture?.(event.pointerId);
        }}
        onPointerMove={(event) => {
          const held = drag.current;
          if (!held || Math.abs(at(event) - held.from) < ctx.run.end / 200) return;
          held.moved = true;
          page.setWindow(Math.min(held.from, at(event)), Math.max(held.from, at(event)));
        }}
        onPointerUp={(event) => {
          const held = drag.current;
          drag.current = null;
          if (!held?.moved) page.goToTime(at(event));
        }} />
    </div>
  );
}
