"""A sector of a bladed disk of 24 blades and a ring that is pressed on its rim, meshed by gmsh with tetrahedra of second order.

usage: python mesh.py [SIZE_DISK SIZE_RING]      writes wheel.inp; needs `pip install gmsh`

Sizes of elements in metres: 0.009 0.012 unless given, 6,000 degrees of freedom; 0.0042 0.012 make 20,000. The faces LEFT and RIGHT have
equal meshes, and so have both sides of the contact, RING_RIM and DISK_RIM. BORE is to be clamped.
"""

import math
import sys

import gmsh

disk_size, ring_size = (float(x) for x in sys.argv[1:3]) if len(sys.argv) > 2 else (0.009, 0.012)
SECTORS, GAP = 24, 2e-4
ANGLE = 2 * math.pi / SECTORS
TURN = [math.cos(ANGLE), -math.sin(ANGLE), 0, 0, math.sin(ANGLE), math.cos(ANGLE), 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
shapes = gmsh.model.occ


def wedge(inner, outer, bottom, top):
    """A sector of a ring."""
    surface = shapes.addRectangle(inner, bottom, 0, outer - inner, top - bottom)
    shapes.rotate([(2, surface)], 0, 0, 0, 1, 0, 0, math.pi / 2)
    shapes.rotate([(2, surface)], 0, 0, 0, 0, 0, 1, -ANGLE / 2)
    return next(part for part in shapes.revolve([(2, surface)], 0, 0, 0, 0, 0, 1, ANGLE) if part[0] == 3)


blade = (3, shapes.addBox(0.149, -0.006, 0.002, 0.091, 0.012, 0.016))
bodies, _ = shapes.fuse([wedge(0.05, 0.15, 0.0, 0.02)], [blade])
# The rim is cut off, so that its face equals that of the ring.
rim, _ = shapes.intersect(bodies, [wedge(0.04, 0.12, -0.01, 0.03)], removeObject=False, removeTool=True)
bodies, _ = shapes.fragment(bodies, rim)
bodies = [part[1] for part in bodies if part[0] == 3]
ring = wedge(0.12, 0.15, 0.02 + GAP, 0.025 + GAP)[1]
shapes.synchronize()

sets = dict(LEFT=[], RIGHT=[], BORE=[], DISK_RIM=[], RING_RIM=[])
for body in [*bodies, ring]:
    for _, face in gmsh.model.getBoundary([(3, body)], oriented=False):
        _, _, low, _, _, high = gmsh.model.getBoundingBox(2, face)
        x, y, _ = shapes.getCenterOfMass(2, face)
        angle, radius, is_flat = math.atan2(y, x), math.hypot(x, y), high - low < 1e-5
        if not is_flat and abs(angle + ANGLE / 2) < 1e-6:
            sets["LEFT"].append(face)
        elif not is_flat and abs(angle - ANGLE / 2) < 1e-6:
            sets["RIGHT"].append(face)
        elif not is_flat and body != ring and radius < 0.052:
            sets["BORE"].append(face)
        elif is_flat and body != ring and abs(low - 0.02) < 1e-5 and 0.12 < radius < 0.16:
            sets["DISK_RIM"].append(face)
        elif is_flat and body == ring and abs(low - 0.02 - GAP) < 1e-5:
            sets["RING_RIM"].append(face)
for left, right in zip(sets["LEFT"], sets["RIGHT"]):
    gmsh.model.mesh.setPeriodic(2, [right], [left], TURN)
gmsh.model.mesh.setPeriodic(2, sets["RING_RIM"], sets["DISK_RIM"], [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, GAP, 0, 0, 0, 1])
gmsh.model.mesh.setSize(gmsh.model.getBoundary([(3, body) for body in bodies], recursive=True, combined=False), disk_size)
near_ring = gmsh.model.getBoundary([(2, face) for face in sets["DISK_RIM"]] + [(3, ring)], recursive=True, combined=False)
gmsh.model.mesh.setSize(near_ring, ring_size)
for option, value in (("ElementOrder", 2), ("SecondOrderLinear", 1), ("SaveGroupsOfNodes", 1)):
    gmsh.option.setNumber("Mesh." + option, value)
for name, faces in sets.items():
    gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, faces), name)
gmsh.model.setPhysicalName(3, gmsh.model.addPhysicalGroup(3, [*bodies, ring]), "SOLID")
gmsh.model.mesh.generate(3)
gmsh.write("wheel.inp")
print(len(gmsh.model.mesh.getNodes()[0]), "nodes")
