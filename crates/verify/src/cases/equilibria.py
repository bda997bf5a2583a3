"""Equilibria by a program of its own, for the rows of `souple verify` that name it.

Hexahedra of eight nodes and eight Gauss points, or 27, under Hooke's, St. Venant-Kirchhoff's and Ogden's laws, and triangles in plane
stress under the first two, by Newton's method; numpy and scipy alone. `python3 equilibria.py` takes a minute and prints the tip of the bent bar (`adaptive_bar`), of the bent strip (`adaptive_strip`), the forces on
the pressed and the pulled pad (`pressed_pad`, `pulled_pad`), the bottom of the hung block (`hung_block`), the waist of the stretched cube and the free face of the hanging one.
"""

import itertools

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

CORNERS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], float)


def gauss(count):
    """Samples of a hexahedron and their weights, `count` along each axis."""
    points, weights = np.polynomial.legendre.leggauss(count)
    along = itertools.product(range(count), repeat=3)
    return zip(*[(points[list(at)], np.prod(weights[list(at)])) for at in along])


def grid(size, cells):
    counts = [c + 1 for c in cells]
    axes = [np.linspace(0, s, n) for s, n in zip(size, counts)]
    points = np.array([[x, y, z] for z in axes[2] for y in axes[1] for x in axes[0]])
    number = lambda i, j, k: i + counts[0] * (j + counts[1] * k)
    hexes = []
    for k, j, i in itertools.product(range(cells[2]), range(cells[1]), range(cells[0])):
        hexes.append([number(i + int(a > 0), j + int(b > 0), k + int(c > 0)) for a, b, c in CORNERS])
    return points, np.array(hexes)


def gradients(points, hexes, count):
    """Gradients of shape functions at the samples (sample, node, axis) and weights; all cells are one box."""
    edge = points[hexes[0, 6]] - points[hexes[0, 0]]
    samples, weights = gauss(count)
    g = np.zeros((len(samples), 8, 3))
    for q, xi in enumerate(samples):
        for a, corner in enumerate(CORNERS):
            factors = (1 + corner * xi) / 2
            for d in range(3):
                g[q, a, d] = corner[d] / 2 * np.prod(np.delete(factors, d)) * 2 / edge[d]
    return g, np.array(weights) * np.prod(edge) / 8


def hooke(F, mu, lam):
    e = (F + np.swapaxes(F, -1, -2)) / 2 - np.eye(3)
    return 2 * mu * e + lam * np.trace(e, axis1=-2, axis2=-1)[..., None, None] * np.eye(3)


def venant(F, mu, lam):
    E = (np.swapaxes(F, -1, -2) @ F - np.eye(3)) / 2
    return F @ (2 * mu * E + lam * np.trace(E, axis1=-2, axis2=-1)[..., None, None] * np.eye(3))


def ogden(F, terms, bulk):
    """P = F S, S = sum over eigenvectors of C of (1/s) dPsi/ds n n^T, with s_bar = J^(-1/3) s."""
    squares, n = np.linalg.eigh(np.swapaxes(F, -1, -2) @ F)
    s = np.sqrt(squares)
    J = np.prod(s, axis=-1)[..., None]
    slopes = bulk * (J - 1) * J / s
    for mu, alpha in terms:
        powers = (J ** (-1 / 3) * s) ** alpha
        slopes = slopes + mu / s * (powers - powers.mean(axis=-1, keepdims=True))
    return F @ (n * (slopes / s)[..., None, :] @ np.swapaxes(n, -1, -2))


def tangent(stress, F):
    """dP/dF by differences of fourth order: the equilibrium does not depend on it, only the way there."""
    out = np.zeros(F.shape + (3, 3))
    h = 1e-4
    for k in range(3):
        for l in range(3):
            D = np.zeros((3, 3))
            D[k, l] = h
            d = 8 * (stress(F + D) - stress(F - D)) - (stress(F + 2 * D) - stress(F - 2 * D))
            out[..., k, l] = d / (12 * h)
    return out


