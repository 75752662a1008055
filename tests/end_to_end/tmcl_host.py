"""A host written from the manual alone: datagrams, a serial port, and the virtual modules the tests start."""

import json
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import serial

# Opcodes, status codes and parameters as the manual prints them: a second opinion on the tables of the firmware.
ROR, ROL, MST, MVP, SAP, GAP, STAP, RSAP, SGP, GGP, STGP, RSGP = range(1, 13)
STOP, SCO, GCO = 28, 30, 31
STOP_PROGRAM, RUN_PROGRAM, RESET_PROGRAM, BEGIN_DOWNLOAD, END_DOWNLOAD = 128, 129, 131, 132, 133
READ_PROGRAM, PROGRAM_STATUS, VERSION = 134, 135, 136
OK, LOADED, WRONG_CHECKSUM, INVALID_COMMAND = 100, 101, 1, 2
TARGET_POSITION, ACTUAL_POSITION, ACTUAL_SPEED, MAXIMUM_SPEED, MAXIMUM_ACCELERATION, POSITION_REACHED = 0, 1, 3, 4, 5, 8
STANDBY_CURRENT = 7

# Generous: only a hang reaches it, however busy the machine is.
DEADLINE = 60


def tmcl_path():
    """The program under test, from the command line."""
    return os.path.abspath(sys.argv[1])


def main():
    """Runs the tests of the calling module; takes the program's path off the arguments."""
    if len(sys.argv) < 2 or not os.access(sys.argv[1], os.X_OK):
        sys.exit("usage: %s path/to/tmcl [unittest arguments]" % sys.argv[0])
    unittest.main(argv=[sys.argv[0]] + sys.argv[2:], verbosity=2)


def checksum(data):
    return sum(data) & 0xFF


def request(opcode, kind=0, motor=0, value=0, address=1):
    data = struct.pack(">BBBBi", address, opcode, kind, motor, value)
    return data + bytes([checksum(data)])


class Reply:
    def __init__(self, data):
        self.data = data
        self.host, self.module, self.status, self.opcode, self.value = struct.unpack(">BBBBi", data[:8])
        self.checksum_is_right = checksum(data[:8]) == data[8]


def eventually(condition, what):
    """Polls until the condition holds; returns its value."""
    deadline = time.monotonic() + DEADLINE
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > deadline:
            raise AssertionError("not within %d s: %s" % (DEADLINE, what))
        time.sleep(0.01)


class Host:
    """Nine bytes there, nine bytes back."""

    def __init__(self, path):
        self.port = serial.Serial(path, timeout=DEADLINE)

    def close(self):
        self.port.close()

    def send(self, data):
        self.port.write(data)

    def receive(self):
        data = self.port.read(9)
        if len(data) != 9:
            raise AssertionError("only %d bytes came back" % len(data))
        return data

    def ask(self, opcode, kind=0, motor=0, value=0, address=1):
        self.send(request(opcode, kind, motor, value, address))
        reply = Reply(self.receive())
        if not reply.checksum_is_right:
            raise AssertionError("wrong checksum: " + reply.data.hex())
        return reply

    def do(self, opcode, kind=0, motor=0, value=0):
        """Asks and expects status 100."""
        reply = self.ask(opcode, kind, motor, value)
        if (reply.status, reply.opcode) != (OK, opcode):
            raise AssertionError("command %d answered %s" % (opcode, reply.data.hex()))
        return reply.value

    def get(self, parameter):
        return self.do(GAP, parameter)

    def set(self, parameter, value):
        return self.do(SAP, parameter, 0, value)

    def load(self, program, address=0):
        """Writes (opcode, type, motor, value) tuples into the program memory."""
        self.do(BEGIN_DOWNLOAD, 0, 0, address)
        for instruction in program:
            status = self.ask(*instruction).status
            if status != LOADED:
                raise AssertionError("instruction %r answered status %d" % (instruction, status))
        self.do(END_DOWNLOAD)

    def program_state(self):
        """0 stopped, 1 running."""
        return self.do(PROGRAM_STATUS) >> 24


class Simulation:
    """`tmcl sim` as a child process, with its link in a folder of its own."""

    def __init__(self, folder, *arguments):
        self.link = os.path.join(folder, "link")
        # A file, not a pipe: nobody reads what the child prints on stderr while it runs.
        self.errors = tempfile.TemporaryFile(mode="w+")
        self.process = subprocess.Popen(
            [tmcl_path(), "--json", "sim", *arguments, "--pty-link", self.link, "--tcp", "0", "--quiet"],
            stdout=subprocess.PIPE, stderr=self.errors, text=True)
        line = self.process.stdout.readline()
        if not line:
            raise AssertionError("tmcl sim ended with %d: %s" % (self.process.wait(DEADLINE), self.error_text()))
        self.introduction = json.loads(line)
        self.tcp_port = int(self.introduction["tcp"].rsplit(":", 1)[1])

    def error_text(self):
        self.errors.seek(0)
        return self.errors.read()

    def host(self):
        return Host(self.link)

    def stop(self, how=signal.SIGTERM):
        """Ends it as a user does; returns the exit code."""
        if self.process.poll() is None:
            self.process.send_signal(how)
        code = self.process.wait(DEADLINE)
        self.process.stdout.close()
        self.errors.close()
        return code


class TemporaryFolderTest(unittest.TestCase):
    """Each test has a folder."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="tmcl_test.")
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return self.path(name)

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def start(self, *arguments):
        simulation = Simulation(self.folder, *arguments)
        self.addCleanup(simulation.stop)
        return simulation

    def tmcl(self, *arguments, **options):
        """Runs the program to its end."""
        if "input" not in options:
            options["stdin"] = subprocess.DEVNULL
        return subprocess.run([tmcl_path(), *arguments], capture_output=True, text=True, timeout=DEADLINE, check=False,
                              **options)


class SimulationTest(TemporaryFolderTest):
    """Each test has a virtual PD-1161 and a host at its serial port."""

    # A position of some thousand microsteps is reached within a fraction of a second.
    arguments = ("pd1161", "--speed", "10")

    def setUp(self):
        super().setUp()
        self.simulation = self.start(*self.arguments)
        self.host = self.simulation.host()
        self.addCleanup(self.host.close)
