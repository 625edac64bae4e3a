"""Limits of the band of a wedge damper by exact events in time, without the library: LIMITS of tests/forced_response/residual_band.rs.

    python tests/reference/residual_band.py

prints each limit, and fails where one differs from the number in that file. It needs numpy and scipy, and takes about a minute.

A damper (u along, v outward) lies between a platform, whose contact sticks with its slider at a place w, and a blade q, whose contact
sticks, slips or opens. In each of these states the motion is linear: with cos, sin and 1 as further variables a step is one product with
a matrix exponential. Events are roots of linear functions of the state, located to rounding; a function that dips below zero within a
step is found by the sign of its rate. A periodic motion is a fixed point of the map over a period (Newton's method), its first harmonic
an integral by Gauss nodes in each smooth piece, and a limit the place at which the least of mu N - |f| at the platform over the period
is zero.
"""
import pathlib
import re
import sys

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

STEPS = 1000
R = 0.5**0.5
MASS, DAMPING, STIFFNESS = np.diag([1, 0.01, 0.01]), np.diag([0.04, 0.004, 0.004]), np.diag([1, 1e-3, 1e-3])
KT, KN, MU_PLATFORM, MU_BLADE, FORCE = 1.0, 1.5, 0.6, 0.2, 0.1
T_PLATFORM, N_PLATFORM = R * np.array([0, 1, 1]), R * np.array([0, -1, 1])
T_BLADE, N_BLADE = R * np.array([1, -1, 1]), R * np.array([-1, 1, 1])
STICK, UP, DOWN, OPEN = range(4)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)
ROUNDING = 1e-14


def linear(x=None, v=None, w=0.0, one=0.0):
    """A linear function of the state (x, v, w, cos, sin, 1)."""
    row = np.zeros(10)
    if x is not None:
        row[:3] = x
    if v is not None:
        row[3:6] = v
    row[6], row[9] = w, one
    return row


LOAD, LOAD_RATE = linear(x=KN * N_BLADE), linear(v=KN * N_BLADE)
STRETCH = linear(x=KT * T_BLADE, w=-KT)
PLATFORM_LOAD = linear(x=KN * N_PLATFORM)


