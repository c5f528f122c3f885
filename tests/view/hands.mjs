// SPDX-License-Identifier: Apache-2.0

// In these scenarios a person drives robots, and adds, drags and removes objects.
import assert from "node:assert/strict";
import { Guest } from "./guest.mjs";
import { drawCoarsely, look, press, run, runScenario, seenAt, tick, until } from "./in_page.mjs";

const poseOf = (page, name) =>
  page.evaluate((text) => {
    const { viewer } = window.cohort;
    const { position, heading } = viewer.poseOf(viewer.find(text));
    return { x: position[0], y: position[1], z: position[2], heading };
  }, name);
// Sees the robot go on by so much [m], and turn by so much [rad].
const untilMoved = (page, name, from, way, turn) =>
  until(
    page,
    ([text, before, least, angle]) => {
      const { viewer } = window.cohort;
      const { position, heading } = viewer.poseOf(viewer.find(text));
      const turned = Math.atan2(Math.sin(heading - before.heading), Math.cos(heading - before.heading));
      return (
        Math.hypot(position[0] - before.x, position[1] - before.y) >= least &&
        Math.sign(angle) * turned >= Math.abs(angle)
      );
    },
    [name, from, way, turn],
  );
// Sees it at rest for so many ticks.
async function untilAtRest(page, name, ticks = 40) {
  for (;;) {
    const [before, from] = [await poseOf(page, name), await tick(page)];
    await until(page, (wanted) => Number(window.cohort.viewer.poses.frame?.tick) >= wanted, from + ticks);
    const after = await poseOf(page, name);
    if (Math.hypot(after.x - before.x, after.y - before.y) < 1e-4 && Math.abs(after.heading - before.heading) < 1e-3)
      return after;
  }
}
const told = (page, text) =>
  until(
    page,
    (part) => {
      const line = document.getElementById("told");
      return !line.hidden && line.textContent.includes(part);
    },
    text,
  );
const driven = (page) => page.evaluate(() => window.cohort.driving.name);
const drives = (page, name) => until(page, (wanted) => window.cohort.driving.name === wanted, name);

async function goesAhead(page, name, press, release) {
  const from = await untilAtRest(page, name);
  await press();
  await untilMoved(page, name, from, 0.08, 0);
  await release();
  const to = await untilAtRest(page, name);
  const way = Math.hypot(to.x - from.x, to.y - from.y);
  const straight = ((to.x - from.x) * Math.cos(from.heading) + (to.y - from.y) * Math.sin(from.heading)) / way;
  assert.ok(straight > 0.995, `it went ${to.x - from.x}, ${to.y - from.y} where it headed ${from.heading}`);
}
const key = (page, name) => [() => page.keyboard.down(name), () => page.keyboard.up(name)];

