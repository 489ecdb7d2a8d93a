/** Exports: SVG, PNG and CSV of a view, drawn apart from the screen. */

import { csvOf } from "../draw/format";
import { CanvasPainter, SvgPainter, type Painter } from "../draw/painter";
import { boxOf, type Context, type View } from "../views/view";

const WIDTH = 1200;
const HEIGHT = 700;
const MAX_SIDE = 16000;

export function save(name: string, type: string, data: BlobPart): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([data], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function sizeOf(view: View, ctx: Context): [number, number] {
  return [WIDTH, Math.ceil(view.height?.(ctx, WIDTH, HEIGHT) ?? HEIGHT)];
}

function paint(view: View, ctx: Context, painter: Painter, width: number, height: number): void {
  view.draw?.(painter, ctx, boxOf(width, height));
  view.overlay?.(painter, ctx, boxOf(width, height));
}

/** A view as an SVG document: the whole drawing, not the part on screen. */
export function svgOf(view: View, ctx: Context): string {
  const [width, height] = sizeOf(view, ctx);
  const painter = new SvgPainter();
  paint(view, ctx, painter, width, height);
  return painter.document(width, height, ctx.colours.paper, view.summary(ctx));
}

/** A view as a canvas at twice the resolution, less where that would be too large. */
export function sheetOf(view: View, ctx: Context): HTMLCanvasElement {
  const [width, height] = sizeOf(view, ctx);
  const ratio = Math.min(2, MAX_SIDE / height);
  const sheet = document.createElement("canvas");
  sheet.width = width * ratio;
  sheet.height = height * ratio;
  const pen = sheet.getContext("2d") as CanvasRenderingContext2D;
  pen.scale(ratio, ratio);
  pen.fillStyle = ctx.colours.paper;
  pen.fillRect(0, 0, width, height);
  paint(view, ctx, new CanvasPainter(pen), width, height);
  return sheet;
}

export function savePng(view: View, ctx: Context): void {
  sheetOf(view, ctx).toBlob((blob) => {
    if (blob) save(`${view.id}.png`, "image/png", blob);
  });
}

export function saveCsv(view: View, ctx: Context): void {
  const table = view.table(ctx);
  save(`${view.id}.csv`, "text/csv", csvOf(table.columns, table.rows));
}
