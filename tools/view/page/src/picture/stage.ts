// SPDX-License-Identifier: Apache-2.0
import {
  DirectionalLight,
  Fog,
  HemisphereLight,
  NeutralToneMapping,
  type Object3D,
  PCFShadowMap,
  PerspectiveCamera,
  type Sphere,
  type Texture,
  Scene as ThreeScene,
  Vector3,
  WebGLRenderer,
} from "three";
import { type Scene, ShapeKind } from "../data/messages";
import { Ground } from "./ground";
import { levels, Quality } from "./quality";
import { reflectionsOf } from "./reflections";
import { Sky } from "./sky";

export type Theme = "light" | "dark";

const looks = {
  light: {
    sky: { zenith: 0x79a3d3, horizon: 0xe9eff5, depth: 0xa9b4c0, glow: 0xfffaf0 },
    glow: 0.55,
    ground: { color: 0xc6ccd2, line: 0x566473 },
    sun: { intensity: 2.5, color: 0xfff4e6 },
    fill: { intensity: 1.6, sky: 0xeaf0fa, ground: 0xc4c0ba },
    reflections: 0.28,
  },
  dark: {
    sky: { zenith: 0x090d13, horizon: 0x364352, depth: 0x11161c, glow: 0x5b6b80 },
    glow: 0.35,
    ground: { color: 0x51565c, line: 0xa3b0be },
    sun: { intensity: 2.3, color: 0xfff6ea },
    fill: { intensity: 1.2, sky: 0xd3dcea, ground: 0x66686c },
    reflections: 0.3,
  },
};
const fillWithoutReflections = 1.25; // intensity of the fill light relative to that with reflections
const sunDirection = new Vector3(-0.45, -0.35, 1).normalize();
const shadowReach = 1; // [m]; smallest radius around the camera's target
const shadowTexels = 2048;
const mostPixelRatio = 2;

/** The renderer, and the surroundings: sun, sky and ground. */
export class Stage {
  readonly renderer: WebGLRenderer;
  readonly scene = new ThreeScene();
  readonly camera = new PerspectiveCamera(45, 1, 0.01, 2000);
  /** True if pictures are rendered by software, not by a graphics card. */
  readonly isSoftware: boolean;
  readonly quality: Quality;
  /** A sphere around everything that casts shadows. */
  surroundings: Sphere | undefined;
  /** True if something that casts shadows has moved. */
  isShadowStale = true;
  theme: Theme = "light";

  private readonly sun = new DirectionalLight(0xffffff, 2);
  private readonly fill = new HemisphereLight(0xffffff, 0x8a8f96, 1);
  private readonly sky = new Sky();
  private readonly fog = new Fog(0, 25, 160);
  private ground: Ground | undefined;
  private chosenRatio: number;
  private isFine = false;
  private reflections: Texture | undefined;

