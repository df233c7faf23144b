// Directions, half/difference coordinates and look-ups: the same conventions as the C library's
// include/gonio/direction.h and material.h.
import type { Angles, Triple } from './data';

export const THETA_H_BINS = 90;
export const THETA_D_BINS = 90;
export const PHI_D_BINS = 180;
export const CELLS = THETA_H_BINS * THETA_D_BINS;
export const BINS = CELLS * PHI_D_BINS;
export const CHANNELS = 3;
/** s of g = ln(1 + rho/s), 1/sr. */
export const LOG_SCALE: Triple = [1 / 1500, 1.15 / 1500, 1.66 / 1500];

const QUARTER = Math.PI / 2;
const DEGREE = Math.PI / 180;

export const degrees = (radians: number) => radians / DEGREE;
export const radians = (value: number) => value * DEGREE;

export interface HalfDifference {
    thetaH: number;
    thetaD: number;
    /** Any; phi_d and phi_d + pi are the same sample. */
    phiD: number;
}

export function vectorOf([theta, phi]: Angles): Triple {
    return [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];
}

const dot = (a: Triple, b: Triple) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Of unit vectors towards the light and the viewer; +z is the normal. */
export function halfDifference(incident: Triple, outgoing: Triple): HalfDifference {
    const sum: Triple = [
        incident[0] + outgoing[0],
        incident[1] + outgoing[1],
        incident[2] + outgoing[2],
    ];
    const length = Math.hypot(...sum);
    const h: Triple = length > 0 ? [sum[0] / length, sum[1] / length, sum[2] / length] : [0, 0, 1];
    const sine = Math.hypot(h[0], h[1]);
    const [cosPhi, sinPhi] = sine > 0 ? [h[0] / sine, h[1] / sine] : [1, 0];
    // d in the frame of the half vector.
    const x = dot(incident, [h[2] * cosPhi, h[2] * sinPhi, -sine]);
    const y = dot(incident, [-sinPhi, cosPhi, 0]);
    return {
        thetaH: Math.atan2(sine, h[2]),
        thetaD: Math.min(Math.atan2(Math.hypot(x, y), dot(incident, h)), QUARTER),
        phiD: Math.atan2(y, x),
    };
}

/** Cosines of the incident and the outgoing polar angle. */
export function cosines(c: HalfDifference): [number, number] {
    const a = Math.cos(c.thetaH) * Math.cos(c.thetaD);
    const b = Math.sin(c.thetaH) * Math.sin(c.thetaD) * Math.cos(c.phiD);
    return [a - b, a + b];
}

export function binCentre(thetaH: number, thetaD: number, phiD: number): HalfDifference {
    return {
        thetaH: ((thetaH + 0.5) / THETA_H_BINS) ** 2 * QUARTER,
        thetaD: ((thetaD + 0.5) / THETA_D_BINS) * QUARTER,
        phiD: ((phiD + 0.5) / PHI_D_BINS) * Math.PI,
    };
}

/** Neighbouring bins and the weight of the upper one. */
export type Neighbours = [number, number, number];

/** Constant beyond the outer centres. */
function clamped(position: number, bins: number): Neighbours {
    const p = Math.min(Math.max(position - 0.5, 0), bins - 1);
    const low = Math.floor(p);
    return [low, Math.min(low + 1, bins - 1), p - low];
}

export function periodic(position: number, bins: number): Neighbours {
    const p = position - 0.5;
    const low = Math.floor(p);
    const wrap = (k: number) => ((k % bins) + bins) % bins;
    return [wrap(low), wrap(low + 1), p - low];
}

/** Middle bins of the sectors whose mean stands for a value where phi_d means nothing. */
export const SECTORS = 12;
const SECTOR_BINS = PHI_D_BINS / SECTORS;
const sectorMiddle = (sector: number) => sector * SECTOR_BINS + Math.floor(SECTOR_BINS / 2);

/** How much phi_d means: 1 from the first centres of theta_h and theta_d on, 0 where either is 0. */
function meaningOfPhiD(c: HalfDifference): number {
    const first = binCentre(0, 0, 0);
    return Math.min(c.thetaH / first.thetaH, 1) * Math.min(c.thetaD / first.thetaD, 1);
}

