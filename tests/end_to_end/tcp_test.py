"""Hosts at the TCP port of a virtual module."""

import socket

import tmcl_host
from tmcl_host import DEADLINE, GAP, OK, SGP, Reply, SimulationTest, TemporaryFolderTest, request


def connect(simulation):
    return socket.create_connection(("127.0.0.1", simulation.tcp_port), timeout=DEADLINE)


def receive(connection):
    data = b""
    while len(data) < 9:
        part = connection.recv(9 - len(data))
        if not part:
            raise AssertionError("the connection was closed after %d bytes" % len(data))
        data += part
    return Reply(data)


class Tcp(SimulationTest):
    arguments = ("tmcm1110",)

    def test_takes_a_new_connection_for_each_command(self):
        for i in range(20):
            with connect(self.simulation) as connection:
                connection.sendall(request(SGP, 3, 2, i))
                self.assertEqual((OK, i), (receive(connection).status, i))

    def test_answers_each_of_several_hosts_its_own_question(self):
        connections = [connect(self.simulation) for _ in range(5)]
        for i, connection in enumerate(connections):
            connection.sendall(request(SGP, i, 2, 1000 + i) * 3)
        for i, connection in enumerate(connections):
            for _ in range(3):
                self.assertEqual(1000 + i, receive(connection).value)
            connection.close()

    def test_shares_the_module_with_the_serial_port(self):
        with connect(self.simulation) as connection:
            connection.sendall(request(SGP, 8, 2, 4711))
            receive(connection)
        self.assertEqual(4711, self.host.do(tmcl_host.GGP, 8, 2))

    def test_a_host_that_leaves_in_mid_request_disturbs_nobody(self):
        with connect(self.simulation) as rude:
            rude.sendall(request(GAP, 140)[:5])
        with connect(self.simulation) as connection:
            connection.sendall(request(GAP, 140))
            self.assertEqual(8, receive(connection).value)


class TcpOption(TemporaryFolderTest):
    def test_a_taken_port_is_refused_when_it_was_asked_for(self):
        simulation = self.start("pd1161")
        second = self.tmcl("sim", "--tcp", str(simulation.tcp_port), "--pty-link", self.path("second"))
        self.assertEqual(74, second.returncode)
        self.assertIn("cannot listen", second.stderr)

    def test_nonsense_is_refused(self):
        for text in ("port", "-1", "65536", "somewhere:5000"):
            refused = self.tmcl("sim", "--tcp=" + text, "--pty-link", self.path("link"))
            self.assertEqual(64, refused.returncode, text)


if __name__ == "__main__":
    tmcl_host.main()
