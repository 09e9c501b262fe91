import type { ToolChoice } from "./tool_choice";
import type { Touch } from "./touch";

const METRES_PER_NOTCH = 0.001;
const PIXELS_PER_NOTCH = 100;

/**
 * Mouse and fingers on the canvas: a press on an object is the stylus', one beside it turns the view. Shift, the key
 * G or a second finger takes hold.
 */
export class TouchPointer {
  private pointer: number | null = null;
  private second: number | null = null;
  private keys = new Set<string>();

  /** @param camera is switched off while the pointer is the stylus */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly touch: Touch,
    private readonly camera: { enabled: boolean },
    private readonly tool: ToolChoice,
  ) {
    // Before the camera hears of them.
    const before = { capture: true };
    canvas.addEventListener("pointerdown", (event) => this.down(event), before);
    canvas.addEventListener("pointermove", (event) => this.move(event), before);
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"] as const) {
      canvas.addEventListener(end, (event) => this.up(event), before);
    }
    // A press with Shift is not the keyboard's.
    canvas.addEventListener("pointerdown", () => canvas.classList.add("by-pointer"));
    canvas.addEventListener("blur", () => canvas.classList.remove("by-pointer"));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { capture: true, passive: false });
    addEventListener("keydown", (event) => this.key(event, true));
    addEventListener("keyup", (event) => this.key(event, false));
    addEventListener("blur", () => {
      this.keys.clear();
      this.lightTool();
      this.end();
    });
    document.addEventListener("visibilitychange", () => this.end());
  }

  /** The press is over, whatever ended it. */
  ended(): void {
    this.pointer = null;
    this.second = null;
    this.camera.enabled = true;
    this.lightTool();
  }

  private down(event: PointerEvent): void {
    if (this.pointer !== null) {
      if (event.pointerId !== this.pointer) this.second = event.pointerId;
      this.decide();
      return;
    }
    if (event.button !== 0 || !event.isPrimary || this.touch.active) return;
    this.touch.grabs = this.takesHold(event.shiftKey);
    if (!this.touch.press(event.offsetX, event.offsetY)) return;
    this.pointer = event.pointerId;
    this.camera.enabled = false;
    this.canvas.setPointerCapture(event.pointerId);
  }

  private move(event: PointerEvent): void {
    if (event.pointerId === this.pointer) this.touch.aim(event.offsetX, event.offsetY);
    else if (this.pointer === null && event.buttons === 0) this.hover(event.offsetX, event.offsetY);
  }

  private hover(x: number, y: number): void {
    if (this.hovers) return;
    this.hovers = true;
    requestAnimationFrame(() => {
      this.hovers = false;
      this.canvas.classList.toggle("over", this.touch.isOver(x, y));
    });
  }
  private hovers = false;

  private up(event: PointerEvent): void {
    if (event.pointerId === this.second) {
      this.second = null;
      this.decide();
    } else if (event.pointerId === this.pointer) this.end();
  }

  private end(): void {
    if (this.pointer === null) return;
    this.ended();
    this.touch.release();
  }

  private wheel(event: WheelEvent): void {
    if (!this.touch.active) return;
    event.preventDefault();
    const pixels = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY : 33 * event.deltaY;
    this.touch.deepen((-pixels / PIXELS_PER_NOTCH) * METRES_PER_NOTCH);
  }

  private key(event: KeyboardEvent, down: boolean): void {
    const name = event.key.toLowerCase();
    if (/^(arrow|page| |t$)/.test(name)) this.canvas.classList.remove("by-pointer");
    if (name !== "shift" && name !== "g") return;
    if (down) this.keys.add(name);
    else if (!this.keys.delete(name)) return;
    if (this.pointer !== null) this.decide();
    else if (!this.touch.active) this.lightTool();
  }

  private takesHold(shift: boolean): boolean {
    return shift || this.keys.size > 0 || this.second !== null || this.tool.grabs;
  }

  private decide(): void {
    this.touch.grabs = this.takesHold(false);
    this.lightTool();
  }

  private lightTool(): void {
    this.tool.grabMeanwhile(this.keys.size > 0 || this.second !== null);
  }
}
