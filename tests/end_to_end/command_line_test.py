"""Sub-commands, their output and their exit codes."""

import json
import os
import pty
import signal
import subprocess

import tmcl_host
from tmcl_host import ACTUAL_SPEED, TemporaryFolderTest, eventually, tmcl_path

PROGRAM = "MVP ABS, 0, 2000\nWAIT POS, 0, 0\nSTOP\n"
ENDLESS = "Loop: ROR 0, 300\nJA Loop\n"


class CommandLineTest(TemporaryFolderTest):
    def expect(self, code, *arguments, **options):
        done = self.tmcl(*arguments, **options)
        self.assertEqual(code, done.returncode, "%r: %s" % (arguments, done.stderr))
        return done

    def json(self, *arguments):
        return json.loads(self.expect(0, "--json", *arguments).stdout)


class WithNothingPluggedIn(CommandLineTest):
    def test_reads_parameters_by_number_symbol_and_name(self):
        for name in ("140", "APMicrostepResolution", "microstep-resolution", "microstep resolution"):
            self.assertEqual("8", self.expect(0, "get", name).stdout.split()[0])
        self.assertEqual("1", self.expect(0, "get", "--global", "0", "serial-address").stdout.split()[0])

    def test_shows_units_and_physical_values(self):
        data = self.json("get", "maximum-positioning-speed")
        self.assertEqual((4, 1000, "internal velocity"), (data["number"], data["value"], data["unit"]))
        self.assertEqual("30517.6 microsteps/s = 35.76 rpm", data["physical"])
        self.assertEqual("0 microsteps = 0 turns\n", self.expect(0, "get", "actual-position").stdout)
        self.assertEqual("set to 100 = 1098 mA\n", self.expect(0, "set", "maximum-current", "100").stderr)

    def test_writes_parameters(self):
        self.expect(0, "set", "maximum-current", "100")
        self.expect(0, "set", "--global", "2", "7", "--", "-5")

    def test_moves_and_rotates_and_stops(self):
        self.assertEqual("5000", self.expect(0, "move", "5000", "--wait").stdout.strip())
        self.assertEqual({"position": -300}, self.json("move", "--wait", "--", "-300"))
        self.expect(0, "rotate", "500")
        self.expect(0, "rotate", "--", "-500")
        self.expect(0, "stop")

    def test_sends_any_instruction(self):
        done = self.expect(0, "send", "MVP ABS, 0, 1000")
        self.assertIn("01 04 00 00 00 00 03 E8 F0", done.stdout)
        self.assertIn("status 100", done.stdout)
        self.assertEqual(1161 << 16 | 1 << 8 | 47, self.json("send", "136", "1", "0", "0")["value"])
        self.assertEqual("version 1161V147", self.json("send", "136 0 0 0")["meaning"])

    def test_prints_all_tables(self):
        spec = self.json("spec")
        self.assertEqual({"modules", "instructions", "axis_parameters", "global_parameters", "user_variables", "coordinates",
                          "interrupts", "status_codes", "io_ports", "functions"}, set(spec))
        self.assertIn("MVP", self.expect(0, "spec").stdout)

    def test_tells_versions(self):
        self.assertRegex(self.expect(0, "version").stdout, r"^tmcl \d+\.\d+\.\d+\n$")
        self.assertEqual("TMCM-1110", self.json("version", "--port", "sim:tmcm1110")["module"])

    def test_takes_the_port_from_the_environment(self):
        environment = dict(os.environ, TMCL_PORT="sim:tmcm1110")
        self.assertIn("1110V108", self.expect(0, "version", env=environment).stdout)

    def test_runs_a_program_to_its_end(self):
        done = self.expect(0, "run", self.write("p.tmc", PROGRAM))
        self.assertIn("position 2000", done.stdout)
        result = self.json("run", "--quiet", self.path("p.tmc"))
        self.assertEqual(("stopped", 2000), (result["program"], result["position"]))

    def test_ends_a_program_after_a_duration(self):
        self.expect(0, "run", "--quiet", "--duration", "10s", self.write("p.tmc", ENDLESS))

    def test_simulates_a_stage_or_a_free_shaft(self):
        sim = ("sim", "--tcp", "none", "--pty-link", self.path("port"), "--speed", "max", "--duration", "1s")
        self.assertIn("  0.00 mm", self.expect(0, *sim).stderr)
        self.assertNotIn(" mm", self.expect(0, *sim, "--machine", "free").stderr)

    def test_has_help_with_examples_for_each_command(self):
        self.assertIn("Examples:", self.expect(0, "--help").stdout)
        for command in "sim asm dis fmt run get set rotate move stop send spec version".split():
            self.assertIn("Example", self.expect(0, command, "--help").stdout, command)


