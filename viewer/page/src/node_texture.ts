import * as THREE from "three";

const WIDTH = 4096; // which every machine with WebGL 2 can have, nearly
const KINDS = ["displacement", "normal", "colour"] as const;
type Kind = (typeof KINDS)[number];

/**
 * Vectors of the nodes of a surface for vertex shaders, in one texture: a block of rows for each kind, in a block the
 * nodes row by row.
 */
export class NodeTexture {
  readonly texture: THREE.DataTexture;
  private readonly blockRows: number;

  constructor(nodes: number) {
    const width = Math.min(nodes, WIDTH);
    this.blockRows = Math.ceil(nodes / width);
    const height = KINDS.length * this.blockRows;
    this.texture = new THREE.DataTexture(new Float32Array(4 * width * height), width, height, THREE.RGBAFormat, THREE.FloatType);
  }

  /** @param vectors three numbers a node */
  set(kind: Kind, vectors: Float32Array, factor = 1): void {
    const { data, width } = this.texture.image;
    const numbers = data as Float32Array;
    let at = 4 * width * this.blockRows * KINDS.indexOf(kind);
    for (let i = 0; i < vectors.length; i += 3, at += 4) {
      for (let c = 0; c < 3; ++c) numbers[at + c] = factor * vectors[i + c]!;
    }
    this.texture.needsUpdate = true;
  }

  dispose(): void {
    this.texture.dispose();
  }
}

/** Of a vertex shader: means of what three nodes have. */
export const OF_NODES = `
attribute uvec3 nodes;
attribute vec3 weights;
uniform sampler2D nodeVectors;

vec3 ofNode(int block, uint node) {
  ivec2 size = textureSize(nodeVectors, 0);
  int row = block * (size.y / ${KINDS.length}) + int(node) / size.x;
  return texelFetch(nodeVectors, ivec2(int(node) % size.x, row), 0).xyz;
}

vec3 ofNodes(int block) {
  return weights.x * ofNode(block, nodes.x) + weights.y * ofNode(block, nodes.y) + weights.z * ofNode(block, nodes.z);
}

${KINDS.map((kind, block) => `vec3 ${kind}OfNodes() { return ofNodes(${block}); }`).join("\n")}
`;
