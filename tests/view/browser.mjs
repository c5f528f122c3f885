// SPDX-License-Identifier: Apache-2.0

// Drives the page in a browser without a window: node browser.mjs SCENARIO ADDRESS [FILE]. Ends with 0 if all is right.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import {
  atTick,
  coloursIn,
  drawCoarsely,
  drawFewPixels,
  drawn,
  expectRobots,
  patience,
  pausedTick,
  pixelsAt,
  press,
  reachInPicture,
  run,
  runScenario,
  setShadows,
  tick,
  until,
} from "./in_page.mjs";

const isBlue = ([red, green, blue]) => blue > 100 && blue > 1.4 * red && blue > green;
const isYellow = ([red, green, blue]) => red > 120 && red > 1.2 * green && green > 1.5 * blue;
const isOrange = ([red, green, blue]) => red > 120 && red > 1.5 * green && green > blue;

async function draws(page, file) {
  const expected = JSON.parse(readFileSync(file, "utf8"));
  await run(page, `pause; seek ${expected.time}`);
  await setShadows(page, false);
  await atTick(page, expected.tick);
  assert.equal(expected.robots.length, 16);
  await expectRobots(page, expected);
  await run(page, "home; top");
  await drawn(page, 2);
  const turretHeight = 0.1; // [m]
  const pixels = await pixelsAt(
    page,
    expected.robots.map(({ x, y }) => [x, y, turretHeight]),
  );
  for (const [i, pixel] of pixels.entries())
    assert.ok(isOrange(pixel), `where ${expected.robots[i].name} is, the picture is ${pixel}`);
  const [ground] = await pixelsAt(page, [[1.9, 1.9, 0]]);
  assert.ok(!isOrange(ground), `the ground is ${ground}`);
  for (const { name } of expected.robots) {
    await run(page, `select ${name}`);
    await drawn(page, 1);
    const pose = await page.evaluate(() => document.getElementById("pose").textContent);
    assert.match(pose, /^x -?\d+\.\d{3} /);
    assert.doesNotMatch(pose, /-0\.000|-0°/);
  }
  await drawsLittleWhileStill(page);
}

async function drawsLittleWhileStill(page) {
  await until(page, () => {
    const { stillness, poses } = window.cohort.viewer;
    return !stillness.isDue(performance.now(), performance.now(), poses);
  });
  const { pictures, elapsed, isDue } = await page.evaluate(async () => {
    const { viewer } = window.cohort;
    const begin = performance.now();
    let pictures = 0;
    viewer.draw = (now) => {
      ++pictures;
      Object.getPrototypeOf(viewer).draw.call(viewer, now);
    };
    await new Promise((resolve) => setTimeout(resolve, 1500));
    delete viewer.draw;
    const elapsed = performance.now() - begin;
    window.dispatchEvent(new Event("pointermove"));
    return { pictures, elapsed, isDue: viewer.stillness.isDue(performance.now(), performance.now(), viewer.poses) };
  });
  assert.ok(pictures >= 1 && pictures <= elapsed / 250 + 1, `${pictures} pictures in ${elapsed} ms`);
  assert.ok(isDue, "after an input");
}

