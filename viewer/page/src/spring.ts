import * as THREE from "three";

const LENGTH = 0.02; // as it was wound; it is drawn longer and shorter by scaling [m]
const TURNS = 6;
const RADIUS = 0.0016;
const WIRE = 0.00032;
const LEAST = 0.0004; // shorter it is not drawn [m]
const UP = new THREE.Vector3(0, 1, 0);

class Helix extends THREE.Curve<THREE.Vector3> {
  constructor() {
    super();
  }
  override getPoint(at: number, into = new THREE.Vector3()): THREE.Vector3 {
    const angle = 2 * Math.PI * TURNS * at;
    const radius = RADIUS * Math.min(1, 8 * at, 8 * (1 - at)); // both ends are on the axis
    return into.set(radius * Math.cos(angle), LENGTH * at, radius * Math.sin(angle));
  }
}

/** What is between the hand and the surface that holds it back. Seen through the objects. */
export class Spring {
  readonly mesh: THREE.Mesh<THREE.TubeGeometry, THREE.MeshBasicMaterial>;

  constructor() {
    const wire = new THREE.TubeGeometry(new Helix(), TURNS * 18, WIRE, 6);
    this.mesh = new THREE.Mesh(wire, new THREE.MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.95 }));
    this.mesh.renderOrder = 3;
    this.mesh.frustumCulled = false;
  }

  span(from: THREE.Vector3, to: THREE.Vector3): void {
    const way = to.clone().sub(from);
    const length = way.length();
    this.mesh.visible = length > LEAST;
    if (!this.mesh.visible) return;
    this.mesh.position.copy(from);
    this.mesh.quaternion.setFromUnitVectors(UP, way.divideScalar(length));
    this.mesh.scale.y = length / LENGTH;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