class AssemblerCommands(CommandLineTest):
    def test_assemble_and_disassemble_are_inverse(self):
        source = self.write("p.tmc", PROGRAM)
        self.expect(0, "asm", source)
        binary = self.read("p.bin")
        self.assertEqual(24, len(binary))
        self.write("again.tmc", self.expect(0, "dis", self.path("p.bin")).stdout)
        self.expect(0, "asm", self.path("again.tmc"), "-o", self.path("again.bin"))
        self.assertEqual(binary, self.read("again.bin"))

    def test_a_stop_is_appended_unless_told_otherwise(self):
        source = self.write("p.tmc", "ROR 0, 100\n")
        self.expect(0, "asm", source, "-o", self.path("with.bin"))
        self.expect(0, "asm", source, "-o", self.path("without.bin"), "--no-append-stop")
        self.assertEqual((16, 8), (len(self.read("with.bin")), len(self.read("without.bin"))))

    def test_a_listing_shows_the_source(self):
        listing = self.expect(0, "asm", self.write("p.tmc", PROGRAM), "--listing", "-").stdout
        self.assertIn("WAIT POS, 0, 0", listing)

    def test_errors_are_shown_with_their_place_and_no_file_is_written(self):
        done = self.expect(65, "asm", self.write("bad.tmc", "ROR 0, 100\n  NOP\nJA Nowhere\n"))
        self.assertIn("bad.tmc:2:3: error:", done.stderr)
        self.assertIn("bad.tmc:3:4: error:", done.stderr)
        self.assertFalse(os.path.exists(self.path("bad.bin")))

    def test_an_instruction_the_module_lacks_is_an_error(self):
        source = self.write("p.tmc", "CALCVV ADD, 1, 2\n")
        self.expect(0, "asm", source)
        self.assertIn("TMCM-1110", self.expect(65, "asm", source, "--module", "tmcm1110").stderr)

    def test_a_damaged_binary_is_refused(self):
        self.expect(65, "dis", self.write("p.bin", b"1234567"))
        self.expect(65, "dis", self.path("missing.bin"))


    def test_comments_say_what_instructions_are_about(self):
        self.expect(0, "asm", self.write("p.tmc", "SAP 4, 0, 1000\n"))
        with_comments = self.expect(0, "dis", self.path("p.bin")).stdout
        self.assertIn("SAP 4, 0, 1000          // maximum positioning speed = 35.8 rpm\n", with_comments)
        self.assertNotIn("rpm", self.expect(0, "dis", "--no-comments", self.path("p.bin")).stdout)

    def test_the_program_in_a_module_can_be_read(self):
        program = self.write("p.tmc", PROGRAM)
        self.expect(0, "asm", program)
        simulation = self.start("pd1161", "--program", program)
        port = ("--port", "tcp://127.0.0.1:%d" % simulation.tcp_port)
        eventually(lambda: self.tmcl(*port, "dis").returncode == 0, "the program is loaded")
        self.assertEqual(self.expect(0, "dis", self.path("p.bin")).stdout, self.expect(0, *port, "dis").stdout)
        self.assertEqual([3, []], [self.json(*port, "dis")[key] for key in ("instructions", "problems")])
        # Nothing is left of a longer program behind a shorter one.
        self.expect(0, *port, "run", self.write("short.tmc", "MVP ABS, 0, 2000\n"))
        self.assertEqual(2, self.json(*port, "dis")["instructions"])
        self.expect(0, *port, "set", "--global", "0", "81", "1")
        self.assertIn("protected against reading", self.expect(1, *port, "dis").stderr)
        self.assertIn("no program", self.expect(1, "dis").stderr)


