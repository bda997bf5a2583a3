// What bodies touch: planes as floors and walls, shapes where they are led.

import {
  BackSide,
  Box3,
  BufferAttribute,
  BufferGeometry,
  FrontSide,
  Group,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  PlaneGeometry,
  Quaternion,
  ShadowMaterial,
  Vector3,
} from "three";
import type { Material } from "three";
import type { ObstacleInfo, Surface } from "../protocol";
import { corners } from "./eye";
import { floor } from "./floor";
import { OBSTACLE_COLOUR } from "./palette";

/** Cosine of 45 degrees: steeper planes are walls. */
const LEVEL = 0.7;

export class Obstacles {
  readonly group = new Group();
  private readonly shapes: Mesh[] = [];

  constructor(obstacles: ObstacleInfo[], surfaces: Surface[], up: Vector3, bounds: Box3) {
    const size = bounds.getSize(new Vector3()).length();
    const centre = bounds.getCenter(new Vector3());
    let hasFloor = false;
    let next = 0;
    for (const obstacle of obstacles) {
      if (obstacle.form === "plane") {
        const normal = new Vector3(...obstacle.normal);
        const level = normal.dot(up) > LEVEL;
        hasFloor ||= level;
        this.group.add(plane(new Vector3(...obstacle.point), normal, centre, size, level));
      } else {
        const surface = surfaces[next++];
        if (surface) this.shapes.push(shape(surface, obstacle.is_around));
      }
    }
    this.shapes.forEach((shape) => this.group.add(shape));
    if (!hasFloor) this.group.add(shade(up, bounds, size));
  }

  move(poses: Float32Array[]): void {
    poses.forEach((pose, index) => {
      const mesh = this.shapes[index];
      if (!mesh) return;
      const p = pose as unknown as number[];
      mesh.matrix.set(p[0]!, p[3]!, p[6]!, p[9]!, p[1]!, p[4]!, p[7]!, p[10]!, p[2]!, p[5]!, p[8]!, p[11]!, 0, 0, 0, 1);
      mesh.matrixWorldNeedsUpdate = true;
    });
  }

  /** Of each shape as it stands. */
  get bounds(): Box3[] {
    return this.shapes.map(({ geometry, matrix }) => {
      if (!geometry.boundingBox) geometry.computeBoundingBox();
      return new Box3().copy(geometry.boundingBox!).applyMatrix4(matrix);
    });
  }

  dispose(): void {
    this.group.traverse((thing) => {
      if (thing instanceof Mesh) {
        thing.geometry.dispose();
        (thing.material as Material).dispose();
      }
    });
  }
}

function facing(normal: Vector3): Quaternion {
  return new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), normal);
}

function plane(point: Vector3, normal: Vector3, centre: Vector3, size: number, isLevel: boolean): Mesh {
  const mesh = isLevel ? floor(8 * size, size) : wall(1.2 * size);
  const foot = centre.clone().addScaledVector(normal, -normal.dot(centre.clone().sub(point)));
  mesh.applyMatrix4(new Matrix4().compose(foot, facing(normal), new Vector3(1, 1, 1)));
  return mesh;
}

function wall(side: number): Mesh {
  const material = new MeshStandardMaterial({ color: 0xb9bfca, roughness: 0.9, transparent: true, opacity: 0.55 });
  const mesh = new Mesh(new PlaneGeometry(side, side), material);
  mesh.receiveShadow = true;
  return mesh;
}

/** Where nothing is below, a shadow on nothing tells how high things hang. */
function shade(up: Vector3, bounds: Box3, size: number): Mesh {
  const mesh = new Mesh(new PlaneGeometry(8 * size, 8 * size), new ShadowMaterial({ opacity: 0.16 }));
  const lowest = Math.min(...corners(bounds).map((corner) => corner.dot(up)));
  const centre = bounds.getCenter(new Vector3());
  const foot = centre.addScaledVector(up, lowest - 0.22 * size - centre.dot(up));
  mesh.applyMatrix4(new Matrix4().compose(foot, facing(up), new Vector3(1, 1, 1)));
  mesh.receiveShadow = true;
  return mesh;
}

function shape(surface: Surface, isAround: boolean): Mesh {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(surface.points, 3));
  geometry.setIndex(new BufferAttribute(surface.triangles, 1));
  geometry.computeVertexNormals();
  const material = new MeshStandardMaterial({
    color: OBSTACLE_COLOUR,
    roughness: 0.35,
    metalness: 0.35,
    // of a thing that bodies are inside of, the far side is seen
    side: isAround ? BackSide : FrontSide,
  });
  const mesh = new Mesh(geometry, material);
  mesh.matrixAutoUpdate = false;
  mesh.frustumCulled = false;
  mesh.castShadow = !isAround;
  mesh.receiveShadow = true;
  return mesh;
}
