// SPDX-License-Identifier: Apache-2.0
import {
  AdditiveBlending,
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  Color,
  Group,
  LineBasicMaterial,
  LineLoop,
  NormalBlending,
  Points,
  Quaternion,
  ShaderMaterial,
  Sprite,
  SpriteMaterial,
  Vector3,
} from "three";
import type { SceneEmitter, SceneSignals } from "../data/messages";
import { overlayColors } from "./overlays";
import type { Poses } from "./poses";

const ledSize = 0.028; // [m], with its glow
const circlePoints = 96;

const vertexShader = `
attribute vec3 tint;
uniform float size;
uniform float height;
varying vec3 shown;
void main() {
  shown = tint;
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * at;
  gl_PointSize = max(2.0, size * height * projectionMatrix[1][1] / (2.0 * -at.z));
}`;
const fragmentShader = `
varying vec3 shown;
uniform float strength;
void main() {
  float r = 2.0 * length(gl_PointCoord - 0.5);
  float core = 1.0 - smoothstep(0.12, 0.34, r);
  float halo = pow(max(0.0, 1.0 - r), 2.2);
  vec3 color = mix(shown, vec3(1.0), 0.65 * core);
  gl_FragColor = vec4(color, clamp(core + strength * halo, 0.0, 1.0));
}`;

function glowTexture(): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 128;
  const context = canvas.getContext("2d");
  if (!context) throw new Error("this browser cannot draw on a canvas");
  const gradient = context.createRadialGradient(64, 64, 0, 64, 64, 64);
  gradient.addColorStop(0, "rgba(255,255,255,1)");
  gradient.addColorStop(0.12, "rgba(255,255,255,0.9)");
  gradient.addColorStop(0.35, "rgba(255,255,255,0.25)");
  gradient.addColorStop(1, "rgba(255,255,255,0)");
  context.fillStyle = gradient;
  context.fillRect(0, 0, 128, 128);
  return new CanvasTexture(canvas);
}

function reachCircle(radius: number, color: Color): LineLoop {
  const points = Array.from({ length: circlePoints }, (_, i) => {
    const angle = (2 * Math.PI * i) / circlePoints;
    return new Vector3(radius * Math.cos(angle), radius * Math.sin(angle), 0);
  });
  return new LineLoop(
    new BufferGeometry().setFromPoints(points),
    new LineBasicMaterial({ color, transparent: true, opacity: 0.5, toneMapped: false }),
  );
}

interface Lamp {
  glow: Sprite;
  circle: LineLoop | undefined;
}

/** Draws lights: LEDs as points with a halo, lamps as billboards with a circle at their range. */
export class Glow {
  readonly group = new Group();
  private readonly points: Points<BufferGeometry, ShaderMaterial>;
  private readonly lamps: Lamp[];
  private lit: number[] = [];
  private signals: SceneSignals | undefined;
  private readonly position = new Vector3();
  private readonly orientation = new Quaternion();

  constructor(private readonly poses: Poses) {
    const { leds, lamps } = poses.scene;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(3 * leds.length), 3));
    geometry.setAttribute("tint", new BufferAttribute(new Float32Array(3 * leds.length), 3));
    geometry.setDrawRange(0, 0);
    const uniforms = { size: { value: ledSize }, height: { value: 600 }, strength: { value: 0.55 } };
    this.points = new Points(
      geometry,
      new ShaderMaterial({ uniforms, vertexShader, fragmentShader, transparent: true, depthWrite: false }),
    );
    this.points.frustumCulled = false;
    this.group.add(this.points);
    const texture = glowTexture();
    this.lamps = lamps.map((lamp) => this.addLamp(lamp, texture));
  }

  wear(isDark: boolean): void {
    this.points.material.blending = isDark ? AdditiveBlending : NormalBlending;
    this.points.material.uniforms.strength.value = isDark ? 0.9 : 0.55;
  }

  take(signals: SceneSignals): void {
    if (signals.revision !== this.poses.scene.revision) return;
    this.signals = signals;
    this.lit = [];
    const tint = this.points.geometry.getAttribute("tint") as BufferAttribute;
    for (let led = 0; 3 * led < signals.leds.length; ++led) {
      const [r, g, b] = signals.leds.subarray(3 * led, 3 * led + 3);
      if (r + g + b === 0 || this.poses.absent.has(this.poses.scene.leds[led].entity)) continue;
      tint.setXYZ(this.lit.length, r / 255, g / 255, b / 255);
      this.lit.push(led);
    }
    tint.needsUpdate = true;
    this.points.geometry.setDrawRange(0, this.lit.length);
    this.lamps.forEach(({ glow, circle }, lamp) => {
      const [r, g, b, intensity] = signals.lamps.subarray(4 * lamp, 4 * lamp + 4);
      glow.visible = intensity > 0;
      glow.material.color.setRGB(r, g, b);
      if (circle) circle.visible = glow.visible;
    });
  }

  get litLamps(): number {
    return this.lamps.filter(({ glow }) => glow.visible).length;
  }

  draw(height: number): void {
    if (!this.signals) return;
    const { leds, lamps } = this.poses.scene;
    this.points.material.uniforms.height.value = height;
    const positions = this.points.geometry.getAttribute("position") as BufferAttribute;
    this.lit.forEach((led, i) => {
      this.place(leds[led]);
      positions.setXYZ(i, this.position.x, this.position.y, this.position.z);
    });
    positions.needsUpdate = true;
    this.lamps.forEach(({ glow, circle }, lamp) => {
      this.place(lamps[lamp]);
      glow.position.copy(this.position);
      circle?.position.set(this.position.x, this.position.y, 0.003);
    });
  }

  private addLamp({ range }: SceneEmitter, texture: CanvasTexture): Lamp {
    const glow = new Sprite(
      new SpriteMaterial({ map: texture, transparent: true, depthWrite: false, toneMapped: false }),
    );
    glow.scale.setScalar(0.35);
    glow.visible = false;
    const hasReach = range > 0 && range < 1e4;
    const circle = hasReach ? reachCircle(range, new Color(overlayColors.lamp)) : undefined;
    this.group.add(glow, ...(circle ? [circle] : []));
    return { glow, circle };
  }

  private place({ link, position }: SceneEmitter): void {
    this.poses.read(link, this.position, this.orientation);
    this.position.add(new Vector3(position[0], position[1], position[2]).applyQuaternion(this.orientation));
  }
}
