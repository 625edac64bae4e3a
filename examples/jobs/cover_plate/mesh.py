"""Writes mesh.inp, one sector of a bladed disk with a cover plate, in the format of CalculiX and Abaqus; SI units.

The disk and the plate in front of it are clamped at the bore and touch at the rim; no node belongs to both. The sets of nodes are
the two faces of the sector, the clamped nodes, both sides of the contact, and a corner of the blade's tip.
"""

from math import cos, pi, sin

SECTORS = 24
AROUND = 4  # elements from the left to the right face
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
nodes, elements = {}, []  # number by position; numbers of corners and of the middles of edges
sets = {name: [] for name in ("LEFT", "RIGHT", "BORE", "DISK_RIM", "PLATE_RIM", "TIP")}


def block(radii, heights, steps, share=lambda r: 1.0):
    """Quadratic bricks; returns node numbers by twice the steps in radius, angle and height. A share of the sector is filled."""
    numbers = {}

    def number(place):
        if place not in numbers:
            i, j, k = place
            r = (radii[i // 2] + radii[(i + 1) // 2]) / 2
            z = (heights[k // 2] + heights[(k + 1) // 2]) / 2
            step = (steps[j // 2] + steps[(j + 1) // 2]) / 2
            angle = 2 * pi / SECTORS * (0.5 + share(r) * (step / AROUND - 0.5))
            position = (r * cos(angle), r * sin(angle), z)
            numbers[place] = nodes.setdefault(tuple(f"{x:.12f}" for x in position), len(nodes) + 1)
        return numbers[place]

    for k in range(0, 2 * len(heights) - 2, 2):
        for j in range(0, 2 * len(steps) - 2, 2):
            for i in range(0, 2 * len(radii) - 2, 2):
                corners = [(i + a, j + b, k + c) for c in (0, 2) for a, b in ((0, 0), (2, 0), (2, 2), (0, 2))]
                middles = [tuple((p + q) // 2 for p, q in zip(corners[a], corners[b])) for a, b in EDGES]
                elements.append([number(place) for place in corners + middles])
    return numbers


radii = [0.05, 0.07, 0.09, 0.11, 0.13, 0.15]
bodies = [block(radii, heights, range(AROUND + 1)) for heights in ([0.0, 0.01, 0.02], [0.0202, 0.0242])]
blade = block([0.15, 0.18, 0.21, 0.24], [0.0, 0.01, 0.02], [1, 2, 3], lambda r: 1 - 6 * (r - 0.15))
for body in bodies:
    for (i, j, k), n in body.items():
        if i == 0:
            sets["BORE"].append(n)
        elif j == 0:
            sets["LEFT"].append(n)
        elif j == 2 * AROUND:
            sets["RIGHT"].append(n)
# Pairs on the right face are images of those on the left one and are left out.
for j in range(0, 2 * AROUND, 2):
    sets["DISK_RIM"].append(bodies[0][10, j, 4])
    sets["PLATE_RIM"].append(bodies[1][10, j, 0])
sets["TIP"] = [blade[6, 0, 0]]

with open("mesh.inp", "w") as file:
    file.write("*NODE, NSET=ALL\n" + "".join(f"{n}, {', '.join(position)}\n" for position, n in nodes.items()))
    file.write("*ELEMENT, TYPE=C3D20, ELSET=BRICKS\n")
    for number, members in enumerate(elements, 1):
        words = [str(n) for n in [number, *members]]
        file.write(", ".join(words[:11]) + ",\n" + ", ".join(words[11:]) + "\n")
    for name, members in sets.items():
        file.write(f"*NSET, NSET={name}\n" + "".join(f"{n},\n" for n in sorted(members)))
