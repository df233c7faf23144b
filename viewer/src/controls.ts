// Labelled controls that work by keyboard, pointer and touch.

let serial = 0;

export function element<K extends keyof HTMLElementTagNameMap>(
    tag: K,
    attributes: Record<string, string> = {},
    ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        made.setAttribute(name, value);
    }
    made.append(...children);
    return made;
}

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
    const found = document.getElementById(id);
    if (!found) {
        throw new Error(`the page has no #${id}`);
    }
    return found as T;
}

export interface Choice<T> {
    readonly value: T;
    set(value: T): void;
}

/** A slider with its value beside it. */
export function slider(
    parent: HTMLElement,
    name: string,
    label: string,
    [low, high, step]: [number, number, number],
    initial: number,
    text: (value: number) => string,
    changed: (value: number) => void,
): Choice<number> {
    const id = `${name}-${serial++}`;
    const input = element('input', {
        type: 'range',
        id,
        'data-control': name,
        min: String(low),
        max: String(high),
        step: String(step),
        value: String(initial),
    });
    const output = element('output', { for: id });
    const show = () => {
        output.textContent = text(input.valueAsNumber);
        input.setAttribute('aria-valuetext', output.textContent);
    };
    input.addEventListener('input', () => {
        show();
        changed(input.valueAsNumber);
    });
    show();
    parent.append(
        element('div', { class: 'control' }, element('label', { for: id }, label), input, output),
    );
    return {
        get value() {
            return input.valueAsNumber;
        },
        set(value) {
            input.value = String(value);
            show();
        },
    };
}

/** One of a few: radio buttons that look like one bar. */
export function choice<T extends string>(
    parent: HTMLElement,
    name: string,
    label: string,
    options: readonly (readonly [T, string])[],
    initial: T,
    changed: (value: T) => void,
): Choice<T> {
    const group = `${name}-${serial++}`;
    const box = element(
        'fieldset',
        { class: 'choice', 'data-control': name },
        element('legend', {}, label),
    );
    const bar = element('div', { class: 'bar' });
    let current = initial;
    const inputs = options.map(([value, text]) => {
        const input = element('input', {
            type: 'radio',
            name: group,
            value,
            id: `${group}-${value}`,
        });
        input.checked = value === initial;
        input.addEventListener('change', () => {
            current = value;
            changed(value);
        });
        bar.append(input, element('label', { for: input.id }, text));
        return input;
    });
    box.append(bar);
    parent.append(box);
    return {
        get value() {
            return current;
        },
        set(value) {
            current = value;
            for (const input of inputs) {
                input.checked = input.value === value;
            }
        },
    };
}

export function toggle(
    parent: HTMLElement,
    name: string,
    label: string,
    initial: boolean,
    changed: (value: boolean) => void,
): Choice<boolean> {
    const id = `${name}-${serial++}`;
    const input = element('input', { type: 'checkbox', id, 'data-control': name });
    input.checked = initial;
    input.addEventListener('change', () => changed(input.checked));
    parent.append(
        element('div', { class: 'control check' }, input, element('label', { for: id }, label)),
    );
    return {
        get value() {
            return input.checked;
        },
        set(value) {
            input.checked = value;
        },
    };
}

export function button(
    parent: HTMLElement,
    name: string,
    label: string,
    pressed: () => void,
): HTMLButtonElement {
    const made = element('button', { type: 'button', 'data-control': name }, label);
    made.addEventListener('click', pressed);
    parent.append(made);
    return made;
}

/** A number in few digits: 0.000123, 1.23, 4567. */
export function short(value: number, digits = 3): string {
    if (value === 0) {
        return '0';
    }
    const size = Math.abs(value);
    return size >= 1e-4 && size < 1e6
        ? Number(value.toPrecision(digits)).toString()
        : value
              .toExponential(digits - 1)
              .replace(/e\+?(-?\d+)/, (_, power: string) => `·10${raised(power)}`);
}

const raised = (power: string) =>
    power.replace(/[-\d]/g, (c) => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(c)]);

export const signed = (value: number, digits: number) =>
    `${value < 0 ? '−' : '+'}${Math.abs(value).toFixed(digits)}`;
