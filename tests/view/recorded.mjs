// SPDX-License-Identifier: Apache-2.0

// Recordings and views of them, for programs that measure or photograph the page.

import { spawn, spawnSync } from "node:child_process";

/** Records a run of `experiment` with more options to `file`, and returns `file`. */
export function record(cohort, experiment, file, options = []) {
  const run = ["run", experiment, ...options, "--controllers", "inprocess", "--record", file, "--quiet"];
  const { status, stderr } = spawnSync(cohort, run, { encoding: "utf8" });
  if (status !== 0) throw new Error(stderr);
  return file;
}

/** Serves a page of the recording; returns the process and its address. */
export async function serve(cohort, file) {
  const view = spawn(cohort, ["view", file, "--port", "0"]);
  let said = "";
  view.stdout.setEncoding("utf8");
  for await (const text of view.stdout) {
    said += text;
    if (said.includes("\n")) break;
  }
  return { view, address: said.trim() };
}
