"""Words that people write for others: of older simulators, other libraries, or plain speech."""

from __future__ import annotations

_PLACE = "x y theta position positon pos xy orientation heading angle start initialpose location"
_SPEED = "speed maxspeed maxlinearspeed vmax maxv v velocity"
_TURN = "omega maxomega maxangularspeed w wmax angularspeed maxangularvelocity"
_TORUS = "workspace=None, and neighbours=... of your own that takes distances modulo the side"
_COMMAND = "return v, omega: a law returns its command"

_INSTEAD: dict[str, dict[str, str]] = {
    "Robot": {
        _PLACE: "pose=(x, y, theta)",
        "radius r": "diameter=2 * radius",
        "size width length": "shape=Polygon([(x, y), ...]), of mars2d.geometry, or diameter=...",
        _SPEED: "drive=Unicycle(max_linear_speed=...)",
        _TURN: "drive=Unicycle(max_angular_speed=...)",
        "law control controllaw behaviour behavior policy function": "controller=law",
        "wheelssemiaxislength semiaxis wheelbase": "drive=Unicycle(wheel_semiaxis=...)",
        "distancecenterbarycenter": "center_offset=...",
    },
    "Ball": {"radius r size": "diameter=2 * radius"},
    "Puck": {"radius r size": "diameter=2 * radius"},
    "Scenario": {
        "n number numrobots agents": "robots=3, or robots=[Robot(...), ...]",
        "dt ts step timestep stepsize period": "sampling_time=...",
        "t time duration tmax tend endtime maxtime": "stop_time=...",
        "law laws control controller controllers":
            "def control(world) in the file, or controller=law of each Robot",
        "obstacle obstacles wall walls map": "addons=[Map([[(x, y), ...], ...])], of mars2d.addons",
        "bounds arena size world field area width": "workspace=[(x, y), ...], the area's corners",
        "sensor sensors": "Robot(sensors=[...])",
        "initialpose pose poses": "robots=[Robot(pose=p) for p in P.T], with P (3, n)",
        "nonholonomic drive": "Robot(drive=Holonomic()), or Robot(drive=Unicycle())",
        "periodic wrap torus toroidal boundary boundaries periodicboundary": _TORUS,
        "colors colours basecolors": "animation=Animation(base_colors=[...])",
    },
    "Animation": {
        "enable": "speed=1 in mars2d.run(...) for a window; without a speed there is none",
        "color colour colors colours": "base_colors=[...]",
        "title": "Scenario(title=...)",
    },
    "Scenario.on_exit": {"periodic wrap wraparound torus toroidal": _TORUS},
    "Sensor": {
        "distance maxrange reach maxdistance": "range=...",
        "fov angle aperture opening": "field_of_view=...",
    },
    "Drive": {_SPEED: "max_linear_speed=...", _TURN: "max_angular_speed=..."},
    "a robot": {
        "x": "robot.pose[0]",
        "y": "robot.pose[1]",
        "theta heading angle orientation yaw": "robot.pose[2]",
        "speed v vel omega w": "robot.velocity: x', y' [m/s], theta' [rad/s]",
        "dt ts step": "robot.sampling_time",
        "goal target state integral error": "robot.memory: a law keeps things there",
        "stop move setvelocity setspeed setcommand forward turn rotate": _COMMAND,
        "props obstacles workspace bounds addons robots iteration": "robot.world, which has them",
    },
    "a world": {
        "x y theta heading": "x, y, theta = world.pose, each with a number for each robot",
        "dt ts step": "world.sampling_time",
        "sense sensors memory inbox send neighbours name": "world.robots[0], which has it",
        "n numrobots": "len(world.robots)",
    },
    "a hook": {
        "onend onfinish onfinished onclose ondone onexit stop end finish": "on_stop(self, world)",
        "oninit onbegin onreset onsetup oninitialize start begin reset setup initialize":
            "on_start(self, world)",
        "onupdate onloop ontick step update loop tick": "on_step(self, world)",
        "oncollision oncollide ontouch onhit contact collision": "on_contact(self, world, contact)",
        "onrender onplot onpaint": "on_draw(self, world, scene)",
    },
    "a room": {
        "lidar laser laserscanner rangesensor scanner": "RangeFinder, of mars2d.sensors",
        "wall walls obstacle obstacles": "Map, of mars2d.addons: Map([[(x, y), ...]])",
        "simulator simulation simulate sim environment env": "run: mars2d.run(scenario)",
    },
    "mars2d run": {
        "time stop duration t end": "--stop-time S",
        "seeds runs n": "--seed K; mars2d sweep has --seeds N",
    },
}  # fmt: skip
"""What to write, by where it is written and the words, in small letters and without underscores."""


def instead(word: object, *places: str) -> str:
    """Return ``"; write ..."`` for a word that others use in one of the places, or ``""``.

    >>> instead("maxSpeed", "Robot")
    '; write drive=Unicycle(max_linear_speed=...)'
    """
    plain = str(word).lower().replace("_", "").replace("-", "")
    for place in places:
        for words, meant in _INSTEAD.get(place, {}).items():
            if plain in words.split() and not meant.startswith(f"{word}="):
                return f"; write {meant}"
    return ""
