// SPDX-License-Identifier: Apache-2.0

// Tries what the page shows of tests/view/exhibits: node exhibits.mjs SCENARIO ADDRESS [FILE]. Ends with 0 if all is right.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { atTick, coloursIn, drawn, look, patience, pixelsAt, run, runScenario, setShadows, until } from "./in_page.mjs";
import { drawsTextures } from "./textures.mjs";

const near = (found, wanted, by, what) =>
  assert.ok(Math.abs(found - wanted) <= by, `${what} is ${found}, not ${wanted}`);
const camera = (page) =>
  page.evaluate(() => {
    const { cameras, stage } = window.cohort.viewer;
    return { position: stage.camera.position.toArray(), target: cameras.target.toArray() };
  });
const minus = (a, b) => a.map((each, i) => each - b[i]);
const dot = (a, b) => a.reduce((sum, each, i) => sum + each * b[i], 0);
const unit = (a) => a.map((each) => each / Math.hypot(...a));
// Points of lines or dots that are drawn: x y z of each.
const pointsOf = (page, path) =>
  page.evaluate((names) => {
    const { geometry } = names.reduce((from, name) => from[name], window.cohort.viewer);
    const values = geometry.getAttribute("position").array.slice(0, 3 * geometry.drawRange.count);
    return Array.from({ length: values.length / 3 }, (_, i) => [...values.slice(3 * i, 3 * i + 3)]);
  }, path);

async function films(page) {
  await run(page, "pause; seek 1; film");
  await run(page, "play; theme dark");
  await drawn(page, 30);
  await run(page, "theme light; top");
  await drawn(page, 20);
  const canvasWidth = await page.evaluate(() => document.getElementById("canvas").width);
  const [film] = await Promise.all([page.waitForEvent("download", { timeout: patience }), run(page, "film")]);
  const bytes = readFileSync(await film.path());
  assert.equal(film.suggestedFilename(), "cohort.webm");
  assert.equal(bytes.subarray(0, 4).toString("hex"), "1a45dfa3", "EBML, which WebM is");
  const { width, colours } = await coloursIn(page, bytes, "video/webm");
  assert.equal(width, canvasWidth);
  assert.ok(colours > 50, `the film has ${colours} colours`);
}

// Returns the command and the measured sound of each loudspeaker that sounds, by the x of its place.
const heard = (page) =>
  page.evaluate(async () => {
    const { sound } = window.cohort.viewer;
    const found = {};
    for (const { oscillator, panner } of sound.voices.values()) {
      const analyser = new AnalyserNode(sound.context, { fftSize: 32768, smoothingTimeConstant: 0 });
      panner.connect(analyser);
      const end = sound.context.currentTime + (2 * analyser.fftSize) / sound.context.sampleRate;
      while (sound.context.currentTime < end) await new Promise((resolve) => setTimeout(resolve, 50));
      const spectrum = new Float32Array(analyser.frequencyBinCount);
      analyser.getFloatFrequencyData(spectrum);
      const strongest = spectrum.indexOf(Math.max(...spectrum));
      panner.disconnect(analyser);
      found[panner.positionX.value.toFixed(1)] = {
        told: oscillator.frequency.value,
        frequency: (strongest * sound.context.sampleRate) / analyser.fftSize,
        loudness: spectrum[strongest], // [dB]
      };
    }
    return found;
  });

async function sounds(page) {
  await run(page, "pause; seek 1");
  await atTick(page, 100);
  assert.equal(
    await page.evaluate(() => window.cohort.viewer.sound.context),
    undefined,
    "nothing sounds before it is asked for",
  );
  await look(page, [2, -1, 0.5], [2, 0, 0.3]);
  await page.getByRole("button", { name: "sound" }).click(); // a browser allows sound after a real click only
  await until(page, () => window.cohort.viewer.sound.sounding === 2);
  const beside = await heard(page);
  assert.deepEqual(Object.keys(beside).sort(), ["-2.0", "2.0"]);
  for (const [place, wanted] of [
    ["2.0", 880],
    ["-2.0", 330],
  ]) {
    near(beside[place].told, wanted, 0.5, `the frequency at x ${place}`);
    near(beside[place].frequency, wanted, 3, `what is heard from x ${place}`);
  }
  // Behind the other one.
  await look(page, [-2, -1, 0.5], [-2, 0, 0.3]);
  const across = await heard(page);
  assert.ok(
    across["2.0"].loudness < beside["2.0"].loudness - 6,
    `${across["2.0"].loudness} and ${beside["2.0"].loudness} dB`,
  );
  assert.ok(
    across["-2.0"].loudness > beside["-2.0"].loudness + 6,
    `${across["-2.0"].loudness} and ${beside["-2.0"].loudness} dB`,
  );
  await run(page, "toggle sound");
  assert.equal(await page.evaluate(() => window.cohort.viewer.sound.sounding), 0);
}

