/** A view on screen: a still canvas, a moving one above it, and the mouse. */

import { useEffect, useRef, useState } from "preact/hooks";
import { timeOf, type Scale } from "../draw/axis";
import { CanvasPainter } from "../draw/painter";
import type { MapPart } from "../state";
import { nameOf } from "../views/names";
import type { Box, Context, View } from "../views/view";
import { WHOLE_MAP, type Page } from "./page";

interface Size { width: number; height: number }
type Layer = "draw" | "overlay";

const CLICK_px = 4;

/** Size of an element, followed. */
export function useSize(start: Size): [{ current: HTMLDivElement | null }, Size] {
  const holder = useRef<HTMLDivElement>(null);
  const [size, setSize] = useState(start);
  useEffect(() => {
    const element = holder.current as HTMLDivElement;
    const watch = new ResizeObserver(() => setSize({ width: element.clientWidth, height: element.clientHeight }));
    watch.observe(element);
    return () => watch.disconnect();
  }, []);
  return [holder, size];
}

/** A cleared pen over a canvas of some size in CSS pixels; the canvas is only made anew if the size has changed. */
export function penOf(element: HTMLCanvasElement, width: number, height: number): CanvasRenderingContext2D {
  const ratio = Math.min(2, devicePixelRatio || 1);
  const [w, h] = [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
  if (element.width !== w || element.height !== h) {
    element.width = w;
    element.height = h;
  }
  const pen = element.getContext("2d") as CanvasRenderingContext2D;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  return pen;
}

function paint(element: HTMLCanvasElement, view: View, ctx: Context, box: Box, layer: Layer): void {
  const pen = penOf(element, box.width, box.bottom - box.top);
  if (layer === "draw") {
    pen.fillStyle = ctx.colours.paper;
    pen.fillRect(0, 0, box.width, box.bottom - box.top);
  }
  pen.translate(0, -box.top);
  view[layer]?.(new CanvasPainter(pen), ctx, box);
}

/** Everything that the still layer may depend on. */
function stillKey(ctx: Context, page: Page, view: View, box: Box): unknown[] {
  const { ui } = ctx;
  return [view.id, page.version, box.width, box.height, box.top, box.bottom, ui.window, ui.selection, ui.lanes, ui.byLoad,
    ui.fit, ui.map, ui.dag, ui.chain, ui.conflicts, ui.load, ui.sheet, ui.heat, ctx.colours, ctx.extras];
}

export function Drawing({ view, ctx, page }: { view: View; ctx: Context; page: Page }) {
  const [holder, size] = useSize({ width: 900, height: 500 });
  const [top, setTop] = useState(0);
  const still = useRef<HTMLCanvasElement>(null);
  const moving = useRef<HTMLCanvasElement>(null);
  const drawn = useRef<unknown[]>([]);
  const [tip, setTip] = useState<{ x: number; y: number; text: string } | null>(null);
  const height = Math.max(size.height, Math.ceil(view.height?.(ctx, size.width, size.height) ?? 0));
  const from = Math.min(top, height - size.height);
  const box: Box = { width: size.width, height, top: from, bottom: from + size.height };
  useEffect(() => {
    const key = stillKey(ctx, page, view, box);
    if (key.some((each, i) => each !== drawn.current[i])) {
      drawn.current = key;
      paint(still.current as HTMLCanvasElement, view, ctx, box, "draw");
    }
    paint(moving.current as HTMLCanvasElement, view, ctx, box, "overlay");
  });
  useWheel(moving, (event) => {
    const scale = view.scale?.(ctx, box);
    const factor = event.deltaY > 0 ? 1.25 : 0.8;
    if (view.isMap) {
      event.preventDefault();
      return page.zoomMap(1 / factor, event.offsetX / box.width - 0.5, event.offsetY / box.height - 0.5);
    }
    if (!scale || (height > size.height && !event.ctrlKey && !event.altKey)) return;
    event.preventDefault();
    page.zoom(factor, timeOf(scale, event.offsetX));
  });
  const mouse = useMouse(view, ctx, page, box, setTip);
  return (
    <div class="drawing" ref={holder} tabIndex={0} aria-label={`${view.title}: drawing`} role="group"
      onScroll={(event) => setTop(event.currentTarget.scrollTop)}>
      <div class="sheet" style={{ height: `${height}px` }}>
        <div class="glass" style={{ height: `${size.height}px` }}>
          <canvas ref={still} role="img" aria-label={view.summary(ctx)} />
          <canvas ref={moving} aria-hidden="true" {...mouse} />
          {tip && <div class="tip" style={placeOf(tip, size)}>{tip.text}</div>}
        </div>
      </div>
    </div>
  );
}

function placeOf(tip: { x: number; y: number }, size: Size): Record<string, string> {
  const side: Record<string, string> = tip.x > size.width / 2 ? { right: `${size.width - tip.x + 12}px` } : { left: `${tip.x + 14}px` };
  return tip.y > size.height / 2 ? { ...side, bottom: `${size.height - tip.y + 10}px` } : { ...side, top: `${tip.y + 14}px` };
}

function useWheel(canvas: { current: HTMLCanvasElement | null }, wheel: (event: WheelEvent) => void): void {
  const latest = useRef(wheel);
  latest.current = wheel;
  useEffect(() => {
    const element = canvas.current as HTMLCanvasElement;
    const listen = (event: WheelEvent): void => latest.current(event);
    element.addEventListener("wheel", listen, { passive: false });
    return () => element.removeEventListener("wheel", listen);
  }, []);
}

interface Drag { x: number; y: number; window: [number, number]; map: MapPart; scale: Scale | null; isBrush: boolean; moved: boolean }

/** Drag moves the window, shift and drag brushes one, a click selects, a still mouse asks. */
function useMouse(view: View, ctx: Context, page: Page, box: Box, setTip: (tip: { x: number; y: number; text: string } | null) => void) {
  const drag = useRef<Drag | null>(null);
  const ask = (x: number, y: number): void => {
    const text = view.tip?.(ctx, box, x, y + box.top) ?? hitName(view, ctx, box, x, y + box.top);
    setTip(text ? { x, y, text } : null);
  };
  return {
    onPointerDown: (event: PointerEvent) => {
      const scale = view.scale?.(ctx, box) ?? null;
      setTip(null);
      if ((!scale && !view.isMap) || event.button !== 0) return;
      drag.current = { x: event.offsetX, y: event.offsetY, window: ctx.window, map: ctx.ui.map ?? WHOLE_MAP, scale, isBrush: event.shiftKey && scale !== null, moved: false };
      (event.currentTarget as HTMLElement).setPointerCapture?.(event.pointerId);
    },
    onPointerMove: (event: PointerEvent) => {
      const held = drag.current;
      if (!held || !(event.buttons & 1)) return ask(event.offsetX, event.offsetY);
      const dx = event.offsetX - held.x;
      const dy = event.offsetY - held.y;
      if (Math.abs(dx) < CLICK_px && Math.abs(dy) < CLICK_px && !held.moved) return;
      held.moved = true;
      if (!held.scale) return page.panMap(held.map, dx / box.width, dy / box.height);
      if (held.isBrush) return brush(page, held, event.offsetX);
      const [from, to] = held.window;
      page.pan(from, to, (-dx / (held.scale.right - held.scale.left)) * (to - from));
    },
    onPointerUp: (event: PointerEvent) => {
      const held = drag.current;
      drag.current = null;
      if (!held?.moved) ctx.select(view.hit?.(ctx, box, event.offsetX, event.offsetY + box.top) ?? null);
      else if (held.isBrush) zoomToBrush(page, held, event.offsetX);
    },
    onPointerLeave: () => setTip(null),
  };
}

const hitName = (view: View, ctx: Context, box: Box, x: number, y: number): string => {
  const found = view.hit?.(ctx, box, x, y);
  return found ? nameOf(ctx.run, found) : "";
};

/** While brushing, the playhead follows, so that the far end is seen in words and numbers. */
function brush(page: Page, held: Drag, x: number): void {
  if (held.scale) page.goToTime(timeOf(held.scale, x));
}

function zoomToBrush(page: Page, held: Drag, x: number): void {
  if (!held.scale) return;
  const ends = [timeOf(held.scale, held.x), timeOf(held.scale, x)].sort((a, b) => a - b);
  page.setWindow(ends[0], ends[1]);
}
