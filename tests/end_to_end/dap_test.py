"""`tmcl dap`, as an editor uses it: with a twin in its process, and with a module at a pseudo terminal."""

import base64
import signal

import tmcl_host
from dap_client import DapClient, Refused
from debugged_programs import ADDED, CALCULATES, CODE_PROTECTION, COUNTING, ENDLESS, LOOPS
from tmcl_host import TemporaryFolderTest


class DapTest(TemporaryFolderTest):
    """Each test has a folder with two programs, and adapters that are gone at its end."""

    def setUp(self):
        super().setUp()
        self.counting = self.write("counting.tmc", COUNTING)
        self.endless = self.write("endless.tmc", ENDLESS)

    def adapter(self, *options):
        client = DapClient(tmcl_host.tmcl_path(), *options, "dap")
        self.addCleanup(client.kill)
        return client

    def breakpoints(self, client, path, *breakpoints):
        return client.ask("setBreakpoints", source={"path": path}, breakpoints=list(breakpoints))["breakpoints"]

    def leave(self, client, **arguments):
        client.ask("disconnect", **arguments)
        self.assertEqual(0, client.wait(), client.errors())


class Twin(DapTest):
    def launched(self, program, **arguments):
        client = self.adapter()
        client.begin("launch", program=program, **arguments)
        return client

    def test_steps_forth_and_back_and_sees_the_accumulator(self):
        client = self.adapter()
        abilities = client.begin("launch", program=self.counting)
        self.assertTrue(abilities["supportsStepBack"])
        placed = self.breakpoints(client, self.counting, {"line": CALCULATES, "condition": "VAR(2) == 5"})
        self.assertEqual([(True, CALCULATES)], [(one["verified"], one["line"]) for one in placed])
        client.ask("configurationDone")
        self.assertEqual("entry", client.stopped()["reason"])

        stopped = client.go("continue")
        self.assertEqual(("breakpoint", [placed[0]["id"]]), (stopped["reason"], stopped["hitBreakpointIds"]))
        self.assertEqual((CALCULATES, "5"), (client.line(), client.value("A")))
        self.assertEqual("step", client.go("next")["reason"])
        self.assertEqual((ADDED, "10"), (client.line(), client.value("A")))
        self.assertEqual("step", client.go("stepBack")["reason"])
        self.assertEqual((CALCULATES, "5"), (client.line(), client.value("A")))
        client.go("stepOut")
        self.assertEqual((LOOPS, "10"), (client.line(), client.value("VAR(2)")))
        self.assertEqual("breakpoint", client.go("reverseContinue")["reason"])
        self.assertEqual((CALCULATES, "5"), (client.line(), client.value("A")))
        self.assertEqual("entry", client.go("reverseContinue")["reason"], "nothing else stops it on the way back")
        self.leave(client)

    def test_changes_values_and_shows_them(self):
        client = self.launched(self.counting)
        client.ask("configurationDone")
        client.stopped()
        scopes = {one["name"]: one["variablesReference"] for one in client.ask("scopes", frameId=1)["scopes"]}
        self.assertEqual(["Registers", "Variables", "Axis", "Global", "Bench"], list(scopes))
        for name, reference in scopes.items():
            self.assertTrue(client.ask("variables", variablesReference=reference)["variables"], name)
        client.ask("setVariable", variablesReference=scopes["Variables"], name="VAR(2)", value="4 * 25")
        self.assertEqual("100", client.value("VAR(2)"))
        changed = client.ask("setVariable", variablesReference=scopes["Axis"], name="maximum positioning speed",
                             value="500")
        self.assertIn("rpm", changed["value"])
        self.assertEqual(changed["value"], client.value("GAP 4, 0", context="repl"))
        self.leave(client)

    def test_reads_the_memory_as_the_binary_file_has_it(self):
        binary = self.path("counting.bin")
        self.assertEqual(0, self.tmcl("asm", self.counting, "-o", binary).returncode)
        expected = self.read("counting.bin")
        client = self.launched(self.counting)
        client.ask("configurationDone")
        memory = client.ask("readMemory", memoryReference="0x0", count=len(expected))
        self.assertEqual(expected, base64.b64decode(memory["data"]))
        lines = client.ask("disassemble", memoryReference="0x8", instructionCount=2)["instructions"]
        self.assertEqual([("0x8", "CSUB 4"), ("0x10", "DJNZ 1, 1")],
                         [(line["address"], line["instruction"]) for line in lines])
        self.leave(client)

    def test_pauses_and_restarts_a_program_that_runs(self):
        client = self.launched(self.endless, stopOnEntry=False)
        client.ask("configurationDone")
        self.assertEqual("2", client.value("1 + 1"), "answered while it runs")
        with self.assertRaisesRegex(Refused, "the program runs; pause it first"):
            client.ask("stackTrace", threadId=1)
        self.assertEqual("pause", client.go("pause")["reason"])
        self.assertGreater(int(client.value("A")), 0)
        client.ask("continue", threadId=1)
        client.ask("restart", arguments={"program": self.endless, "stopOnEntry": True})
        self.assertEqual("entry", client.stopped()["reason"])
        self.assertEqual("0", client.value("A"))
        self.leave(client)

    def test_restarts_with_the_source_as_it_is_now(self):
        client = self.launched(self.counting)
        self.breakpoints(client, self.counting, {"line": CALCULATES})
        client.ask("configurationDone")
        client.stopped()
        self.write("counting.tmc", COUNTING.replace("ADD, 5", "ADD, 7").replace("// Adds", "\n// Adds"))
        client.ask("restart")
        moved = client.wait_for("breakpoint")["breakpoint"]
        self.assertEqual(CALCULATES, moved["line"], "one line up in the program, which is a line longer")
        self.assertEqual("entry", client.stopped()["reason"])
        client.go("continue")
        client.go("next")
        client.go("next")
        self.assertEqual("7", client.value("A"))
        self.leave(client)

    def test_says_what_is_wrong_with_a_source(self):
        bad = self.write("bad.tmc", "  NOSUCH 1\n  MVP UP, 0, 1\n")
        client = self.adapter()
        client.ask("initialize", adapterID="tmcl")
        with self.assertRaisesRegex(Refused, r"^.*bad\.tmc has 2 errors$"):
            client.ask("launch", program=bad)
        self.assertIn("bad.tmc:1:3: error: there is no instruction 'NOSUCH'", client.output())
        self.assertIn("bad.tmc:2:7: error:", client.output())
        self.leave(client)

    def test_takes_the_module_of_the_source_before_that_of_the_editor(self):
        # Only the PD-1161 has a boost current, parameter 200.
        for head, has_boost_current in (("", False), ("// module: pd1161\n", True)):
            client = self.launched(self.write("my.tmc", head + ENDLESS), defaultModule="tmcm1110")
            client.ask("configurationDone")
            if has_boost_current:
                self.assertEqual("0", client.value("GAP 200, 0")[:1])
            else:
                with self.assertRaises(Refused):
                    client.value("GAP 200, 0")
            self.leave(client)

    def test_runs_a_scenario_around_the_program(self):
        scenario = self.write("bench.toml", 'module = "pd1161"\nduration = "1 s"\n'
                              '[[event]]\nat = "10 ms"\nnote = "ten milliseconds"\n')
        client = self.launched(self.write("wait.tmc", "WAIT TICKS, 0, 5\nSTOP\n"), scenario=scenario, noDebug=True)
        client.ask("configurationDone")
        self.assertIn("ten milliseconds", client.wait_for("output")["output"])
        client.wait_for("terminated")
        self.leave(client)

    def test_ends_with_its_input(self):
        client = self.launched(self.endless, stopOnEntry=False)
        client.ask("configurationDone")
        client.close_input()
        self.assertEqual(0, client.wait(), client.errors())

    def test_ends_at_bytes_that_are_no_message(self):
        client = self.adapter()
        client.send_bytes(b"hello\r\n\r\n")
        self.assertEqual(76, client.wait())
        self.assertIn("Content-Length", client.errors())


