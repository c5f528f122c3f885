// Measures how long the page takes to show its first picture and to draw one, in headless chromium without a graphics
// card, for 16, 1,000 and 10,000 robots. With several folders of pages, they are measured in turn on the same
// recordings.
//
//   cd build/release/tests/view/node    # after `tools/test -R Layout`, which installs the packages of npm
//   node page_benchmark.mjs COHORT PAGE...
//
// COHORT is the program, and each PAGE a folder with page.js, page.css and index.html.
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const [, , cohort, ...pages] = process.argv;
if (!cohort || pages.length === 0) {
  console.error("usage: node page_benchmark.mjs COHORT PAGE...");
  process.exit(2);
}
const rounds = 5;
const pictures = 21;
const folder = mkdtempSync(join(tmpdir(), "cohort-page-"));
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

function record(count) {
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
  const run = ["run", join(folder, "experiment.yaml"), "--controllers", "inprocess", "--record", file, "--quiet"];
  const { status, stderr } = spawnSync(cohort, run, { encoding: "utf8" });
  if (status !== 0) throw new Error(stderr);
  return file;
}

async function serve(file) {
  const view = spawn(cohort, ["view", file, "--port", "0"]);
  let said = "";
  view.stdout.setEncoding("utf8");
  for await (const text of view.stdout) {
    said += text;
    if (said.includes("\n")) break;
  }
  return { view, address: said.trim() };
}

/** Time from the request of the page to its first picture with robots, and of later pictures [ms]. */
async function measure(address, page) {
  const browser = await chromium.launch({
    executablePath: process.env.COHORT_CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-quic", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  try {
    const tab = await browser.newPage({ viewport: { width: 1440, height: 900 } });
    for (const [name, path] of [
      ["page.js", "**/page.js"],
      ["page.css", "**/page.css"],
      ["index.html", address],
    ])
      await tab.route(path, (route) => route.fulfill({ path: join(page, name) }));
    const begin = performance.now();
    await tab.goto(address);
    await tab.waitForFunction(() => window.cohort?.viewer.poses?.frame && window.cohort.viewer.framesDrawn > 0, null, {
      timeout: 300_000,
      polling: "raf",
    });
    const first = performance.now() - begin;
    const draw = await tab.evaluate(async (count) => {
      const { viewer, run } = window.cohort;
      await run("pause");
      const { renderer } = viewer.stage;
      if (viewer.stage.quality) viewer.stage.quality.isHeld = true;
      renderer.setPixelRatio(1);
      renderer.setSize(1440, 900, false); // the same number of pixels beside any panels
      const gl = renderer.getContext();
      const pixel = new Uint8Array(4);
      const times = [];
      for (let i = 0; i < count; ++i) {
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
    const { view, address } = await serve(record(count));
    const results = new Map(pages.map((page) => [page, []]));
    for (let round = 0; round < rounds; ++round)
      for (const page of pages) results.get(page).push(await measure(address, page));
    view.kill();
    for (const [page, found] of results) {
      const [first, draw] = ["first", "draw"].map((name) => median(found.map((each) => each[name])));
      console.log(
        `${count} robots, ${page}: first picture after ${first.toFixed(0)} ms, a picture in ${draw.toFixed(1)} ms`,
      );
    }
  }
} finally {
  rmSync(folder, { recursive: true });
}
