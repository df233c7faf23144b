// Section 5: the errors that gonio compare finds.
import { byId, element } from './controls';
import type { Comparison, ErrorNumbers } from './data';

const text = (value: number | null, digits: number, unit: string) =>
    value === null ? '–' : `${value.toFixed(digits)}${unit}`;

function row(name: string, e: ErrorNumbers): HTMLElement {
    const cells = [text(e.e6, 3, ' %'), text(e.cubeRoot, 3, ' %'), text(e.logRelative, 4, '')];
    return element(
        'tr',
        {},
        element('th', { scope: 'row' }, name),
        ...cells.map((c) => element('td', {}, c)),
    );
}

export function showErrors(comparison: Comparison) {
    byId('error-rows').replaceChildren(
        row('all channels', comparison.all),
        ...comparison.channels.map((e, k) => row('RGB'[k], e)),
    );
    const count = (value: number) => value.toLocaleString('en');
    byId('error-note').textContent =
        `${count(comparison.bins)} bins compared` +
        (comparison.missing > 0
            ? `; ${count(comparison.missing)} bins of the original have no data in the reconstruction.`
            : '.');
}
