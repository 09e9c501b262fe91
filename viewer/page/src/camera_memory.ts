import type { Scene, Vec3 } from "./protocol";
import { remember, remembered } from "./visits";

/** Where the camera is and what it looks at [m], W. */
export interface CameraView {
  position: Vec3;
  target: Vec3;
}

export type Preset = "fit" | "front" | "side" | "top";

/** From the middle of the picture to the camera, W; from above a hair to the front, so that it is up on the screen. */
export const PRESETS: Record<Preset, Vec3> = {
  fit: [0.55, 0.42, 1],
  front: [0, 0, 1],
  side: [1, 0, 0],
  top: [0, 1, 1e-4],
};

/** Each scene has a view of its own. */
function nameOf(scene: Scene): string {
  return "camera." + scene.objects.map(({ name }) => name).join(",");
}

/** Whether a view of one scene is as good for the other. */
export function hasSameBodies(a: Scene, b: Scene): boolean {
  const same = (i: number): boolean => {
    const [first, second] = [a.objects[i]!, b.objects[i]!];
    return first.name === second.name && first.rest.length === second.rest.length && first.rest.every((part, k) => part === second.rest[k]);
  };
  return a.objects.length === b.objects.length && a.objects.every((_, i) => same(i));
}

function isVector(value: unknown): value is Vec3 {
  return Array.isArray(value) && value.length === 3 && value.every((part) => Number.isFinite(part));
}

/** The view that a person of this browser left a scene with; null: none. */
export function rememberedView(scene: Scene): CameraView | null {
  try {
    const { position, target } = JSON.parse(remembered(nameOf(scene)) ?? "{}") as Partial<CameraView>;
    return isVector(position) && isVector(target) ? { position, target } : null;
  } catch {
    return null;
  }
}

export function rememberView(scene: Scene, view: CameraView): void {
  remember(nameOf(scene), JSON.stringify(view));
}
