// SPDX-License-Identifier: Apache-2.0
import { none, type Scene, type SceneModel, type SceneShape } from "../data/messages";
import { hasTexture } from "./textures";

// Red, green and blue: light sand for movable objects, dark slate for static ones. Colour-blind users can distinguish
// them.
const roleColors = {
  robot: [0.27, 0.52, 0.75],
  movable: [0.89, 0.75, 0.48],
  wall: [0.44, 0.47, 0.51],
};
const uncoloured = 0.5; // red, green and blue of shapes whose file gives no colour

/** Returns a scene in which shapes without a colour have the colour of their role: robot, movable object or wall. */
export function withRoleColors(scene: Scene): Scene {
  const robots = new Set(scene.entities.filter(({ robot }) => robot !== none).map(({ model }) => model));
  const models = scene.models.map((model, i) => {
    const role = robots.has(i) ? "robot" : model.is_static ? "wall" : "movable";
    return dressed(scene, model, roleColors[role]);
  });
  return { ...scene, models };
}

function dressed(scene: Scene, model: SceneModel, color: readonly number[]): SceneModel {
  if (!model.links.some(({ shapes }) => shapes.some(isUncoloured))) return model;
  const dressedShape = (shape: SceneShape): SceneShape =>
    isUncoloured(shape) && !hasTexture(scene, shape)
      ? { ...shape, color: Float32Array.of(...color, shape.color[3]) }
      : shape;
  return { ...model, links: model.links.map((link) => ({ ...link, shapes: link.shapes.map(dressedShape) })) };
}

function isUncoloured({ color, has_mesh_colors }: SceneShape): boolean {
  return !has_mesh_colors && [0, 1, 2].every((i) => color[i] === uncoloured);
}
