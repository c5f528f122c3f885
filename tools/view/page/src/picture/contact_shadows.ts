// SPDX-License-Identifier: Apache-2.0
import { Box3, BufferAttribute, Group, InstancedBufferGeometry, Matrix4, Mesh, ShaderMaterial } from "three";
import { growBy } from "./framing";
import { type Instances, placeDeclarations } from "./instances";
import type { Poses } from "./poses";
import { matrixOf } from "./shapes";

const spread = 0.5; // width of a shadow beyond a body, relative to the body's smaller half length
const mostSpread = 0.12; // [m]
const lift = 0.002; // [m] above the ground
const lowPart = 0.35; // fraction of a body's height that may touch the ground

// A box of the body, projected onto the ground. The shadow fades with the height of the box above the ground.
const vertexShader = `
${placeDeclarations}
attribute vec2 inBox;
attribute vec3 boxSize; // half lengths, and the width of the shadow beyond them
attribute vec3 boxCentre; // the centre of its lower face
uniform float ground;
varying vec2 at;
varying vec3 size;
varying float strength;
void main() {
  vec4 turn = linkTurn();
  vec3 link = mix(linkPositionBefore, linkPosition, blend);
  vec3 place = turned(boxCentre + vec3(inBox, 0.0), turn) + link;
  float height = (turned(boxCentre, turn) + link).z - ground;
  at = inBox;
  size = boxSize;
  strength = 1.0 - smoothstep(0.2, 2.5, max(0.0, height) / (boxSize.z + 0.02));
  gl_Position = projectionMatrix * viewMatrix * vec4(place.xy, ground + ${lift}, 1.0);
}`;
const fragmentShader = `
varying vec2 at;
varying vec3 size;
varying float strength;
uniform float darkness;
void main() {
  vec2 beyond = abs(at) - size.xy + 0.4 * size.z;
  float outside = length(max(beyond, 0.0)) + min(max(beyond.x, beyond.y), 0.0);
  float shade = 1.0 - smoothstep(-0.2 * size.z, 1.4 * size.z, outside);
  gl_FragColor = vec4(0.05, 0.07, 0.11, darkness * strength * shade * shade);
}`;

/** Soft shadows where bodies meet the ground, which need neither a shadow map nor a separate rendering pass. */
export class ContactShadows {
  readonly group = new Group();
  private readonly material: ShaderMaterial;

  constructor(poses: Poses, instances: Instances, ground: number) {
    this.material = new ShaderMaterial({
      uniforms: { blend: instances.blend, ground: { value: ground }, darkness: { value: 0.5 } },
      vertexShader,
      fragmentShader,
      transparent: true,
      depthWrite: false,
      polygonOffset: true,
      polygonOffsetFactor: -1,
      polygonOffsetUnits: -1,
    });
    for (const model of poses.scene.models.keys()) this.add(poses, instances, model);
  }

  wear(isDark: boolean): void {
    this.material.uniforms.darkness.value = isDark ? 0.5 : 0.36;
  }

  dispose(): void {
    for (const child of this.group.children as Mesh[]) child.geometry.dispose();
    this.material.dispose();
  }

  private add(poses: Poses, instances: Instances, model: number): void {
    const drawn = instances.links.filter((each) => each.model === model);
    const places = drawn.length > 0 ? instances.placesOf(model, drawn[0].link) : undefined;
    if (!places) return;
    const { links, is_static: isStatic } = poses.scene.models[model];
    const root = matrixOf(links[drawn[0].link].pose).invert();
    const boxes = isStatic
      ? drawn.filter(({ link }) => link === drawn[0].link).flatMap(({ parts }) => parts)
      : lowBox(
          drawn.map(({ link, geometry }) => {
            if (!geometry.boundingBox) geometry.computeBoundingBox();
            const box = new Box3();
            growBy(box, geometry.boundingBox ?? box, new Matrix4().multiplyMatrices(root, matrixOf(links[link].pose)));
            return box;
          }),
        );
    if (boxes.length === 0) return;
    const geometry = quads(boxes);
    for (const name of ["linkPosition", "linkPositionBefore", "linkOrientation", "linkOrientationBefore"])
      geometry.setAttribute(name, places.getAttribute(name));
    geometry.instanceCount = places.instanceCount;
    const mesh = new Mesh(geometry, this.material);
    mesh.frustumCulled = false;
    mesh.renderOrder = -1;
    this.group.add(mesh);
  }
}

// Returns one box around all boxes that are low enough to touch the ground.
function lowBox(boxes: readonly Box3[]): Box3[] {
  const whole = boxes.reduce((sum, each) => sum.union(each), new Box3());
  const limit = whole.min.z + lowPart * (whole.max.z - whole.min.z);
  const low = boxes.filter(({ min }) => min.z <= limit).reduce((sum, each) => sum.union(each), new Box3());
  return low.isEmpty() ? [] : [low];
}

function quads(boxes: readonly Box3[]): InstancedBufferGeometry {
  const geometry = new InstancedBufferGeometry();
  const inBox: number[] = [];
  const sizes: number[] = [];
  const centres: number[] = [];
  const index: number[] = [];
  for (const [i, { min, max }] of boxes.entries()) {
    const half = max.clone().sub(min).multiplyScalar(0.5);
    const beyond = Math.min(mostSpread, spread * Math.min(half.x, half.y) + 0.01);
    for (const [x, y] of [
      [-1, -1],
      [1, -1],
      [1, 1],
      [-1, 1],
    ]) {
      inBox.push(x * (half.x + beyond), y * (half.y + beyond));
      sizes.push(half.x, half.y, beyond);
      centres.push(0.5 * (min.x + max.x), 0.5 * (min.y + max.y), min.z);
    }
    index.push(4 * i, 4 * i + 1, 4 * i + 2, 4 * i, 4 * i + 2, 4 * i + 3);
  }
  geometry.setIndex(index);
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(12 * boxes.length), 3));
  geometry.setAttribute("inBox", new BufferAttribute(new Float32Array(inBox), 2));
  geometry.setAttribute("boxSize", new BufferAttribute(new Float32Array(sizes), 3));
  geometry.setAttribute("boxCentre", new BufferAttribute(new Float32Array(centres), 3));
  return geometry;
}
