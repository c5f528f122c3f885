// SPDX-License-Identifier: Apache-2.0
import type { Commands } from "../commands";

const mouse: readonly (readonly [string, string])[] = [
  ["drag", "turns the camera; the right button pans, the wheel zooms"],
  ["click", "selects; a double click follows"],
  ["Shift + drag", "moves an object of a server that may be controlled"],
];
const names: Record<string, string> = { " ": "space" };

/** Returns the rows of the table of keys: the actions of the mouse, then all keys with their commands. */
export function keyRows(commands: Commands): HTMLElement[] {
  const keys = Object.entries(commands.keys()).map(
    ([key, line]) => [names[key] ?? key, commands.helpOf(line)] as const,
  );
  return [...mouse, ...keys].map(([key, text]) => {
    const row = document.createElement("tr");
    const [first, second] = [document.createElement("td"), document.createElement("td")];
    const mark = document.createElement("kbd");
    mark.textContent = key;
    first.append(mark);
    second.textContent = text;
    row.append(first, second);
    return row;
  });
}
