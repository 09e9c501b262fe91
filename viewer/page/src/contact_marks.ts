import * as THREE from "three";
import { colourAt, linear, PLASMA } from "./colour_map";
import { HEAD_LENGTH, headGeometry, LEAST_FORCE, METRES_PER_NEWTON, shaftGeometry, UP } from "./force_arrow";
import { MAX_CONTACTS, type BodyContact } from "./protocol";
import type { Theme } from "./theme";

const OUT = new THREE.Vector3(0, 0, 1); // normal of a disc
const ON_TOP = { depthTest: false, transparent: true };

/** Force along the normal per area of the patch [Pa], at least 0. Pure. */
export function pressure({ force, normal, area }: BodyContact): number {
  const pressing = force[0] * normal[0] + force[1] * normal[1] + force[2] * normal[2];
  return pressing > 0 && area > 0 ? pressing / area : 0;
}

/**
 * Contacts between bodies: the force on one of them as an arrow of 4 cm a newton, the patch that it acts on as a disc
 * in the colour of its pressure. Seen through the objects.
 */
export class ContactMarks {
  readonly group = new THREE.Group();
  /** pressure at the ramp's end [Pa]; 0: nothing has touched */
  largest = 0;
  private readonly arrowMaterial = new THREE.MeshBasicMaterial({ ...ON_TOP, opacity: 0.9 });
  readonly shafts = instances(shaftGeometry(), this.arrowMaterial, 2);
  readonly heads = instances(headGeometry(), this.arrowMaterial, 2);
  readonly discs = instances(
    new THREE.CircleGeometry(1, 32),
    new THREE.MeshBasicMaterial({ ...ON_TOP, opacity: 0.85, side: THREE.DoubleSide, toneMapped: false }),
    1,
  );

  constructor() {
    this.group.add(this.discs, this.shafts, this.heads);
  }

  /** The ramp begins anew. */
  clear(): void {
    this.largest = 0;
    this.follow([]);
  }

  /** The ramp's end follows upwards at once and downwards slowly, so that colours can be compared. */
  follow(contacts: readonly BodyContact[]): void {
    if (contacts.length > 0) this.largest = Math.max(0.995 * this.largest, ...contacts.map(pressure));
    this.discs.count = contacts.length;
    contacts.forEach((contact, i) => this.putDisc(contact, i));
    const pushing = contacts.filter(({ force }) => Math.hypot(...force) > LEAST_FORCE);
    this.shafts.count = this.heads.count = pushing.length;
    pushing.forEach((contact, i) => this.putArrow(contact, i));
    for (const mesh of [this.discs, this.shafts, this.heads]) mesh.instanceMatrix.needsUpdate = true;
    if (this.discs.instanceColor !== null) this.discs.instanceColor.needsUpdate = true;
  }

  private putDisc(contact: BodyContact, i: number): void {
    const radius = Math.sqrt(Math.max(contact.area, 0) / Math.PI);
    const turn = new THREE.Quaternion().setFromUnitVectors(OUT, new THREE.Vector3(...contact.normal).normalize());
    const size = new THREE.Vector3(radius, radius, 1);
    this.discs.setMatrixAt(i, new THREE.Matrix4().compose(new THREE.Vector3(...contact.position), turn, size));
    const parts = new Float32Array(3);
    colourAt(PLASMA, this.largest > 0 ? pressure(contact) / this.largest : 0, parts, 0);
    const [red, green, blue] = parts;
    this.discs.setColorAt(i, new THREE.Color(linear(red!), linear(green!), linear(blue!)));
  }

  private putArrow({ position, force }: BodyContact, i: number): void {
    const way = new THREE.Vector3(...force);
    const length = way.length() * METRES_PER_NEWTON;
    const turn = new THREE.Quaternion().setFromUnitVectors(UP, way.normalize());
    const from = new THREE.Vector3(...position);
    const head = Math.min(1, length / (2 * HEAD_LENGTH)); // that of a short arrow is small
    const width = new THREE.Vector3(head, length, head);
    this.shafts.setMatrixAt(i, new THREE.Matrix4().compose(from, turn, width));
    const to = from.addScaledVector(way, length);
    this.heads.setMatrixAt(i, new THREE.Matrix4().compose(to, turn, new THREE.Vector3(head, head, head)));
  }

  applyTheme(theme: Theme): void {
    this.arrowMaterial.color.set(theme.ink); // which the ramp does not have
  }
}

function instances(geometry: THREE.BufferGeometry, material: THREE.Material, order: number): THREE.InstancedMesh {
  const mesh = new THREE.InstancedMesh(geometry, material, MAX_CONTACTS);
  mesh.count = 0;
  mesh.frustumCulled = false;
  mesh.renderOrder = order;
  return mesh;
}
