import type * as THREE from "three";

/** Share of a colour that stands for a value and must not go dark in the shade. */
export const OWN_LIGHT = 0.6;

/** Of a fragment shader, after `#include <emissivemap_fragment>`; with the uniform `ownLight`. */
export const SHINE = `
totalEmissiveRadiance += ownLight * diffuseColor.rgb;
diffuseColor.rgb *= 1.0 - ownLight;
`;

/** The material's colours always stand for values. */
export function giveOwnLight(material: THREE.MeshStandardMaterial): void {
  material.onBeforeCompile = (shader) => {
    shader.uniforms["ownLight"] = { value: OWN_LIGHT };
    shader.fragmentShader = ("uniform float ownLight;\n" + shader.fragmentShader).replace(
      "#include <emissivemap_fragment>",
      "#include <emissivemap_fragment>\n" + SHINE,
    );
  };
}
