// The page that gonio report writes: unpacks the data in it and fills in the sections they allow.
import './style.css';
import { halfDifference, LOG_SCALE, radians, type Table } from './brdf';
import { byId, choice, element } from './controls';
import {
    errorOf,
    readData,
    TABLE_NAMES,
    takeTable,
    type Material,
    type Reading,
    type ReportData,
    type TableName,
} from './data';
import { showErrors } from './errors';
import { showFigures } from './figures';
import { HemisphereSection, type Plan } from './hemisphere';
import { LobeSection, type Turned } from './lobes';
import { SliceSection } from './slice';
import { SphereRenderer } from './sphere-renderer';
import { SphereSection } from './spheres';
import { setTheme } from './theme';
import { TurnedTable } from './turned';
import { unpack } from './unpack';

/** What scripts may use; also in the browser's console. */
export interface Report {
    data: ReportData;
    tables: Partial<Record<TableName, Table>>;
    turned: Turned;
    halfDifference: typeof halfDifference;
    spheres: SphereSection | null;
    SphereRenderer: typeof SphereRenderer;
}

declare global {
    interface Window {
        gonioReport?: Report;
    }
}

function fail(message: string) {
    byId('problem').textContent = message;
    byId('problem').hidden = false;
}

/** Shows a section and its entry in the navigation. */
function open(section: string) {
    byId(section).hidden = false;
    document.querySelector<HTMLElement>(`nav a[href="#${section}"]`)!.hidden = false;
}

/** One section's failure leaves the others. */
function attempt(section: string, work: () => void) {
    open(section);
    try {
        work();
    } catch (error) {
        const webgl = document.createElement('canvas').getContext('webgl2') !== null;
        const reason = webgl
            ? String(error)
            : 'this browser has no WebGL 2, or it is switched off.';
        byId(section).append(element('p', { class: 'problem' }, `Cannot be shown: ${reason}`));
        if (webgl) {
            console.error(error);
        }
    }
}

async function unpackTables(data: ReportData): Promise<Partial<Record<TableName, Table>>> {
    const tables: Partial<Record<TableName, Table>> = {};
    for (const name of TABLE_NAMES) {
        const packed = takeTable(name);
        const step = data[name]?.step;
        if (packed !== null && step !== undefined) {
            tables[name] = await unpack(packed, step, name !== 'deviation');
        }
    }
    return tables;
}

// ---- head and foot ----

function describe(data: ReportData) {
    const { reference, reconstruction, readings } = data;
    const title = reference?.name ?? 'reproduced figures';
    document.title = `${title} – gonio report`;
    byId('title').textContent = title;
    const parts: string[] = [];
    if (reference) {
        parts.push(reference.format);
    }
    if (reconstruction) {
        parts.push(`reconstruction: ${reconstruction.name}`);
    }
    if (readings) {
        parts.push(`${readings.count} readings (${readings.file})`);
    }
    const e6 = errorOf(data.comparison, 'E6');
    if (e6 !== null) {
        parts.push(`E6 ${e6.toFixed(2)} %`);
    }
    byId('summary').textContent = parts.join(' · ');
    byId('version').textContent = `Written by gonio ${data.version}.`;
}

/** Directions at which look-ups here are not what gonio found, allowing for the steps. */
export function failedChecks(material: Material, table: Table): number {
    return material.checks.filter(([thetaH, thetaD, phiD, ...expected]) => {
        const found = table.at({ thetaH, thetaD, phiD });
        return (
            !found ||
            expected.some((rho, k) => !closeInSteps(found[k], rho, LOG_SCALE[k], material.step))
        );
    }).length;
}

function closeInSteps(found: number, expected: number, scale: number, step: number): boolean {
    return Math.abs(found - expected) <= 1.1 * Math.expm1(step / 2) * (expected + scale) + 1e-9;
}

function checkTables(data: ReportData, tables: Partial<Record<TableName, Table>>) {
    const texts: string[] = [];
    for (const name of ['reference', 'reconstruction'] as const) {
        const [material, table] = [data[name], tables[name]];
        if (material && table) {
            const failed = failedChecks(material, table);
            const precision = (100 * Math.expm1(material.step / 2)).toPrecision(2);
            texts.push(`${material.name}: stored to within ±${precision} % of ρ + s.`);
            if (failed > 0) {
                fail(
                    `${material.name}: ${failed} of ${material.checks.length} values differ from gonio's. The file may be damaged.`,
                );
            } else {
                texts.push(
                    `${material.checks.length} look-ups checked against gonio's: equal within that.`,
                );
            }
        }
    }
    byId('precision').textContent = texts.join(' ');
}

