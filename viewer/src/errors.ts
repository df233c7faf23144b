// Section 5: the errors that gonio compare finds.
import { byId, element } from './controls';
import type { Comparison, ErrorNumbers, Metric } from './data';

const text = (value: number | null, metric: Metric) =>
    value === null
        ? '–'
        : `${value.toFixed(metric.digits)}${metric.unit === '' ? '' : ` ${metric.unit}`}`;

function row(name: string, errors: ErrorNumbers, metrics: Metric[]): HTMLElement {
    return element(
        'tr',
        {},
        element('th', { scope: 'row' }, name),
        ...metrics.map((metric, m) => element('td', {}, text(errors[m], metric))),
    );
}

/** turns: directions at all azimuths of the sample were compared, not bins. */
export function showErrors(comparison: Comparison, turns: boolean) {
    const metrics = comparison.metrics;
    byId('error-metrics').replaceChildren(
        element('th', { scope: 'col' }),
        ...metrics.map((metric) => element('th', { scope: 'col' }, metric.title)),
    );
    byId('error-rows').replaceChildren(
        row('all channels', comparison.all, metrics),
        ...comparison.channels.map((e, k) => row('RGB'[k], e, metrics)),
    );
    byId('error-summaries').textContent = metrics
        .map((metric) => `${metric.title}: ${metric.summary}.`)
        .join(' ');
    const places = turns ? 'directions at all azimuths' : 'bins';
    const count = (value: number) => value.toLocaleString('en');
    byId('error-note').textContent =
        `${count(comparison.bins)} ${places} compared` +
        (comparison.missing > 0
            ? `; ${count(comparison.missing)} ${places} of the original have no data in the reconstruction.`
            : '.');
}
