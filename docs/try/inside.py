"""What the page asks of Python: sources of examples, their parameters, and runs."""

import json

import mars2d
from mars2d.output.pages.replay import page
from mars2d.scenario.examples import examples
from mars2d.scenario.experiment import open_experiment

TEXTS = {name: file.read_text() for name, file in examples().items()}


def names():
    """Return the names of the examples."""
    return list(TEXTS)


def source(name):
    """Return an example's text."""
    return json.dumps({"text": TEXTS[name], "name": name})


def _file(code, name):
    """Return the example's own file, beside its laws and maps, with this code in it."""
    file = examples()[name]
    file.write_text(code)
    return file


def parameters(code, name):
    """Return the parameters of an experiment, as sliders show them."""
    try:
        found = open_experiment(_file(code, name), seed=0).parameters()
    except mars2d.Mars2dError as error:
        return json.dumps({"error": str(error), "found": []})
    keys = ("name", "value", "low", "high", "step", "unit")
    return json.dumps({"found": [{key: getattr(p, key) for key in keys} for p in found]})


def run(code, name, options):
    """Run an experiment, and return its replay and digest, or its error with the line."""
    last = [0]

    def watch(world):
        if world.iteration - last[0] >= 20:
            last[0] = world.iteration
            progress(world.time / world.scenario.stop_time)  # noqa: F821 - set by the worker

    try:
        record = mars2d.run(_file(code, name), options=json.loads(options), watchers=[watch])
    except mars2d.Mars2dError as error:
        record = error.record
        shown = page(record) if record is not None and len(record) > 1 else ""
        return json.dumps({"error": str(error), "page": shown})
    return json.dumps({"page": page(record), "digest": record.digest, "rows": len(record)})