class Damper:
    """The damper at an angular frequency, its slider at the platform at a place."""

    def __init__(self, omega, place):
        self.omega, self.place, self.has_chattered = omega, place, False
        self.period = 2 * np.pi / omega
        self.step = self.period / STEPS
        self.generators = [self.generator(state) for state in range(4)]
        self.whole = [expm(a * self.step) for a in self.generators]
        self.at_nodes = [[expm(a * self.step * 0.5 * (1 + c)) for c in NODES] for a in self.generators]
        self.platform = linear(x=KT * T_PLATFORM, one=-KT * place)

    def generator(self, state):
        """A of z' = A z while the blade's contact is in a state."""
        a = np.zeros((10, 10))
        a[:3, 3:6] = np.eye(3)
        pull = np.zeros((3, 10))  # forces of contacts
        pull += np.outer(T_PLATFORM, linear(x=KT * T_PLATFORM, one=-KT * self.place)) + np.outer(N_PLATFORM, PLATFORM_LOAD)
        slider = np.zeros(10)
        if state != OPEN:
            pull += np.outer(N_BLADE, LOAD)
        if state == STICK:
            pull += np.outer(T_BLADE, STRETCH)
        elif state == OPEN:
            slider = linear(v=T_BLADE)
        else:
            sign = 1 if state == UP else -1
            pull += np.outer(T_BLADE, sign * MU_BLADE * LOAD)
            slider = linear(v=T_BLADE) - sign * MU_BLADE / KT * LOAD_RATE
        load = np.zeros((3, 10))
        load[0, 7], load[2, 9] = FORCE, 1.0
        free = np.zeros((3, 10))
        free[:, :3], free[:, 3:6] = -STIFFNESS, -DAMPING
        a[3:6] = np.linalg.solve(MASS, load + free - pull)
        a[6] = slider
        a[7, 8], a[8, 7] = -self.omega, self.omega
        return a

    def conditions(self, state):
        """Linear functions that stay above zero in a state."""
        if state == STICK:
            return np.array([MU_BLADE * LOAD - STRETCH, MU_BLADE * LOAD + STRETCH])
        if state == OPEN:
            return np.array([-LOAD])
        sign = 1 if state == UP else -1
        return np.array([sign * linear(v=T_BLADE) - MU_BLADE / KT * LOAD_RATE, LOAD])

    def after(self, state, which, z):
        """The state behind an event."""
        if state == STICK:
            return UP if which == 0 else DOWN
        if state in (UP, DOWN):
            return STICK if which == 0 else OPEN
        along = KT * z[3:6] @ T_BLADE
        if abs(along) < MU_BLADE * (LOAD_RATE @ z):
            return STICK
        return UP if along > 0 else DOWN

    def begin(self, start):
        """State and complete vector at the start of a period."""
        z = np.concatenate([start, [1.0, 0.0, 1.0]])
        load = LOAD @ z
        if load < 0:
            z[6] = T_BLADE @ z[:3]
            return OPEN, z
        pull = STRETCH @ z
        sign = np.sign(pull)
        if abs(pull) < MU_BLADE * load * (1 - 1e-13):
            return STICK, z
        z[6] = T_BLADE @ z[:3] - sign * MU_BLADE * load / KT
        outward = sign * (T_BLADE @ z[3:6]) - MU_BLADE / KT * (LOAD_RATE @ z)
        return (UP if sign > 0 else DOWN) if outward > 0 else STICK, z

    def event(self, state, z, length, end):
        """Time and number of the first condition that fails within a step; None where all hold."""
        rows = self.conditions(state)
        a = self.generators[state]
        first = None
        for number, row in enumerate(rows):
            value = lambda t, row=row: row @ (expm(a * t) @ z)
            rate = lambda t, row=row: row @ (a @ (expm(a * t) @ z))
            until = None
            if row @ end < -ROUNDING:
                until = length
            elif row @ (a @ z) < 0 < row @ (a @ end):
                lowest = brentq(rate, 0.0, length, xtol=1e-15)
                if value(lowest) < -ROUNDING:
                    until = lowest
            if until is None:
                continue
            low = 0.0
            if row @ z <= 0:
                # At zero behind the last event: the next root, if the function rises first.
                rises = row @ (a @ z) > 0 or (abs(row @ (a @ z)) < 1e-9 and row @ (a @ (a @ z)) > 0)
                if rises:
                    low = brentq(rate, 1e-6 * until, until, xtol=1e-15) if rate(1e-6 * until) > 0 > rate(until) else 0.0
            time = brentq(value, low, until, xtol=1e-16, rtol=1e-15) if value(low) > 0 else low
            if first is None or time < first[0]:
                first = time, number
        return first

    def over_period(self, start, observe=None):
        """The end of a period; `observe` receives state, begin and length of each smooth piece."""
        state, z = self.begin(start)
        for _ in range(STEPS):
            left, is_whole = self.step, True
            for _ in range(20):
                end = (self.whole[state] if is_whole else expm(self.generators[state] * left)) @ z
                found = self.event(state, z, left, end)
                if found is None:
                    if observe:
                        observe(state, z, left, end, is_whole)
                    z = end
                    break
                time, number = found
                middle = expm(self.generators[state] * time) @ z
                if observe and time > 0:
                    observe(state, z, time, middle, False)
                z, left, is_whole = middle, left - time, False
                state = self.after(state, number, z)
            else:
                # On the way to a periodic motion the contact may chatter; the motion that is read must not.
                self.has_chattered = True
                z = expm(self.generators[STICK] * left) @ z
                state = STICK
        return z[:7]

    def periodic(self, start, marched=0):
        """The periodic motion near a start: state at the begin of a period."""
        for _ in range(marched):
            start = self.over_period(start)
        for _ in range(12):
            gap = self.over_period(start) - start
            if np.abs(gap).max() < 1e-13:
                return start
            jacobian = np.empty((7, 7))
            for k in range(7):
                step = np.zeros(7)
                step[k] = 1e-6
                jacobian[:, k] = (self.over_period(start + step) - self.over_period(start - step)) / 2e-6
            start = start - np.linalg.lstsq(jacobian - np.eye(7), gap, rcond=1e-9)[0]
        if np.abs(self.over_period(start) - start).max() > 1e-11:
            raise RuntimeError("no periodic motion")
        return start

    def read(self, start):
        """|q_1|, the least margin at the platform over a period, and the states of the blade's contact."""
        first, least, states = [0j], [np.inf], []
        sides = [MU_PLATFORM * PLATFORM_LOAD - self.platform, MU_PLATFORM * PLATFORM_LOAD + self.platform]

        def observe(state, z, length, end, is_whole):
            if not states or states[-1] != state:
                states.append(state)
            a = self.generators[state]
            for k, c in enumerate(NODES):
                at = (self.at_nodes[state][k] if is_whole else expm(a * length * 0.5 * (1 + c))) @ z
                first[0] += 0.5 * length * WEIGHTS[k] * at[0] * (at[7] - 1j * at[8])
            for row in sides:
                least[0] = min(least[0], row @ z)
                if row @ (a @ z) < 0 < row @ (a @ end):
                    lowest = brentq(lambda t, row=row: row @ (a @ (expm(a * t) @ z)), 0.0, length, xtol=1e-15)
                    least[0] = min(least[0], row @ (expm(a * lowest) @ z))

        self.has_chattered = False
        self.over_period(start, observe)
        if self.has_chattered:
            raise RuntimeError("events without end")
        return abs(2 * first[0] / self.period), least[0], states