async function drivesByKeys(page) {
  const robot = "people/keys";
  await drawCoarsely(page);
  await run(page, "select people/keys");
  await press(page.locator("#drive"));
  await drives(page, robot);
  assert.match(
    await page.locator("#driven").textContent(),
    /drives people\/keys · arrows or w a s d · Escape releases/,
  );
  assert.equal(await page.locator("#drive").textContent(), "release");
  await goesAhead(page, robot, ...key(page, "ArrowUp"));

  // The server reports the command: half of full speed, and the other way round.
  let from = await untilAtRest(page, robot);
  await page.keyboard.down("ArrowLeft");
  await until(page, () => {
    const { robot: seen, poses } = window.cohort.viewer;
    const { command } =
      poses.scene.models[
        poses.scene.entities[poses.scene.entities.findIndex(({ name }) => name === "people/keys")].model
      ];
    const left = command.findIndex(({ name }) => name.endsWith("/left/velocity"));
    const half = 0.5 * command[left].upper;
    return seen && Math.abs(seen.command[left] + half) < 1e-9 && Math.abs(seen.command[left + 1] - half) < 1e-9;
  });
  await untilMoved(page, robot, from, 0, 0.4);
  await page.keyboard.up("ArrowLeft");
  const to = await untilAtRest(page, robot);
  assert.ok(Math.hypot(to.x - from.x, to.y - from.y) < 0.03, "it turned on the spot");

  // Two keys make a curve; a key that drives does nothing else, and others what they did.
  await run(page, 'bind w "toggle labels"; steer i back; steer m turret/0/velocity 0.5');
  from = await untilAtRest(page, robot);
  await page.locator("#canvas").focus();
  await page.keyboard.down("w");
  await page.keyboard.down("d");
  await untilMoved(page, robot, from, 0.05, -0.3);
  await page.keyboard.up("w");
  await page.keyboard.up("d");
  await page.keyboard.press("t");
  await until(page, () => window.cohort.viewer.cameras.mode === "top");
  assert.equal(await page.evaluate(() => window.cohort.viewer.layers.has("labels")), false);
  from = await untilAtRest(page, robot);
  await page.keyboard.down("i");
  await untilMoved(page, robot, from, 0.05, 0);
  await page.keyboard.up("i");
  await assert.rejects(run(page, "steer i sideways"), /expected ahead, back, left, right/);

  // Another channel, by its slider and by its key.
  const turretIs = (wanted) =>
    until(
      page,
      (value) => {
        const { robot: seen, poses } = window.cohort.viewer;
        const { command } = poses.scene.models[poses.scene.entities.find(({ name }) => name === "people/keys").model];
        return seen?.command[command.findIndex(({ name }) => name === "turret/0/velocity")] === value;
      },
      wanted,
    );
  await turretIs(0);
  await page.locator('#sliders input[data-channel="turret/0/velocity"]').fill("0.25");
  await turretIs(0.25);
  await page.locator("#canvas").focus();
  await page.keyboard.down("m");
  await turretIs(0.5);
  await page.keyboard.up("m");
  await turretIs(0.25);

  // Pause and reset are survived.
  await run(page, "pause; step 3; play");
  await run(page, "reset");
  await until(page, () => Number(window.cohort.viewer.poses.frame?.run) === 2);
  await goesAhead(page, robot, ...key(page, "ArrowUp"));
  assert.equal(await driven(page), robot);

  await page.keyboard.press("Escape");
  await drives(page, undefined);
  assert.equal(await page.locator("#inspected").textContent(), robot, "Escape has deselected nothing");
  from = await untilAtRest(page, robot);
  await page.keyboard.down("ArrowUp");
  const later = (await tick(page)) + 60;
  await until(page, (wanted) => Number(window.cohort.viewer.poses.frame?.tick) > wanted, later);
  await page.keyboard.up("ArrowUp");
  const after = await poseOf(page, robot);
  assert.ok(Math.hypot(after.x - from.x, after.y - from.y) < 1e-3, "nobody drives it any more");

  // A robot that a controller drives.
  await run(page, "select others/driven");
  await press(page.locator("#drive"));
  await told(page, "others/driven is driven by");
  await assert.rejects(run(page, "drive people/nobody"), /there is no robot/);
}

// Robots with a twist, two wheels, four wheels and belts.
async function drivesByArrows(page) {
  await drawCoarsely(page);
  for (const robot of ["people/turtlebot3", "people/two_wheeler", "people/skid_steer", "people/on_belts"]) {
    await run(page, `drive ${robot}`);
    assert.match(await page.locator("#driven").textContent(), /arrows or w a s d/, robot);
    assert.doesNotMatch(
      await page.locator("#sliders").innerText(),
      /velocity|linear|angular/,
      "the arrows drive these",
    );
    await page.locator("#canvas").focus();
    await goesAhead(page, robot, ...key(page, "ArrowUp"));
    const from = await untilAtRest(page, robot);
    await page.keyboard.down("ArrowLeft");
    await untilMoved(page, robot, from, 0, 0.3);
    await page.keyboard.up("ArrowLeft");
    await untilAtRest(page, robot);
  }
}

