"""Hosts on the CAN bus of a virtual TMCM-1110: python-can's own buses, unmodified."""

import os
import random
import socket
import struct
import unittest

import can

import tmcl_host
from tmcl_host import DEADLINE, GAP, GGP, INVALID_COMMAND, MVP, OK, SGP, VERSION, Host, TemporaryFolderTest, eventually
from tcp_test import connect, receive

MODULE_ID, REPLY_ID = 1, 2
SOFTWARE_RESET, POSITION_REPORT = 255, 138
CAN_BIT_RATE = 69
GROUP = "239.74.163.2"


def data(opcode, kind=0, motor=0, value=0):
    return struct.pack(">BBBi", opcode, kind, motor, value)


def slcan(path, bitrate=1000000):
    # The pause after opening is for adapters that start up then.
    return can.Bus(interface="slcan", channel=path, bitrate=bitrate, sleep_after_open=0)


class Node:
    """A host on a bus: requests to identifier 1, replies from identifier 2."""

    def __init__(self, bus):
        self.bus = bus

    def send(self, payload, extended=False, identifier=MODULE_ID):
        self.bus.send(can.Message(arbitration_id=identifier, is_extended_id=extended, data=payload))

    def receive(self, timeout=DEADLINE):
        """The next reply; other members of a multicast group, oneself among them, are heard too."""
        while True:
            message = self.bus.recv(timeout)
            if message is None or message.arbitration_id == REPLY_ID:
                return message

    def ask(self, payload, extended=False):
        self.send(payload, extended)
        message = self.receive()
        if message is None:
            raise AssertionError("no reply to " + payload.hex())
        return message

    def do(self, *command):
        """Expects status 100 and returns the value."""
        reply = bytes(self.ask(data(*command)).data)
        if (reply[0], reply[1], reply[2]) != (MODULE_ID, OK, command[0]):
            raise AssertionError("command %d answered %s" % (command[0], reply.hex()))
        return struct.unpack(">i", reply[3:7])[0]


class Conversation:
    """What must work on each kind of bus; `self.node` is on it."""

    def test_seven_bytes_are_answered_with_seven(self):
        reply = self.node.ask(data(GAP, 140))
        self.assertEqual(bytes([1, 100, 6, 0, 0, 0, 8]), bytes(reply.data))
        self.assertFalse(reply.is_extended_id)

    def test_eight_bytes_are_answered_with_eight(self):
        reply = self.node.ask(data(GAP, 140) + b"\x93")
        self.assertEqual(bytes([1, 100, 6, 0, 0, 0, 8, 0]), bytes(reply.data))

    def test_29_bits_are_answered_with_29(self):
        self.assertTrue(self.node.ask(data(GAP, 140), extended=True).is_extended_id)

    def test_the_version_comes_as_text_in_eight_bytes(self):
        self.assertEqual(b"1110V108", bytes(self.node.ask(data(VERSION) + b"\0").data))

    def test_other_frames_are_ignored(self):
        self.node.send(data(GAP, 140), identifier=3)
        self.node.send(data(GAP, 140)[:6])
        self.node.bus.send(can.Message(arbitration_id=MODULE_ID, is_extended_id=False, is_remote_frame=True, dlc=7))
        self.assertEqual(INVALID_COMMAND, self.node.ask(data(0)).data[1])

    def test_a_hundred_requests_are_answered_in_order(self):
        for i in range(100):
            self.node.send(data(SGP, i, 2, 1000 + i))
        for i in range(100):
            self.assertEqual(1000 + i, struct.unpack(">i", bytes(self.node.receive().data)[3:7])[0])

    def test_the_end_of_a_move_is_reported_to_who_asked(self):
        self.node.do(POSITION_REPORT, 0, 0, 1)
        self.node.do(MVP, 0, 0, 3000)
        self.assertEqual(bytes([1, 128, 138, 0, 0, 0, 1]), bytes(self.node.receive().data))


class Slcan(TemporaryFolderTest, Conversation):
    def setUp(self):
        super().setUp()
        self.adapter = self.path("slcan")
        self.simulation = self.start("tmcm1110", "--speed", "10", "--slcan-link", self.adapter)
        self.node = Node(slcan(self.adapter))
        # Tests open others in its place.
        self.addCleanup(lambda: self.node.bus.shutdown())

    def test_the_introduction_names_it(self):
        self.assertEqual(self.adapter, self.simulation.introduction["slcan_link"])
        self.assertEqual(os.readlink(self.adapter), self.simulation.introduction["slcan"])

    def test_the_adapter_says_what_it_is(self):
        self.assertEqual((10, 10), self.node.bus.get_version(DEADLINE))
        self.assertEqual("TMCL", self.node.bus.get_serial_number(DEADLINE))

    def test_hosts_may_come_and_go(self):
        self.node.bus.shutdown()
        for i in range(20):
            self.node.bus = slcan(self.adapter)
            self.assertEqual(i, self.node.do(SGP, 7, 2, i))
            self.node.bus.shutdown()
        self.node.bus = slcan(self.adapter)

    def test_at_another_bit_rate_nobody_answers_until_the_module_has_it_too(self):
        self.node.do(SGP, CAN_BIT_RATE, 0, 5)
        self.assertEqual(8, self.node.do(GAP, 140))
        self.node.do(SOFTWARE_RESET, 0, 0, 1234)
        self.node.bus.set_bitrate(125000)
        # The module starts anew at once, but not in no time.
        eventually(lambda: self.node.send(data(GAP, 140)) or self.node.receive(0.05), "an answer at 125 kbit/s")
        self.node.bus.shutdown()
        self.node.bus = slcan(self.adapter, 1000000)
        self.node.send(data(GAP, 140))
        self.assertIsNone(self.node.receive(0.2))


