// The eye: where the picture is seen from, and what lies under a place of the screen.

import { Box3, Frustum, Matrix4, PerspectiveCamera, Plane, Raycaster, Sphere, Vector2, Vector3 } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

/** How far a key turns the view [rad], and the share by which it comes nearer or goes away. */
const KEY_TURN = 0.08;
const KEY_SHARE = 0.08;
/** The eye stays as far from where it would look straight down or up [rad]. */
const POLE = 0.1;
/** What is looked at could be as many times as high and as wide: it has room to move. */
const MARGIN = 1.2;
/** The axes and the scale at the foot of the picture take so much of its height [px]. */
const FOOT = 84;
/** What stands at the foot takes no more of the height of the picture. */
const FOOT_SHARE = 0.4;
/** What is nearer than this part of the distance, or farther away than so many of it, is not drawn. */
const NEAR = 1 / 200;
const FAR = 40;

export class Eye {
  readonly camera = new PerspectiveCamera(32, 1, 0.01, 100);
  controls: OrbitControls;
  /** What is up in the picture, and the way that it looks. */
  readonly up = new Vector3(0, 1, 0);
  readonly direction = new Vector3(-0.5, -0.45, -1);
  private readonly ray = new Raycaster();
  /** Of the picture [px]. */
  private size = { width: 1, height: 1 };
  /** Height of what stands at its foot [px]. */
  private foot = 0;
  /** What the view was fitted to last, and where the eye went for it. */
  private fitted: { bounds: Box3; turning: Box3; position: Vector3 } | null = null;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.controls = this.newControls();
  }

  /** Those that were there know another direction as up, and glide on. */
  private newControls(): OrbitControls {
    const controls = new OrbitControls(this.camera, this.canvas);
    controls.enableDamping = true;
    controls.dampingFactor = 0.12;
    return controls;
  }

  /**
   * Looks at all of a box, from where the scene wants to be seen; while what is in another box turns about the middle of that one, as
   * it stands now, it stays in the picture.
   */
  fit(bounds: Box3, turning: Box3): void {
    const centre = bounds.getCenter(new Vector3());
    const { enabled } = this.controls;
    this.controls.dispose();
    this.camera.up.copy(this.up);
    this.controls = this.newControls();
    this.controls.enabled = enabled;
    this.camera.position.copy(centre).addScaledVector(this.direction, -1);
    this.camera.lookAt(centre);
    const radius = 0.5 * turning.getSize(new Vector3()).length();
    const beside = turning.getCenter(new Vector3());
    const points = corners(bounds);
    const distance = Math.max(1e-6, ...points.map((corner) => this.needed(corner, centre, 0, MARGIN)), this.needed(beside, centre, radius, 1));
    this.camera.position.copy(centre).addScaledVector(this.direction, -distance);
    this.reach(distance);
    this.controls.target.copy(centre);
    this.controls.update();
    this.fitted = { bounds: bounds.clone(), turning: turning.clone(), position: this.camera.position.clone() };
  }

  /** Goes on as it was moved last, and draws what is about as far as what it looks at; once for each picture. */
  update(): void {
    this.controls.update();
    const distance = this.distance;
    if (Math.abs(this.camera.near - NEAR * distance) > 1e-6 * this.camera.near) this.reach(distance);
  }

  private get distance(): number {
    return this.camera.position.distanceTo(this.controls.target);
  }

  /** Goes so many times as far from what it looks at. */
  goAway(factor: number): void {
    const { target } = this.controls;
    this.camera.position.sub(target).multiplyScalar(factor).add(target);
  }

  /** From how far a ball about a point is in the picture, seen as now with a target in its middle, were it farther from that by a factor. */
  private needed(point: Vector3, target: Vector3, radius: number, factor: number): number {
    this.camera.updateMatrixWorld();
    const [right, up, back] = [0, 1, 2].map((axis) => new Vector3().setFromMatrixColumn(this.camera.matrixWorld, axis));
    const offset = point.clone().sub(target);
    const from = (slope: number, aside: number) => (factor * Math.abs(aside) + radius * Math.hypot(1, slope)) / slope;
    const slopes = this.slopes();
    const aside = from(slopes.aside, offset.dot(right!));
    const above = from(slopes.above, offset.dot(up!));
    return offset.dot(back!) + Math.max(aside, above);
  }

  /** Of the rays to the sides of the picture, and to its upper border from the middle above its foot. */
  private slopes(): { aside: number; above: number } {
    const { width, height } = this.size;
    const slope = Math.tan(0.5 * this.camera.fov * (Math.PI / 180));
    return { aside: (slope * width) / height, above: (slope * (height - this.foot)) / height };
  }

  /** Draws what is about as far. */
  private reach(distance: number): void {
    this.camera.near = NEAR * distance;
    this.camera.far = FAR * distance;
    this.camera.updateProjectionMatrix();
  }

  /** Goes a way without turning. */
  shift(way: Vector3): void {
    this.camera.position.add(way);
    this.controls.target.add(way);
  }

  /** Looks at a point from where it looked at another one. */
  lookAt(point: Vector3): void {
    this.shift(point.clone().sub(this.controls.target));
  }

  /** Turns about what is looked at, to the right and up, or comes nearer. */
  turn([right, up, away]: [number, number, number]): void {
    const { target } = this.controls;
    const offset = this.camera.position.clone().sub(target);
    const across = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    offset.applyAxisAngle(this.camera.up, -KEY_TURN * right);
    // the eye does not go over the top; a view that is already beyond comes back
    const polar = offset.angleTo(this.camera.up);
    const wanted = Math.min(Math.max(polar + KEY_TURN * up, POLE), Math.PI - POLE);
    offset.applyAxisAngle(across.applyAxisAngle(this.camera.up, -KEY_TURN * right), wanted - polar);
    offset.multiplyScalar(1 + KEY_SHARE * away);
    this.camera.position.copy(target).add(offset);
    this.camera.lookAt(target);
  }

  /** Towards the eye, unit. */
  get towards(): Vector3 {
    return this.camera.getWorldDirection(new Vector3()).negate();
  }

  /** Whether any part of a box may be in the picture. */
  sees(bounds: Box3): boolean {
    return this.frustum().intersectsBox(bounds);
  }

  /** Whether any of some balls about places may be in the picture. */
  seesAny(places: ArrayLike<number>, radius: number): boolean {
    const frustum = this.frustum();
    const ball = new Sphere(new Vector3(), radius);
    for (let i = 0; i < places.length; i += 3) {
      ball.center.set(places[i]!, places[i + 1]!, places[i + 2]!);
      if (frustum.intersectsSphere(ball)) return true;
    }
    return false;
  }

  /** What is in the picture. */
  private frustum(): Frustum {
    this.camera.updateMatrixWorld();
    const seen = new Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
    return new Frustum().setFromProjectionMatrix(seen);
  }

  /** The ray to a place of the screen. */
  aimAt({ clientX, clientY }: { clientX: number; clientY: number }): Raycaster {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = new Vector2(((clientX - left) / width) * 2 - 1, 1 - ((clientY - top) / height) * 2);
    this.ray.setFromCamera(at, this.camera);
    return this.ray;
  }

  /** Where the ray to a place of the screen meets the plane through a point, across the view. */
  onPlane(event: { clientX: number; clientY: number }, point: Vector3): Vector3 | null {
    const plane = new Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new Vector3()), point);
    return this.aimAt(event).ray.intersectPlane(plane, new Vector3());
  }

  /** Metres that a pixel is wide where the eye looks. */
  metresPerPixel(height: number): number {
    return (2 * this.distance * Math.tan(0.5 * this.camera.fov * (Math.PI / 180))) / Math.max(height, 1);
  }

  /**
   * What is looked at stands in the middle above the foot of the picture, where a legend of a height may stand [px], however the view
   * turns: the lens is shifted. A view that nobody has moved is fitted anew, of another the narrower side shows what it has shown.
   */
  resize(width: number, height: number, legend: number): void {
    const narrower = () => Math.min(...Object.values(this.slopes()));
    const before = narrower();
    const isOther = width !== this.size.width || height !== this.size.height;
    this.size = { width, height };
    this.foot = Math.min(Math.max(FOOT, legend), FOOT_SHARE * height);
    this.camera.setViewOffset(width, height, 0, 0.5 * this.foot, width, height);
    // the controls round as they hold still
    const { fitted } = this;
    const isMoved = fitted === null || fitted.position.distanceTo(this.camera.position) > 1e-6 * this.distance;
    if (!isMoved) this.fit(fitted.bounds, fitted.turning);
    else if (isOther) this.goAway(before / narrower());
  }
}

export function corners({ min, max }: Box3): Vector3[] {
  const ends = [min, max];
  return [0, 1, 2, 3, 4, 5, 6, 7].map((i) => new Vector3(ends[i & 1]!.x, ends[(i >> 1) & 1]!.y, ends[i >> 2]!.z));
}
