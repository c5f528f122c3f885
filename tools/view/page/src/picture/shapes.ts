// SPDX-License-Identifier: Apache-2.0
import {
  Box3,
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  Color,
  CylinderGeometry,
  Matrix4,
  Quaternion,
  SphereGeometry,
  Vector3,
} from "three";
import { mergeGeometries, toCreasedNormals } from "three/addons/utils/BufferGeometryUtils.js";
import { none, type Scene, type SceneMesh, type SceneShape, ShapeKind } from "../data/messages";
import { coordinatesOf, texturesOf } from "./textures";

/** Returns the number of segments of round shapes: fewer if there are many instances. */
const segmentsOf = (instances: number): number => (instances <= 500 ? 28 : instances <= 3000 ? 16 : 10);
const crease = 0.6; // [rad]; sharper edges are drawn as edges

function meshGeometry(mesh: SceneMesh): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(mesh.vertices, 3));
  geometry.setIndex(new BufferAttribute(mesh.triangles, 1));
  return toCreasedNormals(geometry, crease);
}

function plainGeometry(scene: Scene, shape: SceneShape, round: number): BufferGeometry {
  const [a, b, c] = shape.size;
  const upright = (geometry: BufferGeometry): BufferGeometry => geometry.rotateX(Math.PI / 2); // three's axis is y
  switch (shape.kind) {
    case ShapeKind.box:
      return upright(new BoxGeometry(a, c, b));
    case ShapeKind.sphere:
      return upright(new SphereGeometry(a, round, round / 2));
    case ShapeKind.cylinder:
      return upright(new CylinderGeometry(a, a, b, round));
    case ShapeKind.capsule:
      return upright(new CapsuleGeometry(a, b, 8, round));
    case ShapeKind.ellipsoid:
      return upright(new SphereGeometry(1, round, round / 2)).scale(a, b, c);
    case ShapeKind.mesh:
      return meshGeometry(scene.meshes[shape.mesh]);
    case ShapeKind.plane:
      throw new Error("a plane is drawn as ground");
  }
}

export function matrixOf(pose: ArrayLike<number>): Matrix4 {
  return new Matrix4().compose(
    new Vector3(pose[0], pose[1], pose[2]),
    new Quaternion(pose[3], pose[4], pose[5], pose[6]),
    new Vector3(1, 1, 1),
  );
}

/** Adds the fraction of a team's colour for each vertex, which is 0 for textured ones. */
function withTeamShare(geometry: BufferGeometry, share: number, textures?: Uint32Array): BufferGeometry {
  const shares = new Float32Array(geometry.getAttribute("position").count).fill(share);
  textures?.forEach((texture, triangle) => {
    if (texture !== none) shares.fill(0, 3 * triangle, 3 * triangle + 3);
  });
  return geometry.setAttribute("teamShare", new BufferAttribute(shares, 1));
}

/** Returns the texture of each triangle, as an index into the textures of the scene, or `none`. */
function triangleTextures(geometry: BufferGeometry, scene: Scene, shape: SceneShape): Uint32Array {
  const textures = new Uint32Array(geometry.getAttribute("position").count / 3).fill(none);
  const of = texturesOf(scene, shape);
  return of ? textures.map((_, triangle) => of(triangle)) : textures;
}

/** Sets texture coordinates: meshes have those of their file, other shapes those of three.js. */
function withCoordinates(geometry: BufferGeometry, scene: Scene, shape: SceneShape): BufferGeometry {
  if (shape.kind !== ShapeKind.mesh) return geometry;
  const count = geometry.getAttribute("position").count;
  const known = coordinatesOf(scene, shape.mesh);
  const coordinates = known?.length === 2 * count ? known : new Float32Array(2 * count);
  return geometry.setAttribute("uv", new BufferAttribute(coordinates, 2));
}

/** Sets the colours. `geometry` has three vertices for each triangle, in order. */
function coloured(geometry: BufferGeometry, scene: Scene, shape: SceneShape): BufferGeometry {
  const count = geometry.getAttribute("position").count;
  const colors = new Float32Array(3 * count);
  const linear = new Color().setRGB(shape.color[0], shape.color[1], shape.color[2], "srgb");
  const ofMesh = shape.has_mesh_colors ? scene.meshes[shape.mesh].colors : undefined;
  for (let i = 0; i < count; ++i) {
    if (ofMesh && i % 3 === 0) linear.setRGB(ofMesh[i] / 255, ofMesh[i + 1] / 255, ofMesh[i + 2] / 255, "srgb");
    linear.toArray(colors, 3 * i);
  }
  return geometry.setAttribute("color", new BufferAttribute(colors, 3));
}

/**
 * Returns the shapes of one link as one geometry with colours, in the link's frame; undefined if there are none.
 * `shareOf` returns the fraction of a team's colour in a shape. `userData.textures` has the texture of each triangle,
 * or is empty if there are none.
 */
export function linkGeometry(
  scene: Scene,
  shapes: readonly SceneShape[],
  instances: number,
  shareOf: (shape: SceneShape) => number = () => 0,
): BufferGeometry | undefined {
  const bodies = shapes.filter(({ kind }) => kind !== ShapeKind.plane);
  if (bodies.length === 0) return undefined;
  const hasTextures = bodies.some((shape) => texturesOf(scene, shape));
  const textures: number[] = [];
  const parts = bodies.map((shape) => {
    const geometry = plainGeometry(scene, shape, segmentsOf(instances));
    const plain = geometry.index ? geometry.toNonIndexed() : geometry;
    if (hasTextures) withCoordinates(plain, scene, shape);
    else plain.deleteAttribute("uv");
    const ofTriangles = hasTextures ? triangleTextures(plain, scene, shape) : undefined;
    for (const texture of ofTriangles ?? []) textures.push(texture);
    const placed = coloured(plain.applyMatrix4(matrixOf(shape.pose)), scene, shape);
    return withTeamShare(placed, shareOf(shape), ofTriangles);
  });
  const merged = mergeGeometries(parts);
  merged.userData.textures = textures;
  merged.userData.parts = parts.map((part) =>
    new Box3().setFromBufferAttribute(part.getAttribute("position") as BufferAttribute),
  );
  merged.computeBoundingSphere();
  return merged;
}
