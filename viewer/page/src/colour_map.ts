// Viridis, sampled: even steps look like even steps, also to the colour-blind and in grey.
const STOPS: readonly (readonly [number, number, number])[] = [
  [68, 1, 84],
  [71, 45, 123],
  [59, 82, 139],
  [44, 114, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];

/** @param at 0 to 1, beyond it is cut; writes r, g, b (0 to 1, sRGB) */
export function colourAt(at: number, into: Float32Array, offset: number): void {
  const x = Math.min(Math.max(at, 0), 1) * (STOPS.length - 1);
  const i = Math.min(Math.floor(x), STOPS.length - 2);
  const part = x - i;
  for (let c = 0; c < 3; ++c) into[offset + c] = (STOPS[i]![c]! * (1 - part) + STOPS[i + 1]![c]! * part) / 255;
}

export function cssRamp(): string {
  return `linear-gradient(to right, ${STOPS.map((stop) => `rgb(${stop.join(" ")})`).join(", ")})`;
}

/** sRGB to linear, as three.js wants vertex colours. */
export function linear(value: number): number {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}
