"""Words that people write for others: of older simulators, other libraries, or plain speech."""

from __future__ import annotations

POSE = "pose=(x, y, theta)"
LAW = "controller=law"
LIMIT = "drive=Unicycle(max_linear_speed=...)"
TURN = "drive=Unicycle(max_angular_speed=...)"
KEEP = "robot.memory in the law, or functools.partial(law, goal=...): a law keeps its own numbers"
MAPPED = "addons=[Map([[(x, y), ...], ...])], of mars2d.addons"
CORNERS = "workspace=[(x, y), ...], the corners of the area"
COUNT = "robots=3, or robots=[Robot(...), ...]"
TEAM = "def control(world) in the file, or controller=law of each Robot"
COMMAND = "return v, omega: a law returns its command"
SENSE = "robot.sense.NAME, the reading of the sensor of that name"
SOLID = "shape=Polygon([(x, y), ...]), of mars2d.geometry, or diameter=..."
SCANNER = "RangeFinder, of mars2d.sensors"
WALLS = "Map, of mars2d.addons: Map([[(x, y), ...]])"
RUN = "run: mars2d.run(scenario)"

_PLACE = ("x", "y", "theta", "position", "positon", "pos", "xy", "orientation", "heading", "angle",
          "start", "initialpose", "startpose", "location", "yaw")  # fmt: skip

