// SPDX-License-Identifier: Apache-2.0
import { element } from "../element";
import type { Viewer } from "../viewer";
import { type Row, rowsOf } from "./tree_rows";

const rowHeight = 22; // [px]; also in tree.css
const searched = 150; // [ms] from the last typed letter to the search

/** The tree of the world: teams, robots, objects and their parts. Only visible rows exist as elements. */
export class Tree {
  private rows: Row[] = [];
  private readonly open = new Set<string>();
  private active = 0; // row that keys act on
  private anchor = 0; // row where a range begins
  private readonly box = element("tree");
  private readonly list = document.createElement("div");
  private readonly search = element("wanted") as HTMLInputElement;
  private waiting: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly viewer: Viewer) {
    this.list.className = "rows";
    this.list.setAttribute("role", "none");
    this.box.append(this.list);
    this.box.addEventListener("scroll", () => this.draw());
    this.box.addEventListener("click", (event) => this.click(event));
    this.box.addEventListener("dblclick", () => this.viewer.follow());
    this.box.addEventListener("keydown", (event) => this.onKey(event));
    new ResizeObserver(() => this.draw()).observe(this.box);
    this.search.addEventListener("input", () => {
      clearTimeout(this.waiting);
      this.waiting = setTimeout(() => this.show(), searched);
    });
    this.search.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Escape") this.search.value = "";
      if (event.key === "Escape" || event.key === "Enter") this.show();
      if (event.key === "Enter" && this.rows.length > 1) this.choose(1);
      if (event.key === "ArrowDown") this.box.focus();
    });
    element("isolate").addEventListener("click", () => this.viewer.chosen.isolate());
    element("hide").addEventListener("click", () => this.viewer.chosen.hideSelection());
    element("show-all").addEventListener("click", () => this.viewer.chosen.showAll());
  }

  /** Called when the scene, the selection, or the hidden entities have changed. */
  show(): void {
    const scene = this.viewer.poses?.scene;
    if (!scene) return;
    const key = this.rows[this.active]?.key;
    if (this.open.size === 0)
      for (const { key: each, entities } of rowsOf(scene, this.open, ""))
        if (entities.length <= 40) this.open.add(each);
    this.rows = rowsOf(scene, this.open, this.search.value);
    this.active = Math.max(
      0,
      this.rows.findIndex((row) => row.key === key),
    );
    this.list.style.height = `${rowHeight * this.rows.length}px`;
    const isAny = this.viewer.chosen.selection.size > 0;
    for (const id of ["isolate", "hide"]) (element(id) as HTMLButtonElement).disabled = !isAny;
    (element("show-all") as HTMLButtonElement).disabled = this.viewer.chosen.hidden.size === 0;
    this.draw();
  }

  private draw(): void {
    const first = Math.max(0, Math.floor(this.box.scrollTop / rowHeight) - 2);
    const last = Math.min(this.rows.length, first + Math.ceil(this.box.clientHeight / rowHeight) + 4);
    this.list.replaceChildren(...this.rows.slice(first, last).map((row, i) => this.element(row, first + i)));
    const active = this.list.querySelector(".active");
    if (active) this.box.setAttribute("aria-activedescendant", active.id);
    else this.box.removeAttribute("aria-activedescendant");
  }

  private element(row: Row, index: number): HTMLElement {
    const { poses } = this.viewer;
    const { selection, hidden } = this.viewer.chosen;
    const item = document.createElement("div");
    const isGone = row.entities.every((each) => hidden.has(each) || poses?.frame?.absent.includes(each));
    item.id = `row-${index}`;
    item.dataset.row = String(index);
    item.setAttribute("role", "treeitem");
    item.setAttribute("aria-level", String(row.level));
    if (row.hasChildren) item.setAttribute("aria-expanded", String(this.isOpen(row)));
    item.setAttribute("aria-selected", String(row.level < 3 && row.entities.every((each) => selection.has(each))));
    item.classList.toggle("active", index === this.active);
    item.classList.toggle("gone", isGone);
    item.style.top = `${rowHeight * index}px`;
    const twist = document.createElement("i");
    const name = document.createElement("span");
    const detail = document.createElement("small");
    name.textContent = row.text;
    detail.textContent = row.detail;
    item.append(twist, name, detail);
    return item;
  }

  private isOpen({ key, level }: Row): boolean {
    return this.open.has(key) || (level === 1 && this.search.value.trim() !== "");
  }

  private fold(row: Row, isOpen = !this.open.has(row.key)): void {
    if (isOpen) this.open.add(row.key);
    else this.open.delete(row.key);
    this.show();
  }

  private click(event: MouseEvent): void {
    const target = event.target as HTMLElement;
    const index = Number(target.closest<HTMLElement>("[data-row]")?.dataset.row ?? Number.NaN);
    const row = this.rows[index];
    if (!row) return;
    this.active = index;
    if (target.tagName === "I" && row.hasChildren) this.fold(row);
    else this.choose(index, event);
  }

  // Selects a row: with Ctrl in addition to the present selection, with Shift all rows from the anchor to it.
  private choose(index: number, { ctrlKey = false, metaKey = false, shiftKey = false } = {}): void {
    const { viewer } = this;
    this.active = index;
    const range = shiftKey
      ? this.rows
          .slice(Math.min(index, this.anchor), Math.max(index, this.anchor) + 1)
          .filter(({ level }) => level === 2)
      : [this.rows[index]];
    if (!shiftKey) this.anchor = index;
    const chosen = range.flatMap(({ entities }) => entities);
    if (!ctrlKey && !metaKey) viewer.chosen.selectMany(chosen);
    else if (chosen.every((each) => viewer.chosen.selection.has(each)))
      viewer.chosen.selectMany([...viewer.chosen.selection].filter((each) => !chosen.includes(each)));
    else viewer.chosen.selectMany([...viewer.chosen.selection, ...chosen]);
  }

  private onKey(event: KeyboardEvent): void {
    const row = this.rows[this.active];
    if (!row) return;
    const page = Math.max(1, Math.floor(this.box.clientHeight / rowHeight) - 1);
    const moves: Record<string, number> = {
      ArrowDown: 1,
      ArrowUp: -1,
      PageDown: page,
      PageUp: -page,
      Home: -this.rows.length,
      End: this.rows.length,
    };
    if (event.key in moves) this.activate(this.active + moves[event.key]);
    else if (event.key === "ArrowRight" && row.hasChildren) this.fold(row, true);
    else if (event.key === "ArrowLeft" && row.hasChildren && this.isOpen(row)) this.fold(row, false);
    else if (event.key === "ArrowLeft") this.activate(this.parentOf(this.active));
    else if (event.key === "Enter" || event.key === " ") this.choose(this.active, event);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private parentOf(index: number): number {
    const { level } = this.rows[index];
    for (let i = index; i >= 0; --i) if (this.rows[i].level < level) return i;
    return index;
  }

  private activate(index: number): void {
    this.active = Math.min(this.rows.length - 1, Math.max(0, index));
    const top = rowHeight * this.active;
    if (top < this.box.scrollTop) this.box.scrollTop = top;
    const below = top + rowHeight - this.box.clientHeight;
    if (below > this.box.scrollTop) this.box.scrollTop = below;
    this.draw();
  }
}
