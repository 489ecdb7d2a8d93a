/** Exports: SVG, PNG and CSV of a view, drawn apart from the screen. */

import { csvOf } from "../draw/format";
import { CanvasPainter, SvgPainter, type Painter } from "../draw/painter";
import { boxOf, type Box, type Context, type View } from "../views/view";

const WIDTH = 1200;
const NOTE = 30;
const HEIGHT = 700;
const MAX_SIDE = 16000;
/** Longer drawings are cut there, and say so. */
const MAX_HEIGHT = 12000;

export function save(name: string, type: string, data: BlobPart): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([data], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

interface Sheet { box: Box; height: number; note: string }

/** The whole drawing; of a very long one the beginning, with a note. */
function sheetSize(view: View, ctx: Context): Sheet {
  const whole = Math.ceil(view.height?.(ctx, WIDTH, HEIGHT) ?? HEIGHT);
  if (whole <= MAX_HEIGHT) return { box: boxOf(WIDTH, whole), height: whole, note: "" };
  const share = Math.floor((100 * MAX_HEIGHT) / whole);
  return {
    box: { width: WIDTH, height: whole, top: 0, bottom: MAX_HEIGHT }, height: MAX_HEIGHT + NOTE,
    note: `The first ${share} % of this drawing; narrow the window of time to have less in it.`,
  };
}

function paint(view: View, ctx: Context, painter: Painter, { box, note }: Sheet): void {
  painter.clip(0, 0, box.width, box.bottom, () => {
    view.draw?.(painter, ctx, box);
    view.overlay?.(painter, ctx, box);
  });
  if (note) painter.text(8, box.bottom + NOTE / 2, note, { fill: ctx.colours.ink, size: 13, bold: true });
}

/** A view as an SVG document: the whole drawing, not the part on screen. */
export function svgOf(view: View, ctx: Context): string {
  const sheet = sheetSize(view, ctx);
  const painter = new SvgPainter();
  paint(view, ctx, painter, sheet);
  return painter.document(WIDTH, sheet.height, ctx.colours.paper, view.summary(ctx));
}

/** A view as a canvas at twice the resolution, less where that would be too large. */
export function sheetOf(view: View, ctx: Context): HTMLCanvasElement {
  const size = sheetSize(view, ctx);
  const ratio = Math.min(2, MAX_SIDE / size.height);
  const sheet = document.createElement("canvas");
  sheet.width = WIDTH * ratio;
  sheet.height = size.height * ratio;
  const pen = sheet.getContext("2d") as CanvasRenderingContext2D;
  pen.scale(ratio, ratio);
  pen.fillStyle = ctx.colours.paper;
  pen.fillRect(0, 0, WIDTH, size.height);
  paint(view, ctx, new CanvasPainter(pen), size);
  return sheet;
}

export function savePng(view: View, ctx: Context): void {
  sheetOf(view, ctx).toBlob((blob) => {
    if (blob) save(`${view.id}.png`, "image/png", blob);
  });
}

export function saveCsv(view: View, ctx: Context): void {
  const table = view.table(ctx, true);
  save(`${view.id}.csv`, "text/csv", csvOf(table.columns, table.rows));
}
