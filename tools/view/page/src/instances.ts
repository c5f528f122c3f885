import {
  type BufferGeometry,
  Group,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  type Material,
  Mesh,
  MeshDepthMaterial,
  MeshStandardMaterial,
  RGBADepthPacking,
  type Sphere,
} from "three";
import { type SceneShape, ShapeRole } from "./messages";
import type { Poses } from "./poses";
import { linkGeometry } from "./shapes";

const declarations = `
attribute vec3 linkPosition;
attribute vec4 linkOrientation;
attribute vec3 linkPositionBefore;
attribute vec4 linkOrientationBefore;
uniform float blend;
vec4 linkTurn() {
  float side = dot(linkOrientation, linkOrientationBefore) < 0.0 ? -1.0 : 1.0;
  return normalize(mix(linkOrientationBefore, side * linkOrientation, blend));
}
vec3 turned(vec3 v, vec4 q) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
`;

/** Lets a material draw each instance where its link is. */
function placeByLink(material: Material, blend: { value: number }): void {
  material.onBeforeCompile = (shader) => {
    shader.uniforms.blend = blend;
    shader.vertexShader =
      declarations +
      shader.vertexShader
        .replace(
          "#include <beginnormal_vertex>",
          "#include <beginnormal_vertex>\nobjectNormal = turned(objectNormal, linkTurn());",
        )
        .replace(
          "#include <begin_vertex>",
          "vec3 transformed = turned(position, linkTurn()) + mix(linkPositionBefore, linkPosition, blend);",
        );
  };
}

interface Drawn {
  geometry: InstancedBufferGeometry;
  first: number;
  count: number;
}

/** One link of a model, to find out where a ray meets it. */
export interface LinkShape {
  model: number;
  link: number;
  geometry: BufferGeometry;
  sphere: Sphere;
}

/** All links of a scene, each drawn at once for all entities that have it. */
export class Instances {
  readonly group = new Group();
  readonly links: LinkShape[] = [];
  private readonly drawn: Drawn[] = [];
  private readonly blend = { value: 1 };

  constructor(
    private readonly poses: Poses,
    role: "visual" | "collision",
  ) {
    const { scene } = poses;
    const isShown = (shape: SceneShape): boolean =>
      role === "visual" ? shape.role !== ShapeRole.collision : shape.role !== ShapeRole.visual;
    for (const [model, { links }] of scene.models.entries()) {
      for (const [link, { shapes }] of links.entries()) {
        const shown = shapes.filter(isShown);
        const opaque = shown.filter(({ color }) => color[3] >= 1);
        const translucent = shown.filter(({ color }) => color[3] > 0 && color[3] < 1);
        this.add(model, link, opaque);
        this.add(model, link, translucent);
      }
    }
  }

  /** The poses have a new frame. */
  update(): void {
    const { positions, orientations, positionsBefore, orientationsBefore } = this.poses;
    for (const { geometry, first, count } of this.drawn) {
      const fill = (name: string, from: Float32Array | Int16Array, size: number): void => {
        const attribute = geometry.getAttribute(name) as InstancedBufferAttribute;
        (attribute.array as Float32Array).set(from.subarray(size * first, size * (first + count)) as Float32Array);
        attribute.needsUpdate = true;
      };
      fill("linkPosition", positions, 3);
      fill("linkOrientation", orientations, 4);
      fill("linkPositionBefore", positionsBefore, 3);
      fill("linkOrientationBefore", orientationsBefore, 4);
    }
  }

  draw(): void {
    this.blend.value = this.poses.blend;
  }

  dispose(): void {
    for (const { geometry } of this.drawn) geometry.dispose();
    for (const child of this.group.children as Mesh[]) (child.material as Material).dispose();
  }

  private add(model: number, link: number, shapes: SceneShape[]): void {
    const count = this.poses.entitiesOf(model).length;
    const shape = count > 0 ? linkGeometry(this.poses.scene, shapes, count) : undefined;
    if (!shape?.boundingSphere) return;
    this.links.push({ model, link, geometry: shape, sphere: shape.boundingSphere });
    const geometry = new InstancedBufferGeometry();
    for (const name of ["position", "normal", "color"]) geometry.setAttribute(name, shape.getAttribute(name));
    geometry.instanceCount = count;
    for (const name of ["linkPosition", "linkPositionBefore"])
      geometry.setAttribute(name, new InstancedBufferAttribute(new Float32Array(3 * count), 3));
    for (const name of ["linkOrientation", "linkOrientationBefore"])
      geometry.setAttribute(name, new InstancedBufferAttribute(new Int16Array(4 * count), 4, true));
    const opacity = shapes[0].color[3];
    const material = new MeshStandardMaterial({
      vertexColors: true,
      roughness: 0.62,
      metalness: 0.05,
      opacity,
      transparent: opacity < 1,
    });
    placeByLink(material, this.blend);
    const mesh = new Mesh(geometry, material);
    mesh.customDepthMaterial = new MeshDepthMaterial({ depthPacking: RGBADepthPacking });
    placeByLink(mesh.customDepthMaterial, this.blend);
    mesh.frustumCulled = false;
    mesh.castShadow = opacity >= 1;
    mesh.receiveShadow = true;
    this.group.add(mesh);
    this.drawn.push({ geometry, first: this.poses.firstPlace(model, link), count });
  }
}