async function drawsMany(page, file) {
  const expected = JSON.parse(readFileSync(file, "utf8"));
  await drawFewPixels(page);
  await run(page, `pause; seek ${expected.time}`);
  await atTick(page, expected.tick);
  const { places, calls } = await page.evaluate(() => {
    const { viewer } = window.cohort;
    viewer.draw(performance.now() + 1000);
    return {
      places: viewer.robotEntities().map((entity) => viewer.poseOf(entity).position),
      calls: viewer.stage.renderer.info.render.calls,
    };
  });
  assert.equal(places.length, expected.robots.length);
  expected.robots.forEach(({ name, x, y }, i) => {
    assert.ok(Math.hypot(places[i][0] - x, places[i][1] - y) < 1e-4, `${name} is at ${places[i]}, not at ${x} ${y}`);
  });
  assert.ok(calls < 10, `${calls} draw calls`);
  const { x, y } = expected.robots[7];
  await page.evaluate(
    ([left, ahead]) => {
      window.cohort.viewer.cameras.look({ position: [left, ahead - 0.3, 0.9], target: [left, ahead, 0.1] });
    },
    [x, y],
  );
  const [pixel] = await pixelsAt(page, [[x, y, 0.1]]);
  assert.ok(isOrange(pixel), `where robot 7 is, the picture is ${pixel}`);

  for (const line of ["home", "top"]) {
    await run(page, line);
    const reach = await reachInPicture(page);
    assert.ok(reach <= 1, `after '${line}', a robot is at ${reach} of half the picture`);
    assert.ok(reach > 0.7, `after '${line}', robots take only ${reach} of half the picture`);
  }
  await run(page, "toggle labels");
  const labels = await shownLabels(page);
  assert.ok(labels.length > 5 && labels.length <= 30, `${labels.length} names`);
  assertApart(labels);
  const again = await shownLabels(page);
  assert.deepEqual(
    again.map(({ name }) => name),
    labels.map(({ name }) => name),
    "other names, though nothing has moved",
  );
}

// Draws once; the names that are shown, and where.
const shownLabels = (page) =>
  page.evaluate(() => {
    window.cohort.viewer.draw(performance.now() + 1000);
    return [...document.querySelectorAll("#labels span:not([hidden])")].map((each) => {
      const { left, right, top, bottom } = each.getBoundingClientRect();
      return { name: each.textContent, left, right, top, bottom };
    });
  });
function assertApart(labels) {
  for (const [i, a] of labels.entries())
    for (const b of labels.slice(i + 1)) {
      const overlaps = a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
      assert.ok(!overlaps, `the names ${a.name} and ${b.name} overlap`);
    }
}

// A recording of 40 s.
async function keepsInFrame(page) {
  await drawCoarsely(page);
  const isInside = async (what) => {
    let reach = Infinity;
    for (const end = Date.now() + patience; reach > 1 && Date.now() < end; ) {
      await drawn(page, 1);
      reach = await reachInPicture(page);
    }
    assert.ok(reach <= 1, `${what}, a robot is at ${reach} of half the picture`);
  };
  const keeps = () => page.evaluate(() => window.cohort.viewer.cameras.keepsAll);
  await run(page, "pause");
  for (const time of [0, 10, 40]) {
    await run(page, `seek ${time}`);
    await atTick(page, 100 * time);
    await isInside(`at ${time} s`);
  }
  await page.setViewportSize({ width: 500, height: 640 });
  await isInside("in a narrow picture");
  await page.setViewportSize({ width: 960, height: 640 });
  await run(page, "top; seek 0");
  await atTick(page, 0);
  await isInside("from above");
  await run(page, "orbit");
  await isInside("from the side again");

  // A click leaves the camera to itself, a drag takes it.
  const { x, y, width, height } = await page.locator("#canvas").boundingBox();
  const place = [x + 0.3 * width, y + 0.6 * height]; // which no panel covers
  await page.mouse.click(...place);
  await drawn(page, 2);
  assert.equal(await keeps(), true, "after a click");
  await page.mouse.move(...place);
  await page.mouse.down();
  await page.mouse.move(place[0] + 60, place[1] + 5, { steps: 4 });
  await drawn(page, 2);
  await page.mouse.up();
  await until(page, () => !window.cohort.viewer.cameras.keepsAll);
  await run(page, "home");
  assert.equal(await keeps(), true, "after 'home'");
  await page.mouse.wheel(0, -200);
  await until(page, () => !window.cohort.viewer.cameras.keepsAll);
  const stays = () =>
    page.evaluate(() => {
      const { viewer } = window.cohort;
      for (let i = 0; i < 200; ++i) viewer.cameras.controls.update(); // until the wheel's movement has faded
      return viewer.stage.camera.position.toArray();
    });
  const before = await stays();
  await run(page, "seek 40");
  await atTick(page, 4000);
  await drawn(page, 3);
  const after = await stays();
  assert.ok(Math.hypot(...after.map((each, i) => each - before[i])) < 1e-3, "the camera is the user's");
  await run(page, "home");
  await isInside("after 'home'");
  await run(page, "select 0; follow");
  assert.equal(await keeps(), false, "while it follows");
}

