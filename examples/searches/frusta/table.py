"""The largest radius of the outline at the borders of equal rows: four numbers a row, radii at its lower and upper end."""
import json
import sys

solid = json.load(sys.stdin)
rows = solid["rows"]


def radius(z):
    """Where the outline crosses a height, farthest from the axis."""
    found = 0.0
    for chain in solid["chains"]:
        for (r0, z0), (r1, z1) in zip(chain, chain[1:]):
            if min(z0, z1) <= z <= max(z0, z1):
                part = (z - z0) / (z1 - z0) if z0 != z1 else 0.0
                found = max(found, r0 + part * (r1 - r0), r1 if z0 == z1 else 0.0)
    return found


borders = [radius(i / rows) for i in range(rows + 1)]
for low, high in zip(borders, borders[1:]):
    print(low, high, 0, 0)
