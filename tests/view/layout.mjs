// SPDX-License-Identifier: Apache-2.0

// Checks the page around the picture: panels, tree, cards, and what assistive technology needs.
// node layout.mjs SCENARIO ADDRESS
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { drawCoarsely, drawn, press, run, runScenario, until } from "./in_page.mjs";

const axeSource = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const desktop = { width: 1440, height: 900 };
const phone = { width: 390, height: 844 };

/** A large page with the tree. */
async function onDesktop(page) {
  await page.setViewportSize(desktop);
  if (!(await isVisible(page, "left"))) await press(page.locator('[data-panel="left"]'));
}

const isVisible = (page, id) => page.locator(`#${id}`).isVisible();
const text = (page, id) => page.locator(`#${id}`).textContent();

/** Rectangles of the visible panels and of the picture that share an area. */
const overlaps = (page) =>
  page.evaluate(() => {
    const ids = ["bar", "note", "tools", "left", "view", "right", "tabs", "dock", "time"];
    const boxes = ids.flatMap((id) => {
      const { left, top, right, bottom, width, height } = document.getElementById(id).getBoundingClientRect();
      return width > 0 && height > 0 ? [{ id, left, top, right, bottom }] : [];
    });
    return boxes.flatMap((a, i) =>
      boxes
        .slice(i + 1)
        .filter(
          (b) =>
            Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 &&
            Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1,
        )
        .map((b) => `${a.id} and ${b.id}`),
    );
  });
const outside = (page) =>
  page.evaluate(() =>
    ["bar", "tools", "view", "tabs", "time"].filter((id) => {
      const { left, top, right, bottom } = document.getElementById(id).getBoundingClientRect();
      return left < -1 || top < -1 || right > innerWidth + 1 || bottom > innerHeight + 1;
    }),
  );
const areaOfPicture = (page) =>
  page.evaluate(() => {
    const { width, height } = document.getElementById("canvas").getBoundingClientRect();
    return (width * height) / (innerWidth * innerHeight);
  });

async function nothingOverlaps(page) {
  await run(page, "pause; select sbot_3");
  for (const size of [desktop, { width: 960, height: 640 }, phone]) {
    await page.setViewportSize(size);
    await drawn(page, 2);
    for (const tab of ["left", "right", "plotting", "events", "console"]) {
      const button = page.locator(`[data-tab="${tab}"]:visible, [data-panel="${tab}"]:visible`);
      if ((await button.getAttribute("aria-pressed")) === "false") await press(button);
      assert.equal(await isVisible(page, tab), true, tab);
      assert.deepEqual(await overlaps(page), [], `${size.width} with ${tab}`);
      assert.deepEqual(await outside(page), [], `${size.width} with ${tab}`);
    }
    assert.ok((await areaOfPicture(page)) > 0.2, `the picture has ${await areaOfPicture(page)} of ${size.width}`);
  }
}

async function panelsAreKept(page) {
  await onDesktop(page);
  await run(page, "pause");
  const width = (id) => page.evaluate((each) => document.getElementById(each).getBoundingClientRect().width, id);
  const before = await width("left");
  const edge = await page.locator("#left-edge").boundingBox();
  await page.mouse.move(edge.x + 2, edge.y + 100);
  await page.mouse.down();
  await page.mouse.move(edge.x + 82, edge.y + 100, { steps: 4 });
  await page.mouse.up();
  assert.equal(await width("left"), before + 80);
  await page.locator("#right-edge").focus();
  const right = await width("right");
  await page.keyboard.press("ArrowLeft");
  assert.equal(await width("right"), right + 16);
  await press(page.locator('[data-tab="events"]'));
  assert.equal(await isVisible(page, "events"), true);
  await press(page.locator('[data-panel="right"]'));
  assert.equal(await isVisible(page, "right"), false);
  await page.reload();
  await until(page, () => window.cohort?.viewer.poses?.frame);
  assert.equal(await width("left"), before + 80);
  assert.equal(await isVisible(page, "right"), false);
  assert.equal(await isVisible(page, "events"), true);
  await press(page.locator('[data-tab="events"]'));
  assert.equal(await isVisible(page, "dock"), false);
}

