import type { Theme } from "./theme";

const TITLE_HEIGHT = 22; // [CSS px]

/** Plots side by side as a PNG, each below its title, on a ground. */
export function pictureOf(parts: { plot: HTMLCanvasElement; title: string }[], theme: Theme): Promise<Blob | null> {
  const ratio = devicePixelRatio;
  const top = parts.some(({ title }) => title !== "") ? TITLE_HEIGHT * ratio : 0;
  const canvas = document.createElement("canvas");
  canvas.width = parts.reduce((sum, { plot }) => sum + plot.width, 0);
  canvas.height = top + Math.max(...parts.map(({ plot }) => plot.height));
  const context = canvas.getContext("2d")!;
  context.fillStyle = theme.surface;
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.fillStyle = theme.ink;
  context.font = `${13 * ratio}px system-ui, sans-serif`;
  let left = 0;
  for (const { plot, title } of parts) {
    context.fillText(title, left + 8 * ratio, 16 * ratio);
    context.drawImage(plot, left, top);
    left += plot.width;
  }
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}
