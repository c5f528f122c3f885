// SPDX-License-Identifier: Apache-2.0

// Functions that scripts that drive the page share.
import assert from "node:assert/strict";
import { chromium } from "playwright-core";

export const patience = Number(process.env.COHORT_PATIENCE ?? 60_000); // [ms]; a browser that draws in software is slow

/** Runs `look` in the page until it gives something that is true, and gives that back. */
export async function until(page, look, argument) {
  const handle = await page.waitForFunction(look, argument, { timeout: patience, polling: 50 });
  return handle.jsonValue();
}
export const run = (page, line) => page.evaluate((text) => window.cohort.run(text), line);
export async function tick(page) {
  const tickOf = () => window.cohort.viewer.poses?.frame && String(window.cohort.viewer.poses.frame.tick);
  return Number(await until(page, tickOf));
}
export const atTick = (page, wanted) =>
  until(page, (each) => Number(window.cohort.viewer.poses?.frame?.tick) === each, wanted);

/**
 * Presses a button that is visible and enabled. A click of the mouse would wait for still frames, which a busy machine
 * may not draw for minutes.
 */
export async function press(button) {
  await button.waitFor();
  const enabled = button.and(button.page().locator(":not(:disabled)"));
  await enabled.focus();
  await enabled.dispatchEvent("click");
}

/** Switches shadows by hand: then the page itself leaves them alone. */
export const setShadows = (page, on) =>
  page.evaluate(
    (wanted) =>
      window.cohort.run(
        window.cohort.viewer.layers.has("shadows") === wanted ? "toggle shadows; toggle shadows" : "toggle shadows",
      ),
    on,
  );
/** A picture with so few pixels that software draws it fast. */
export const drawFewPixels = (page) => page.evaluate(() => window.cohort.viewer.stage.renderer.setPixelRatio(0.25));
/** A picture that is coarse enough for software to draw it often: people steer by what they see. */
export async function drawCoarsely(page) {
  await drawFewPixels(page);
  await setShadows(page, false);
}
/** The next pictures are drawn, so many of them. */
export const drawn = (page, count) =>
  page.evaluate(
    (wanted) =>
      new Promise((resolve) => {
        let left = wanted;
        const next = () => (left-- > 0 ? requestAnimationFrame(next) : resolve());
        next();
      }),
    count,
  );
/** The server says that the run is paused, and the page shows where: the tick. Ticks are of 10 ms. */
export const pausedTick = (page) =>
  until(page, () => {
    const shown = Number(window.cohort.viewer.poses?.frame?.tick);
    const said = Math.round(100 * Number(document.getElementById("scrub").value));
    return document.getElementById("factor").textContent === "paused" && shown === said && shown;
  });

/** Where in the page a place of the world is seen. */
export const seenAt = (page, place) =>
  page.evaluate(([x, y, z]) => {
    const { viewer } = window.cohort;
    viewer.draw(performance.now() + 1000); // past the blend of the last two frames
    const at = viewer.cameras.target.clone().set(x, y, z).project(viewer.stage.camera);
    const { left, top, width, height } = document.getElementById("canvas").getBoundingClientRect();
    return { x: left + 0.5 * (at.x + 1) * width, y: top + 0.5 * (1 - at.y) * height };
  }, place);