class Formatting(CommandLineTest):
    UNTIDY = "l: stop\nmst 0 // halt\n"
    TIDY = "l:\n    STOP\n    MST 0                   // halt\n"

    def test_replaces_files_and_keeps_links_and_permissions(self):
        source = self.write("p.tmc", self.UNTIDY)
        os.chmod(source, 0o640)
        os.symlink(source, self.path("link.tmc"))
        done = self.expect(0, "fmt", self.path("link.tmc"))
        self.assertEqual(("", ""), (done.stdout, done.stderr))
        self.assertEqual(self.TIDY.encode(), self.read("p.tmc"))
        self.assertTrue(os.path.islink(self.path("link.tmc")))
        self.assertEqual(0o640, os.stat(source).st_mode & 0o777)
        self.assertEqual({"p.tmc", "link.tmc"}, set(os.listdir(os.path.dirname(source))))

    def test_checks_without_writing(self):
        untidy, tidy = self.write("untidy.tmc", self.UNTIDY), self.write("tidy.tmc", self.TIDY)
        self.assertEqual(untidy + "\n", self.expect(1, "fmt", "--check", untidy, tidy).stdout)
        self.assertEqual("", self.expect(0, "fmt", "--check", tidy).stdout)
        self.assertEqual([True, False], [entry["changed"] for entry in self.json("fmt", "--diff", untidy, tidy)])
        self.assertEqual(self.TIDY, self.expect(0, "fmt", "--stdout", untidy).stdout)
        self.assertEqual(self.UNTIDY.encode(), self.read("untidy.tmc"))

    def test_shows_a_diff_that_patch_takes(self):
        text = "// 1\n// 2\n// 3\n// 4\n\n\n" + self.UNTIDY + "// 5\n" * 9 + " stop"
        source = self.write("p.tmc", text)
        diff = self.expect(0, "fmt", "--diff", source).stdout
        subprocess.run(["patch", "--quiet", source], input=diff, text=True, check=True, timeout=30)
        self.expect(0, "fmt", "--check", source)

    def test_is_a_filter(self):
        self.assertEqual(self.TIDY, self.expect(0, "fmt", "-", input=self.UNTIDY).stdout)

    def test_names_lines_it_leaves_alone(self):
        source = self.write("p.tmc", "stop\n 5 apples\n")
        self.assertIn("p.tmc:2: ", self.expect(0, "fmt", source).stderr)
        self.assertEqual(b"    STOP\n 5 apples\n", self.read("p.tmc"))

    def test_goes_on_after_a_file_that_is_missing(self):
        source = self.write("p.tmc", self.UNTIDY)
        self.assertIn("missing.tmc", self.expect(65, "fmt", self.path("missing.tmc"), source).stderr)
        self.assertEqual(self.TIDY.encode(), self.read("p.tmc"))