def equilibrium(points, hexes, stress, load, held, values, start, samples=2, tolerance=1e-11):
    g, weight = gradients(points, hexes, samples)
    dofs = (3 * hexes[:, :, None] + np.arange(3)).reshape(len(hexes), 24)
    rows, columns = np.repeat(dofs, 24, axis=1).ravel(), np.tile(dofs, (1, 24)).ravel()
    u = start.copy()
    free = np.setdiff1d(np.arange(u.size), held)
    u[held] = values
    for _ in range(60):
        F = np.einsum("cai,qaj->cqij", u.reshape(-1, 3)[hexes], g) + np.eye(3)
        forces = np.einsum("q,cqij,qaj->cai", weight, stress(F), g, optimize=True)
        internal = np.bincount(dofs.ravel(), forces.ravel(), minlength=u.size)
        residual = load - internal
        if np.abs(residual[free]).max() < tolerance * np.abs(internal).max():
            return u, internal
        blocks = np.einsum("q,cqijkl,qaj,qbl->caibk", weight, tangent(stress, F), g, g, optimize=True)
        K = coo_matrix((blocks.ravel(), (rows, columns)), shape=(u.size, u.size)).tocsr()
        u[free] += spsolve(K[free][:, free], residual[free])
    raise RuntimeError(f"no equilibrium: {np.abs(residual[free]).max()}")


def lame(E, nu):
    return E / 2 / (1 + nu), E * nu / (1 + nu) / (1 - 2 * nu)


def bar():
    points, hexes = grid([1, 0.1, 0.1], [24, 5, 5])
    mu, lam = lame(5e6, 0.3)
    # an eighth of each cell's mass on each of its corners
    mass = np.bincount(hexes.ravel(), minlength=len(points)) * 1000 * 0.01 / len(hexes) / 8
    held = np.flatnonzero(np.repeat(points[:, 0] < 1e-9, 3))
    tip = [i for i, p in enumerate(points) if p[0] > 1 - 1e-9 and {p[1], p[2]} <= {0, 0.1}]
    u = np.zeros(3 * len(points))
    for name, law in [("Hooke", hooke), ("St. Venant-Kirchhoff", venant)]:
        for part in [1.0] if law is hooke else [0.25, 0.5, 0.75, 1.0]:
            load = np.zeros((len(points), 3))
            load[:, 1] = -9.81 * part * mass
            start = np.zeros_like(u) if law is hooke or part == 0.25 else u
            u, _ = equilibrium(points, hexes, lambda F: law(F, mu, lam), load.ravel(), held, 0.0, start)
        print(f"tip of the bar, {name}: {u.reshape(-1, 3)[tip, 1].mean():.15f} m")


def pad():
    points, hexes = grid([1, 0.6, 1], [10, 6, 10])
    terms, bulk = [(9615.4, 4), (-9615.4, -4)], 83333
    x, y, z = points.T
    inside = (abs(x - 0.5) < 0.1501) & (abs(z - 0.5) < 0.1501) & (y > 0.59)
    floor = y < 1e-9
    held = np.concatenate([np.flatnonzero(np.repeat(floor, 3)), np.flatnonzero(np.repeat(inside, 3))])
    pressed = 3 * np.flatnonzero(inside) + 1
    u = np.zeros(3 * len(points))
    for depth in np.linspace(0.02, 0.12, 6):
        values = np.zeros(held.size)
        values[np.isin(held, pressed)] = -depth
        u, internal = equilibrium(points, hexes, lambda F: ogden(F, terms, bulk), np.zeros_like(u), held, values, u)
    print(f"force on the press, Ogden: {internal[pressed].sum():.9f} N")
    mu, lam = lame(1e5, 0.3)
    u, internal = equilibrium(points, hexes, lambda F: hooke(F, mu, lam), np.zeros_like(u), held, values, u)
    print(f"force on the press, Hooke: {internal[pressed].sum():.9f} N")
    u = np.zeros(3 * len(points))
    for height in np.linspace(0.03, 0.12, 4):
        values[np.isin(held, pressed)] = height
        law = lambda F: venant(F, mu, lam)
        u, internal = equilibrium(points, hexes, law, np.zeros_like(u), held, values, u, samples=3)
    print(f"force on the pull, St. Venant-Kirchhoff: {internal[pressed].sum():.9f} N")


