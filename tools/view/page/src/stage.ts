import {
  Color,
  DirectionalLight,
  Fog,
  HemisphereLight,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
  PCFShadowMap,
  PerspectiveCamera,
  PlaneGeometry,
  Quaternion,
  Scene as ThreeScene,
  Vector3,
  WebGLRenderer,
} from "three";
import { type Scene, ShapeKind } from "./messages";

export type Theme = "light" | "dark";

const looks = {
  light: { sky: 0xe9edf1, ground: 0xdfe3e7, line: 0x8793a0, sun: 2.4, fill: 1.5 },
  dark: { sky: 0x14181d, ground: 0x22282f, line: 0x5a6673, sun: 1.7, fill: 0.75 },
};
const groundSize = 400; // [m]
const shadowReach = 3; // [m]; around what the camera looks at, at the least

// Lines every 0.1, 1 and 10 m, of which the finer ones fade with distance.
const gridLines = `
float lineOf(vec2 at, float spacing, float width) {
  vec2 scaled = at / spacing;
  vec2 slope = fwidth(scaled);
  vec2 distance = abs(fract(scaled - 0.5) - 0.5) / max(slope, vec2(1e-6));
  float fading = 1.0 - smoothstep(0.15, 0.6, max(slope.x, slope.y));
  return (1.0 - min(min(distance.x, distance.y) / width, 1.0)) * fading;
}
`;

/** The surroundings of everything: the renderer, sun and ground. */
export class Stage {
  readonly renderer: WebGLRenderer;
  readonly scene = new ThreeScene();
  readonly camera = new PerspectiveCamera(45, 1, 0.01, 2000);
  private readonly sun = new DirectionalLight(0xffffff, 2);
  private readonly fill = new HemisphereLight(0xffffff, 0x8a8f96, 1);
  private readonly grounds: Mesh[] = [];
  private readonly lineColor = { value: new Color() };
  theme: Theme = "light";

  constructor(canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: "high-performance" });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.camera.up.set(0, 0, 1);
    this.fill.position.set(0, 0, 1);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.normalBias = 0.002;
    this.scene.add(this.sun, this.sun.target, this.fill);
  }

  resize(width: number, height: number): void {
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
  }

  wear(theme: Theme): void {
    this.theme = theme;
    const look = looks[theme];
    this.scene.background = new Color(look.sky);
    this.scene.fog = new Fog(look.sky, 25, 160);
    this.lineColor.value.set(look.line);
    for (const { material } of this.grounds) (material as MeshStandardMaterial).color.set(look.ground);
    this.sun.intensity = look.sun;
    this.fill.intensity = look.fill;
  }

  cast(shadows: boolean): void {
    this.sun.castShadow = shadows;
  }

  /** The planes of a scene, which are without end. */
  lay(scene: Scene): void {
    for (const ground of this.grounds.splice(0)) this.scene.remove(ground);
    for (const model of scene.models)
      for (const link of model.links)
        for (const shape of link.shapes)
          if (shape.kind === ShapeKind.plane && this.grounds.length === 0) this.addGround(shape.pose, shape.size);
    this.wear(this.theme);
  }

  /** The shadows are sharp around what is looked at. */
  draw(target: Vector3): void {
    const reach = Math.max(shadowReach, 0.8 * this.camera.position.distanceTo(target));
    const { camera } = this.sun.shadow;
    if (Math.abs(camera.right - reach) > 0.2 * reach) {
      Object.assign(camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1, far: 8 * reach });
      camera.updateProjectionMatrix();
    }
    this.sun.target.position.copy(target);
    this.sun.position.copy(target).add(new Vector3(-0.45, -0.35, 1).multiplyScalar(4 * camera.right));
    this.renderer.render(this.scene, this.camera);
  }

  add(...objects: Object3D[]): void {
    this.scene.add(...objects);
  }
  remove(...objects: Object3D[]): void {
    this.scene.remove(...objects);
  }

  private addGround(pose: Float32Array, normal: Float32Array): void {
    const material = new MeshStandardMaterial({
      roughness: 0.95,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    material.onBeforeCompile = (shader) => {
      shader.uniforms.lineColor = this.lineColor;
      shader.vertexShader =
        "varying vec2 at;\n" +
        shader.vertexShader.replace(
          "#include <begin_vertex>",
          "#include <begin_vertex>\nat = (modelMatrix * vec4(position, 1.0)).xy;",
        );
      shader.fragmentShader =
        `varying vec2 at;\nuniform vec3 lineColor;\n${gridLines}` +
        shader.fragmentShader.replace(
          "#include <color_fragment>",
          `#include <color_fragment>
        float line = max(max(0.16 * lineOf(at, 0.1, 1.0), 0.42 * lineOf(at, 1.0, 1.2)), 0.6 * lineOf(at, 10.0, 1.5));
        diffuseColor.rgb = mix(diffuseColor.rgb, lineColor, line);`,
        );
    };
    const ground = new Mesh(new PlaneGeometry(groundSize, groundSize), material);
    ground.receiveShadow = true;
    const turn = new Quaternion(pose[3], pose[4], pose[5], pose[6]);
    const up = new Vector3(normal[0], normal[1], normal[2]).applyQuaternion(turn);
    ground.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), up);
    ground.position.set(pose[0], pose[1], pose[2]);
    this.grounds.push(ground);
    this.scene.add(ground);
  }
}
