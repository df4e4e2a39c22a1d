#!/usr/bin/env python3
"""Plays scenes through the C interface, by Python's ctypes, to the hashes of the golden files.

Usage: golden_test.py LIBRARY SCENES GOLDEN

Nothing of the interface is written down here: capi/samestep.json says how each function is called. Scenes that name
other files are left out. Handlers are those that scenes ask for by name, in Python.
"""

import ctypes
import json
import sys
from pathlib import Path

TICKS = 300
DESCRIPTION = json.loads((Path(__file__).resolve().parents[2] / "capi/samestep.json").read_text(encoding="utf-8"))
SCALARS = {"char": ctypes.c_char, "uint8_t": ctypes.c_uint8, "int32_t": ctypes.c_int32, "uint32_t": ctypes.c_uint32,
           "int64_t": ctypes.c_int64, "uint64_t": ctypes.c_uint64, "double": ctypes.c_double, "size_t": ctypes.c_size_t,
           "void": None}


class Library:
    """The functions of the interface by name, with or without samestep_; structures and constants as attributes."""

    def __init__(self, path):
        self.library = ctypes.CDLL(path)
        self.types = dict(SCALARS)
        for new, old in DESCRIPTION["aliases"].items():
            self.types[new] = SCALARS[old]
        for opaque in DESCRIPTION["opaque"]:
            self.types[opaque["name"]] = type(opaque["name"], (ctypes.Structure,), {})
        # Function pointers may take structures, and these may hold function pointers.
        for structure in DESCRIPTION["structures"]:
            self.types[structure["name"]] = type(structure["name"], (ctypes.Structure,), {})
        for callback in DESCRIPTION["callbacks"]:
            self.types[callback["name"]] = self.function_type(callback)
        for structure in DESCRIPTION["structures"]:
            self.lay_out(structure)
        self.constants = {constant["name"]: constant["value"] for constant in DESCRIPTION["constants"]}
        for function in DESCRIPTION["functions"]:
            bound = getattr(self.library, function["name"])
            bound.restype = self.type_of(function["result"], function)
            bound.argtypes = [self.type_of(argument["type"], argument) for argument in function["arguments"]]
            setattr(self, function["name"].removeprefix("samestep_"), self.checked(bound, function))

    def type_of(self, name, about):
        if name == "function pointer":
            return self.function_type(about)
        name = name.replace("const ", "").strip()
        if name == "char*":
            return ctypes.c_char_p
        if name == "void*":
            return ctypes.c_void_p
        if name.endswith("*"):
            return ctypes.POINTER(self.type_of(name[:-1], about))
        found = self.types[name]
        return ctypes.POINTER(found) if "count" in about else found

    def function_type(self, about):
        arguments = [self.type_of(argument["type"], argument) for argument in about["arguments"]]
        return ctypes.CFUNCTYPE(self.type_of(about["result"], {}), *arguments)

    def lay_out(self, about):
        fields = []
        for field in about["fields"]:
            kind = self.type_of(field["type"], {key: field[key] for key in field if key != "count"})
            fields.append((field["name"], kind * field["count"] if "count" in field else kind))
        made = self.types[about["name"]]
        made._fields_ = fields
        assert ctypes.sizeof(made) == about["size"]["64"], about["name"]
        for field in about["fields"]:
            assert getattr(made, field["name"]).offset == field["offset"]["64"], field["name"]

    def checked(self, bound, function):
        if function["result"] != "samestep_status":
            return bound

        def call(*arguments):
            status = bound(*arguments)
            if status != 0:
                name = self.library.samestep_status_name(status).decode()
                raise RuntimeError(f"{function['name']}: {name}: {self.message(arguments)}")
        return call

    def message(self, arguments):
        world = arguments[0] if isinstance(arguments[0], ctypes.POINTER(self.types["samestep_world"])) else None
        return self.library.samestep_last_message(world).decode()

    def new(self, name, **fields):
        """A structure, filled by its init function if it has one."""
        made = self.types["samestep_" + name]()
        if hasattr(self, name + "_init"):
            getattr(self, name + "_init")(ctypes.byref(made))
        for field, value in fields.items():
            setattr(made, field, value)
        return made

    def get(self, function, kind, *arguments):
        """What a function gives through its last argument."""
        result = self.types[kind]()
        getattr(self, function)(*arguments, ctypes.byref(result))
        return result.value if isinstance(result, ctypes._SimpleCData) else result