_INSTEAD: dict[str, dict[tuple[str, ...] | str, str]] = {
    "Robot": {
        _PLACE: POSE,
        ("r", "size", "width", "length"): SOLID,
        ("speed", "maxspeed", "maxlinearspeed", "vmax", "maxv", "v", "velocity"): LIMIT,
        ("omega", "maxomega", "maxangularspeed", "w", "wmax", "angularspeed"): TURN,
        ("law", "control", "controllaw", "behaviour", "behavior", "policy", "function"): LAW,
        ("type", "kind", "model", "kinematics"): "drive=Unicycle(), Holonomic(), Car() or another",
        ("holonomic", "omni"): "drive=Holonomic()",
        ("unicycle", "differential"): "drive=Unicycle() or Differential()",
        ("goal", "target", "kp", "gain", "k", "params"): KEEP,
        ("id", "number", "index", "label"): "name='...'",
        ("wheelbase", "wheelradius"): "drive=Differential(wheel_radius=...) or Car(wheelbase=...)",
        "weight": "mass=...",
        ("lidar", "sensing", "perception"): "sensors=[RangeFinder(...)], of mars2d.sensors",
    },
    "Prop": {
        _PLACE: POSE,
        ("r", "size"): "diameter=... or radius=..., for a Box length=... and width=...",
        ("weight", "density"): "mass=... or material='...'",
        ("vel", "speed"): "velocity=(vx, vy, omega)",
    },
    "Scenario": {
        ("n", "number", "numrobots", "nrobots", "numberofrobots", "agents"): COUNT,
        ("poses", "positions", "initialposes"): "robots=[Robot(pose=(x, y, theta)), ...]",
        ("dt", "ts", "step", "timestep", "stepsize", "period"): "sampling_time=...",
        ("t", "time", "duration", "tmax", "tend", "endtime", "maxtime", "simtime"): "stop_time=...",
        ("law", "laws", "control", "controller", "controllers"): TEAM,
        ("obstacle", "obstacles", "wall", "walls", "map"): MAPPED,
        ("bounds", "arena", "size", "world", "field", "area", "limits", "width"): CORNERS,
        ("boxes", "objects", "bodies", "things", "balls"): "props=[Box(...), ...]",
        ("sensor", "sensors"): "Robot(sensors=[...])",
        ("seed", "randomseed"): "--seed 3, or mars2d.run(scenario, seed=3)",
        "gravity": "ground_friction=... of a prop: one looks at the plane from above",
        "name": "title='...'",
        ("communication", "range", "neighborhood"): "neighbours=Within(range)",
    },
    "Sensor": {
        ("distance", "maxrange", "reach", "maxdistance"): "range=...",
        ("fov", "angle", "aperture", "opening"): "field_of_view=...",
        ("n", "rays", "numbeams", "numrays"): "beams=...",
        (*_PLACE, "offset"): "mount=(x, y, theta)",
        ("frequency", "hz"): "rate=...",
        "delay": "latency=...",
        ("std", "sigma", "stddev"): "noise=...",
    },
    "Drive": {
        ("maxv", "vmax", "maxspeed", "speed", "v", "maxvelocity"): "max_linear_speed=...",
        ("maxomega", "maxw", "wmax", "omega", "maxangularvelocity"): "max_angular_speed=...",
        ("turningradius", "minturningradius", "minradius", "rho", "curvature", "maxcurvature"):
            "max_angular_speed=...: at the speed v the radius is v / max_angular_speed",
        ("wheelseparation", "track", "axle", "axletrack", "l"):
            "wheel_semiaxis=..., half the distance of the wheels",
        "force": "max_force=...",
        ("acceleration", "amax"): "max_acceleration=...",
    },
    "Holonomic": {
        ("maxangularspeed", "maxomega", "maxw", "wmax", "omega", "maxangularvelocity"):
            "drive=Unicycle(max_angular_speed=...): a holonomic robot keeps its heading",
    },
    "Unicycle": {"wheelbase": "wheel_semiaxis=..., half the distance of the wheels"},
    "Differential": {"wheelbase": "wheel_semiaxis=..., half the distance of the wheels"},
    "Within": {("radius", "distance", "r"): "range=..."},
    "a robot": {
        "x": "robot.pose[0]",
        "y": "robot.pose[1]",
        ("theta", "heading", "angle", "orientation", "yaw"): "robot.pose[2]",
        ("speed", "v", "vel", "omega", "w"): "robot.velocity: x', y' [m/s], theta' [rad/s]",
        ("sensors", "sensor", "readings", "prox", "proximity", "lidar", "range", "measure"): SENSE,
        ("t", "now"): "robot.time",
        ("dt", "ts", "step"): "robot.sampling_time",
        ("goal", "target", "state", "integral", "error"): "robot.memory: a law keeps things there",
        ("stop", "move", "setvelocity", "setspeed", "setcommand", "forward", "turn", "rotate"):
            COMMAND,
        ("id", "number"): "robot.index or robot.name",
        ("distance", "distanceto"): "math.dist(robot.position, other.position)",
        ("neighbors", "others", "robots"): "robot.neighbours",
        ("message", "messages", "receive"): "robot.inbox",
        ("obstacles", "map"): "robot.world.obstacles",
    },
    "a world": {
        ("n", "count", "number", "nrobots"): "len(world.robots)",
        ("x", "state", "states", "poses", "positions"): "world.pose, an array (3, n)",
        ("theta", "heading"): "world.pose[2]",
        ("t", "now"): "world.time",
        ("dt", "ts"): "world.sampling_time",
        ("k", "steps", "row"): "world.iteration",
        ("setvelocity", "setvelocities", "setcommand", "move"):
            "return array (2, n): a law returns its commands",
        ("agents", "robot"): "world.robots",
        ("getposes", "getpose"): "world.pose, an array (3, n)",
    },
    "a room": {
        ("lidar", "laser", "laserscanner", "rangesensor", "scanner"): SCANNER,
        ("sonar", "ultrasonic", "ultrasound"): "SonarRing or RangeFinder, of mars2d.sensors",
        ("camera", "vision"): "LineCamera, RangeBearing or Ground, of mars2d.sensors",
        ("ir", "infrared", "proximitysensor"): "Proximity, of mars2d.sensors",
        ("gps", "compass"): "Pose, of mars2d.sensors",
        ("encoder", "encoders"): "Odometry, of mars2d.sensors",
        ("gyro", "accelerometer"): "Imu, of mars2d.sensors",
        ("touch", "contactsensor"): "Bumper, of mars2d.sensors",
        ("wall", "walls", "obstacle", "obstacles"): WALLS,
        ("simulator", "simulation", "simulate", "sim", "environment", "env"): RUN,
        ("agent", "vehicle", "diffdrive"): "Robot, with drive=Unicycle() or another",
        ("circle", "disc", "rectangle", "square"): "Puck or Box, of mars2d.bodies",
        ("radio", "comms", "network"): "Communication, of mars2d.addons",
        ("plot", "animate", "show"): "the command: mars2d run FILE, or mars2d plot RECORD",
    },
    "mars2d": {
        ("simulate", "start", "go", "open", "exec"): "mars2d run EXPERIMENT",
        ("help", "h"): "mars2d --help",
        "version": "mars2d --version",
        ("show", "view", "watch"): "mars2d replay RECORD",
        ("examples", "ls"): "mars2d list",
        ("new", "editor", "draw"): "mars2d edit",
        ("test", "verify", "lint"): "mars2d check FILE",
        ("study", "grid"): "mars2d sweep EXPERIMENT --set NAME=VALUES",
        ("league", "match", "game"): "mars2d tournament",
    },
    "mars2d run": {
        ("time", "stop", "duration", "t", "end"): "--stop-time S",
        ("seeds", "runs", "n"): "--seed K; mars2d sweep has --seeds N",
        ("out", "output", "save", "log", "csv", "npz"): "--record OUT.npz, .csv or another",
        ("png", "picture", "plot", "image", "fig"): "--figure OUT.png",
        ("gif", "mp4", "movie", "film", "animation"): "--video OUT.gif",
        ("nowindow", "nogui", "batch", "quiet"): "--headless",
        ("param", "params", "values", "option"): "--set NAME=VALUE",
        ("dt", "ts"): "--set sampling_time=0.1",
    },
    "mars2d sweep": {
        ("values", "param", "params", "vary", "range", "grid", "over"): "--set NAME=VALUES",
        ("time", "stop", "duration"): "--stop-time S",
        ("seed", "runs", "n", "repeat"): "--seeds N",
        ("jobs", "j", "processes", "cores"): "--workers N",
        ("csv", "save", "output"): "--out OUT.csv",
        ("metric", "metrics", "measures"): "--measure NAME",
    },
}  # fmt: skip
"""What to write, by where it is written and the word, in small letters and without underscores."""


def instead(word: object, *places: str) -> str:
    """Return ``"; write ..."`` for a word that others use in one of the places, or ``""``.

    >>> instead("maxSpeed", "Robot")
    '; write drive=Unicycle(max_linear_speed=...)'
    """
    plain = str(word).lower().replace("_", "").replace("-", "")
    for place in places:
        for words, meant in _INSTEAD.get(place, {}).items():
            if plain in ((words,) if isinstance(words, str) else words):
                return f"; write {meant}"
    return ""
