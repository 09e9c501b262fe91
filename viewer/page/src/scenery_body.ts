import * as THREE from "three";
import { Ground, UP } from "./ground";
import type { Scenery, Shape } from "./protocol";
import type { Theme } from "./theme";

/** A body that never moves: a solid one, or of a plane the part that is round the objects. */
export class SceneryBody {
  readonly group = new THREE.Group();
  private readonly material = new THREE.MeshStandardMaterial({ roughness: 0.85 });
  private readonly solid: THREE.Mesh | null;
  private readonly ground: Ground | null;

  constructor(private readonly scenery: Scenery) {
    const geometry = geometryOf(scenery.shape);
    this.solid = geometry === null ? null : new THREE.Mesh(geometry, this.material);
    this.ground = geometry === null ? new Ground() : null;
    if (this.ground !== null) this.group.add(this.ground.group);
    if (this.solid === null) return;
    this.solid.position.set(...scenery.position);
    this.solid.quaternion.copy(this.orientation());
    this.solid.castShadow = true;
    this.solid.receiveShadow = true;
    this.group.add(this.solid);
  }

  /** @param objects the ball that they are in [m], W */
  place(objects: THREE.Sphere, theme: Theme): void {
    const normal = UP.clone().applyQuaternion(this.orientation());
    this.ground?.place(objects, normal, normal.dot(new THREE.Vector3(...this.scenery.position)), theme.line);
  }

  applyTheme(theme: Theme): void {
    this.material.color.set(theme.scenery);
    this.ground?.applyTheme(theme);
  }

  private orientation(): THREE.Quaternion {
    const [w, x, y, z] = this.scenery.orientation;
    return new THREE.Quaternion(x, y, z, w);
  }

  dispose(): void {
    this.solid?.geometry.dispose();
    this.material.dispose();
    this.ground?.dispose();
  }
}

/** null: a plane has no end. */
function geometryOf(shape: Shape): THREE.BufferGeometry | null {
  switch (shape.kind) {
    case "plane":
      return null;
    case "box":
      return new THREE.BoxGeometry(...shape.size);
    case "sphere":
      return new THREE.SphereGeometry(shape.radius, 48, 32);
    case "capsule":
      return new THREE.CapsuleGeometry(shape.radius, shape.length, 16, 48);
    case "mesh":
      return facetted(shape.nodes, shape.triangles);
  }
}

/** Each triangle flat, as contacts find it. */
function facetted(nodes: Float32Array, triangles: Uint32Array): THREE.BufferGeometry {
  const indexed = new THREE.BufferGeometry();
  indexed.setAttribute("position", new THREE.BufferAttribute(nodes, 3));
  indexed.setIndex(new THREE.BufferAttribute(triangles, 1));
  const flat = indexed.toNonIndexed();
  indexed.dispose();
  flat.computeVertexNormals();
  return flat;
}
