// SPDX-License-Identifier: Apache-2.0
import { Quaternion, Vector3 } from "three";
import { type Command, command } from "../commands";
import type { Connection, ViewRequest } from "../data/connection";
import { none, type Scene, ShapeKind } from "../data/messages";
import { element } from "../element";
import type { ConsolePanel } from "../panels/console";
import type { Panels } from "../panels/panels";
import { Ghost, originOf, standingHeight } from "../picture/ghost";
import type { Viewer } from "../viewer";
import { Removal } from "./removal";

interface Dragged {
  name: string;
  model: number;
  origin: number[];
  heading: number;
  height: number;
  grabbed: [number, number];
}

/** Lets the user add, drag, remove and switch objects of a server. */
export class Objects {
  private readonly ghost = new Ghost();
  private readonly card = element("adding");
  private readonly models = element("adding-model") as HTMLSelectElement;
  private readonly name = element("adding-name") as HTMLInputElement;
  private readonly removal: Removal;
  private dragged: Dragged | undefined;

  constructor(
    private readonly viewer: Viewer,
    private readonly connection: Connection,
    private readonly console: ConsolePanel,
    private readonly canvas: HTMLCanvasElement,
    private readonly panels: Panels,
  ) {
    viewer.stage.add(this.ghost.group);
    this.removal = new Removal(viewer, (name) => this.ask({ operation: "remove", name }));
    viewer.cameras.isHeld = () => this.isAdding || this.isDragging;
    this.models.addEventListener("change", () => this.suggestName());
    element("adding-close").addEventListener("click", () => this.close());
    element("remove").addEventListener("click", () => {
      canvas.focus();
      this.removal.begin(viewer.chosen.selectedEntity?.name);
    });
    element("light").addEventListener("click", () => void this.switchLight());
    canvas.addEventListener("pointerleave", () => this.ghost.hide());
  }

  consoleCommands(): Command[] {
    return [
      command(
        "add [MODEL]",
        "opens or closes the card for adding objects by a click",
        ([model]) => {
          if (this.isAdding && model === undefined) this.close();
          else this.open(model);
        },
        () => this.modelNames(),
      ),
    ];
  }

  get isAdding(): boolean {
    return !this.card.hidden;
  }
  close(): void {
    this.card.hidden = true;
    this.ghost.hide();
  }

  /** Called when the scene or the selection has changed. */
  show(): void {
    if (this.isAdding) this.offer(this.models.value);
    const lamps = this.lampsOfSelected();
    element("light").hidden = lamps.length === 0;
    this.showLight();
  }
  showLight(): void {
    const isOn = this.lampsOfSelected().some((lamp) => this.shines(lamp));
    element("light").textContent = isOn ? "light off" : "light on";
  }

  // Mouse input, with positions in the picture.

  /** Returns whether there is an object to drag. */
  grab(x: number, y: number): boolean {
    const { viewer } = this;
    const { poses } = viewer;
    const entity = viewer.pickAt(x, y);
    if (entity === undefined || !poses) return false;
    const { scene } = poses;
    const { name, model } = scene.entities[entity];
    const [position, turn] = [new Vector3(), new Quaternion()];
    poses.read(poses.placeOf(entity), position, turn, 1); // the drawn pose may lag behind
    const grabbed = viewer.placeAt(x, y, position.z);
    if (!grabbed) return false;
    const { place, heading } = originOf(scene, model, position, turn);
    this.dragged = { name, model, origin: place, heading, height: position.z, grabbed };
    return true;
  }
  get isDragging(): boolean {
    return this.dragged !== undefined;
  }

  hover(x: number, y: number): void {
    const scene = this.viewer.poses?.scene;
    if (!scene) return;
    if (this.dragged) {
      const place = this.dragTo(this.dragged, x, y);
      if (place) this.ghost.show(scene, this.dragged.model, place, this.dragged.heading);
    } else if (this.isAdding) {
      const place = this.standingPlace(scene, x, y);
      if (place) this.ghost.show(scene, this.modelIndex(scene), place, 0);
      else this.ghost.hide();
    }
  }

