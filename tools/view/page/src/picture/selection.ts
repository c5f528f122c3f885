// SPDX-License-Identifier: Apache-2.0
import {
  BackSide,
  type Camera,
  Group,
  Mesh,
  MeshBasicMaterial,
  Quaternion,
  type Ray,
  Raycaster,
  Sphere,
  type Vector2,
  Vector3,
} from "three";
import type { Instances, LinkShape } from "./instances";
import type { Poses } from "./poses";

const outlineWidth = 1.06;
const mostOutlined = 100;

/** Returns the first entity on a ray from the camera. */
export function pick(poses: Poses, instances: Instances, camera: Camera, at: Vector2): number | undefined {
  const raycaster = new Raycaster();
  raycaster.setFromCamera(at, camera);
  const position = new Vector3();
  const orientation = new Quaternion();
  const probe = new Mesh();
  let nearest = Infinity;
  let found: number | undefined;
  const isNear = ({ sphere }: LinkShape, ray: Ray): boolean => {
    const placed = new Sphere(sphere.center.clone().applyQuaternion(orientation).add(position), sphere.radius);
    return ray.intersectsSphere(placed);
  };
  for (const shape of instances.links) {
    probe.geometry = shape.geometry;
    for (const entity of poses.entitiesOf(shape.model)) {
      if (poses.absent.has(entity)) continue;
      poses.read(poses.placeOf(entity, shape.link), position, orientation);
      if (!isNear(shape, raycaster.ray)) continue;
      probe.matrixWorld.compose(position, orientation, new Vector3(1, 1, 1));
      const [hit] = raycaster.intersectObject(probe, false);
      if (hit && hit.distance < nearest) {
        nearest = hit.distance;
        found = entity;
      }
    }
  }
  return found;
}

/** An outline around the selected entities, up to a limited number. */
export class Outline {
  readonly group = new Group();
  private readonly material = new MeshBasicMaterial({ color: 0x1f8fff, side: BackSide, toneMapped: false });
  private parts: { mesh: Mesh; entity: number; link: number }[] = [];

  select(entities: readonly number[], poses: Poses | undefined, instances: Instances | undefined): void {
    this.group.clear();
    this.parts = [];
    if (!poses || !instances) return;
    for (const entity of entities.slice(0, mostOutlined))
      for (const { model, link, geometry, sphere } of instances.links) {
        if (model !== poses.scene.entities[entity].model) continue;
        const mesh = new Mesh(geometry, this.material);
        mesh.scale.setScalar(outlineWidth);
        mesh.userData.centre = sphere.center;
        this.parts.push({ mesh, entity, link });
        this.group.add(mesh);
      }
  }

  draw(poses: Poses): void {
    if (!poses.frame) return;
    for (const { mesh, entity, link } of this.parts) {
      poses.read(poses.placeOf(entity, link), mesh.position, mesh.quaternion);
      const centre = (mesh.userData.centre as Vector3).clone().applyQuaternion(mesh.quaternion);
      mesh.position.addScaledVector(centre, 1 - outlineWidth);
    }
  }
}
