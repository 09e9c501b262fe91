import type { Mesh } from "three";
import { ComputedMesh } from "./computed_mesh";
import { DisplayMesh } from "./display_mesh";
import type { DrawnSurface } from "./drawn_surface";
import type { SceneObject } from "./protocol";
import type { Span } from "./regions";
import { SurfaceMarks } from "./surface_marks";
import type { Theme } from "./theme";

/** What the colours of a surface stand for: nothing, values of its nodes, or Young's moduli of its triangles. */
export type Colours = "none" | "modulus" | Float32Array;

/** The surface of an object as it is looked at: its display mesh where it has one, else the triangles that compute. */
export class ShownSurface {
  readonly marks = new SurfaceMarks();
  /** the triangles that compute, in any case */
  computedOnly = false;
  private readonly computed: ComputedMesh;
  private readonly display: DisplayMesh | null;
  private readonly shares: Float32Array;

  constructor(object: SceneObject) {
    this.computed = new ComputedMesh(object, this.marks);
    this.display = object.display === null ? null : new DisplayMesh(object, object.display, this.marks);
    this.shares = new Float32Array(object.rest.length / 3);
  }

  get meshes(): Mesh[] {
    return this.both.map(({ mesh }) => mesh);
  }

  private get both(): (ComputedMesh | DisplayMesh)[] {
    return this.display === null ? [this.computed] : [this.computed, this.display];
  }

  /** Fails when there is one that cannot be read: it then stays plain. */
  async loadTexture(): Promise<void> {
    await this.display?.loadTexture();
  }

  /** Below 1 it is looked through. */
  set opacity(opacity: number) {
    for (const { look } of this.both) look.opacity = opacity;
  }

  applyTheme(theme: Theme): void {
    for (const { look } of this.both) look.plain = theme.object;
    this.marks.colour = theme.accent;
  }

  /** @param range at both ends of the colours' ramp */
  draw(drawn: DrawnSurface, colours: Colours, range: Span): void {
    const shown = this.chosen(colours);
    for (const { mesh } of this.both) mesh.visible = mesh === shown.mesh;
    shown.draw(drawn);
    if (colours === "modulus") this.computed.paintModuli(range);
    else if (colours !== "none") shown.paint(this.sharesOf(colours, range));
    shown.look.show(colours !== "none");
    this.marks.coloursAreValues = colours !== "none";
  }

  private chosen(colours: Colours): ComputedMesh | DisplayMesh {
    return this.computedOnly || colours === "modulus" || this.display === null ? this.computed : this.display;
  }

  /** @param values of the nodes; NaN: not known */
  private sharesOf(values: Float32Array, { low, high }: Span): Float32Array {
    const share = (value: number): number => Math.min(Math.max((value - low) / (high - low), 0), 1);
    const known = high > low ? share : () => 0;
    values.forEach((value, i) => (this.shares[i] = Number.isNaN(value) ? value : known(value)));
    return this.shares;
  }

  dispose(): void {
    for (const mesh of this.both) mesh.dispose();
  }
}
