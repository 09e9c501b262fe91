import type { ToolChoice } from "./tool_choice";
import type { Touch } from "./touch";

const PIXELS_PER_SECOND = 90;
const SLOWLY = 0.25; // with Shift
const METRES_PER_SECOND = 0.02;
const ARROWS: Record<string, readonly [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};
const DEPTHS: Record<string, number> = { PageUp: 1, PageDown: -1 };

/**
 * The stylus by keys: arrows move a cross over the picture, Space presses there and lets go, page keys go deeper
 * and back, G grabs, Escape lets go and ends it.
 */
export class TouchKeys {
  on = false;
  private x = 0;
  private y = 0;
  private readonly down = new Set<string>();
  private slow = false;
  private before = 0;
  private pressed = false;

  /** @param cross the mark on the picture */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly cross: HTMLElement,
    private readonly touch: Touch,
    private readonly toggle: HTMLButtonElement,
    private readonly tool: ToolChoice,
  ) {
    toggle.onclick = () => this.set(!this.on);
    canvas.addEventListener("keydown", (event) => this.key(event), { capture: true });
    addEventListener("keyup", (event) => this.down.delete(event.key));
    canvas.addEventListener("blur", () => {
      this.down.clear();
      this.release();
    });
  }

  set(on: boolean): void {
    this.on = on;
    this.toggle.setAttribute("aria-pressed", String(on));
    this.cross.hidden = !on;
    if (!on) {
      this.release();
      this.grab(false);
      return;
    }
    this.x = this.canvas.clientWidth / 2;
    this.y = this.canvas.clientHeight / 2;
    this.place();
    this.canvas.focus();
  }

  /** The press is over, whatever ended it. */
  ended(): void {
    this.pressed = false;
    if (this.on) this.tool.grabMeanwhile(this.touch.grabs);
  }

  private release(): void {
    if (this.pressed) this.touch.release();
  }

  private key(event: KeyboardEvent): void {
    if (!this.on || event.ctrlKey || event.metaKey || event.altKey) return;
    if (!this.act(event)) return;
    event.preventDefault();
    event.stopPropagation();
  }

  private act(event: KeyboardEvent): boolean {
    this.slow = event.shiftKey;
    if (event.key === "Shift") return true; // it slows here, and grabs nothing
    if (event.key in ARROWS || event.key in DEPTHS) {
      this.down.add(event.key);
      if (this.down.size === 1 && !event.repeat) this.begin();
      return true;
    }
    if (event.repeat) return event.key === " ";
    if (event.key === " ") this.press();
    else if (event.key.toLowerCase() === "g") this.grab(!this.touch.grabs);
    else if (event.key === "Escape") this.set(false);
    else return false;
    return true;
  }

  private press(): void {
    if (this.pressed) {
      this.touch.release();
      return;
    }
    this.grab(this.touch.grabs || this.tool.grabs);
    this.pressed = this.touch.press(this.x, this.y);
  }

  private grab(on: boolean): void {
    this.touch.grabs = on;
    this.tool.grabMeanwhile(on);
  }

  private begin(): void {
    this.before = performance.now();
    requestAnimationFrame(() => this.beat());
  }

  private beat(): void {
    const now = performance.now();
    const seconds = Math.min((now - this.before) / 1000, 0.1);
    this.before = now;
    const pace = this.slow ? SLOWLY : 1;
    for (const key of this.down) {
      const [right, down] = ARROWS[key] ?? [0, 0];
      this.x += right * pace * PIXELS_PER_SECOND * seconds;
      this.y += down * pace * PIXELS_PER_SECOND * seconds;
      this.touch.deepen((DEPTHS[key] ?? 0) * pace * METRES_PER_SECOND * seconds);
    }
    this.place();
    if (this.down.size > 0) requestAnimationFrame(() => this.beat());
  }

  private place(): void {
    this.x = Math.min(Math.max(this.x, 0), this.canvas.clientWidth);
    this.y = Math.min(Math.max(this.y, 0), this.canvas.clientHeight);
    this.cross.style.translate = `${this.x.toFixed(1)}px ${this.y.toFixed(1)}px`;
    if (this.pressed) this.touch.aim(this.x, this.y);
  }
}