class Assembling(CommandLineTest):
    """Every command that assembles has the options of `tmcl asm` for it."""

    def setUp(self):
        super().setUp()
        os.mkdir(self.path("library"))
        self.write("library/speed.tmc", "Speed = 100\n")
        source = self.write("p.tmc", "#include speed.tmc\nUnused = 5\nMVP ABS, 0, Speed\n")
        farm = self.write("farm.toml", '[[module]]\nname = "a"\ntcp = 0\nprogram = "p.tmc"\n')
        scenario = self.write("scenario.toml", 'program = "p.tmc"\nduration = "10 ms"\n')
        quiet = ("--quiet", "--pty-link", self.path("link"), "--tcp", "none", "--control", "none")
        self.commands = (("asm", source), ("run", source), ("farm", "--check", farm), ("scenario", "check", scenario),
                         ("sim", *quiet, "--duration", "10ms", "--program=" + source), ("sim", *quiet, "--scenario=" + scenario),
                         ("debug", "-e", "quit", source))

    def test_includes_from_other_folders(self):
        for command in self.commands:
            self.assertIn("speed.tmc", self.expect(65, *command).stderr)
            # Nor does the option take a file that comes behind its folder.
            self.expect(0, *command[:-1], "-I", self.path("library"), command[-1])

    def test_warns_of_what_is_not_switched_off(self):
        for command in self.commands:
            command = (*command, "-I", self.path("library"))
            self.assertIn("[unused-constant]", self.expect(0, *command).stderr)
            self.assertNotIn("unused-constant", self.expect(0, *command, "--no-warning", "unused-constant").stderr)
            self.assertIn("[unused-constant]", self.expect(65, *command, "--warnings-as-errors").stderr)
            misspelt = self.expect(64, *command, "--no-warning", "unused-constants").stderr
            self.assertIn("did you mean unused-constant?", misspelt)


class ModulesOfPrograms(CommandLineTest):
    """A source can say in a comment which module it is for."""

    CALL = "// module: %s\nCALL ZE, Sub\nSTOP\nSub: RSUB\n"

    def test_are_those_of_the_virtual_module(self):
        for module, title in (("pd1161", "PD-1161"), ("tmcm1110", "TMCM-1110")):
            source = self.write(module + ".tmc", "// module: %s\nWAIT TICKS, 0, 100\n" % module)
            simulation = self.start("--program", source)
            self.assertEqual(title, simulation.introduction["module"])
            port = ("--port", simulation.introduction["tcp"])
            self.expect(0, *port, "run", source)
            simulation.stop()
        # The PD-1161 has CALL, the TMCM-1110 has not.
        self.expect(0, "run", self.write("call.tmc", self.CALL % "pd1161"))
        self.assertIn("CALL is not available on the TMCM-1110", self.expect(65, "run", self.write("call.tmc", self.CALL % "tmcm1110")).stderr)

    def test_are_not_confused_with_another(self):
        source = self.write("call.tmc", self.CALL % "tmcm1110")
        simulation = self.start("pd1161")
        port = ("--port", simulation.introduction["tcp"])
        self.assertIn("is for a TMCM-1110, and at", self.expect(65, *port, "run", source).stderr)
        self.assertIn("no program", self.expect(1, *port, "dis").stderr)
        self.expect(0, *port, "run", "--module", "pd1161", source)
        for command in (("run",), ("sim", "--program"), ("asm",), ("debug",)):
            self.assertIn("tmcm9", self.expect(65, *command, self.write("unknown.tmc", "// module: tmcm9\n")).stderr)


class StandardInput(CommandLineTest):
    def test_is_a_source_or_a_binary(self):
        self.expect(0, "asm", "-", "-o", self.path("p.bin"), input="ROR 0, 100\n")
        self.expect(0, "run", "-", input="ROR 0, 100\n")
        with open(self.path("p.bin"), encoding="latin-1") as binary:
            listed = self.expect(0, "dis", "-", input=binary.read()).stdout
        self.assertEqual(self.expect(0, "dis", self.path("p.bin")).stdout, listed)
        self.assertIn("-:1:1: error:", self.expect(65, "asm", "-", "-o", self.path("x.bin"), input="RORR 0\n").stderr)

    def test_has_no_name_for_other_files(self):
        self.assertIn("-o", self.expect(64, "asm", "-", input="ROR 0, 100\n").stderr)
        self.assertIn("standard input has the debugger's commands", self.expect(64, "debug", "-", input="quit\n").stderr)


