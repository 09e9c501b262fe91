import * as THREE from "three";

const WIDTH = 4096; // a texture is nearly everywhere as wide
const UNKNOWN = -1e4; // so much that a part of it is still below all values

/**
 * What nodes of a surface have, for vertex shaders, in one texture: in a first block of rows, node by node, displacement
 * and value, in a second one the normal.
 */
export class NodeTexture {
  readonly texture: THREE.DataTexture;
  private readonly numbers: Float32Array;
  private readonly block: number;

  constructor(nodes: number) {
    const width = Math.min(nodes, WIDTH);
    const rows = Math.ceil(nodes / width);
    this.block = 4 * width * rows;
    this.numbers = new Float32Array(2 * this.block);
    this.texture = new THREE.DataTexture(this.numbers, width, 2 * rows, THREE.RGBAFormat, THREE.FloatType);
  }

  /** @param vectors three numbers a node */
  setDisplacements(vectors: Float32Array, factor: number): void {
    this.set(0, vectors, factor);
  }

  /** @param vectors three numbers a node */
  setNormals(vectors: Float32Array): void {
    this.set(this.block, vectors, 1);
  }

  /** @param values a node; NaN: not known */
  setValues(values: Float32Array): void {
    values.forEach((value, i) => (this.numbers[4 * i + 3] = Number.isNaN(value) ? UNKNOWN : value));
    this.texture.needsUpdate = true;
  }

  private set(start: number, vectors: Float32Array, factor: number): void {
    for (let i = 0, at = start; i < vectors.length; i += 3, at += 4) {
      for (let c = 0; c < 3; ++c) this.numbers[at + c] = factor * vectors[i + c]!;
    }
    this.texture.needsUpdate = true;
  }

  dispose(): void {
    this.texture.dispose();
  }
}

/** GLSL of a vertex shader: weighted means of what three nodes have. */
export const OF_NODES = `
attribute uvec3 nodes;
attribute vec3 weights;
uniform sampler2D ofAllNodes;

vec4 ofNode(int block, uint node) {
  ivec2 size = textureSize(ofAllNodes, 0);
  return texelFetch(ofAllNodes, ivec2(int(node) % size.x, block * (size.y / 2) + int(node) / size.x), 0);
}

vec4 ofNodes(int block) {
  return weights.x * ofNode(block, nodes.x) + weights.y * ofNode(block, nodes.y) + weights.z * ofNode(block, nodes.z);
}

vec3 displacementOfNodes() { return ofNodes(0).xyz; }
float valueOfNodes() { return ofNodes(0).w; }
vec3 normalOfNodes() { return ofNodes(1).xyz; }
`;
