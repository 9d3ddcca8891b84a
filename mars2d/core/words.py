"""Words that people write for others: of older simulators, other libraries, or plain speech."""

from __future__ import annotations

LIMIT, TURN = "drive=Unicycle(max_linear_speed=...)", "drive=Unicycle(max_angular_speed=...)"
COMMAND = "return v, omega: a law returns its command"
HALF = "wheel_semiaxis=..., half the distance of the wheels"
PLACE = "x y theta position positon pos orientation heading angle start initialpose yaw"
POSE = "pose=(x, y, theta)", PLACE

_MEANT: dict[str, list[tuple[str, str]]] = {
    "Robot": [
        POSE,
        ("shape=Polygon([(x, y), ...]), of mars2d.geometry, or diameter=...", "r size width"),
        (LIMIT, "speed maxspeed maxlinearspeed vmax maxv v velocity"),
        (TURN, "omega maxomega maxangularspeed w wmax"),
        ("controller=law", "law control controllaw behavior policy function"),
        ("drive=Unicycle(), Holonomic(), Car() or another", "type kind model kinematics"),
        ("drive=Holonomic()", "holonomic omni"),
        ("drive=Unicycle() or Differential()", "unicycle differential"),
        ("robot.memory in the law, or functools.partial(law, goal=...): it keeps its own numbers",
         "goal target kp gain k params"),
        ("drive=Differential(wheel_radius=...) or Car(wheelbase=...)", "wheelbase wheelradius"),
        ("mass=...", "weight"),
        ("sensors=[RangeFinder(...)], of mars2d.sensors", "lidar sensing perception"),
    ],
    "Prop": [
        POSE,
        ("diameter=... or radius=..., for a Box length=... and width=...", "r size"),
        ("mass=... or material='...'", "weight density"),
    ],
    "Scenario": [
        ("robots=3, or robots=[Robot(...), ...]", "n number numrobots nrobots agents"),
        ("sampling_time=...", "dt ts step timestep period"),
        ("stop_time=...", "t time duration tmax tend endtime simtime"),
        ("def control(world) in the file, or controller=law of each Robot",
         "law laws control controller controllers"),
        ("addons=[Map([[(x, y), ...], ...])], of mars2d.addons", "obstacle obstacles wall walls"),
        ("workspace=[(x, y), ...], the corners of the area", "bounds arena size world area"),
        ("props=[Box(...), ...]", "boxes objects bodies balls"),
        ("Robot(sensors=[...])", "sensor sensors"),
        ("--seed 3, or mars2d.run(scenario, seed=3)", "seed randomseed"),
        ("ground_friction=... of a prop: one looks at the plane from above", "gravity"),
    ],
    "Sensor": [
        ("range=...", "distance maxrange reach maxdistance"),
        ("field_of_view=...", "fov angle aperture"),
        ("beams=...", "n rays numbeams numrays"),
        ("mount=(x, y, theta)", PLACE + " offset"),
        ("rate=...", "frequency hz"), ("latency=...", "delay"), ("noise=...", "std sigma stddev"),
    ],
    "Drive": [
        ("max_linear_speed=...", "maxv vmax maxspeed speed v maxvelocity"),
        ("max_angular_speed=...", "maxomega maxw wmax omega maxangularvelocity"),
        ("max_angular_speed=...: at the speed v the radius is v / max_angular_speed",
         "turningradius minturningradius minradius rho curvature maxcurvature"),
        (HALF, "wheelseparation track axle axletrack l"),
        ("max_force=...", "force"), ("max_acceleration=...", "acceleration amax"),
    ],
    "Holonomic": [
        ("drive=Unicycle(max_angular_speed=...): a holonomic robot keeps its heading",
         "maxangularspeed maxomega maxw wmax omega maxangularvelocity"),
    ],
    "Unicycle": [(HALF, "wheelbase")],
    "Differential": [(HALF, "wheelbase")],
    "Within": [("range=...", "radius distance r")],
    "a robot": [
        ("robot.pose[0]", "x"), ("robot.pose[1]", "y"),
        ("robot.pose[2]", "theta heading angle orientation yaw"),
        ("robot.velocity: x', y' [m/s], theta' [rad/s]", "speed v vel omega w"),
        ("robot.sense.NAME, the reading of the sensor of that name",
         "sensors sensor readings prox proximity lidar range"),
        ("robot.time", "t now"), ("robot.sampling_time", "dt ts step"),
        ("robot.memory: a law keeps things there", "goal target state integral error"),
        (COMMAND, "stop move setvelocity setspeed setcommand forward turn rotate"),
        ("robot.index or robot.name", "id number"),
        ("robot.neighbours", "neighbors others robots"),
    ],
    "a world": [
        ("len(world.robots)", "n count number nrobots"),
        ("world.pose, an array (3, n)", "x state states poses positions getposes getpose"),
        ("world.time", "t now"), ("world.sampling_time", "dt ts"),
        ("return array (2, n): a law returns its commands", "setvelocity setcommand move"),
        ("world.robots", "agents robot"),
    ],
    "a room": [
        ("RangeFinder, of mars2d.sensors", "lidar laser laserscanner rangesensor scanner"),
        ("SonarRing or RangeFinder, of mars2d.sensors", "sonar ultrasonic ultrasound"),
        ("LineCamera, RangeBearing or Ground, of mars2d.sensors", "camera vision"),
        ("Proximity, of mars2d.sensors", "ir infrared proximitysensor"),
        ("Pose, of mars2d.sensors", "gps compass"),
        ("Odometry, of mars2d.sensors", "encoder encoders"),
        ("Map, of mars2d.addons: Map([[(x, y), ...]])", "wall walls obstacle obstacles"),
        ("run: mars2d.run(scenario)", "simulator simulation simulate sim env"),
    ],
    "mars2d": [
        ("mars2d run EXPERIMENT", "simulate start go open exec"),
        ("mars2d --help", "help h"), ("mars2d --version", "version"),
        ("mars2d replay RECORD", "show view watch"), ("mars2d list", "examples ls"),
        ("mars2d edit", "editor draw"), ("mars2d check FILE", "test verify lint"),
        ("mars2d sweep EXPERIMENT --set NAME=VALUES", "study grid"),
    ],
    "mars2d run": [
        ("--stop-time S", "time stop duration t end"),
        ("--seed K; mars2d sweep has --seeds N", "seeds runs n"),
        ("--record OUT.npz, .csv or another", "out output save log csv npz"),
        ("--figure OUT.png", "png picture plot image fig"),
        ("--video OUT.gif", "gif mp4 movie film animation"),
        ("--headless", "nowindow nogui batch quiet"),
        ("--set NAME=VALUE", "param params values option"),
        ("--set sampling_time=0.1", "dt ts"),
    ],
    "mars2d sweep": [
        ("--set NAME=VALUES", "values param params vary range grid over"),
        ("--stop-time S", "time stop duration"), ("--seeds N", "seed runs n repeat"),
        ("--workers N", "jobs j processes cores"), ("--out OUT.csv", "csv save output"),
        ("--measure NAME", "metric metrics measures"),
    ],
}  # fmt: skip
"""What to write, by where it is written, and the words of others, without underscores."""


def instead(word: object, *places: str) -> str:
    """Return ``"; write ..."`` for a word that others use in one of the places, or ``""``.

    >>> instead("maxSpeed", "Robot")
    '; write drive=Unicycle(max_linear_speed=...)'
    """
    plain = str(word).lower().replace("_", "").replace("-", "")
    for place in places:
        for meant, words in _MEANT.get(place, []):
            if plain in words.split():
                return f"; write {meant}"
    return ""