async function worksOnAPhone(page) {
  await page.setViewportSize(phone);
  await run(page, "pause; seek 1; select sbot_3");
  await press(page.locator('[data-tab="right"]'));
  assert.equal(await text(page, "inspected"), "explorers/sbot_3");
  const small = await page.evaluate(() =>
    [...document.querySelectorAll("button, select")]
      .filter((each) => each.checkVisibility())
      .map((each) => ({ id: each.id || each.title || each.textContent, box: each.getBoundingClientRect() }))
      .filter(({ box }) => box.width < 44 || box.height < 44)
      .map(({ id, box }) => `${id} ${box.width} × ${box.height}`),
  );
  assert.deepEqual(small, []);
  await run(page, "home");
  const out = await page.evaluate(() => {
    const { viewer } = window.cohort;
    viewer.draw(performance.now() + 1000);
    return viewer.robotEntities().filter((entity) => {
      const at = viewer.cameras.target.clone().set(...viewer.poseOf(entity).position);
      at.project(viewer.stage.camera);
      return Math.abs(at.x) > 1 || Math.abs(at.y) > 1;
    });
  });
  assert.deepEqual(out, [], "robots outside of the picture");
}

const rows = (page) =>
  page.evaluate(() =>
    [...document.querySelectorAll("#tree [role=treeitem]")].map((row) => row.querySelector("span").textContent),
  );
const selected = (page) =>
  page.evaluate(() => {
    const { viewer } = window.cohort;
    return [...viewer.chosen.selection].map((entity) => viewer.poses.scene.entities[entity].name);
  });

async function showsTheWorldAsATree(page) {
  await onDesktop(page);
  await drawCoarsely(page);
  await run(page, "pause; seek 2");
  assert.equal((await rows(page))[0], "explorers");
  await page.locator("#wanted").fill("sbot_12");
  await until(page, () => document.querySelectorAll("#tree [role=treeitem]").length === 2);
  await page.keyboard.press("Enter");
  assert.deepEqual(await selected(page), ["explorers/sbot_12"]);
  await page.locator("#wanted").fill("");
  await until(page, () => document.querySelectorAll("#tree [role=treeitem]").length > 16);

  // By the keys: the team, all of it, and one robot less.
  await page.locator("#tree").focus();
  await page.keyboard.press("Home");
  await page.keyboard.press("Enter");
  assert.equal((await selected(page)).length, 16);
  assert.match(await text(page, "group"), /^16 robots \(sbot\)/);
  await page.locator("#tree [data-row='1']").click({ modifiers: ["Control"] });
  assert.equal((await selected(page)).length, 15);
  await press(page.locator("#tree [data-row='1']"));
  await page.locator("#tree [data-row='4']").click({ modifiers: ["Shift"] });
  const four = ["sbot_0", "sbot_1", "sbot_2", "sbot_3"].map((name) => `explorers/${name}`);
  assert.deepEqual(await selected(page), four);

  // The camera follows the middle of them.
  await run(page, "follow");
  const beside = await page.evaluate(() => {
    const { viewer } = window.cohort;
    viewer.draw(performance.now() + 1000);
    const places = [...viewer.chosen.selection].map((entity) => viewer.poseOf(entity).position);
    const mean = [0, 1].map((axis) => places.reduce((sum, place) => sum + place[axis], 0) / places.length);
    return Math.hypot(viewer.cameras.target.x - mean[0], viewer.cameras.target.y - mean[1]);
  });
  assert.ok(beside < 1e-3, `the camera looks ${beside} m beside the middle`);

  // Hidden robots are not drawn, also after a step.
  await press(page.locator("#isolate"));
  const shown = () =>
    page.evaluate(() => {
      const { viewer } = window.cohort;
      return viewer.robotEntities().filter((entity) => !viewer.poses.absent.has(entity)).length;
    });
  assert.equal(await shown(), 4);
  await run(page, "step");
  assert.equal(await shown(), 4);
  await press(page.locator("#hide"));
  assert.equal(await shown(), 0);
  assert.deepEqual(await selected(page), []);
  await press(page.locator("#show-all"));
  assert.equal(await shown(), 16);
}

// Mean, spread and sum of a channel are those of the robots.
async function tellsOfMany(page) {
  await onDesktop(page);
  await run(page, "pause; seek 3");
  await press(page.locator("#tree [data-row='0']"));
  const cells = await until(page, () => {
    const row = [...document.querySelectorAll("#group tr")].find((each) =>
      each.textContent.startsWith("treel/left/velocity"),
    );
    const cells = row && [...row.cells].slice(1);
    return cells?.map((cell) => ({ shown: Number(cell.textContent), exact: Number(cell.title) }));
  });
  const values = await page.evaluate(() => {
    const { viewer } = window.cohort;
    return viewer.robots.map((robot) => {
      const { observation } = viewer.poses.scene.models[viewer.chosen.selectedEntity.model];
      let at = 0;
      for (const { name, size } of observation) {
        if (name === "treel/left/velocity") break;
        at += size;
      }
      return robot.observation[at];
    });
  });
  assert.equal(values.length, 16);
  const sum = values.reduce((total, each) => total + each, 0);
  const mean = sum / 16;
  const spread = Math.sqrt(values.reduce((total, each) => total + (each - mean) ** 2, 0) / 16);
  for (const [i, wanted] of [mean, spread, sum].entries())
    for (const [kind, share] of [
      ["shown", 5e-3],
      ["exact", 1e-6],
    ])
      assert.ok(
        Math.abs(cells[i][kind] - wanted) <= share * Math.abs(wanted) + 1e-9,
        `${cells[i][kind]} for ${wanted}`,
      );
  const overflow = await page.evaluate(() => {
    const { scrollWidth, clientWidth } = document.getElementById("about");
    return scrollWidth - clientWidth;
  });
  assert.equal(overflow, 0, "the table is wider than its panel");

  // The legend of many lines names the first ones, and all of them in its tooltip.
  await run(page, "plot treel/left/velocity; plot treel/right/velocity");
  const legend = await until(page, () => {
    const more = document.querySelector(".plot-more");
    return more
      ? { entries: more.parentElement.children.length, title: more.title, text: more.textContent }
      : undefined;
  });
  assert.equal(legend.entries, 9);
  assert.equal(legend.title.split("\n").length, 24);
  assert.match(legend.text, /^and 16 more: sbot_8 /);
}

