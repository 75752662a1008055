"""What a virtual module makes of bytes that are no proper request."""

import random

import tmcl_host
from tmcl_host import GAP, OK, WRONG_CHECKSUM, Reply, SimulationTest, eventually, request


class Framing(SimulationTest):
    arguments = ("pd1161",)

    def expect_silence_then_an_answer(self):
        """After 5 ms without a byte a request is understood, whatever came before; how long the machine needs is open."""

        def is_answered():
            self.host.port.timeout = 0.05
            self.host.port.read(1000)  # what came before, and the silence
            self.host.send(request(GAP, 140))
            return self.host.port.read(1000) == bytes([2, 1, OK, GAP, 0, 0, 0, 8, 2 + 1 + OK + GAP + 8])

        eventually(is_answered, "an answer to a proper request")

    def test_a_wrong_checksum_is_answered_with_status_1_command_0_value_0(self):
        broken = bytearray(request(GAP, 1, 0, 1234))
        broken[8] ^= 0xFF
        self.host.send(broken)
        self.assertEqual(bytes([2, 1, WRONG_CHECKSUM, 0, 0, 0, 0, 0, 4]), self.host.receive())
        self.assertEqual(8, self.host.get(140))

    def test_a_request_with_a_wrong_checksum_is_not_executed(self):
        broken = bytearray(request(tmcl_host.SAP, 4, 0, 777))
        broken[8] ^= 1
        before = self.host.get(4)
        self.host.send(broken)
        self.host.receive()
        self.assertEqual(before, self.host.get(4))

    def test_nine_zero_bytes_are_answered_with_an_error(self):
        self.host.send(bytes(9))
        reply = Reply(self.host.receive())
        self.assertTrue(reply.checksum_is_right)
        self.assertLess(reply.status, OK)

    def test_half_a_request_and_silence_leave_no_trace(self):
        for length in range(1, 9):
            self.host.send(request(GAP, 1)[:length])
            self.expect_silence_then_an_answer()

    def test_garbage_of_any_length_is_survived(self):
        source = random.Random(1161)
        for _ in range(30):
            self.host.send(bytes(source.randrange(256) for _ in range(source.randrange(1, 40))))
            self.expect_silence_then_an_answer()

    def test_a_request_byte_by_byte_is_understood(self):
        def is_answered():
            self.host.port.timeout = 0.05
            self.host.port.read(1000)
            for byte in request(GAP, 140):
                self.host.send(bytes([byte]))
            return self.host.port.read(1000)[4:8] == bytes([0, 0, 0, 8])

        eventually(is_answered, "an answer to nine single bytes")

    def test_over_usb_any_address_is_answered_with_the_modules_own(self):
        for address in (0, 1, 2, 77, 255):
            reply = self.host.ask(GAP, 140, address=address)
            self.assertEqual((1, OK, 8), (reply.module, reply.status, reply.value))

    def test_many_requests_at_once_are_all_answered_in_order(self):
        count = 200
        self.host.send(b"".join(request(tmcl_host.SGP, 1, 2, i) for i in range(count)))
        for i in range(count):
            reply = Reply(self.host.receive())
            self.assertEqual((OK, i), (reply.status, reply.value))

    def test_an_unknown_command_is_answered_with_status_2(self):
        self.assertEqual(tmcl_host.INVALID_COMMAND, self.host.ask(200).status)


if __name__ == "__main__":
    tmcl_host.main()
