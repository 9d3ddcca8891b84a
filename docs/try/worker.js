// Python, in a thread of its own so that the page answers while an experiment runs.
let python;

const say = (kind, more) => postMessage({ kind, ...more });

async function start({ pyodide, wheel }) {
  say("state", { text: "Loading Python" });
  const { loadPyodide } = await import(pyodide + "pyodide.mjs");
  python = await loadPyodide({ indexURL: pyodide });
  const known = python.lockfile ? python.lockfile.packages : {};
  const quiet = { messageCallback() {} };
  say("state", { text: "Loading numpy, scipy and the engine" });
  const wanted = ["numpy", "scipy", "shapely", "cffi", "pymunk"].filter((name) => name in known);
  await python.loadPackage(wanted, quiet);
  if (!("pymunk" in known)) {
    await python.loadPackage("micropip", quiet);
    await python.runPythonAsync(`import micropip\nawait micropip.install("pymunk>=7.1,<8")`);
  }
  await python.loadPackage(wheel, quiet);
  await python.runPythonAsync(await (await fetch("inside.py")).text());
  say("ready", { examples: python.globals.get("names")().toJs() });
}

function call(name, ...given) {
  return JSON.parse(python.globals.get(name)(...given));
}

onmessage = async ({ data }) => {
  try {
    if (data.kind === "start") await start(data);
    if (data.kind === "example") say("code", call("source", data.name));
    if (data.kind === "read") say("parameters", call("parameters", data.code, data.name));
    if (data.kind === "run") {
      say("state", { text: "Running" });
      python.globals.set("progress", (share) => say("progress", { share }));
      say("done", call("run", data.code, data.name, JSON.stringify(data.options)));
    }
  } catch (error) {
    say("failed", { text: String(error.message || error).trim().split("\n").pop() });
  }
};
