// Other pages: figures of a reproduction, a material alone, on a phone, without WebGL.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import {
    changes,
    choose,
    json,
    launch,
    lookUpErrors,
    looksLike,
    open,
    slide,
    spheresDone,
} from './browser.mjs';

let browser;
before(async () => (browser = await launch()));
after(async () => browser?.close());

test('the figures of a reproduction are charts', async () => {
    const { page, complaints } = await open(browser, 'figures.html');
    for (const figure of ['fig2a', 'fig2b', 'fig3a', 'fig5']) {
        assert.ok(await page.locator(`#${figure} canvas`).isVisible(), figure);
    }
    assert.equal(await page.locator('#fig3b').count(), 0, 'a table that is not there');
    assert.equal(await page.locator('#spheres').isVisible(), false);
    await changes(page, '#fig3a canvas', () => choose(page, 'fig3a-metric', 'cube root'));
    await changes(page, '#fig5 canvas', () => choose(page, 'fig5-metric', 'cube root'));
    await page.locator('#fig5 .chart').focus();
    await page.keyboard.press('ArrowRight');
    const legend = page.locator('#fig5 .u-legend');
    assert.match(await legend.innerText(), /<\/script>,odd[\s\S]*3/, 'a name as it is');
    const entry = page.locator('#fig5 .u-legend th').nth(1);
    await entry.focus();
    await changes(page, '#fig5 canvas', () => page.keyboard.press('Enter'));
    await page.locator('#fig2b summary').click();
    // The table is made when the browser tells of the opening, which is after the click.
    assert.match(
        await page.locator('#fig2b .numbers table').innerText(),
        /start 1\s+start 2[\s\S]*90\s+70/,
    );
    assert.deepEqual(complaints, []);
    await page.close();
});

test('a material alone has no difference, no errors and no band', async () => {
    const { page, complaints } = await open(browser, 'alone.html');
    assert.equal(await page.locator('#sphere-panels canvas').count(), 1);
    for (const section of ['hemisphere', 'errors', 'figures']) {
        assert.equal(await page.locator(`#${section}`).isVisible(), false, section);
    }
    assert.equal(await page.locator('[data-control=layer]').count(), 0);
    assert.equal(await page.locator('#lobe-key').count(), 0);
    assert.equal(await page.locator('[data-control=azimuth]').count(), 0);
    assert.equal(await page.locator('#turning').isVisible(), false);
    assert.deepEqual(complaints, []);
    await page.close();
});

test('where phi_d means nothing its mean is looked up, as the C library does', async () => {
    const { page, complaints } = await open(browser, 'poles.html');
    const worst = await lookUpErrors(page, json('poles.json'));
    assert.equal(worst.wrong, 0, 'where there are data');
    assert.ok(worst.most < 0.52, `off by ${worst.most} steps`);
    assert.equal(await page.locator('#problem').isHidden(), true);
    assert.deepEqual(complaints, []);
    await page.close();
});

test('an anisotropic material is shown at any azimuth, its readings by the turn of the sample', async () => {
    const { page, complaints } = await open(browser, 'turned.html');
    assert.match(await page.locator('#turning').innerText(), /changes as the sample turns/);
    // What gonio finds at the readings, which are in the plane of incidence.
    const found = await page.evaluate(() => {
        const degrees = (angle) => (angle * 180) / Math.PI;
        return window.gonioReport.data.readings.list.map(({ incident, outgoing, reference }) => {
            const across = Math.cos(outgoing[1] - incident[1]) < 0 ? 1 : -1;
            const [light, view] = [degrees(incident[0]), across * degrees(outgoing[0])];
            const value = window.gonioReport.turned.original.at(light, degrees(incident[1]), view);
            return [value[0], reference[0]];
        });
    });
    for (const [here, known] of found) {
        assert.ok(Math.abs(here / known - 1) < 0.02, `${here} for ${known}`);
    }
    assert.ok(found[2][1] > 2 * found[0][1], 'the azimuth counts');
    await changes(page, '#lobe-polar', () => slide(page, 'azimuth', 90));

    const told = page.locator('#turn-readout');
    assert.match(await told.innerText(), /2 azimuths/);
    await changes(page, '#hemisphere-canvas', () => slide(page, 'turn', 2));
    assert.equal(await told.innerText(), '3 readings at 90°: 3, 4, 5');
    await page.locator('#hemisphere-canvas').focus();
    await page.keyboard.press('Shift+ArrowLeft');
    await page.keyboard.press('Shift+ArrowRight');
    assert.match(await page.locator('#hemisphere-readout').innerText(), /Reading 3 of 5/);
    await changes(page, '#hemisphere-canvas', () =>
        page.locator('[data-turn="1"]').dispatchEvent('click'),
    );
    assert.equal(await told.innerText(), '2 readings at 0°: 1, 2');
    assert.deepEqual(complaints, []);
    await page.close();
});

test('on a phone in the dark nothing is wider than the screen', async () => {
    const { page, complaints } = await open(browser, 'page.html', {
        viewport: { width: 360, height: 740 },
        colorScheme: 'dark',
        hasTouch: true,
    });
    await spheresDone(page);
    const [wide, dark] = await page.evaluate(() => [
        document.documentElement.scrollWidth,
        getComputedStyle(document.body).backgroundColor,
    ]);
    assert.equal(wide, 360);
    assert.equal(dark, 'rgb(20, 23, 26)');
    await page.evaluate(() => window.scrollTo(0, 0));
    await looksLike(page, await page.screenshot(), 'phone', 0.04);
    assert.deepEqual(complaints, []);
    await page.close();
});

test('without WebGL the other sections still work and the page says why', async () => {
    const page = await browser.newPage();
    await page.addInitScript(() => {
        const original = HTMLCanvasElement.prototype.getContext;
        HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
            return kind.startsWith('webgl') ? null : original.call(this, kind, ...rest);
        };
    });
    await page.goto(`file://${process.env.PAGES}/page.html`);
    await page.waitForSelector('html[data-ready=yes]', { timeout: 120000 });
    assert.match(await page.locator('#spheres .problem').innerText(), /no WebGL 2/);
    assert.ok(await page.locator('#lobe-polar .lobe-original').isVisible());
    await page.close();
});
