/** What all views share; they are pure functions of it, and it is the hash of the address. */

export const VIEW_IDS = [
  "overview", "gantt", "topology", "rates", "cascade", "replay", "dag", "compare", "events", "parameters", "sweep",
  "configure", "runs",
] as const;
export type ViewId = (typeof VIEW_IDS)[number];

export type SelectionKind = "task" | "transfer" | "link" | "node" | "recalc" | "row";
export interface Selection { kind: SelectionKind; id: number }

export const LANE_MODES = ["node", "link", "dag", "transfer"] as const;
export type LaneMode = (typeof LANE_MODES)[number];

/** Columns, rows and measure of a heat map. */
export type Heat = [string, string, string];

export interface MapPart { scale: number; x: number; y: number }

export interface Ui {
  view: ViewId;
  /** Event that has just happened; -1 before the first. */
  event: number;
  /** Instant of the playhead: within a replay it lies between events. */
  time: number;
  /** Window of time that all views show; null is the whole run. */
  window: [number, number] | null;
  selection: Selection | null;
  lanes: LaneMode;
  /** Lanes in order of what they carry, busiest first. */
  byLoad: boolean;
  /** Whether all lanes are pressed into the height of the screen. */
  fit: boolean;
  /** How the map is enlarged, and what is in its middle as parts of its size; null shows all of it. */
  map: MapPart | null;
  /** DAG number; -1 shows every DAG. */
  dag: number;
  /** Whether the binding chain is outlined. */
  chain: boolean;
  conflicts: boolean;
  load: boolean;
  asTable: boolean;
  theme: "light" | "dark" | "auto";
  playing: boolean;
  /** Whether a replay starts again at the end of the window. */
  loop: boolean;
  /** A replay takes this many seconds for the whole run. */
  replaySeconds: number;
  search: string;
  help: boolean;
  /** Run that a server shows, by its path; empty in a report. */
  path: string;
  /** Run that it is compared with. */
  against: string;
  /** Study that a server shows. */
  study: string;
  /** Part of a study that is shown. */
  sheet: number;
  /** Two factors and the measure of a study's maps and curves. */
  heat: Heat | null;
}

export const START: Ui = {
  view: "overview", event: -1, time: 0, window: null, selection: null, lanes: "node", byLoad: false, fit: false, map: null,
  dag: 0, chain: false, conflicts: true, load: false, asTable: false, theme: "auto", playing: false, loop: false,
  replaySeconds: 20, search: "", help: false, path: "", against: "", study: "", sheet: 0, heat: null,
};

export const MAX_SCALE = 40;

const LETTERS: Record<SelectionKind, string> = { task: "t", transfer: "x", link: "l", node: "n", recalc: "r", row: "w" };
const FLAGS = [["o", "byLoad"], ["f", "fit"], ["c", "chain"], ["r", "load"], ["a", "asTable"], ["y", "loop"]] as const;
const TEXTS = [["q", "search"], ["p", "path"], ["b", "against"], ["u", "study"]] as const;

/** The state as the hash of an address, without what is not worth a link. */
export function hashOf(ui: Ui): string {
  const parts = new URLSearchParams();
  parts.set("v", ui.view);
  if (ui.event >= 0) parts.set("e", String(ui.event));
  if (ui.window) parts.set("w", ui.window.map((each) => Math.round(each)).join("-"));
  if (ui.selection) parts.set("s", LETTERS[ui.selection.kind] + ui.selection.id);
  if (ui.lanes !== "node") parts.set("l", ui.lanes);
  if (ui.dag) parts.set("d", ui.dag < 0 ? "all" : String(ui.dag));
  if (ui.map) parts.set("z", [ui.map.scale, ui.map.x, ui.map.y].map((each) => each.toFixed(3)).join("_"));
  if (!ui.conflicts) parts.set("x", "0");
  if (ui.theme !== "auto") parts.set("t", ui.theme);
  if (ui.replaySeconds !== START.replaySeconds) parts.set("n", String(ui.replaySeconds));
  if (ui.sheet) parts.set("h", String(ui.sheet));
  if (ui.heat) parts.set("m", JSON.stringify(ui.heat));
  for (const [letter, name] of FLAGS) if (ui[name]) parts.set(letter, "1");
  for (const [letter, name] of TEXTS) if (ui[name]) parts.set(letter, ui[name]);
  return parts.toString();
}

/** What a hash says; whatever it gets wrong is left out. */
export function fromHash(hash: string): Partial<Ui> {
  const parts = new URLSearchParams(hash.replace(/^#/, ""));
  const found: Partial<Ui> = {};
  const whole = (key: string): number | null => {
    const text = parts.get(key);
    return text !== null && /^\d{1,15}$/.test(text) ? Number(text) : null;
  };
  const view = parts.get("v") as ViewId;
  if (VIEW_IDS.includes(view)) found.view = view;
  found.event = whole("e") ?? START.event;
  const window = /^(\d+)-(\d+)$/.exec(parts.get("w") ?? "");
  found.window = window && Number(window[2]) > Number(window[1]) ? [Number(window[1]), Number(window[2])] : null;
  found.selection = selectionIn(parts.get("s") ?? "");
  const lanes = parts.get("l") as LaneMode;
  found.lanes = LANE_MODES.includes(lanes) ? lanes : START.lanes;
  found.dag = parts.get("d") === "all" ? -1 : (whole("d") ?? 0);
  found.map = mapIn(parts.get("z") ?? "");
  found.conflicts = parts.get("x") !== "0";
  const theme = parts.get("t");
  if (theme === "light" || theme === "dark") found.theme = theme;
  found.replaySeconds = Math.max(1, Math.min(3600, whole("n") ?? START.replaySeconds));
  found.sheet = whole("h") ?? 0;
  found.heat = heatIn(parts.get("m"));
  for (const [letter, name] of FLAGS) found[name] = parts.get(letter) === "1";
  for (const [letter, name] of TEXTS) found[name] = (parts.get(letter) ?? "").slice(0, 500);
  return found;
}

function selectionIn(text: string): Selection | null {
  const found = /^([txlnrw])(\d{1,15})$/.exec(text);
  const kinds = Object.keys(LETTERS) as SelectionKind[];
  const kind = found ? kinds.find((each) => LETTERS[each] === found[1]) : undefined;
  return found && kind ? { kind, id: Number(found[2]) } : null;
}

function mapIn(text: string): MapPart | null {
  const [scale, x, y] = text.split("_").map(Number);
  const isPart = [scale, x, y].every((each) => Number.isFinite(each)) && scale > 1 && Math.abs(x) <= 1 && Math.abs(y) <= 1;
  return isPart ? { scale: Math.min(scale, MAX_SCALE), x, y } : null;
}

function heatIn(text: string | null): Heat | null {
  try {
    const found: unknown = JSON.parse(text ?? "null");
    const isHeat = Array.isArray(found) && found.length === 3 && found.every((each) => typeof each === "string");
    return isHeat ? (found as Heat) : null;
  } catch {
    return null;
  }
}

type Listener = () => void;

export class Store {
  private listeners = new Set<Listener>();

  constructor(public ui: Ui) {}

  set(change: Partial<Ui>): void {
    this.ui = { ...this.ui, ...change };
    for (const listener of this.listeners) listener();
  }

  subscribe(listener: Listener): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }
}