// ---- plans ----

/** The plans of Fig. 4, which have no values. */
function plansOfFigure(data: ReportData): Plan[] {
    const table = data.figures?.fig4;
    const plans = new Map<string, Reading[]>();
    for (const row of table?.rows ?? []) {
        const [components, samples, channel, ...angles] = row;
        const [ti, pi, to, po] = angles.map((v) => radians(Number(v)));
        const name = `${samples} samples, ${components} components`;
        plans.set(name, [
            ...(plans.get(name) ?? []),
            {
                incident: [ti, pi],
                outgoing: [to, po],
                channel: 'RGB'.indexOf(String(channel)),
                value: [null, null, null],
                reference: null,
                reconstruction: null,
            },
        ]);
    }
    return [...plans].map(([name, readings]) => ({ name, readings }));
}

function plansOf(data: ReportData): Plan[] {
    return data.readings && data.readings.list.length > 0
        ? [{ name: data.readings.file, readings: data.readings.list }]
        : plansOfFigure(data);
}

// ---- anisotropic materials ----

const turnedOf = (table: Table | undefined) => (table ? new TurnedTable(table) : null);

/** Which materials change as the sample turns, and that some sections show their mean. */
function tellMean(data: ReportData) {
    const names = (['reference', 'reconstruction'] as const)
        .filter((which) => data[`${which}-turns`])
        .map((which) => (which === 'reference' ? 'The original' : 'The reconstruction'));
    if (names.length > 0) {
        const [who, verb] = names.length > 1 ? ['Both materials', 'change'] : [names[0], 'changes'];
        byId('turning').textContent =
            `${who} ${verb} as the sample turns. Spheres and image slice show the mean over its azimuths, ` +
            'the lobes any azimuth.';
        byId('turning').hidden = false;
    }
}

// ---- all of it ----

function fill(
    data: ReportData,
    tables: Partial<Record<TableName, Table>>,
    turned: Turned,
): SphereSection | null {
    const { reference } = tables;
    const reconstruction = tables.reconstruction ?? null;
    const deviation = tables.deviation ?? null;
    const readings = data.readings?.list ?? [];
    let spheres: SphereSection | null = null;
    if (reference) {
        attempt('spheres', () => (spheres = new SphereSection(reference, reconstruction)));
    }
    const plans = plansOf(data);
    const turns = turned.original !== null || turned.reconstruction !== null;
    if (plans.length > 0) {
        attempt('hemisphere', () => new HemisphereSection(plans, turns));
        if (data.readings && data.readings.count > readings.length) {
            byId('hemisphere-note').textContent =
                `The first ${readings.length} of ${data.readings.count} readings are shown.`;
        }
    }
    if (reference) {
        attempt('slice', () => new SliceSection(reference, reconstruction, deviation, readings));
        attempt('lobes', () => new LobeSection(reference, reconstruction, deviation, turned));
    }
    if (data.comparison) {
        const { comparison } = data;
        attempt('errors', () => showErrors(comparison, turns));
    }
    if (data.figures) {
        const { figures } = data;
        attempt('figures', () => showFigures(figures));
    }
    return spheres;
}

async function start() {
    choice(
        byId('theme'),
        'theme',
        'Colours',
        [
            ['auto', 'auto'],
            ['light', 'light'],
            ['dark', 'dark'],
        ],
        'auto',
        setTheme,
    );
    const data = readData();
    if (!data) {
        fail('This is the empty page: gonio report fills it in.');
        return;
    }
    describe(data);
    tellMean(data);
    const tables = await unpackTables(data);
    checkTables(data, tables);
    const turned = {
        original: turnedOf(tables['reference-turns']),
        reconstruction: turnedOf(tables['reconstruction-turns']),
    };
    const spheres = fill(data, tables, turned);
    window.gonioReport = { data, tables, turned, halfDifference, spheres, SphereRenderer };
    document.documentElement.dataset.ready = 'yes';
}

start().catch((error: unknown) => {
    console.error(error);
    fail(`This page could not be shown: ${String(error)}`);
});