// Holds a key until the camera has moved; the unit vector of where it went.
async function fly(page, key) {
  const from = await camera(page);
  await page.keyboard.down(key);
  await until(
    page,
    ([x, y, z]) => {
      const at = window.cohort.viewer.stage.camera.position;
      return Math.hypot(at.x - x, at.y - y, at.z - z) > 0.1;
    },
    from.position,
  );
  await page.keyboard.up(key);
  const to = await camera(page);
  for (const each of minus(minus(to.target, from.target), minus(to.position, from.position)))
    near(each, 0, 1e-3, "what the target went beside the camera");
  return unit(minus(to.position, from.position));
}

async function movesCamera(page) {
  await run(page, "pause; seek 1");
  await atTick(page, 100);
  await page.locator("#canvas").focus();

  await look(page, [0, -3, 2], [0, 0, 0]);
  await page.keyboard.press("g");
  const { position, target } = await camera(page);
  const ahead = unit(minus(target, position));
  for (const [key, direction] of [
    ["w", ahead],
    ["s", ahead.map((each) => -each)],
    ["d", [1, 0, 0]],
    ["a", [-1, 0, 0]],
    ["q", [0, 0, 1]],
    ["z", [0, 0, -1]],
  ]) {
    const went = await fly(page, key);
    assert.ok(dot(went, direction) > 0.99, `with ${key} it went along ${went}`);
  }
  const before = await camera(page);
  await drawn(page, 10);
  near(
    Math.hypot(...minus((await camera(page)).position, before.position)),
    0,
    1e-3,
    "its way after the keys were released",
  );

  await run(page, "eye lookout");
  await until(page, () => {
    const { x, y, z } = window.cohort.viewer.stage.camera.position;
    return Math.hypot(x - 0.06, y, z - 0.05) < 0.01;
  });
  const eye = await page.evaluate(() => {
    const { camera: seen } = window.cohort.viewer.stage;
    return { position: seen.position.toArray(), ahead: seen.getWorldDirection(seen.position.clone()).toArray() };
  });
  assert.ok(eye.ahead[0] > 0.99, `it looks along ${eye.ahead}`);

  await run(page, "orbit");
  await page.locator("#canvas").focus();
  await page.keyboard.press("F");
  await until(page, () => document.fullscreenElement === document.documentElement);
  await page.keyboard.press("F");
  await until(page, () => document.fullscreenElement === null);
}

async function keepsLooks(page) {
  await run(page, "pause");
  await look(page, [1, -2, 0.9], [0.5, 0.2, 0.8]);
  const kept = await camera(page);
  const [light] = await pixelsAt(page, [[0, 300, 60]]);
  await run(page, "viewpoint save door; theme dark; home");
  await page.reload();
  await until(page, () => window.cohort?.viewer.poses?.frame);
  assert.ok(Math.hypot(...minus((await camera(page)).position, kept.position)) > 0.1);
  await run(page, "pause; viewpoint door");
  const again = await camera(page);
  assert.ok(Math.hypot(...minus(again.position, kept.position)) < 1e-3, `it looks from ${again.position}`);
  assert.ok(Math.hypot(...minus(again.target, kept.target)) < 1e-3, `it looks at ${again.target}`);
  await assert.rejects(run(page, "viewpoint window"), /no viewpoint 'window'/);
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
  const [dark] = await pixelsAt(page, [[0, 300, 60]]);
  assert.ok(Math.max(...dark) < 80 && Math.min(...light) > 180, `the sky was ${light} and is ${dark}`);
}

