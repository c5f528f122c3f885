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
import { type Scene, type SceneMesh, type SceneShape, ShapeKind } from "../data/messages";

/** Segments of what is round: fewer where there are many of it. */
const segmentsOf = (instances: number): number => (instances <= 500 ? 28 : instances <= 3000 ? 16 : 10);
const crease = 0.6; // [rad]; edges that are sharper are seen as edges

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
      return new BoxGeometry(a, b, c);
    case ShapeKind.sphere:
      return new SphereGeometry(a, round, round / 2);
    case ShapeKind.cylinder:
      return upright(new CylinderGeometry(a, a, b, round));
    case ShapeKind.capsule:
      return upright(new CapsuleGeometry(a, b, 8, round));
    case ShapeKind.ellipsoid:
      return new SphereGeometry(1, round, round / 2).scale(a, b, c);
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

/** Adds how much of a team's colour each vertex takes. */
function withTeamShare(geometry: BufferGeometry, share: number): BufferGeometry {
  const shares = new Float32Array(geometry.getAttribute("position").count).fill(share);
  return geometry.setAttribute("teamShare", new BufferAttribute(shares, 1));
}

/** `geometry` has three vertices for each triangle, in their order. */
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
 * Returns the shapes of one link as one piece with colours, in the link's frame; nothing if there are none. `shareOf`
 * gives how much of a team's colour a shape takes.
 */
export function linkGeometry(
  scene: Scene,
  shapes: readonly SceneShape[],
  instances: number,
  shareOf: (shape: SceneShape) => number = () => 0,
): BufferGeometry | undefined {
  const parts = shapes
    .filter(({ kind }) => kind !== ShapeKind.plane)
    .map((shape) => {
      const geometry = plainGeometry(scene, shape, segmentsOf(instances));
      const plain = geometry.index ? geometry.toNonIndexed() : geometry;
      plain.deleteAttribute("uv");
      return withTeamShare(coloured(plain.applyMatrix4(matrixOf(shape.pose)), scene, shape), shareOf(shape));
    });
  if (parts.length === 0) return undefined;
  const merged = mergeGeometries(parts);
  merged.userData.parts = parts.map((part) =>
    new Box3().setFromBufferAttribute(part.getAttribute("position") as BufferAttribute),
  );
  merged.computeBoundingSphere();
  return merged;
}
