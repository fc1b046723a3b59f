#!/usr/bin/env python3
"""Makes host/scene/albedo_tables.cpp: the directional albedos of microfacet lobes (host/scene/README.md, "Surfaces" and
"Albedo tables"), and says how well interpolation in them keeps a white furnace white. Needs numpy; takes a minute on
two cores. --check measures the committed tables without writing.
"""
import argparse
import concurrent.futures
import itertools
import math
import pathlib
import re

import numpy

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "host" / "scene"
HEADER, TARGET = FOLDER / "albedo_tables.h", FOLDER / "albedo_tables.cpp"
SMALLEST = 1e-3  # stands for 0 in the square roots of alpha and the cosine: what follows depends on their ratio there

# A Fibonacci lattice (Sloan and Joe 1994, 4.2): its points are a row of their own in either coordinate, so that the
# kinks of the integrands (total reflection, the horizon) cost less than on a grid.
POINTS, GENERATOR = 28657, 10946


def lattice():
    """Caps' parameters v with weights, and the cosines of their azimuths: half the circle stands for both halves."""
    i = numpy.arange(POINTS)
    s = (i + 0.5) / POINTS
    weights = numpy.sin(numpy.pi * s)  # of v = (1 - cos(pi s))/2, which softens the square roots at both ends
    azimuth = numpy.pi * (i * GENERATOR % POINTS + 0.5) / POINTS
    return (1 - numpy.cos(numpy.pi * s)) / 2, weights / weights.sum(), numpy.cos(azimuth)


PARTS = list(zip(*(numpy.array_split(numbers, 4) for numbers in lattice())))  # that stay in a processor's cache


def stretched(mu, alpha):
    """s of the README: the length of a direction's stretched counterpart."""
    return numpy.sqrt(alpha * alpha * (1 - mu * mu) + mu * mu)


def visible_normals(mu, alpha, v, cosines):
    """Cosines of visible normals to wo, and to the surface (Dupuy and Benyoub 2023); wo lies in the plane y = 0."""
    s = stretched(mu, alpha)
    sine = math.sqrt(1 - mu * mu)
    wx, wz = alpha * sine / s, mu / s
    z = (1 - v) * (1 + wz) - wz
    radius = numpy.sqrt(numpy.maximum(1 - z * z, 0))
    x = radius * cosines
    hx, hy_squared, hz = alpha * (x + wx), alpha * alpha * (radius * radius - x * x), z + wz
    length = numpy.sqrt(hx * hx + hy_squared + hz * hz)
    return (sine * hx + mu * hz) / length, hz / length


def masking(mu, mu_i, alpha):
    """G2/G1: the weight of a direction found by a visible normal."""
    mu_i = numpy.abs(mu_i)
    s, s_i = stretched(mu, alpha), stretched(mu_i, alpha)
    return mu_i * (mu + s) / numpy.maximum(mu * s_i + mu_i * s, 1e-300)


def reflection(mu, alpha):
    """E1, and R times E1."""
    albedo = weighted = 0
    for v, weights, cosines in PARTS:
        cosine, hz = visible_normals(mu, alpha, v, cosines)
        mu_i = 2 * cosine * hz - mu
        reflected = weights * numpy.where(mu_i > 0, masking(mu, mu_i, alpha), 0)
        albedo += reflected.sum()
        weighted += (reflected * (1 - cosine) ** 5).sum()
    return albedo, weighted


def fresnel(cosine, eta):
    """Of a dielectric, and the cosine beyond; 1 where there is none."""
    squared = 1 - (1 - cosine * cosine) / (eta * eta)
    beyond = numpy.sqrt(numpy.maximum(squared, 0))
    s = (cosine - eta * beyond) / (cosine + eta * beyond)
    p = (eta * cosine - beyond) / (eta * cosine + beyond)
    return numpy.where(squared > 0, (s * s + p * p) / 2, 1), beyond


def glass(mu, alpha, eta):
    """Reflection and transmission together; eta = (index beyond)/(index on the side of wo)."""
    if eta == 1:  # straight on, whatever the normal: the weight of wi = -wo
        return masking(mu, mu, alpha)
    albedo = 0
    for v, weights, cosines in PARTS:
        cosine, hz = visible_normals(mu, alpha, v, cosines)
        mu_r = 2 * cosine * hz - mu
        reflected = numpy.where(mu_r > 0, masking(mu, mu_r, alpha), 0)
        f, beyond = fresnel(cosine, eta)
        mu_t = (cosine / eta - beyond) * hz - mu / eta
        transmitted = numpy.where(mu_t < 0, masking(mu, mu_t, alpha), 0)
        albedo += (weights * (f * reflected + (1 - f) * transmitted)).sum()
    return albedo


def side_eta(ior, side):
    return ior if side == 0 else 1 / ior


# --- nodes ---

def sizes():
    text = HEADER.read_text()
    return {name: int(number) for name, number in re.findall(r"k(\w+) = (\d+);", text)}


def node_alpha(y):
    return max(y, SMALLEST) ** 2


def node_mu(x, y):
    """Inverse of x = m (1 + y)/(m + y), m the root of the cosine and y that of alpha."""
    y = max(y, SMALLEST)
    return min(max(x * y / (1 + y - x), 1e-5), 1) ** 2


def nodes(count):
    return [i / (count - 1) for i in range(count)]


def reflection_row(y, angles):
    return [reflection(node_mu(x, y), node_alpha(y))[0] for x in nodes(angles)]


