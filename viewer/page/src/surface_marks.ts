import * as THREE from "three";
import { OWN_LIGHT, SHINE } from "./own_light";

const MOST = 16; // contacts on one object, as many as there are styluses
const POINT = 0.0013; // radius at which the contact of a point is drawn [m]
const AMONG_COLOURS = "#ffffff"; // which the ramp does not have

/**
 * Marks where styluses touch, as discs on the surface at rest, which the deformation takes along. What is drawn
 * needs the attribute `rest`, a vertex's place on that surface [m], B.
 */
export class SurfaceMarks {
  private readonly middles = Array.from({ length: MOST }, () => new THREE.Vector3());
  private readonly radii = new Array<number>(MOST).fill(0);
  private readonly uniforms = {
    markMiddles: { value: this.middles },
    markRadii: { value: this.radii },
    markColour: { value: new THREE.Color() },
    ownLight: { value: 0 },
  };

  /** To be called before the material of a surface is compiled. */
  drawBy(shader: THREE.WebGLProgramParametersWithUniforms): void {
    Object.assign(shader.uniforms, this.uniforms);
    shader.vertexShader = ("attribute vec3 rest;\nvarying vec3 vRest;\n" + shader.vertexShader).replace(
      "#include <begin_vertex>",
      "#include <begin_vertex>\nvRest = rest;",
    );
    shader.fragmentShader = (DECLARE + shader.fragmentShader)
      .replace("#include <color_fragment>", "#include <color_fragment>\n" + MARK)
      .replace("#include <emissivemap_fragment>", "#include <emissivemap_fragment>\n" + SHINE);
  }

  /** On a plain surface. */
  colour = "#ffffff";

  /** The surface's colours stand for values, and are to be read in the shade, too. */
  set coloursAreValues(are: boolean) {
    this.uniforms.ownLight.value = are ? OWN_LIGHT : 0;
    this.uniforms.markColour.value.set(are ? AMONG_COLOURS : this.colour);
  }

  /** @param contacts middles on the surface at rest [m], B, and radii of the fingertips, 0: a point */
  show(contacts: { middle: readonly [number, number, number]; radius: number }[]): void {
    this.radii.fill(0);
    contacts.slice(0, MOST).forEach(({ middle, radius }, i) => {
      this.middles[i]!.set(...middle);
      this.radii[i] = Math.max(radius, POINT);
    });
  }
}

const DECLARE = `
varying vec3 vRest;
uniform vec3 markMiddles[${MOST}];
uniform float markRadii[${MOST}];
uniform vec3 markColour;
uniform float ownLight;
`;

// A thin fill and a rim two pixels wide, with soft edges; a point is filled.
const MARK = `
for (int i = 0; i < ${MOST}; ++i) {
  if (markRadii[i] <= 0.0) break;
  float away = distance(vRest, markMiddles[i]) - markRadii[i];
  float pixel = max(fwidth(away), 1e-7);
  float inside = 1.0 - smoothstep(-0.5 * pixel, 0.5 * pixel, away);
  float rim = inside * smoothstep(-3.0 * pixel, -2.0 * pixel, away);
  float strength = markRadii[i] > ${(1.01 * POINT).toFixed(6)} ? max(0.4 * inside, 0.95 * rim) : 0.95 * inside;
  diffuseColor.rgb = mix(diffuseColor.rgb, markColour, strength);
}
`;
