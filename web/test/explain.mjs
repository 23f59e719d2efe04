// Checks of explain mode: two shapes in the hand, and what the engine does with them step by step.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { startNative } from "./native.mjs";

const until = (page, condition, argument = null) => page.waitForFunction(condition, argument, { polling: 50 });
const box = "box:0.5,0.4,0.3", capsule = "capsule:0.4,0.2@1.3,0.6,0.2@0,0,40", inside = "box:0.4,0.4,0.4@0.5,0.3,0.1";
const address = (what, a, b, step = 1) => `?shadows=0#explain=${what}&a=${a}&b=${b}&step=${step}`;
const seen = (page) => page.evaluate(() => {
    const { sequence, step, what, shapes } = window.lenduletExplain;
    const text = (id) => document.getElementById(id).textContent;
    return {
        step, what, texts: shapes.map((s) => s.text),
        titles: sequence?.steps.map(({ title, note }) => `${title}; ${note}`),
        title: text("explain-title"), distance: text("explain-distance"), address: location.hash,
    };
});
const ready = async (page) => {
    await until(page, () => document.getElementById("explain-distance").textContent !== "");
    return seen(page);
};

export const explainChecks = {
    async "explain: the page shows the steps that the program draws, for every sequence"({ open, program }) {
        const folder = mkdtempSync(join(tmpdir(), "lendulet-"));
        try {
            const page = await open({ viewport: { width: 900, height: 460 } }, address("gjk", box, capsule));
            await ready(page);
            const questions = [
                ["gjk", box, capsule], ["epa", box, inside], ["distance", "hull:20,0.6", inside],
                ["clip", "box:0.6,0.3,0.5", "box:0.4,0.3,0.4@0.4,0.59,0.2@0,30,0"], ["sat", box, inside],
            ];
            for (const [what, a, b] of questions) {
                await page.evaluate((hash) => (location.hash = hash), address(what, a, b).slice(10));
                const words = `lendulet explain ${what} ${a} ${b}`;
                await until(page, (words) => document.getElementById("explain-words").textContent === words, words);
                await until(page, () => !window.lenduletExplain.stale && !window.lenduletExplain.asking);
                const { titles } = await seen(page), svg = join(folder, "native.svg");
                execFileSync(program, ["explain", what, a, b, "--svg", svg]);
                const texts = [...readFileSync(svg, "utf8").matchAll(/y='(?:16|33)'[^>]*>([^<]*)</g)].map((m) => m[1]);
                const native = titles.map((_, i) => `${texts[2 * i]}; ${texts[2 * i + 1]}`);
                assert.equal(texts.length, 2 * titles.length, what);
                assert.deepEqual(titles, native, what);
            }
        } finally {
            rmSync(folder, { recursive: true });
        }
    },

    async "explain: shapes are dragged, turned and moved by keys; steps go on and back; the address follows"({ open }) {
        const page = await open({ viewport: { width: 800, height: 360 } }, address("distance", box, capsule));
        const first = await ready(page);
        assert.equal(first.step, 1);
        const canvas = page.locator("#explain-shapes"), at = await page.evaluate(() => {
            const { left, shapes } = window.lenduletExplain;
            return left.stage.project(shapes[1].position.toArray());
        });
        const drag = async (dx, dy) => {
            await page.mouse.move(...at);
            await page.mouse.down();
            for (let i = 1; i <= 4; ++i) await page.mouse.move(at[0] + (dx * i) / 4, at[1] + (dy * i) / 4);
            await page.mouse.up();
        };
        const changed = (before) => until(page, (before) => {
            const now = document.getElementById("explain-distance").textContent;
            return now !== before && !location.hash.includes("undefined");
        }, before);
        await drag(20, -30);
        await changed(first.distance);
        const moved = await seen(page);
        assert.notEqual(moved.texts[1], first.texts[1]);
        assert.equal(moved.texts[0], first.texts[0]);
        await until(page, (b) => location.hash.includes(b), moved.texts[1]);
        // Another pair, which overlaps: EPA goes on where GJK ended.
        await page.click("#explain-pair");
        await until(page, () => window.lenduletExplain.sequence.steps.some(({ title }) => /^polytope/.test(title)));
        // By keys.
        await canvas.focus();
        const left = (await seen(page)).texts[1];
        await page.keyboard.press("ArrowLeft");
        const before = (await seen(page)).texts[1];
        assert.notEqual(before, left);
        await page.keyboard.press("t");
        await page.keyboard.press("ArrowRight");
        await until(page, (before) => window.lenduletExplain.shapes[1].text !== before, before);
        const places = [before, (await seen(page)).texts[1]].map((text) => text.split("@")[1]);
        assert.equal(places[0], places[1], "a turn moves nothing");
        await page.click("#explain-next");
        await page.click("#explain-next");
        await page.keyboard.press(",");
        await until(page, () => location.hash.endsWith("step=2"));
        await page.click("#explain-play");
        await until(page, () => window.lenduletExplain.step > 2);
        // Where there is nothing to explain it is said.
        await page.selectOption("#explain-b select", "sphere");
        await page.click('#explain-what [data-value="sat"]');
        await until(page, () => document.getElementById("explain-refused").textContent.includes("must be boxes"));
        await page.click("#explain-close");
        await until(page, () => location.hash.includes("scene=") && !document.body.hasAttribute("data-explain"));
        await page.keyboard.press("e");
        await until(page, () => document.body.hasAttribute("data-explain"));
        await page.click("#list a[href*=two_boxes]");
        await until(page, () => !document.body.hasAttribute("data-explain"));
        assert.equal(await page.evaluate(() => window.lendulet.player.sceneName), "two_boxes");
    },

    async "explain: a phone has room for it, by touch too, and every control a name"({ open }) {
        const page = await open({ viewport: { width: 360, height: 700 }, hasTouch: true, isMobile: true },
            address("distance", box, capsule));
        await ready(page);
        const layout = await page.evaluate(() => ({
            wide: document.documentElement.scrollWidth,
            cut: [...document.querySelectorAll("#explain button, #explain input, #explain select, #explain canvas")]
                .filter((e) => e.offsetParent !== null).map((e) => [e.id || e.outerHTML, e.getBoundingClientRect()])
                .filter(([, r]) => r.left < 0 || r.right > innerWidth || r.bottom > innerHeight).map(([name]) => name),
        }));
        assert.ok(layout.wide <= 360, `${layout.wide} pixels`);
        assert.deepEqual(layout.cut, []);
        await page.tap("#explain-next");
        assert.equal((await seen(page)).step, 2);
        await page.tap('#explain-what [data-value="gjk"]');
        await until(page, () => window.lenduletExplain.what === "gjk");
        const nameless = await page.evaluate(() =>
            [...document.querySelectorAll("#explain :is(button, input, select, canvas)")]
                .filter((e) => !e.getAttribute("aria-label") && !e.textContent.trim() && !e.labels?.length)
                .map((e) => e.outerHTML));
        assert.deepEqual(nameless, []);
    },

    async "explain: a page without an engine of its own asks the native one"({ open, program, folder }) {
        const native = await startNative(program, folder, "stack:3");
        const page = await open({ viewport: { width: 900, height: 420 } }, "?shadows=0#paused=1", native.url);
        const answers = await page.evaluate(async ([a, b]) => {
            const { connection, explain } = window.lendulet.sources;
            const question = { what: "gjk", simplex: "half-space", a, b };
            const told = (sequence) => JSON.stringify(sequence.steps.map(({ title, note }) => [title, note]));
            const refused = await connection.explain({ ...question, what: "epa" }).catch((error) => error.message);
            return [told(await connection.explain(question)), told(await explain(question)), refused];
        }, [box, capsule]);
        assert.equal(answers[0], answers[1]);
        assert.match(answers[2], /do not overlap/);
        await page.context().close();
        assert.equal(await native.end(), 0);
    },

    async "pictures of explain mode show something"({ open, save, look, keeps }) {
        const pictures = [
            ["explain", "light", address("distance", "cylinder:0.4,0.4", "cone:0.5,0.45@0.3,0.4,0.2@10,20,30", 9)],
            ["explain-dark", "dark", address("distance", box, capsule, 3)],
        ];
        for (const [name, scheme, at] of pictures) {
            const page = await open({ viewport: { width: 1160, height: 560 }, colorScheme: scheme },
                keeps ? at.replace("shadows=0", "shadows=2048") : at);
            await ready(page);
            await page.waitForTimeout(300);
            const png = await page.screenshot({ clip: await page.locator("#explain").boundingBox() });
            const { colours, commonest } = await look(page, png);
            assert.ok(colours > 300 && commonest < 0.9, `${name}: ${colours} colours, ${commonest} of one`);
            save(`viewer-${name}.png`, png);
            await page.context().close();
        }
    },
};
