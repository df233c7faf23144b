// Colour maps that the colour-blind can read, and colours of the theme.
import { interpolateCividis, interpolatePuOr, interpolateViridis } from 'd3-scale-chromatic';
import { luminance } from './brdf';
import type { Triple } from './data';

export type ColourMap = (share: number) => string;

/** Of values: dark is little. */
export const valueColours: ColourMap = interpolateViridis;
/** Of uncertainties. */
export const deviationColours: ColourMap = interpolateCividis;
/** Of differences: purple is less, orange more than the original. */
export const differenceColours: ColourMap = interpolatePuOr;

export function bytesOf(colour: string): Triple {
    if (colour.startsWith('#')) {
        const value = parseInt(colour.slice(1), 16);
        return [value >> 16, (value >> 8) & 255, value & 255];
    }
    const [r, g, b] = (colour.match(/\d+(\.\d+)?/g) ?? []).map(Number);
    return [r, g, b];
}

/** `count` colours of a map as RGBA bytes. */
export function ramp(map: ColourMap, count: number): Uint8Array<ArrayBuffer> {
    const bytes = new Uint8Array(4 * count);
    for (let k = 0; k < count; k++) {
        bytes.set([...bytesOf(map((k + 0.5) / count)), 255], 4 * k);
    }
    return bytes;
}

/** A colour of the theme, by the name of its CSS variable. */
export function themeColour(name: string): string {
    return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

const linear = (byte: number) => {
    const c = byte / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
};

export function linearOf(colour: string): Triple {
    const [r, g, b] = bytesOf(colour);
    return [linear(r), linear(g), linear(b)];
}

export function encode(value: number): number {
    const c = Math.min(Math.max(value, 0), 1);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055;
}

/** How a BRDF value looks: brightness from `share` (0 .. 1), hue from the value. */
export function tinted(value: Triple, share: number): Triple {
    const l = luminance(value);
    const factor = l > 0 ? share ** 2.2 / l : 0;
    return [encode(value[0] * factor), encode(value[1] * factor), encode(value[2] * factor)];
}
