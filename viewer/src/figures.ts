// The paper's figures from a `gonio reproduce` folder, as charts.
import { Chart, type Series } from './charts';
import { byId, choice, element } from './controls';
import type { FigureTable, Metric } from './data';
import { valueColours } from './colour';

type Figures = Record<string, FigureTable>;
/** "E6 error, %", "log-relative error" */
function labelOf({ title, unit }: Metric): string {
    return unit === '' ? `${title} error` : `${title} error, ${unit}`;
}

const COLOURS = ['series-1', 'series-2', 'series-3', 'series-4', 'series-5'];

/** Rows as objects by column. */
function rowsOf(table: FigureTable): Record<string, number | string | null>[] {
    return table.rows.map((row) =>
        Object.fromEntries(table.columns.map((name, k) => [name, row[k]])),
    );
}

const number = (value: number | string | null | undefined) =>
    typeof value === 'number' ? value : null;

/** Values of curves at the sorted union of their places. */
function aligned(curves: Map<string, [number, number | null][]>): {
    at: number[];
    of: Map<string, (number | null)[]>;
} {
    const at = [...new Set([...curves.values()].flatMap((c) => c.map(([x]) => x)))].sort(
        (a, b) => a - b,
    );
    const of = new Map(
        [...curves].map(([name, points]) => {
            const values = new Map(points);
            return [name, at.map((x) => values.get(x) ?? null)];
        }),
    );
    return { at, of };
}

function gather(
    table: FigureTable,
    name: string,
    x: string,
    y: string,
): Map<string, [number, number | null][]> {
    const curves = new Map<string, [number, number | null][]>();
    for (const row of rowsOf(table)) {
        const at = number(row[x]);
        if (at !== null) {
            const key = String(row[name]);
            curves.set(key, [...(curves.get(key) ?? []), [at, number(row[y])]]);
        }
    }
    return curves;
}

function section(name: string, title: string, note: string): HTMLElement {
    const box = element(
        'div',
        { class: 'figure', id: name },
        element('h3', {}, title),
        element('p', {}, note),
    );
    byId('figure-list').append(box);
    return box;
}

// ---- Fig. 2 ----

function showSpectrum(table: FigureTable) {
    const box = section(
        'fig2a',
        'Fig. 2(a): few components explain most',
        'Share of the variance that the first components explain; of all materials, and of the bases of the splits.',
    );
    const { at, of } = aligned(gather(table, 'basis_of', 'component', 'cumulative'));
    const series = [...of].map(
        ([name, values]): Series =>
            name === 'all'
                ? { label: 'all materials', values, colour: 'series-1', width: 3 }
                : { label: name, values, colour: 'muted', width: 1, faint: true },
    );
    series.reverse(); // all materials on top
    new Chart(box, 'Variance against components').show({
        x: { label: 'components' },
        y: { label: 'share of the variance', range: [0, 1.02], text: (v) => v.toFixed(4) },
        at,
        series,
    });
}

function showConvergence(table: FigureTable) {
    const box = section(
        'fig2b',
        'Fig. 2(b): a plan converges',
        'Condition number of the chosen rows while rows are swapped, for each random start.',
    );
    const { at, of } = aligned(gather(table, 'start', 'swap', 'condition_number'));
    const series = [...of].map(
        ([name, values], k): Series => ({
            label: `start ${name}`,
            values,
            colour: COLOURS[k % COLOURS.length],
        }),
    );
    new Chart(box, 'Condition number against swaps').show({
        x: { label: 'swaps' },
        y: { label: 'condition number', logarithmic: true },
        at,
        series,
    });
}

// ---- Fig. 3 ----

/** A choice of the table's metrics. */
function withMetrics(
    box: HTMLElement,
    name: string,
    table: FigureTable,
    draw: (metric: Metric) => void,
) {
    const bar = element('div', { class: 'controls' });
    box.append(bar);
    const options = table.metrics.map(({ key, title }) => [key, title] as const);
    choice(bar, `${name}-metric`, 'Error', options, table.metrics[0].key, (key) =>
        draw(table.metrics.find((metric) => metric.key === key) ?? table.metrics[0]),
    );
}

