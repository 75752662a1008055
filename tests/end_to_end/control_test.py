"""A client of the control interface, with nothing but Python's own library, while a host talks to the module."""

import json
import os
import signal
import socket
import stat
import subprocess
import sys

import tmcl_host
from tmcl_host import ACTUAL_POSITION, DEADLINE, MAXIMUM_SPEED, MVP, ROR, SAP, TemporaryFolderTest, eventually

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples")


class Control:
    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(DEADLINE)
        self.socket.connect(path)
        self.lines = self.socket.makefile("r")
        self.notifications = []

    def close(self):
        self.lines.close()
        self.socket.close()

    def send(self, data):
        self.socket.sendall(data if isinstance(data, bytes) else data.encode())

    def receive(self):
        return json.loads(self.lines.readline())

    def ask(self, method, **parameters):
        self.send(json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": parameters}) + "\n")
        while True:
            message = self.receive()
            if "method" not in message:
                return message
            self.notifications.append(message["params"])

    def call(self, method, **parameters):
        message = self.ask(method, **parameters)
        if "error" in message:
            raise AssertionError("%s: %s" % (method, message["error"]))
        return message["result"]

    def get(self, name):
        return self.call("get", names=name)["values"][name]


class ControlTest(TemporaryFolderTest):
    def begin(self, *arguments):
        self.simulation = self.start(*arguments)
        self.host = self.simulation.host()
        self.addCleanup(self.host.close)
        self.control = self.connect()

    def connect(self):
        control = Control(self.simulation.introduction["control"])
        self.addCleanup(control.close)
        return control

    def ctl(self, *arguments):
        return self.tmcl("sim", "ctl", "--control", self.simulation.introduction["control"], *arguments)


class LiveControl(ControlTest):
    def setUp(self):
        super().setUp()
        self.begin("pd1161")

    def test_the_socket_is_beside_the_link_and_for_the_user_alone(self):
        path = self.simulation.link + ".control"
        self.assertEqual(path, self.simulation.introduction["control"])
        self.assertEqual(0o600, stat.S_IMODE(os.stat(path).st_mode))
        self.simulation.stop()
        self.assertFalse(os.path.exists(path))

    def test_what_a_client_changes_a_host_finds(self):
        self.control.call("set", values={"left_switch.held_open": 1})
        self.assertTrue(self.control.get("left_switch"))
        left_switch = 11
        self.assertEqual(1, self.host.get(left_switch))
        self.control.call("set", values={"left_switch.held_open": False})
        self.assertEqual(0, self.host.get(left_switch))

    def test_what_a_host_moves_a_client_finds(self):
        self.control.call("subscribe", names=["position"], every=10_000)
        self.host.do(MVP, 0, 0, 1000)
        eventually(lambda: self.control.get("position") == 1000, "the end of the move")
        positions = [change["values"]["position"] for change in self.control.notifications]
        self.assertEqual(sorted(positions), positions)
        self.assertGreater(len(positions), 3)

    def test_time_can_be_stopped_and_stepped(self):
        self.host.do(ROR, 0, 0, 500)
        paused_at = self.control.call("pause")["time"]
        self.assertEqual(paused_at, self.control.call("time")["time"])
        stepped = self.control.call("step", by=250_000)
        self.assertEqual(paused_at + 250_000, stepped["time"])
        self.assertEqual(2, self.control.call("step", turns=2)["turns"])
        self.assertEqual(9_000_000, self.control.call("advance", to=9_000_000)["time"])
        self.control.call("resume")
        self.host.get(ACTUAL_POSITION)

    def test_mistakes_and_clients_that_go_disturb_nobody(self):
        rude = self.connect()
        for text, code in ((b"nonsense\n", -32700), (b"\xff\xfe\n", -32700), (b"[]\n", -32600), (b"{}\n", -32600)):
            rude.send(text)
            self.assertEqual(code, rude.receive()["error"]["code"])
        self.assertEqual(-32601, rude.ask("jump")["error"]["code"])
        self.assertEqual(-32602, rude.ask("set", values={"supply_voltage": 1000})["error"]["code"])
        rude.send(b'{"jsonrpc":"2.0","id":1,"method":"step","params":{"by":100')
        rude.close()
        self.assertEqual(24, self.control.get("supply_voltage"))
        self.host.get(ACTUAL_POSITION)

    def test_a_second_simulation_does_not_take_the_socket(self):
        path = self.simulation.introduction["control"]
        refused = self.tmcl("sim", "--pty-link", self.path("other"), "--tcp", "none", "--control", path)
        self.assertEqual(74, refused.returncode)
        self.assertIn("another simulation listens there", refused.stderr)
        self.control.call("time")

    def test_a_socket_left_over_from_a_killed_program_is_replaced(self):
        self.simulation.stop(signal.SIGKILL)
        self.assertTrue(os.path.exists(self.simulation.link + ".control"))
        self.begin("pd1161")
        self.control.call("time")

    def test_a_snapshot_is_gone_back_to(self):
        self.host.do(MVP, 0, 0, 700)
        eventually(lambda: self.host.get(ACTUAL_POSITION) == 700, "the end of the move")
        self.control.call("pause")
        before = self.control.call("get")
        self.control.call("save", path=self.path("snapshot"))
        self.control.call("resume")
        self.host.do(MVP, 0, 0, -700)
        eventually(lambda: self.host.get(ACTUAL_POSITION) == -700, "the end of the move back")
        self.control.call("pause")
        self.control.call("load", path=self.path("snapshot"))
        self.assertEqual(before, self.control.call("get"))
        self.control.call("resume")
        self.assertEqual(700, self.host.get(ACTUAL_POSITION))

    def test_quit_ends_it(self):
        self.control.call("quit")
        self.assertEqual(0, self.simulation.process.wait(DEADLINE))

    def test_the_example_works(self):
        run = subprocess.run([sys.executable, os.path.join(EXAMPLES, "control.py"),
                              self.simulation.introduction["control"]],
                             capture_output=True, text=True, timeout=DEADLINE, check=True)
        self.assertIn("'supply_voltage': 12", run.stdout)
        self.assertEqual(24, self.control.get("supply_voltage"))


class Shell(ControlTest):
    def setUp(self):
        super().setUp()
        self.begin("pd1161")

    def test_looks_and_changes(self):
        self.assertEqual("24.0 V\n", self.ctl("get", "supply_voltage").stdout)
        self.assertEqual(0, self.ctl("set", "supply_voltage=12.5", "input.3=1").returncode)
        self.assertEqual("supply_voltage = 12.5 V\ninput.3 = 1\n", self.ctl("get", "supply_voltage", "input.3").stdout)
        values = json.loads(self.ctl("get", "supply_voltage", "--json").stdout)["values"]
        self.assertEqual({"supply_voltage": 12.5}, values)
        self.assertIn("analog_input.0", self.ctl("describe").stdout)

    def test_controls_time(self):
        self.ctl("pause")
        before = json.loads(self.ctl("time", "--json").stdout)
        self.assertTrue(before["paused"])
        self.assertEqual("%.6f s\n" % (before["time"] / 1e6 + 0.01), self.ctl("step", "10ms").stdout)
        self.assertEqual(0, self.ctl("speed", "max").returncode)
        self.assertEqual(0, self.ctl("resume").returncode)

    def test_watches(self):
        self.host.do(ROR, 0, 0, 500)
        lines = self.ctl("watch", "position", "--count", "3").stdout.splitlines()
        self.assertEqual(4, len(lines))
        self.assertRegex(lines[0], r"^[0-9.]+ s  position = ")

    def test_has_an_exit_code_for_each_kind_of_mistake(self):
        self.assertEqual(64, self.ctl("get", "nothing").returncode)
        self.assertEqual(64, self.ctl("set", "supply_voltage=1000").returncode)
        self.assertEqual(64, self.ctl("set", "supply_voltage").returncode)
        self.assertEqual(64, self.ctl("step").returncode)
        self.assertEqual(64, self.ctl("jump").returncode)
        self.assertEqual(65, self.ctl("load", self.write("file", "no snapshot\n")).returncode)
        self.assertEqual(74, self.ctl("load", self.path("missing")).returncode)
        self.assertEqual(69, self.tmcl("sim", "ctl", "--control", self.path("nobody"), "time").returncode)
        self.host.do(ROR, 0, 0, 500)
        self.assertEqual(75, self.ctl("advance", "100000h", "--within", "10ms").returncode)


class Faults(ControlTest):
    """What can go wrong at a bench, made and mended from outside."""

    def setUp(self):
        super().setUp()
        self.begin("pd1161")
        self.host.do(ROR, 0, 0, 500)
        self.step(1_000_000)

    def step(self, span):
        self.control.call("step", by=span)

    def set(self, **values):
        self.control.call("set", values=values)

    def test_a_short_of_a_coil_switches_its_bridge_off(self):
        self.set(**{"coil_a.shorted": 1})
        self.step(50_000)
        self.assertTrue(self.control.get("tmc262.short_to_ground_a"))
        self.assertFalse(self.control.get("tmc262.bridges_on"))

    def test_a_broken_wire_of_a_coil_is_an_open_load(self):
        self.set(**{"coil_b.connected": 0})
        self.step(500_000)
        self.assertTrue(self.control.get("tmc262.open_load_b"))

    def test_a_jam_costs_steps(self):
        self.assertEqual(0, self.control.get("rotor.lost_steps"))
        self.set(**{"load.jammed": 1})
        self.step(500_000)
        self.set(**{"load.jammed": 0})
        self.assertGreater(self.control.get("rotor.lost_steps"), 0)

    def test_a_load_is_carried(self):
        self.set(**{"load.torque": 0.1})
        self.step(500_000)
        self.assertAlmostEqual(0.1, self.control.get("motor.torque"), delta=0.05)
        self.assertEqual(0, self.control.get("rotor.lost_steps"))

    def test_without_its_supply_the_motor_stands_still(self):
        self.set(supply_voltage=0)
        self.step(500_000)
        self.assertFalse(self.control.get("tmc262.bridges_on"))
        self.assertAlmostEqual(0, self.control.get("rotor.speed"), delta=1)

    def test_a_power_cycle_stops_it(self):
        self.control.call("power_cycle")
        self.step(10_000)
        self.assertEqual(0, self.control.get("velocity"))

    def test_a_pressed_switch_stops_it(self):
        right_limit_switch_disable = 12
        self.control.call("resume")
        self.host.set(right_limit_switch_disable, 0)
        self.set(**{"right_switch.pressed": 1})
        self.step(50_000)
        self.assertEqual(0, self.control.get("velocity"))


class Recordings(ControlTest):
    def test_begin_and_end_while_it_runs(self):
        self.begin("pd1161", "--speed", "max")
        number = self.ctl("record", self.path("move.vcd"), "--signals", "position,rotor.load_angle").stdout.strip()
        self.host.do(MVP, 0, 0, 1000)
        eventually(lambda: self.host.get(ACTUAL_POSITION) == 1000, "the end of the move")
        self.assertEqual(0, self.ctl("stop-recording", number).returncode)
        recording = self.read("move.vcd")
        self.assertIn(b"load_angle", recording)
        self.assertGreater(recording.count(b"\n#"), 50)
        self.assertEqual(64, self.ctl("stop-recording", number).returncode)
        self.assertEqual(64, self.ctl("record", self.path("move.txt")).returncode)
        self.assertEqual(74, self.ctl("record", self.path("missing/move.vcd")).returncode)


class Replay(ControlTest):
    PROGRAM = "Loop: MVP ABS, 0, 15000\nWAIT POS, 0, 0\nMVP ABS, 0, -15000\nWAIT POS, 0, 0\nJA Loop\n"
    SIGNALS = "position,velocity,step,stage,encoder,rotor.angle,rotor.load_angle,coil_a.current,temperature,right_switch"

    def program(self):
        return self.write("p.tmc", self.PROGRAM)

    def recording(self, name):
        return "--record", self.path(name), "--signals", self.SIGNALS

    def replay(self, *arguments):
        return self.tmcl("sim", "--replay", self.path("log"), *arguments)

    def assert_same(self, first, *others):
        self.assertGreater(len(self.read(first)), 20_000)
        for other in others:
            # Not shown when they differ: they are long.
            self.assertTrue(self.read(first) == self.read(other), "%s is not %s" % (other, first))

    def some_seconds_with_a_host(self):
        self.host.do(SAP, MAXIMUM_SPEED, 0, 900)
        self.control.call("set", values={"temperature": 30, "load.coulomb_friction": 0.03})
        self.host.get(ACTUAL_POSITION)
        self.control.call("step", by=1_234_567)
        self.control.call("set", values={"load.jammed": 1})
        self.control.call("step", by=10_000)
        self.control.call("set", values={"load.jammed": 0, "temperature": 20})
        self.control.call("resume")
        self.host.get(ACTUAL_POSITION)

    def test_a_live_session_is_replayed_signal_by_signal(self):
        self.begin("pd1161", "--program", self.program(), "--log", self.path("log"), "--trace", self.path("trace"),
                   *self.recording("live.vcd"))
        self.some_seconds_with_a_host()
        self.control.call("power_cycle")
        self.host.do(MVP, 0, 0, 500)
        eventually(lambda: self.host.get(ACTUAL_POSITION) == 500, "the end of the move")
        self.assertEqual(0, self.simulation.stop())
        replayed = self.replay("--trace", self.path("trace_again"), *self.recording("again.vcd"))
        self.assertEqual((0, ""), (replayed.returncode, replayed.stderr))
        self.assert_same("trace", "trace_again")
        self.assert_same("live.vcd", "again.vcd")

    def test_a_line_that_takes_its_time_is_in_the_log(self):
        self.begin("pd1161", "--wire", "9600", "--log", self.path("log"), "--trace", self.path("trace"))
        self.host.do(MVP, 0, 0, 5000)
        eventually(lambda: self.host.get(ACTUAL_POSITION) == 5000, "the end of the move")
        self.assertEqual(0, self.simulation.stop())
        self.assertIn(b'"wire":9600', self.read("log"))
        self.assertEqual(0, self.replay("--trace", self.path("again")).returncode)
        self.assert_same("trace", "again")

    def test_a_scenario_is_replayed_with_its_report(self):
        scenario = self.write("s.toml", '''
            duration = "2 s"
            program = "p.tmc"
            [[event]]
            at = "500 ms"
            pulse = { load.jammed = true }
            lasting = "20 ms"
            note = "a jam"
            [[event]]
            when = "position > 10000"
            send = "SAP 4, 0, 600"
            [[expect]]
            at = "1 s"
            that = "position = 1"
            [[expect]]
            at = "1 s"
            that = "maximum_velocity > 0"
            ''')
        self.program()
        live = self.tmcl("sim", "--scenario", scenario, "--log", self.path("log"), *self.recording("live.vcd"), "--speed",
                         "max", "--quiet", "--tcp", "none", "--pty-link", self.path("link"))
        replayed = self.replay(*self.recording("again.vcd"))
        self.assertEqual(1, live.returncode)
        self.assertEqual(1, replayed.returncode)
        report = [line for line in live.stdout.splitlines() if line.startswith(scenario)]
        self.assertEqual(4, len(report))
        self.assertIn("FAILED: position = 1", live.stdout)
        self.assertEqual(report, [line for line in replayed.stdout.splitlines() if line.startswith(scenario)])
        self.assert_same("live.vcd", "again.vcd")

    def test_a_changed_log_is_noticed(self):
        self.begin("pd1161", "--log", self.path("log"))
        self.host.do(MVP, 0, 0, 500)
        self.simulation.stop()
        log = self.read("log")
        self.assertIn(b"01040000000001F4", log)
        self.write("log", log.replace(b"01040000000001F4", b"01040000000001F5"))
        replayed = self.replay()
        self.assertEqual(65, replayed.returncode)
        self.assertIn("departed from the recorded session", replayed.stderr)

    def test_a_session_goes_on_from_a_snapshot_as_the_first_one_did(self):
        self.begin("pd1161", "--program", self.program(), *self.recording("live.vcd"), "--trace", self.path("trace"))
        self.some_seconds_with_a_host()
        self.control.call("pause")
        self.control.call("save", path=self.path("snapshot"))
        end = self.control.call("step", by=2_000_000)["time"]
        self.control.call("quit")
        self.assertEqual(0, self.simulation.process.wait(DEADLINE))
        self.begin("--load", self.path("snapshot"), *self.recording("again.vcd"), "--trace", self.path("trace_again"),
                   "--speed", "0.000001")
        self.control.call("advance", to=end)
        self.control.call("quit")
        self.assertEqual(0, self.simulation.process.wait(DEADLINE))
        self.assert_same("live.vcd", "again.vcd")
        self.assert_same("trace", "trace_again")

    def test_the_speed_changes_nothing(self):
        scenario = self.write("s.toml", '''
            duration = "1500 ms"
            program = "p.tmc"
            [[event]]
            at = "400 ms"
            send = ["SAP 4, 0, 700", "GAP 1, 0"]
            [[event]]
            at = "800 ms"
            pulse = { load.coulomb_friction = 0.9 }
            lasting = "30 ms"
            ''')
        self.program()
        for speed in ("1", "100", "max"):
            ended = self.tmcl("sim", "--scenario", scenario, "--speed", speed, *self.recording(speed + ".vcd"), "--trace",
                              self.path(speed), "--pty-link", self.path("link"), "--tcp", "none", "--quiet")
            self.assertEqual((0, ""), (ended.returncode, ended.stderr))
        self.assert_same("1.vcd", "100.vcd", "max.vcd")
        self.assert_same("1", "100", "max")


if __name__ == "__main__":
    tmcl_host.main()
