// SPDX-License-Identifier: Apache-2.0

// The messages of server/viewing/scene_messages.hpp and tools/view/messages/view_messages.hpp, as decoded by
// rosmsg2-serialization.

export const none = 0xffffffff;

export enum ShapeKind {
  box,
  sphere,
  cylinder,
  capsule,
  ellipsoid,
  plane,
  mesh,
}
export enum ShapeRole {
  visual,
  collision,
  collisionAsVisual,
}

export interface SceneShape {
  kind: ShapeKind;
  role: ShapeRole;
  mesh: number;
  size: Float32Array;
  pose: Float32Array;
  color: Float32Array;
  has_mesh_colors: boolean;
}
export interface SceneMesh {
  vertices: Float32Array;
  triangles: Uint32Array;
  colors: Uint8Array;
}
export interface SceneLink {
  name: string;
  pose: Float32Array;
  shapes: SceneShape[];
}
export interface SceneSensor {
  name: string;
  kind: string;
  link: number;
  origins: Float32Array;
  directions: Float32Array;
  range: number;
  cone: number;
  channel: string;
}
export interface SceneChannel {
  name: string;
  unit: string;
  size: number;
  lower: number;
  upper: number;
  neutral: number;
}
export interface SceneModel {
  name: string;
  is_static: boolean;
  links: SceneLink[];
  sensors: SceneSensor[];
  observation: SceneChannel[];
  command: SceneChannel[];
}
export interface SceneEntity {
  name: string;
  model: number;
  robot: number;
  team: string;
}
export interface SceneEmitter {
  entity: number;
  link: number;
  position: Float32Array;
  direction: Float32Array;
  range: number;
}
export interface SceneTexture {
  image: Uint8Array;
}
export interface SceneMeshTexture {
  mesh: number;
  coordinates: Float32Array;
  textures: Uint32Array;
}
export interface SceneShapeTexture {
  model: number;
  link: number;
  shape: number;
  texture: number;
}
export interface SceneDrive {
  model: number;
  value: number;
  ahead: number;
  turn: number;
}
export interface Scene {
  revision: number;
  world: string;
  step_ns: bigint;
  meshes: SceneMesh[];
  models: SceneModel[];
  entities: SceneEntity[];
  lamps: SceneEmitter[];
  tones: SceneEmitter[];
  leds: SceneEmitter[];
  textures: SceneTexture[];
  mesh_textures: SceneMeshTexture[];
  shape_textures: SceneShapeTexture[];
  drives: SceneDrive[];
}
export interface SceneFrame {
  revision: number;
  run: number;
  tick: bigint;
  time_ns: bigint;
  state_hash: bigint;
  absent: Uint32Array;
  quarantined: Uint32Array;
  positions: Float32Array;
  orientations: Int16Array;
}
export interface SceneSignals {
  revision: number;
  lamps: Float32Array;
  tones: Float32Array;
  leds: Uint8Array;
}
export interface SceneContacts {
  revision: number;
  positions: Float32Array;
  forces: Float32Array;
  entities: Uint32Array;
  grips: Float32Array;
}
export interface SceneRobot {
  revision: number;
  robot: number;
  tick: bigint;
  time_ns: bigint;
  observation: Float64Array;
  command: Float64Array;
}
export interface ViewStatus {
  source: string;
  name: string;
  may_control: boolean;
  can_seek: boolean;
  loses_what_follows: boolean;
  is_playing: boolean;
  speed: number;
  real_time_factor: number;
  time_ns: bigint;
  begin_ns: bigint;
  end_ns: bigint;
  seekable_from_ns: bigint;
  seekable_to_ns: bigint;
  note: string;
  awaited: string[];
  phase: "waiting" | "gathering" | "running" | "ended" | "gone";
  end: string;
  end_text: string;
  to_type: string;
  recording: string;
  seed: string;
  can_run_again: boolean;
}
export interface ViewEvent {
  time_ns: bigint;
  tick: bigint;
  kind: string;
  text: string;
  count: bigint;
  last_ns: bigint;
}

export interface Messages {
  "/cohort/scene": Scene;
  "/cohort/frame": SceneFrame;
  "/cohort/signals": SceneSignals;
  "/cohort/contacts": SceneContacts;
  "/cohort/status": ViewStatus;
  "/cohort/robots": { robots: SceneRobot[] };
  "/cohort/events": { events: ViewEvent[] };
}
export type Topic = keyof Messages;

export const seconds = (ns: bigint): number => Number(ns) * 1e-9;