function showGrid(table: FigureTable) {
    const box = section(
        'fig3a',
        'Fig. 3(a): components and samples',
        'Mean error of the test materials against the number of samples, a curve for each number of components.',
    );
    const components = [...new Set(rowsOf(table).map((row) => String(row.components)))];
    const draw = (metric: Metric) => {
        const { at, of } = aligned(gather(table, 'components', 'samples', metric.key));
        const series = components.map(
            (name, k): Series => ({
                label: `${name} components`,
                values: of.get(name) ?? [],
                colour: valueColours(0.05 + (0.8 * k) / Math.max(components.length - 1, 1)),
                points: true,
            }),
        );
        chart.show({
            x: { label: 'samples' },
            y: { label: `mean ${labelOf(metric)}` },
            at,
            series,
        });
    };
    withMetrics(box, 'fig3a', table, draw);
    const chart = new Chart(box, 'Error against samples', 400);
    draw(table.metrics[0]);
}

/** Mean and quartiles of each method, in the table's order. */
function summaries(table: FigureTable, metric: Metric) {
    const groups = new Map<string, number[]>();
    for (const row of rowsOf(table)) {
        const value = number(row[metric.key]);
        const key = `${row.method}, ${row.samples}`;
        groups.set(key, [...(groups.get(key) ?? []), ...(value === null ? [] : [value])]);
    }
    return [...groups].map(([name, values]) => {
        const sorted = values.sort((a, b) => a - b);
        const quantile = (q: number) => sorted[Math.round(q * (sorted.length - 1))] ?? null;
        const mean = values.length > 0 ? values.reduce((a, b) => a + b, 0) / values.length : null;
        return { name, mean, low: quantile(0.1), high: quantile(0.9) };
    });
}

function showMethods(table: FigureTable) {
    const box = section(
        'fig3b',
        'Fig. 3(b): the methods',
        'Mean error over materials and splits, and where the middle 80 % of them lie; the number of samples behind the name.',
    );
    const draw = (metric: Metric) => {
        const rows = summaries(table, metric);
        chart.show({
            x: {
                label: 'method, samples',
                names: rows.map((r) => r.name),
            },
            y: { label: `mean ${labelOf(metric)}` },
            at: rows.map((_, k) => k),
            series: [
                {
                    label: 'mean',
                    values: rows.map((r) => r.mean),
                    colour: 'series-1',
                    scattered: true,
                },
                {
                    label: 'lower tenth',
                    values: rows.map((r) => r.low),
                    colour: 'series-1',
                    hidden: true,
                },
                {
                    label: 'upper tenth',
                    values: rows.map((r) => r.high),
                    colour: 'series-1',
                    hidden: true,
                },
            ],
            whiskers: { lower: 1, upper: 2, colour: 'series-1' },
        });
    };
    withMetrics(box, 'fig3b', table, draw);
    const chart = new Chart(box, 'Error of the methods');
    draw(table.metrics[0]);
}

// ---- Fig. 5 ----

function showLeftOut(table: FigureTable) {
    const box = section(
        'fig5',
        'Fig. 5: every material left out once',
        'Error of each material from a basis of the others, sorted by the first series. The name is below the chart, at the cursor.',
    );
    const draw = (metric: Metric) => {
        const bySeries = new Map<string, Map<string, number | null>>();
        for (const row of rowsOf(table)) {
            const key = String(row.reconstructed_from);
            const values = bySeries.get(key) ?? new Map<string, number | null>();
            values.set(String(row.material), number(row[metric.key]));
            bySeries.set(key, values);
        }
        const first = bySeries.values().next().value ?? new Map<string, number | null>();
        const names = [...first.keys()].sort((a, b) => (first.get(a) ?? 0) - (first.get(b) ?? 0));
        chart.show({
            x: { label: 'material', names },
            y: { label: labelOf(metric) },
            at: names.map((_, k) => k),
            series: [...bySeries].map(
                ([label, values], k): Series => ({
                    label,
                    values: names.map((name) => values.get(name) ?? null),
                    colour: COLOURS[k % COLOURS.length],
                    points: true,
                    width: 1,
                }),
            ),
        });
    };
    withMetrics(box, 'fig5', table, draw);
    const chart = new Chart(box, 'Error of every material', 400);
    draw(table.metrics[0]);
}

export function showFigures(figures: Figures) {
    const shown: [string, (table: FigureTable) => void][] = [
        ['fig2a', showSpectrum],
        ['fig2b', showConvergence],
        ['fig3a-means', showGrid],
        ['fig3b', showMethods],
        ['fig5', showLeftOut],
    ];
    for (const [name, show] of shown) {
        if (figures[name] && figures[name].rows.length > 0) {
            show(figures[name]);
        }
    }
}
