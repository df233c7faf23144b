// Unpacks a table: the counterpart of src/page/packed_table.c.
import { DataUtils } from 'three';
import {
    BINS,
    CELLS,
    CHANNELS,
    LOG_SCALE,
    PHI_D_BINS,
    Table,
    THETA_D_BINS,
    THETA_H_BINS,
} from './brdf';

const ROWS = CHANNELS * CELLS;
const VALUES = ROWS * PHI_D_BINS;
const MASK = Math.ceil(BINS / 8);

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
    const binary = atob(base64);
    const bytes = new Uint8Array(binary.length);
    for (let k = 0; k < binary.length; k++) {
        bytes[k] = binary.charCodeAt(k);
    }
    return bytes;
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

const BEFORE = 0;
const ABOVE = 1;

/** One row of codes from its differences and the row above, by the predictor that was chosen. */
function unpackRow(
    codes: Uint16Array,
    at: number,
    above: Uint16Array,
    differences: Uint16Array,
    kind: number,
) {
    let left = above[0];
    let corner = above[0];
    for (let k = 0; k < PHI_D_BINS; k++) {
        const up = above[k];
        const guess = kind === BEFORE ? left : kind === ABOVE ? up : left + up - corner;
        left = (guess + differences[k]) & 0xffff;
        corner = up;
        codes[at + k] = left;
    }
}

/** From bytes with the sign in the lowest bit. */
function differencesOf(low: Uint8Array, high: Uint8Array): Uint16Array {
    const differences = new Uint16Array(VALUES);
    for (let k = 0; k < VALUES; k++) {
        const folded = low[k] | (high[k] << 8);
        differences[k] = (folded >> 1) ^ -(folded & 1);
    }
    return differences;
}

function unpackCodes(stream: Uint8Array): Uint16Array {
    const kinds = stream.subarray(MASK, MASK + ROWS);
    const low = stream.subarray(MASK + ROWS, MASK + ROWS + VALUES);
    const differences = differencesOf(low, stream.subarray(MASK + ROWS + VALUES));
    const codes = new Uint16Array(VALUES);
    const nothing = new Uint16Array(PHI_D_BINS);
    for (let row = 0; row < ROWS; row++) {
        const at = row * PHI_D_BINS;
        const above = row % CELLS > 0 ? codes.subarray(at - PHI_D_BINS, at) : nothing;
        unpackRow(codes, at, above, differences.subarray(at, at + PHI_D_BINS), kinds[row]);
    }
    return codes;
}

/** Every code's value: rho in 1/sr, or for deviations the number itself. */
function valuesOfCodes(step: number, channel: number, logarithmic: boolean): Float32Array {
    const values = new Float32Array(65536);
    for (let code = 1; code < values.length; code++) {
        const g = (code - 1) * step;
        values[code] = logarithmic ? LOG_SCALE[channel] * Math.expm1(g) : g;
    }
    return values;
}

/** The same as half floats, which end at 65504. */
const halvesOf = (values: Float32Array) =>
    Uint16Array.from(values, (value) => DataUtils.toHalfFloat(Math.min(value, 65504)));

export async function unpack(base64: string, step: number, logarithmic: boolean): Promise<Table> {
    const stream = await inflate(bytesOf(base64));
    if (stream.length !== MASK + ROWS + 2 * VALUES) {
        throw new Error('a table in this page is damaged');
    }
    const codes = unpackCodes(stream);
    const rgba = new Float32Array(4 * BINS);
    const halves = new Uint16Array(4 * BINS);
    for (let channel = 0; channel < CHANNELS; channel++) {
        const values = valuesOfCodes(step, channel, logarithmic);
        const asHalves = halvesOf(values);
        for (let bin = 0; bin < BINS; bin++) {
            if ((stream[bin >> 3] >> (bin & 7)) & 1) {
                const code = codes[channel * BINS + bin];
                rgba[4 * bin + channel] = values[code];
                halves[4 * bin + channel] = asHalves[code];
                rgba[4 * bin + 3] = 1;
                halves[4 * bin + 3] = 0x3c00;
            }
        }
    }
    fillHoles(halves);
    return new Table(rgba, halves);
}

/** What a bin without data weighs beside one with: hardly anything, unless there is no other. */
const HOLE = 1e-3;

/** For the spheres, bins without data get the values of the nearest along theta_d. */
function fillHoles(halves: Uint16Array) {
    const step = 4 * PHI_D_BINS;
    const weight = DataUtils.toHalfFloat(HOLE);
    for (let line = 0; line < THETA_H_BINS * PHI_D_BINS; line++) {
        const first =
            4 * (Math.floor(line / PHI_D_BINS) * THETA_D_BINS * PHI_D_BINS + (line % PHI_D_BINS));
        let last = -1; // the last bin with data
        for (let d = 0; d < THETA_D_BINS; d++) {
            const at = first + d * step;
            if (halves[at + 3] !== 0) {
                last = at;
            } else if (last >= 0) {
                for (let channel = 0; channel < CHANNELS; channel++) {
                    const value = DataUtils.fromHalfFloat(halves[last + channel]);
                    halves[at + channel] = DataUtils.toHalfFloat(HOLE * value);
                }
                halves[at + 3] = weight;
            }
        }
    }
}
