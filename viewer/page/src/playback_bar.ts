import { element } from "./elements";
import { Command, encodeCommand, type Frame, type Scene, type State } from "./protocol";

const LEAST_PAUSE_MS = 60; // between two messages while the slider is moved
const HAND_ON_MS = 400; // after which the slider follows the run again

/** The bar under a recorded run: play, seek, speed, back to the live run. */
export class PlaybackBar {
  private state: State | null = null;
  private recordedOnly = false;
  private soughtAt = Number.NEGATIVE_INFINITY;
  private lastSent = 0;
  private timer = 0;
  private wanted: number | null = null; // sought, and not sent yet
  private readonly bar = element("playback");
  private readonly playButton = element<HTMLButtonElement>("play");
  private readonly slider = element<HTMLInputElement>("seek");
  private readonly time = element("seek-value");
  private readonly speed = element<HTMLSelectElement>("speed");
  private readonly backButton = element<HTMLButtonElement>("back-to-live");

  constructor(private readonly send: (message: ArrayBuffer) => void) {
    this.playButton.onclick = () =>
      send(encodeCommand(this.state?.playback?.playing ? Command.PausePlayback : Command.Play));
    this.backButton.onclick = () => send(encodeCommand(Command.BackToLive));
    this.speed.onchange = () => send(encodeCommand(Command.Speed, 0, Number(this.speed.value)));
    this.slider.oninput = () => {
      this.wanted = Number(this.slider.value);
      this.write(this.wanted);
      this.seekSoon();
    };
  }

  show(scene: Scene): void {
    this.recordedOnly = scene.recordedOnly;
    this.state = null;
    this.render();
  }

  showState(state: State): void {
    this.state = state;
    this.render();
  }

  follow(frame: Frame): void {
    if (this.bar.hidden || this.wanted !== null || performance.now() - this.soughtAt < HAND_ON_MS) return;
    this.slider.value = String(frame.time);
    this.write(frame.time);
  }

  private seekSoon(): void {
    if (this.wanted === null) return;
    this.soughtAt = performance.now();
    clearTimeout(this.timer);
    const wait = this.lastSent + LEAST_PAUSE_MS - this.soughtAt;
    if (wait > 0) {
      this.timer = window.setTimeout(() => this.seekSoon(), wait);
      return;
    }
    this.lastSent = this.soughtAt;
    this.send(encodeCommand(Command.Seek, 0, this.wanted));
    this.wanted = null;
  }

  private write(time: number): void {
    const length = this.state?.playback?.length ?? 0;
    this.time.textContent = `${time.toFixed(2)} / ${length.toFixed(2)} s`;
    this.slider.setAttribute("aria-valuetext", `${time.toFixed(2)} seconds of ${length.toFixed(2)}`);
  }

  private render(): void {
    const playback = this.state?.playback ?? null;
    this.bar.hidden = playback === null;
    if (playback === null) return;
    const may = !this.state!.onlyLooksOn;
    for (const control of [this.playButton, this.slider, this.speed, this.backButton]) control.disabled = !may;
    this.playButton.textContent = playback.playing ? "Pause" : "Play";
    this.slider.max = String(playback.length);
    this.backButton.hidden = this.recordedOnly;
    const speed = String(playback.speed);
    if (![...this.speed.options].some((option) => option.value === speed)) {
      this.speed.append(new Option(`× ${Number(playback.speed.toPrecision(3))}`, speed));
    }
    this.speed.value = speed;
    this.write(Number(this.slider.value));
  }
}
