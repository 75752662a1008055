"""Cuts a virtual module's supply by half while `tmcl sim` runs, and gives it back: docs/control.md in ten lines."""

import json
import socket
import sys

simulation = socket.socket(socket.AF_UNIX)
simulation.connect(sys.argv[1] if len(sys.argv) > 1 else "/tmp/tmcl-pd1161.control")
lines = simulation.makefile("rw")


def call(method, **parameters):
    print(json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": parameters}), file=lines, flush=True)
    return json.loads(lines.readline())["result"]


call("set", values={"supply_voltage": 12})
call("step", by=100_000)
print(call("get", names=["supply_voltage", "velocity", "position"]))
call("set", values={"supply_voltage": 24})
call("resume")
