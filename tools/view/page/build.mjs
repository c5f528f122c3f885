// SPDX-License-Identifier: Apache-2.0

// Checks and bundles the page: node build.mjs FOLDER
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const folder = process.argv[2];
if (!folder) throw new Error("usage: build.mjs FOLDER: the folder for the built page");

const { status } = spawnSync(process.execPath, ["node_modules/typescript/bin/tsc", "--noEmit"], { stdio: "inherit" });
if (status !== 0) process.exit(1);
mkdirSync(folder, { recursive: true });
const { metafile } = await build({
  entryPoints: { page: "src/main.ts" },
  outdir: folder,
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "eof",
  logLevel: "warning",
  metafile: true,
});
writeFileSync(`${folder}/notices.txt`, noticesOf(metafile));
copyFileSync("src/index.html", `${folder}/index.html`);

// The licenses of the npm packages from which the bundle contains code.
function noticesOf({ inputs }) {
  const packages = new Set(
    Object.keys(inputs).flatMap((input) => input.match(/^node_modules\/((?:@[^/]+\/)?[^/]+)\//)?.[1] ?? []),
  );
  const notices = [...packages].sort().map((name) => {
    const root = `node_modules/${name}`;
    const { version, license } = JSON.parse(readFileSync(`${root}/package.json`, "utf8"));
    const file = readdirSync(root).find((each) => /^licen[cs]e/i.test(each));
    const text = file ? readFileSync(`${root}/${file}`, "utf8").trim() : `License: ${license}`;
    return `${name} ${version}\n\n${text}\n`;
  });
  const line = "-".repeat(80);
  return `The page of cohort view contains code of these packages.\n\n${line}\n${notices.join(`\n${line}\n`)}`;
}
