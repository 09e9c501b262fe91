import { ProtocolError, type Reader } from "./byte_reader";

const HAS_COORDINATES = 1;
const MAX_TEXTURE = 16_777_216; // bytes
const SUM_OFF = 1e-3; // by which weights may miss the sum 1

/** A mesh that is drawn in place of an object's computed surface, which takes it along. */
export interface Display {
  /** at rest, three numbers a vertex [m], B */
  positions: Float32Array;
  /** at rest, unit, three numbers a vertex; B */
  normals: Float32Array;
  /** three vertex numbers a triangle, outward */
  triangles: Uint32Array;
  /** a vertex: three nodes of the computed surface that take it along */
  nodes: Uint32Array;
  /** of these nodes; their sum is 1 */
  weights: Float32Array;
  /** two numbers a vertex, from the picture's bottom left; null: none */
  coordinates: Float32Array | null;
  /** a PNG or JPEG file; null: none */
  texture: Uint8Array<ArrayBuffer> | null;
}

function below(bound: number, numbers: Uint32Array, what: string): Uint32Array {
  if (numbers.some((number) => number >= bound)) throw new ProtocolError(`a triangle has a ${what} that is not there`);
  return numbers;
}

function readWeights(reader: Reader, vertices: number): Float32Array {
  const weights = reader.singles(3 * vertices);
  for (let i = 0; i < weights.length; i += 3) {
    const off = Math.abs(weights[i]! + weights[i + 1]! + weights[i + 2]! - 1);
    if (!(off <= SUM_OFF)) throw new ProtocolError("the weights of a vertex have not the sum 1");
  }
  return weights;
}

function readTexture(reader: Reader, size: number): Uint8Array<ArrayBuffer> | null {
  const texture = size > 0 ? reader.octets(size) : null;
  reader.align();
  return texture;
}

/** @param nodeCount of the computed surface */
export function readDisplay(reader: Reader, nodeCount: number): Display {
  const vertices = reader.u32();
  const triangles = reader.u32();
  const hasCoordinates = (reader.u32() & HAS_COORDINATES) !== 0;
  const size = reader.u32();
  if (size > MAX_TEXTURE) throw new ProtocolError("a texture is too large");
  if (size > 0 && !hasCoordinates) throw new ProtocolError("a texture has no coordinates");
  if (vertices === 0 || triangles === 0) throw new ProtocolError("nothing where there has to be something");
  return {
    positions: reader.singles(3 * vertices),
    normals: reader.singles(3 * vertices),
    triangles: below(vertices, reader.words(3 * triangles), "vertex"),
    nodes: below(nodeCount, reader.words(3 * vertices), "node"),
    weights: readWeights(reader, vertices),
    coordinates: hasCoordinates ? reader.singles(2 * vertices) : null,
    texture: readTexture(reader, size),
  };
}
