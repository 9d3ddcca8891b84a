"""A small network in an ONNX file, with the spaces of an environment, for tests."""

import json

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper


def save_policy(path, metadata, action=(0.5, 0.0), size=None, outputs=2):
    """Write a network that always returns `action`, plus nothing of what it sees."""
    if size is None:
        given = json.loads(metadata)
        size = sum(len(part["low"]) for part in given["observation"])
    weight = np.zeros((size, outputs), np.float32)
    bias = np.resize(np.array(action, np.float32), outputs)
    graph = helper.make_graph(
        [helper.make_node("Gemm", ["observation", "w", "b"], ["action"])],
        "policy",
        [helper.make_tensor_value_info("observation", TensorProto.FLOAT, [1, size])],
        [helper.make_tensor_value_info("action", TensorProto.FLOAT, [1, outputs])],
        [numpy_helper.from_array(weight, "w"), numpy_helper.from_array(bias, "b")],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    if metadata is not None:
        helper.set_model_props(model, {"mars2d": metadata})
    onnx.save(model, path)
    return path
