import { make } from "./elements";
import type { Changeable, ObjectSettings, Scene, Settings, State, Vec3 } from "./protocol";
import { SettingsDraft } from "./settings_draft";
import { byFactor, fromZero, type SliderScale } from "./slider_scale";

const PLACES = 1000;
const LEAST_PAUSE_MS = 60; // between two messages while a slider is moved
const MOST_GRAVITY = 20;

type NumberKey = { [Key in keyof ObjectSettings]: ObjectSettings[Key] extends number ? Key : never }[keyof ObjectSettings];

interface SliderKind {
  label: string;
  unit: string;
  help: string;
  /** @param value that must have a place on it */
  scale(value: number): SliderScale;
}

const SLIDERS: Record<NumberKey, SliderKind> = {
  staticFriction: { label: "Friction", unit: "", help: "A tip sticks up to this", scale: (v) => fromZero(Math.max(2, v), 1) },
  kineticFriction: { label: "Friction while slipping", unit: "", help: "At most the friction above", scale: (v) => fromZero(Math.max(2, v), 1) },
  damping: { label: "Damping of motion", unit: "/s", help: "How fast it comes to rest", scale: (v) => fromZero(Math.max(20, v), 2) },
  angularDamping: { label: "Damping of turning", unit: "/s", help: "How fast it stops turning", scale: (v) => fromZero(Math.max(20, v), 2) },
  tether: { label: "Tether", unit: "N/m", help: "Soft spring to where it was at the start", scale: (v) => fromZero(Math.max(200, v), 2) },
  angularTether: { label: "Tether of turning", unit: "N m/rad", help: "The same for its orientation", scale: (v) => fromZero(Math.max(1, v), 3) },
  dampingFactor: { label: "Damping of the material", unit: "×", help: "Factor of its own damping: how long it wobbles", scale: () => byFactor(0.1, 10) },
};

const REASONS: Record<keyof Changeable, string> = {
  dampingFactor: "The damping of the material cannot be changed in this model.",
  inertia: "This model has no data for centrifugal loading.",
  motion: "This body is fixed: damping of motion and turning, tethers and centrifugal loading do nothing.",
};

const NEEDS: Partial<Record<keyof ObjectSettings, readonly (keyof Changeable)[]>> = {
  damping: ["motion"],
  angularDamping: ["motion"],
  tether: ["motion"],
  angularTether: ["motion"],
  dampingFactor: ["dampingFactor"],
  inertia: ["motion", "inertia"],
};

class Slider {
  readonly row = make("div", "", "row wide");
  readonly input = document.createElement("input");
  private readonly output = make("output", "");
  private scale: SliderScale;

  constructor(
    private readonly kind: SliderKind,
    id: string,
    changed: (value: number) => void,
  ) {
    this.scale = kind.scale(0);
    const label = make("label", kind.label) as HTMLLabelElement;
    label.htmlFor = this.input.id = id;
    label.title = kind.help;
    this.input.type = "range";
    this.input.max = String(PLACES);
    this.input.oninput = () => {
      const value = this.scale.valueAt(Number(this.input.value) / PLACES);
      this.write(value);
      changed(value);
    };
    this.row.append(label, this.output, this.input);
  }

  show(value: number): void {
    this.scale = this.kind.scale(value);
    this.input.value = String(Math.round(this.scale.placeOf(value) * PLACES));
    this.write(value);
  }

  private write(value: number): void {
    const figure = value === 0 ? "0" : String(Number(value.toPrecision(3)));
    const { unit } = this.kind;
    this.output.textContent = unit === "×" ? `× ${figure}` : `${figure} ${unit}`.trim();
    this.input.setAttribute("aria-valuetext", this.output.textContent);
  }
}

function lengthOf(vector: Vec3): number {
  return Math.hypot(...vector);
}

/** Gravity, friction, damping, tether: values come from State, and go out whole. */
export class SettingsPanel {
  private scene: Scene | null = null;
  private state: State | null = null;
  private draft: SettingsDraft | null = null;
  private object = 0;
  private lastSent = 0;
  private timer = 0;
  private gravityDown: Vec3 = [0, -1, 0];
  private readonly gravity: Slider;
  private readonly sliders = new Map<NumberKey, Slider>();
  private readonly chooser = document.createElement("select");
  private readonly inertia = document.createElement("input");
  private readonly reasons: Record<keyof Changeable, HTMLElement>;
  private readonly chooserRow: HTMLElement;

  constructor(
    host: HTMLElement,
    private readonly reason: HTMLElement,
    private readonly send: (settings: Settings) => void,
  ) {
    const kind = { label: "Gravity", unit: "m/s²", help: "On all objects", scale: (v: number) => fromZero(Math.max(MOST_GRAVITY, v), 1) };
    this.gravity = new Slider(kind, "set-gravity", (value) => this.changeGravity(value));
    this.reasons = { dampingFactor: reasonLine(), inertia: reasonLine(), motion: reasonLine() };
    this.chooserRow = labelled("Object", "set-object", this.chooser);
    this.chooser.onchange = () => {
      this.object = Number(this.chooser.value);
      this.render();
    };
    host.append(this.gravity.row, this.chooserRow);
    for (const [key, slider] of Object.entries(SLIDERS) as [NumberKey, SliderKind][]) {
      const made = new Slider(slider, `set-${key}`, (value) => this.changeNumber(key, value));
      this.sliders.set(key, made);
      host.append(made.row);
    }
    host.append(this.reasons.dampingFactor, this.inertiaRow(), this.reasons.inertia, this.reasons.motion);
  }

