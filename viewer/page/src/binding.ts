// How a finer mesh hangs on the nodes of a surface, three a vertex. Pure.

export interface Binding {
  /** three a vertex */
  nodes: Uint32Array;
  /** of these nodes; their sum is 1 */
  weights: Float32Array;
}

/** Of vectors that nodes have: the weighted mean for each vertex, three numbers. */
export function means({ nodes, weights }: Binding, vectors: Float32Array): Float32Array {
  const found = new Float32Array(nodes.length);
  for (let i = 0; i < nodes.length; ++i) {
    const vertex = i - (i % 3);
    for (let c = 0; c < 3; ++c) found[vertex + c] = found[vertex + c]! + weights[i]! * vectors[3 * nodes[i]! + c]!;
  }
  return found;
}