/** A weighted sum of values whose fourth number is that of the weights; null without data. */
const meanOf = (sum: number[]): Triple | null =>
    sum[3] > 0 ? [sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]] : null;

/** A BRDF (or its deviations) on the grid. rgba[bin][4], phi_d fastest; the fourth is 1 with data. */
export class Table {
    /** `halves` are the same as half floats, which every WebGL 2 can interpolate. */
    constructor(
        readonly rgba: Float32Array,
        readonly halves: Uint16Array,
    ) {}

    /** What bin centres hold; null without data. */
    atBin(thetaH: number, thetaD: number, phiD: number): Triple | null {
        const at = 4 * ((thetaH * THETA_D_BINS + thetaD) * PHI_D_BINS + phiD);
        const { rgba } = this;
        return rgba[at + 3] > 0 ? [rgba[at], rgba[at + 1], rgba[at + 2]] : null;
    }

    /**
     * Trilinear between bin centres; near the poles of phi_d, towards its mean. Bins without data
     * are left out, the others count for more.
     */
    at(c: HalfDifference): Triple | null {
        const [cosineI, cosineO] = cosines(c);
        if (cosineI <= 0 || cosineO <= 0) {
            return null;
        }
        const p = periodic((PHI_D_BINS * c.phiD) / Math.PI, PHI_D_BINS);
        const meaning = meaningOfPhiD(c);
        const sum = [0, 0, 0, 0];
        this.addPlane(c, p[0], (1 - p[2]) * meaning, sum);
        this.addPlane(c, p[1], p[2] * meaning, sum);
        for (let sector = 0; meaning < 1 && sector < SECTORS; sector++) {
            this.addPlane(c, sectorMiddle(sector), (1 - meaning) / SECTORS, sum);
        }
        return meanOf(sum);
    }

    /** Trilinear, with the neighbours in the third coordinate given. */
    between(c: Pick<HalfDifference, 'thetaH' | 'thetaD'>, third: Neighbours): Triple | null {
        const sum = [0, 0, 0, 0];
        this.addPlane(c, third[0], 1 - third[2], sum);
        this.addPlane(c, third[1], third[2], sum);
        return meanOf(sum);
    }

    /** Adds the value at a bin of phi_d, bilinear in the other two, times a share, to sum[4]. */
    private addPlane(
        c: Pick<HalfDifference, 'thetaH' | 'thetaD'>,
        phiD: number,
        share: number,
        sum: number[],
    ) {
        const h = clamped(THETA_H_BINS * Math.sqrt(c.thetaH / QUARTER), THETA_H_BINS);
        const d = clamped((THETA_D_BINS * c.thetaD) / QUARTER, THETA_D_BINS);
        for (let k = 0; k < 4; k++) {
            const [a, b] = [k >> 1, k & 1];
            const weight = share * (a ? h[2] : 1 - h[2]) * (b ? d[2] : 1 - d[2]);
            const at = 4 * ((h[a] * THETA_D_BINS + d[b]) * PHI_D_BINS + phiD);
            for (let channel = 0; channel < 4; channel++) {
                sum[channel] += weight * this.rgba[at + channel];
            }
        }
    }

    atPair(incident: Angles, outgoing: Angles): Triple | null {
        return this.at(halfDifference(vectorOf(incident), vectorOf(outgoing)));
    }
}

/** A channel of a value: 0, 1, 2 for R, G, B; 3 for luminance (BT.709). */
export type Channel = 0 | 1 | 2 | 3;
export const CHANNEL_NAMES = ['R', 'G', 'B', 'luminance'] as const;

export function ofChannel(value: Triple, channel: Channel): number {
    return channel === 3 ? luminance(value) : value[channel];
}

export const luminance = (v: Triple) => 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];

/** s of a channel; luminance takes that of G. */
export const scaleOf = (channel: Channel) => LOG_SCALE[channel === 3 ? 1 : channel];

export const toLog = (rho: number, channel: Channel) => Math.log1p(rho / scaleOf(channel));
