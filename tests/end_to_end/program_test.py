"""A host loads a program into a virtual module and runs it."""

import tmcl_host
from tmcl_host import (ACTUAL_POSITION, BEGIN_DOWNLOAD, END_DOWNLOAD, LOADED, MVP, POSITION_REACHED, READ_PROGRAM,
                       RESET_PROGRAM, RUN_PROGRAM, SGP, STOP, STOP_PROGRAM, SimulationTest, TemporaryFolderTest, checksum,
                       eventually, request)

WAIT = 27
JA = 22
MOVE_THERE = [(MVP, 0, 0, 3000), (WAIT, 1, 0, 0), (SGP, 5, 2, 55), (STOP, 0, 0, 0)]


class Download(SimulationTest):
    def test_each_instruction_is_answered_101_and_can_be_read_back(self):
        self.host.load(MOVE_THERE)
        for address, instruction in enumerate(MOVE_THERE):
            self.host.send(request(READ_PROGRAM, 0, 0, address))
            data = self.host.receive()
            self.assertEqual(request(*instruction)[1:8], data[1:8])
            self.assertEqual(2, data[0])
            self.assertEqual(checksum(data[:8]), data[8])

    def test_a_program_runs_from_its_beginning_and_ends(self):
        self.host.load(MOVE_THERE)
        self.host.do(RESET_PROGRAM)
        self.host.do(RUN_PROGRAM)
        eventually(lambda: self.host.program_state() == 0, "the end of the program")
        self.assertEqual(3000, self.host.get(ACTUAL_POSITION))
        self.assertEqual(55, self.host.do(tmcl_host.GGP, 5, 2))

    def test_a_program_can_be_stopped_and_continued(self):
        self.host.load([(JA, 0, 0, 0)])
        self.host.do(RUN_PROGRAM, 1, 0, 0)
        self.assertEqual(1, self.host.program_state())
        self.host.do(STOP_PROGRAM)
        self.assertEqual(0, self.host.program_state())
        self.host.do(RUN_PROGRAM)
        self.assertEqual(1, self.host.program_state())

    def test_nothing_is_executed_during_a_download(self):
        self.host.do(BEGIN_DOWNLOAD)
        self.assertEqual(LOADED, self.host.ask(MVP, 0, 0, 100000).status)
        self.host.do(END_DOWNLOAD)
        self.assertEqual(1, self.host.get(POSITION_REACHED))
        self.assertEqual(0, self.host.get(ACTUAL_POSITION))

    def test_a_long_program_arrives_whole(self):
        program = [(SGP, i % 50, 2, i * 1000) for i in range(300)] + [(STOP, 0, 0, 0)]
        self.host.load(program)
        for address in (0, 1, 149, 298, 299, 300):
            self.host.send(request(READ_PROGRAM, 0, 0, address))
            self.assertEqual(request(*program[address])[1:8], self.host.receive()[1:8])


class ProgramOption(TemporaryFolderTest):
    SOURCE = "Loop: SGP 9, 2, 99\nMVP ABS, 0, 2000\nWAIT POS, 0, 0\nSTOP\n"

    def test_loads_and_starts_a_program(self):
        simulation = self.start("pd1161", "--speed", "10", "--program", self.write("p.tmc", self.SOURCE))
        host = simulation.host()
        eventually(lambda: host.get(ACTUAL_POSITION) == 2000, "the end of the move")
        self.assertEqual(99, host.do(tmcl_host.GGP, 9, 2))
        host.close()

    def test_loads_without_starting_when_told(self):
        simulation = self.start("pd1161", "--program", self.write("p.tmc", self.SOURCE), "--no-start")
        host = simulation.host()
        self.assertEqual(0, host.program_state())
        self.assertEqual(0, host.do(tmcl_host.GGP, 9, 2))
        host.do(RUN_PROGRAM)
        eventually(lambda: host.do(tmcl_host.GGP, 9, 2) == 99, "the program's first instruction")
        host.close()

    def test_a_bad_program_is_refused_with_its_place(self):
        source = self.write("bad.tmc", "ROR 0, 100\nRORR 0, 1\n")
        refused = self.tmcl("sim", "--program", source, "--tcp", "none", "--pty-link", self.path("link"))
        self.assertEqual(65, refused.returncode)
        self.assertIn("bad.tmc:2:1: error:", refused.stderr)


if __name__ == "__main__":
    tmcl_host.main()
