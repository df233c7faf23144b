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
