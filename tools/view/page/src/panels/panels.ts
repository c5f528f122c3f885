// SPDX-License-Identifier: Apache-2.0
import { element } from "../element";

export type Panel = "left" | "right" | "dock";
export type DockTab = "plotting" | "events" | "console";
type Tab = DockTab | "left" | "right"; // on a phone, a single sheet shows one of them

const storage = "cohort.view.panels";
const panels: readonly Panel[] = ["left", "right", "dock"];
const dockTabs: readonly DockTab[] = ["plotting", "events", "console"];
const keyStep = 16; // [px]

interface Kept {
  sizes: Record<Panel, number>; // [px]
  closed: Panel[];
  tab: DockTab;
}
const defaults: Kept = { sizes: { left: 230, right: 290, dock: 210 }, closed: ["dock"], tab: "plotting" };
const smallest: Record<Panel, number> = { left: 150, right: 210, dock: 90 };

/** The panels around the picture: which of them are open, and their sizes. Both are stored in the browser. */
export class Panels {
  private kept: Kept = defaults;
  private sheet: Tab | undefined; // on a phone
  private readonly phone = matchMedia("(max-width: 699px)");

  constructor() {
    const closed: Panel[] = matchMedia("(max-width: 1000px)").matches ? ["left", "dock"] : ["dock"];
    this.kept = read() ?? { ...defaults, closed };
    for (const button of document.querySelectorAll<HTMLElement>("[data-panel]"))
      button.addEventListener("click", () => this.toggle(button.dataset.panel as Panel));
    for (const button of document.querySelectorAll<HTMLElement>("#tabs [data-tab]"))
      button.addEventListener("click", () => {
        const tab = button.dataset.tab as Tab;
        if (this.isShown(tab)) this.close(tab);
        else this.show(tab);
      });
    for (const splitter of document.querySelectorAll<HTMLElement>(".splitter")) this.makeDraggable(splitter);
    this.phone.addEventListener("change", () => this.apply());
    this.apply();
  }

  isShown(tab: Tab): boolean {
    if (this.phone.matches) return this.sheet === tab;
    if (tab === "left" || tab === "right") return this.isOpen(tab);
    return this.isOpen("dock") && this.kept.tab === tab;
  }

  show(tab: Tab): void {
    if (this.phone.matches) this.sheet = tab;
    else {
      const panel = tab === "left" || tab === "right" ? tab : "dock";
      this.kept = {
        ...this.kept,
        closed: this.kept.closed.filter((each) => each !== panel),
        tab: panel === "dock" ? (tab as DockTab) : this.kept.tab,
      };
    }
    this.keep();
  }

  close(tab: Tab): void {
    if (this.phone.matches) this.sheet = undefined;
    else {
      const panel: Panel = tab === "left" || tab === "right" ? tab : "dock";
      this.kept = { ...this.kept, closed: [...new Set<Panel>([...this.kept.closed, panel])] };
    }
    this.keep();
  }

  toggle(panel: Panel): void {
    const tab = panel === "dock" ? this.kept.tab : panel;
    if (this.isShown(tab)) this.close(tab);
    else this.show(tab);
  }

  private isOpen(panel: Panel): boolean {
    return !this.kept.closed.includes(panel);
  }

  private keep(): void {
    try {
      localStorage.setItem(storage, JSON.stringify(this.kept));
    } catch {
      // Storage is not available: the layout is lost when the page is closed.
    }
    this.apply();
  }

  private apply(): void {
    const isPhone = this.phone.matches;
    const inDock = dockTabs.find((tab) => this.isShown(tab));
    element("left").hidden = !this.isShown("left");
    element("right").hidden = !this.isShown("right");
    element("dock").hidden = inDock === undefined;
    for (const tab of dockTabs) element(tab).hidden = tab !== inDock;
    for (const panel of panels) {
      element("page").style.setProperty(`--${panel}`, `${this.kept.sizes[panel]}px`);
      element(`${panel}-edge`).hidden = isPhone || !this.isOpen(panel);
    }
    for (const button of document.querySelectorAll<HTMLElement>("#tabs [data-tab]"))
      button.setAttribute("aria-pressed", String(this.isShown(button.dataset.tab as Tab)));
    for (const button of document.querySelectorAll<HTMLElement>("[data-panel]"))
      button.setAttribute("aria-pressed", String(this.isOpen(button.dataset.panel as Panel)));
  }

  // Makes a splitter movable by the mouse, a finger, or the arrow keys.
  private makeDraggable(splitter: HTMLElement): void {
    const panel = splitter.dataset.resizes as Panel;
    const isWide = panel === "dock";
    const sign = panel === "left" ? 1 : -1;
    const whole = (): number => (isWide ? innerHeight : innerWidth);
    const resize = (size: number): void => {
      const largest = Math.max(smallest[panel], 0.6 * whole());
      const chosen = Math.round(Math.min(largest, Math.max(smallest[panel], size)));
      this.kept = { ...this.kept, sizes: { ...this.kept.sizes, [panel]: chosen } };
      splitter.setAttribute("aria-valuenow", String(chosen));
      this.keep();
    };
    splitter.tabIndex = 0;
    splitter.setAttribute("role", "separator");
    splitter.setAttribute("aria-orientation", isWide ? "horizontal" : "vertical");
    splitter.setAttribute(
      "aria-label",
      `Size of the panel ${isWide ? "below" : panel === "left" ? "on the left" : "on the right"}`,
    );
    splitter.setAttribute("aria-valuemin", String(smallest[panel]));
    splitter.setAttribute("aria-valuenow", String(this.kept.sizes[panel]));
    splitter.addEventListener("pointerdown", (event) => {
      const from = isWide ? event.clientY : event.clientX;
      const size = this.kept.sizes[panel];
      const move = ({ clientX, clientY }: PointerEvent): void =>
        resize(size + sign * ((isWide ? clientY : clientX) - from));
      splitter.setPointerCapture(event.pointerId);
      splitter.classList.add("dragged");
      splitter.addEventListener("pointermove", move);
      const end = (): void => {
        splitter.classList.remove("dragged");
        splitter.removeEventListener("pointermove", move);
      };
      splitter.addEventListener("lostpointercapture", end, { once: true });
      event.preventDefault();
    });
    splitter.addEventListener("keydown", (event) => {
      const steps: Record<string, number> = isWide
        ? { ArrowUp: 1, ArrowDown: -1 }
        : { ArrowRight: sign, ArrowLeft: -sign };
      const step = steps[event.key];
      if (step === undefined) return;
      resize(this.kept.sizes[panel] + keyStep * step);
      event.preventDefault();
      event.stopPropagation();
    });
  }
}

function read(): Kept | undefined {
  try {
    const found = JSON.parse(localStorage.getItem(storage) ?? "null") as Partial<Kept> | null;
    if (!found || !dockTabs.includes(found.tab as DockTab) || !Array.isArray(found.closed)) return undefined;
    if (!panels.every((panel) => Number.isFinite(found.sizes?.[panel]))) return undefined;
    return found as Kept;
  } catch {
    return undefined;
  }
}
