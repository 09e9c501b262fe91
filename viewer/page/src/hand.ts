import { Plane, Vector3, type Ray } from "three";

const APPROACH_MS = 120;
const CLEARANCE = 0.005; // between tip and surface at the beginning [m]
const PUSH_DEPTH = 0.008; // below the surface as it was at the beginning [m]
const GRAB_DEPTH = 0.001; // where only what is touched can be taken hold of
const GRAB_DISTANCE = 0.002; // where there is a reach: the object is not pushed before it is held
const MOST_DEPTH = 0.08;

/**
 * A press by mouse or finger: the tip begins outside the surface, goes in along the view within a moment, and then
 * slides in the plane parallel to the screen at that depth. The tip of a fingertip is the point that touches, whatever
 * its radius; that of a ball is its centre. Pure; times in ms.
 */
export class Hand {
  private readonly plane = new Plane();
  private readonly way: number;
  private depth: number;
  private began: number | null = null; // when it was first asked where it is: outside, however late that was [ms]

  /**
   * @param place on the surface that is pressed, its true one however much exaggerated it is drawn [m], W
   * @param ray from the eye through the pointer, unit direction
   * @param forward from the eye through the middle of the screen, unit
   * @param reach distance from which it can take hold [m]
   * @param grabs to take hold, not to push
   * @param radius of a ball, whose centre the tip is [m]; 0 for a tip that touches with its point
   */
  constructor(
    private readonly place: Vector3,
    private ray: Ray,
    private readonly forward: Vector3,
    reach: number,
    grabs: boolean,
    radius = 0,
  ) {
    const grabDepth = reach > 0 ? -Math.min(GRAB_DISTANCE, 0.4 * reach) : GRAB_DEPTH;
    this.depth = grabs ? grabDepth : PUSH_DEPTH;
    this.way = this.depth + CLEARANCE;
    const end = place.clone().addScaledVector(ray.direction, this.depth - radius);
    this.plane.setFromNormalAndCoplanarPoint(forward, end);
    this.holdsFromAfar = reach > 0;
  }
  private readonly holdsFromAfar: boolean;

  /** The pointer has moved. */
  aim(ray: Ray): void {
    this.ray = ray;
  }

  /** Deeper, along the view. [m] */
  deepen(way: number): void {
    const depth = Math.min(Math.max(this.depth + way, -CLEARANCE), MOST_DEPTH);
    this.carry(depth - this.depth);
    this.depth = depth;
  }

  /** Nothing bounds the depth of what is held: it is moved to and fro. [m] */
  carry(way: number): void {
    this.plane.constant -= way * this.ray.direction.dot(this.forward);
  }

  /** Where the tip ought to be [m], W. */
  tip(now: number): Vector3 {
    const at = this.ray.intersectPlane(this.plane, new Vector3()) ?? this.place.clone();
    this.began ??= now;
    const left = 1 - Math.min(Math.max((now - this.began) / APPROACH_MS, 0), 1);
    return at.addScaledVector(this.ray.direction, -this.way * left * left * (3 - 2 * left));
  }

  /** Not on the way there, where it would take hold from afar and then push. */
  mayTakeHold(now: number): boolean {
    return !this.holdsFromAfar || (this.began !== null && now - this.began >= APPROACH_MS);
  }

  /** Comes from outside once more. */
  again(): void {
    this.began = null;
  }
}
