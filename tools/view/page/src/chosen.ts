// SPDX-License-Identifier: Apache-2.0
import { none, type Scene, type SceneEntity } from "./data/messages";

/** The entities of a scene that the user has selected, and those that the user has hidden. */
export class Chosen {
  /** Selected entities, in the order of their selection. */
  selection: ReadonlySet<number> = new Set();
  hidden: ReadonlySet<number> = new Set();
  private scene: Scene | undefined;

  constructor(
    private readonly onSelect: () => void,
    private readonly onHide: () => void,
  ) {}

  /**
   * Moves to another scene, and selects and hides the entities that have the same names there. Returns the entity that
   * was selected last, or -1 if it is missing.
   */
  moveTo(scene: Scene): number {
    const nameOf = (entity: number): string | undefined => this.scene?.entities[entity].name;
    const [selected, hidden] = [this.selection, this.hidden].map((set) => new Set([...set].map(nameOf)));
    const lastName = this.selectedEntity?.name;
    const known = (names: ReadonlySet<string | undefined>): number[] =>
      scene.entities.flatMap(({ name }, entity) => (names.has(name) ? [entity] : []));
    this.scene = scene;
    this.hide(known(hidden));
    const last = scene.entities.findIndex(({ name }) => name === lastName);
    this.selectMany([...known(selected).filter((each) => each !== last), ...(last >= 0 ? [last] : [])]);
    return last;
  }

  select(entity: number | undefined): void {
    this.selectMany(entity === undefined ? [] : [entity]);
  }
  selectMany(entities: readonly number[]): void {
    this.selection = new Set(entities);
    this.onSelect();
  }

  /** The entity that was selected last. */
  get selected(): number | undefined {
    return [...this.selection].at(-1);
  }
  get selectedEntity(): SceneEntity | undefined {
    return this.selected === undefined ? undefined : this.scene?.entities[this.selected];
  }
  /** Returns the ids of the selected robots. */
  robots(): Set<number> {
    const robots = [...this.selection].map((entity) => this.scene?.entities[entity].robot ?? none);
    return new Set(robots.filter((robot) => robot !== none));
  }

  /** Hides all movable entities except the selection. */
  isolate(): void {
    const { models, entities } = this.scene ?? { models: [], entities: [] };
    const isOther = (entity: number): boolean =>
      !models[entities[entity].model].is_static && !this.selection.has(entity);
    this.hide(entities.flatMap((_, entity) => (isOther(entity) ? [entity] : [])));
    this.selectMany([...this.selection]);
  }
  hideSelection(): void {
    this.hide([...this.hidden, ...this.selection]);
    this.selectMany([]);
  }
  unhide(entity: number): void {
    this.hide([...this.hidden].filter((each) => each !== entity));
    this.selectMany([...this.selection]);
  }
  showAll(): void {
    this.hide([]);
    this.selectMany([...this.selection]);
  }
  private hide(entities: readonly number[]): void {
    this.hidden = new Set(entities);
    this.onHide();
  }
}
