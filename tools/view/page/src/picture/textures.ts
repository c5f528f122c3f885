// SPDX-License-Identifier: Apache-2.0
import { RepeatWrapping, SRGBColorSpace, Texture } from "three";
import { none, type Scene, type SceneMeshTexture, type SceneShape } from "../data/messages";

const mostTextures = 64;
const mostPixels = 8192; // along an edge
const sharpness = 4; // anisotropy: samples along a surface that is seen at a low angle

interface Uses {
  ofMeshes: Map<number, SceneMeshTexture>;
  ofShapes: Map<SceneShape, number>;
}
const usesOfScenes = new WeakMap<Scene, Uses>();

function usesOf(scene: Scene): Uses {
  let uses = usesOfScenes.get(scene);
  if (uses) return uses;
  uses = {
    ofMeshes: new Map(scene.mesh_textures.map((each) => [each.mesh, each])),
    ofShapes: new Map(
      scene.shape_textures.flatMap(({ model, link, shape, texture }) => {
        const found = scene.models[model]?.links[link]?.shapes[shape];
        return found ? [[found, texture] as const] : [];
      }),
    ),
  };
  usesOfScenes.set(scene, uses);
  return uses;
}

/** Returns u and v of each corner of each triangle of a mesh; undefined if it has none. */
export const coordinatesOf = (scene: Scene, mesh: number): Float32Array | undefined =>
  usesOf(scene).ofMeshes.get(mesh)?.coordinates;

/** Returns whether one texture applies to a whole shape. */
export const hasTexture = (scene: Scene, shape: SceneShape): boolean => usesOf(scene).ofShapes.has(shape);

/** Returns a function from the index of a shape's triangle to the index of its texture, or `none`. */
export function texturesOf(scene: Scene, shape: SceneShape): ((triangle: number) => number) | undefined {
  const { ofShapes, ofMeshes } = usesOf(scene);
  const whole = ofShapes.get(shape);
  if (whole !== undefined) return () => whole;
  const textures = shape.has_mesh_colors ? ofMeshes.get(shape.mesh)?.textures : undefined;
  return textures && textures.length > 0 ? (triangle) => textures[triangle] ?? none : undefined;
}

/** The images of a scene, which are decoded in the background. An image that the browser cannot decode is ignored. */
export class Textures {
  /** The numbers of images that are shown and that cannot be decoded. */
  readonly counts = { shown: 0, broken: 0 };
  /** Resolves when all images are decoded. */
  readonly ready: Promise<unknown>;
  private readonly decoded: Promise<Texture | undefined>[];
  private isDisposed = false;

  constructor(scene: Scene) {
    this.decoded = scene.textures.slice(0, mostTextures).map(({ image }) => this.decode(image));
    this.ready = Promise.all(this.decoded);
  }

  /** Calls `show` with the image of this index once it is decoded. */
  use(index: number, show: (texture: Texture) => void): void {
    void this.decoded[index]?.then((texture) => {
      if (texture && !this.isDisposed) show(texture);
    });
  }

  dispose(): void {
    this.isDisposed = true;
    for (const each of this.decoded)
      void each.then((texture) => {
        texture?.dispose();
        (texture?.image as ImageBitmap | undefined)?.close();
      });
  }

  private async decode(bytes: Uint8Array): Promise<Texture | undefined> {
    try {
      const bitmap = await createImageBitmap(new Blob([bytes as Uint8Array<ArrayBuffer>]), {
        imageOrientation: "flipY", // v points upwards
        premultiplyAlpha: "none",
      });
      if (Math.max(bitmap.width, bitmap.height) > mostPixels) throw new Error("the image is too large");
      const texture = new Texture(bitmap, undefined, RepeatWrapping, RepeatWrapping);
      Object.assign(texture, { flipY: false, colorSpace: SRGBColorSpace, anisotropy: sharpness, needsUpdate: true });
      ++this.counts.shown;
      return texture;
    } catch {
      ++this.counts.broken;
      return undefined;
    }
  }
}
