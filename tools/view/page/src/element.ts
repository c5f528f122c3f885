// SPDX-License-Identifier: Apache-2.0

/** Returns an element of index.html. Throws Error if there is none with this id. */
export function element(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no element '${id}'`);
  return found;
}
