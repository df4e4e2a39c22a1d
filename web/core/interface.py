#!/usr/bin/env python3
"""Writes what TypeScript and the linker need to know of the C interface, from capi/samestep.json.

Usage: interface.py ABI.ts EXPORTS.json

ABI.ts has the status codes, the constants, the places of fields, and the exported functions: 64 bits are two numbers,
the low half first. EXPORTS.json is the list that Emscripten takes. Threads are left out.
"""

import json
import sys
from pathlib import Path

DESCRIPTION = json.loads((Path(__file__).resolve().parents[2] / "capi/samestep.json").read_text(encoding="utf-8"))
WIDE = {"uint64_t", "int64_t", *(new for new, old in DESCRIPTION["aliases"].items() if old == "uint64_t")}
LEFT_OUT = {"samestep_world_set_workers", "samestep_world_set_task_runner", "samestep_make_id"}
BRIDGE = {"samestep_web_functions": ["", "number"],
          "samestep_web_write_poses": ["world: number, values: number, ids: number, count: number", "number"],
          "malloc": ["size: number", "number"], "free": ["pointer: number", "void"],
          "stackSave": ["", "number"], "stackAlloc": ["size: number", "number"],
          "stackRestore": ["pointer: number", "void"]}


def functions():
    for function in DESCRIPTION["functions"]:
        if function["name"] in LEFT_OUT:
            continue
        arguments = []
        for argument in function["arguments"]:
            # `function` is a word of the language.
            name = argument["name"].replace("function", "callback")
            halves = [name, f"{name}High"] if argument["type"] in WIDE and "count" not in argument else [name]
            arguments += [f"{half}: number" for half in halves]
        yield function["name"], ", ".join(arguments), "void" if function["result"] == "void" else "number"


def constants():
    """Those of statuses and the others."""
    both = ({}, {})
    for constant in DESCRIPTION["constants"]:
        name, value = constant["name"].removeprefix("SAMESTEP_"), constant["value"]
        # Statuses stand before the scalars.
        is_status = "OK" in both[0] and "FIXED" not in both[1] and name != "FIXED" or name == "OK"
        both[not is_status][name] = value
    return both


def text():
    statuses, others = constants()
    lines = ["// Made from capi/samestep.json by web/core/interface.py.", "/** Why a call was refused. */",
             "export const statuses = {", *(f"  {value}: '{name}'," for name, value in statuses.items()),
             "} as const;", "export const constants = {", *(f"  {name}: {value}," for name, value in others.items()),
             "} as const;"]
    for structure in DESCRIPTION["structures"]:
        places = ", ".join(f"{field['name']}: {field['offset']['wasm32']}" for field in structure["fields"])
        lines.append(f"export const {structure['name'].removeprefix('samestep_')} = "
                     f"{{ size_of: {structure['size']['wasm32']}, {places} }} as const;")
    lines.append("export interface Exports {")
    lines += [f"  {name}({arguments}): {result};" for name, arguments, result in functions()]
    lines += [f"  {name}({arguments}): {result};" for name, (arguments, result) in BRIDGE.items()]
    return "\n".join([*lines, "}", ""])


def main():
    abi, exports = map(Path, sys.argv[1:])
    names = [name for name, _, _ in functions()] + [name for name in BRIDGE if not name.startswith("stack")]
    for path, content in ((abi, text()), (exports, json.dumps([f"_{name}" for name in names]))):
        # A file that stays as it is keeps its time, and nothing is linked again.
        if not path.exists() or path.read_text(encoding="utf-8") != content:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content, encoding="utf-8")


if __name__ == "__main__":
    main()
