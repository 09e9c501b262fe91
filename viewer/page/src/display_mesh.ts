import * as THREE from "three";
import { means } from "./binding";
import { VIRIDIS } from "./colour_map";
import { smoothMesh, vertexNormals, type CreasedMesh } from "./creases";
import type { Display } from "./display";
import type { DrawnSurface } from "./drawn_surface";
import { NodeTexture, OF_NODES } from "./node_texture";
import { pictureOf } from "./picture";
import type { SceneObject } from "./protocol";
import { rampShader } from "./ramp_shader";
import { SurfaceLook } from "./surface_look";
import type { SurfaceMarks } from "./surface_marks";

/** A mesh that the computed surface takes along; its vertices are moved where they are drawn. B */
export class DisplayMesh {
  readonly mesh: THREE.Mesh;
  readonly look = new SurfaceLook();
  private readonly geometry: THREE.BufferGeometry;
  private readonly depth = new THREE.MeshDepthMaterial();
  private readonly ofNodes: NodeTexture;
  private readonly computed: CreasedMesh;
  /** of its nodes */
  private readonly normals: Float32Array;
  private disposed = false;

  constructor({ rest, triangles }: SceneObject, private readonly display: Display, marks: SurfaceMarks) {
    this.computed = smoothMesh(rest.length / 3, triangles);
    this.normals = new Float32Array(rest.length);
    vertexNormals(rest, this.computed, this.normals);
    this.ofNodes = new NodeTexture(rest.length / 3);
    this.geometry = geometryOf(display, rest, this.normals);
    const { material } = this.look;
    material.onBeforeCompile = (shader) => {
      marks.drawBy(shader);
      this.move(shader);
      turnAndColour(shader);
    };
    material.customProgramCacheKey = () => "display mesh";
    this.depth.onBeforeCompile = (shader) => this.move(shader);
    this.depth.customProgramCacheKey = () => "depth of a display mesh";
    this.mesh = new THREE.Mesh(this.geometry, material);
    this.mesh.customDepthMaterial = this.depth;
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
  }

  async loadTexture(): Promise<void> {
    if (this.display.texture === null) return;
    const texture = await pictureOf(this.display.texture);
    if (this.disposed) texture.dispose();
    else this.look.texture = texture;
  }

  draw({ displacement, exaggeration, positions }: DrawnSurface): void {
    this.ofNodes.setDisplacements(displacement, exaggeration);
    vertexNormals(positions, this.computed, this.normals);
    this.ofNodes.setNormals(this.normals);
  }

  /** @param shares of the ramp, 0 to 1, of the nodes; NaN: not known */
  paint(shares: Float32Array): void {
    this.ofNodes.setValues(shares);
  }

  private move(shader: THREE.WebGLProgramParametersWithUniforms): void {
    shader.uniforms["ofAllNodes"] = { value: this.ofNodes.texture };
    shader.vertexShader = (OF_NODES + TURNED + shader.vertexShader).replace(
      "#include <begin_vertex>",
      "#include <begin_vertex>\ntransformed += displacementOfNodes() + turned(gap) - gap;",
    );
  }

  dispose(): void {
    this.disposed = true;
    this.geometry.dispose();
    this.ofNodes.dispose();
    this.depth.dispose();
    this.look.dispose();
  }
}

/** @param rest, normals of the nodes at rest */
function geometryOf(display: Display, rest: Float32Array, normals: Float32Array): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  const bound = means(display, rest);
  const triples = {
    position: display.positions,
    normal: display.normals,
    nodes: display.nodes,
    weights: display.weights,
    rest: bound,
    gap: display.positions.map((part, i) => part - bound[i]!),
    boundNormal: means(display, normals),
  };
  for (const [name, numbers] of Object.entries(triples)) geometry.setAttribute(name, new THREE.BufferAttribute(numbers, 3));
  if (display.coordinates !== null) geometry.setAttribute("uv", new THREE.BufferAttribute(display.coordinates, 2));
  return geometry.setIndex(new THREE.BufferAttribute(display.triangles, 1));
}

/** Values are those of the nodes that the vertex is bound to. */
function turnAndColour(shader: THREE.WebGLProgramParametersWithUniforms): void {
  shader.vertexShader = (rampShader(VIRIDIS) + shader.vertexShader)
    .replace("#include <beginnormal_vertex>", "vec3 objectNormal = turned(normal);")
    .replace("#include <color_vertex>", "#ifdef USE_COLOR\nvColor = vec4(onRamp(valueOfNodes()), 1.0);\n#endif");
}

/** A normal, and the gap to the computed surface, turn as that does where the vertex is bound, on the shortest way. */
const TURNED = `
attribute vec3 boundNormal;
attribute vec3 gap;

vec3 turned(vec3 vector) {
  vec3 now = normalOfNodes();
  if (dot(boundNormal, boundNormal) < 1e-12 || dot(now, now) < 1e-12) return vector;
  vec3 from = normalize(boundNormal);
  vec3 to = normalize(now);
  vec3 axis = cross(from, to);
  float cosine = dot(from, to);
  return cosine * vector + cross(axis, vector) + dot(axis, vector) / max(1.0 + cosine, 1e-4) * axis;
}
`;
