import { download } from "./download";
import { element } from "./elements";
import { ForceLog } from "./force_log";
import { ForcePlot } from "./force_plot";
import { StylusList } from "./panel";
import type { Frame, Scene, State } from "./protocol";
import { currentTheme } from "./theme";

/** Styluses, curves of the force on one of them, and what can be taken home of it. */
export class ForcePanel {
  private readonly plot = new ForcePlot(element("plot"), currentTheme());
  private readonly styluses = new StylusList(element("styluses"));
  private log = new ForceLog(1, 0.002);
  private newest: Frame | null = null;
  private shown: number | null = -1;
  private asked = false;

  constructor() {
    element("freeze").onclick = () => this.toggleFreeze();
    element("csv").onclick = () => download("irdm-force.csv", new Blob([this.log.csv()], { type: "text/csv" }));
    element("png").onclick = async () => {
      const picture = await this.plot.picture();
      if (picture !== null) download("irdm-force.png", picture);
    };
    // A zoom into curves that run away is none.
    element("plot").addEventListener("pointerdown", () => {
      if (!this.plot.frozen) this.toggleFreeze();
    });
  }

  show(scene: Scene): void {
    this.newest = null;
    this.log = new ForceLog(scene.styluses.length, scene.dt);
    this.styluses.show(scene);
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
    this.askToDraw();
  }

  /** The curves are those of the hand that is at work. */
  chooseLast(): void {
    this.styluses.chooseLast();
  }

  toggleFreeze(): void {
    this.plot.frozen = !this.plot.frozen;
    element("freeze").setAttribute("aria-pressed", String(this.plot.frozen));
    this.askToDraw();
  }

  applyTheme(): void {
    this.plot.applyTheme(currentTheme());
  }

  private askToDraw(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      if (this.newest !== null) this.plot.show(this.log, this.styluses.chosen, this.newest.time);
    });
  }
}
