"""`tmcl debug`: scripts on a twin and on a module at a pseudo terminal, and a person at a real terminal."""

import json
import os
import pty
import re
import select
import signal
import socket
import subprocess
import time

import tmcl_host
from debugged_programs import CALCULATES, CODE_PROTECTION, COUNTING, ENDLESS, READS
from tmcl_host import DEADLINE, TemporaryFolderTest, eventually

# As ENDLESS, but it can say that it has run for a while.
TALKING = "Loop: CALC ADD, 1\nCOMP 1000\nJC EQ, Once\nJA Loop\nOnce: JA Loop\n"


class Script(TemporaryFolderTest):
    """Commands from arguments and from standard input, on a twin."""

    def debug(self, source, *commands, arguments=()):
        options = [part for command in commands for part in ("-e", command)]
        return self.tmcl("debug", self.write("my.tmc", source), *arguments, *options)

    def debug_input(self, source, text):
        return subprocess.run([tmcl_host.tmcl_path(), "debug", self.write("my.tmc", source)], input=text,
                              capture_output=True, text=True, timeout=DEADLINE, check=False)

    def test_stops_at_a_breakpoint_and_shows_the_line(self):
        done = self.debug(COUNTING, "break Work if A >= 5", "run", "print VAR(2)", "bt")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("breakpoint 1, at Work, %s:%d" % (self.path("my.tmc"), READS), done.stdout)
        self.assertRegex(done.stdout, r"=> +%d Work: +GGP 2, 2" % READS)
        self.assertIn("VAR(2) = 5\n", done.stdout)
        self.assertRegex(done.stdout, r"#1 +Loop\+1")

    def test_goes_back_in_time(self):
        done = self.debug(COUNTING, "break Work+2", "run", "continue", "print A", "reverse-step", "print A", "rc",
                          "print VAR(2)", "rc")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual(["A = 10", "A = 5"], re.findall(r"^A = .*", done.stdout, re.M))
        self.assertIn("VAR(2) = 0\n", done.stdout)
        self.assertIn("the beginning of the history", done.stdout)

    def test_shows_what_no_module_shows(self):
        done = self.debug("COMP -1\nCSUB Sub\nSub: STOP\n", "step 2", "info registers")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("comparison   greater", done.stdout)
        self.assertIn("stack depth  1", done.stdout)

    def test_stops_at_a_signal_of_the_bench(self):
        done = self.debug("ROR 0, 1000\n" + ENDLESS, "signal velocity > 500", "run", "measure velocity")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertRegex(done.stdout, r"breakpoint 1: velocity > 500: velocity is 50\d")

    def test_a_script_ends_at_its_first_error_with_its_exit_code(self):
        for script, code, message in (("break Lop\nrun\n", 64, "did you mean Loop?"),
                                      ("print GAP(255)\nrun\n", 1, "refused"),
                                      ("nonsense\n", 64, "no command 'nonsense'"),
                                      ("step\nfinish\n", 64, "no subroutine is open")):
            done = self.debug_input(COUNTING, script)
            self.assertEqual(code, done.returncode, done.stderr)
            self.assertIn(message, done.stderr)
            self.assertNotIn("ended", done.stdout)

    def test_ctrl_c_ends_a_script_that_waits_for_commands(self):
        debugger = subprocess.Popen([tmcl_host.tmcl_path(), "debug", self.write("my.tmc", COUNTING)],
                                    stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        debugger.stdout.readline()
        debugger.send_signal(signal.SIGINT)
        self.assertEqual(130, debugger.wait(DEADLINE))
        debugger.communicate()

    def test_no_script_hangs(self):
        done = self.debug(ENDLESS, "continue", arguments=("--limit", "2s"))
        self.assertEqual(75, done.returncode)
        self.assertIn("time limit", done.stderr)

    def test_a_bad_source_is_refused_with_its_place(self):
        done = self.debug("RORR 0, 1\n", "run")
        self.assertEqual(65, done.returncode)
        self.assertIn("my.tmc:1:1: error:", done.stderr)

    def test_events_are_objects_with_json(self):
        path = self.write("my.tmc", COUNTING)
        done = self.tmcl("--json", "debug", path, "-e", "log Work here {A}", "-e", "break DoesNotMatter", "-e", "run")
        self.assertEqual(64, done.returncode)
        done = self.tmcl("--json", "debug", path, "-e", "log Work VAR {VAR(2)}", "-e", "run", "-e", "print A")
        self.assertEqual(0, done.returncode, done.stderr)
        events = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual(["stopped", "breakpoint", "output", "output", "output", "stopped", "value"],
                         [event["event"] for event in events])
        self.assertEqual({"reason": "entry", "address": 0, "line": 3},
                         {key: events[0][key] for key in ("reason", "address", "line")})
        self.assertEqual("VAR 5", events[3]["text"])
        self.assertEqual("ended", events[5]["reason"])
        self.assertEqual(15, events[6]["value"])

    def test_an_empty_line_shows_further_instructions(self):
        done = self.debug_input(COUNTING, "x Loop 2\n\n")
        self.assertEqual(0, done.returncode, done.stderr)
        shown = re.findall(r"^ +(\d+)  \w", done.stdout, re.M)
        self.assertEqual([str(address) for address in range(1, 13)], shown)

    def test_the_bench_of_a_scenario_is_around_the_twin(self):
        self.write("wait.tmc", "Loop: GIO 1, 0\nJC ZE, Loop\nSTOP\n")
        bench = self.write("bench.toml", 'module = "pd1161"\nprogram = "wait.tmc"\nduration = "1 s"\n'
                           '[[event]]\nat = "20 ms"\nset = { "input.1" = 1 }\nnote = "pressed"\n')
        done = self.tmcl("debug", "--scenario", bench, "-e", "run", "-e", "rs", "-e", "continue")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual(1, done.stdout.count("pressed"))
        self.assertEqual(2, done.stdout.count("the program has ended"))


class Module(TemporaryFolderTest):
    """`tmcl debug` at the serial port of a module."""

    def setUp(self):
        super().setUp()
        self.simulation = self.start("pd1161")

    def debug(self, source, *arguments):
        options = [argument for argument in arguments if argument.startswith("--")]
        commands = [part for command in arguments if not command.startswith("--") for part in ("-e", command)]
        return self.tmcl("--port", self.simulation.link, "debug", self.write("my.tmc", source), *options, *commands)

    def test_loads_what_differs_and_steps(self):
        done = self.debug(COUNTING, "break Work+2 if A > 5", "run", "print A", "info registers", "bt", "finish")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("sent 9 of 9 instructions", done.stderr)
        self.assertIn("A = 10\n", done.stdout)
        self.assertIn("flags        not visible on a module", done.stdout)
        self.assertRegex(done.stdout, r"#1 +Loop\+1")
        self.assertIn("program and motor have been stopped", done.stderr)
        again = self.debug(COUNTING.replace("ADD, 5", "ADD, 6"), "break *3", "run", "print VAR(2)")
        self.assertEqual(0, again.returncode, again.stderr)
        self.assertIn("sent 1 of 9 instructions", again.stderr)
        # A module keeps its user variables from one run to the next: 10 of the first, then 3 times 6.
        self.assertIn("VAR(2) = 28\n", again.stdout)

    def test_attaches_to_a_program_that_runs_and_leaves_it_running(self):
        self.assertEqual(0, self.debug(ENDLESS, "detach").returncode)
        host = self.simulation.host()
        self.addCleanup(host.close)
        self.assertEqual(1, host.program_state())
        host.close()
        done = self.debug(ENDLESS, "--attach", "until *1", "print PC", "detach")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("the program runs", done.stderr)
        self.assertIn("PC = 1\n", done.stdout)

    def test_another_program_is_noticed_before_it_is_debugged(self):
        self.assertEqual(0, self.debug(COUNTING, "info program").returncode)
        done = self.debug(COUNTING.replace("ADD, 5", "ADD, 6"), "--attach", "step")
        self.assertEqual(65, done.returncode)
        self.assertIn("my.tmc:%d: the module has another program: 1 of 9 instructions differ" % CALCULATES, done.stderr)
        self.assertIn("`CALC ADD, 5` and the source `CALC ADD, 6`; without --attach the source", done.stderr)

    def test_a_protected_program_is_debugged_on_trust_only(self):
        self.assertEqual(0, self.debug(COUNTING, "info program").returncode)
        host = self.simulation.host()
        host.do(tmcl_host.SGP, CODE_PROTECTION, 0, 3)
        host.close()
        for options in ((), ("--attach",)):
            done = self.debug(COUNTING, *options, "step")
            self.assertEqual(1, done.returncode, done.stderr)
            self.assertIn("global parameter 81", done.stderr)
            self.assertIn("--trust takes that on trust", done.stderr)
        done = self.debug(COUNTING, "--trust", "restart", "break Work", "continue")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertIn("breakpoint 1, at Work", done.stdout)

    def test_without_a_source_the_program_of_the_module_is_debugged(self):
        self.assertEqual(0, self.debug(COUNTING, "info program").returncode)
        done = self.tmcl("--port", self.simulation.link, "debug", "-e", "step", "-e", "step", "-e", "list")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertRegex(done.stdout, r"=>.*GGP 2, 2")

    def test_nobody_goes_back_in_time_on_a_module(self):
        done = self.debug(COUNTING, "step", "reverse-step")
        self.assertEqual(64, done.returncode)
        self.assertIn("port sim:pd1161", done.stderr)

    def test_ctrl_c_pauses_and_the_module_is_left_stopped(self):
        debugger = subprocess.Popen(
            [tmcl_host.tmcl_path(), "--port", self.simulation.link, "debug", self.write("my.tmc", ENDLESS)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        debugger.stdin.write("continue\n")
        debugger.stdin.flush()
        # The port is the debugger's; another host sees over TCP that the program runs.
        with socket.create_connection(("127.0.0.1", self.simulation.tcp_port), DEADLINE) as host:
            def state():
                host.sendall(tmcl_host.request(tmcl_host.PROGRAM_STATUS))
                data = b""
                while len(data) < 9:
                    data += host.recv(9 - len(data))
                return tmcl_host.Reply(data).value >> 24
            eventually(lambda: state() == 1, "the program to run")
        debugger.send_signal(signal.SIGINT)
        out, errors = debugger.communicate(timeout=DEADLINE)
        self.assertEqual(130, debugger.returncode, errors)
        self.assertIn("paused", out)
        host = self.simulation.host()
        self.addCleanup(host.close)
        self.assertEqual(0, host.program_state())


class Terminal(TemporaryFolderTest):
    """A person types."""

    def setUp(self):
        super().setUp()
        self.shown = ""
        source = self.write("my.tmc", TALKING)
        environment = dict(os.environ, TERM="xterm", XDG_STATE_HOME=self.folder)
        environment.pop("NO_COLOR", None)
        self.process, self.terminal = pty.fork()
        if self.process == 0:
            os.execve(tmcl_host.tmcl_path(), ["tmcl", "debug", source], environment)
        self.addCleanup(self.close)
        self.expect("(tmcl Loop)")

    def close(self):
        os.close(self.terminal)
        if self.process:
            os.kill(self.process, signal.SIGKILL)
            os.waitpid(self.process, 0)

    def expect(self, text):
        """Waits until it is shown; forgets what was shown up to there."""
        deadline = time.monotonic() + DEADLINE
        while text not in self.shown:
            if not select.select([self.terminal], [], [], max(0, deadline - time.monotonic()))[0]:
                raise AssertionError("not shown within %d s: %r; shown: %r" % (DEADLINE, text, self.shown))
            try:
                self.shown += os.read(self.terminal, 4096).decode(errors="replace")
            except OSError as gone:
                raise AssertionError("ended before %r was shown; shown: %r" % (text, self.shown)) from gone
        self.shown = self.shown.split(text, 1)[1]

    def type(self, text):
        os.write(self.terminal, text.encode())

    def exit_code(self):
        code = eventually(lambda: os.waitpid(self.process, os.WNOHANG)[1:] if self.has_ended() else None, "its end")
        self.process = 0
        return os.waitstatus_to_exitcode(code[0])

    def has_ended(self):
        return os.waitid(os.P_PID, self.process, os.WEXITED | os.WNOWAIT | os.WNOHANG) is not None

    def test_tab_completes_commands_and_labels(self):
        self.type("tbr\t")
        self.expect("eak ")  # behind what was typed
        self.type("Lo\t\n")
        self.expect("breakpoint 1: Loop, ")
        self.type("rever\t\t")
        self.expect("reverse-continue")
        self.expect("reverse-step")

    def test_the_history_outlives_the_session(self):
        self.type("print 6 * 7\n")
        self.expect("6 * 7 = 42")
        self.type("quit\n")
        self.assertEqual(0, self.exit_code())
        os.close(self.terminal)
        source = self.path("my.tmc")
        self.process, self.terminal = pty.fork()
        if self.process == 0:
            os.execve(tmcl_host.tmcl_path(), ["tmcl", "debug", source],
                      dict(os.environ, TERM="xterm", XDG_STATE_HOME=self.folder))
        self.expect("(tmcl Loop)")
        self.type("\x1b[A\x1b[A\n")  # up past "quit"
        self.expect("6 * 7 = 42")

    def test_an_empty_line_steps_again_and_errors_leave_the_session_as_it_is(self):
        self.type("step\n")
        self.expect("(tmcl Loop+1)")
        self.type("\n")
        self.expect("(tmcl Loop+2)")
        self.type("braek 1\n")
        self.expect("did you mean break?")
        self.expect("(tmcl Loop+2)")

    def test_ctrl_c_pauses_and_two_of_them_end_the_session(self):
        self.type("log Once it runs\n")
        self.expect("breakpoint 1")
        self.expect("(tmcl Loop)")
        self.type("continue\n")
        self.expect("it runs")
        self.type("\x03")
        self.expect("paused")
        self.expect("(tmcl Loop")
        self.type("\x03")
        self.expect("Ctrl-C again")
        self.expect("(tmcl Loop")
        self.type("\x03")
        self.assertEqual(130, self.exit_code())

    def test_the_place_is_shown_in_colours(self):
        self.type("step\n")
        self.expect("\x1b[32m=>")


if __name__ == "__main__":
    tmcl_host.main()
