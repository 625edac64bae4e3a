"""The header without preprocessor is C, and has the functions, structs and constants of hbvib.h."""

import os
import re

from pycparser import c_ast, c_parser

from common import check, finish, hbvib

INCLUDE = hbvib.get_include()
with open(os.path.join(INCLUDE, "hbvib_plain.h"), encoding="utf-8") as file:
    text = file.read()
check("there is no preprocessor", "#" not in text)
tree = c_parser.CParser().parse(re.sub(r"/\*.*?\*/", "", text, flags=re.S), "hbvib_plain.h")
functions, structs, constants = {}, {}, {}
for item in tree.ext:
    if isinstance(item, c_ast.Decl) and isinstance(item.type, c_ast.FuncDecl):
        functions[item.name] = [a for a in item.type.args.params if not isinstance(a, c_ast.Typename)]
    elif isinstance(item, c_ast.Decl) and isinstance(item.type, c_ast.Struct):
        structs[item.type.name] = [field.name for field in item.type.decls]
    elif isinstance(item, c_ast.Typedef) and isinstance(getattr(item.type, "type", None), c_ast.Enum):
        for member in item.type.type.values.enumerators:
            negative = isinstance(member.value, c_ast.UnaryOp)
            constants[member.name] = -int(member.value.expr.value) if negative else int(member.value.value)
check("every function has its arguments", {n: len(a) for n, a in functions.items()} == {
    n: len(a) for n, a in hbvib._library._ARGUMENTS.items()}, set(functions) ^ set(hbvib._library._ARGUMENTS))
check("every struct has its fields", structs == {
    n: [field for field, _ in s._fields_] for n, s in hbvib.structs.items()}, set(structs) ^ set(hbvib.structs))
with open(os.path.join(INCLUDE, "hbvib.h"), encoding="utf-8") as file:
    header = file.read()
known = {name: int(value) for name, value in re.findall(r"\b(HBVIB_\w+) = (-?\d+)", header)}
check("every constant has its value", constants == known, set(constants.items()) ^ set(known.items()))

# The fields that ctypes finds at the offsets of the table in the book.
HERE = os.path.dirname(os.path.abspath(__file__))
with open(os.path.join(HERE, "../../../docs/foreign-calls.md"), encoding="utf-8") as file:
    page = file.read()
rows = 0
for name, size, table in re.findall(r"(?ms)^### (\w+) \((\d+) bytes\)\n(.*?)(?=^###|^<!--)", page):
    kind = hbvib.structs[name]
    for offset, length, field in re.findall(r"(?m)^\| (\d+) \| (\d+) \| `[^`]*` \| `(\w+)` \|", table):
        place = getattr(kind, field)
        check(f"{name}.{field} lies where the table says", (place.offset, place.size) == (int(offset), int(length)))
        rows += 1
check("the table has every field", rows == sum(len(s._fields_) for s in hbvib.structs.values()), rows)

finish(150)
