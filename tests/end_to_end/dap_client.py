"""A client of the Debug Adapter Protocol: what an editor does, without an editor. Standard library only."""

import json
import queue
import subprocess
import threading
import time

# Generous: only a hang reaches it, however busy the machine is.
DEADLINE = 60


class Refused(Exception):
    """The adapter answered that a request failed."""


class DapClient:
    """Starts a debug adapter and speaks with it over its stdin and stdout."""

    def __init__(self, *command):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.events = []
        self._messages = queue.Queue()
        self._last_number = 0
        self._errors = b""
        self._threads = [threading.Thread(target=self._read_messages), threading.Thread(target=self._read_errors)]
        for thread in self._threads:
            thread.start()

    # ---- Messages

    def _read_messages(self):
        stream = self.process.stdout
        while True:
            length = None
            while True:
                line = stream.readline()
                if not line:
                    self._messages.put(None)
                    return
                if line == b"\r\n":
                    break
                name, value = line.split(b":", 1)
                if name.lower() == b"content-length":
                    length = int(value)
            self._messages.put(json.loads(stream.read(length)))

    def _read_errors(self):
        self._errors = self.process.stderr.read()

    def send_bytes(self, data):
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def send(self, command, **arguments):
        """Sends a request and does not wait; returns its number."""
        self._last_number += 1
        body = json.dumps({"seq": self._last_number, "type": "request", "command": command,
                           "arguments": arguments}).encode()
        self.send_bytes(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        return self._last_number

    def _next(self, deadline, what):
        try:
            message = self._messages.get(timeout=max(0.0, deadline - time.monotonic()))
        except queue.Empty:
            raise AssertionError("not within %d s: %s" % (DEADLINE, what)) from None
        if message is None:
            raise AssertionError("the adapter has gone; expected " + what)
        return message

    def answer_to(self, number, what="an answer"):
        """The body of the response; events that come before it are kept. Raises Refused."""
        deadline = time.monotonic() + DEADLINE
        while True:
            message = self._next(deadline, what)
            if message["type"] == "event":
                self.events.append(message)
            elif message["type"] == "response" and message["request_seq"] == number:
                if not message["success"]:
                    raise Refused(message["message"])
                return message.get("body", {})

    def ask(self, command, **arguments):
        return self.answer_to(self.send(command, **arguments), "the answer to " + command)

    def wait_for(self, name):
        """The body of the next event of this name; the events before it are dropped."""
        deadline = time.monotonic() + DEADLINE
        while True:
            event = self.events.pop(0) if self.events else self._next(deadline, "the event " + name)
            if event["type"] == "event" and event["event"] == name:
                return event.get("body", {})

    def output(self):
        """What was printed in the console and has not been dropped."""
        return "".join(event["body"]["output"] for event in self.events if event["event"] == "output")

    # ---- What editors do

    def begin(self, kind, **arguments):
        """Initializes, and launches or attaches, until the adapter can be told where to stop."""
        abilities = self.ask("initialize", adapterID="tmcl", linesStartAt1=True, columnsStartAt1=True,
                             pathFormat="path", supportsInvalidatedEvent=True)
        self.ask(kind, **arguments)
        while True:
            event = self.events.pop(0) if self.events else self._next(time.monotonic() + DEADLINE, "initialized")
            if event.get("event") == "capabilities":
                abilities.update(event["body"]["capabilities"])
            if event.get("event") == "initialized":
                return abilities

    def stopped(self):
        return self.wait_for("stopped")

    def go(self, command, **arguments):
        """A motion, until it is over; returns why."""
        self.ask(command, threadId=1, **arguments)
        return self.stopped()

    def line(self):
        """Where the program stands."""
        return self.ask("stackTrace", threadId=1)["stackFrames"][0]["line"]

    def value(self, expression, context="watch"):
        return self.ask("evaluate", expression=expression, context=context)["result"]

    # ---- The end

    def close_input(self):
        self.process.stdin.close()

    def wait(self):
        """The exit code."""
        code = self.process.wait(DEADLINE)
        for thread in self._threads:
            thread.join(DEADLINE)
        return code

    def errors(self):
        """What the process wrote on stderr, after its end."""
        return self._errors.decode()

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.wait()
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            try:
                stream.close()
            except BrokenPipeError:
                pass
