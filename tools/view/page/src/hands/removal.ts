// SPDX-License-Identifier: Apache-2.0
import { element } from "../element";
import type { Viewer } from "../viewer";

const graceTime = 5000; // [ms]

/**
 * Removes an object a few seconds after the user's request, so that the user can undo it. The object is hidden
 * meanwhile.
 */
export class Removal {
  private pending: { name: string; timer: ReturnType<typeof setTimeout> } | undefined;

  constructor(
    private readonly viewer: Viewer,
    private readonly remove: (name: string) => Promise<boolean>,
  ) {
    element("undo-button").addEventListener("click", () => this.undo());
  }

  begin(name: string | undefined): void {
    if (name === undefined) return;
    if (this.pending) void this.finish();
    element("undo-text").textContent = `${name} will be removed.`;
    element("undo").hidden = false;
    this.pending = { name, timer: setTimeout(() => void this.finish(), graceTime) };
    this.viewer.chosen.hideSelection();
  }

  private undo(): void {
    const found = this.end();
    if (found === undefined) return;
    this.viewer.chosen.unhide(found);
    this.viewer.chosen.select(found);
  }

  private async finish(): Promise<void> {
    const { name } = this.pending ?? {};
    const found = this.end();
    if (name !== undefined && !(await this.remove(name)) && found !== undefined) this.viewer.chosen.unhide(found);
  }

  // Ends the wait. Returns the entity that was to be removed, if it still exists.
  private end(): number | undefined {
    if (!this.pending) return undefined;
    clearTimeout(this.pending.timer);
    const found = this.viewer.find(this.pending.name);
    this.pending = undefined;
    element("undo").hidden = true;
    return found;
  }
}
