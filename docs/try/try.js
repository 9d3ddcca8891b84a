"use strict";
const at = (name) => document.getElementById(name);
const asked = new URLSearchParams(location.search);
const given = new URLSearchParams(location.hash.slice(1)).get("code");
const worker = new Worker("worker.js", { type: "module" });
const options = {};
let name = asked.get("example") || "go_to_point";

function state(text, wrong = false) {
  at("state").textContent = text;
  at("state").className = wrong ? "wrong" : "";
}

function busy(is) {
  at("run").disabled = at("examples").disabled = is;
  at("progress").hidden = !is;
  at("progress").value = 0;
}

function read() {
  busy(true);
  worker.postMessage({ kind: "read", code: at("code").value, name });
}

function slider({ name, value, low, high, step, unit }) {
  const label = document.createElement("label");
  const input = Object.assign(document.createElement("input"), { type: "range" });
  const shown = document.createElement("output");
  Object.assign(input, { min: low, max: high, step, value });
  shown.textContent = `${value} ${unit}`;
  input.oninput = () => {
    options[name] = Number(input.value);
    shown.textContent = `${input.value} ${unit}`;
  };
  label.append(name, input, shown);
  return label;
}

const answers = {
  state: ({ text }) => state(text),
  progress: ({ share }) => (at("progress").value = share),
  ready({ examples }) {
    at("examples").append(...examples.map((each) => new Option(each.replaceAll("_", " "), each)));
    if (!examples.includes(name)) name = "go_to_point";
    at("examples").value = name;
    worker.postMessage({ kind: "example", name });
  },
  code({ text }) {
    at("code").value = answers.first && given ? given : text;
    answers.first = false;
    read();
  },
  parameters({ found, error }) {
    for (const key of Object.keys(options)) delete options[key];
    at("sliders").replaceChildren(...found.map(slider));
    busy(false);
    state(error || "Ready", Boolean(error));
  },
  done({ page, error, rows }) {
    busy(false);
    if (page) at("replay").srcdoc = page;
    state(error || `Done: ${rows} rows`, Boolean(error));
  },
  failed({ text }) {
    busy(false);
    state(text, true);
  },
  first: true,
};

worker.onmessage = ({ data }) => answers[data.kind](data);
at("examples").onchange = () => {
  name = at("examples").value;
  busy(true);
  worker.postMessage({ kind: "example", name });
};
at("code").onchange = () => at("run").disabled || read();
at("run").onclick = () => {
  busy(true);
  worker.postMessage({ kind: "run", code: at("code").value, name, options: { ...options } });
};
at("link").onclick = () => {
  const link = new URL(`?example=${name}`, location.href);
  link.hash = new URLSearchParams({ code: at("code").value });
  navigator.clipboard.writeText(link.href);
  state("The link is copied");
};
fetch("settings.json").then(async (answer) => {
  const { pyodide, wheel } = await answer.json();
  const whole = (place) => new URL(place, location.href).href;
  worker.postMessage({ kind: "start", pyodide: whole(pyodide), wheel: whole(wheel) });
});
