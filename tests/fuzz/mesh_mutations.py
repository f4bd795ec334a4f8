"""Mesh files of a beam of 8 m x 1 m at 0, 2, and what may be wrong in them."""

import text_mutations

COLUMNS, ROWS = 8, 2
NODES = [(column, 2 + row / ROWS) for row in range(ROWS + 1)
         for column in range(COLUMNS + 1)]


def quadrilaterals():
    """By numbers of nodes from 1, anticlockwise."""
    wide = COLUMNS + 1
    return [(row * wide + column + 1, row * wide + column + 2,
             (row + 1) * wide + column + 2, (row + 1) * wide + column + 1)
            for row in range(ROWS) for column in range(COLUMNS)]


def numbered(rows, words):
    return [" ".join(map(str, (number, *words, *row)))
            for number, row in enumerate(rows, start=1)]


def gmsh(cells, nodes):
    kinds = {3: 2, 4: 3, 2: 1, 8: 5}
    return "\n".join(
        ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes)),
         *numbered([(x, y, 0) for x, y in nodes], ()), "$EndNodes",
         "$Elements", str(len(cells)),
         *(f"{number} {kinds.get(len(cell), 3)} 2 0 1 "
           + " ".join(map(str, cell))
           for number, cell in enumerate(cells, start=1)), "$EndElements", ""])


def ucd(cells, nodes):
    kinds = {3: "tri", 4: "quad", 2: "line", 8: "hex"}
    return "\n".join(
        [f"{len(nodes)} {len(cells)} 0 0 0",
         *numbered([(x, y, 0) for x, y in nodes], ()),
         *(f"{number} 1 {kinds.get(len(cell), 'quad')} "
           + " ".join(map(str, cell))
           for number, cell in enumerate(cells, start=1)), ""])


def abaqus(cells, nodes):
    return "\n".join(
        ["*HEADING", "beam", "*NODE",
         *(f"{number}, {x}, {y}, 0"
           for number, (x, y) in enumerate(nodes, start=1)),
         "*ELEMENT, TYPE=CPS4R, ELSET=ALL",
         *(", ".join(map(str, (number, *cell)))
           for number, cell in enumerate(cells, start=1)), ""])


def vtk(cells, nodes):
    kinds = {3: 5, 4: 9, 2: 3, 8: 12}
    return "\n".join(
        ["# vtk DataFile Version 3.0", "beam", "ASCII",
         "DATASET UNSTRUCTURED_GRID", f"POINTS {len(nodes)} double",
         *(f"{x} {y} 0" for x, y in nodes),
         f"CELLS {len(cells)} {sum(len(cell) + 1 for cell in cells)}",
         *(" ".join(map(str, (len(cell), *(n - 1 for n in cell))))
           for cell in cells),
         f"CELL_TYPES {len(cells)}",
         *(str(kinds.get(len(cell), 9)) for cell in cells), ""])


FORMATS = {"mesh.msh": gmsh, "mesh.inp": ucd, "mesh.inp ": abaqus,
           "mesh.vtk": vtk, "mesh.ucd": ucd, "mesh.unv": ucd,
           "mesh.xda": ucd, "mesh": gmsh, "mesh.exo": gmsh}


def wrong_cells(cells, draws):
    """Triangles, twisted, repeated, negative or missing nodes."""
    place = draws.below(len(cells))
    a, b, c, d = cells[place]
    far = draws.choose([-5, 0, 999999999, len(NODES) + 1, 2**31, 2**63])
    cells[place:place + 1] = draws.choose(
        [[(a, b, c), (a, c, d)], [(a, c, b, d)], [(a, d, c, b)],
         [(a, a, c, d)], [(a, a, a, a)], [(far, b, c, d)], [],
         [cells[place]] * 2, [(a, b)], [(a, b, c, d, a, b, c, d)]])


def wrong_nodes(nodes, draws):
    place = draws.below(len(nodes))
    nodes[place] = draws.choose(
        [("nan", 2), (1e300, 2), nodes[place - 1], (1e-300, 2), (3.3, 2.3),
         ("inf", "inf"), ("", ""), (1e6, -1e6)])


def draw(draws):
    """Name of a mesh file, its bytes, what was done to them."""
    name = draws.weighted({"mesh.msh": 6, "mesh.inp ": 2, "mesh.vtk": 2,
                           "mesh.ucd": 1, "mesh.unv": 0.5, "mesh": 0.5,
                           "mesh.exo": 0.2, "mesh.inp": 1, "mesh.xda": 0.3})
    cells, nodes, done = quadrilaterals(), list(NODES), []
    if draws.chance(0.4):
        wrong_cells(cells, draws)
        done.append("wrong cell")
    if draws.chance(0.15):
        wrong_nodes(nodes, draws)
        done.append("wrong node")
    text = FORMATS[name](cells, nodes).encode()
    if not done or draws.chance(0.3):
        mutation = draws.choose([text_mutations.replace_number,
                                 text_mutations.delete_line,
                                 text_mutations.double_line,
                                 text_mutations.truncate,
                                 text_mutations.control_bytes,
                                 text_mutations.replace_number])
        text = mutation(text, draws)
        done.append(mutation.__name__)
    return name.strip(), text, done