  show(scene: Scene): void {
    this.scene = scene;
    this.state = null;
    this.draft = null;
    this.object = Math.min(this.object, scene.objects.length - 1);
    this.chooser.replaceChildren(...scene.objects.map((object, i) => new Option(object.name, String(i))));
    this.chooser.value = String(this.object);
    this.chooserRow.hidden = scene.objects.length < 2;
    if (scene.floor !== null) this.gravityDown = scene.floor.normal.map((part) => -part) as unknown as Vec3;
    this.render();
  }

  showState(state: State): void {
    this.state = state;
    if (this.draft === null) this.draft = new SettingsDraft(state.settings);
    else this.draft.confirmed = state.settings;
    this.render();
  }

  lost(): void {
    this.state = null;
    this.render();
  }

  private inertiaRow(): HTMLElement {
    const row = make("div", "", "row");
    const label = make("label", "", "check");
    this.inertia.type = "checkbox";
    this.inertia.id = "set-inertia";
    this.inertia.onchange = () => this.change("inertia", this.inertia.checked);
    label.append(this.inertia, make("span", "Centrifugal loading"));
    row.append(label);
    return row;
  }

  private changeGravity(size: number): void {
    const gravity = this.gravityDown.map((part) => part * size) as unknown as Vec3;
    this.draft?.change("gravity", (settings) => (settings.gravity = gravity), performance.now());
    this.sendSoon();
  }

  private changeNumber(key: NumberKey, value: number): void {
    this.change(key, value);
    const [other, pulled] = key === "staticFriction" ? (["kineticFriction", Math.min] as const) : (["staticFriction", Math.max] as const);
    if (key !== "staticFriction" && key !== "kineticFriction") return;
    // Kinetic friction is never above static friction: one takes the other along.
    const now = this.draft!.values(performance.now()).objects[this.object]![other];
    const then = pulled(now, value);
    if (then !== now) this.change(other, then);
    this.sliders.get(other)!.show(then);
  }

  private change<Key extends keyof ObjectSettings>(key: Key, value: ObjectSettings[Key]): void {
    this.draft?.changeObject(this.object, key, value, performance.now());
    this.sendSoon();
  }

  /** At once, or when the last message is long enough ago. */
  private sendSoon(): void {
    clearTimeout(this.timer);
    const wait = this.lastSent + LEAST_PAUSE_MS - performance.now();
    if (wait > 0) {
      this.timer = window.setTimeout(() => this.sendSoon(), wait);
      return;
    }
    if (this.draft === null) return;
    this.lastSent = performance.now();
    this.send(this.draft.values(this.lastSent));
    this.settle();
  }

  /** Shows what the server made of it, once that is known. */
  private settle(): void {
    clearTimeout(this.settling);
    this.settling = window.setTimeout(() => (this.draft?.settled(performance.now()) ? this.render() : this.settle()), 200);
  }
  private settling = 0;

  private whyNot(): string | null {
    if (this.state === null || this.draft === null) return "There is no connection to the server.";
    if (this.state.onlyLooksOn) return "This link is view only.";
    if (this.state.playback !== null) return "A recorded run is shown, as it was.";
    return null;
  }

  private render(): void {
    const why = this.whyNot();
    this.reason.textContent = why;
    this.reason.hidden = why === null;
    const changeable = this.state?.changeable[this.object];
    const lacks = (key: keyof ObjectSettings): (keyof Changeable)[] => (NEEDS[key] ?? []).filter((need) => !changeable?.[need]);
    const can = (key: keyof ObjectSettings): boolean => why === null && lacks(key).length === 0;
    for (const [key, slider] of this.sliders) slider.input.disabled = !can(key);
    this.gravity.input.disabled = why !== null;
    this.inertia.disabled = !can("inertia");
    const missing = new Set((Object.keys(NEEDS) as (keyof ObjectSettings)[]).flatMap((key) => lacks(key)[0] ?? []));
    for (const need of Object.keys(REASONS) as (keyof Changeable)[]) {
      this.reasons[need].textContent = REASONS[need];
      this.reasons[need].hidden = why !== null || !missing.has(need);
    }
    if (this.draft === null || this.scene === null) return;
    // What is under the hand is not moved by what comes back.
    if (!this.draft.settled(performance.now())) return;
    this.showValues(this.draft.confirmed);
  }

  private showValues({ gravity, objects }: Settings): void {
    const size = lengthOf(gravity);
    if (size > 0) this.gravityDown = gravity.map((part) => part / size) as unknown as Vec3;
    this.gravity.show(size);
    const object = objects[this.object]!;
    for (const [key, slider] of this.sliders) slider.show(object[key]);
    this.inertia.checked = object.inertia;
  }
}

function reasonLine(): HTMLElement {
  const line = make("p", "", "hint reason");
  line.hidden = true;
  return line;
}

function labelled(text: string, id: string, control: HTMLElement): HTMLElement {
  const row = make("div", "", "row");
  const label = make("label", text) as HTMLLabelElement;
  label.htmlFor = control.id = id;
  row.append(label, control);
  return row;
}
