// SPDX-License-Identifier: Apache-2.0

// Takes the pictures of the page that docs/view.md shows, as PNG files: node pictures.mjs COHORT FOLDER. See
// tools/dev/make-view-pictures.
import { join } from "node:path";
import { chromium } from "playwright-core";
import { look, run, until } from "./in_page.mjs";
import { record, serve } from "./recorded.mjs";

const [, , cohort, folder] = process.argv;
const desktop = { width: 1440, height: 900 };
const phone = { width: 390, height: 844 };
const pictures = [
  {
    name: "view_light",
    example: "obstacle_avoidance",
    duration: 30,
    size: desktop,
    lines: "theme light; seek 20; select sbot_3; plot → treel/left/velocity",
    from: [-2.3, -2.5, 2.2],
    to: [0, -0.15, 0],
  },
  {
    name: "view_dark",
    example: "retrieval",
    duration: 40,
    size: desktop,
    lines: "theme dark; seek 24; select sbot_3",
    from: [0.1, -0.7, 0.5],
    to: [0.75, 0, 0.07],
  },
  {
    name: "view_phone",
    example: "obstacle_avoidance",
    duration: 30,
    size: phone,
    lines: "theme light; seek 20; select sbot_3; panel right",
  },
];

async function take(browser, address, { name, duration, size, lines, from, to }) {
  const page = await browser.newPage({ viewport: size });
  await page.goto(address);
  await until(page, () => window.cohort?.viewer.poses?.frame);
  await page.evaluate(() => Object.assign(window.cohort.viewer.stage.quality, { level: 0, isHeld: true }));
  await run(page, `pause; ${lines}`);
  await until(
    page,
    (end) => {
      const plotted = window.cohort.plots.lines();
      return plotted.length > 0 && plotted.every(({ curve }) => curve.times.at(-1) === end);
    },
    duration,
  );
  if (from) await look(page, from, to);
  await page.evaluate(() => window.cohort.viewer.draw(performance.now() + 1000));
  await page.screenshot({ path: join(folder, `${name}.png`) });
  await page.close();
}

const browser = await chromium.launch({
  executablePath: process.env.COHORT_CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-quic", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
try {
  for (const picture of pictures) {
    const file = record(cohort, picture.example, join(folder, `${picture.example}.mcap`), [
      "--duration",
      `${picture.duration}`,
    ]);
    const { view, address } = await serve(cohort, file);
    await take(browser, address, picture);
    view.kill();
  }
} finally {
  await browser.close();
}
