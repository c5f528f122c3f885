// SPDX-License-Identifier: Apache-2.0

// Opens HTML files that contain a recording, without a network: node html.mjs SCENARIO ADDRESS [FILE].
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { atTick, drawCoarsely, expectRobots, run, runScenario, until } from "./in_page.mjs";
import { drawsTextures } from "./textures.mjs";

const asked = []; // addresses
const complaints = []; // in the browser's console

async function cutOff(page) {
  page.on("request", (request) => asked.push(request.url()));
  page.on("websocket", (socket) => asked.push(socket.url()));
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  await page.context().setOffline(process.argv[2] !== "equals_view");
}

function expectNoRequests() {
  const [page, ...others] = asked;
  assert.ok(page.startsWith("file://"), page);
  assert.deepEqual(
    others.filter((address) => !/^(data|blob):/.test(address)),
    [],
    "only the file itself is loaded",
  );
  assert.deepEqual(complaints, []);
}

const shownNote = (page) => page.evaluate(() => document.getElementById("note").textContent);

async function plays(page, file) {
  await drawCoarsely(page);
  const { moments, last } = JSON.parse(readFileSync(file, "utf8"));
  await run(page, "pause; seek 0");
  await atTick(page, 0);
  await run(page, "play");
  await until(page, () => Number(window.cohort.viewer.poses.frame.tick) > 0);
  await run(page, "pause");
  for (const expected of moments) {
    await run(page, `seek ${expected.time}`);
    await atTick(page, expected.tick);
    await expectRobots(page, expected);
  }
  const [first] = moments;
  await run(page, `seek ${first.time}`);
  await atTick(page, first.tick);
  await expectRobots(page, first);

  // The file has each fifth tick.
  await run(page, "seek 1; step");
  await atTick(page, 105);
  await run(page, "step -15");
  await atTick(page, 90);
  await page.locator("#canvas").focus();
  await page.keyboard.press(".");
  await atTick(page, 95);
  const bar = await page.locator("#track").boundingBox();
  await page.mouse.click(bar.x + 0.5 * bar.width, bar.y + 0.5 * bar.height);
  await until(page, () => Math.abs(Number(window.cohort.viewer.poses.frame.tick) - 200) < 20);

  await run(page, "seek 0; select sbot_3");
  await until(page, () => document.querySelectorAll("#dial line").length >= 15);
  assert.equal(await shownNote(page), "");
  await run(page, "toggle contacts");
  await until(page, () => document.getElementById("note").textContent.includes("cohort page --contacts"));
  await run(page, "toggle contacts");
  await until(page, () => document.getElementById("note").textContent === "");

  await run(page, "speed max; play");
  await atTick(page, last);
  await until(page, () => document.getElementById("factor").textContent === "paused");
  await run(page, "speed 0.1; play");
  await until(page, (end) => Number(window.cohort.viewer.poses.frame.tick) < end, last);
  await assert.rejects(run(page, "reset"), /'reset': unknown operation; a recording offers play/);
  expectNoRequests();
}

/** The state of a page at a time of the recording. */
async function stateAt(page, { time, tick: wanted }, robot) {
  await run(page, `pause; seek ${time}; select ${robot}`);
  await atTick(page, wanted);
  await until(page, (at) => Number(window.cohort.viewer.robot?.tick) === at, wanted);
  return page.evaluate(() => {
    const { poses, signals, robot: channels, contacts } = window.cohort.viewer;
    const { positions, orientations, state_hash, run: number, time_ns } = poses.frame;
    return {
      positions: [...positions],
      orientations: [...orientations],
      frame: [state_hash, number, time_ns].map(String),
      leds: [...signals.leds],
      channels: [...channels.observation, ...channels.command],
      contacts: contacts.group.children.map(({ geometry }) => {
        const points = geometry.getAttribute("position");
        return points ? [...points.array.slice(0, 3 * geometry.drawRange.count)] : [];
      }),
    };
  });
}

// The view of the same recording is at `view`.
async function equalsView(page, file) {
  const { view, moments } = JSON.parse(readFileSync(file, "utf8"));
  const statesAt = async () => {
    await drawCoarsely(page);
    await run(page, "toggle contacts");
    const states = [];
    for (const moment of moments) states.push(await stateAt(page, moment, "holder"));
    return states;
  };
  const states = await statesAt();
  await page.goto(view);
  await until(page, () => window.cohort?.viewer.poses?.frame);
  const expected = await statesAt();
  const exact = (all) => all.map((state) => ({ ...state, channels: state.channels.length }));
  assert.deepEqual(exact(states), exact(expected));
  for (const [i, { channels }] of states.entries())
    for (const [j, value] of channels.entries()) {
      const wanted = expected[i].channels[j];
      assert.ok(Math.abs(value - wanted) <= 1e-5 * Math.abs(wanted), `channel ${j} is ${value}, not ${wanted}`);
    }
  assert.ok(
    states.some(({ contacts }) => contacts.some((points) => points.length > 0)),
    "there are contacts",
  );
}

// The world's name, which the file holds, is code that must not be run.
async function isHarmless(page, file) {
  const { world, name } = JSON.parse(readFileSync(file, "utf8"));
  const { found, title, broken, images } = await page.evaluate(() => ({
    found: window.cohort.viewer.poses.scene.world,
    title: document.title,
    broken: window.broken,
    images: document.images.length,
  }));
  assert.equal(found, world);
  await until(page, (each) => document.getElementById("name").textContent === each, name);
  assert.ok(title.startsWith(name), title);
  assert.deepEqual([broken, images], [undefined, 0]);
  expectNoRequests();
}

// The second world of the recording has an object more.
async function changesScene(page) {
  await drawCoarsely(page);
  const entities = () => page.evaluate(() => window.cohort.viewer.poses.scene.entities.map(({ name }) => name));
  await run(page, "pause; seek 0.05");
  await until(page, () => window.cohort.viewer.poses.frame.tick === 5n);
  assert.ok(!(await entities()).includes("late"));
  await run(page, "seek 100");
  await until(page, () => window.cohort.viewer.poses.scene.entities.some(({ name }) => name === "late"));
  assert.equal(await page.evaluate(() => window.cohort.viewer.poses.frame.revision), 2);
  await run(page, "seek 0.05");
  await until(page, () => !window.cohort.viewer.poses.scene.entities.some(({ name }) => name === "late"));
  await until(page, () => window.cohort.viewer.poses.frame?.tick === 5n);
  expectNoRequests();
}

async function containsTextures(page) {
  await drawsTextures(page);
  expectNoRequests();
}

await runScenario(
  {
    plays,
    equals_view: equalsView,
    is_harmless: isHarmless,
    changes_scene: changesScene,
    contains_textures: containsTextures,
  },
  { prepare: cutOff },
);
