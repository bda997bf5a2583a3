"""Dresses a file of points (x, y, z in four bytes each) by pysplashsurf on one thread, and prints what it took as JSON.

Arguments: file, radius, voxel, times.
"""

import json
import sys
import time

import numpy
import pysplashsurf
from importlib.metadata import version

points = numpy.fromfile(sys.argv[1], dtype="<f4").reshape(-1, 3)
radius, voxel, times = float(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4])
seconds = []
for _ in range(times):
    # lengths but that of the radius are in radii
    clock = time.perf_counter()
    surface = pysplashsurf.reconstruct_surface(
        points, particle_radius=radius, smoothing_length=2.0, cube_size=voxel / radius, multi_threading=False
    )
    seconds.append(time.perf_counter() - clock)
corners = numpy.asarray(surface.mesh.vertices, dtype=float)[numpy.asarray(surface.mesh.triangles)]
volume = abs(numpy.einsum("ij,ij->", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])) / 6)
print(json.dumps({"version": version("pysplashsurf"), "seconds": seconds, "volume": volume}))
