// Checks and bundles the page: node build.mjs FOLDER
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync } from "node:fs";
import { build } from "esbuild";

const folder = process.argv[2];
if (!folder) throw new Error("usage: build.mjs FOLDER: the folder for the built page");

const { status } = spawnSync(process.execPath, ["node_modules/typescript/bin/tsc", "--noEmit"], { stdio: "inherit" });
if (status !== 0) process.exit(1);
mkdirSync(folder, { recursive: true });
await build({
  entryPoints: { page: "src/main.ts" },
  outdir: folder,
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "eof",
  logLevel: "warning",
});
copyFileSync("src/index.html", `${folder}/index.html`);