// Values fill the inspector down to its lower edge when the dock is closed.
async function usesTheHeight(page) {
  await onDesktop(page);
  await run(page, "pause; select sbot_3");
  const dock = page.locator('[data-panel="dock"]');
  if ((await dock.getAttribute("aria-pressed")) === "true") await press(dock);
  const below = await until(page, () => {
    if (document.querySelectorAll("#values tr").length === 0) return undefined;
    const bottom = (id) => document.getElementById(id).getBoundingClientRect().bottom;
    return { gap: bottom("right") - bottom("values") };
  });
  assert.ok(below.gap >= 0 && below.gap < 20, `${below.gap} pixels are free below the values`);
}

// No finding of axe in any state, in both themes. Buttons get their event directly: a click by the mouse waits for two
// frames, which take minutes on a busy machine without a graphics card.
async function isAccessible(page) {
  await onDesktop(page);
  await drawCoarsely(page);
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.evaluate(axeSource);
  const check = async (state) => {
    const findings = await page.evaluate(async () => {
      const { violations } = await window.axe.run(document, { resultTypes: ["violations"] });
      return violations.flatMap(({ id, nodes }) => nodes.map(({ target }) => `${id}: ${target}`));
    });
    assert.deepEqual(findings, [], state);
  };
  await run(page, "pause; seek 1");
  for (const theme of ["light", "dark"]) {
    await run(page, `theme ${theme}; deselect`);
    await check(`${theme}, nothing selected`);
    await run(page, "select sbot_3; plot proximity/0/reading");
    for (const tab of ["plotting", "events", "console"]) {
      const button = page.locator(`[data-tab="${tab}"]`);
      if ((await button.getAttribute("aria-pressed")) === "false") await button.dispatchEvent("click");
      await check(`${theme}, ${tab}`);
    }
    await page.locator("#tree").focus();
    await page.keyboard.press("Home");
    await page.keyboard.press("Enter");
    await check(`${theme}, a team selected`);
    await run(page, "keys");
    await check(`${theme}, keys`);
    await page.keyboard.press("Escape");
    await page.locator("#more").dispatchEvent("click");
    await check(`${theme}, details`);
    await page.locator("#more").dispatchEvent("click");
  }
  assert.match(await text(page, "seen"), /At 1\.0 s: 16 robots of team explorers.*Selected: explorers\/sbot_0/);
  await page.setViewportSize(phone);
  await check("phone");
}

// A run of two seconds that begins paused and may be controlled.
async function runsAgain(page) {
  const ended = () => until(page, () => document.getElementById("phase").innerText.includes("The run has finished"));
  const lastTick = () =>
    until(page, () => /200 ticks, state hash [0-9a-f]{16}/.test(document.getElementById("phase-text").textContent));
  await run(page, "play");
  await ended();
  await lastTick();
  const card = await text(page, "phase-text");
  assert.equal(await text(page, "phase-word"), "■ finished");
  await press(page.locator("#again"));
  await until(page, () => document.getElementById("phase").hidden);
  await until(page, () => document.getElementById("phase-word").textContent === "❚❚ paused");
  await run(page, "play");
  await ended();
  await lastTick();
  assert.equal(await text(page, "phase-text"), card);
}

await runScenario({
  nothing_overlaps: nothingOverlaps,
  panels_are_kept: panelsAreKept,
  works_on_a_phone: worksOnAPhone,
  shows_the_world_as_a_tree: showsTheWorldAsATree,
  tells_of_many: tellsOfMany,
  uses_the_height: usesTheHeight,
  is_accessible: isAccessible,
  runs_again: runsAgain,
});