async function drivesByPad(page) {
  const robot = "people/pad";
  await page.addInitScript(() => {
    window.pad = {
      id: "Test pad (STANDARD GAMEPAD)",
      index: 0,
      connected: true,
      mapping: "standard",
      axes: [0, 0, 0, 0],
      buttons: [],
      timestamp: 0,
    };
    navigator.getGamepads = () => [null, window.pad];
  });
  await page.reload();
  await until(page, () => window.cohort?.viewer.poses?.frame);
  const stick = (x, y) =>
    page.evaluate(
      (axes) => {
        window.pad.axes = axes;
      },
      [x, y, 0, 0],
    );
  await drawCoarsely(page);
  await run(page, "drive people/pad");
  assert.match(await page.locator("#driven").textContent(), /the left stick of Test pad/);
  await goesAhead(
    page,
    robot,
    () => stick(0, -1),
    () => stick(0.1, -0.1),
  );
  const from = await untilAtRest(page, robot);
  await stick(1, 0);
  await untilMoved(page, robot, from, 0, -0.4);
  await stick(0, 0);
  await untilAtRest(page, robot);
  await run(page, "release");
}

// A page drives, and another one requests the same robot.
async function drivesAlone(page) {
  const robot = "people/keys";
  await drawCoarsely(page);
  const guest = await Guest.at(page.url());
  const claim = () => guest.ask({ operation: "drive", name: robot, numbers: [] });
  const from = await poseOf(page, robot);
  await run(page, "drive people/keys");
  assert.deepEqual(await claim(), { done: false, text: "another page drives people/keys" });
  assert.equal((await guest.ask({ operation: "release", name: robot })).done, false);
  await page.keyboard.down("ArrowUp");
  await untilMoved(page, robot, from, 0.05, 0);

  // A page that says nothing, though its connection is there: the robot stands, and is the next one's.
  const { id, left, neutral } = await guest.sees("/cohort/scene", ({ entities, models }) => {
    const { model, robot: number } = entities.find(({ name }) => name === robot);
    const { command } = models[model];
    return {
      id: number,
      left: command.findIndex(({ name }) => name.endsWith("/left/velocity")),
      neutral: command.flatMap((channel) => Array(channel.size).fill(channel.neutral)),
    };
  });
  await guest.ask({ operation: "watch", numbers: [id] });
  const isTold = (speed) =>
    guest.sees(
      "/cohort/robots",
      ({ robots }) => robots[0]?.command[left] === speed && robots[0].command[left + 1] === speed,
    );
  await page.evaluate(() => {
    window.cohort.connection.ask = () => new Promise(() => undefined);
  });
  await isTold(0);
  for (let answer = await claim(); !answer.done; answer = await claim()) {
    assert.equal(answer.text, "another page drives people/keys");
    await new Promise((resolve) => setTimeout(resolve, 200));
  }
  const slowly = neutral.map((value, i) => (i === left || i === left + 1 ? 0.05 : value));
  assert.deepEqual(await guest.ask({ operation: "drive", name: robot, numbers: slowly.slice(1) }), {
    done: false,
    text: `the robot's command has ${slowly.length} values, not ${slowly.length - 1}`,
  });
  const beating = setInterval(() => void guest.ask({ operation: "drive", name: robot, numbers: slowly }), 100);
  await isTold(0.05);
  clearInterval(beating);
  assert.deepEqual(await guest.ask({ operation: "release", name: robot }), {
    done: true,
    text: "released people/keys",
  });
  guest.close();
}

// Until the run is over, or it is killed.
async function drivesOn(page) {
  await drawCoarsely(page);
  await run(page, "drive people/keys");
  const from = await poseOf(page, "people/keys");
  await page.keyboard.down("ArrowUp");
  await untilMoved(page, "people/keys", from, 0.05, 0);
  console.log("driving");
  await drives(page, undefined);
  console.log(`ended: ${await page.locator("#told").textContent()}`);
}

