import * as THREE from "three";
import { colourAt, linear, PLASMA } from "./colour_map";
import { HEAD_LENGTH, headGeometry, LEAST_FORCE, shaftGeometry, UP } from "./force_arrow";
import { ALL_OVERLAYS, type Overlays } from "./overlays";
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
 * Contacts between bodies: the force on one of them as an arrow, the patch that it acts on as a disc, in the colour of its
 * pressure or plain. Seen through the objects.
 */
export class ContactMarks {
  readonly group = new THREE.Group();
  private largest = 0; // pressure of late [Pa]; 0: nothing has touched
  private overlays = ALL_OVERLAYS;
  private metresPerNewton = 1;
  private readonly plain = new THREE.Color();
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

  /** Pressure at the ramp's end [Pa]; 0: nothing has touched. */
  get end(): number {
    return this.largest > 0 ? (this.overlays.pressureEnd ?? this.largest) : 0;
  }

  /** The ramp begins anew. */
  clear(): void {
    this.largest = 0;
    this.follow([], this.overlays, this.metresPerNewton);
  }

  /** The ramp's end follows upwards at once and downwards slowly, so that colours can be compared. */
  follow(contacts: readonly BodyContact[], overlays: Overlays, metresPerNewton: number): void {
    this.overlays = overlays;
    this.metresPerNewton = metresPerNewton;
    this.discs.visible = overlays.contacts || overlays.pressure;
    this.shafts.visible = this.heads.visible = overlays.forces;
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
    if (!this.overlays.pressure) {
      this.discs.setColorAt(i, this.plain);
      return;
    }
    const parts = new Float32Array(3);
    colourAt(PLASMA, this.end > 0 ? pressure(contact) / this.end : 0, parts, 0);
    const [red, green, blue] = parts;
    this.discs.setColorAt(i, new THREE.Color(linear(red!), linear(green!), linear(blue!)));
  }

  private putArrow({ position, force }: BodyContact, i: number): void {
    const way = new THREE.Vector3(...force);
    const length = way.length() * this.metresPerNewton;
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
    this.plain.set(theme.accent);
  }
}

function instances(geometry: THREE.BufferGeometry, material: THREE.Material, order: number): THREE.InstancedMesh {
  const mesh = new THREE.InstancedMesh(geometry, material, MAX_CONTACTS);
  mesh.count = 0;
  mesh.frustumCulled = false;
  mesh.renderOrder = order;
  return mesh;
}