// Two teams of s-bots on a plane: those of the first are blue, those of the second are a yellowish orange.
async function coloursTeams(page, file) {
  const expected = JSON.parse(readFileSync(file, "utf8"));
  await run(page, `pause; seek ${expected.time}`);
  await atTick(page, expected.tick);
  await setShadows(page, false);
  await run(page, "home; top");
  await drawn(page, 2);
  const legend = await page.evaluate(() => window.cohort.viewer.legend().filter(({ kind }) => kind === "team"));
  assert.deepEqual(legend, [
    { label: "team first", color: "#0072b2", kind: "team" },
    { label: "team second", color: "#e69f00", kind: "team" },
  ]);
  const pixels = await pixelsAt(
    page,
    expected.robots.map(({ x, y }) => [x, y, 0.1]),
  );
  for (const [i, { name }] of expected.robots.entries()) {
    const hasColour = name.startsWith("a/") ? isBlue : isYellow;
    assert.ok(hasColour(pixels[i]), `where ${name} is, the picture is ${pixels[i]}`);
  }
}

// The page draws coarser when pictures come slowly, finer when they come fast, and leaves alone what people choose.
async function drawsAsItCan(page) {
  await run(page, "pause");
  // Feeds times between pictures; returns what comes of it, before the page measures its own.
  const feed = (interval, count) =>
    page.evaluate(
      ([each, times]) => {
        const { viewer } = window.cohort;
        for (let i = 0; i < times; ++i) viewer.adapt(each);
        const button = document.querySelector('[data-command="toggle shadows"]');
        return {
          ratio: viewer.stage.renderer.getPixelRatio(),
          shadows: viewer.layers.has("shadows"),
          isPressed: button.getAttribute("aria-pressed") === "true",
        };
      },
      [interval, count],
    );
  assert.deepEqual(await feed(500, 100), { ratio: 0.35, shadows: false, isPressed: false });
  assert.deepEqual(await feed(16, 100_000), { ratio: 1, shadows: true, isPressed: true });
  await setShadows(page, true);
  assert.deepEqual(await feed(500, 100), { ratio: 0.35, shadows: true, isPressed: true });
  await page.evaluate(() => window.cohort.viewer.stage.renderer.setPixelRatio(0.25));
  assert.equal((await feed(16, 100_000)).ratio, 0.25);
}

async function click(page, name) {
  const at = await page.evaluate((text) => {
    const { viewer } = window.cohort;
    viewer.draw(performance.now() + 1000);
    const [x, y, z] = viewer.poseOf(viewer.find(text)).position;
    const seen = viewer.cameras.target
      .clone()
      .set(x, y, z + 0.08)
      .project(viewer.stage.camera);
    const { left, top, width, height } = document.getElementById("canvas").getBoundingClientRect();
    return { x: left + 0.5 * (seen.x + 1) * width, y: top + 0.5 * (1 - seen.y) * height };
  }, name);
  await page.mouse.click(at.x, at.y);
}

