import { download } from "./download";
import { element } from "./elements";
import type { World } from "./world";

const TYPES = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];
const FRAMES_PER_SECOND = 30;
const STILL_MS = 250; // after which a picture at rest is taken once more, so that it lasts
const BITS_PER_SECOND = 8e6;

function supportedType(): string | null {
  if (typeof MediaRecorder === "undefined" || !("captureStream" in HTMLCanvasElement.prototype)) return null;
  return TYPES.find((type) => MediaRecorder.isTypeSupported(type)) ?? null;
}

/** Why there can be no video, for a person; null: there can be one. */
function whyNot(world: World | null): string | null {
  if (world === null) return "No video: the picture needs WebGL 2.";
  return supportedType() === null ? "No video: this browser cannot record a canvas (MediaRecorder)." : null;
}

/** The button that films the picture, and hands over the file when it is pressed again. */
export class VideoButton {
  private readonly button = element<HTMLButtonElement>("video");
  private recorder: MediaRecorder | null = null;
  private timer = 0;

  constructor(private readonly world: World | null) {
    const reason = whyNot(world);
    this.button.disabled = reason !== null;
    element("video-reason").hidden = reason === null;
    element("video-reason").textContent = reason;
    this.button.onclick = () => (this.recorder === null ? this.begin() : this.recorder.stop());
  }

  private begin(): void {
    const world = this.world!;
    const mimeType = supportedType()!;
    world.setOpaque(true);
    world.drawNow(); // the stream begins with what is there
    const stream = world.canvas.captureStream(FRAMES_PER_SECOND);
    const recorder = new MediaRecorder(stream, { mimeType, videoBitsPerSecond: BITS_PER_SECOND });
    const parts: Blob[] = [];
    recorder.ondataavailable = ({ data }) => parts.push(data);
    recorder.onstop = () => {
      for (const track of stream.getTracks()) track.stop();
      this.ended();
      const [type] = mimeType.split(";");
      download(`irdm.${type!.split("/")[1]}`, new Blob(parts, { type }));
    };
    this.recorder = recorder;
    this.timer = window.setInterval(() => world.invalidate(), STILL_MS);
    recorder.start();
    this.render();
  }

  private ended(): void {
    clearInterval(this.timer);
    this.recorder = null;
    this.world!.setOpaque(false);
    this.render();
  }

  private render(): void {
    const films = this.recorder !== null;
    this.button.setAttribute("aria-pressed", String(films));
    this.button.querySelector("span")!.textContent = films ? "End video" : "Video";
  }
}
