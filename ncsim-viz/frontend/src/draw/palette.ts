/** Colours, passed to drawing code as data: canvases must not read them from CSS. */

export interface Palette {
  name: "light" | "dark";
  paper: string; panel: string; ink: string; muted: string; grid: string; lane: string;
  accent: string; select: string; bind: string; bad: string;
  /** Okabe-Ito; by category, further ones are told apart by hatching. */
  categories: string[];
  /** Text on each of the categories. */
  onCategory: string[];
}

const OKABE_ITO = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#F0E442", "#999999"];
const ON = ["#ffffff", "#000000", "#ffffff", "#000000", "#000000", "#ffffff", "#000000", "#000000"];

export const LIGHT: Palette = {
  name: "light", paper: "#ffffff", panel: "#f5f6f8", ink: "#1b1f24", muted: "#57606a", grid: "#d8dde3",
  lane: "#f5f6f8", accent: "#0b62a8", select: "#d1006c", bind: "#111111", bad: "#b3261e",
  categories: OKABE_ITO, onCategory: ON,
};
export const DARK: Palette = {
  name: "dark", paper: "#14171b", panel: "#1d2126", ink: "#e8eaed", muted: "#a4adb8", grid: "#363c44",
  lane: "#1a1e23", accent: "#6cb6ff", select: "#ff6bb3", bind: "#ffffff", bad: "#ff8a80",
  categories: ["#3d9bdc", "#E69F00", "#1fb88a", "#CC79A7", "#7cc8f2", "#ee7733", "#F0E442", "#a8a8a8"],
  onCategory: ["#000000", "#000000", "#000000", "#000000", "#000000", "#000000", "#000000", "#000000"],
};

export const paletteOf = (name: "light" | "dark"): Palette => (name === "dark" ? DARK : LIGHT);

/** Cividis, sampled: readable without colour vision, monotone in lightness. */
const CIVIDIS = ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55", "#fee838"];

export function magnitude(share: number): string {
  const at = Math.max(0, Math.min(CIVIDIS.length - 1, Math.round(share * (CIVIDIS.length - 1))));
  return CIVIDIS[at];
}
export const onMagnitude = (share: number): string => (share > 0.5 ? "#000000" : "#ffffff");

/** A hex colour as a pixel of little-endian ImageData. */
export function pixelOf(colour: string): number {
  const value = parseInt(colour.slice(1), 16);
  return ((255 << 24) | ((value & 0xff) << 16) | (value & 0xff00) | (value >> 16)) >>> 0;
}