async function steersRecording(page) {
  await drawCoarsely(page);
  await run(page, "pause; seek 1");
  await atTick(page, 100);
  await run(page, "step 3");
  await atTick(page, 103);
  await run(page, "step -2");
  await atTick(page, 101);
  await page.locator("#canvas").focus();
  await page.keyboard.press(".");
  await atTick(page, 102);

  await run(page, "home; top");
  await click(page, "explorers/sbot_7");
  await until(page, () => document.getElementById("inspected").textContent === "explorers/sbot_7");
  await until(page, () => document.querySelectorAll("#dial line").length >= 15);
  await page.keyboard.press("f");
  await until(page, () => window.cohort.viewer.cameras.mode === "follow");
  await run(page, "play; speed 2");
  await until(page, () => Number(window.cohort.viewer.poses.frame?.tick) > 150);
  const distance = await page.evaluate(() => {
    const { viewer } = window.cohort;
    viewer.draw(performance.now());
    const [x, y] = viewer.poseOf(viewer.chosen.selected).position;
    return Math.hypot(viewer.cameras.target.x - x, viewer.cameras.target.y - y);
  });
  assert.ok(distance < 0.02, `the camera looks ${distance} m beside what it follows`);
  await run(page, "pause; orbit");

  // The time bar, by hand.
  const bar = await page.locator("#track").boundingBox();
  await page.mouse.click(bar.x + 0.5 * bar.width, bar.y + 0.5 * bar.height);
  const near = await until(page, () => {
    const found = Number(window.cohort.viewer.poses.frame?.tick);
    return found > 180 && found < 220 ? found : undefined;
  });
  assert.ok(near);

  // The console, by hand: completion and history.
  await page.locator("#canvas").focus();
  await page.keyboard.press("`");
  await page.keyboard.type("see");
  await page.keyboard.press("Tab");
  await page.keyboard.type("0.5");
  await page.keyboard.press("Enter");
  await atTick(page, 50);
  await page.keyboard.type("step");
  await page.keyboard.press("Enter");
  await atTick(page, 51);
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("Enter");
  await atTick(page, 50);
  await page.keyboard.type("seeek 1");
  await page.keyboard.press("Enter");
  await until(page, () => document.querySelector("#lines .wrong")?.textContent.includes("there is no command 'seeek'"));
  await page.keyboard.press("Escape");

  const [download] = await Promise.all([page.waitForEvent("download", { timeout: patience }), run(page, "screenshot")]);
  const picture = readFileSync(await download.path());
  assert.equal(picture.subarray(1, 4).toString(), "PNG");
  const { colours } = await coloursIn(page, picture, "image/png");
  assert.ok(colours > 50, `the picture has ${colours} colours`);
}

/** Opens the panel of the plots if the page has them in one. */
const openPlots = (page) =>
  page.evaluate(() => {
    if (!document.getElementById("plots").checkVisibility()) document.querySelector('[data-tab="plotting"]')?.click();
  });

/** The plotted line of a value of a recording of 4 s, once all of it is there. */
const lineOf = (page, name) =>
  until(
    page,
    (each) => {
      const found = window.cohort.plots.lines().find((line) => line.name === each && line.curve.times.at(-1) === 4);
      return found && { unit: found.unit, times: found.curve.times, values: found.curve.values };
    },
    name,
  );

const fileOf = async (page, button) => {
  const [download] = await Promise.all([
    page.waitForEvent("download", { timeout: patience }),
    press(page.getByRole("button", { name: button })),
  ]);
  return readFileSync(await download.path(), "utf8");
};

/** Puts the mouse on a time of the first plot. */
async function hoverAt(page, time, range) {
  const first = page.locator("#plots .u-over").first();
  await first.scrollIntoViewIfNeeded();
  const over = await first.boundingBox();
  const x = over.x + ((time - range[0]) / (range[1] - range[0])) * over.width;
  await page.mouse.move(x - 3, over.y + 0.5 * over.height);
  await page.mouse.move(x, over.y + 0.5 * over.height);
  return { x, y: over.y + 0.5 * over.height };
}

