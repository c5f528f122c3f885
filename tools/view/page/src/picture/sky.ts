// SPDX-License-Identifier: Apache-2.0
import { BufferAttribute, BufferGeometry, Mesh, ShaderMaterial } from "three";

/** Colours as they are displayed. */
export interface SkyLook {
  zenith: number;
  horizon: number;
  depth: number; // straight down, if there is no ground
  glow: number; // around the sun
}

// One triangle over the whole picture at the far end, drawn after everything that hides it.
const vertexShader = `
varying vec3 direction;
uniform mat4 toWorld;
uniform vec2 halfPicture; // tangents of half the angles of view
void main() {
  direction = (toWorld * vec4(position.xy * halfPicture, -1.0, 0.0)).xyz;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}`;
const fragmentShader = `
varying vec3 direction;
uniform vec3 zenith;
uniform vec3 horizon;
uniform vec3 depth;
uniform vec4 glow; // colour and strength
uniform vec3 sun;
void main() {
  vec3 ray = normalize(direction);
  float up = ray.z;
  vec3 color = mix(horizon, zenith, pow(clamp(up, 0.0, 1.0), 0.62));
  color = mix(color, depth, smoothstep(0.0, 0.35, -up));
  float near = max(0.0, dot(ray, sun));
  color = mix(color, glow.rgb, glow.a * pow(near, 6.0) * smoothstep(-0.05, 0.1, up));
  gl_FragColor = vec4(color, 1.0);
}`;

/** The sky: a gradient from the horizon to the zenith. Fog of the horizon's colour joins the ground to it. */
export class Sky {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;

  constructor() {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    const value = (): { value: number[] } => ({ value: [0, 0, 0] });
    const material = new ShaderMaterial({
      vertexShader,
      fragmentShader,
      uniforms: {
        zenith: value(),
        horizon: value(),
        depth: value(),
        sun: { value: [-0.38, -0.3, 0.87] },
        glow: { value: [0, 0, 0, 0] },
        toWorld: { value: undefined },
        halfPicture: { value: [1, 1] },
      },
      depthWrite: false,
      fog: false,
      toneMapped: false,
    });
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 1; // after opaque bodies, before translucent ones
    this.mesh.onBeforeRender = (_renderer, _scene, camera) => {
      const [x, , , , , y] = camera.projectionMatrix.elements;
      material.uniforms.toWorld.value = camera.matrixWorld;
      material.uniforms.halfPicture.value = [1 / x, 1 / y];
    };
  }

  wear({ zenith, horizon, depth, glow }: SkyLook, glowStrength: number): void {
    const { uniforms } = this.mesh.material;
    uniforms.zenith.value = displayed(zenith);
    uniforms.horizon.value = displayed(horizon);
    uniforms.depth.value = displayed(depth);
    uniforms.glow.value = [...displayed(glow), glowStrength];
  }
}

// Red, green and blue of a colour, from 0 to 1.
const displayed = (hex: number): number[] => [16, 8, 0].map((shift) => ((hex >> shift) & 0xff) / 255);
