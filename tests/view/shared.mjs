// What scenarios have in common.

export const patience = 60_000; // [ms]; a browser that draws in software is slow

/** Runs `look` in the page until it gives something that is true, and gives that back. */
export async function until(page, look, argument) {
  const handle = await page.waitForFunction(look, argument, { timeout: patience, polling: 50 });
  return handle.jsonValue();
}
export const run = (page, line) => page.evaluate((text) => window.cohort.run(text), line);
export const tick = (page) => page.evaluate(() => Number(window.cohort.viewer.poses.frame.tick));

/** Where in the picture a place of the world is. */
export const seenAt = (page, place) => page.evaluate(([x, y, z]) => {
  const { viewer } = window.cohort;
  viewer.draw(performance.now() + 1000); // past the blend of the last two frames
  const at = viewer.cameras.target.clone().set(x, y, z).project(viewer.stage.camera);
  const { width, height } = document.getElementById("canvas").getBoundingClientRect();
  return { x: 0.5 * (at.x + 1) * width, y: 0.5 * (1 - at.y) * height };
}, place);