async function plots(page, file) {
  const { name: robot, samples } = JSON.parse(readFileSync(file, "utf8"));
  const names = Object.keys(samples[0].values);
  await drawCoarsely(page);
  await run(page, "pause; seek 1");
  await atTick(page, 100);
  await run(page, `select ${robot}`);
  await openPlots(page);
  // By default the two commands of the tracks, in one plot as they have one unit.
  await lineOf(page, "→ treel/left/velocity");
  await lineOf(page, "→ treel/right/velocity");
  assert.equal(await page.locator("#plots .plot").count(), 1);
  await run(page, "plot treel/left/velocity");
  assert.equal(await page.locator("#plots .plot").count(), 1);
  await run(page, "plot treel/left/position [m]");
  await run(page, "plot proximity/3/reading");
  assert.equal(await page.locator("#plots .plot").count(), 3);
  await assert.rejects(run(page, "plot nothing"), /no channel 'nothing'/);
  const allIsThere = async () => {
    for (const name of names) {
      const { times, values } = await lineOf(page, name);
      assert.equal(times.length, 401, name);
      assert.deepEqual([times[0], times.at(-1)], [0, 4]);
      for (const { time, values: expected } of samples)
        assert.equal(values[times.indexOf(time)], expected[name], `${name} at ${time} s`);
    }
  };
  await allIsThere();
  const nowAt = () => page.evaluate(() => Number.parseFloat(document.querySelector("#plots .plot-now").style.left));
  await until(
    page,
    () => Math.abs(Number.parseFloat(document.querySelector("#plots .plot-now").style.left) - 25) < 0.1,
  );
  await run(page, "seek 3");
  await atTick(page, 300);
  await until(
    page,
    () => Math.abs(Number.parseFloat(document.querySelector("#plots .plot-now").style.left) - 75) < 0.1,
  );
  await allIsThere();

  // The mouse shows values with units, in all plots.
  const legend = (label) =>
    page.evaluate((text) => {
      const rows = [...document.querySelectorAll("#plots .plot-legend li")];
      return rows.find((row) => row.querySelector("span").textContent === text)?.querySelector("output").textContent;
    }, label);
  await hoverAt(page, 2, [0, 4]);
  const hovered = await until(page, () => {
    const time = Number.parseFloat(document.querySelector("#plots .plot-tools output").textContent);
    return Math.abs(time - 2) < 0.03 && time;
  });
  for (const name of names) {
    const { times, values, unit } = await lineOf(page, name);
    const value = values[times.indexOf(hovered)];
    const shown = await legend(name);
    assert.ok(Math.abs(Number.parseFloat(shown) - value) < 6e-4, `${name} is ${value}, not ${shown}`);
    assert.ok(unit === "1" ? /^[-\d.]+$/.test(shown) : shown.endsWith(` ${unit}`), shown);
    assert.ok(!/^-0\.?0*( |$)/.test(shown), shown);
  }

  // A click seeks, dragging zooms, a double click shows the whole again.
  await page.mouse.down();
  await page.mouse.up();
  await until(page, () => Math.abs(Number(window.cohort.viewer.poses.frame?.tick) - 200) < 4);
  assert.ok(Math.abs((await nowAt()) - 50) < 2);
  const from = await hoverAt(page, 1, [0, 4]);
  await page.mouse.down();
  await page.mouse.move(from.x + 40, from.y, { steps: 3 });
  const to = await hoverAt(page, 3, [0, 4]);
  await page.mouse.up();
  assert.ok(to.x > from.x);
  await until(page, () => {
    const rows = window.cohort.plots.csv().split("\r\n");
    return Math.abs(Number(rows[1].split(",")[0]) - 1) < 0.05 && Math.abs(Number(rows.at(-2).split(",")[0]) - 3) < 0.05;
  });
  await page.mouse.dblclick(to.x - 20, to.y);
  await until(page, () => window.cohort.plots.csv().split("\r\n").length === 403);
  await run(page, "seek 2.5");
  await atTick(page, 250);

  // The files have what is plotted.
  const csv = await fileOf(page, "Export the plotted values as CSV");
  const [head, ...rows] = csv.trimEnd().split("\r\n");
  const columns = head.split(",");
  assert.equal(columns[0], "time [s]");
  assert.ok(columns.includes("→ treel/left/velocity [m/s]"));
  assert.ok(columns.includes("treel/left/position [m]"));
  assert.equal(rows.length, 401);
  for (const { time, values: expected } of samples) {
    const cells = rows.find((row) => Number(row.split(",")[0]) === time).split(",");
    for (const name of names)
      assert.equal(Number(cells[columns.findIndex((column) => column.startsWith(`${name} [`))]), expected[name]);
  }
  assert.ok(!/(^|,)-0(,|$)/m.test(csv));
  const svg = await fileOf(page, "Export the plots as SVG");
  const picture = await page.evaluate((text) => {
    const parsed = new DOMParser().parseFromString(text, "image/svg+xml");
    return { root: parsed.documentElement.nodeName, lines: parsed.querySelectorAll("path[clip-path]").length };
  }, svg);
  assert.deepEqual(picture, { root: "svg", lines: columns.length - 1 });
  assert.ok(svg.includes("m/s") && svg.includes("treel/left/position"));

  // Several robots at once, and lines that are removed.
  await page.evaluate(() => window.cohort.plots.show([3, 5]));
  await until(page, () => window.cohort.plots.lines().filter(({ curve }) => curve.times.length === 401).length === 10);
  await page.evaluate(() => window.cohort.plots.show([3]));
  await press(page.getByRole("button", { name: "Remove treel/left/position" }));
  await until(page, () => !window.cohort.plots.lines().some(({ name }) => name === "treel/left/position"));

  // The inspector lists values with units.
  const cells = await until(page, () => {
    const rows = [...document.querySelectorAll("#values tr")].map((row) =>
      [...row.cells].map((cell) => cell.textContent),
    );
    const found = rows.find(([name]) => name === "treel/left/position");
    return found && found[1] !== "–" && found;
  });
  const { times, values } = await (async () => {
    await run(page, "plot treel/left/position");
    return lineOf(page, "treel/left/position");
  })();
  assert.ok(Math.abs(Number(cells[1]) - values[times.indexOf(2.5)]) < 6e-4);
  assert.equal(cells[2], "m");
  assert.ok(!/-0\.000/.test(await page.evaluate(() => document.body.innerText)));
}

