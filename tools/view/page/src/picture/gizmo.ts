// SPDX-License-Identifier: Apache-2.0
import { type PerspectiveCamera, Quaternion, Vector3 } from "three";

const svgNamespace = "http://www.w3.org/2000/svg";
const axes = [
  { name: "x", color: "#d64545", direction: new Vector3(1, 0, 0) },
  { name: "y", color: "#3a9b45", direction: new Vector3(0, 1, 0) },
  { name: "z", color: "#3b7ddd", direction: new Vector3(0, 0, 1) },
];
const radius = 22; // [pixels]
const longestBar = 120; // [pixels]
const inset = 12; // [pixels] from the edges of the picture

/** Returns the longest of 1, 2 or 5 times a power of ten that is at most `most`. */
export function roundLength(most: number): number {
  const power = 10 ** Math.floor(Math.log10(most));
  const factor = [5, 2, 1].find((each) => each * power <= most * (1 + 1e-9)) ?? 1;
  return factor * power;
}

export function lengthText(length: number): string {
  const tidy = (value: number): string => String(Number(value.toPrecision(3)));
  if (length >= 1000) return `${tidy(length / 1000)} km`;
  if (length >= 1) return `${tidy(length)} m`;
  return length >= 0.01 ? `${tidy(100 * length)} cm` : `${tidy(1000 * length)} mm`;
}

function added<Name extends keyof SVGElementTagNameMap>(
  parent: Element,
  name: Name,
  attributes: Record<string, string | number>,
): SVGElementTagNameMap[Name] {
  const element = document.createElementNS(svgNamespace, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  return parent.appendChild(element);
}

/** Shows the directions of the axes, and a scale bar of a round length at the distance of the camera's target. */
export class Gizmo {
  private readonly svg: SVGSVGElement;
  private readonly arms: { group: SVGGElement; line: SVGLineElement; dot: SVGCircleElement; text: SVGTextElement }[];
  private readonly bar: SVGPathElement;
  private readonly length: SVGTextElement;
  private readonly turn = new Quaternion();
  private readonly at = new Vector3();
  private last = "";

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.svg = document.createElementNS(svgNamespace, "svg");
    this.svg.id = "gizmo";
    this.svg.setAttribute("role", "img");
    this.svg.setAttribute("aria-label", "Axes and scale");
    this.svg.setAttribute("width", "220");
    this.svg.setAttribute("height", "64");
    Object.assign(this.svg.style, {
      position: "absolute",
      pointerEvents: "none",
      overflow: "visible",
      color: "inherit",
    });
    const cross = added(this.svg, "g", { transform: "translate(30 34)" });
    this.arms = axes.map(({ color, name }) => {
      const group = added(cross, "g", {});
      const line = added(group, "line", { stroke: color, "stroke-width": 2.5, "stroke-linecap": "round" });
      const dot = added(group, "circle", { r: 7, fill: color });
      const text = added(group, "text", {
        fill: "white",
        "font-size": 10,
        "font-weight": 600,
        "text-anchor": "middle",
        "dominant-baseline": "central",
      });
      text.textContent = name;
      return { group, line, dot, text };
    });
    const halo = { "paint-order": "stroke", stroke: "var(--card)", "stroke-width": 3, "stroke-linejoin": "round" };
    added(this.svg, "path", { class: "halo", stroke: "var(--card)", "stroke-width": 4.5, fill: "none" });
    this.bar = added(this.svg, "path", { stroke: "currentColor", "stroke-width": 1.5, fill: "none" });
    this.length = added(this.svg, "text", {
      ...halo,
      fill: "currentColor",
      "font-size": 11,
      "text-anchor": "middle",
      y: 44,
    });
    canvas.parentElement?.append(this.svg);
  }

  draw(camera: PerspectiveCamera, target: Vector3): void {
    const { clientWidth, clientHeight, offsetLeft, offsetTop } = this.canvas;
    if (clientHeight === 0) return;
    const metresPerPixel =
      (2 * camera.position.distanceTo(target) * Math.tan((camera.fov * Math.PI) / 360)) / clientHeight;
    const length = roundLength(longestBar * metresPerPixel);
    const { x, y, z, w } = camera.quaternion;
    const state = [offsetLeft, offsetTop, clientWidth, clientHeight, x, y, z, w, length / metresPerPixel]
      .map((each) => each.toFixed(3))
      .join(" ");
    if (state === this.last) return;
    this.last = state;
    this.svg.style.left = `${offsetLeft + inset}px`;
    this.svg.style.top = `${offsetTop + clientHeight - 64 - inset}px`;
    this.drawAxes(camera);
    this.drawBar(length, length / metresPerPixel);
  }

  private drawAxes(camera: PerspectiveCamera): void {
    this.turn.copy(camera.quaternion).invert();
    const depths = axes.map(({ direction }, i) => {
      const { x, y, z } = this.at.copy(direction).applyQuaternion(this.turn);
      const { line, dot, text } = this.arms[i];
      line.setAttribute("x2", (radius * x).toFixed(1));
      line.setAttribute("y2", (-radius * y).toFixed(1));
      dot.setAttribute("cx", (radius * x).toFixed(1));
      dot.setAttribute("cy", (-radius * y).toFixed(1));
      text.setAttribute("x", (radius * x).toFixed(1));
      text.setAttribute("y", (-radius * y).toFixed(1));
      return { i, z };
    });
    const order = depths.sort((a, b) => a.z - b.z).map(({ i }) => this.arms[i].group);
    const parent = order[0].parentElement;
    if (order.some((group, i) => parent?.children[i] !== group)) parent?.append(...order);
  }

  private drawBar(length: number, pixels: number): void {
    const path = `M70 52v5h${pixels.toFixed(1)}v-5`;
    for (const each of [this.bar, this.svg.querySelector(".halo")]) each?.setAttribute("d", path);
    this.length.setAttribute("x", (70 + 0.5 * pixels).toFixed(1));
    this.length.textContent = lengthText(length);
  }
}
