// Run a Python script in WebAssembly: node run.mjs PYODIDE CHECKOUT SCRIPT
// The checkout is the folder /mars2d of its file system. `load(names)` loads packages.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { join, resolve } from "node:path";

const [pyodideFolder, checkout, script] = process.argv.slice(2).map((name) => resolve(name));
const { loadPyodide } = await import(pathToFileURL(join(pyodideFolder, "pyodide.mjs")).href);
const python = await loadPyodide({ indexURL: pyodideFolder + "/" });
python.FS.mkdirTree("/mars2d");
python.FS.mount(python.FS.filesystems.NODEFS, { root: checkout }, "/mars2d");
python.globals.set("load", (names) =>
  python.loadPackage(names.split(" "), { messageCallback() {}, errorCallback: console.error }),
);
await python.runPythonAsync(readFileSync(script, "utf-8"));
