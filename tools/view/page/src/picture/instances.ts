// SPDX-License-Identifier: Apache-2.0
import {
  type Box3,
  type BufferGeometry,
  type Color,
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
import { none, type SceneShape, ShapeRole } from "../data/messages";
import type { Poses } from "./poses";
import { linkGeometry } from "./shapes";
import { dominantColor, teamColors, teamShare } from "./teams";
import type { Textures } from "./textures";

/** Shader functions that place a vertex by its link. */
export const placeDeclarations = `
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

/** Makes a material draw each instance at the pose of its link. */
function placeByLink(material: Material, blend: { value: number }): void {
  material.onBeforeCompile = (shader) => {
    shader.uniforms.blend = blend;
    shader.vertexShader =
      `${placeDeclarations}attribute float teamShare;\nattribute vec4 teamColor;\n` +
      shader.vertexShader
        .replace(
          "#include <beginnormal_vertex>",
          "#include <beginnormal_vertex>\nobjectNormal = turned(objectNormal, linkTurn());",
        )
        .replace(
          "#include <color_vertex>",
          "#include <color_vertex>\n#ifdef USE_COLOR\nvColor.rgb = mix(vColor.rgb, teamColor.rgb, teamColor.a * teamShare);\n#endif",
        )
        .replace(
          "#include <begin_vertex>",
          "vec3 transformed = turned(position, linkTurn()) + mix(linkPositionBefore, linkPosition, blend);",
        );
  };
}

/** Surfaces by the role of a body: the paint of robots is slightly glossy, walls are matt. */
const surfaces = {
  robot: { roughness: 0.45, metalness: 0.08 },
  movable: { roughness: 0.65, metalness: 0.02 },
  static: { roughness: 0.9, metalness: 0 },
};
/** The smallest roughness of any surface. */
export const smoothest = Math.min(...Object.values(surfaces).map(({ roughness }) => roughness));

/** Splits a geometry into one for each texture. The attributes are those of `whole`. */
function partsByTexture(
  whole: InstancedBufferGeometry,
  textures: readonly number[],
): { texture: number; part: InstancedBufferGeometry }[] {
  const corners = new Map<number, number[]>();
  textures.forEach((texture, triangle) => {
    const known = corners.get(texture);
    const first = 3 * triangle;
    if (known) known.push(first, first + 1, first + 2);
    else corners.set(texture, [first, first + 1, first + 2]);
  });
  if (corners.size < 2) return [{ texture: textures[0] ?? none, part: whole }];
  return [...corners].map(([texture, index]) => {
    const part = new InstancedBufferGeometry();
    for (const [name, attribute] of Object.entries(whole.attributes)) part.setAttribute(name, attribute);
    part.instanceCount = whole.instanceCount;
    part.setIndex(index);
    return { texture, part };
  });
}

interface Drawn {
  geometry: InstancedBufferGeometry;
  model: number;
  link: number;
  first: number;
  count: number;
}

/** One link of a model, for intersections with rays. */
export interface LinkShape {
  model: number;
  link: number;
  geometry: BufferGeometry;
  sphere: Sphere;
  /** Boxes around its shapes, in the link's frame. */
  parts: readonly Box3[];
}

/** All links of a scene, each drawn at once for all entities that have it. */
export class Instances {
  readonly group = new Group();
  readonly links: LinkShape[] = [];
  private readonly drawn: Drawn[] = [];
  private readonly teams: ReadonlyMap<string, Color>;
  readonly blend = { value: 1 };

  constructor(
    private readonly poses: Poses,
    private readonly textures: Textures,
    role: "visual" | "collision",
  ) {
    const { scene } = poses;
    const isShown = (shape: SceneShape): boolean =>
      role === "visual" ? shape.role !== ShapeRole.collision : shape.role !== ShapeRole.visual;
    this.teams = teamColors(scene);
    for (const [model, { links }] of scene.models.entries()) {
      const dominant = dominantColor(scene, scene.models[model]);
      for (const [link, { shapes }] of links.entries()) {
        const shown = shapes.filter(isShown);
        const opaque = shown.filter(({ color }) => color[3] >= 1);
        const translucent = shown.filter(({ color }) => color[3] > 0 && color[3] < 1);
        this.add(model, link, opaque, dominant);
        this.add(model, link, translucent, dominant);
      }
    }
  }

  /** Called when the poses have a new frame. */
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

  /** Returns the attributes that place a link, for other objects that are drawn there. */
  placesOf(model: number, link: number): InstancedBufferGeometry | undefined {
    return this.drawn.find((each) => each.model === model && each.link === link)?.geometry;
  }

  draw(): void {
    this.blend.value = this.poses.blend;
  }

  dispose(): void {
    for (const { geometry } of this.drawn) geometry.dispose();
    for (const child of this.group.children as Mesh[]) {
      child.geometry.dispose();
      (child.material as Material).dispose();
    }
  }

  private add(model: number, link: number, shapes: SceneShape[], dominant: Float32Array | undefined): void {
    const { scene } = this.poses;
    const entities = this.poses.entitiesOf(model);
    const count = entities.length;
    const shareOf = (shape: SceneShape): number => teamShare(shape, dominant);
    const shape = count > 0 ? linkGeometry(scene, shapes, count, shareOf) : undefined;
    if (!shape?.boundingSphere) return;
    this.links.push({
      model,
      link,
      geometry: shape,
      sphere: shape.boundingSphere,
      parts: shape.userData.parts as Box3[],
    });
    const geometry = new InstancedBufferGeometry();
    for (const name of ["position", "normal", "color", "teamShare", "uv"])
      if (shape.hasAttribute(name)) geometry.setAttribute(name, shape.getAttribute(name));
    geometry.instanceCount = count;
    for (const name of ["linkPosition", "linkPositionBefore"])
      geometry.setAttribute(name, new InstancedBufferAttribute(new Float32Array(3 * count), 3));
    for (const name of ["linkOrientation", "linkOrientationBefore"])
      geometry.setAttribute(name, new InstancedBufferAttribute(new Int16Array(4 * count), 4, true));
    geometry.setAttribute("teamColor", this.colorsOf(entities));
    const opacity = shapes[0].color[3];
    const isRobot = scene.entities[entities[0]].robot !== none;
    const surface = surfaces[isRobot ? "robot" : scene.models[model].is_static ? "static" : "movable"];
    for (const { texture, part } of partsByTexture(geometry, shape.userData.textures as number[])) {
      const material = new MeshStandardMaterial({
        vertexColors: true,
        ...surface,
        opacity,
        transparent: opacity < 1,
      });
      placeByLink(material, this.blend);
      this.textures.use(texture, (map) => Object.assign(material, { map, vertexColors: false, needsUpdate: true }));
      const mesh = new Mesh(part, material);
      mesh.customDepthMaterial = new MeshDepthMaterial({ depthPacking: RGBADepthPacking });
      placeByLink(mesh.customDepthMaterial, this.blend);
      mesh.frustumCulled = false;
      mesh.castShadow = opacity >= 1;
      mesh.receiveShadow = true;
      this.group.add(mesh);
    }
    this.drawn.push({ geometry, model, link, first: this.poses.firstPlace(model, link), count });
  }

  // Returns the team's red, green and blue for each entity, and whether it has a team.
  private colorsOf(entities: readonly number[]): InstancedBufferAttribute {
    const values = new Float32Array(4 * entities.length);
    entities.forEach((entity, i) => {
      this.teams.get(this.poses.scene.entities[entity].team)?.toArray(values, 4 * i);
      values[4 * i + 3] = this.teams.has(this.poses.scene.entities[entity].team) ? 1 : 0;
    });
    return new InstancedBufferAttribute(values, 4);
  }
}