def fresnel_row(y, angles):
    def average(root):
        albedo, weighted = reflection(max(root, 1e-5) ** 2, node_alpha(y))
        return weighted / albedo
    return [average(root) for root in nodes(angles)]


def glass_row(task):
    side, third, y, angles = task
    alpha, root = node_alpha(y), third * third
    if root == 1:  # infinitely dense: everything is reflected
        return reflection_row(y, angles)
    eta = side_eta((1 + root) / (1 - root), side)
    return [glass(node_mu(x, y), alpha, eta) for x in nodes(angles)]


def make_tables(n, pool):
    roughness = nodes(n["AlbedoRoughnesses"])
    tasks = list(itertools.product((0, 1), nodes(n["GlassIndices"]), nodes(n["GlassRoughnesses"]), [n["GlassAngles"]]))
    shape = (2, n["GlassIndices"], n["GlassRoughnesses"], n["GlassAngles"])
    return {
        "reflection": numpy.array(list(pool.map(reflection_row, roughness, [n["AlbedoAngles"]] * len(roughness)))),
        "fresnel": numpy.array(list(pool.map(fresnel_row, roughness, [n["FresnelAngles"]] * len(roughness)))),
        "glass": numpy.array(list(pool.map(glass_row, tasks, chunksize=16))).reshape(shape),
    }


# --- what interpolation makes of them ---

def interpolate(table, *coordinates):
    """Multilinear; the last axis first."""
    for coordinate in coordinates:
        position = coordinate * (table.shape[-1] - 1)
        i = min(int(position), table.shape[-1] - 2)
        table = table[..., i] * (i + 1 - position) + table[..., i + 1] * (position - i)
    return table


def coordinates(mu, alpha):
    m, y = math.sqrt(mu), math.sqrt(alpha)
    return m * (1 + y) / (m + y), y


def samples(count):
    """Pairs of cosine and alpha in [0.001, 1]: even ones logarithmic in the cosine, odd ones linear."""
    random = numpy.random.default_rng(1).random((count, 2))
    for i, (a, b) in enumerate(random):
        yield (10 ** (3 * a - 3) if i % 2 == 0 else 0.001 + 0.999 * a), 10 ** (3 * b - 3)


def report(name, errors):
    error, mu, alpha = max(errors)
    print(f"{name:28} {100 * error:.2f} % at most, at cosine {mu:.4f}, alpha {alpha:.4f}")


def measure(tables):
    """Largest gain or loss of a white furnace by interpolation, in per cent."""
    errors, average_errors = [], []
    for mu, alpha in samples(1000):
        albedo, weighted = reflection(mu, alpha)
        x, y = coordinates(mu, alpha)
        errors.append((abs(albedo / interpolate(tables["reflection"], x, y) - 1), mu, alpha))
        average = interpolate(tables["fresnel"], math.sqrt(mu), y)
        average_errors.append((abs(average - weighted / albedo), mu, alpha))
    report("reflection", errors)
    report("average of (1 - cosine)^5", average_errors)
    for side, ior in itertools.product((0, 1), (1.02, 1.1, 1.33, 1.5, 2.4)):
        third = math.sqrt((ior - 1) / (ior + 1))
        errors = []
        for mu, alpha in samples(600):
            found = interpolate(tables["glass"][side], *coordinates(mu, alpha), third)
            errors.append((abs(glass(mu, alpha, side_eta(ior, side)) / found - 1), mu, alpha))
        report(f"glass, {('outside', 'inside')[side]}, ior {ior}", errors)


# --- the file ---

TITLE = """// Written by tools/make_albedo_tables.py: change it there.
#include "scene/albedo_tables.h"

#include <array>

namespace isolux {
namespace {

// clang-format off
"""
ACCESS = """// clang-format on

} // namespace

std::span<const float> reflectionAlbedo() { return kReflection; }

std::span<const float> fresnelAlbedo() { return kFresnel; }

std::span<const float> glassAlbedo() { return kGlass; }

} // namespace isolux
"""


def literals(table):
    words = [f"{value:.5f}f,".replace("0.", ".", 1) for value in table.reshape(-1)]
    return "\n".join("".join(words[i:i + 15]) for i in range(0, len(words), 15))


def source(tables):
    def array(name, size, table):
        return f"constexpr std::array<float, {size}> {name}{{\n{literals(table)}\n}};\n"
    return (TITLE
            + array("kReflection", "kAlbedoAngles * kAlbedoRoughnesses", tables["reflection"])
            + array("kFresnel", "kFresnelAngles * kAlbedoRoughnesses", tables["fresnel"])
            + array("kGlass", "2 * kGlassAngles * kGlassRoughnesses * kGlassIndices", tables["glass"])
            + ACCESS)


def committed(n):
    numbers = [numpy.array(block.split("f,")[:-1], dtype=float)
               for block in re.findall(r"\{\n([.\d,f\n]+)\};", TARGET.read_text())]
    return {
        "reflection": numbers[0].reshape(n["AlbedoRoughnesses"], n["AlbedoAngles"]),
        "fresnel": numbers[1].reshape(n["AlbedoRoughnesses"], n["FresnelAngles"]),
        "glass": numbers[2].reshape(2, n["GlassIndices"], n["GlassRoughnesses"], n["GlassAngles"]),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="measure the committed tables, write nothing")
    if not parser.parse_args().check:
        with concurrent.futures.ProcessPoolExecutor() as pool:
            TARGET.write_text(source(make_tables(sizes(), pool)))
    measure(committed(sizes()))


if __name__ == "__main__":
    main()