// Moves the joints of a model that was run by itself.
async function movesJoints(page) {
  await drawCoarsely(page);
  await run(page, "select bare");
  await press(page.locator("#drive"));
  await drives(page, "bare");
  const slider = (joint) => page.locator(`#sliders input[data-channel="${joint}/0/position"]`);
  assert.equal(await slider("shoulder").getAttribute("type"), "range");
  assert.equal(await slider("shoulder").getAttribute("max"), "1");
  assert.equal(Number(await slider("spin").getAttribute("max")), Math.PI, "a joint without limits has a slider too");
  await slider("shoulder").fill("0.5");
  await until(page, () => window.cohort.viewer.robot?.command[0] === 0.5);
  await run(page, "shutdown");
}

// The first robot of teleop.yaml, whose run waits for a driver.
async function drivesFirst(page) {
  const robot = "explorers/sbot_0";
  const noted = (part) =>
    until(
      page,
      (text) => {
        const note = document.getElementById("note");
        return !note.hidden && note.textContent.includes(text);
      },
      part,
    );
  await until(
    page,
    (name) => {
      const text = document.getElementById("phase").innerText;
      return text.includes("Waiting for controllers") && text.includes(`cohort teleop --robots ${name}`);
    },
    robot,
  );
  await press(page.locator("#phase-close"));
  assert.equal(await tick(page), 0);
  await drawCoarsely(page);
  await run(page, "select sbot_0");
  await press(page.locator("#drive"));
  await drives(page, robot);
  const from = await poseOf(page, robot);
  await page.keyboard.down("ArrowDown");
  await untilMoved(page, robot, from, 0.05, 0);
  await page.keyboard.up("ArrowDown");
  await page.keyboard.press("Escape");
  await noted(`waits for ${robot}`);
  await press(page.locator("#drive"));
  await drives(page, robot);
  const before = await tick(page);
  await until(page, (each) => Number(window.cohort.viewer.poses.frame?.tick) > each + 20, before);
}

