"""Train a robot by PPO, draw its learning curve, and keep it as a law in an ONNX file.

    python train.py mars2d/Pursuit-v0 --steps 300000

Needs: pip install "mars2d[rl]" stable-baselines3 onnx
Source of the method: J. Schulman and others, Proximal Policy Optimization Algorithms (2017).
"""

import argparse
from pathlib import Path

import gymnasium
import matplotlib.pyplot as plt
import numpy as np
import onnx
import torch
from gymnasium.wrappers import RescaleObservation
from onnx import TensorProto, helper, numpy_helper
from stable_baselines3 import PPO
from stable_baselines3.common.env_util import make_vec_env

import mars2d.rl

gymnasium.register_envs(mars2d.rl)  # the import registers them; this line does no more than say so


def rescaled(environment):
    return RescaleObservation(environment, np.float32(-1), np.float32(1))


def layers_of(policy, space):
    """Return weights and biases of the network, which takes the observation without scaling."""
    network = [*policy.mlp_extractor.policy_net, policy.action_net]
    linear = [layer for layer in network if isinstance(layer, torch.nn.Linear)]
    layers = [
        [p.detach().cpu().numpy().astype(float) for p in layer.parameters()] for layer in linear
    ]
    scale = 2.0 / (space.high.astype(float) - space.low)
    weight, bias = layers[0]
    layers[0] = [weight * scale, bias + weight @ (-1.0 - scale * space.low)]
    return layers


def export(policy, environment, path):
    """Write the network, tanh between its layers, with the spaces of the environment."""
    layers = layers_of(policy, environment.observation_space)
    nodes, numbers, last = [], [], "observation"
    for k, (weight, bias) in enumerate(layers):
        for name, values in ((f"w{k}", weight), (f"b{k}", bias)):
            numbers.append(numpy_helper.from_array(values.astype(np.float32), name))
        end = "action" if k == len(layers) - 1 else f"h{k}"
        nodes.append(helper.make_node("Gemm", [last, f"w{k}", f"b{k}"], [end], transB=1))
        if end != "action":
            nodes.append(helper.make_node("Tanh", [end], [f"t{k}"]))
        last = f"t{k}"
    size = environment.observation_space.shape[0]
    row = [helper.make_tensor_value_info("observation", TensorProto.FLOAT, [1, size])]
    command = [helper.make_tensor_value_info("action", TensorProto.FLOAT, [1, 2])]
    graph = helper.make_graph(nodes, "policy", row, command, numbers)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    helper.set_model_props(model, {"mars2d": environment.policy_metadata})
    onnx.save(model, path)


def draw(curve, name, path):
    """Draw the mean return of the last hundred episodes over the steps."""
    steps, returns = np.array(curve).T
    figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
    axes.plot(steps / 1e3, returns, color="#0072b2")
    axes.set(xlabel="steps [thousand]", ylabel="return, mean of 100 episodes", title=name)
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=100)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("environment", nargs="?", default="mars2d/Pursuit-v0")
    parser.add_argument("--steps", type=int, default=300_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, help="the file of the law; the curve lies beside it")
    given = parser.parse_args()
    name = given.environment.removeprefix("mars2d/").partition("-")[0].lower()
    out = given.out or Path(f"{name}.onnx")

    torch.set_num_threads(1)
    worlds = make_vec_env(given.environment, 8, seed=given.seed, wrapper_class=rescaled)
    model = PPO(
        "MlpPolicy", worlds, n_steps=512, batch_size=512, gamma=0.99, ent_coef=0.0,
        learning_rate=1e-3, seed=given.seed, device="cpu",
        policy_kwargs={"net_arch": [32, 32], "log_std_init": -0.5},
    )  # fmt: skip
    curve = []

    def note(values, _):
        episodes = values["self"].ep_info_buffer
        if episodes:
            curve.append((values["self"].num_timesteps, np.mean([e["r"] for e in episodes])))
            if len(curve) % 4096 == 0:
                print(f"{curve[-1][0]:8d} steps: return {curve[-1][1]:.2f}", flush=True)
        return True  # to go on

    model.learn(given.steps, callback=note)
    environment = gymnasium.make(given.environment).unwrapped
    export(model.policy, environment, out)
    draw(curve[::512] + curve[-1:], given.environment, out.with_suffix(".png"))
    print(f"{out}: return {curve[-1][1]:.2f} after {given.steps} steps")


if __name__ == "__main__":
    main()