/** Pixels of the picture at places of the world: red, green, blue of each. */
export const pixelsAt = (page, places) =>
  page.evaluate((points) => {
    const { viewer } = window.cohort;
    const { camera, renderer } = viewer.stage;
    viewer.draw(performance.now());
    const gl = renderer.getContext();
    return points.map(([x, y, z]) => {
      const at = viewer.cameras.target.clone().set(x, y, z).project(camera);
      const pixel = new Uint8Array(4);
      const column = Math.round(0.5 * (at.x + 1) * gl.drawingBufferWidth);
      const row = Math.round(0.5 * (at.y + 1) * gl.drawingBufferHeight);
      gl.readPixels(column, row, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      return [...pixel.slice(0, 3)];
    });
  }, places);

/**
 * Returns how far robots reach from the middle of the picture: at most 1 if all their corners are in it. By the
 * vertices that are drawn.
 */
export const reachInPicture = (page) =>
  page.evaluate(() => {
    const { viewer } = window.cohort;
    viewer.draw(performance.now() + 1000); // past the blend of the last two frames
    const { poses, instances, stage } = viewer;
    const vector = () => viewer.cameras.target.clone();
    const [place, at, turn] = [vector(), vector(), stage.camera.quaternion.clone()];
    stage.camera.updateMatrixWorld();
    const robots = new Set(viewer.robotEntities());
    let most = 0;
    for (const { model, link, geometry } of instances.links) {
      const corners = geometry.getAttribute("position");
      const step = Math.max(1, Math.floor(corners.count / 200));
      for (const entity of poses.entitiesOf(model)) {
        if (!robots.has(entity) || poses.absent.has(entity)) continue;
        poses.read(poses.placeOf(entity, link), place, turn, 1);
        for (let i = 0; i < corners.count; i += step) {
          at.fromBufferAttribute(corners, i).applyQuaternion(turn).add(place).project(stage.camera);
          most = Math.max(most, at.z > 1 ? Infinity : 0, Math.abs(at.x), Math.abs(at.y));
        }
      }
    }
    return most;
  });

/** Looks from a place to another one. */
export const look = (page, position, target) =>
  page.evaluate(
    ([from, to]) => {
      window.cohort.viewer.cameras.look({ position: from, target: to });
      window.cohort.viewer.draw(performance.now() + 1000); // past the blend of the last two frames
    },
    [position, target],
  );

/** How large an image, or the first picture of a film, is that is given as bytes, and how many colours it has. */
export const coloursIn = (page, bytes, type) =>
  page.evaluate(
    async ([base64, kind]) => {
      const content = new Blob([Uint8Array.from(atob(base64), (each) => each.charCodeAt(0))], { type: kind });
      const isFilm = kind.startsWith("video/");
      const picture = isFilm ? document.createElement("video") : new Image();
      const loaded = new Promise((resolve, reject) => {
        if (isFilm) picture.requestVideoFrameCallback(resolve);
        else picture.addEventListener("load", resolve);
        picture.addEventListener("error", () =>
          reject(new Error(`a picture that cannot be decoded: ${picture.error?.message ?? ""}`)),
        );
      });
      picture.src = URL.createObjectURL(content);
      if (isFilm) picture.muted = true;
      if (isFilm) await picture.play();
      await loaded;
      const [width, height] = isFilm ? [picture.videoWidth, picture.videoHeight] : [picture.width, picture.height];
      const context = new OffscreenCanvas(width, height).getContext("2d");
      context.drawImage(picture, 0, 0);
      const { data } = context.getImageData(0, 0, width, height);
      const found = new Set();
      for (let i = 0; i < data.length; i += 4 * 37) found.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
      return { width, height, colours: found.size };
    },
    [bytes.toString("base64"), type],
  );

/** Checks that the page, at its present frame, has robots where a test expects them, and the tick and the hash. */
export async function expectRobots(page, expected) {
  const { poses, shown } = await page.evaluate(
    (names) => {
      const { viewer } = window.cohort;
      viewer.draw(performance.now() + 1000); // past the blend of the last two frames
      return {
        poses: names.map((name) => viewer.poseOf(viewer.find(name))),
        shown: ["tick", "hash", "robots"].map((id) => document.getElementById(id).textContent),
      };
    },
    expected.robots.map(({ name }) => name),
  );
  expected.robots.forEach(({ name, x, y, heading }, i) => {
    const { position, heading: found } = poses[i];
    assert.ok(Math.hypot(position[0] - x, position[1] - y) < 1e-4, `${name} is at ${position}, not at ${x} ${y}`);
    assert.ok(Math.cos(found - heading) > 0.99999, `${name} heads ${found}, not ${heading}`);
  });
  assert.deepEqual(shown, [String(expected.tick), expected.hash, String(expected.robots.length)]);
}

/**
 * Opens the page for the scenario that the command line names: SCENARIO ADDRESS [FILE]. `prepare` is called before.
 * `context` goes to Playwright's `newPage`.
 */
export async function runScenario(scenarios, { prepare = async () => undefined, context = {} } = {}) {
  const [, , scenario, address, file] = process.argv;
  const browser = await chromium.launch({
    executablePath: process.env.COHORT_CHROMIUM,
    args: [
      "--no-sandbox",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
    ],
  });
  try {
    const page = await browser.newPage({ viewport: { width: 960, height: 640 }, ...context });
    page.setDefaultTimeout(patience);
    const errors = [];
    page.on("pageerror", (error) => errors.push(error.message));
    await prepare(page);
    await page.goto(address);
    await until(page, () => window.cohort?.viewer.poses?.frame);
    try {
      await scenarios[scenario](page, file);
    } catch (error) {
      const text = await page.evaluate(() => document.body.innerText).catch(() => "nothing: it is gone");
      error.stack += `\nThe page then says: ${text}`;
      throw error;
    }
    assert.deepEqual(errors, []);
  } finally {
    await browser.close();
  }
}
