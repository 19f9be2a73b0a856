#!/usr/bin/env python3
"""A remote hand for Touchstone: two fingertips that go down onto the table and come up again, and what they feel.

With --waves the packets carry wave variables (Touchstone must be told so too): a hand on a spring and damper then leans on the
table, at rest however slow the network is. --delay makes the network slow, each way, to try it.

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
WAVE_VERSION, WAVE_UP, WAVE_DOWN = 2, 3, 4
GOODBYE, GREETING, STOP = 1, 1, 2
HEADER = "<4sBBHQQQ"  # magic, version, kind, flags, session, sequence, clock in us
SEAL_BYTES = 16


class Hand:
    """The socket, the session and the sequence."""

    version, up, down, down_bytes = VERSION, MOTION, FORCE, 88

    def __init__(self, address, key, delay_s=0.0):
        self.key = key
        self.delay_s = delay_s
        self.leaving, self.coming = [], []
        self.session = 0
        self.sequence = 0
        self.newest_force = 0
        self.asked_us = set()
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect(address)
        self.socket.setblocking(False)

    def send(self, tips, velocities, flags=0):
        """Sends positions (m) and velocities (m/s) as [x1, y1, x2, y2]."""
        self.post(struct.pack("<8d", *tips, *velocities), flags)

    def post(self, payload, flags):
        """Sends a payload behind its header and before its seal, when the artificial delay has passed."""
        self.sequence += 1
        clock_us = time.monotonic_ns() // 1000
        if self.session == 0:
            self.asked_us.add(clock_us)
        message = struct.pack(HEADER, MAGIC, self.version, self.up, flags, self.session, self.sequence, clock_us)
        message += payload
        self.leaving.append((time.monotonic() + self.delay_s, message + self.seal(message)))
        self.flush()

    def flush(self):
        """Hands over what has waited long enough."""
        while self.leaving and self.leaving[0][0] <= time.monotonic():
            try:
                self.socket.send(self.leaving.pop(0)[1])
            except OSError:
                pass  # nobody listens yet, or any more: the next packet may find somebody

    def receive(self):
        """The newest answer that has come, as `content` gives it, or None."""
        self.flush()
        while True:
            try:
                self.coming.append((time.monotonic() + self.delay_s, self.socket.recv(256)))
            except OSError:
                break
        newest = None
        while self.coming and self.coming[0][0] <= time.monotonic():
            answer = self.decode(self.coming.pop(0)[1])
            newest = newest if answer is None else answer
        return newest

    def decode(self, packet):
        if len(packet) != self.down_bytes:
            return None
        message, seal = packet[:-SEAL_BYTES], packet[-SEAL_BYTES:]
        if not hmac.compare_digest(seal, self.seal(message)):
            return None
        magic, version, kind, flags, session, sequence, _ = struct.unpack_from(HEADER, message)
        if (magic, version, kind) != (MAGIC, self.version, self.down):
            return None
        echo_us = struct.unpack_from("<Q", message, len(message) - 8)[0]
        if flags & GREETING:
            # Only the answer to a question of this run: a greeting recorded long ago would lead astray.
            if self.session == 0 and echo_us in self.asked_us:
                self.session, self.newest_force = session, sequence
                self.greeted(message)
            return None
        if session != self.session or sequence <= self.newest_force:
            return None
        content = self.content(message, flags)
        if content is None:
            return None
        self.newest_force = sequence
        return content, (time.monotonic_ns() // 1000 - echo_us) * 1e-6

    def greeted(self, message):
        """A session begins."""

    def content(self, message, flags):
        """[fx1, fy1, fx2, fy2] in N."""
        force = struct.unpack_from("<4d", message, 32)
        return force if all(math.isfinite(f) for f in force) else None

    def seal(self, message):
        return hmac.new(self.key, message, hashlib.sha256).digest()[:SEAL_BYTES]


class WaveHand(Hand):
    """The same with wave variables: the packets carry each wave's integral and energy since the session began."""

    version, up, down, down_bytes = WAVE_VERSION, WAVE_UP, WAVE_DOWN, 112

    SMOOTHING_S = 0.02  # with which the wave that arrives is followed, or four of the longest gaps between packets
    LONGEST_GAP_S = 0.1  # a longer one is a break, and not smoothed over
    PURSE_J = 1e-4  # energy that may be kept from one tick for another: evens the errors of sampling out
    MOST_N = 4.0  # what the motors can do

    def __init__(self, address, key, delay_s=0.0):
        super().__init__(address, key, delay_s)
        self.impedance = 1.0
        self.origin = [-0.02, -0.11, 0.02, -0.11]
        # Per finger: x and y of the integral, energy.
        self.arrived = [[0.0] * 3 for _ in range(2)]
        self.used = [[0.0] * 3 for _ in range(2)]
        self.sent = [[0.0] * 3 for _ in range(2)]
        self.purse = [0.0] * 2
        self.incoming = [[0.0, 0.0] for _ in range(2)]
        self.stopped = False
        self.arrived_at, self.gap_s = None, 0.0

    def send_waves(self, flags=0):
        """Sends where the hand began (m) and the waves since then."""
        self.post(struct.pack("<10d", *self.origin, *self.sent[0], *self.sent[1]), flags)

    def greeted(self, message):
        self.impedance = struct.unpack_from("<d", message, 80)[0]

    def content(self, message, flags):
        accounts = struct.unpack_from("<6d", message, 32)
        if not all(math.isfinite(value) for value in accounts):
            return None
        self.arrived = [list(accounts[:3]), list(accounts[3:])]
        now = time.monotonic()
        if self.arrived_at is not None:
            self.gap_s = max(self.gap_s, min(now - self.arrived_at, self.LONGEST_GAP_S))
        self.arrived_at = now
        self.stopped = bool(flags & STOP)
        return accounts

    def forces(self, velocities, dt):
        """A tick begins: the forces to put on the fingers, N, for their velocities of the tick before, m/s."""
        forces = []
        self.gap_s *= math.exp(-dt / 2.0)
        smoothing_s = max(self.SMOOTHING_S, 4.0 * self.gap_s)
        for finger in range(2):
            arrived, used = self.arrived[finger], self.used[finger]
            wave = [(arrived[axis] - used[axis]) / smoothing_s for axis in range(2)]
            # No more energy than has arrived.
            most = math.sqrt(2.0 * max(arrived[2] - used[2], 0.0) / dt)
            size = math.hypot(*wave)
            if size > most:
                wave = [w * most / size for w in wave]
            for axis in range(2):
                used[axis] += wave[axis] * dt
            used[2] += 0.5 * (wave[0] ** 2 + wave[1] ** 2) * dt
            self.incoming[finger] = wave
            root = math.sqrt(2.0 * self.impedance)
            force = [root * wave[axis] - self.impedance * velocities[2 * finger + axis] for axis in range(2)]
            size = math.hypot(*force)
            limit = 0.0 if self.stopped else self.MOST_N
            forces += [f * limit / size for f in force] if size > limit else force
        return forces

    def moved(self, forces, moved, dt):
        """The tick ends: under these forces (N) the fingers have moved by so much (m)."""
        root = math.sqrt(2.0 * self.impedance)
        for finger in range(2):
            w, sent = self.incoming[finger], self.sent[finger]
            u = [root * moved[2 * finger + axis] / dt - w[axis] for axis in range(2)]
            for axis in range(2):
                sent[axis] += u[axis] * dt
            # The wave may carry no more than this end took in: from the hand, and from the wave that came.
            work = -sum(forces[2 * finger + axis] * moved[2 * finger + axis] for axis in range(2))
            self.purse[finger] += work + 0.5 * (w[0] ** 2 + w[1] ** 2) * dt
            spent = max(0.0, min(0.5 * (u[0] ** 2 + u[1] ** 2) * dt, self.purse[finger]))
            sent[2] += spent
            self.purse[finger] = min(self.purse[finger] - spent, self.PURSE_J)


