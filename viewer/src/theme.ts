// Dark or light: as the system has it, or as chosen.

export type Theme = 'auto' | 'light' | 'dark';

const listeners: (() => void)[] = [];
const system = matchMedia('(prefers-color-scheme: dark)');

/** Calls back whenever colours have changed, for what is drawn with them. */
export function onTheme(listener: () => void) {
    listeners.push(listener);
}

const changed = () => listeners.forEach((listener) => listener());

export function setTheme(theme: Theme) {
    if (theme === 'auto') {
        delete document.documentElement.dataset.theme;
    } else {
        document.documentElement.dataset.theme = theme;
    }
    changed();
}

system.addEventListener('change', changed);