async function handlesObjects(page) {
  await drawCoarsely(page);
  await look(page, [0, -0.01, 5], [0, 0, 0]); // from so far that no card covers anything
  await run(page, "top; add bar");
  await run(page, "move others/driven -4 -4"); // or it comes and pushes what is put down
  assert.deepEqual(await page.locator("#adding-model option").allTextContents(), ["lamp_post", "bar"]);
  assert.equal(await page.locator("#adding-name").inputValue(), "bar_1");
  const ghost = () =>
    page.evaluate(() => {
      const { group } = window.cohort.objects.ghost;
      return group.visible ? group.position.toArray() : undefined;
    });
  const at = await seenAt(page, [0.5, 0.3, 0]);
  await page.mouse.move(at.x, at.y);
  const shown = await ghost();
  assert.ok(
    Math.hypot(shown[0] - 0.5, shown[1] - 0.3) < 0.02 && Math.abs(shown[2] - 0.05) < 1e-6,
    `the ghost is at ${shown}`,
  );
  await page.mouse.click(at.x, at.y);
  await until(page, () => window.cohort.viewer.find("bar_1") !== undefined && window.cohort.viewer.poses.frame);
  const added = await poseOf(page, "bar_1");
  assert.ok(
    Math.hypot(added.x - 0.5, added.y - 0.3) < 0.02 && Math.abs(added.z - 0.05) < 5e-3,
    `it is at ${JSON.stringify(added)}`,
  );
  await until(page, () => document.getElementById("adding-name").value === "bar_2");

  // The page shows a refusal by the server.
  await page.locator("#adding-name").fill("bar_1");
  await page.mouse.click(at.x, at.y);
  await told(page, "another object has the name 'bar_1'");
  await assert.rejects(run(page, "spawn sbott one_more 0 0"), /the world has no model/);
  await page.locator("#canvas").focus();
  await page.keyboard.press("Escape");
  assert.equal(await page.locator("#adding").isVisible(), false);
  assert.equal(await ghost(), undefined);

  // Grabbed while the picture is still on the way there, it keeps the heading that it has.
  const grabbing = page.evaluate(
    ({ x, y }) =>
      new Promise((resolve) => {
        const { viewer, objects } = window.cohort;
        viewer.take = (frame) => {
          Object.getPrototypeOf(viewer).take.call(viewer, frame);
          if (Math.abs(viewer.poseOf(viewer.find("bar_1")).heading - 1) > 0.01) return;
          viewer.poses.advance(0);
          objects.grab(x, y);
          resolve(objects.dragged?.heading);
          objects.dragged = undefined;
          delete viewer.take;
        };
      }),
    await seenAt(page, [0.5, 0.3, 0.1]),
  );

  // Dragged, it is shown where it goes, and keeps its heading.
  await run(page, "move bar_1 0.5 0.3 0.05 1.0");
  assert.ok(Math.abs((await grabbing) - 1) < 0.01, `it would be put down with a heading of ${await grabbing}`);
  await until(page, () => Math.abs(window.cohort.viewer.poseOf(window.cohort.viewer.find("bar_1")).heading - 1) < 0.01);
  const [from, to] = [await seenAt(page, [0.5, 0.3, 0.1]), await seenAt(page, [0.5, -0.4, 0.1])];
  await page.keyboard.down("Shift");
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 3 });
  const dragged = await ghost();
  assert.ok(Math.hypot(dragged[0] - 0.5, dragged[1] + 0.4) < 0.05, `the ghost is at ${dragged}`);
  await page.mouse.up();
  await page.keyboard.up("Shift");
  await until(page, () => {
    const { position, heading } = window.cohort.viewer.poseOf(window.cohort.viewer.find("bar_1"));
    return Math.hypot(position[0] - 0.5, position[1] + 0.4) < 0.05 && Math.abs(heading - 1) < 0.02;
  });
  assert.equal(await ghost(), undefined);

  await run(page, "select lamp_post");
  const lampShines = (wanted) => until(page, (isOn) => window.cohort.viewer.signals.lamps[3] > 0 === isOn, wanted);
  await lampShines(true);
  await press(page.locator("#light", { hasText: "light off" }));
  await lampShines(false);
  await press(page.locator("#light", { hasText: "light on" }));
  await lampShines(true);

  await run(page, "select bar_1");
  assert.equal(await page.locator("#light").isVisible(), false);
  assert.equal(await page.locator("#drive").isVisible(), false);
  // A removal hides the object at once, and the server removes it later, unless the user undoes it.
  const isHidden = () =>
    page.evaluate(() => window.cohort.viewer.chosen.hidden.has(window.cohort.viewer.find("bar_1")));
  const isGone = () =>
    page.evaluate(() => window.cohort.viewer.poses.frame.absent.includes(window.cohort.viewer.find("bar_1")));
  await press(page.locator("#remove"));
  assert.equal(await isHidden(), true);
  await press(page.locator("#undo-button"));
  assert.equal(await isHidden(), false);
  assert.equal(await page.locator("#inspected").textContent(), "bar_1");
  assert.equal(await isGone(), false);
  await press(page.locator("#remove"));
  await until(page, () => document.getElementById("inspector").hidden);
  await until(page, () => window.cohort.viewer.poses.frame?.absent.includes(window.cohort.viewer.find("bar_1")));
}

// Nothing of it is offered where it cannot be done.
async function offersNoHands(page) {
  await run(page, "select explorers/sbot_3");
  for (const id of ["remove", "drive", "adding"]) assert.equal(await page.locator(`#${id}`).isVisible(), false, id);
  assert.equal(await page.locator('[data-command="add"]').isVisible(), false);
  await assert.rejects(run(page, "drive sbot_3"), /a recording offers/);
}

await runScenario(
  {
    drives_by_keys: drivesByKeys,
    drives_by_arrows: drivesByArrows,
    drives_by_pad: drivesByPad,
    drives_alone: drivesAlone,
    drives_on: drivesOn,
    drives_first: drivesFirst,
    moves_joints: movesJoints,
    handles_objects: handlesObjects,
    offers_no_hands: offersNoHands,
  },
  { context: { deviceScaleFactor: 0.25 } }, // no test looks at pixels here
);