async function drawsOverlays(page) {
  await run(page, "pause; seek 0.5; toggle trails; toggle labels; toggle contacts");
  await atTick(page, 50);
  // The names that are shown, each where its robot is.
  const names = async () => {
    const found = await page.evaluate(() => {
      const { viewer } = window.cohort;
      viewer.draw(performance.now() + 1000);
      const { left, top, width, height } = document.getElementById("canvas").getBoundingClientRect();
      const shown = [...document.querySelectorAll("#labels span:not([hidden])")].map((each) => {
        const box = each.getBoundingClientRect();
        return [each.textContent, 0.5 * (box.left + box.right), box.bottom];
      });
      return shown.map(([name, x, y]) => {
        const [a, b, c] = viewer.poseOf(viewer.find(name)).position;
        const at = viewer.cameras.target
          .clone()
          .set(a, b, c + 0.12)
          .project(viewer.stage.camera);
        return { name, beside: Math.hypot(left + 0.5 * (at.x + 1) * width - x, top + 0.5 * (1 - at.y) * height - y) };
      });
    });
    for (const { name, beside } of found) assert.ok(beside < 3, `the name of ${name} is ${beside} pixels beside it`);
    return found.map(({ name }) => name).sort();
  };
  await run(page, "home");
  const all = await names(); // those of the held and its holder would overlap
  assert.ok(all.length === 3 && all[0].startsWith("h"), `the names are ${all}`);
  assert.deepEqual(all.slice(1), ["lookout", "runner"]);
  await look(page, [-1.94, 1.2, 0.5], [-1.94, 2, 0.1]);
  assert.deepEqual(await names(), ["held", "holder"]);
  await run(page, "home");

  // A picture that began before its frame came.
  assert.equal(
    await page.evaluate(() => {
      const { poses } = window.cohort.viewer;
      poses.advance(performance.now() - 1e6);
      return poses.blend;
    }),
    0,
  );

  // The runner goes along y = -2.
  await run(page, "play");
  await until(page, () => Number(window.cohort.viewer.poses.frame?.tick) > 250);
  await run(page, "pause");
  const runner = await page.evaluate(() => window.cohort.viewer.find("runner"));
  const trail = await pointsOf(page, [
    "trails",
    "group",
    "children",
    String(await page.evaluate((entity) => [...window.cohort.viewer.trails.trails.keys()].indexOf(entity), runner)),
  ]);
  assert.ok(trail.length > 5, `its trail has ${trail.length} points`);
  trail.forEach(([x, y], i) => {
    near(y, -2, 0.01, "y of its trail");
    assert.ok(i === 0 || x > trail[i - 1][0], `its trail goes back to ${x}`);
  });
  assert.ok(trail.at(-1)[0] - trail[0][0] > 0.2, `its trail goes from ${trail[0]} to ${trail.at(-1)}`);
  await run(page, "seek 0.5");
  await atTick(page, 50);
  assert.ok(
    (await page.evaluate(() => window.cohort.viewer.trails.group.children.length)) === 0 ||
      (await pointsOf(page, ["trails", "group", "children", "0"])).length < 2,
    "before it ran there is no trail",
  );

  await run(page, "seek 2");
  await atTick(page, 200);
  const corners = [
    [-0.1, 0.9],
    [0.1, 0.9],
    [0.1, 1.1],
    [-0.1, 1.1],
  ];
  await until(page, () => window.cohort.viewer.contacts.points.geometry.drawRange.count >= 4);
  const contacts = await pointsOf(page, ["contacts", "points"]);
  for (const [x, y] of corners)
    assert.ok(
      contacts.some((each) => Math.hypot(each[0] - x, each[1] - y, each[2]) < 0.005),
      `no contact at ${x} ${y}: ${JSON.stringify(contacts)}`,
    );
  await look(page, [0.2, 0.3, 0.5], [0, 0.9, 0]);
  const seen = await pixelsAt(page, [
    [-0.1, 0.9, 0],
    [-0.102, 0.9, 0],
    [-0.1, 0.898, 0],
    [-0.102, 0.898, 0],
  ]);
  assert.ok(
    seen.some(([red, green, blue]) => red > 150 && red > 1.5 * green && red > 1.5 * blue),
    `at the corner of the crate are ${seen}`,
  );
  const forces = await pointsOf(page, ["contacts", "forces"]);
  const weight =
    forces.reduce(
      (sum, [, , z], i) =>
        sum +
        (i % 2 === 1 && Math.abs(forces[i][1] - 1) < 0.15 && Math.abs(forces[i][0]) < 0.15
          ? Math.abs(z - forces[i - 1][2])
          : 0),
      0,
    ) / 0.02;
  near(weight, 500 * 0.2 ** 3 * 9.81, 1, "the weight of the crate, by the lines of its forces,");

  const grips = await pointsOf(page, ["contacts", "grips"]);
  assert.equal(grips.length, 1);
  near(grips[0][0], -1.942, 0.012, "x of the jaw");
  near(grips[0][1], 2, 0.01, "y of the jaw");
  await look(page, [-1.8, 1.6, 0.35], [-1.94, 2, 0.05]);
  const [grip] = await pixelsAt(page, [grips[0]]);
  assert.ok(grip[1] > 120 && grip[1] > 1.5 * grip[0], `where it holds on, the picture is ${grip}`);

  await run(page, "select lookout; toggle labels");
  await until(page, () => document.querySelectorAll("#dial line").length >= 15);
  await page.evaluate(() => window.cohort.viewer.draw(performance.now() + 1000));
  const hits = await pointsOf(page, ["rays", "hit"]);
  const ends = hits.filter((_, i) => i % 2 === 1);
  const atWall = ends.filter(([x, , z]) => x > 0.1 && z > 0.05);
  assert.equal(atWall.length, 2, `rays to the wall: ${JSON.stringify(ends)}`); // 12 degrees to each side
  for (const [x] of atWall) near(x, 0.225, 0.01, "the end of a ray to the wall");
  const onGround = ends.filter(([, , z]) => z < 0.03);
  assert.equal(onGround.length, 4);
  for (const [, , z] of onGround) near(z, 0, 0.002, "the end of a ray to the ground");
  assert.equal((await pointsOf(page, ["rays", "free"])).length, 2 * 13);
}