class ExitCodes(CommandLineTest):
    def test_1_when_the_module_says_no(self):
        self.assertIn("status 4", self.expect(1, "set", "4", "5000").stderr)
        self.expect(1, "get", "99")
        self.expect(1, "send", "200 0 0 0")

    def test_64_for_wrong_usage(self):
        for arguments in ([], ["dance"], ["get"], ["get", "no such parameter"], ["rotate", "99999"], ["--timeout", "soon", "stop"],
                          ["--port", "nowhere", "stop"], ["--port", "sim:tmcm9999", "stop"], ["--port", "tcp://x", "stop"],
                          ["sim", "tmcm9999"], ["sim", "--speed", "fast"], ["sim", "--duration", "5"], ["sim", "--machine", "wheel"],
                          ["send", "DANCE 0"],
                          ["send", "1 2"], ["asm", "--module", "x", "y"]):
            self.assertNotEqual("", self.expect(64, *arguments).stderr)

    def test_69_when_there_is_no_such_device(self):
        self.assertIn("/dev/no_such_port", self.expect(69, "--port", "/dev/no_such_port", "stop").stderr)
        self.expect(69, "--port", "/dev/null", "stop")
        self.expect(69, "--port", "tcp://127.0.0.1:1", "stop")

    def test_75_when_nobody_answers(self):
        ours, theirs = pty.openpty()
        try:
            path = os.ttyname(theirs)
            self.assertIn("no answer", self.expect(75, "--port", path, "--timeout", "50ms", "stop").stderr)
        finally:
            os.close(ours)
            os.close(theirs)


class OverASerialPort(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.simulation = self.start("pd1161", "--speed", "10")

    def at(self, code, *arguments):
        return self.expect(code, "--port", self.simulation.link, *arguments)

    def program_is_running(self):
        return self.json("--port", self.simulation.introduction["tcp"], "send", "135 0 0 0")["value"] >> 24 == 1

    def test_commands_act_on_one_and_the_same_module(self):
        self.at(0, "set", "4", "777")
        self.assertEqual("777", self.at(0, "get", "4").stdout.split()[0])
        self.assertEqual("3000", self.at(0, "move", "3000", "--wait").stdout.strip())
        self.assertIn("1161V147", self.at(0, "version").stdout)

    def test_commands_reach_it_over_tcp_too(self):
        self.expect(0, "--port", self.simulation.introduction["tcp"], "set", "4", "778")
        self.assertEqual("778", self.at(0, "get", "4").stdout.split()[0])

    def test_a_program_is_loaded_verified_and_followed(self):
        done = self.at(0, "run", self.write("p.tmc", PROGRAM))
        self.assertIn("program stopped", done.stdout)
        self.assertIn("position 2000", done.stdout)

    def test_control_c_stops_program_and_motor(self):
        process = subprocess.Popen([tmcl_path(), "--port", self.simulation.introduction["tcp"], "run", "--quiet",
                                    self.write("p.tmc", ENDLESS)], stderr=subprocess.PIPE, text=True)
        host = self.simulation.host()
        self.addCleanup(host.close)
        # Until it is loaded, any command but one about the program would become a part of it.
        eventually(lambda: host.program_state() == 1, "the program's start")
        eventually(lambda: host.get(ACTUAL_SPEED) == 300, "the program's speed")
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=tmcl_host.DEADLINE)[1]
        self.assertEqual(130, process.returncode, errors)
        self.assertEqual(0, host.program_state())
        eventually(lambda: host.get(ACTUAL_SPEED) == 0, "standstill")

    def test_a_port_in_use_by_another_tmcl_is_refused(self):
        process = subprocess.Popen([tmcl_path(), "--port", self.simulation.link, "run", "--quiet",
                                    self.write("p.tmc", ENDLESS)], stderr=subprocess.PIPE, text=True)
        try:
            eventually(self.program_is_running, "the program's start")
            self.assertIn("in use", self.at(69, "get", "1").stderr)
        finally:
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=tmcl_host.DEADLINE)
        self.assertEqual(130, process.returncode)


if __name__ == "__main__":
    tmcl_host.main()
