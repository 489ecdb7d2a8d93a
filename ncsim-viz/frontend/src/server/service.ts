/** What a served page shows: runs and studies by their path, opened when the address names them. */

import type { Page } from "../app/page";
import { EMPTY } from "../app/page";
import type { Extras } from "../data/extras";
import { loadRun } from "../data/load";
import type { Run } from "../data/run";
import type { Study } from "../data/study";
import type { ViewId } from "../state";
import { Api, Refusal, wordsOf, type Job, type ServerInfo } from "./api";
import { Live } from "./live";

const POLL_ms = 500;

export class Service {
  readonly api: Api;
  readonly title: string;
  readonly canRun: boolean;
  /** What goes on or went wrong, for people. */
  note = "";
  private live: Live | null = null;
  private shown = "";
  private study: { id: string; study: Study } | null = null;

  constructor(info: ServerInfo, readonly page: Page) {
    this.api = new Api(info.token);
    this.title = info.title;
    this.canRun = info.can_run;
    page.store.subscribe(() => void this.follow());
    page.openRow = info.can_run ? (row) => void this.runRow(row) : null;
  }

  say(note: string): void {
    this.note = note;
    this.page.store.set({});
  }

  /** Open what the address names, if it is not open yet. */
  async follow(): Promise<void> {
    const { path, against, study } = this.page.store.ui;
    const wanted = JSON.stringify([path, against, study]);
    if (wanted === this.shown) return;
    this.shown = wanted;
    this.live?.close();
    this.live = null;
    this.say(path || study ? "loading …" : "");
    try {
      const found = study ? await this.studyOf(study) : null;
      if (wanted !== this.shown) return;
      if (path) await this.openRun(path, against, found, wanted);
      else this.page.open({ ...EMPTY, extras: found ? { study: found } : {} });
      if (wanted === this.shown) this.say("");
    } catch (error) {
      if (wanted === this.shown) this.say(wordsOf(error));
    }
  }

  openPath(path: string, against = "", first: ViewId = "overview"): void {
    const { view } = this.page.store.ui;
    const isElsewhere = view === "runs" || view === "configure" || view === "sweep";
    this.page.store.set({
      path, against, window: null, selection: null, event: -1, time: 0, playing: false,
      view: against ? "compare" : isElsewhere ? first : view,
    });
  }

  openStudy(study: string): void {
    this.page.store.set({ study, path: "", against: "", view: "sweep", sheet: 0, heat: null, selection: null, window: null, event: -1, time: 0 });
  }

  private async studyOf(id: string): Promise<Study> {
    if (this.study?.id !== id) this.study = { id, study: await this.api.study(id) };
    return this.study.study;
  }

  private async openRun(path: string, against: string, study: Study | null, wanted: string): Promise<void> {
    const { entries } = await this.api.entries();
    if (wanted !== this.shown) return;
    if (entries.some((each) => each.id === path && each.is_live)) return this.openLive(path, study);
    const more = study ? { study } : {};
    const asked = this.api.extras(path, against);
    asked.catch(() => {}); // told below
    const [run, other] = await Promise.all([this.api.trace(path).then(loadRun), against ? this.api.trace(against).then(loadRun) : null]);
    if (wanted !== this.shown) return;
    this.page.open({ run, other, extras: more }); // a large run is seen before all its numbers are there
    const extras = await asked;
    if (wanted === this.shown) this.page.open({ run, other, extras: { ...extras, ...more } });
  }

  private openLive(path: string, study: Study | null): void {
    const { page } = this;
    const extras = study ? { study } : {};
    this.live = new Live((from) => this.api.stream(path, from), {
      opened: (run) => {
        this.lastEvents = run.events;
        page.open({ run, other: null, extras });
      },
      grew: (run) => this.grew(run),
      failed: (words) => this.say(words),
      ended: (run, status) => {
        if (status === "abandoned" || status === "gone") this.say(`the run is ${status}: nothing more will come`);
        void this.complete(path, run, extras);
      },
    });
  }

  /** Add what Python computes of a run that has ended; its folder takes its name a moment after its last record. */
  private async complete(path: string, run: Run, extras: Extras): Promise<void> {
    while (this.page.run === run) {
      try {
        const found = await this.api.extras(path);
        if (this.page.run === run) this.page.open({ run, other: null, extras: { ...found, ...extras } });
        return;
      } catch (error) {
        if (!(error instanceof Refusal && error.status === 409)) return this.say(wordsOf(error));
        await new Promise((resolve) => setTimeout(resolve, POLL_ms));
      }
    }
  }

  /** A playhead at the end stays at the end. */
  private grew(run: Run): void {
    const { page } = this;
    const { event } = page.store.ui;
    const wasAtEnd = event < 0 || event >= this.lastEvents - 1;
    this.lastEvents = run.events;
    page.changed();
    if (wasAtEnd && !page.store.ui.playing) page.goTo(run.events - 1);
    else page.store.set({});
  }
  private lastEvents = 0;

  /** Run a row of the study again, and open it when it has ended. */
  private async runRow(row: number): Promise<void> {
    const { study } = this.page.store.ui;
    try {
      const { yaml } = await this.api.studyScenario(study, row);
      const { job } = await this.api.start(yaml, `${study.split("/").pop() ?? "study"}-${row + 1}`);
      this.say(`running ${job.name} …`);
      const ended = await this.waitFor(job);
      this.say(ended.state === "ended" ? "" : `${job.name}: ${ended.message || ended.state}`);
      if (ended.state === "ended") this.openPath(ended.run);
    } catch (error) {
      this.say(wordsOf(error));
    }
  }

  private async waitFor(job: Job): Promise<Job> {
    for (;;) {
      const found = (await this.api.jobs()).jobs.find((each) => each.id === job.id);
      if (!found || !["queued", "running"].includes(found.state)) return found ?? job;
      await new Promise((resolve) => setTimeout(resolve, POLL_ms));
    }
  }
}