def multicast_is_possible():
    """python-can joins where the routes lead: on a machine without any it cannot open its bus."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                             socket.inet_aton(GROUP) + struct.pack("@I", socket.INADDR_ANY))
        except OSError:
            return False
    return True


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        return probe.getsockname()[1]


@unittest.skipUnless(multicast_is_possible(), "no route for multicast: python-can cannot open its own bus here")
class UdpMulticast(TemporaryFolderTest, Conversation):
    def setUp(self):
        super().setUp()
        self.port = free_port()
        self.simulation = self.start("tmcm1110", "--speed", "10", "--can-udp", "%s:%d" % (GROUP, self.port))
        self.node = Node(can.Bus(GROUP, interface="udp_multicast", port=self.port))
        self.addCleanup(self.node.bus.shutdown)

    def test_the_introduction_names_it(self):
        self.assertEqual("udp://%s:%d" % (GROUP, self.port), self.simulation.introduction["can_udp"])


class SeveralTransports(TemporaryFolderTest):
    def test_each_reply_goes_to_who_asked(self):
        adapter = self.path("slcan")
        simulation = self.start("tmcm1110", "--slcan-link", adapter)
        terminal = simulation.host()
        self.addCleanup(terminal.close)
        node = Node(slcan(adapter))
        self.addCleanup(node.bus.shutdown)
        order = random.Random(1)
        with connect(simulation) as connection:
            senders = {
                "terminal": lambda number: terminal.send(tmcl_host.request(SGP, 1, 2, number)),
                "tcp": lambda number: connection.sendall(tmcl_host.request(SGP, 2, 2, number)),
                "can": lambda number: node.send(data(SGP, 3, 2, number)),
            }
            receivers = {
                "terminal": lambda: tmcl_host.Reply(terminal.receive()).value,
                "tcp": lambda: receive(connection).value,
                "can": lambda: struct.unpack(">i", bytes(node.receive().data)[3:7])[0],
            }
            sent = {name: [] for name in senders}
            for number in range(300):
                name = order.choice(sorted(senders))
                senders[name](number)
                sent[name].append(number)
            for name, receiver in receivers.items():
                self.assertEqual(sent[name], [receiver() for _ in sent[name]], name)
        self.assertIsNone(node.receive(0.1))


class Options(TemporaryFolderTest):
    def refused(self, *arguments):
        ended = self.tmcl("sim", *arguments, "--tcp", "none", "--pty-link", self.path("link"), "--quiet")
        self.assertEqual(1, len(ended.stderr.splitlines()), ended.stderr)
        return ended

    def test_a_pd1161_has_no_can(self):
        for option in (("--slcan-link", self.path("slcan")), ("--can-udp", GROUP + ":43113"), ("--can", "vcan0")):
            ended = self.refused("pd1161", *option)
            self.assertEqual(64, ended.returncode)
            self.assertIn("has no CAN", ended.stderr)

    def test_nonsense_is_refused(self):
        for group in ("239.74.163.2", "127.0.0.1:43113", "somewhere:43113", ":43113", GROUP + ":", GROUP + ":0",
                      GROUP + ":65536"):
            self.assertEqual(64, self.refused("tmcm1110", "--can-udp", group).returncode, group)
        self.assertEqual(64, self.refused("tmcm1110", "--port-kind", "can").returncode)
        self.assertEqual(64, self.refused("tmcm1110", "--port-kind", "rs232").returncode)

    def test_an_interface_that_is_not_there_is_named(self):
        ended = self.refused("tmcm1110", "--can", "no_such_can")
        self.assertEqual(69, ended.returncode)
        self.assertIn("no_such_can", ended.stderr)

    def test_the_links_are_removed_at_the_end(self):
        adapter = self.path("slcan")
        simulation = self.start("tmcm1110", "--slcan-link", adapter)
        self.assertTrue(os.path.islink(adapter))
        self.assertEqual(0, simulation.stop())
        self.assertFalse(os.path.lexists(adapter))


class PortKind(TemporaryFolderTest):
    def host(self, *arguments):
        simulation = self.start(*arguments)
        host = Host(simulation.link)
        self.addCleanup(host.close)
        return simulation, host

    def test_usb_ignores_the_address(self):
        for arguments in (("pd1161",), ("pd1161", "--port-kind", "usb")):
            simulation, host = self.host(*arguments)
            self.assertEqual("USB", simulation.introduction["port_kind"])
            self.assertEqual(8, host.ask(GAP, 140, address=77).value)
            simulation.stop()

    def test_the_others_are_silent_for_another_address(self):
        for module, kind in (("pd1161", "rs485"), ("pd1161", "rs232"), ("tmcm1110", "rs485")):
            simulation, host = self.host(module, "--port-kind", kind)
            self.assertEqual(kind.upper(), simulation.introduction["port_kind"])
            host.send(tmcl_host.request(GAP, 140, address=77))
            # Replies come in order: that of the second question is the first to come.
            self.assertEqual(tmcl_host.request(GGP, 66)[1], host.ask(GGP, 66).opcode)
            simulation.stop()


if __name__ == "__main__":
    tmcl_host.main()
