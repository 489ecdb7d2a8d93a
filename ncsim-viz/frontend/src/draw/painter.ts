/** One drawing vocabulary, two back ends: the canvas on screen, and SVG text for export. */

export interface Style { fill?: string; stroke?: string; width?: number; dash?: number[]; alpha?: number }
export interface TextStyle {
  size?: number; fill: string; anchor?: "start" | "middle" | "end"; bold?: boolean; halo?: string; mono?: boolean;
}

export interface Painter {
  rect(x: number, y: number, width: number, height: number, style: Style): void;
  /** An open line through x, y pairs. */
  line(points: ArrayLike<number>, style: Style): void;
  /** A closed area. */
  area(points: ArrayLike<number>, style: Style): void;
  circle(x: number, y: number, radius: number, style: Style): void;
  /** Text with its vertical middle at y. */
  text(x: number, y: number, text: string, style: TextStyle): void;
  clip(x: number, y: number, width: number, height: number, body: () => void): void;
  /** Draw with the origin elsewhere, and turned by some degrees clockwise. */
  shift(x: number, y: number, body: () => void, degrees?: number): void;
  /** Pixels, stretched over a box; both back ends take a canvas. */
  image(x: number, y: number, width: number, height: number, source: HTMLCanvasElement): void;
}

export const FONT = "system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif";
export const MONO = "ui-monospace, 'DejaVu Sans Mono', monospace";

let ruler: CanvasRenderingContext2D | null | undefined;

/** Width of a text; estimated where there is no canvas. */
export function widthOf(text: string, size = 11, bold = false): number {
  if (ruler === undefined) {
    ruler = typeof document === "undefined" ? null : document.createElement("canvas").getContext("2d");
  }
  if (!ruler) return text.length * size * 0.56;
  ruler.font = `${bold ? "600 " : ""}${size}px ${FONT}`;
  return ruler.measureText(text).width;
}

const widths = new Map<string, number>();
const MAX_WIDTHS = 20000;

/** Width of a text, remembered: measuring is what drawing many labels costs. */
function knownWidth(text: string, size: number): number {
  const key = `${size}${text}`;
  let width = widths.get(key);
  if (width === undefined) {
    if (widths.size > MAX_WIDTHS) widths.clear();
    width = widthOf(text, size);
    widths.set(key, width);
  }
  return width;
}

/** Text cut to a width, with an ellipsis; empty if not even two letters fit. */
export function fitted(text: string, width: number, size = 11): string {
  if (width < size) return "";
  if (knownWidth(text, size) <= width) return text;
  let low = 0;
  let high = text.length;
  while (low < high) {
    const middle = (low + high + 1) >>> 1;
    if (widthOf(`${text.slice(0, middle)}…`, size) <= width) low = middle;
    else high = middle - 1;
  }
  return low < 2 ? "" : `${text.slice(0, low)}…`;
}

/** Diagonal lines over a box: never colour alone. */
export function hatch(p: Painter, x: number, y: number, w: number, h: number, colour: string, gap = 5): void {
  p.clip(x, y, w, h, () => {
    for (let at = x - h; at < x + w; at += gap) p.line([at, y + h, at + h, y], { stroke: colour, width: 1 });
  });
}

export class CanvasPainter implements Painter {
  constructor(private c: CanvasRenderingContext2D) {}

  private apply(style: Style, draw: (how: "fill" | "stroke") => void): void {
    const { c } = this;
    c.globalAlpha = style.alpha ?? 1;
    if (style.fill) {
      c.fillStyle = style.fill;
      draw("fill");
    }
    if (style.stroke) {
      c.strokeStyle = style.stroke;
      c.lineWidth = style.width ?? 1;
      c.setLineDash(style.dash ?? []);
      draw("stroke");
    }
    c.globalAlpha = 1;
  }

  rect(x: number, y: number, width: number, height: number, style: Style): void {
    this.apply(style, (how) => (how === "fill" ? this.c.fillRect(x, y, width, height) : this.c.strokeRect(x, y, width, height)));
  }

  private path(points: ArrayLike<number>): void {
    this.c.beginPath();
    for (let i = 0; i < points.length; i += 2) this.c.lineTo(points[i], points[i + 1]);
  }

  line(points: ArrayLike<number>, style: Style): void {
    this.path(points);
    this.apply({ ...style, fill: undefined }, () => this.c.stroke());
  }

  area(points: ArrayLike<number>, style: Style): void {
    this.path(points);
    this.c.closePath();
    this.apply(style, (how) => this.c[how]());
  }

  circle(x: number, y: number, radius: number, style: Style): void {
    this.c.beginPath();
    this.c.arc(x, y, radius, 0, 2 * Math.PI);
    this.apply(style, (how) => this.c[how]());
  }

