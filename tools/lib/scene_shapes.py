"""Boxes, geodesic spheres and rotations for the project's scenes."""

import math


def box_quads(lower, upper):
    """The six faces of a box, fronts outside."""
    (x0, y0, z0), (x1, y1, z1) = lower, upper
    return [
        [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
        [(x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)],
        [(x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)],
        [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)],
        [(x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0)],
        [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
    ]


def about_y(degrees):
    half = math.radians(degrees) / 2
    return [0.0, round(math.sin(half), 7), 0.0, round(math.cos(half), 7)]


def looking(x_degrees, y_degrees):
    """The rotation of something that looks along -z: first about x (up is positive), then about y (left is)."""
    x, y = math.radians(x_degrees) / 2, math.radians(y_degrees) / 2
    product = [math.sin(x) * math.cos(y), math.cos(x) * math.sin(y), -math.sin(x) * math.sin(y), math.cos(x) * math.cos(y)]
    return [round(c, 7) for c in product]


def icosahedron():
    """Twelve corners, and twenty faces counter-clockwise seen from outside."""
    g = (1 + math.sqrt(5)) / 2
    corners = [(s * a, t * b, 0.0) for a, b in [(1.0, g)] for s in (-1, 1) for t in (-1, 1)]
    corners = [p[-k:] + p[:-k] if k else p for k in range(3) for p in corners]
    near = [[math.dist(p, q) < 2.1 for q in corners] for p in corners]
    faces = [(i, j, k) for i in range(12) for j in range(i) for k in range(j) if near[i][j] and near[j][k] and near[i][k]]
    return corners, [face if volume(*(corners[i] for i in face)) > 0 else face[::-1] for face in faces]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def volume(a, b, c):
    """Positive if a, b, c run counter-clockwise seen from outside a convex body about the origin."""
    return sum(x * y for x, y in zip(cross(a, b), c))


def normalised(p):
    length = math.sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])
    return (p[0] / length, p[1] / length, p[2] / length)


def geodesic(frequency):
    """A unit sphere of 20 frequency^2 triangles, every vertex shared by all of its triangles: no seams."""
    corners, faces = icosahedron()
    points, number = [], {}

    def vertex(face, weights):
        # Corner weights name a vertex wherever it is met; the order is fixed, so that the sums round alike.
        key = tuple(sorted((corner, weight) for corner, weight in zip(face, weights) if weight))
        if key not in number:
            number[key] = len(points)
            points.append(normalised([sum(w * corners[c][axis] for c, w in key) for axis in range(3)]))
        return number[key]

    triangles = []
    for face in faces:
        rows = [[vertex(face, (frequency - i - j, i, j)) for j in range(frequency + 1 - i)] for i in range(frequency + 1)]
        for i in range(frequency):
            for j in range(frequency - i):
                triangles.append((rows[i][j], rows[i + 1][j], rows[i][j + 1]))
                if j + 1 < frequency - i:
                    triangles.append((rows[i + 1][j], rows[i + 1][j + 1], rows[i][j + 1]))
    return points, triangles
