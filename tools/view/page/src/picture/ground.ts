// SPDX-License-Identifier: Apache-2.0
import { Color, Mesh, MeshLambertMaterial, PlaneGeometry, Quaternion, Vector3 } from "three";

const size = 400; // [m], at the least

// Lines every 0.1, 1, 10 and 100 m, on squares of 1 and 10 m. Finer lines fade with distance.
const gridShader = `
float lineOf(vec2 at, float spacing, float width) {
  vec2 scaled = at / spacing;
  vec2 slope = fwidth(scaled);
  vec2 distance = abs(fract(scaled - 0.5) - 0.5) / max(slope, vec2(1e-6));
  float fading = 1.0 - smoothstep(0.06, 0.26, max(slope.x, slope.y));
  return (1.0 - min(min(distance.x, distance.y) / width, 1.0)) * fading;
}
float squareOf(vec2 at, float spacing) {
  vec2 scaled = at / spacing;
  vec2 slope = fwidth(scaled);
  vec2 cell = mod(floor(scaled), 2.0);
  return (abs(cell.x - cell.y) - 0.5) * (1.0 - smoothstep(0.05, 0.4, max(slope.x, slope.y)));
}
float axisOf(float across) {
  return 1.0 - min(abs(across) / max(1.6 * fwidth(across), 1e-6), 1.0);
}
`;
const gridColors = `#include <color_fragment>
diffuseColor.rgb *= 1.0 + 0.05 * squareOf(at, 1.0) + 0.04 * squareOf(at, 10.0);
float line = max(
  max(0.10 * lineOf(at, 0.1, 1.0), 0.32 * lineOf(at, 1.0, 1.2)),
  max(0.55 * lineOf(at, 10.0, 1.5), 0.7 * lineOf(at, 100.0, 1.8)));
diffuseColor.rgb = mix(diffuseColor.rgb, lineColor, line);
diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.62, 0.11, 0.09), 0.55 * axisOf(at.y));
diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.09, 0.42, 0.13), 0.55 * axisOf(at.x));`;

/** An infinite plane, with a grid and the axes x (red) and y (green) of the world. */
export class Ground {
  readonly mesh: Mesh<PlaneGeometry, MeshLambertMaterial>;
  /** Height of the ground [m], if it is level. */
  readonly height: number | undefined;
  private readonly lineColor = { value: new Color() };
  private readonly up: Vector3;
  private readonly point: Vector3;

  constructor(pose: Float32Array, normal: Float32Array) {
    const material = new MeshLambertMaterial({ polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    material.onBeforeCompile = (shader) => {
      shader.uniforms.lineColor = this.lineColor;
      shader.vertexShader =
        "varying vec2 at;\n" +
        shader.vertexShader.replace(
          "#include <begin_vertex>",
          "#include <begin_vertex>\nat = (modelMatrix * vec4(position, 1.0)).xy;",
        );
      shader.fragmentShader =
        `varying vec2 at;\nuniform vec3 lineColor;\n${gridShader}` +
        shader.fragmentShader.replace("#include <color_fragment>", gridColors);
    };
    this.mesh = new Mesh(new PlaneGeometry(size, size), material);
    this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
    const turn = new Quaternion(pose[3], pose[4], pose[5], pose[6]);
    this.up = new Vector3(normal[0], normal[1], normal[2]).applyQuaternion(turn).normalize();
    this.point = new Vector3(pose[0], pose[1], pose[2]);
    this.height = this.up.z > 0.9999 ? pose[2] : undefined;
    this.mesh.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), this.up);
    this.mesh.position.copy(this.point);
  }

  wear(color: number, line: number): void {
    this.mesh.material.color.set(color);
    this.lineColor.value.set(line);
  }

  /** Moves the drawn part around a place, as far as the visibility in fog. */
  surround(place: Vector3, sight: number): void {
    const height = place.clone().sub(this.point).dot(this.up);
    this.mesh.position.copy(place).addScaledVector(this.up, -height);
    this.mesh.scale.setScalar(Math.max(1, (2.5 * sight) / size));
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