  constructor(canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: "high-performance" });
    this.isSoftware = drawsInSoftware(this.renderer);
    this.quality = new Quality(this.isSoftware ? 1 : 0);
    this.chosenRatio = this.ratio();
    this.renderer.setPixelRatio(this.chosenRatio);
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.autoUpdate = false;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.camera.up.set(0, 0, 1);
    this.fill.position.set(0, 0, 1);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(shadowTexels, shadowTexels);
    this.sun.shadow.radius = 2.5; // [texels]
    this.sun.shadow.intensity = 0.85;
    this.scene.fog = this.fog;
    this.scene.add(this.sun, this.sun.target, this.fill, this.sky.mesh);
  }

  resize(width: number, height: number): void {
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
  }

  wear(theme: Theme): void {
    if (theme !== this.theme) {
      this.reflections?.dispose();
      this.reflections = undefined;
    }
    this.theme = theme;
    const look = looks[theme];
    this.sky.wear(look.sky, look.glow);
    this.fog.color.set(look.sky.horizon);
    this.ground?.wear(look.ground.color, look.ground.line);
    this.sun.intensity = look.sun.intensity;
    this.sun.color.set(look.sun.color);
    this.fill.color.set(look.fill.sky);
    this.fill.groundColor.set(look.fill.ground);
    this.reflect();
  }

  cast(shadows: boolean): void {
    if (shadows && !this.sun.castShadow) this.isShadowStale = true;
    this.sun.castShadow = shadows;
  }

  /** Draws the plane of a scene as infinite ground. */
  lay(scene: Scene): void {
    this.ground?.dispose();
    if (this.ground) this.scene.remove(this.ground.mesh);
    this.ground = undefined;
    const shape = scene.models
      .flatMap(({ links }) => links.flatMap(({ shapes }) => shapes))
      .find(({ kind }) => kind === ShapeKind.plane);
    if (shape) {
      this.ground = new Ground(shape.pose, shape.size);
      this.scene.add(this.ground.mesh);
    }
    this.wear(this.theme);
  }

  /** Returns the height of the ground [m], if there is one and it is level. */
  get groundHeight(): number | undefined {
    return this.ground?.height;
  }

  /** Takes the time since the previous picture [ms], and adapts the quality. Returns whether it has changed. */
  adapt(elapsed: number): boolean {
    if (!this.quality.take(elapsed)) return false;
    this.applyQuality();
    return true;
  }

  /** Draws one picture at full resolution, such as for a screenshot. */
  drawFinely(target: Vector3): void {
    this.setRatio(Math.min(window.devicePixelRatio, mostPixelRatio));
    this.draw(target);
    this.isFine = true;
  }

  draw(target: Vector3): void {
    if (this.isFine) this.setRatio(this.ratio());
    this.isFine = false;
    const distance = this.camera.position.distanceTo(target);
    this.fog.near = Math.max(8, 1.5 * distance);
    this.fog.far = Math.max(90, 9 * distance);
    this.ground?.surround(this.camera.position, this.fog.far);
    this.camera.near = Math.min(0.1, Math.max(0.005, 0.01 * distance));
    this.camera.far = 3 * this.fog.far;
    this.camera.updateProjectionMatrix();
    if (this.sun.castShadow) this.aimSun(target, distance);
    this.renderer.render(this.scene, this.camera);
  }

  add(...objects: Object3D[]): void {
    this.scene.add(...objects);
  }
  remove(...objects: Object3D[]): void {
    this.scene.remove(...objects);
  }

  // The shadow map covers everything, unless that is much larger than the camera's view; then it covers the view. It
  // moves by whole texels, so that the edges of shadows do not flicker.
  private aimSun(target: Vector3, distance: number): void {
    const around = Math.max(shadowReach, 0.8 * distance);
    const isAll = this.surroundings !== undefined && this.surroundings.radius <= 1.5 * around;
    const wanted = isAll && this.surroundings ? 1.02 * this.surroundings.radius : around;
    const { camera } = this.sun.shadow;
    const isFar = wanted > camera.right || wanted < 0.7 * camera.right;
    if (isFar) {
      const reach = 1.1 * wanted;
      Object.assign(camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1, far: 4 * reach });
      camera.updateProjectionMatrix();
      this.isShadowStale = true;
    }
    const texel = (2 * camera.right) / shadowTexels;
    this.sun.shadow.normalBias = 0.7 * texel;
    const centre = isAll && this.surroundings ? this.surroundings.center : target;
    const across = new Vector3(0, 0, 1).cross(sunDirection).normalize();
    const along = sunDirection.clone().cross(across);
    const snapped = new Vector3();
    for (const axis of [across, along, sunDirection])
      snapped.addScaledVector(axis, Math.round(centre.dot(axis) / texel) * texel);
    if (snapped.distanceTo(this.sun.target.position) > 0.5 * texel) this.isShadowStale = true;
    this.sun.target.position.copy(snapped);
    this.sun.position.copy(snapped).addScaledVector(sunDirection, 2 * camera.right);
    this.renderer.shadowMap.needsUpdate = this.isShadowStale;
    this.isShadowStale = false;
  }

  private ratio(): number {
    return Math.min(window.devicePixelRatio, mostPixelRatio) * levels[this.quality.level].resolution;
  }

  private applyQuality(): void {
    this.setRatio(this.ratio());
    this.reflect();
  }

  // A ratio that other code has set is kept.
  private setRatio(ratio: number): void {
    if (this.renderer.getPixelRatio() !== this.chosenRatio || ratio === this.chosenRatio) return;
    this.chosenRatio = ratio;
    this.renderer.setPixelRatio(ratio);
  }

  private reflect(): void {
    const look = looks[this.theme];
    const isOn = levels[this.quality.level].reflections;
    if (isOn && !this.reflections) this.reflections = reflectionsOf(this.renderer, look, sunDirection);
    this.scene.environment = isOn ? (this.reflections ?? null) : null;
    this.scene.environmentIntensity = look.reflections;
    this.fill.intensity = look.fill.intensity * (isOn ? 1 : fillWithoutReflections);
  }
}

function drawsInSoftware(renderer: WebGLRenderer): boolean {
  const gl = renderer.getContext();
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(names ? gl.getParameter(names.UNMASKED_RENDERER_WEBGL) : gl.getParameter(gl.RENDERER));
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
