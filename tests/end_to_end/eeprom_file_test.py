"""What survives a restart of a virtual module with an EEPROM file, and which files are refused."""

import os
import signal

import tmcl_host
from tmcl_host import (GCO, GGP, MAXIMUM_ACCELERATION, MAXIMUM_SPEED, READ_PROGRAM, SCO, SGP, STANDBY_CURRENT, STAP, STGP, STOP,
                       TemporaryFolderTest, eventually, request)

USER_VARIABLES = 2
SERIAL_ADDRESS = 66
COORDINATE_STORAGE = 84


class EepromFileTest(TemporaryFolderTest):
    def setUp(self):
        super().setUp()
        self.eeprom = self.path("module.eeprom")

    def power_on(self, module="pd1161"):
        simulation = self.start(module, "--eeprom", self.eeprom)
        host = simulation.host()
        self.addCleanup(host.close)
        return simulation, host

    def power_off(self, simulation, host, how=signal.SIGTERM):
        host.close()
        simulation.stop(how)


class Restart(EepromFileTest):
    def test_keeps_what_the_access_letters_promise_and_loses_the_rest(self):
        simulation, host = self.power_on()
        host.set(MAXIMUM_SPEED, 1234)
        host.do(STAP, MAXIMUM_SPEED)  # access RWE, stored
        host.set(MAXIMUM_ACCELERATION, 321)  # access RWE, not stored
        host.set(STANDBY_CURRENT, 99)  # access RW on this module
        host.do(SGP, SERIAL_ADDRESS, 0, 5)  # access RWA
        host.do(SGP, 10, USER_VARIABLES, -77)
        host.do(STGP, 10, USER_VARIABLES)
        host.do(SGP, 11, USER_VARIABLES, 88)  # not stored
        host.do(SGP, COORDINATE_STORAGE, 0, 1)
        host.do(SCO, 3, 0, 4242)
        host.load([(SGP, 20, USER_VARIABLES, 1), (STOP, 0, 0, 0)])
        self.power_off(simulation, host)

        simulation, host = self.power_on()
        self.assertEqual(1234, host.get(MAXIMUM_SPEED))
        self.assertNotEqual(321, host.get(MAXIMUM_ACCELERATION))
        self.assertNotEqual(99, host.get(STANDBY_CURRENT))
        self.assertEqual(5, host.do(GGP, SERIAL_ADDRESS, 0))
        self.assertEqual(5, host.ask(GGP, SERIAL_ADDRESS, 0).module)
        self.assertEqual(-77, host.do(GGP, 10, USER_VARIABLES))
        self.assertEqual(0, host.do(GGP, 11, USER_VARIABLES))
        self.assertEqual(4242, host.do(GCO, 3, 0))
        host.send(request(READ_PROGRAM, 0, 0, 0))
        self.assertEqual(request(SGP, 20, USER_VARIABLES, 1)[1:8], host.receive()[1:8])
        self.power_off(simulation, host)

    def test_keeps_it_also_when_the_program_is_killed(self):
        simulation, host = self.power_on()
        before = self.read("module.eeprom")
        host.set(MAXIMUM_SPEED, 555)
        host.do(STAP, MAXIMUM_SPEED)
        # Stored means: in the file once the EEPROM's 5 ms are over. Reading waits for the last page.
        eventually(lambda: self.read("module.eeprom") != before, "a new file")
        written = self.settled_file()
        self.power_off(simulation, host, signal.SIGKILL)
        self.assertEqual(written, self.read("module.eeprom"))
        simulation, host = self.power_on()
        self.assertEqual(555, host.get(MAXIMUM_SPEED))
        self.power_off(simulation, host)

    def settled_file(self):
        """The file's content when two looks a while apart are the same."""
        last = [self.read("module.eeprom")]

        def is_settled():
            content, last[0] = last[0], self.read("module.eeprom")
            return content == last[0]

        tmcl_host.time.sleep(0.1)  # how long nothing has to happen; waits for an absence
        eventually(is_settled, "a file that stays as it is")
        return last[0]

    def test_each_module_keeps_its_own(self):
        simulation, host = self.power_on("tmcm1110")
        host.set(STANDBY_CURRENT, 40)
        host.do(STAP, STANDBY_CURRENT)  # access RWE on this module
        self.power_off(simulation, host)
        simulation, host = self.power_on("tmcm1110")
        self.assertEqual(40, host.get(STANDBY_CURRENT))
        self.power_off(simulation, host)

    def test_leaves_only_the_file_itself_behind(self):
        simulation, host = self.power_on()
        host.do(SGP, SERIAL_ADDRESS, 0, 9)
        self.power_off(simulation, host)
        self.assertEqual(["module.eeprom"], sorted(os.listdir(self.folder)))


class Refusal(EepromFileTest):
    def good_file(self):
        simulation, host = self.power_on()
        host.do(SGP, SERIAL_ADDRESS, 0, 9)
        self.power_off(simulation, host)
        return self.read("module.eeprom")

    def expect_refused(self, content, message, module="pd1161"):
        self.write("module.eeprom", content)
        refused = self.tmcl("sim", module, "--eeprom", self.eeprom, "--tcp", "none", "--pty-link", self.path("link"),
                            "--quiet")
        self.assertEqual(65, refused.returncode, refused.stderr)
        self.assertIn("module.eeprom", refused.stderr)
        self.assertIn(message, refused.stderr)
        self.assertEqual(1, refused.stderr.count("\n"))
        self.assertEqual("", refused.stdout)
        self.assertEqual(content, self.read("module.eeprom"))

    def test_of_truncated_files(self):
        good = self.good_file()
        for length in (0, 5, 30, 100, len(good) // 2, len(good) - 1):
            self.expect_refused(good[:length], "refused")

    def test_of_foreign_files(self):
        self.expect_refused(b"\x7fELF" + bytes(20000), "not an OpenTMCL EEPROM file")
        self.expect_refused(b"ROR 0, 100\n", "not an OpenTMCL EEPROM file")

    def test_of_corrupt_files(self):
        good = self.good_file()
        for place in (len(good) - 1, len(good) - 8000):
            corrupt = bytearray(good)
            corrupt[place] ^= 0x10
            self.expect_refused(bytes(corrupt), "checksum")

    def test_of_another_modules_file(self):
        self.expect_refused(self.good_file(), "not to a TMCM-1110", module="tmcm1110")

    def test_of_a_file_that_another_module_uses(self):
        simulation, host = self.power_on()
        second = self.tmcl("sim", "--eeprom", self.eeprom, "--tcp", "none", "--pty-link", self.path("second"), "--quiet")
        self.assertEqual(65, second.returncode)
        self.assertIn("in use", second.stderr)
        self.assertEqual(1, host.do(GGP, SERIAL_ADDRESS, 0))
        self.power_off(simulation, host)


if __name__ == "__main__":
    tmcl_host.main()