def hung():
    points, hexes = grid([1, 0.6, 1], [10, 6, 10])
    mu, lam = lame(6e4, 0.3)
    x, y, z = points.T
    plate = (abs(x - 0.5) < 0.1501) & (abs(z - 0.5) < 0.1501) & (y > 0.59)
    held, bottom = np.flatnonzero(np.repeat(plate, 3)), np.flatnonzero(y < 1e-9)
    mass = np.bincount(hexes.ravel(), minlength=len(points)) * 1000 * 0.6 / len(hexes) / 8
    for name, law in [("Hooke", hooke), ("St. Venant-Kirchhoff", venant)]:
        u = np.zeros(3 * len(points))
        for part in [1.0] if law is hooke else np.linspace(0.125, 1, 8):
            load = np.zeros(points.shape)
            load[:, 1] = -9.81 * part * mass
            u, _ = equilibrium(points, hexes, lambda F: law(F, mu, lam), load.ravel(), held, 0.0, u, samples=3)
        print(f"bottom of the hung block, {name}: {u.reshape(-1, 3)[bottom, 1].mean():.12f} m")


def cube():
    points, hexes = grid([1, 1, 1], [10, 10, 10])
    mu, lam = lame(1e5, 0.3)
    law = lambda F: venant(F, mu, lam)
    near, far = np.flatnonzero(points[:, 0] < 1e-9), np.flatnonzero(points[:, 0] > 1 - 1e-9)
    fixed = (3 * near[:, None] + np.arange(3)).ravel()
    held = np.concatenate([fixed, (3 * far[:, None] + np.arange(3)).ravel()])
    values = np.zeros(held.size)
    values[np.isin(held, 3 * far)] = 0.05
    u, _ = equilibrium(points, hexes, law, np.zeros(points.size), held, values, np.zeros(points.size))
    waist = np.argmin(np.linalg.norm(points - [0.5, 1, 0.5], axis=1))
    print(f"waist of the stretched cube: {u[3 * waist + 1]:.12f} m")
    mass = np.bincount(hexes.ravel(), minlength=len(points)) * 1000 / len(hexes) / 8
    u = np.zeros(points.size)
    for part in [0.25, 0.5, 0.75, 1.0]:
        load = np.zeros(points.shape)
        load[:, 1] = -9.81 * part * mass
        u, _ = equilibrium(points, hexes, law, load.ravel(), fixed, 0.0, u)
    along, down = u[3 * far].mean(), u[3 * far + 1].mean()
    print(f"free face of the hanging cube: {along:.12f} m along it, {down:.12f} m upward")