class Module(DapTest):
    """A virtual module in a process of its own, known by its commands alone."""

    def setUp(self):
        super().setUp()
        self.simulation = self.start("pd1161")
        self.port = self.simulation.link

    def program_state(self):
        host = self.simulation.host()
        try:
            return host.program_state()
        finally:
            host.close()

    def test_stops_steps_and_does_not_offer_to_go_back(self):
        client = self.adapter()
        abilities = client.begin("launch", program=self.counting, port=self.port)
        self.assertNotIn("supportsStepBack", abilities)
        self.breakpoints(client, self.counting, {"line": CALCULATES, "condition": "VAR(2) == 5"})
        client.ask("configurationDone")
        client.stopped()
        self.assertEqual("breakpoint", client.go("continue")["reason"])
        self.assertEqual("5", client.value("A"))
        client.go("next")
        self.assertEqual((ADDED, "10"), (client.line(), client.value("A")))
        frames = client.ask("stackTrace", threadId=1)["stackFrames"]
        self.assertEqual(["Work+2", "Loop+1"], [frame["name"] for frame in frames])
        scopes = [one["name"] for one in client.ask("scopes", frameId=1)["scopes"]]
        self.assertEqual(["Registers", "Variables", "Axis", "Global"], scopes)
        client.ask("setVariable", variablesReference=1, name="A", value="33")
        self.assertEqual("33", client.value("A"))
        client.ask("stepBack", threadId=1)
        self.assertIn("does not go back in time", client.wait_for("output")["output"])
        self.assertEqual((ADDED, "33"), (client.line(), client.value("A")))
        self.leave(client)
        self.assertEqual(0, self.program_state())

    def test_pauses_a_program_that_runs_by_itself(self):
        client = self.adapter()
        client.begin("launch", program=self.endless, port=self.port, stopOnEntry=False)
        client.ask("configurationDone")
        self.assertEqual("2", client.value("1 + 1"))
        self.assertEqual("pause", client.go("pause")["reason"])
        self.assertIn(client.line(), (1, 2))
        self.leave(client)
        self.assertEqual(0, self.program_state())

    def test_attaches_to_a_program_and_leaves_it_running(self):
        client = self.adapter()
        client.begin("launch", program=self.endless, port=self.port)
        client.ask("configurationDone")
        client.stopped()
        self.leave(client, terminateDebuggee=False)

        host = self.simulation.host()
        host.do(tmcl_host.RUN_PROGRAM)
        host.close()
        client = self.adapter()
        client.begin("attach", program=self.endless, port=self.port)
        client.ask("configurationDone")
        self.assertEqual("entry", client.stopped()["reason"])
        self.assertIn(client.line(), (1, 2))
        self.leave(client)
        self.assertEqual(1, self.program_state(), "it goes on where it was")

        client = self.adapter()
        client.ask("initialize", adapterID="tmcl")
        with self.assertRaisesRegex(Refused, 'the module has another program.*"request": "launch" loads the source'):
            client.ask("attach", program=self.counting, port=self.port)
        self.leave(client)
        self.assertEqual(1, self.program_state())

    def test_attaches_to_a_protected_program_on_trust_only(self):
        client = self.adapter()
        client.begin("launch", program=self.endless, port=self.port)
        self.leave(client)
        host = self.simulation.host()
        host.do(tmcl_host.SGP, CODE_PROTECTION, 0, 3)
        host.close()

        client = self.adapter()
        client.ask("initialize", adapterID="tmcl")
        for request in ("launch", "attach"):
            with self.assertRaisesRegex(Refused, 'global parameter 81.*"attach" with "trust": true takes that on trust'):
                client.ask(request, program=self.endless, port=self.port)
        client.ask("attach", program=self.endless, port=self.port, trust=True)
        client.wait_for("initialized")
        client.ask("configurationDone")
        self.assertEqual("entry", client.stopped()["reason"])
        self.leave(client)

    def test_stops_the_module_when_the_editor_is_gone(self):
        for end in (DapClient.close_input, lambda client: client.process.send_signal(signal.SIGTERM)):
            client = self.adapter()
            client.begin("launch", program=self.endless, port=self.port, stopOnEntry=False)
            client.ask("configurationDone")
            self.assertEqual("2", client.value("1 + 1"))
            end(client)
            self.assertEqual(0, client.wait(), client.errors())
            self.assertEqual(0, self.program_state())

    def test_ends_when_the_module_is_gone(self):
        client = self.adapter()
        client.begin("launch", program=self.endless, port=self.port, stopOnEntry=False)
        client.ask("configurationDone")
        self.simulation.stop()
        client.wait_for("terminated")
        try:
            client.ask("disconnect", terminateDebuggee=False)
        except Refused as refused:  # it wanted to let the program go on
            self.assertIn("is gone", str(refused))
        self.assertEqual(0, client.wait())


if __name__ == "__main__":
    tmcl_host.main()
