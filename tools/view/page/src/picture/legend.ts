// SPDX-License-Identifier: Apache-2.0
import type { Color } from "three";
import { none, type Scene } from "../data/messages";
import { overlayColors } from "./overlays";
import { drawnColor, teamColors } from "./teams";

export type LegendKind =
  | "team"
  | "robot"
  | "movable"
  | "wall"
  | "led"
  | "lamp"
  | "ray free"
  | "ray hit"
  | "contact"
  | "grip";

/** A colour of the picture and its meaning. */
export interface LegendEntry {
  label: string;
  color: string; // for CSS
  kind: LegendKind;
}

/** The overlays that are shown. */
export interface ShownOverlays {
  rays: boolean;
  contacts: boolean;
}

const hexText = (hex: number): string => `#${hex.toString(16).padStart(6, "0")}`;
const lines = new Set<LegendKind>(["ray free", "ray hit"]);
const lights = new Set<LegendKind>(["led", "lamp"]);

/** Returns the entries for a scene: teams or robots, bodies, lights, and overlays that are shown. */
export function legendOf(scene: Scene, { rays, contacts }: ShownOverlays): LegendEntry[] {
  const entries: LegendEntry[] = [];
  const add = (label: string, color: Color | string | undefined, kind: LegendKind): void => {
    if (color !== undefined)
      entries.push({ label, color: typeof color === "string" ? color : `#${color.getHexString()}`, kind });
  };
  const ofModel = (isWanted: (entity: Scene["entities"][number]) => boolean): Color | undefined => {
    for (const entity of scene.entities) {
      const color = isWanted(entity) ? drawnColor(scene, scene.models[entity.model]) : undefined;
      if (color) return color;
    }
    return undefined;
  };
  const teams = teamColors(scene);
  for (const [name, color] of teams) add(`team ${name}`, color, "team");
  if (teams.size === 0)
    add(
      "robots",
      ofModel(({ robot }) => robot !== none),
      "robot",
    );
  add(
    "movable objects",
    ofModel(({ robot, model }) => robot === none && !scene.models[model].is_static),
    "movable",
  );
  add(
    "walls and other fixed objects",
    ofModel(({ model }) => isWall(scene, model)),
    "wall",
  );
  if (scene.leds.length > 0) add("LEDs that are on", "#e5484d", "led");
  if (scene.lamps.length > 0) add("lamps and their range", hexText(overlayColors.lamp), "lamp");
  if (rays) {
    add("sensor ray, free", hexText(overlayColors.rayFree), "ray free");
    add("sensor ray, hit", hexText(overlayColors.rayHit), "ray hit");
  }
  if (contacts) {
    add("contacts and forces", hexText(overlayColors.contact), "contact");
    add("grips", hexText(overlayColors.grip), "grip");
  }
  return entries;
}

function isWall(scene: Scene, model: number): boolean {
  return scene.models[model].is_static && drawnColor(scene, scene.models[model]) !== undefined;
}

/** Shows entries as a list in an element. */
export function showLegend(parent: HTMLElement, entries: readonly LegendEntry[]): void {
  const text = JSON.stringify(entries);
  if (parent.dataset.entries === text) return;
  parent.dataset.entries = text;
  const list = document.createElement("ul");
  Object.assign(list.style, { listStyle: "none", margin: "0", padding: "0" });
  for (const { label, color, kind } of entries) {
    const item = document.createElement("li");
    item.dataset.kind = kind;
    Object.assign(item.style, { display: "flex", alignItems: "center", gap: "7px" });
    const sample = document.createElement("i");
    const isRound = lights.has(kind) || kind === "contact" || kind === "grip";
    Object.assign(sample.style, {
      flex: "none",
      width: "14px",
      height: lines.has(kind) ? "3px" : "14px",
      borderRadius: isRound ? "50%" : "3px",
      background: color,
      transform: isRound ? "scale(0.7)" : "",
    });
    item.append(sample, label);
    list.append(item);
  }
  parent.replaceChildren(list);
}
