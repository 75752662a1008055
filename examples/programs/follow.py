#!/usr/bin/env python3
"""Sends the position of one module on an RS485 line to all that follow it: see multi_drop_follower.tmc.

    tmcl farm examples/programs/multi_drop.farm.toml
    examples/programs/follow.py examples/programs/run/line --baud-rate 115200

Turn the leader meanwhile through the line's TCP port, which the farm prints; hosts at both doors take turns. Ctrl-C ends
it, and the followers stop.
"""

import argparse
import struct
import time

import serial

GAP, SGP = 6, 9
ACTUAL_POSITION = 1
LEADER_VARIABLE, USER_VARIABLES = 0, 2
DONE = 100


def datagram(address, opcode, kind, motor, value=0):
    data = struct.pack(">BBBBi", address, opcode, kind, motor, value)
    return data + bytes([sum(data) & 0xFF])


def position_of(port, address):
    port.write(datagram(address, GAP, ACTUAL_POSITION, 0))
    reply = port.read(9)
    if len(reply) < 9:
        raise TimeoutError("module %d does not answer" % address)
    _, sender, status, _, value = struct.unpack(">BBBBi", reply[:8])
    if sender != address or status != DONE or reply[8] != sum(reply[:8]) & 0xFF:
        raise ValueError("not the answer of module %d: %s" % (address, reply.hex()))
    return value


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("port", help="serial port of the line")
    options.add_argument("--baud-rate", type=int, default=9600)
    options.add_argument("--leader", type=int, default=1, help="address of the module to follow (1)")
    options.add_argument("--group", type=int, default=100, help="second address of the followers (100)")
    options.add_argument("--period", type=float, default=0.05, help="seconds between two positions (0.05)")
    arguments = options.parse_args()

    with serial.Serial(arguments.port, arguments.baud_rate, timeout=0.5) as port:
        while True:
            position = position_of(port, arguments.leader)
            port.write(datagram(arguments.group, SGP, LEADER_VARIABLE, USER_VARIABLES, position))
            time.sleep(arguments.period)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        pass
