// Drives the page in a browser without a window: node browser.mjs SCENARIO ADDRESS [FILE]. Ends with 0 if all is right.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import {
  atTick,
  coloursIn,
  drawCoarsely,
  drawn,
  patience,
  pausedTick,
  pixelsAt,
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
  assert.equal(poses.length, 16);
  expected.robots.forEach(({ name, x, y, heading }, i) => {
    const { position, heading: found } = poses[i];
    assert.ok(Math.hypot(position[0] - x, position[1] - y) < 1e-4, `${name} is at ${position}, not at ${x} ${y}`);
    assert.ok(Math.cos(found - heading) > 0.99999, `${name} heads ${found}, not ${heading}`);
  });
  assert.deepEqual(shown, [String(expected.tick), expected.hash, "16"]);
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
}

async function drawsMany(page, file) {
  const expected = JSON.parse(readFileSync(file, "utf8"));
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
          isPressed: button.classList.contains("on"),
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
    const { width, height } = document.getElementById("canvas").getBoundingClientRect();
    return { x: 0.5 * (seen.x + 1) * width, y: 0.5 * (1 - seen.y) * height };
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
    const [x, y] = viewer.poseOf(viewer.selected).position;
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
      const { width, height } = document.getElementById("canvas").getBoundingClientRect();
      return { x: 0.5 * (seen.x + 1) * width, y: 0.5 * (1 - seen.y) * height };
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
