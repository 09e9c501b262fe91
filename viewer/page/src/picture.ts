import * as THREE from "three";

/**
 * The picture of a PNG or JPEG file as a texture, which is repeated beyond its edges. The browser turns the picture over
 * while it reads it, as WebGL would not.
 */
export async function pictureOf(file: Uint8Array<ArrayBuffer>): Promise<THREE.Texture> {
  const options: ImageBitmapOptions = { imageOrientation: "flipY", premultiplyAlpha: "none" };
  const texture = new THREE.Texture(await createImageBitmap(new Blob([file]), options));
  texture.flipY = false;
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.anisotropy = 4;
  texture.needsUpdate = true;
  texture.addEventListener("dispose", () => (texture.image as ImageBitmap).close());
  return texture;
}
