// What gonio has put into the page: see docs/report-page.md.

export type Triple = [number, number, number];

/** theta from the normal, phi from +x, radians. */
export type Angles = [theta: number, phi: number];

export interface Material {
    name: string;
    format: string;
    /** Values are stored in steps of this much of g = ln(1 + rho/s). */
    step: number;
    /** theta_h, theta_d, phi_d and the R, G, B that gonio finds there. */
    checks: [number, number, number, number, number, number][];
}

/** An error metric: its column in tables; digits are those worth showing after the decimal point. */
export interface Metric {
    key: string;
    title: string;
    unit: string;
    digits: number;
    summary: string;
}

/** Errors in the order of the metrics. */
export type ErrorNumbers = (number | null)[];

export interface Comparison {
    bins: number;
    missing: number;
    metrics: Metric[];
    all: ErrorNumbers;
    channels: [ErrorNumbers, ErrorNumbers, ErrorNumbers];
}

/** The error of all channels by the metric of a title; null where there is none. */
export function errorOf(comparison: Comparison | undefined, title: string): number | null {
    const at = comparison?.metrics.findIndex((metric) => metric.title === title) ?? -1;
    return comparison?.all[at] ?? null;
}

export interface Reading {
    incident: Angles;
    outgoing: Angles;
    /** 0, 1, 2: what was planned to be read; -1: all channels. */
    channel: number;
    value: (number | null)[];
    reference: Triple | null;
    reconstruction: Triple | null;
}

export interface Readings {
    file: string;
    count: number;
    components: number;
    method: string;
    list: Reading[];
}

export interface FigureTable {
    columns: string[];
    /** Those whose keys are columns. */
    metrics: Metric[];
    rows: (number | string | null)[][];
}

export interface ReportData {
    version: string;
    reference?: Material;
    reconstruction?: Material;
    deviation?: { step: number };
    /** Of anisotropic materials: the plane of incidence at all azimuths. */
    'reference-turns'?: { step: number };
    'reconstruction-turns'?: { step: number };
    comparison?: Comparison;
    readings?: Readings;
    figures?: Record<string, FigureTable>;
}

export const TABLE_NAMES = [
    'reference',
    'reconstruction',
    'deviation',
    'reference-turns',
    'reconstruction-turns',
] as const;
export type TableName = (typeof TABLE_NAMES)[number];

function textOf(id: string): string | null {
    return document.getElementById(`gonio-${id}`)?.textContent ?? null;
}

export function readData(): ReportData | null {
    const text = textOf('data');
    return text === null ? null : (JSON.parse(text) as ReportData);
}

/** A packed table, which is taken out of the page: it is needed once. */
export function takeTable(name: TableName): string | null {
    const text = textOf(name);
    document.getElementById(`gonio-${name}`)?.remove();
    return text;
}