async function plotsServer(page) {
  const first = await tick(page);
  await until(page, (each) => Number(window.cohort.viewer.poses.frame?.tick) > each + 100, first);
  await run(page, "select sbot_3");
  await openPlots(page);
  await run(page, "plot treel/left/position");
  // From a second before it was selected, and on. Ticks are of 10 ms.
  await until(
    page,
    (begin) => {
      const [line] = window.cohort.plots.lines().filter(({ name }) => name === "treel/left/position");
      const times = line?.curve.times ?? [];
      return times.length > 5 && times[0] <= begin && times.at(-1) > begin + 1;
    },
    first / 100,
  );
  const before = await page.evaluate(() => window.cohort.plots.lines()[0].curve.times.at(-1));
  await until(page, (time) => window.cohort.plots.lines()[0].curve.times.at(-1) > time + 0.5, before);
  assert.equal(
    await page.evaluate(() => {
      const { times } = window.cohort.plots.lines()[0].curve;
      return times.every((time, i) => i === 0 || time > times[i - 1]);
    }),
    true,
  );
  assert.equal(await page.locator("#plots .plot-tools .wrong").count(), 0);
}

async function keepsProfile(page) {
  await run(page, "pause");
  await run(page, 'bind k "seek 0.2"; alias hop "step 4"; script tour "seek 0.1; hop"');
  await page.reload();
  await until(page, () => window.cohort?.viewer.poses?.frame);
  await page.locator("#canvas").focus();
  await page.keyboard.press("k");
  await atTick(page, 20);
  await run(page, "hop");
  await atTick(page, 24);
  await run(page, "exec tour");
  await atTick(page, 14);
  await assert.rejects(run(page, "alias loop loop; loop"), /the alias refers to itself/);
  const profile = await page.evaluate(() => window.cohort.commands.exportProfile());
  await run(page, "unbind k; unalias hop");
  assert.equal(await page.evaluate(() => window.cohort.commands.commandOfKey("k")), undefined);
  await page.evaluate((text) => window.cohort.commands.importProfile(text), profile);
  assert.equal(await page.evaluate(() => window.cohort.commands.commandOfKey("k")), "seek 0.2");
  await assert.rejects(
    page.evaluate(() => window.cohort.commands.importProfile('{"keys": 3}')),
    /not a profile/,
  );
}