class Handlers:
    """The named handlers of scenes, as far as they are registered by the scene."""

    NUMBERS = {"ignore": 1, "one-way": 2, "bounce-pad": 3, "count": 4, "separate-kick": 5, "conveyor": 6, "remove-b": 7,
               "slippery": 8}

    def __init__(self, library, world):
        self.library, self.world = library, world
        self.post_step = library.types["samestep_post_step"](self.remove)
        self.kept = []

    def register(self, name):
        phase, function = {"ignore": ("begin", lambda *_: 0), "one-way": ("pre_solve", self.one_way),
                           "bounce-pad": ("pre_solve", self.bounce), "count": ("begin", self.count),
                           "separate-kick": ("separate", self.kick), "conveyor": ("pre_solve", self.carry),
                           "remove-b": ("begin", self.remove_b), "slippery": ("pre_solve", self.slip)}[name]
        handler = self.library.new("handler")
        setattr(handler, phase, dict(type(handler)._fields_)[phase](function))
        self.kept.append(handler)
        self.library.world_register_handler(self.world, self.NUMBERS[name], ctypes.byref(handler))
        return self.NUMBERS[name]

    def contact(self, contact):
        return self.library.get("contact_get", "samestep_contact_state", contact)

    def one_way(self, contact, *_):
        if self.contact(contact).touch.normal.y >= 0:
            return 1
        self.library.contact_ignore(contact)
        return 0

    def bounce(self, contact, *_):
        self.library.contact_set_restitution(contact, 1)
        return 1

    def count(self, contact, *_):
        state = self.contact(contact)
        for body in (state.body_a, state.body_b):
            data = self.library.get("body_get", "samestep_body_state", self.world, body).user_data
            self.library.body_set_user_data(self.world, body, data + 1)
        return 1

    def kick(self, contact, *_):
        body = self.contact(contact).body_b
        state = self.library.get("body_get", "samestep_body_state", self.world, body)
        if state.type == self.library.constants["SAMESTEP_DYNAMIC"]:
            self.library.body_set_velocity(self.world, body, state.velocity.x, min(state.velocity.y + 1, 1024))

    def carry(self, contact, *_):
        normal = self.contact(contact).touch.normal
        self.library.contact_set_surface_velocity(contact, -normal.y * 3, normal.x * 3)
        return 1

    def remove_b(self, contact, *_):
        body = self.contact(contact).body_b
        if body != self.library.get("world_get_static_body", "samestep_body_id", self.world):
            self.library.world_add_post_step(self.world, self.post_step, body, None, None)
        return 1

    def slip(self, contact, *_):
        self.library.contact_set_friction(contact, 0)
        return 1

    def remove(self, _world, body, _data):
        if self.library.get("body_exists", "int32_t", self.world, body):
            self.library.body_destroy(self.world, body)


