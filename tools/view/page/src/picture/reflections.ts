// SPDX-License-Identifier: Apache-2.0
import {
  BackSide,
  BufferAttribute,
  Color,
  Mesh,
  MeshBasicMaterial,
  PMREMGenerator,
  SphereGeometry,
  type Texture,
  Scene as ThreeScene,
  Vector3,
  type WebGLCubeRenderTarget,
  type WebGLRenderer,
} from "three";
import { smoothest } from "./instances";

interface Surroundings {
  sky: { zenith: number; horizon: number };
  ground: { color: number };
}

// Parts of three.js that its types do not declare.
interface Levels {
  lodToRoughness?: (level: number, last: number) => number;
}
interface LevelDrawer {
  _renderCube?: (target: WebGLCubeRenderTarget, level: number, material: unknown) => void;
}

// The sharpest levels of the reflections take most of the time without a graphics card, and no surface is so smooth
// that it reads them. A version of three.js without these parts draws all levels: slower, with the same result.
function leaveOutSharpLevels(generator: PMREMGenerator): void {
  const { lodToRoughness } = PMREMGenerator as Levels;
  const drawer = generator as LevelDrawer;
  const draw = drawer._renderCube?.bind(generator);
  if (!draw || !lodToRoughness) return;
  drawer._renderCube = (target, level, material) => {
    const last = target.texture.mipmaps.length - 1;
    if (lodToRoughness(level + 1, last) > smoothest) draw(target, level, material);
  };
}

/** Returns the environment map of sky and ground, which surfaces reflect. */
export function reflectionsOf(renderer: WebGLRenderer, { sky, ground }: Surroundings, sunDirection: Vector3): Texture {
  const geometry = new SphereGeometry(10, 32, 32).rotateX(Math.PI / 2);
  const [zenith, horizon, below] = [sky.zenith, sky.horizon, ground.color].map((each) => new Color(each));
  const positions = geometry.getAttribute("position");
  const colors = new Float32Array(3 * positions.count);
  for (let i = 0; i < positions.count; ++i) {
    const up = positions.getZ(i) / 10;
    const color = up < -0.02 ? below.clone() : horizon.clone().lerp(zenith, Math.max(0, up) ** 0.6);
    const towardsSun = new Vector3().fromBufferAttribute(positions, i).normalize().dot(sunDirection);
    color
      .lerp(new Color(0xffffff), 0.3)
      .multiplyScalar(1 + 6 * Math.max(0, towardsSun) ** 24)
      .toArray(colors, 3 * i);
  }
  geometry.setAttribute("color", new BufferAttribute(colors, 3));
  const material = new MeshBasicMaterial({ vertexColors: true, side: BackSide, toneMapped: false });
  const surroundings = new ThreeScene();
  surroundings.add(new Mesh(geometry, material));
  const generator = new PMREMGenerator(renderer);
  leaveOutSharpLevels(generator);
  const { texture } = generator.fromScene(surroundings); // no blur: no surface is smooth enough to show it
  generator.dispose();
  geometry.dispose();
  material.dispose();
  return texture;
}
