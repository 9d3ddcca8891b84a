"""The examples: short enough to project, and the same to the last bit from run to run."""

import os
import platform
import subprocess
import sys
from importlib.metadata import version

import numpy as np
import pytest

import mars2d
from mars2d.scenario.examples import examples
from tests.cases import each_case
from tests.house.make_golden import SETTINGS, Golden

# Another platform or engine may round the last digit differently: it is held to the golden paths.
DIGESTS = {
    "billiards": "5174d61a96c180f2db0f8fb6d3a3bf401e77d59422856fc1811b87c947037aab",
    "braitenberg": "87804438a3865c4466e963f107cfd825f9b9bb0092b048a310858c106294aa81",
    "capture_the_flag": "800380d3fb78fabff1a0f8c05f7b7db96444b13b7c197fd63a89e0e07dedbc02",
    "circular_motion": "37825f087ce753c11560d07c71f892c0aa4026ef6ad1eaf9aba1b0cf487dec43",
    "corner_game": "2d170d696cca7a0eae66291c4b00d326d01b486f4f350d620106234308bb4542",
    "coverage_circle": "596acc7a184871823bce70a781245f4c2de25b4853d2309b82e66df9decc0483",
    "coverage_square": "57f72ebfaae46d6723d284d59feb30ef9cf28457281734b9117eb5a7420ace1c",
    "crowd": "af99c02d60e4ae8cb194cffb4e59d3cb80820b4783071a1a47dbad7eb4856ea5",
    "cyclic_pursuit": "f5094c1b99680685462546b1f842f1c9ac97eb65784522796e2888698384024e",
    "dead_reckoning": "9041bd74f76dce7a948830dc2fa57402320e8bdf63a31ea78a370c7aaf39995e",
    "encirclement": "071078e785597e87d32820d92e2c6f8b247cb8016175bfa08289ea8c3012c9c0",
    "escort": "7bb386c4cc8848a42a6e44a09d63b045d90bf2ac3395a1cb2f433ef204e79d1c",
    "flocking": "4aa8761ffa455499a6ebabd07e9358b7eba282a2a6181bb31bddb1c01596e025",
    "follow_the_leader": "4ffa023dff13eced025b127cd647057f62c1c1ad862cdd3c1a198a822aca99b5",
    "formation": "af7d2b2c756cec2fbd96b1d1b35e95cb25ec231929332d0538293c76b22f728f",
    "go_to_point": "574bc90f7793774871a9873b22220d51dccce04fa3d058b0759611d4c26097a3",
    "guard_the_line": "4adebb7816b7bd68058ef5268eddc18061ed84545cd992635c8fbaf944edb64f",
    "head_on": "a6894bbfd2ca1f794e45fb44f92831e573ed5bc653ea0df9a51b6f2c2baff06f",
    "herding": "5e93f99fa3f0e60142c2f6e4294c277818827c686899f3a52067ada3c59517bf",
    "hide_and_seek": "b9448f5189c1ae4f7db18b567f22b3379e471cf4272387260b3fe89d15973d8f",
    "homicidal_chauffeur": "a52fa2ea6e1041b2fc3ffb4129e6966c4a1f41072638bb7dc3d404421010ec1f",
    "leader_following": "00bb595bb196f2b4b005844cae6e8255d95c52d01c09cc5b02c37601105dd07e",
    "lion_and_man": "24de2361ac607b75189d7ef7c56a5ac3243d9adbf422834d69bca70b5d2b3817",
    "many_push_one": "ea375f1256e553a1ff4f741333a20ba196c84df924e92765326024e76010dfa0",
    "material_pairs": "3235915af4d65b0335b8a4c965db030c96a4b0b48fdd3d1420e5ba5cca167fce",
    "obstacle_avoidance": "a28f2d9204f853475de38c4112c2428a89121811b83eb61a9733943949cefaaf",
    "own_sensor_and_addon": "4d181254e01011e4e5d9419feaaa03abb077c8965576928150c972f33c96b0a3",
    "path_planning": "e6481b5473be9d60c77868191116290bd544079575cbd3a9bcba2e3686d019f0",
    "plan_push": "ea2e811c0be886a5416e9ec5298f5f4a4b1f0f3aaa173884cc16074b89fab84b",
    "pursuit_corners": "b597ab1237fb29760b7f546cd9ee403d31e11e96d0ef69448617d13a653159b6",
    "pursuit_voronoi": "f1c35f7703847496a12271a089ca9060e89e6811b245eb8d25f5d4160d464598",
    "push_box": "851f48126ea47bb4b0d4009c352f207c536be40d619c341066d1d2ec509c47a1",
    "random_walk": "ffb70a801e42c014ca8515070a4e78d24e72d534b05bcb77249969a2cbec24b7",
    "rendezvous": "e6d6cdb7ab189f90a86169dfea16b87e34b4e3311cbc088de759d2d6ec47ffb0",
    "round_a_pillar": "da04d4f4dd9b4b3c4557c8961b34b0965248bf7b73932287219d7171e94bc0fd",
    "selfish_herd": "a0d15f1e53680d8da0c8a6f5cc51574e12b0671f2d7a3061987075cfd6e3616d",
    "shove_and_spin": "4ca1823afc8d291658e7356082a356f58942f6de074e56cfe9b8cf5ebfe333c5",
    "stick_slip": "166b40892afbe50af38f937579571ae51596b7754a1d28136d59252d83f5e7cf",
    "straight_chase": "64e1fadd0dcdf6657fc8987c5f241ae492b092a70b8ea04b57b134e53c202237",
    "sumo": "8b574e2913d7edfc0e87bd235d2c10c91557743a5cfe48c776b264470d6c4e4d",
    "token_ring": "fd0102826b144941b5497e70ed2e62bb04409ed5915da6df921b6503c9f36a91",
    "tug_of_war": "117dfe8010479abb2ace8f84c2c2d50aff2444a15e59c34899a834681abbde16",
    "two_cars": "2d3d8d901e8fb1a38d5ced152511978186ecc634f30a22f8e62228707888cc1d",
    "wall_follower": "fec077dc650fba352ff1ea62097e95f4d4a574fc8b1a3c58464afe03f1056625",
    "wall_slide": "c7725e905d62239b898de12e189c0af8c53933997c47fd82f93aa45353768642",
}
ON_THE_PINNED_PLATFORM = (
    sys.platform == "linux"
    and platform.machine() == "x86_64"
    and platform.libc_ver()[0] == "glibc"
    and version("pymunk").startswith("7.3.")
)


