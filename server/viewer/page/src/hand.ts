import { Plane, Vector3, type Ray } from "three";

const APPROACH_MS = 120;
const CLEARANCE = 0.005; // between tip and surface at the beginning [m]
const PUSH_DEPTH = 0.008; // how far it goes beyond first touch [m]
const GRAB_DEPTH = 0.001;
const MOST_DEPTH = 0.08;
const LEAST_COSINE = 0.3; // of the view's angle to the surface; beyond, the way to first touch grows without end

/** Where on an object a press began: true positions, however much exaggerated the object is drawn. [m], W */
export interface PressPoint {
  point: Vector3;
  /** outward, unit */
  normal: Vector3;
}

/**
 * A press by mouse or finger: the tip begins outside the surface, goes in along the view within a moment, and then
 * slides in the plane parallel to the screen at that depth. Pure; times in ms.
 */
export class Hand {
  private readonly plane: Plane;
  private readonly first: Vector3;
  private depth: number;

  /**
   * @param ray from the eye through the pointer, unit direction
   * @param forward from the eye through the middle of the screen, unit
   * @param radius of the fingertip [m]
   * @param grabs to take hold, not to push
   * @param now [ms]
   */
  constructor(
    press: PressPoint,
    private ray: Ray,
    private readonly forward: Vector3,
    radius: number,
    grabs: boolean,
    private began: number,
  ) {
    // A ball touches a plane before its middle is there.
    const cosine = Math.max(LEAST_COSINE, -press.normal.dot(ray.direction));
    this.first = press.point.clone().addScaledVector(ray.direction, -radius / cosine);
    this.depth = grabs ? GRAB_DEPTH : PUSH_DEPTH;
    this.start = this.depth + CLEARANCE;
    this.plane = new Plane();
    this.layPlane(this.first.clone().addScaledVector(ray.direction, this.depth));
  }
  private readonly start: number;

  private layPlane(point: Vector3): void {
    this.plane.setFromNormalAndCoplanarPoint(this.forward, point);
  }

  /** The pointer has moved. */
  aim(ray: Ray): void {
    this.ray = ray;
  }

  /** Deeper, along the view. [m] */
  deepen(way: number): void {
    const depth = Math.min(Math.max(this.depth + way, -CLEARANCE), MOST_DEPTH);
    this.plane.constant -= (depth - this.depth) * this.ray.direction.dot(this.forward);
    this.depth = depth;
  }

  /** Nothing bounds the depth of what is held: it is moved to and fro. [m] */
  carry(way: number): void {
    this.plane.constant -= way * this.ray.direction.dot(this.forward);
  }

  /** Where the tip ought to be [m], W. */
  tip(now: number): Vector3 {
    const at = this.ray.intersectPlane(this.plane, new Vector3()) ?? this.first.clone();
    const left = 1 - Math.min(Math.max((now - this.began) / APPROACH_MS, 0), 1);
    return at.addScaledVector(this.ray.direction, -this.start * left * left * (3 - 2 * left));
  }

  /** It is where it presses: only now may it take hold, else the object would be pushed on the way there. */
  arrived(now: number): boolean {
    return now - this.began >= APPROACH_MS;
  }

  /** Comes from outside once more. */
  again(now: number): void {
    this.began = now;
  }
}
