#!/usr/bin/env python3
"""A remote hand for Touchstone: two fingertips that go down onto the table and come up again, and what they feel.

Only Python's standard library. The packets are described in README.md beside this file.
"""

import argparse
import hashlib
import hmac
import json
import math
import socket
import struct
import sys
import time

MAGIC, VERSION, MOTION, FORCE = b"TSUD", 1, 1, 2
GOODBYE, GREETING = 1, 1
HEADER = "<4sBBHQQQ"  # magic, version, kind, flags, session, sequence, clock in us
SEAL_BYTES = 16


class Hand:
    """The socket, the session and the sequence."""

    def __init__(self, address, key):
        self.key = key
        self.session = 0
        self.sequence = 0
        self.newest_force = 0
        self.asked_us = set()
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect(address)
        self.socket.setblocking(False)

    def send(self, tips, velocities, flags=0):
        """Sends positions (m) and velocities (m/s) as [x1, y1, x2, y2]."""
        self.sequence += 1
        clock_us = time.monotonic_ns() // 1000
        if self.session == 0:
            self.asked_us.add(clock_us)
        message = struct.pack(HEADER, MAGIC, VERSION, MOTION, flags, self.session, self.sequence, clock_us)
        message += struct.pack("<8d", *tips, *velocities)
        try:
            self.socket.send(message + self.seal(message))
        except OSError:
            pass  # nobody listens yet, or any more: the next packet may find somebody

    def receive(self):
        """The newest force that has come: ([fx1, fy1, fx2, fy2] in N, round trip in s), or None."""
        newest = None
        while True:
            try:
                packet = self.socket.recv(256)
            except OSError:
                return newest
            force = self.decode(packet)
            if force is not None:
                newest = force

    def decode(self, packet):
        if len(packet) != 88:
            return None
        message, seal = packet[:-SEAL_BYTES], packet[-SEAL_BYTES:]
        if not hmac.compare_digest(seal, self.seal(message)):
            return None
        magic, version, kind, flags, session, sequence, _ = struct.unpack_from(HEADER, message)
        if (magic, version, kind) != (MAGIC, VERSION, FORCE):
            return None
        *force, echo_us = struct.unpack_from("<4dQ", message, 32)
        if flags & GREETING:
            # Only the answer to a question of this run: a greeting recorded long ago would lead astray.
            if self.session == 0 and echo_us in self.asked_us:
                self.session, self.newest_force = session, sequence
            return None
        if session != self.session or sequence <= self.newest_force:
            return None
        if not all(math.isfinite(f) for f in force):
            return None
        self.newest_force = sequence
        return force, (time.monotonic_ns() // 1000 - echo_us) * 1e-6

    def seal(self, message):
        return hmac.new(self.key, message, hashlib.sha256).digest()[:SEAL_BYTES]


def greet(hand, limit_s):
    """Asks for a session, five times a second, until one comes."""
    deadline, rest = time.monotonic() + limit_s, [-0.02, -0.11, 0.02, -0.11]
    while hand.session == 0 and time.monotonic() < deadline:
        hand.send(rest, [0.0] * 4)
        until = time.monotonic() + 0.2
        while hand.session == 0 and time.monotonic() < until:
            hand.receive()
            time.sleep(0.002)
    return hand.session != 0


def press(hand, seconds, rate_hz=500.0):
    """Goes down onto the table and up again along a cosine, once every two seconds."""
    start = time.monotonic()
    # The table is at -0.125 m: from 12 mm over it to 3 mm into it.
    middle, swing, omega = -0.1205, 0.0075, math.pi
    largest, answers, round_trips = 0.0, 0, []
    while (now := time.monotonic() - start) < seconds:
        y = middle + swing * math.cos(omega * now)
        vy = -swing * omega * math.sin(omega * now)
        hand.send([-0.02, y, 0.02, y], [0.0, vy, 0.0, vy])
        answer = hand.receive()
        if answer is not None:
            (_, fy1, _, _), round_trip_s = answer
            largest, answers = max(largest, fy1), answers + 1
            round_trips.append(round_trip_s)
        # A real device sets its motors here, and to zero when nothing has come for 50 ms.
        time.sleep(1.0 / rate_hz)
    hand.send([-0.02, -0.11, 0.02, -0.11], [0.0] * 4, GOODBYE)
    round_trips.sort()
    median_s = round_trips[len(round_trips) // 2] if round_trips else None
    return {"sent": hand.sequence, "answers": answers, "largest_force_N": largest, "round_trip_s": median_s}


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--host", default="127.0.0.1")
    arguments.add_argument("--port", type=int, default=47474)
    arguments.add_argument("--key", help="file with 64 hexadecimal digits", required=True)
    arguments.add_argument("--seconds", type=float, default=10.0)
    options = arguments.parse_args()
    try:
        with open(options.key, encoding="ascii") as file:
            key = bytes.fromhex(file.read().strip())
    except (OSError, ValueError) as error:
        return f"the key could not be read ({error}); README.md says how to make one"
    if len(key) != 32:
        return "a key is 64 hexadecimal digits"
    hand = Hand((options.host, options.port), key)
    if not greet(hand, limit_s=max(5.0, options.seconds)):
        return f"nobody answers at {options.host}:{options.port}; is Touchstone listening there, with this key?"
    print(json.dumps(press(hand, options.seconds)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
