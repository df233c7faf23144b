// Unpacks a table: the counterpart of src/report/web_table.c.
import { BINS, CELLS, CHANNELS, LOG_SCALE, PHI_D_BINS, Table } from './brdf';

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

/** One row of codes from its differences and the row before, by the predictor that was chosen. */
function unpackRow(
    codes: Uint16Array,
    at: number,
    above: number,
    low: Uint8Array,
    high: Uint8Array,
    kind: number,
) {
    for (let k = 0; k < PHI_D_BINS; k++) {
        const up = above < 0 ? 0 : codes[above + k];
        const first = above < 0 ? 0 : codes[above];
        const left = k > 0 ? codes[at + k - 1] : first;
        const corner = k === 0 || above < 0 ? first : codes[above + k - 1];
        const guess = kind === 0 ? left : kind === 1 ? up : left + up - corner;
        const folded = low[at + k] | (high[at + k] << 8);
        const difference = folded & 1 ? ~(folded >> 1) : folded >> 1;
        codes[at + k] = guess + difference; // modulo 2^16
    }
}

function unpackCodes(stream: Uint8Array): Uint16Array {
    const kinds = stream.subarray(MASK, MASK + ROWS);
    const low = stream.subarray(MASK + ROWS, MASK + ROWS + VALUES);
    const high = stream.subarray(MASK + ROWS + VALUES);
    const codes = new Uint16Array(VALUES);
    for (let row = 0; row < ROWS; row++) {
        const at = row * PHI_D_BINS;
        unpackRow(codes, at, row % CELLS > 0 ? at - PHI_D_BINS : -1, low, high, kinds[row]);
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

export async function unpack(base64: string, step: number, logarithmic: boolean): Promise<Table> {
    const stream = await inflate(bytesOf(base64));
    if (stream.length !== MASK + ROWS + 2 * VALUES) {
        throw new Error('a table in this page is damaged');
    }
    const codes = unpackCodes(stream);
    const rgba = new Float32Array(4 * BINS);
    for (let channel = 0; channel < CHANNELS; channel++) {
        const values = valuesOfCodes(step, channel, logarithmic);
        for (let bin = 0; bin < BINS; bin++) {
            const present = (stream[bin >> 3] >> (bin & 7)) & 1;
            rgba[4 * bin + channel] = present ? values[codes[channel * BINS + bin]] : 0;
            rgba[4 * bin + 3] = present;
        }
    }
    return new Table(rgba);
}
