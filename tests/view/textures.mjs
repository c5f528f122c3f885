// SPDX-License-Identifier: Apache-2.0

// Checks how the page draws the textures in exhibits/textures.yaml.
import assert from "node:assert/strict";
import { look, pixelsAt, run, setShadows, until } from "./in_page.mjs";

/** Checks colours of pixels at each texture, and the number of draw calls. */
export async function drawsTextures(page) {
  await run(page, "pause");
  await until(page, () => window.cohort.viewer.poses?.frame);
  await until(page, () => {
    const { shown, broken } = window.cohort.viewer.textures.counts;
    return shown === 1 && broken === 1;
  });
  await setShadows(page, false);
  const isRed = ([red, green, blue]) => red > 2 * green && red > 2 * blue;
  const isGreen = ([red, green, blue]) => green > 2 * red && green > 2 * blue;
  const isBlue = ([red, green, blue]) => blue > 2 * red && blue > 2 * green;
  const isYellow = ([red, green, blue]) => red > 2 * blue && green > 2 * blue;
  const expectQuarters = async (x, y, z, quarter) => {
    const pixels = await pixelsAt(page, [
      [x - quarter, y, z - quarter],
      [x + quarter, y, z - quarter],
      [x - quarter, y, z + quarter],
      [x + quarter, y, z + quarter],
    ]);
    [isRed, isGreen, isBlue, isYellow].forEach((is, i) => {
      assert.ok(is(pixels[i]), `at x ${x}, the quarters are ${pixels.join(" | ")}`);
    });
  };
  await look(page, [-1, -1.5, 0.25], [-1, 0, 0.25]);
  await expectQuarters(-1, -0.25, 0.25, 0.12);
  await look(page, [0, -1.5, 0.2], [0, 0, 0.2]);
  await expectQuarters(-0.2, 0, 0.2, 0.1);
  const [grey] = await pixelsAt(page, [[0.2, 0, 0.2]]);
  assert.ok(Math.max(...grey) - Math.min(...grey) < 30, `the half without a texture is ${grey}`);
  await look(page, [1, -1.5, 0.25], [1, 0, 0.25]);
  const [plain] = await pixelsAt(page, [[1, -0.25, 0.25]]);
  assert.ok(plain[0] > 2 * plain[1] && plain[2] > 2 * plain[1], `the shape with a broken image is ${plain}`);
  const { meshes, links, shares } = await page.evaluate(() => {
    const { instances, poses } = window.cohort.viewer;
    const sign = poses.scene.models.findIndex(({ name }) => name === "sign");
    const { geometry } = instances.links.find(({ model }) => model === sign);
    return {
      meshes: instances.group.children.length,
      links: instances.links.length,
      shares: [...geometry.getAttribute("teamShare").array].map((share) => share > 0),
    };
  });
  assert.equal(meshes, links + 1, "a draw call for each texture of a link: the sign has two");
  const corners = 6; // in each half of the sign
  assert.deepEqual(
    shares,
    [...Array(corners).fill(false), ...Array(corners).fill(true)],
    "where a team's colour shows",
  );
}
