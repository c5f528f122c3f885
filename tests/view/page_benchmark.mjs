// SPDX-License-Identifier: Apache-2.0

// Measures how long the page takes to show its first picture and to draw one, in headless chromium without a graphics
// card, for 16, 1,000 and 10,000 robots. With several folders of pages, they are measured in turn on the same
// recordings.
//
//   cp tests/view/{page_benchmark,recorded}.mjs build/release/tests/view/node  # npm packages: `tools/test -R Layout`
//   node build/release/tests/view/node/page_benchmark.mjs COHORT PAGE...
//
// COHORT is the program, and each PAGE a folder with page.js, page.css and index.html.
import { mkdtempSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";
import { record, serve } from "./recorded.mjs";

const [, , cohort, ...pages] = process.argv;
if (!cohort || pages.length === 0) {
  console.error("usage: node page_benchmark.mjs COHORT PAGE...");
  process.exit(2);
}
const rounds = 5;
const pictures = 7;
const folder = mkdtempSync(join(tmpdir(), "cohort-page-"));
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
const middleOf = (values) =>
  `${median(values).toFixed(0)} ms (${Math.min(...values).toFixed(0)} to ${Math.max(...values).toFixed(0)})`;

function recorded(count) {
  const side = Math.sqrt(count) * 0.3;
  const file = join(folder, `${count}.mcap`);
  writeFileSync(
    join(folder, "world.yaml"),
    `world:
  name: field
  model: {name: ground, static: true, link: {name: body, collision: {name: floor, geometry: {plane: {normal: [0, 0, 1], size: [3, 3]}}}}}
  cohort:physics: {fidelity: planar}
  cohort:population:
    - {name: robots, uri: model://sbot, count: ${count}, placement: {uniform: {min: [-${side}, -${side}], max: [${side}, ${side}]}, gap: 0.05}}
`,
  );
  writeFileSync(
    join(folder, "experiment.yaml"),
    `world: world.yaml
duration: 0.5
teams:
  - {name: all, robots: robots/*, controller: obstacle_avoidance}
`,
  );
  return record(cohort, join(folder, "experiment.yaml"), file);
}

/** In the page: `window.firstPicture` is the time from the request of the page to its first picture with bodies [ms]. */
function tellOfTheFirstPicture() {
  let cohort;
  Object.defineProperty(window, "cohort", {
    get: () => cohort,
    set: (value) => {
      cohort = value;
      const { viewer } = value;
      if (viewer.stage.quality) viewer.stage.quality.isHeld = true;
      const draw = viewer.draw.bind(viewer);
      viewer.draw = (now) => {
        draw(now);
        if (!viewer.poses?.frame || window.firstPicture) return;
        const gl = viewer.stage.renderer.getContext();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits for the picture
        window.firstPicture = performance.now();
      };
    },
  });
}

/** Time from the request of the page to its first picture with robots, and of later pictures [ms]. */
async function measure(address, page) {
  const browser = await chromium.launch({
    executablePath: process.env.COHORT_CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-quic", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  try {
    // Chromium does not know that the replaced files come from this machine, so it would refuse their connection to it.
    const permissions = ["local-network-access"];
    const tab = await browser.newPage({ viewport: { width: 1440, height: 900 }, permissions });
    for (const [name, path] of [
      ["page.js", "**/page.js"],
      ["page.css", "**/page.css"],
      ["index.html", address],
    ])
      await tab.route(path, (route) => route.fulfill({ path: join(page, name) }));
    await tab.addInitScript(tellOfTheFirstPicture);
    await tab.goto(address);
    const limit = { timeout: 300_000, polling: 20 };
    const first = await (await tab.waitForFunction(() => window.firstPicture, null, limit)).jsonValue();
    const draw = await tab.evaluate(async (count) => {
      const { viewer, run } = window.cohort;
      await run("pause");
      const { renderer } = viewer.stage;
      renderer.setPixelRatio(1);
      renderer.setSize(1440, 900, false); // the same number of pixels beside any panels
      const gl = renderer.getContext();
      const pixel = new Uint8Array(4);
      const times = [];
      for (let i = 0; i < count; ++i) {
        viewer.stage.isShadowStale = true; // as if bodies had moved
        const from = performance.now();
        viewer.draw(from + 1000);
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits for the picture
        times.push(performance.now() - from);
      }
      return times;
    }, pictures);
    return { first, draw: median(draw) };
  } finally {
    await browser.close();
  }
}

try {
  for (const page of pages)
    console.log(`${page}: page.js has ${(statSync(join(page, "page.js")).size / 1000).toFixed(0)} kB`);
  for (const count of [16, 1000, 10_000]) {
    const { view, address } = await serve(cohort, recorded(count));
    const results = new Map(pages.map((page) => [page, []]));
    for (let round = 0; round < rounds; ++round)
      for (const page of pages) results.get(page).push(await measure(address, page));
    view.kill();
    for (const [page, found] of results) {
      const [first, draw] = ["first", "draw"].map((name) => middleOf(found.map((each) => each[name])));
      console.log(`${count} robots, ${page}: first picture after ${first}, a picture in ${draw}`);
    }
  }
} finally {
  rmSync(folder, { recursive: true });
}