  text(x: number, y: number, text: string, style: TextStyle): void {
    const { c } = this;
    c.font = `${style.bold ? "600 " : ""}${style.size ?? 11}px ${style.mono ? MONO : FONT}`;
    c.textAlign = style.anchor === "middle" ? "center" : (style.anchor ?? "start");
    c.textBaseline = "middle";
    if (style.halo) {
      c.strokeStyle = style.halo;
      c.lineWidth = 3;
      c.lineJoin = "round";
      c.setLineDash([]);
      c.strokeText(text, x, y);
    }
    c.fillStyle = style.fill;
    c.fillText(text, x, y);
  }

  clip(x: number, y: number, width: number, height: number, body: () => void): void {
    this.c.save();
    this.c.beginPath();
    this.c.rect(x, y, width, height);
    this.c.clip();
    body();
    this.c.restore();
  }

  shift(x: number, y: number, body: () => void, degrees = 0): void {
    this.c.save();
    this.c.translate(x, y);
    this.c.rotate((degrees * Math.PI) / 180);
    body();
    this.c.restore();
  }

  image(x: number, y: number, width: number, height: number, source: HTMLCanvasElement): void {
    this.c.imageSmoothingEnabled = false;
    this.c.drawImage(source, x, y, width, height);
  }
}

/** Text made harmless in markup. */
export function escaped(text: string): string {
  return text
    .replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f\ufffe\uffff]/g, "\ufffd")
    .replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");
}

const short = (value: number): string => String(Math.round(value * 100) / 100);

export class SvgPainter implements Painter {
  private parts: string[] = [];
  private clips = 0;

  private look(style: Style): string {
    let text = ` fill="${style.fill ?? "none"}"`;
    if (style.stroke) {
      text += ` stroke="${style.stroke}"`;
      if (style.width && style.width !== 1) text += ` stroke-width="${short(style.width)}"`;
      if (style.dash?.length) text += ` stroke-dasharray="${style.dash.join(" ")}"`;
    }
    return style.alpha !== undefined && style.alpha < 1 ? `${text} opacity="${short(style.alpha)}"` : text;
  }

  private points(points: ArrayLike<number>): string {
    return Array.from(points, short).join(" ");
  }

  rect(x: number, y: number, width: number, height: number, style: Style): void {
    this.parts.push(`<rect x="${short(x)}" y="${short(y)}" width="${short(Math.max(0, width))}" height="${short(Math.max(0, height))}"${this.look(style)}/>`);
  }

  line(points: ArrayLike<number>, style: Style): void {
    this.parts.push(`<polyline points="${this.points(points)}"${this.look({ ...style, fill: undefined })}/>`);
  }

  area(points: ArrayLike<number>, style: Style): void {
    this.parts.push(`<polygon points="${this.points(points)}"${this.look(style)}/>`);
  }

  circle(x: number, y: number, radius: number, style: Style): void {
    this.parts.push(`<circle cx="${short(x)}" cy="${short(y)}" r="${short(radius)}"${this.look(style)}/>`);
  }

  text(x: number, y: number, text: string, style: TextStyle): void {
    const anchor = style.anchor && style.anchor !== "start" ? ` text-anchor="${style.anchor}"` : "";
    const weight = style.bold ? ' font-weight="600"' : "";
    const family = style.mono ? ` font-family="${escaped(MONO)}"` : "";
    const halo = style.halo ? ` stroke="${style.halo}" stroke-width="3" stroke-linejoin="round" paint-order="stroke"` : "";
    this.parts.push(
      `<text x="${short(x)}" y="${short(y)}" dy="0.35em" font-size="${style.size ?? 11}" fill="${style.fill}"${anchor}${weight}${family}${halo}>${escaped(text)}</text>`,
    );
  }

  clip(x: number, y: number, width: number, height: number, body: () => void): void {
    const id = `c${this.clips++}`;
    this.parts.push(
      `<clipPath id="${id}"><rect x="${short(x)}" y="${short(y)}" width="${short(Math.max(0, width))}" height="${short(Math.max(0, height))}"/></clipPath><g clip-path="url(#${id})">`,
    );
    body();
    this.parts.push("</g>");
  }

  shift(x: number, y: number, body: () => void, degrees = 0): void {
    this.parts.push(`<g transform="translate(${short(x)} ${short(y)})${degrees ? ` rotate(${short(degrees)})` : ""}">`);
    body();
    this.parts.push("</g>");
  }

  image(x: number, y: number, width: number, height: number, source: HTMLCanvasElement): void {
    this.parts.push(
      `<image x="${short(x)}" y="${short(y)}" width="${short(width)}" height="${short(height)}" preserveAspectRatio="none" image-rendering="pixelated" href="${source.toDataURL("image/png")}"/>`,
    );
  }

  document(width: number, height: number, paper: string, title: string): string {
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family="${escaped(FONT)}" role="img"><title>${escaped(title)}</title><rect width="${width}" height="${height}" fill="${paper}"/>${this.parts.join("")}</svg>\n`;
  }
}
