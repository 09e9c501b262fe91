import type { Ramp } from "./colour_map";

const vector = (parts: readonly number[]): string => `vec3(${parts.map((part) => (part / 255).toFixed(6)).join(", ")})`;

/** GLSL: vec3 onRamp(float share), linear; below -0.5 the value is not known. */
export function rampShader(ramp: Ramp): string {
  const last = ramp.length - 1;
  return `
const vec3 RAMP[${ramp.length}] = vec3[${ramp.length}](${ramp.map(vector).join(", ")});

vec3 onRamp(float share) {
  float x = clamp(share, 0.0, 1.0) * ${last}.0;
  int i = min(int(x), ${last - 1});
  vec3 colour = share < -0.5 ? vec3(0.5) : mix(RAMP[i], RAMP[i + 1], x - float(i));
  return mix(colour / 12.92, pow((colour + 0.055) / 1.055, vec3(2.4)), step(0.04045, colour));
}
`;
}