async function isFoundAgain(page) {
  console.log("connected");
  await until(page, () => document.getElementById("phase").innerText.includes("The connection is lost"));
  console.log("lost");
  await until(page, () => document.getElementById("phase").hidden);
  await run(page, "pause; seek 0.3");
  await atTick(page, 30);
}

// A run that records itself; the page was there before its first tick.
async function seesTheEnd(page) {
  const says = (text) => until(page, (each) => document.getElementById("phase").innerText.includes(each), text);
  await says("The run has finished");
  await says("At 0:03.00");
  await says("cohort run");
  if (process.env.COHORT_SCREENSHOT) await page.screenshot({ path: process.env.COHORT_SCREENSHOT });
  const hash = await page.evaluate(() => document.getElementById("hash").textContent);
  await until(page, () => {
    if (document.getElementById("name").textContent.endsWith(".mcap")) return true;
    document.getElementById("replay").click(); // the file may still be being written
    return false;
  });
  await until(page, () => document.getElementById("phase").hidden);
  await run(page, "pause; seek 3");
  await atTick(page, 300);
  assert.equal(await page.evaluate(() => document.getElementById("hash").textContent), hash);
}

async function steersServer(page) {
  await until(page, () => Number(window.cohort.viewer.poses.frame?.tick) > 20);
  await run(page, "pause");
  const before = await pausedTick(page);
  await run(page, "step 5");
  await atTick(page, before + 5);
  await run(page, "move sbot_3 0.25 -0.5");
  await until(page, () => {
    const { viewer } = window.cohort;
    const [x, y] = viewer.poseOf(viewer.find("explorers/sbot_3")).position;
    return Math.hypot(x - 0.25, y + 0.5) < 1e-3;
  }).catch(async (error) => {
    throw new Error(`${error.message}\n${await run(page, "where sbot_3")}`);
  });
  // By the mouse.
  await run(page, "home; top");
  await setShadows(page, false);
  const [from, to] = await page.evaluate(() => {
    const { viewer } = window.cohort;
    viewer.draw(performance.now() + 1000);
    return [
      [0.25, -0.5],
      [0.25, -0.2],
    ].map(([x, y]) => {
      const seen = viewer.cameras.target.clone().set(x, y, 0.05).project(viewer.stage.camera);
      const { left, top, width, height } = document.getElementById("canvas").getBoundingClientRect();
      return { x: left + 0.5 * (seen.x + 1) * width, y: top + 0.5 * (1 - seen.y) * height };
    });
  });
  await page.keyboard.down("Shift");
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y);
  await page.mouse.up();
  await page.keyboard.up("Shift");
  await until(page, () => {
    const { viewer } = window.cohort;
    const [x, y] = viewer.poseOf(viewer.find("explorers/sbot_3")).position;
    return Math.hypot(x - 0.25, y + 0.2) < 0.05;
  });
  await assert.rejects(run(page, "move nobody 0 0"), /nobody/);
  await assert.rejects(run(page, "step -1"), /one tick or more/);
  await run(page, "select sbot_3");
  await until(page, () => document.querySelectorAll("#dial line").length >= 15);
  await run(page, "reset");
  await until(page, () => Number(window.cohort.viewer.poses.frame?.run) === 2);
  assert.equal(await page.evaluate(() => document.getElementById("inspected").textContent), "explorers/sbot_3");
  await run(page, "play");
  await until(page, () => Number(window.cohort.viewer.poses.frame?.tick) > 10);
}