def limit(omega, place, sign, start, width=0.02):
    """The limit of the platform's slider beyond a place within it: place and amplitude there."""
    known = {}

    def margin(at):
        damper = Damper(omega, at)
        near = min(known, key=lambda other: abs(other - at)) if known else None
        motion = damper.periodic(known[near] if near is not None else start, 0 if near is not None else 100)
        known[at] = motion
        return damper.read(motion)[1]

    inner, outer = place, place + sign * width
    if margin(inner) <= 0:
        raise RuntimeError(f"{inner} is no place within the limit at {omega}")
    while margin(outer) > 0:
        inner, outer = outer, outer + sign * width
    found = brentq(margin, inner, outer, xtol=1e-13, rtol=1e-13)
    damper = Damper(omega, found)
    amplitude, least, states = damper.read(damper.periodic(known[min(known, key=lambda other: abs(other - found))]))
    names = "".join("s+-o"[state] for state in states)
    print(f"{omega} {found:.12f} {amplitude:.12f}, margin {least:.1e}, states {names}", flush=True)
    return found, amplitude


def stuck(omega):
    """Amplitude with both contacts stuck."""
    k = STIFFNESS + sum(c * np.outer(d, d) for c, d in
                        [(KT, T_PLATFORM), (KT, T_BLADE), (KN, N_PLATFORM), (KN, N_BLADE)])
    return abs(np.linalg.solve(k - omega**2 * MASS + 1j * omega * DAMPING, [FORCE, 0, 0])[0])


def expected():
    text = (pathlib.Path(__file__).parents[1] / "forced_response/residual_band.rs").read_text(encoding="utf-8")
    table = re.search(r"const LIMITS[^=]*=\s*\[(.*?)\n\];", text, re.S).group(1)
    number = lambda word: float(word.replace("_", "").replace("f64::NAN", "nan"))
    words = re.findall(r"f64::NAN|\d[\d_]*\.\d[\d_]*", table)
    return np.array([number(word) for word in words]).reshape(4, 5)


def main():
    start = np.zeros(7)
    start[2] = 0.8
    worst = 0.0
    for omega, low, low_amplitude, high, high_amplitude in expected():
        found = [limit(omega, low + 0.01, -1, start)]
        if np.isfinite(high):
            found.append(limit(omega, high - 0.01, 1, start))
        else:
            found.append((np.nan, stuck(omega)))
            print(f"{omega} both contacts stuck {found[1][1]:.12f}")
        gaps = np.array(found) - [[low, low_amplitude], [high, high_amplitude]]
        worst = max(worst, np.nanmax(np.abs(gaps)))
    print(f"largest difference from the test {worst:.1e}")
    return int(worst > 1e-9)


if __name__ == "__main__":
    sys.exit(main())
