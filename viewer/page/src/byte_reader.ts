import type { Quat, Vec3 } from "./protocol";

export class ProtocolError extends Error {}

/** Takes a message apart from front to back. Every length is checked before it is used. */
export class Reader {
  private at = 0;
  private readonly view: DataView;

  constructor(private readonly bytes: ArrayBuffer) {
    this.view = new DataView(bytes);
  }
  private take(count: number): number {
    if (count > this.bytes.byteLength - this.at) throw new ProtocolError("a message is too short");
    const at = this.at;
    this.at += count;
    return at;
  }
  u8(): number {
    return this.view.getUint8(this.take(1));
  }
  i8(): number {
    return this.view.getInt8(this.take(1));
  }
  u16(): number {
    return this.view.getUint16(this.take(2), true);
  }
  i16(): number {
    return this.view.getInt16(this.take(2), true);
  }
  u32(): number {
    return this.view.getUint32(this.take(4), true);
  }
  /** Exact up to 2^53, which is enough for counts. */
  u64(): number {
    return Number(this.view.getBigUint64(this.take(8), true));
  }
  f32(): number {
    return this.view.getFloat32(this.take(4), true);
  }
  f64(): number {
    return this.view.getFloat64(this.take(8), true);
  }
  vector(): Vec3 {
    return [this.f64(), this.f64(), this.f64()];
  }
  singleVector(): Vec3 {
    return [this.f32(), this.f32(), this.f32()];
  }
  /** w, x, y, z */
  quaternion(): Quat {
    return [this.f32(), this.f32(), this.f32(), this.f32()];
  }
  text(length: number): string {
    return new TextDecoder().decode(new Uint8Array(this.bytes, this.take(length), length));
  }
  /** Little-endian, as every machine is that has a browser. The offsets in the protocol are multiples of 4. */
  singles(count: number): Float32Array {
    return new Float32Array(this.bytes, this.take(4 * count), count);
  }
  words(count: number): Uint32Array {
    return new Uint32Array(this.bytes, this.take(4 * count), count);
  }
  shorts(count: number): Int16Array {
    return new Int16Array(this.bytes, this.take(2 * count), count);
  }
  longs(count: number): Int32Array {
    return new Int32Array(this.bytes, this.take(4 * count), count);
  }
  octets(count: number): Uint8Array<ArrayBuffer> {
    return new Uint8Array(this.bytes, this.take(count), count);
  }
  skip(count: number): void {
    this.take(count);
  }
  align(): void {
    this.skip((4 - (this.at % 4)) % 4);
  }
  /** Of a text in a field that is filled up with zeros. */
  field(length: number, size: number): string {
    if (length > size) throw new ProtocolError("a text is longer than its field");
    const text = this.text(length);
    this.skip(size - length);
    return text;
  }
  finish(): void {
    if (this.at !== this.bytes.byteLength) throw new ProtocolError("a message is too long");
  }
}
