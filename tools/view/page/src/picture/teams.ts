// SPDX-License-Identifier: Apache-2.0
import { Color, SRGBColorSpace } from "three";
import { none, type Scene, type SceneModel, type SceneShape, ShapeKind, ShapeRole } from "../data/messages";
import { hasTexture } from "./textures";

/** The palette of Okabe and Ito, which colour-blind users can distinguish. The colours that differ most come first. */
const palette = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442"];

const shareWithoutDominant = 0.55; // for models whose mesh files define the colours

/** Returns the colour of each team, in the order of its first robot; empty if all robots belong to one team. */
export function teamColors(scene: Scene): Map<string, Color> {
  const names = new Set(
    scene.entities.filter(({ robot, team }) => robot !== none && team !== "").map(({ team }) => team),
  );
  if (names.size < 2) return new Map();
  return new Map(
    [...names].map((name, i) => {
      const darkening = 0.55 ** Math.floor(i / palette.length);
      return [name, new Color(palette[i % palette.length]).multiplyScalar(darkening)];
    }),
  );
}

/** The colour of a shape in its message: red, green, blue, alpha. */
type ShapeColor = Float32Array;
const isSame = (a: ShapeColor, b: ShapeColor): boolean => [0, 1, 2].every((i) => Math.abs(a[i] - b[i]) < 0.01);
const colorOf = ([r, g, b]: ShapeColor): Color => new Color().setRGB(r, g, b, SRGBColorSpace);

// Returns the approximate surface area of a shape [m²].
function areaOf(scene: Scene, { kind, size, mesh }: SceneShape): number {
  const [a, b, c] = size;
  if (kind === ShapeKind.box) return 2 * (a * b + b * c + c * a);
  if (kind === ShapeKind.sphere) return 4 * Math.PI * a * a;
  if (kind === ShapeKind.cylinder || kind === ShapeKind.capsule) return 2 * Math.PI * a * (a + b);
  if (kind === ShapeKind.ellipsoid) return 4 * Math.PI * Math.cbrt(a * b * c) ** 2;
  if (kind !== ShapeKind.mesh) return 0;
  const { vertices } = scene.meshes[mesh];
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < vertices.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], vertices[i]);
    high[i % 3] = Math.max(high[i % 3], vertices[i]);
  }
  const [x, y, z] = high.map((each, axis) => each - low[axis]);
  return 2 * (x * y + y * z + z * x);
}

/** Returns the dominant colour of a model: that with the largest area, with more weight for vivid colours. */
export function dominantColor(scene: Scene, model: SceneModel): ShapeColor | undefined {
  const found: { color: ShapeColor; weight: number }[] = [];
  for (const { shapes } of model.links)
    for (const shape of shapes) {
      if (shape.role === ShapeRole.collision || shape.kind === ShapeKind.plane) continue;
      if (shape.color[3] < 1 || shape.has_mesh_colors || hasTexture(scene, shape)) continue;
      const { s, l } = colorOf(shape.color).getHSL({ h: 0, s: 0, l: 0 }, SRGBColorSpace);
      const weight = areaOf(scene, shape) * (0.05 + s * (1 - Math.abs(2 * l - 1)));
      const known = found.find(({ color }) => isSame(color, shape.color));
      if (known) known.weight += weight;
      else found.push({ color: shape.color, weight });
    }
  return found.sort((a, b) => b.weight - a.weight)[0]?.color;
}

/** Returns the fraction of a team's colour in a shape: 1 where it replaces the dominant colour of the model. */
export function teamShare(shape: SceneShape, dominant: ShapeColor | undefined): number {
  if (dominant === undefined) return shareWithoutDominant;
  return !shape.has_mesh_colors && isSame(shape.color, dominant) ? 1 : 0;
}

/** Returns the dominant colour as it is drawn. */
export function drawnColor(scene: Scene, model: SceneModel): Color | undefined {
  const color = dominantColor(scene, model);
  return color && colorOf(color);
}
