"""Prints the size of every struct of hbvib.h and the offset and size of each of its fields, in the header's order."""

import ctypes

import hbvib

for name, struct in hbvib.structs.items():
    print(name, "sizeof", 0, ctypes.sizeof(struct))
    for field, _ in struct._fields_:
        place = getattr(struct, field)
        print(name, field, place.offset, place.size)
