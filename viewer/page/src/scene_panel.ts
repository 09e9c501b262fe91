import { element } from "./elements";
import { Command, encodeCommand, encodeLoadScene, type Scene, type Scenes, type State } from "./protocol";

/** Another scene from the server's folder, and the settings as a new one. */
export class ScenePanel {
  private scene: Scene | null = null;
  private state: State | null = null;
  private listed = "";
  private readonly section = element("scenes-section");
  private readonly choice = element<HTMLSelectElement>("scene-choice");
  private readonly loadButton = element<HTMLButtonElement>("scene-load");
  private readonly saveButton = element<HTMLButtonElement>("scene-save");
  private readonly reason = element("scenes-reason");

  constructor(private readonly send: (message: ArrayBuffer) => void) {
    this.loadButton.onclick = () => this.send(encodeLoadScene(this.choice.value));
    this.saveButton.onclick = () => this.send(encodeCommand(Command.SaveScene));
    this.choice.onchange = () => this.render();
  }

  show(scene: Scene): void {
    this.scene = scene;
    this.state = null;
    this.listed = "";
  }

  showState(state: State): void {
    this.state = state;
    this.section.hidden = state.scenes === null;
    if (state.scenes !== null) this.list(state.scenes);
    this.render();
  }

  lost(): void {
    this.state = null;
    this.render();
  }

  /** What is chosen stays so while the list changes. */
  private list({ names, shown }: Scenes): void {
    const key = JSON.stringify([names, shown]);
    if (key === this.listed) return;
    const current = shown === null ? "" : names[shown]!;
    const chosen = this.listed === "" ? current : this.choice.value;
    this.listed = key;
    const options = names.map((name, i) => new Option(i === shown ? `${name} (shown)` : name, name));
    if (shown === null) options.unshift(new Option("Choose a scene", ""));
    this.choice.replaceChildren(...options);
    this.choice.value = names.includes(chosen) ? chosen : current;
  }

  private render(): void {
    const why = this.whyNot();
    const whyNoOther = why ?? this.whyNoOther();
    this.choice.disabled = whyNoOther !== null;
    this.loadButton.disabled = whyNoOther !== null || this.choice.value === "";
    this.saveButton.disabled = why !== null;
    this.reason.textContent = whyNoOther;
    this.reason.hidden = whyNoOther === null;
  }

  private whyNot(): string | null {
    const { state } = this;
    if (state === null) return "There is no connection to the server.";
    if (state.onlyLooksOn) return "This link is view only.";
    if (state.scenes?.preparing) return "A scene is being loaded or saved.";
    return state.playback === null ? null : "A recorded run is shown.";
  }

  private whyNoOther(): string | null {
    if (this.scene?.lockstep) return "A run in lockstep keeps its scene.";
    if (this.state?.scenes?.canLoad === false) return "The server records this run as a whole: it keeps its scene.";
    if (this.state?.recording) return "End the recording before another scene is loaded.";
    return this.state?.scenes?.names.length === 0 ? "The server's folder has no scenes yet." : null;
  }
}
