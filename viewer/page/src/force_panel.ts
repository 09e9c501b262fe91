import { download } from "./download";
import { element } from "./elements";
import { ForceLog } from "./force_log";
import { ForcePlot, union } from "./force_plot";
import { pictureOf } from "./plot_picture";
import type { Frame, Scene, State } from "./protocol";
import { StylusList } from "./stylus_list";
import { currentTheme } from "./theme";

/** Styluses, curves of the force on one or two of them, and what can be taken home of it. */
export class ForcePanel {
  private readonly plots = [new ForcePlot(element("plot"), currentTheme()), new ForcePlot(element("plot-beside"), currentTheme())] as const;
  private readonly titles = [element("plot-title"), element("plot-beside-title")] as const;
  private readonly styluses = new StylusList(element("styluses"), () => this.arrange());
  private log = new ForceLog(1, 0.002);
  private newest: Frame | null = null;
  private shown: number | null = -1;
  private asked = false;
  private frozenAt: number | null = null; // time of the run [s]

  constructor() {
    element("freeze").onclick = () => this.toggleFreeze();
    element("csv").onclick = () => download("irdm-force.csv", new Blob([this.log.csv()], { type: "text/csv" }));
    element("png").onclick = async () => {
      const parts = this.plotted().map((stylus, i) => ({ plot: this.plots[i]!.canvas, title: this.titleOf(stylus) }));
      const picture = await pictureOf(parts, currentTheme());
      if (picture !== null) download("irdm-force.png", picture);
    };
    // A zoom into curves that run away is none.
    for (const id of ["plot", "plot-beside"]) {
      element(id).addEventListener("pointerdown", () => {
        if (this.frozenAt === null) this.toggleFreeze();
      });
    }
  }

  show(scene: Scene): void {
    this.newest = null;
    this.log = new ForceLog(scene.styluses.length, scene.dt);
    this.styluses.show(scene);
    this.arrange();
  }

  /** Another run has another past. */
  showState(state: State): void {
    const shown = state.playback === null ? -1 : state.playback.recording;
    if (shown !== this.shown) this.log.clear();
    this.shown = shown;
  }

  follow(frame: Frame): void {
    this.newest = frame;
    this.log.follow(frame);
    this.styluses.follow(frame);
    if (this.frozenAt === null) this.askToDraw();
  }

  /** The curves are those of the hand that is at work, unless others are looked at. */
  chooseLast(): void {
    if (this.frozenAt === null) this.styluses.chooseLast();
  }

  toggleFreeze(): void {
    this.frozenAt = this.frozenAt === null ? (this.newest?.time ?? 0) : null;
    element("freeze").setAttribute("aria-pressed", String(this.frozenAt !== null));
    this.askToDraw();
  }

  applyTheme(): void {
    for (const plot of this.plots) plot.applyTheme(currentTheme());
  }

  /** The styluses in the plots. */
  private plotted(): number[] {
    const { chosen, beside } = this.styluses;
    return beside === null || beside === chosen ? [chosen] : [chosen, beside];
  }

  /** A plot alone needs no title. */
  private titleOf(stylus: number): string {
    return this.plotted().length > 1 ? this.styluses.nameOf(stylus) : "";
  }

  private arrange(): void {
    const plotted = this.plotted();
    document.body.classList.toggle("beside", plotted.length > 1);
    element("beside").hidden = plotted.length < 2;
    this.titles.forEach((title, i) => (title.textContent = plotted[i] === undefined ? "" : this.titleOf(plotted[i])));
    this.askToDraw();
  }

  private askToDraw(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      if (this.newest !== null) this.draw(this.frozenAt ?? this.newest.time);
    });
  }

  /** Two plots have the same axes. */
  private draw(now: number): void {
    const plotted = this.plotted();
    plotted.forEach((stylus, i) => this.plots[i]!.take(this.log, stylus, now));
    const range = plotted.length > 1 ? union(this.plots.map((plot) => plot.extent())) : null;
    plotted.forEach((_, i) => this.plots[i]!.draw(now, range));
  }
}
