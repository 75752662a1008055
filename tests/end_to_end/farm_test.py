"""A farm of three modules, two of them on one RS485 line, and what happens to a file with mistakes."""

import json
import os
import signal
import socket
import subprocess
import tempfile
import time

import tmcl_host
from tmcl_host import DEADLINE, GAP, GGP, OK, ROR, SGP, Host, Reply, TemporaryFolderTest, eventually, request

FARM = """
[[module]]
name = "pump"
kind = "tmcm1110"
tcp = 0
link = "run/pump"
program = "pump.tmc"
eeprom = "pump.eeprom"

[[rs485]]
name = "line"
link = "run/line"
baud_rate = 9600

[[module]]
name = "x"
rs485 = "line"
address = 1

[[module]]
name = "y"
rs485 = "line"
address = 3
tcp = 0
"""


class Farm:
    """`tmcl farm` as a child process."""

    def __init__(self, path, *arguments):
        self.errors = tempfile.TemporaryFile(mode="w+")
        self.process = subprocess.Popen([tmcl_host.tmcl_path(), "--json", "farm", path, "--quiet", *arguments],
                                        stdout=subprocess.PIPE, stderr=self.errors, text=True)
        line = self.process.stdout.readline()
        if not line:
            self.errors.seek(0)
            raise AssertionError("tmcl farm ended with %d: %s" % (self.process.wait(DEADLINE), self.errors.read()))
        places = json.loads(line)
        self.modules = {place["name"]: place for place in places["modules"]}
        self.buses = {place["name"]: place for place in places["buses"]}

    def connect(self, name):
        port = int(self.modules[name]["tcp"].rsplit(":", 1)[1])
        return socket.create_connection(("127.0.0.1", port), timeout=DEADLINE)

    def stop(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(DEADLINE)
        self.process.stdout.close()
        self.errors.close()
        return code


def ask(connection, *command, **options):
    connection.sendall(request(*command, **options))
    data = b""
    while len(data) < 9:
        part = connection.recv(9 - len(data))
        if not part:
            raise AssertionError("the connection was closed after %d bytes" % len(data))
        data += part
    return Reply(data)


class FarmTest(TemporaryFolderTest):
    def start_farm(self, text=FARM, *arguments):
        self.write("pump.tmc", "SGP 5, 2, 42\nSTOP\n")
        farm = Farm(self.write("farm.toml", text), *arguments)
        self.addCleanup(farm.stop)
        return farm

    def open(self, path):
        host = Host(path)
        self.addCleanup(host.close)
        return host

    def test_each_module_has_its_doors(self):
        farm = self.start_farm()
        self.assertEqual({"pump": "TMCM-1110", "x": "PD-1161", "y": "PD-1161"},
                         {name: place["kind"] for name, place in farm.modules.items()})
        pump = self.open(self.path("run/pump"))
        eventually(lambda: pump.do(GGP, 5, 2) == 42, "the program has run")
        with farm.connect("pump") as tcp:
            self.assertEqual(42, ask(tcp, GGP, 5, 2).value)
        with farm.connect("y") as tcp:
            self.assertEqual(0, ask(tcp, GGP, 5, 2).value)

    def test_modules_on_a_line_answer_for_themselves_and_in_the_wire_s_time(self):
        farm = self.start_farm()
        self.assertEqual(("line", 3), (farm.modules["y"]["bus"], farm.modules["y"]["address"]))
        line = self.open(farm.buses["line"]["link"])
        line.ask(GAP, 1, address=1)
        begin = time.monotonic()
        for i in range(5):
            for address in (1, 3):
                reply = line.ask(SGP, 7, 2, 100 * address + i, address=address)
                self.assertEqual((OK, address), (reply.status, reply.module))
        # At least: the machine may be busy.
        self.assertGreaterEqual(time.monotonic() - begin, 10 * 0.01875 - 0.002)
        with farm.connect("y") as tcp:
            self.assertEqual(304, ask(tcp, GGP, 7, 2).value)

    def test_a_flood_at_one_module_leaves_the_others_alone(self):
        farm = self.start_farm()
        with farm.connect("pump") as rude, farm.connect("y") as other:
            rude.setblocking(False)
            flood = request(GAP, 1) * 1000
            for i in range(200):
                try:
                    rude.send(flood)
                except BlockingIOError:
                    pass
                self.assertEqual(OK, ask(other, GAP, 1).status)

    def test_the_eeprom_survives_and_the_links_do_not(self):
        farm = self.start_farm()
        self.open(self.path("run/pump")).do(SGP, 66, 0, 9)
        self.assertEqual(0, farm.stop())
        self.assertEqual([], os.listdir(self.path("run")))
        farm = self.start_farm()
        self.assertEqual(9, self.open(self.path("run/pump")).do(GGP, 66))

    def test_simulated_time_ends_when_it_was_told_to(self):
        farm = self.start_farm(FARM, "--speed", "max", "--duration", "100s")
        self.assertEqual(0, farm.process.wait(DEADLINE))

    def test_mistakes_are_named_with_their_place(self):
        path = self.write("farm.toml", '[[module]]\nname = "a"\ntcpp = 0\n\n[[module]]\nname = "a"\nkind = "pd1162"\n')
        refused = self.tmcl("farm", path)
        self.assertEqual(65, refused.returncode)
        lines = refused.stderr.splitlines()
        self.assertEqual("%s:3:1: error: a [[module]] has no key 'tcpp': did you mean tcp?" % path, lines[1])
        self.assertEqual("%s:7:8: error: no kind is called 'pd1162': did you mean pd1161?" % path, lines[-2])
        self.assertIn("errors", lines[-1])

    def test_a_wrong_program_is_reported_as_by_the_assembler(self):
        self.write("wrong.tmc", "ROR 0,\n")
        path = self.write("farm.toml", '[[module]]\nname = "a"\ntcp = 0\nprogram = "wrong.tmc"\n')
        refused = self.tmcl("farm", "--check", path)
        self.assertEqual(65, refused.returncode)
        self.assertIn("wrong.tmc:1:", refused.stderr)


class ExampleFarm(TemporaryFolderTest):
    def test_runs(self):
        folder = os.path.join(os.path.dirname(__file__), "../../examples/farm")
        for name in os.listdir(folder):
            with open(os.path.join(folder, name), "rb") as file:
                self.write(name, file.read())
        farm = Farm(self.path("farm.toml"))
        self.addCleanup(farm.stop)
        self.assertEqual(15, len(farm.modules))
        gantry = Host(farm.buses["gantry"]["link"])
        self.addCleanup(gantry.close)
        for address in (1, 3):
            self.assertEqual(address, gantry.ask(ROR, 0, 0, 100, address=address).module)
        with farm.connect("pump") as pump:
            eventually(lambda: ask(pump, GAP, 3).value == 500, "the pump turns")
        feeder = Host(farm.modules["feeder-10"]["link"])
        self.addCleanup(feeder.close)
        self.assertEqual(0, feeder.do(GAP, 1))


class PacedSimulation(TemporaryFolderTest):
    def test_a_command_and_its_reply_take_as_long_as_on_the_wire(self):
        simulation = self.start("pd1161", "--wire", "9600")
        host = simulation.host()
        self.addCleanup(host.close)
        host.do(GAP, 1)
        begin = time.monotonic()
        for _ in range(20):
            host.do(GAP, 1)
        self.assertGreaterEqual(time.monotonic() - begin, 20 * 0.01875 - 0.002)


if __name__ == "__main__":
    tmcl_host.main()