def strip():
    """Triangles in plane stress, where both laws are themselves with lambda* = 2 lambda mu / (lambda + 2 mu), for no stress across says what the
    strain across is. One law everywhere, then Hooke's where triangles have not been over a threshold at an equilibrium before, 20 in turn."""
    along, across, thickness = 48, 6, 0.1
    points = np.array([[i / along, 0.1 * j / across] for j in range(across + 1) for i in range(along + 1)])
    number = lambda i, j: i + (along + 1) * j
    triangles = []
    for j, i in itertools.product(range(across), range(along)):
        a, b, c, d = number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)
        triangles += [[a, b, c], [a, c, d]] if (i + j) % 2 == 0 else [[a, b, d], [b, c, d]]
    triangles = np.array(triangles)
    mu, lam = lame(5e6, 0.3)
    lam = 2 * lam * mu / (lam + 2 * mu)
    edges = np.swapaxes(points[triangles[:, 1:]] - points[triangles[:, :1]], -1, -2)
    inverse, area = np.linalg.inv(edges), np.linalg.det(edges) / 2
    g = np.einsum("ak,ckj->caj", np.array([[-1, -1], [1, 0], [0, 1]]), inverse)
    load = np.zeros((len(points), 2))
    load[:, 1] = -9.81 * np.bincount(triangles.ravel(), np.repeat(1000 * thickness * area / 3, 3))
    dofs = (2 * triangles[:, :, None] + np.arange(2)).reshape(-1, 6)
    rows, columns = np.repeat(dofs, 6, axis=1).ravel(), np.tile(dofs, (1, 6)).ravel()
    free = np.flatnonzero(np.repeat(points[:, 0] > 1e-9, 2))
    tip = number(along, across // 2)
    one = np.eye(2)

    def stress(is_second, F):
        H = F - one
        E = (H + np.swapaxes(H, -1, -2) + is_second[:, None, None] * (np.swapaxes(H, -1, -2) @ H)) / 2
        S = 2 * mu * E + lam * np.trace(E, axis1=-2, axis2=-1)[..., None, None] * one
        return S + is_second[:, None, None] * (H @ S)

    def solved(is_second, u):
        for _ in range(60):
            F = np.einsum("cai,caj->cij", u.reshape(-1, 2)[triangles], g) + one
            forces = np.einsum("c,cij,caj->cai", thickness * area, stress(is_second, F), g)
            internal = np.bincount(dofs.ravel(), forces.ravel(), minlength=u.size)
            residual = (load.ravel() - internal)[free]
            if np.abs(residual).max() < 1e-12 * np.abs(internal).max():
                return u, F, forces
            A = np.zeros((len(F), 2, 2, 2, 2))
            for k, l in itertools.product(range(2), range(2)):
                D = np.zeros((2, 2))
                D[k, l] = h = 1e-4
                at = lambda n: stress(is_second, F + n * D)
                A[..., k, l] = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h)
            blocks = np.einsum("c,cijkl,caj,cbl->caibk", thickness * area, A, g, g)
            K = coo_matrix((blocks.ravel(), (rows, columns)), shape=(u.size, u.size)).tocsr()
            u = u.copy()
            u[free] += spsolve(K[free][:, free], residual)
        raise RuntimeError("no equilibrium")

    def sides(x):
        corners = x[triangles]
        return np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)

    def factor(x):
        a, b, c = sides(x).T
        s = (a + b + c) / 2
        return a * b * c / 8 / ((s - a) * (s - b) * (s - c))

    def length(x, F, forces):
        return np.abs(sides(x) / sides(points) - 1).max(axis=1)

    def of_area(x, F, forces):
        return np.abs(np.linalg.det(F) - 1)

    def shape(x, F, forces):
        return np.maximum(factor(x) / factor(points) - 1, 0)

    def force(x, F, forces):
        samples = np.array([[4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6
        field = np.linalg.norm(np.einsum("qa,cai->cqi", samples, forces), axis=2)
        return field.mean(axis=1) / np.linalg.det(F)

    none, all_of_them = np.zeros(len(triangles)), np.ones(len(triangles))
    for name, laws in [("Hooke", none), ("St. Venant-Kirchhoff", all_of_them)]:
        u, _, _ = solved(laws, np.zeros(2 * len(points)))
        print(f"tip of the strip, {name}: {u[2 * tip + 1]:.15f} m")
    for criterion, threshold in [(length, 0.015), (of_area, 0.015), (shape, 0.01), (force, 20.0)]:
        laws, u = none, np.zeros(2 * len(points))
        for step in range(20):
            u, F, forces = solved(laws, u)
            over = criterion(points + u.reshape(-1, 2), F, forces) / threshold
            if step < 19:
                laws = np.maximum(laws, over > 1)
        near = np.abs(over - 1).min()
        share = np.average(laws, weights=area)
        name = f"{criterion.__name__} {threshold}"
        print(f"tip of the strip, {name}: {u[2 * tip + 1]:.15f} m, share {share:.6f}, nearest to the threshold {near:.1e}")


bar()
strip()
pad()
hung()
cube()
