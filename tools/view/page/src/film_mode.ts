// SPDX-License-Identifier: Apache-2.0
import { Box3, Sphere, Vector3 } from "three";
import type { Connection } from "./data/connection";
import type { Topic } from "./data/messages";
import { element } from "./element";
import { clockText } from "./panels/time_bar";
import type { Viewpoint } from "./picture/cameras";
import type { Layer, Viewer } from "./viewer";

interface FilmLook {
  width: number; // [pixels]
  height: number;
  theme: "light" | "dark";
  caption: string;
  showsClock: boolean;
  layers: Layer[];
  fromAbove: boolean;
  distance?: number; // [m]
}
interface Moment {
  time: number; // [s]
  viewpoint?: Viewpoint;
  followed?: { centre: number[]; radius: number };
}

const filmLayers: readonly Layer[] = ["labels", "trails", "contacts", "rays", "shadows"];
const margin = 0.4; // [m] around the followed objects
const pastBlend = 1000; // [ms] after which poses are those of the last frame

const boxAround = (centre: readonly number[], radius: number): Box3 =>
  new Sphere(new Vector3(...centre), radius).getBoundingBox(new Box3());

/**
 * Draws the pictures of `cohort film` on request. The page is in this mode if its address has the parameter `film`
 * after `#`.
 */
export class FilmMode {
  readonly isOn = new URLSearchParams(location.hash.slice(1)).has("film");
  private readonly picture = document.createElement("canvas");
  private look: FilmLook | undefined;
  private readonly target = new Vector3();
  private offset: Vector3 | undefined; // from the target to the camera

  constructor(
    private readonly viewer: Viewer,
    private readonly connection: Connection,
    private readonly canvas: HTMLCanvasElement,
  ) {}

  prepare(look: FilmLook): void {
    const { viewer, canvas } = this;
    this.look = look;
    document.body.classList.add("film");
    const [width, height] = [`${look.width}px`, `${look.height}px`];
    Object.assign(canvas.style, { position: "fixed", left: "0", top: "0", width, height });
    Object.assign(this.picture, { width: look.width, height: look.height });
    viewer.isExact = true;
    Object.assign(viewer.stage.quality, { level: 0, isHeld: true }); // the finest level, set before a theme is chosen
    viewer.stage.renderer.setPixelRatio(1);
    viewer.stage.resize(look.width, look.height);
    viewer.wear(look.theme);
    for (const layer of filmLayers) if (viewer.layers.has(layer) !== look.layers.includes(layer)) viewer.toggle(layer);
    this.connection.want("/cohort/contacts", look.layers.includes("contacts"));
  }

  /** Waits until the last message of each of these topics has this time, and the images of the scene are decoded. */
  async received(awaited: { [T in Topic]?: number }): Promise<void> {
    const times = Object.entries(awaited) as [Topic, number][];
    while (!times.every(([topic, time]) => this.connection.received.get(topic) === BigInt(time)))
      await new Promise((resolve) => setTimeout(resolve, 1));
    await this.viewer.textures?.ready;
  }

  /** Returns the picture as a data URL (PNG). */
  draw(moment: Moment): string {
    const { viewer, picture, look } = this;
    const context = picture.getContext("2d");
    if (!look || !context) throw new Error("the film is not prepared");
    viewer.cameras.look(moment.viewpoint ?? this.viewpoint(moment, look));
    viewer.draw(performance.now() + pastBlend);
    context.drawImage(this.canvas, 0, 0, picture.width, picture.height); // the picture is kept until this task ends
    this.drawLabels(context);
    const size = Math.max(12, Math.round(picture.height / 36));
    context.font = `${size}px ${getComputedStyle(document.body).fontFamily}`;
    if (look.caption) this.drawText(context, look.caption, size, "left");
    if (look.showsClock) this.drawText(context, clockText(moment.time), size, "right");
    return picture.toDataURL("image/png");
  }

  // Returns the initial viewpoint, moved with the followed objects.
  private viewpoint({ followed }: Moment, look: FilmLook): Viewpoint {
    const { cameras, stage } = this.viewer;
    if (!this.offset) {
      if (followed) cameras.home([boxAround(followed.centre, margin + followed.radius)]);
      else this.viewer.home();
      if (look.fromAbove) cameras.choose("top");
      this.target.copy(cameras.target);
      this.offset = stage.camera.position.clone().sub(this.target);
      if (look.distance !== undefined) this.offset.setLength(look.distance);
    }
    if (followed) this.target.fromArray(followed.centre);
    return { position: this.target.clone().add(this.offset).toArray(), target: this.target.toArray() };
  }

  private drawLabels(context: CanvasRenderingContext2D): void {
    const parent = element("labels");
    const origin = parent.getBoundingClientRect();
    for (const label of parent.querySelectorAll<HTMLElement>("span:not([hidden])")) {
      const { left, top, width, height } = label.getBoundingClientRect();
      const style = getComputedStyle(label);
      context.font = `${style.fontSize} ${style.fontFamily}`;
      this.drawPill(context, left - origin.left, top - origin.top, width, height);
      context.textAlign = "center";
      context.fillText(label.textContent ?? "", left - origin.left + width / 2, top - origin.top + height / 2, width);
    }
  }

  // Draws a text in a lower corner.
  private drawText(context: CanvasRenderingContext2D, text: string, size: number, side: "left" | "right"): void {
    const { width, height } = this.picture;
    const space = 0.6 * size;
    const textWidth = Math.min(context.measureText(text).width, 0.7 * width);
    const left = side === "left" ? size : width - size - textWidth - 2 * space;
    this.drawPill(context, left, height - 2.8 * size, textWidth + 2 * space, 1.8 * size);
    context.textAlign = "left";
    context.fillText(text, left + space, height - 1.9 * size, textWidth);
  }

  // Draws the background of a text, and sets the colour for the text.
  private drawPill(context: CanvasRenderingContext2D, x: number, y: number, width: number, height: number): void {
    const style = getComputedStyle(document.body);
    context.fillStyle = style.getPropertyValue("--card");
    context.beginPath();
    context.roundRect(x, y, width, height, Math.min(6, height / 4));
    context.fill();
    context.fillStyle = style.getPropertyValue("--text");
    context.textBaseline = "middle";
  }
}