class Scene:
    """A scene under way in a world of its own."""

    SETTINGS = {"gravity": "gravity", "iterations": "iterations", "substeps": "substeps", "damping": "damping",
                "collisionSlop": "collision_slop", "collisionBias": "collision_bias",
                "collisionPersistence": "collision_persistence", "contactHertz": "contact_hertz",
                "contactDamping": "contact_damping", "contactPushSpeed": "contact_push_speed",
                "contactMargin": "contact_margin", "bounceThreshold": "bounce_threshold", "worldExtent": "world_extent",
                "sleepTimeThreshold": "sleep_time_threshold", "idleSpeedThreshold": "idle_speed_threshold",
                "continuous": "continuous"}
    COMMANDS = {"impulse": 0, "force": 1, "velocity": 2, "angularVelocity": 3, "position": 4, "angle": 5, "remove": 7}

    def __init__(self, library, scene, scalar):
        self.library = library
        self.rate = scene.get("stepsPerSecond", 60)
        definition = library.new("world_def", scalar=scalar)
        self.read_settings(scene.get("settings", {}), definition.settings)
        self.world = self.make(definition)
        self.names = {}
        self.handlers = Handlers(library, self.world)
        for entry in scene.get("handlers", []):
            self.read_handler(entry)
        for body in scene["bodies"]:
            self.read_bodies(body)
        self.events = sorted(scene.get("events", []), key=lambda event: event["tick"])

    def make(self, definition):
        world = ctypes.POINTER(self.library.types["samestep_world"])()
        self.library.world_create(ctypes.byref(definition), ctypes.byref(world))
        return world

    def read_settings(self, found, settings):
        if "solver" in found:
            settings.solver = ["sequential impulses", "soft step"].index(found["solver"])
        if "precision" in found:
            settings.precision = ["accurate", "fast"].index(found["precision"])
        for key, field in self.SETTINGS.items():
            if key in found:
                value = found[key]
                setattr(settings, field, self.vector(value) if isinstance(value, list) else value)

    def read_handler(self, entry):
        number = self.handlers.register(entry["do"])
        if "types" in entry:
            self.library.world_add_handler(self.world, *entry["types"], number)
        elif "type" in entry:
            self.library.world_add_wildcard_handler(self.world, entry["type"], number)
        else:
            self.library.world_add_default_handler(self.world, number)

    def vector(self, pair):
        return self.library.new("vec2", x=pair[0], y=pair[1])

    def read_bodies(self, body):
        grid = body.get("grid", {})
        across, up = grid.get("across", [0, 0]), grid.get("up", [0, 0])
        for row in range(grid.get("rows", 1)):
            for column in range(grid.get("columns", 1)):
                made = self.spawn(body, [self.moved(body, axis, across, column, up, row) for axis in (0, 1)])
                if "name" in body:
                    number = f".{row * grid.get('columns', 1) + column}" if grid else ""
                    self.names[body["name"] + number] = made

    def moved(self, body, axis, across, column, up, row):
        """Computed as the world computes: in units of 2^-32 in a Fixed world."""
        origin = body.get("position", [0, 0])[axis]
        if self.library.get("world_get_scalar", "int32_t", self.world) == self.library.constants["SAMESTEP_DOUBLE"]:
            return origin + across[axis] * column + up[axis] * row
        raw = [self.library.get("number_to_raw", "int64_t", self.world, x) for x in (origin, across[axis], up[axis])]
        return self.library.get("number_from_raw", "double", self.world, raw[0] + raw[1] * column + raw[2] * row)

    def spawn(self, body, position):
        shapes = [self.read_shape(shape) for shape in body.get("shapes", [])]
        array = (self.library.types["samestep_shape_def"] * len(shapes))(*shapes)
        command = self.library.new("command", kind=6, shape_count=len(shapes))
        command.spawned = ctypes.pointer(self.read_body(body, position))
        command.shapes = ctypes.cast(array, ctypes.POINTER(self.library.types["samestep_shape_def"]))
        made = self.library.get("world_apply", "samestep_body_id", self.world, ctypes.byref(command))
        if not body.get("maySleep", True):
            self.library.body_set_may_sleep(self.world, made, 0)
        return made

    def read_body(self, body, position):
        made = self.library.new("body_def", position=self.vector(position))
        made.type = ["dynamic", "kinematic", "static"].index(body.get("type", "dynamic"))
        made.rotates = 1 if body.get("rotates", True) else 0
        made.bullet = 1 if body.get("bullet", False) else 0
        for key, field in (("mass", "mass"), ("moment", "moment"), ("angle", "angle"),
                           ("angularVelocity", "angular_velocity"), ("userData", "user_data")):
            if key in body:
                setattr(made, field, body[key])
        if "velocity" in body:
            made.velocity = self.vector(body["velocity"])
        return made

    def read_geometry(self, shape, made):
        constants = self.library.constants
        if "circle" in shape:
            made.kind, made.radius = constants["SAMESTEP_CIRCLE"], shape["circle"]
            made.a = self.vector(shape.get("offset", [0, 0]))
        elif "box" in shape:
            made.kind, (made.width, made.height) = constants["SAMESTEP_BOX"], shape["box"]
        elif "segment" in shape:
            made.kind, (made.a, made.b) = constants["SAMESTEP_SEGMENT"], map(self.vector, shape["segment"])
            if "neighbors" in shape:
                made.has_neighbors, (made.previous, made.next) = 1, map(self.vector, shape["neighbors"])
        else:
            exact = "polygon" in shape
            made.kind = constants["SAMESTEP_EXACT_POLYGON" if exact else "SAMESTEP_POLYGON"]
            points = [self.vector(point) for point in shape["polygon" if exact else "hull"]]
            made.vertices = (self.library.types["samestep_vec2"] * len(points))(*points)
            made.vertex_count = len(points)

    def read_shape(self, shape):
        made = self.library.new("shape_def", radius=shape.get("radius", 0))
        self.read_geometry(shape, made)
        for key, field in (("density", "density"), ("mass", "mass"), ("friction", "friction"),
                           ("elasticity", "elasticity"), ("collisionType", "collision_type"), ("group", "group"),
                           ("category", "category"), ("mask", "mask"), ("sensor", "sensor"), ("userData", "user_data")):
            if key in shape:
                setattr(made, field, shape[key])
        if "surfaceVelocity" in shape:
            made.surface_velocity = self.vector(shape["surfaceVelocity"])
        return made

    def apply(self, event):
        if event["do"] == "spawn":
            self.names[event["body"].get("name", "")] = self.spawn(event["body"], event["body"].get("position", [0, 0]))
            return
        body = self.names[event["body"]]
        if not self.library.get("body_exists", "int32_t", self.world, body):
            return
        value = event.get("value", [0, 0])
        command = self.library.new("command", kind=self.COMMANDS[event["do"]], body=body)
        command.value = self.vector(value if isinstance(value, list) else [value, 0])
        command.arm = self.vector(event.get("arm", [0, 0]))
        self.library.world_apply(self.world, ctypes.byref(command), None)

    def step(self, tick):
        while self.events and self.events[0]["tick"] <= tick:
            self.apply(self.events.pop(0))
        self.library.world_step_at(self.world, self.rate)
        return self.library.get("world_get_hash", "uint64_t", self.world)


