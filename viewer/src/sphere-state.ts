// What the spheres depend on, and the directions of camera, light and surface that follow.
import { radians } from './brdf';
import type { Triple } from './data';

export type Lighting = 'lamp' | 'studio' | 'sky' | 'furnace';
export const LIGHTINGS: Lighting[] = ['lamp', 'studio', 'sky', 'furnace'];

/** All that the pictures depend on; angles in degrees. */
export interface SphereState {
    lighting: Lighting;
    /** Of the lamp, seen from the sphere: to the right of +z, and above it; turns environments. */
    lightAzimuth: number;
    lightElevation: number;
    viewAzimuth: number;
    viewElevation: number;
    /** Stops. */
    exposure: number;
    tone: 'photographic' | 'linear';
    /** Stops at the ends of the difference's colours. */
    range: number;
}

export const DEFAULT_STATE: SphereState = {
    lighting: 'lamp',
    lightAzimuth: -45,
    lightElevation: 45,
    viewAzimuth: 0,
    viewElevation: 0,
    exposure: 0,
    tone: 'photographic',
    range: 1,
};

export const FIELD_OF_VIEW = radians(30);

export function directionOf(azimuth: number, elevation: number): Triple {
    const [a, e] = [radians(azimuth), radians(elevation)];
    return [Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)];
}

const cross = (a: Triple, b: Triple): Triple => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
];

/** Right, up, towards the viewer. */
export function cameraOf(state: SphereState): [Triple, Triple, Triple] {
    const back = directionOf(state.viewAzimuth, state.viewElevation);
    const a = radians(state.viewAzimuth);
    const right: Triple = [Math.cos(a), 0, -Math.sin(a)];
    return [right, cross(back, right), back];
}

const dot = (a: Triple, b: Triple) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

function normalised(v: Triple): Triple {
    const length = Math.hypot(...v);
    return [v[0] / length, v[1] / length, v[2] / length];
}

/** Light and view at a place of the picture (-1 .. 1), in the frame of the surface. */
export function pairAt(
    state: SphereState,
    x: number,
    y: number,
): { incident: Triple; outgoing: Triple } | null {
    const [right, up, back] = cameraOf(state);
    const tangent = Math.tan(FIELD_OF_VIEW / 2);
    const distance = 1 / Math.sin(Math.atan(0.95 * tangent));
    const ray = normalised(
        [0, 1, 2].map((k) => (x * right[k] + y * up[k]) * tangent - back[k]) as Triple,
    );
    const eye = back.map((v) => v * distance) as Triple;
    const half = dot(eye, ray);
    const discriminant = half * half - dot(eye, eye) + 1;
    if (discriminant <= 0 || state.lighting !== 'lamp') {
        return null;
    }
    const t = -half - Math.sqrt(discriminant);
    const normal = normalised(eye.map((v, k) => v + t * ray[k]) as Triple);
    const lamp = directionOf(state.lightAzimuth, state.lightElevation);
    const tangentX = normalised(
        Math.abs(normal[1]) < 0.99 ? cross([0, 1, 0], normal) : cross([1, 0, 0], normal),
    );
    const tangentY = cross(normal, tangentX);
    const local = (v: Triple): Triple => [dot(v, tangentX), dot(v, tangentY), dot(v, normal)];
    const incident = local(lamp);
    const outgoing = local(ray.map((v) => -v) as Triple);
    return incident[2] > 0 && outgoing[2] > 0 ? { incident, outgoing } : null;
}
