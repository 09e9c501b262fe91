import { ProtocolError, type Reader } from "./byte_reader";

const MAX_FACES = 20_000;

/** Least and greatest of some values. */
export interface Span {
  low: number;
  high: number;
}

export interface Region {
  /** of the [[region]], from 1; 0: what is in none */
  number: number;
  /** [Pa] */
  youngsModulus: Span;
  poissonRatio: Span;
  /** [kg/m^3] */
  density: Span;
}

/** Of an object of several materials. */
export interface Regions {
  list: Region[];
  /** there are more than the list has */
  someUnlisted: boolean;
  /** there are too many faces inside */
  facesLeftOut: boolean;
  /** a triangle of the surface: Young's modulus behind it [Pa]; NaN: not known */
  surfaceModulus: Float32Array;
  /** of the faces inside, three numbers a node, at rest [m], B */
  nodes: Float32Array;
  /** between tetrahedra of different regions: three node numbers each */
  faces: Uint32Array;
  /** of each face [Pa] */
  faceModulus: Float32Array;
}

function isModulus(value: number): boolean {
  return value > 0 && Number.isFinite(value);
}

function readSpan(reader: Reader): Span {
  const span = { low: reader.f32(), high: reader.f32() };
  if (!(span.low <= span.high)) throw new ProtocolError("a number is out of range");
  return span;
}

function readRegion(reader: Reader): Region {
  const number = reader.u32();
  const youngsModulus = readSpan(reader);
  if (!isModulus(youngsModulus.low) || !isModulus(youngsModulus.high)) throw new ProtocolError("a number is out of range");
  return { number, youngsModulus, poissonRatio: readSpan(reader), density: readSpan(reader) };
}

/**
 * @param count of listed regions, > 0
 * @param triangles of the object's surface
 */
export function readRegions(reader: Reader, count: number, flags: number, triangles: number): Regions {
  const list = Array.from({ length: count }, () => readRegion(reader));
  const surfaceModulus = reader.singles(triangles);
  const nodeCount = reader.u32();
  const faceCount = reader.u32();
  if (faceCount > MAX_FACES) throw new ProtocolError("a number is out of range");
  const nodes = reader.singles(3 * nodeCount);
  const faces = reader.words(3 * faceCount);
  if (faces.some((node) => node >= nodeCount)) throw new ProtocolError("a triangle has a node that is not there");
  const faceModulus = reader.singles(faceCount);
  const known = surfaceModulus.every((value) => Number.isNaN(value) || isModulus(value));
  if (!known || !faceModulus.every(isModulus)) throw new ProtocolError("a number is out of range");
  return { list, someUnlisted: (flags & 1) !== 0, facesLeftOut: (flags & 2) !== 0, surfaceModulus, nodes, faces, faceModulus };
}