// A server that keeps a snapshot every half second.
async function goesBack(page) {
  const events = () => page.evaluate(() => document.getElementById("events").textContent);
  const eventsShow = (text) =>
    until(page, (each) => document.getElementById("events").textContent.includes(each), text);
  await until(page, () => Number(window.cohort.viewer.poses.frame?.tick) > 160);
  await eventsShow("joined");
  await run(page, "pause; events");
  await eventsShow("SetSimulationState");
  await run(page, "speed 0.5; speed 0.5");
  await eventsShow("(2 times, last at");
  const before = await pausedTick(page);
  await run(page, "seek 1.23");
  await atTick(page, 123);
  await eventsShow("joined");
  assert.ok(!(await events()).includes("SetSpeed"), "what has not happened any more is told");
  await run(page, "step 2");
  await atTick(page, 125);
  const hash = await page.evaluate(() => document.getElementById("hash").textContent);
  await run(page, "step -25");
  await atTick(page, 100);
  await run(page, "step 25");
  await atTick(page, 125);
  assert.equal(await page.evaluate(() => document.getElementById("hash").textContent), hash);
  await assert.rejects(run(page, `seek ${before / 100 + 1}`), /not reached that time/);
  // Seeks by the time bar: only when the mouse button is released, and no further than the run has come.
  await run(page, "step 75");
  await atTick(page, 200);
  const bar = await page.locator("#track").boundingBox();
  const { begin, end } = await page.evaluate(() => ({
    begin: Number(document.getElementById("scrub").min),
    end: Number(document.getElementById("scrub").max),
  }));
  const atTime = (time) => bar.x + ((time - begin) / (end - begin)) * bar.width;
  assert.equal(await pausedTick(page), 200);
  const asked = () => page.evaluate(() => window.cohort.connection.nextCall);
  const askedBefore = await asked();
  await page.mouse.move(atTime(2), bar.y + 0.5 * bar.height);
  await page.mouse.down();
  await page.mouse.move(atTime(0.75), bar.y + 0.5 * bar.height, { steps: 4 });
  assert.equal(await asked(), askedBefore, "nothing is asked for while the mouse holds it");
  assert.equal(await tick(page), 200);
  await page.mouse.up();
  await until(page, () => Number(window.cohort.viewer.poses.frame?.tick) < 120);
  await run(page, "play; speed 1");
  await until(page, () => Number(window.cohort.viewer.poses.frame?.tick) > 120);
}

async function onlyLooks(page) {
  await until(page, () => Number(window.cohort.viewer.poses.frame?.tick) > 20);
  for (const line of ["pause", "step", "reset", "move sbot_3 0 0", "speed 0.1"])
    await assert.rejects(run(page, line), /read-only/);
  assert.equal(await page.locator("#play").isVisible(), false);
  const before = await tick(page);
  await until(page, (each) => Number(window.cohort.viewer.poses.frame?.tick) > each + 20, before);
}

// A run whose disk is full after 100 kB.
async function tellsOfALostRecording(page) {
  await until(page, () => document.getElementById("events").textContent.includes("ulimit -f"));
  await until(page, () => document.getElementById("note").textContent.startsWith("NOT RECORDED: "));
  assert.equal(await page.locator("#note").isVisible(), true);
}

// Until it is told otherwise, by being killed.
async function looks(page) {
  console.log("looking");
  await until(page, () => Number(window.cohort.viewer.poses.frame?.tick) > 100);
  console.log("seen");
  await new Promise(() => setInterval(() => undefined, 1000));
}

async function isSuspended(page) {
  const session = await page.context().newCDPSession(page);
  await session.send("Page.setWebLifecycleState", { state: "frozen" });
  await session.send("Debugger.enable");
  await session.send("Debugger.pause");
  console.log("looking");
  await new Promise(() => setInterval(() => undefined, 1000));
}

await runScenario({
  draws,
  draws_many: drawsMany,
  keeps_in_frame: keepsInFrame,
  colours_teams: coloursTeams,
  draws_as_it_can: drawsAsItCan,
  steers_recording: steersRecording,
  plots,
  plots_server: plotsServer,
  keeps_profile: keepsProfile,
  is_found_again: isFoundAgain,
  sees_the_end: seesTheEnd,
  steers_server: steersServer,
  goes_back: goesBack,
  only_looks: onlyLooks,
  tells_of_a_lost_recording: tellsOfALostRecording,
  looks,
  is_suspended: isSuspended,
});