def greet(hand, limit_s):
    """Asks for a session, five times a second, until one comes."""
    deadline, rest = time.monotonic() + limit_s, [-0.02, -0.11, 0.02, -0.11]
    while hand.session == 0 and time.monotonic() < deadline:
        if isinstance(hand, WaveHand):
            hand.send_waves()
        else:
            hand.send(rest, [0.0] * 4)
        until = time.monotonic() + 0.2 + 2.0 * hand.delay_s
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


def lean(hand, seconds, rate_hz=500.0):
    """A hand of 80 g on a spring of 400 N/m that wants to be 10 mm under the table's surface, and leans on it."""
    mass, stiffness, damping = 0.08, 400.0, 9.0
    at, velocity, mean = list(hand.origin), [0.0] * 4, [0.0] * 4
    energy, least, largest, answers, round_trips, forces = 0.0, 0.0, 0.0, 0, [], []
    start = last = time.monotonic()
    while (now := time.monotonic()) - start < seconds:
        dt = min(max(now - last, 1e-5), 0.1)
        last = now
        answer = hand.receive()
        if answer is not None:
            answers += 1
            round_trips.append(answer[1])
        force = hand.forces(mean, dt)
        before = list(at)
        goal_y = hand.origin[1] - 0.025 * min((now - start) / 1.0, 1.0)
        # A real device sets its motors here, and reads where its fingers are; this one is a hand by itself.
        parts = 1 + int(dt / 1e-4)
        for _ in range(parts):
            for i, goal in enumerate((hand.origin[0], goal_y, hand.origin[2], goal_y)):
                push = stiffness * (goal - at[i]) - damping * velocity[i] + force[i]
                velocity[i] += push / mass * dt / parts
                at[i] += velocity[i] * dt / parts
        moved = [a - b for a, b in zip(at, before)]
        mean = [m / dt for m in moved]
        hand.moved(force, moved, dt)
        energy -= sum(f * m for f, m in zip(force, moved))
        least = min(least, energy)
        hand.send_waves()
        largest = max(largest, force[1])
        forces.append((now - start, force[1], at[1]))
        time.sleep(1.0 / rate_hz)
    hand.send_waves(GOODBYE)
    late = [(force, y) for t, force, y in forces if t > 0.8 * seconds]
    round_trips.sort()
    return {
        "sent": hand.sequence,
        "answers": answers,
        "largest_force_N": largest,
        "round_trip_s": round_trips[len(round_trips) // 2] if round_trips else None,
        "last_force_N": sum(f for f, _ in late) / len(late),
        "last_swing_m": max(y for _, y in late) - min(y for _, y in late),
        "least_energy_J": least,
    }


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--host", default="127.0.0.1")
    arguments.add_argument("--port", type=int, default=47474)
    arguments.add_argument("--key", help="file with 64 hexadecimal digits", required=True)
    arguments.add_argument("--seconds", type=float, default=10.0)
    arguments.add_argument("--waves", action="store_true", help="send wave variables in place of positions")
    arguments.add_argument("--delay", type=float, default=0.0, help="artificial delay each way, ms")
    options = arguments.parse_args()
    try:
        with open(options.key, encoding="ascii") as file:
            key = bytes.fromhex(file.read().strip())
    except (OSError, ValueError) as error:
        return f"the key could not be read ({error}); README.md says how to make one"
    if len(key) != 32:
        return "a key is 64 hexadecimal digits"
    kind = WaveHand if options.waves else Hand
    hand = kind((options.host, options.port), key, 1e-3 * options.delay)
    if not greet(hand, limit_s=max(5.0, options.seconds)):
        return f"nobody answers at {options.host}:{options.port}; is Touchstone listening there, with this key?"
    work = lean if options.waves else press
    report = work(hand, options.seconds)
    while hand.leaving:
        hand.flush()
        time.sleep(0.001)
    print(json.dumps(report))
    return 0


if __name__ == "__main__":
    sys.exit(main())
