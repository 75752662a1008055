"""Scenarios and recordings from the command line."""

import glob
import json
import os
import tomllib

import jsonschema

import tmcl_host
from tmcl_host import TemporaryFolderTest

PROJECT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
EXAMPLES = sorted(path for path in glob.glob(os.path.join(PROJECT, "examples", "*s", "*.toml"))
                  if not path.endswith(".farm.toml"))

MOVE = """
duration = "600 ms"
[[event]]
at = "50 ms"
send = "MVP ABS, 0, 3000"
[[event]]
when = "position > 1000"
pulse = { home_switch.held_open = true }
lasting = "3.3 ms"
"""


class ScenarioTest(TemporaryFolderTest):
    def sim(self, code, *arguments):
        done = self.tmcl("sim", *arguments, "--tcp", "none", "--quiet", "--pty-link", self.path("link"))
        self.assertEqual(code, done.returncode, "%r: %s%s" % (arguments, done.stdout, done.stderr))
        return done


class Scenarios(ScenarioTest):
    def test_a_failed_expectation_is_named_and_gives_exit_code_1(self):
        expectation = '[[expect]]\nat = "600 ms"\nthat = "position = %d"\n'
        done = self.sim(0, "--speed", "max", "--scenario", self.write("s.toml", MOVE + expectation % 3000))
        self.assertIn("s.toml:10: 0.600000 s: as expected: position = 3000; position is 3000", done.stdout)
        done = self.sim(1, "--speed", "max", "--scenario", self.write("s.toml", MOVE + expectation % 3001))
        self.assertIn("s.toml:10: 0.600000 s: FAILED: position = 3001; position is 3000", done.stdout)

    def test_the_program_stands_beside_the_scenario(self):
        os.mkdir(self.path("folder"))
        self.write("folder/p.tmc", "SIO 0, 2, 1\nSTOP\n")
        scenario = self.write("folder/s.toml", 'program = "p.tmc"\nduration = "1 s"\n'
                              '[[expect]]\nby = "1 s"\nthat = "output.0"\n')
        self.sim(0, "--speed", "max", "--scenario", scenario)

    def test_a_program_that_is_not_there_is_named_with_its_place(self):
        scenario = self.write("s.toml", 'duration = "1 s"\nprogram = "nowhere.tmc"\n')
        for command in (("scenario", "check"), ("sim", "--scenario")):
            done = self.tmcl(*command, scenario)
            self.assertEqual(65, done.returncode)
            self.assertRegex(done.stderr, r"s\.toml:2:11: there is no file '.*nowhere\.tmc'")

    def test_signals_without_a_recording_are_refused(self):
        done = self.tmcl("sim", "--duration", "1s", "--tcp", "none", "--quiet", "--signals", "position",
                         "--pty-link", self.path("link"))
        self.assertEqual(64, done.returncode)
        self.assertIn("--record FILE", done.stderr)

    def test_all_mistakes_are_found_with_their_places(self):
        scenario = self.write("s.toml", 'duration = 5\n[[event]]\nat = "1 s"\nset = { suply_voltage = 3 }\n')
        for command in (("scenario", "check"), ("sim", "--scenario")):
            done = self.tmcl(*command, scenario)
            self.assertEqual(65, done.returncode)
            self.assertIn('s.toml:1:12: expected a time such as "2.5 s" or "30 ms"\n', done.stderr)
            self.assertIn("s.toml:4:9: there is no quantity 'suply_voltage': did you mean supply_voltage?\n", done.stderr)

    def test_the_scenario_says_which_module_and_machine_there_are(self):
        scenario = self.write("s.toml", MOVE)
        self.assertEqual(64, self.tmcl("sim", "tmcm1110", "--scenario", scenario).returncode)
        self.assertEqual(64, self.tmcl("sim", "--machine", "free", "--scenario", scenario).returncode)

    def test_the_examples_have_no_mistakes(self):
        self.assertGreaterEqual(len(EXAMPLES), 10)
        done = self.tmcl("scenario", "check", *EXAMPLES)
        self.assertEqual((0, ""), (done.returncode, done.stderr))


class Schema(ScenarioTest):
    def setUp(self):
        super().setUp()
        self.schema = jsonschema.Draft202012Validator(json.loads(self.tmcl("scenario", "schema").stdout))

    def test_is_met_by_the_examples(self):
        for example in EXAMPLES:
            with open(example, "rb") as file:
                self.schema.validate(tomllib.load(file))

    def test_is_not_met_by_mistakes(self):
        for mistake in ("", 'duration = 5', 'duration = "5 s"\nspeed = 3',
                        'duration = "5 s"\n[[event]]\nset = { suply_voltage = 3 }',
                        'duration = "5 s"\n[[event]]\nset = { position = 3 }',
                        'duration = "5 s"\n[machine]\nkind = "rotary stage"'):
            with self.assertRaises(jsonschema.ValidationError, msg=mistake):
                self.schema.validate(tomllib.loads(mistake))


class Recordings(ScenarioTest):
    def test_are_the_same_at_every_speed(self):
        scenario = self.write("s.toml", MOVE)
        signals = "position,stage,encoder,home_switch,rotor.angle,tmc429.datagram"
        for speed in ("1", "20", "max"):
            self.sim(0, "--speed", speed, "--scenario", scenario, "--record", self.path(speed + ".vcd"), "--signals",
                     signals)
        self.assertGreater(len(self.read("1.vcd")), 10000)
        self.assertEqual(self.read("1.vcd"), self.read("max.vcd"))
        self.assertEqual(self.read("20.vcd"), self.read("max.vcd"))

    def test_are_the_same_when_somebody_looks(self):
        """The live line asks the firmware, and so causes datagrams, but nothing else."""
        for name, options in (("live", ("--speed", "3")), ("unseen", ("--speed", "max", "--quiet"))):
            done = self.tmcl("sim", *options, "--scenario", self.write("s.toml", MOVE), "--tcp", "none", "--pty-link",
                             self.path("link"), "--record", self.path(name + ".vcd"))
            self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual(self.read("live.vcd"), self.read("unseen.vcd"))

    def test_need_no_scenario(self):
        program = self.write("p.tmc", "MVP ABS, 0, 1000\nWAIT POS, 0, 0\nSTOP\n")
        self.sim(0, "--speed", "max", "--duration", "300ms", "--program", program, "--record", self.path("r.csv"),
                 "--signals", "position,velocity", "--record-every", "10ms")
        lines = self.read("r.csv").decode().splitlines()
        self.assertEqual("time [s],position,velocity", lines[0])
        self.assertEqual("0.3,1000,0", lines[-1])

    def test_of_unknown_signals_are_refused(self):
        done = self.sim(64, "--record", self.path("r.csv"), "--signals", "positoin")
        self.assertIn("did you mean position?", done.stderr)
        self.sim(64, "--record", self.path("r.txt"))
        self.sim(74, "--record", self.path("no/such/folder.csv"))


if __name__ == "__main__":
    tmcl_host.main()
