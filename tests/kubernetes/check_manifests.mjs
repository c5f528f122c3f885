// SPDX-License-Identifier: Apache-2.0

// check_manifests.mjs FILE...: checks Kubernetes manifests against Kubernetes' own schemas. Values by their validators; keys that
// there are none of by their types, as TypeScript does. Prints what is wrong; exit code 1 if anything is.
import { readFileSync, writeFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import ts from "typescript";
import { parseAllDocuments } from "yaml";

const here = dirname(fileURLToPath(import.meta.url));
const problems = [];

async function checkValues(where, object, modules) {
  const models = await import(modules);
  try {
    new models[object.kind](object).validate();
  } catch (error) {
    problems.push(`${where}: ${error.message}`);
  }
}

function checkKeys(where, object, modules) {
  const file = join(here, `${basename(where)}.ts`);
  const type = `I${object.kind}`;
  writeFileSync(
    file,
    `import type { ${type} } from "${modules}";\nexport const manifest: ${type} = ${JSON.stringify(object, null, 1)};\n`,
  );
  const program = ts.createProgram([file], {
    strict: true,
    noEmit: true,
    skipLibCheck: true,
    types: [],
    module: ts.ModuleKind.NodeNext,
    moduleResolution: ts.ModuleResolutionKind.NodeNext,
    target: ts.ScriptTarget.ES2022,
  });
  for (const found of ts.getPreEmitDiagnostics(program))
    problems.push(`${where}: ${ts.flattenDiagnosticMessageText(found.messageText, " ")}`);
}

let count = 0;
for (const file of process.argv.slice(2)) {
  for (const document of parseAllDocuments(readFileSync(file, "utf8"))) {
    problems.push(...document.errors.map((error) => `${file}: ${error.message}`));
    const object = document.toJS();
    const modules = `kubernetes-models/${object.apiVersion}`;
    await checkValues(file, object, modules);
    checkKeys(file, object, modules);
    ++count;
  }
}
console.log(problems.length === 0 ? `${count} objects are right` : problems.join("\n"));
process.exitCode = problems.length === 0 ? 0 : 1;
