"""Flexibility of small structures with 60 digits: tests/data/flexibility_digits.json, for tests/forced_response/flexibility_digits.rs.

    python tests/reference/flexibility_digits.py

writes the file anew. It needs mpmath, and takes some seconds. The numbers of the matrices are those of double precision, as the library
stores them, and G = (K - w^2 M + i w C)^-1 is that of these, rounded at the end.

Penalties: a chain of 12 masses 1 between springs 1 with both ends held and damping C = M/1024, in which the spring between masses 5 and 6
is p = 1e4 to 1e12. G at and beside the resonances 2, 6 and 11 (by 1e-9, 1e-6, 1e-3 of w, on either side), between the others, at 1/16 of
the lowest and beyond all soft ones.

Exceptional points, where two modes of a damped pencil are one: (1) two oscillators with spring 1/16 between them, of which one has a
dashpot c and a detuning d at which the polynomial of the pencil has a double root. (2) M = K = 1, a dashpot 2 g on the first motion, and
gyroscopic forces g between them: with s = x + 1/x the polynomial is (s + 2 g) s + g^2 = (s + g)^2.
"""
import json
import pathlib

import mpmath as mp

mp.mp.dps = 60
MASSES, LINK, ALPHA = 12, 5, 2.0**-10
PENALTIES = [1e4, 1e6, 1e8, 1e10, 1e12]
RESONANCES, BESIDE = (2, 6, 11), (0.0, 1e-9, -1e-9, 1e-6, -1e-6, 1e-3, -1e-3)
PORTS = ((0, 0), (0, 11), (5, 0), (5, 5), (6, 5), (11, 11))
SPRING, GYROSCOPIC = 1 / 16, 1 / 8


def flexibility(m, c, k, omega):
    w = mp.mpf(omega)
    return (k - w * w * m + mp.mpc(0, 1) * w * c) ** -1


def entries(g, ports):
    return [[float(g[i, j].real), float(g[i, j].imag)] for i, j in ports]


def chain(penalty):
    springs = [mp.mpf(1)] * (MASSES + 1)
    springs[LINK + 1] = mp.mpf(penalty)
    k = mp.zeros(MASSES)
    for i in range(MASSES):
        # As stored in double precision.
        k[i, i] = mp.mpf(float(springs[i]) + float(springs[i + 1]))
        if i > 0:
            k[i, i - 1] = k[i - 1, i] = -springs[i]
    return mp.eye(MASSES), ALPHA * mp.eye(MASSES), k


def of_penalty(penalty):
    m, c, k = chain(penalty)
    known = sorted(mp.sqrt(x) for x in mp.eigsy(k, eigvals_only=True))
    omegas = [float(known[0]) / 16, 2.5]
    omegas += [float((known[j] + known[j + 1]) / 2) for j in (0, 3, 7)]
    for j in RESONANCES:
        omegas += [float(known[j - 1] * (1 + mp.mpf(by))) for by in BESIDE]
    omegas.sort()
    return {"penalty": penalty, "omega": omegas, "g": [entries(flexibility(m, c, k, w), PORTS) for w in omegas]}


def exceptional_point():
    """c and d at which (x^2 + a)(x^2 + c x + a + d) - s^2, a = 1 + s, has a double root x."""
    s = mp.mpf(SPRING)
    a = 1 + s

    def equations(c, d, re, im):
        x = mp.mpc(re, im)
        one, other = x * x + a, x * x + c * x + a + d
        p, slope = one * other - s * s, 2 * x * other + one * (2 * x + c)
        return [mp.re(p), mp.im(p), mp.re(slope), mp.im(slope)]

    # To first order a pair is one where the difference of dampings is twice the coupling.
    c, d, re, im = mp.findroot(equations, (2 * s, 0, -s / 2, 1 + s / 2))
    return float(c), float(d), complex(re, im)


def pair(m, c, k, root):
    """At, and beside, the frequency of the pair."""
    omegas = sorted([0.5, 2.0] + [root * (1 + by) for by in (0.0, 1e-9, -1e-9, 1e-4, -1e-4, 0.05, -0.05)])
    ports = ((0, 0), (0, 1), (1, 0), (1, 1))
    return {"omega": omegas, "g": [entries(flexibility(m, c, k, w), ports) for w in omegas]}


def main():
    dashpot, detuning, root = exceptional_point()
    s = SPRING
    # As stored in double precision.
    other = (1 + s) + detuning
    damped = pair(mp.eye(2), mp.matrix([[0, 0], [0, dashpot]]), mp.matrix([[1 + s, -s], [-s, other]]), root.imag)
    g = GYROSCOPIC
    # x^2 + g x + 1 = 0 twice.
    whirl = pair(mp.eye(2), mp.matrix([[2 * g, g], [-g, 0]]), mp.eye(2), (1 - g * g / 4) ** 0.5)
    written = {
        "masses": MASSES, "link": LINK, "alpha": ALPHA, "ports": PORTS, "penalties": [of_penalty(p) for p in PENALTIES],
        "damped_pair": {"spring": s, "dashpot": dashpot, "other": other, **damped},
        "gyroscopic_pair": {"gyroscopic": g, **whirl},
    }
    path = pathlib.Path(__file__).parents[1] / "data" / "flexibility_digits.json"
    path.write_text(json.dumps(written, indent=0) + "\n")
    print(f"{path}: dashpot {dashpot!r}, pole {root!r}")


if __name__ == "__main__":
    main()
