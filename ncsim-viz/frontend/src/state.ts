/** What all views share; they are pure functions of it, and it is the hash of the address. */

export type ViewId =
  | "overview" | "gantt" | "topology" | "rates" | "cascade" | "replay" | "dag" | "compare" | "sweep"
  | "configure" | "events" | "parameters";

export type SelectionKind = "task" | "transfer" | "link" | "node" | "recalc";
export interface Selection { kind: SelectionKind; id: number }

export type LaneMode = "node" | "link" | "dag" | "transfer";

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
  fit: boolean;
  dag: number;
  /** Whether the binding chain is outlined. */
  chain: boolean;
  conflicts: boolean;
  load: boolean;
  asTable: boolean;
  theme: "light" | "dark" | "auto";
  playing: boolean;
  /** A replay takes this many seconds for the whole run. */
  replaySeconds: number;
  search: string;
  help: boolean;
}

export const START: Ui = {
  view: "overview", event: -1, time: 0, window: null, selection: null, lanes: "node", byLoad: false, fit: false,
  dag: 0, chain: false, conflicts: true, load: false, asTable: false, theme: "auto", playing: false,
  replaySeconds: 20, search: "", help: false,
};

export const VIEW_IDS: ViewId[] = [
  "overview", "gantt", "topology", "rates", "cascade", "replay", "dag", "compare", "sweep", "configure", "events",
  "parameters",
];
const LANE_MODES: LaneMode[] = ["node", "link", "dag", "transfer"];
const SELECTION_LETTERS: Record<SelectionKind, string> = { task: "t", transfer: "x", link: "l", node: "n", recalc: "r" };

/** The state as the hash of an address, without what is not worth a link. */
export function hashOf(ui: Ui): string {
  const parts = new URLSearchParams();
  parts.set("v", ui.view);
  if (ui.event >= 0) parts.set("e", String(ui.event));
  if (ui.window) parts.set("w", ui.window.map((each) => Math.round(each)).join("-"));
  if (ui.selection) parts.set("s", SELECTION_LETTERS[ui.selection.kind] + ui.selection.id);
  if (ui.lanes !== "node") parts.set("l", ui.lanes);
  if (ui.byLoad) parts.set("o", "1");
  if (ui.fit) parts.set("f", "1");
  if (ui.dag) parts.set("d", String(ui.dag));
  if (ui.chain) parts.set("c", "1");
  if (!ui.conflicts) parts.set("x", "0");
  if (ui.load) parts.set("r", "1");
  if (ui.asTable) parts.set("a", "1");
  if (ui.theme !== "auto") parts.set("t", ui.theme);
  if (ui.search) parts.set("q", ui.search);
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
  const event = whole("e");
  if (event !== null) found.event = event;
  const window = /^(\d+)-(\d+)$/.exec(parts.get("w") ?? "");
  if (window && Number(window[2]) > Number(window[1])) found.window = [Number(window[1]), Number(window[2])];
  const selection = /^([txlnr])(\d+)$/.exec(parts.get("s") ?? "");
  if (selection) {
    const kind = (Object.keys(SELECTION_LETTERS) as SelectionKind[]).find((each) => SELECTION_LETTERS[each] === selection[1]);
    if (kind) found.selection = { kind, id: Number(selection[2]) };
  }
  const lanes = parts.get("l") as LaneMode;
  if (LANE_MODES.includes(lanes)) found.lanes = lanes;
  found.byLoad = parts.get("o") === "1";
  found.fit = parts.get("f") === "1";
  found.dag = whole("d") ?? 0;
  found.chain = parts.get("c") === "1";
  found.conflicts = parts.get("x") !== "0";
  found.load = parts.get("r") === "1";
  found.asTable = parts.get("a") === "1";
  const theme = parts.get("t");
  if (theme === "light" || theme === "dark") found.theme = theme;
  const search = parts.get("q");
  if (search) found.search = search.slice(0, 200);
  return found;
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