def test_every_example_is_pinned():
    assert set(examples()) == set(DIGESTS)


SLOW = {
    "circular_motion", "coverage_square", "dead_reckoning", "flocking", "homicidal_chauffeur",
    "obstacle_avoidance", "plan_push", "pursuit_corners", "pursuit_voronoi", "two_cars",
    "wall_follower",
}  # fmt: skip
"""Examples that take most of a second and more."""


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=[pytest.mark.slow] if n in SLOW else []) for n in DIGESTS],
)
def test_an_example_goes_its_golden_way_and_where_digests_are_pinned_has_its_own(name):
    record = mars2d.run(name)
    if ON_THE_PINNED_PLATFORM:
        assert record.digest == DIGESTS[name]
    settings = SETTINGS.get(name)
    if settings is not None:
        record = mars2d.run(name, options=settings)
    assert Golden.read(name).excess(record) < 1


@pytest.mark.nightly
def test_older_processors_give_the_same_digests():
    """numpy picks its routines by processor; here those of older ones, as far as there are any."""
    from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

    newer = [name for name in __cpu_dispatch__ if __cpu_features__.get(name)]
    if not newer:
        pytest.skip("numpy has only one set of routines for this processor")
    code = f"import mars2d; print(*[mars2d.run(n).digest for n in {list(DIGESTS)}])"

    def digests(**extra: str) -> list[str]:
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", code],
            env=os.environ | extra, capture_output=True, text=True, check=True,
        )  # fmt: skip
        return done.stdout.split()

    # Where they are pinned, the test above has seen those of this processor.
    here = [*DIGESTS.values()] if ON_THE_PINNED_PLATFORM else digests()
    assert digests(NPY_DISABLE_CPU_FEATURES=" ".join(newer)) == here


@each_case("name", DIGESTS)
def test_an_example_is_short_enough_to_project(name):
    lines = examples()[name].read_text().splitlines()
    assert len(lines) <= 70
    assert max(map(len, lines)) <= 100
    assert lines[0].startswith('"""')


def test_random_walk_is_the_papers_algorithm_2():
    record = mars2d.run("random_walk")
    assert record.time[-1] == 1000.0
    assert record.scenario.initial_pose.T.tolist() == [[1, 3, 0], [9, 7, np.pi]]
    seen, command = record.sensors["proximity"], record.command
    for robot in (0, 1):
        for k in range(1, len(record)):
            v, omega = command[k, :, robot]
            if seen[k, robot]:
                assert (v, omega) == (-0.2, 0.0)
            elif command[k - 1, 0, robot] < 0:
                assert v == 0.0
                assert np.pi / 2 <= omega <= 3 * np.pi / 2
            else:
                assert (v, omega) == (0.2, 0.0)
    assert seen.any(axis=0).all()
