"""The ASCII mode of a virtual PD-1161, as somebody at a terminal uses it."""

import socket

import tmcl_host
from tmcl_host import DEADLINE, GAP, GGP, OK, SGP, Reply, SimulationTest, TemporaryFolderTest, eventually, request

ENTER_ASCII_MODE = 139
ASCII_MODE = 67
START_IN_ASCII_MODE, ECHO_LINES, NO_ECHO = 0x01, 0x10, 0x20


class Terminal:
    """Types lines at a serial port and reads what comes back."""

    def __init__(self, port):
        self.port = port

    def read(self, length):
        data = self.port.read(length)
        if len(data) != length:
            raise AssertionError("only %r came back" % data)
        return data.decode("ascii")

    def type(self, line):
        """Each key for itself, waiting for its echo; returns the reply."""
        for key in line + "\r":
            self.port.write(key.encode("ascii"))
            echo = self.read(1)
            if echo != key:
                raise AssertionError("%r came back for %r" % (echo, key))
        return self.port.read_until(b"\r").decode("ascii")


class AsciiMode(SimulationTest):
    def enter(self):
        self.host.do(ENTER_ASCII_MODE)
        return Terminal(self.host.port)

    def test_is_entered_and_left_again(self):
        terminal = self.enter()
        self.assertEqual("BA 100 8\r", terminal.type("AGAP 140, 0"))
        self.assertEqual("BA 3 0\r", terminal.type("A GAP 99, 0"))
        self.assertEqual("BA 2 0\r", terminal.type("Anonsense"))
        self.assertEqual("BA 100 0\r", terminal.type("ABIN"))
        self.assertEqual(8, self.host.get(140))
        self.assertEqual("BA 100 8\r", self.enter().type("agap 140, 0"))

    def test_moves_the_motor(self):
        terminal = self.enter()
        self.assertEqual("BA 100 5000\r", terminal.type("AMVP ABS, 0, 5000"))
        eventually(lambda: terminal.type("AGAP 8, 0") == "BA 100 1\r", "position reached")
        self.assertEqual("BA 100 5000\r", terminal.type("AGAP 1, 0"))
        terminal.type("ABIN")
        self.assertEqual(5000, self.host.get(tmcl_host.ACTUAL_POSITION))

    def test_takes_everything_that_comes_in_one_piece(self):
        self.host.do(SGP, ASCII_MODE, 0, NO_ECHO)
        self.host.send(request(ENTER_ASCII_MODE) + b"ASGP 1, 2, 11\rA?\rAGGP 1, 2\rABIN\r" + request(GAP, 140))
        self.assertEqual(OK, Reply(self.host.receive()).status)
        terminal = Terminal(self.host.port)
        replies = "BA 100 11\rBA 2 0\rBA 100 11\rBA 100 0\r"
        self.assertEqual(replies, terminal.read(len(replies)))
        self.assertEqual(8, Reply(self.host.receive()).value)

    def test_a_text_shorter_than_a_request_is_not_kept_back(self):
        self.host.do(SGP, ASCII_MODE, 0, ECHO_LINES)
        self.host.send(request(ENTER_ASCII_MODE) + b"AMST 0\r")
        self.host.receive()
        self.assertEqual("AMST 0\rBA 100 0\r", Terminal(self.host.port).read(16))

    def test_backspace_erases(self):
        terminal = self.enter()
        self.host.port.write(b"AGAP 141\b0, 0\r")
        expected = "AGAP 141\b \b0, 0\rBA 100 8\r"
        self.assertEqual(expected, terminal.read(len(expected)))

    def test_the_other_ports_stay_binary_and_may_change_too(self):
        terminal = self.enter()
        self.host.port.write(b"AGAP")
        self.assertEqual("AGAP", terminal.read(4))
        with socket.create_connection(("127.0.0.1", self.simulation.tcp_port), timeout=DEADLINE) as connection:
            stream = connection.makefile("rwb", buffering=0)

            def exchange(data, length):
                stream.write(data)
                reply = b""
                while len(reply) < length:
                    part = stream.read(length - len(reply))
                    self.assertTrue(part, "the connection was closed")
                    reply += part
                return reply

            self.assertEqual(8, Reply(exchange(request(GAP, 140), 9)).value)
            exchange(request(ENTER_ASCII_MODE), 9)
            self.assertEqual(b"AGAP 140, 0\rBA 100 8\r", exchange(b"AGAP 140, 0\r", 21))
            self.assertEqual(b"ABIN\rBA 100 0\r", exchange(b"ABIN\r", 14))
            self.assertEqual(8, Reply(exchange(request(GAP, 140), 9)).value)
        self.assertEqual("BA 100 8\r", terminal.type(" 140, 0"))

    def test_outlives_a_terminal_that_closes_the_port(self):
        self.enter()
        self.host.close()
        self.host = self.simulation.host()
        self.addCleanup(self.host.close)
        self.assertEqual("BA 100 8\r", Terminal(self.host.port).type("AGAP 140, 0"))


class AsciiModeFromTheStart(TemporaryFolderTest):
    """Bit 0 of global parameter 67."""

    def start_with_kept_eeprom(self):
        simulation = self.start("pd1161", "--eeprom", self.path("eeprom"), *self.more)
        host = simulation.host()
        self.addCleanup(host.close)
        return simulation, host

    more = ()

    def test_lasts_until_bin(self):
        simulation, host = self.start_with_kept_eeprom()
        host.do(SGP, ASCII_MODE, 0, START_IN_ASCII_MODE)
        self.assertEqual(8, host.get(140))
        simulation.stop()

        # A program is loaded in binary mode all the same.
        self.more = ("--program", self.write("program.tmc", "SGP 1, 2, 4711\nSTOP\n"))
        _, host = self.start_with_kept_eeprom()
        terminal = Terminal(host.port)
        eventually(lambda: terminal.type("AGGP 1, 2") == "BA 100 4711\r", "the program has run")
        self.assertEqual("BA 100 0\r", terminal.type("ABIN"))
        self.assertEqual(START_IN_ASCII_MODE, host.do(GGP, ASCII_MODE))


class AsciiModeAtMaximumSpeed(SimulationTest):
    arguments = ("pd1161", "--speed", "max")

    def test_is_the_same(self):
        self.host.do(ENTER_ASCII_MODE)
        terminal = Terminal(self.host.port)
        self.assertEqual("BA 100 8\r", terminal.type("AGAP 140, 0"))
        self.assertEqual("BA 100 0\r", terminal.type("ABIN"))
        self.assertEqual(8, self.host.get(140))


if __name__ == "__main__":
    tmcl_host.main()