const brightness = ([red, green, blue]) => red + green + blue;

async function drawsShapes(page) {
  await run(page, "pause; seek 1");
  await atTick(page, 100);
  await setShadows(page, true);
  // The sun is at -x -y: the pole's shadow goes to the other side.
  await look(page, [-0.5, -2.2, 1.6], [-0.8, -0.9, 0]);
  const shadow = [-0.8, -0.845, 0];
  const lit = [-1.2, -1.155, 0];
  await drawn(page, 2);
  const [dark, bright] = await pixelsAt(page, [shadow, lit]);
  assert.ok(brightness(dark) < 0.85 * brightness(bright), `the shadow is ${dark}, beside it is ${bright}`);
  await setShadows(page, false);
  const [without] = await pixelsAt(page, [shadow]);
  assert.ok(brightness(without) > 0.95 * brightness(bright), `without shadows it is ${without}`);

  await look(page, [1, -0.2, 0.4], [1, 1, 0.1]);
  const [red, blue, ...green] = await pixelsAt(page, [
    [0.9, 1, 0.1],
    [1.1, 1, 0.1],
    [0.9, 1, 0.35],
    [1.1, 1, 0.35],
  ]);
  assert.ok(red[0] > 2 * red[1] && red[0] > 2 * red[2], `the red square is ${red}`);
  assert.ok(blue[2] > 2 * blue[0] && blue[2] > 2 * blue[1], `the blue square is ${blue}`);
  for (const each of green) assert.ok(each[1] > 2 * each[0] && each[1] > 2 * each[2], `a green square is ${each}`);
}

// The surface that is drawn is where rays of the simulation meet the ground.
async function drawsHills(page, file) {
  await run(page, "pause");
  const expected = JSON.parse(readFileSync(file, "utf8"));
  const heights = await page.evaluate((places) => {
    const { scene } = window.cohort.viewer.poses;
    const model = scene.models.findIndex(({ name }) => name === "terrain");
    const { geometry } = window.cohort.viewer.instances.links.find((each) => each.model === model);
    const corners = geometry.getAttribute("position").array;
    const found = places.map(() => undefined);
    for (let i = 0; i < corners.length; i += 9) {
      const [ax, ay, az, bx, by, bz, cx, cy, cz] = corners.subarray(i, i + 9);
      const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
      places.forEach(([x, y], place) => {
        const u = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area;
        const v = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area;
        if (u >= 0 && v >= 0 && u + v <= 1) found[place] = az + u * (bz - az) + v * (cz - az);
      });
    }
    return found;
  }, expected);
  for (const [i, [x, y, z]] of expected.entries()) near(heights[i], z, 1e-3, `the height at ${x} ${y}`);
  const highest = expected.reduce((best, each) => (each[2] > best[2] ? each : best));
  await look(page, [highest[0], highest[1] - 1.5, 0.6], highest);
  const [hill, sky] = await pixelsAt(page, [
    [highest[0], highest[1], highest[2] - 0.01],
    [highest[0], 300, 60],
  ]);
  assert.ok(Math.abs(brightness(hill) - brightness(sky)) > 60, `the hill is ${hill}, the sky ${sky}`);
}

await runScenario({
  films,
  sounds,
  moves_camera: movesCamera,
  keeps_looks: keepsLooks,
  draws_overlays: drawsOverlays,
  draws_shapes: drawsShapes,
  draws_hills: drawsHills,
  draws_textures: drawsTextures,
});
