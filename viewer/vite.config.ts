// Builds the page into one file that needs no other; serves it with a report's data for development.
import { readFileSync } from 'node:fs';
import { defineConfig, type Plugin } from 'vite';
import { viteSingleFile } from 'vite-plugin-singlefile';

const place = '<!--gonio-data-->';

/** `GONIO_REPORT=report.html npm run dev` shows that report's data in the page under work. */
function dataOfReport(path: string): Plugin {
    return {
        name: 'data-of-report',
        apply: 'serve',
        transformIndexHtml(html) {
            const elements = readFileSync(path, 'utf8').match(
                /<script type="[a-z/]+" id="gonio-[a-z]+">[^<]*<\/script>/g,
            );
            return html.replace(place, () => (elements ?? []).join('\n'));
        },
    };
}

/** gonio puts the data where the template says; a template without the place, or with two, is no use. */
function onePlace(): Plugin {
    return {
        name: 'one-place',
        apply: 'build',
        enforce: 'post',
        generateBundle(_options, bundle) {
            const page = bundle['index.html'];
            const html = page?.type === 'asset' ? String(page.source) : '';
            if (html.split(place).length !== 2) {
                this.error(`index.html must have exactly one ${place}`);
            }
        },
    };
}

const report = process.env.GONIO_REPORT;

export default defineConfig({
    plugins: [
        viteSingleFile({ removeViteModuleLoader: true }),
        onePlace(),
        report ? dataOfReport(report) : null,
    ],
    build: { target: 'es2022', reportCompressedSize: false, chunkSizeWarningLimit: 2000 },
});