  async drop(x: number, y: number): Promise<void> {
    const { dragged } = this;
    const numbers = dragged && this.dragTo(dragged, x, y);
    this.dragged = undefined;
    this.ghost.hide();
    if (dragged && numbers)
      await this.ask({ operation: "move", name: dragged.name, numbers: [...numbers, dragged.heading] });
  }

  /** Adds an object at the clicked place. Returns false if the user is not adding objects. */
  place(x: number, y: number): boolean {
    const scene = this.viewer.poses?.scene;
    if (!this.isAdding || !scene) return false;
    const numbers = this.standingPlace(scene, x, y);
    if (numbers) void this.ask({ operation: "spawn", name: this.name.value.trim(), text: this.models.value, numbers });
    return true;
  }

  // The card.

  private open(model = this.models.value): void {
    const names = this.modelNames();
    if (names.length === 0) throw new Error("this world has no models of objects to add");
    if (model !== "" && !names.includes(model))
      throw new Error(`there is no model '${model}' to add: expected one of ${names.join(", ")}`);
    this.viewer.chosen.select(undefined);
    this.card.hidden = false;
    this.panels.show("right");
    this.offer(model);
  }

  private offer(chosen: string): void {
    const names = this.modelNames();
    const isNew =
      names.length !== this.models.options.length || names.some((name, i) => name !== this.models.options[i].value);
    if (isNew) this.models.replaceChildren(...names.map((name) => new Option(name, name)));
    if (names.includes(chosen)) this.models.value = chosen;
    this.suggestName();
  }

  // Suggests the first name that no object has or had in this run.
  private suggestName(): void {
    const taken = new Set(this.viewer.poses?.scene.entities.map(({ name }) => name));
    const kept = this.name.value.trim();
    if (kept !== "" && !taken.has(kept) && this.name.dataset.model === this.models.value) return;
    let number = 1;
    while (taken.has(`${this.models.value}_${number}`)) ++number;
    this.name.value = `${this.models.value}_${number}`;
    this.name.dataset.model = this.models.value;
  }

  // Leaves out robots, which cannot be added during the run, and the ground, of which there is only one.
  private modelNames(): string[] {
    const scene = this.viewer.poses?.scene;
    if (!scene) return [];
    const ofRobots = new Set(scene.entities.filter(({ robot }) => robot !== none).map(({ model }) => model));
    const isSolid = (model: number): boolean =>
      scene.models[model].links.some(({ shapes }) => shapes.some(({ kind }) => kind !== ShapeKind.plane));
    const names = scene.models.flatMap(({ name }, model) => (ofRobots.has(model) || !isSolid(model) ? [] : [name]));
    return [...new Set(names)];
  }

  private modelIndex(scene: Scene): number {
    return scene.models.findIndex(({ name }) => name === this.models.value);
  }

  private standingPlace(scene: Scene, x: number, y: number): number[] | undefined {
    const model = this.modelIndex(scene);
    const place = this.viewer.placeAt(x, y, 0);
    return place && model >= 0 ? [...place, standingHeight(scene, model)] : undefined;
  }

  private dragTo({ origin, grabbed, height }: Dragged, x: number, y: number): number[] | undefined {
    const place = this.viewer.placeAt(x, y, height);
    return place && [origin[0] + place[0] - grabbed[0], origin[1] + place[1] - grabbed[1], origin[2]];
  }

  // The selection.

  private async switchLight(): Promise<void> {
    const { selectedEntity } = this.viewer.chosen;
    this.canvas.focus();
    if (!selectedEntity) return;
    const isOn = this.lampsOfSelected().some((lamp) => this.shines(lamp));
    await this.ask({ operation: "light", name: selectedEntity.name, number: isOn ? 0 : 1 });
  }

  private lampsOfSelected(): number[] {
    const { poses } = this.viewer;
    const { selected } = this.viewer.chosen;
    return poses?.scene.lamps.flatMap(({ entity }, lamp) => (entity === selected ? [lamp] : [])) ?? [];
  }
  private shines(lamp: number): boolean {
    return (this.viewer.signals?.lamps[4 * lamp + 3] ?? 0) > 0;
  }

  private async ask(request: ViewRequest): Promise<boolean> {
    const { done, text } = await this.connection.ask(request);
    this.console.say(text, done ? "said" : "wrong");
    return done;
  }
}
