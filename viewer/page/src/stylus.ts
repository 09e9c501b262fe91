import * as THREE from "three";
import { headGeometry, LEAST_FORCE, shaftGeometry, UP } from "./force_arrow";
import type { Overlays } from "./overlays";
import { Contact, type SceneStylus, type StylusState } from "./protocol";
import { Spring } from "./spring";
import type { Theme } from "./theme";

const SMALLEST_TIP = 0.0022; // a point must be seen [m]

/** Tip, proxy, the spring between them, and the force on the stylus as an arrow. */
export class Stylus {
  readonly group = new THREE.Group();
  /** where this viewer's hand wants the tip [m], W; null: it is not this viewer's stylus */
  asked: THREE.Vector3 | null = null;
  private readonly tipMaterial = new THREE.MeshStandardMaterial({ roughness: 0.35 });
  private readonly ghostMaterial = new THREE.MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.28 });
  private readonly proxyMaterial = new THREE.MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.9 });
  private readonly arrowMaterial = new THREE.MeshStandardMaterial({ roughness: 0.5 });
  private readonly radius: number;
  private readonly ball: boolean;
  private readonly tip: THREE.Mesh;
  private readonly proxy: THREE.Mesh;
  private readonly spring = new Spring();
  private readonly arrow = new THREE.Group();
  private readonly shaft: THREE.Mesh;
  private readonly head: THREE.Mesh;

  constructor(stylus: SceneStylus) {
    this.radius = Math.max(stylus.radius, SMALLEST_TIP);
    this.ball = stylus.ball;
    this.tip = new THREE.Mesh(new THREE.SphereGeometry(this.radius, 32, 20), this.tipMaterial);
    this.tip.castShadow = true;
    if (stylus.radius > SMALLEST_TIP) {
      // A fingertip lets through what it touches.
      Object.assign(this.tipMaterial, { transparent: true, opacity: 0.5, depthWrite: false });
    }
    const ghost = new THREE.Mesh(this.tip.geometry, this.ghostMaterial); // the tip is seen through the objects
    ghost.renderOrder = 1;
    this.tip.add(ghost);
    this.proxy = new THREE.Mesh(new THREE.SphereGeometry(SMALLEST_TIP * 0.7, 20, 12), this.proxyMaterial);
    this.proxy.renderOrder = 2;
    this.shaft = new THREE.Mesh(shaftGeometry(), this.arrowMaterial);
    this.head = new THREE.Mesh(headGeometry(), this.arrowMaterial);
    this.arrow.add(this.shaft, this.head);
    this.group.add(this.tip, this.proxy, this.spring.mesh, this.arrow);
    this.group.visible = false;
  }

  /** @param shift by which the surface that it touches is drawn away from its true place [m], W */
  follow(state: StylusState, overlays: Overlays, metresPerNewton: number, shift: THREE.Vector3): void {
    this.group.visible = state.present;
    this.group.position.copy(shift);
    if (!state.present) return;
    const touches = state.contact !== Contact.Free && overlays.contacts;
    // The proxy of a ball is its centre: the ball lies on the surface, the spring leads to the position of the stylus.
    const place = this.ball ? state.proxy : state.tip;
    this.tip.position.set(...place);
    this.proxy.visible = touches;
    this.proxy.position.set(...state.proxy);
    this.spring.mesh.visible = touches;
    if (touches) this.spring.span(this.asked ?? new THREE.Vector3(...state.tip), this.proxy.position);
    this.arrow.visible = overlays.forces;
    if (overlays.forces) this.point(new THREE.Vector3(...state.force), place, metresPerNewton);
  }

  /** From where the arrow leaves the tip. */
  private point(force: THREE.Vector3, tip: readonly [number, number, number], metresPerNewton: number): void {
    const size = force.length();
    this.arrow.visible = size > LEAST_FORCE;
    if (!this.arrow.visible) return;
    const length = size * metresPerNewton;
    force.divideScalar(size);
    this.arrow.position.set(...tip).addScaledVector(force, this.radius);
    this.arrow.quaternion.setFromUnitVectors(UP, force);
    this.shaft.scale.y = length;
    this.head.position.y = length;
  }

  applyTheme(theme: Theme): void {
    this.tipMaterial.color.set(theme.ink);
    this.ghostMaterial.color.set(theme.ink);
    this.proxyMaterial.color.set(theme.accent);
    this.spring.mesh.material.color.set(theme.force);
    this.arrowMaterial.color.set(theme.force);
  }

  dispose(): void {
    for (const part of [this.tip, this.proxy, this.shaft, this.head]) part.geometry.dispose();
    this.spring.dispose();
    const { tipMaterial, ghostMaterial, proxyMaterial, arrowMaterial } = this;
    for (const one of [tipMaterial, ghostMaterial, proxyMaterial, arrowMaterial]) one.dispose();
  }
}
