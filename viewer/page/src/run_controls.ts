import { element, make } from "./elements";
import { Command, encodeCommand, type State } from "./protocol";

/** Reset, pause, step, record, and the list of recordings. */
export class RunControls {
  private state: State | null = null;
  private readonly resetButton = element<HTMLButtonElement>("reset");
  private readonly pauseButton = element<HTMLButtonElement>("pause");
  private readonly stepButton = element<HTMLButtonElement>("step");
  private readonly recordButton = element<HTMLButtonElement>("record");
  private readonly reason = element("run-reason");
  private readonly list = element("recordings");
  private listed = "";

  constructor(private readonly send: (message: ArrayBuffer) => void) {
    this.resetButton.onclick = () => this.reset();
    this.pauseButton.onclick = () => this.togglePause();
    this.stepButton.onclick = () => this.step();
    this.recordButton.onclick = () => this.toggleRecording();
  }

  reset(): void {
    if (!this.resetButton.disabled) this.ask(Command.Reset);
  }

  togglePause(): void {
    if (this.state?.playback) this.ask(this.state.playback.playing ? Command.PausePlayback : Command.Play);
    else if (!this.pauseButton.disabled) this.ask(this.state!.paused ? Command.Resume : Command.Pause);
  }

  step(): void {
    if (!this.stepButton.disabled) this.ask(Command.Step, 1);
  }

  lost(): void {
    this.state = null;
    this.render();
  }

  showState(state: State): void {
    this.state = state;
    this.render();
  }

  private toggleRecording(): void {
    this.ask(this.state!.recording ? Command.EndRecording : Command.BeginRecording);
  }

  private ask(what: Command, number = 0): void {
    this.send(encodeCommand(what, number));
  }

  private render(): void {
    const { state } = this;
    const may = state !== null && !state.onlyLooksOn;
    const live = may && state.playback === null;
    this.resetButton.disabled = !may;
    this.resetButton.title = state?.playback ? "Recorded run: to its beginning" : "";
    this.pauseButton.disabled = !live;
    this.pauseButton.firstChild!.textContent = state?.paused ? "Resume " : "Pause ";
    this.pauseButton.setAttribute("aria-pressed", String(live && state.paused));
    this.stepButton.disabled = !(live && state.paused);
    const recording = state?.recording === true;
    this.recordButton.disabled = !live || !(state.canRecord || recording);
    this.recordButton.setAttribute("aria-pressed", String(recording));
    this.recordButton.querySelector("span")!.textContent = recording ? "End recording" : "Record";
    this.recordButton.title = recording ? "" : "Resets, then keeps the run in a file beside the server";
    const why = this.whyNot();
    this.reason.textContent = why;
    this.reason.hidden = why === "";
    this.renderList();
  }

  private whyNot(): string {
    const { state } = this;
    if (state === null) return "";
    if (state.onlyLooksOn) return "This link is view only.";
    if (state.playback !== null) return "A recorded run is shown; the live run is paused.";
    return state.canRecord || state.recording ? "" : "This server keeps no recordings.";
  }

  private renderList(): void {
    const { state } = this;
    const recordings = state?.recordings ?? [];
    this.list.hidden = recordings.length === 0;
    const shown = state?.playback?.recording ?? null;
    const may = state !== null && !state.onlyLooksOn && !state.recording;
    const key = JSON.stringify([recordings, shown, may]);
    if (key === this.listed) return; // the focus stays where it is
    this.listed = key;
    this.list.replaceChildren(
      ...recordings.map(({ number, name }) => {
        const row = make("li", "");
        const play = make("button", number === shown ? "Shown" : "Show") as HTMLButtonElement;
        play.type = "button";
        play.disabled = !may || number === shown;
        play.setAttribute("aria-label", number === shown ? `Shown: the recording ${name}` : `Show the recording ${name}`);
        play.onclick = () => this.ask(Command.ShowRecording, number);
        row.append(make("span", name), play);
        return row;
      }),
    );
  }
}
