import * as THREE from "three";

export const LEAST_FORCE = 0.005; // below it no arrow [N]
export const UP = new THREE.Vector3(0, 1, 0);

/** Of an arrow along UP from the origin, 1 m long: it is scaled along UP. */
export function shaftGeometry(): THREE.BufferGeometry {
  return new THREE.CylinderGeometry(0.0009, 0.0009, 1, 16).translate(0, 0.5, 0);
}

export const HEAD_LENGTH = 0.007; // [m]

/** About the arrow's end. */
export function headGeometry(): THREE.BufferGeometry {
  return new THREE.ConeGeometry(0.0026, HEAD_LENGTH, 20);
}
