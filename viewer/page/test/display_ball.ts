// An octahedron that computes and the ball that is drawn in its place.
import type { DisplayParts, ObjectParts } from "./server_messages.ts";

type Point = [number, number, number];

/** A picture of two by two: red above, blue below; a PNG file. */
export const RED_OVER_BLUE = [...atob("iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAIAAAD91JpzAAAAEUlEQVR42mN4JiICRAxg8hkAHZYEObC9oD8AAAAASUVORK5CYII=")].map(
  (sign) => sign.charCodeAt(0),
);

/** Nodes at both ends of each axis. */
function octahedron(radius: number): { rest: number[]; triangles: number[] } {
  const rest = [0, 1, 2].flatMap((axis) => [-radius, radius].flatMap((end) => [0, 1, 2].map((c) => (c === axis ? end : 0))));
  const triangles = Array.from({ length: 8 }, (_, octant) => {
    const [x, y, z] = [octant & 1, (octant >> 1) & 1, octant >> 2];
    const corners = [x, 2 + y, 4 + z];
    return (x + y + z) % 2 === 1 ? corners : corners.reverse();
  });
  return { rest, triangles: triangles.flat() };
}

/** A triangle's grid of points on the ball round it, `cells` an edge: weights, and triangles of them. */
function grid(cells: number): { weights: Point[]; triangles: Point[] } {
  const weights: Point[] = [];
  const triangles: Point[] = [];
  const number = (i: number, j: number): number => (i * (i + 1)) / 2 + j;
  for (let i = 0; i <= cells; ++i) {
    for (let j = 0; j <= i; ++j) {
      weights.push([(cells - i) / cells, (i - j) / cells, j / cells]);
      if (i === cells) continue;
      triangles.push([number(i, j), number(i + 1, j), number(i + 1, j + 1)]);
      if (j < i) triangles.push([number(i, j), number(i + 1, j + 1), number(i, j + 1)]);
    }
  }
  return { weights, triangles };
}

function unit(point: Point): Point {
  const length = Math.hypot(...point);
  return point.map((part) => part / length) as Point;
}

function display(radius: number, rest: number[], corners: number[], cells: number): DisplayParts {
  const parts: DisplayParts = { positions: [], normals: [], triangles: [], nodes: [], weights: [], coordinates: [] };
  const { weights, triangles } = grid(cells);
  for (let t = 0; t < corners.length; t += 3) {
    const nodes = corners.slice(t, t + 3);
    const first = parts.positions.length / 3;
    const above = nodes.some((node) => rest[3 * node + 1]! > 0);
    for (const shares of weights) {
      const point = [0, 1, 2].map((c) => nodes.reduce((sum, node, i) => sum + shares[i]! * rest[3 * node + c]!, 0)) as Point;
      parts.normals.push(...unit(point));
      parts.positions.push(...unit(point).map((part) => radius * part));
      parts.nodes.push(...nodes);
      parts.weights.push(...shares);
      parts.coordinates!.push(0.5, above ? 0.75 : 0.25);
    }
    parts.triangles.push(...triangles.flat().map((vertex) => first + vertex));
  }
  return parts;
}

/**
 * The ball has a picture on it whose upper half is above.
 * @param radius of both [m]
 * @param cells of the ball along an edge of the octahedron
 */
export function ball(radius: number, cells: number, texture: number[] = RED_OVER_BLUE): ObjectParts & { display: DisplayParts } {
  const { rest, triangles } = octahedron(radius);
  const shown = { ...display(radius, rest, triangles, cells), texture };
  return { name: "ball", rest, triangles, compliance: [1, 2, 3, 4, 5, 6].map((c) => 0.001 * c), display: shown };
}