def play(library, scene, scalar, golden):
    """The first tick whose hash is not the one written down, or None."""
    world = Scene(library, scene, scalar)
    wrong = None
    for line in golden.read_text().splitlines()[:TICKS]:
        tick, expected = line.split()
        if world.step(int(tick)) != int(expected, 16):
            wrong = tick
            break
    library.world_destroy(world.world)
    return wrong


def names_files(scene):
    return "inputs" in scene or any("csv" in body for body in scene["bodies"])


def main():
    library = Library(sys.argv[1])
    wrong = played = 0
    for path in sorted(Path(sys.argv[2]).glob("*.json")):
        scene = json.loads(path.read_text(encoding="utf-8"))
        for name, scalar in (("fixed", "SAMESTEP_FIXED"), ("double", "SAMESTEP_DOUBLE")):
            golden = Path(sys.argv[3]) / f"{path.stem}.{name}.txt"
            value = library.constants[scalar]
            # Joints are played by joints_test.c.
            if not golden.exists() or "joints" in scene or names_files(scene) or not library.scalar_built(value):
                continue
            tick = play(library, scene, value, golden)
            played += 1
            if tick is not None:
                wrong += 1
                print(f"{path.stem} in {name}: another hash after tick {tick}")
    print(f"{played} golden files, {wrong} differ")
    return 1 if wrong or not played else 0


if __name__ == "__main__":
    sys.exit(main())
