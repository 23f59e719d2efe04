// Checks of what is dropped onto the page and saved from it, of settings, forks and the engine's own structures.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const wide = { viewport: { width: 1120, height: 420 } }; // both panels are seen
const until = (page, condition, argument = null) => page.waitForFunction(condition, argument, { polling: 50 });

// Drops files onto the page, as a hand would: names and bytes in turn.
async function drop(page, ...files) {
    const list = [];
    for (let i = 0; i < files.length; i += 2) list.push([files[i], Buffer.from(files[i + 1]).toString("base64")]);
    await page.evaluate((list) => {
        const data = new DataTransfer();
        for (const [name, base64] of list)
            data.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], name));
        window.dispatchEvent(new DragEvent("drop", { dataTransfer: data, cancelable: true }));
    }, list);
}
const steps = (page, count) => page.evaluate((count) => {
    for (let i = 0; i < count; ++i) window.lendulet.player.step();
    const { world } = window.lendulet.player;
    return { hash: world.hash, step: world.stepCount, now: Array.from(window.lendulet.player.now) };
}, count);
async function saved(page, action) {
    const [file] = await Promise.all([page.waitForEvent("download"), action()]);
    return readFileSync(await file.path());
}

export const fileChecks = {
    async "files: glTF is dropped, built and simulated; wrong files are said"({ open }) {
        const page = await open({ acceptDownloads: true }, "?shadows=0#scene=stack:3&paused=1");
        const gltf = readFileSync(new URL("../../scenes/files/playground.gltf", import.meta.url));
        await drop(page, "playground.gltf", gltf);
        await until(page, () => window.lendulet.player.sceneName === "playground.gltf");
        const built = await page.evaluate(() => {
            const { world } = window.lendulet.player;
            return { bodies: world.shapes().bodies, joints: world.joints().length };
        });
        assert.ok(built.bodies > 5, `${built.bodies} bodies`);
        const { now } = await steps(page, 60);
        assert.ok(now.every(Number.isFinite));
        // A file with meshes, dropped together with its buffer: they are drawn in place of what collides.
        const folder = new URL("../../scenes/files/", import.meta.url);
        const meshes = ["meshes.bin", "meshes.gltf"].flatMap((name) => [name, readFileSync(new URL(name, folder))]);
        await drop(page, ...meshes.slice(2));
        await until(page, () => document.getElementById("message").textContent.includes("files beside it"));
        await drop(page, "other.bin", "x", ...meshes.slice(2));
        await until(page, () => document.getElementById("message").textContent.includes("meshes.bin, which"));
        await drop(page, ...meshes);
        await until(page, () => window.lendulet.player.sceneName === "meshes.gltf");
        await until(page, () => window.lendulet.picture.visuals !== null);
        assert.ok((await steps(page, 30)).now.every(Number.isFinite));
        // The bowl alone is a mesh.
        assert.equal(await page.evaluate(() => window.lendulet.picture.visuals.parts.size), 1);
        // Its repro file holds the file.
        await page.click("#open-figures");
        const { hash } = await steps(page, 30);
        const repro = await saved(page, () => page.click("#save-repro"));
        await drop(page, "playground.gltf", gltf);
        await until(page, () => window.lendulet.player.sceneName === "playground.gltf");
        await drop(page, "repro.json", repro);
        await until(page, () => window.lendulet.player.sceneName === "meshes.gltf");
        assert.equal((await steps(page, 60)).hash, hash);
        await until(page, () => document.getElementById("message").textContent.startsWith("The same bits"));
        await drop(page, "playground.gltf", gltf);
        await until(page, () => window.lendulet.player.sceneName === "playground.gltf");
        for (const [name, bytes, said] of [["broken.gltf", "{\"asset\":", "malformed"], ["old.gltf", "{}", "glTF 2.0"],
            ["picture.png", "x", "neither"], ["empty.glb", "", "malformed"],
            ["empty.json", "", "not JSON"], ["null.json", "null", "no repro"],
            ["odd.json", JSON.stringify({ lendulet: "repro", version: 1, scene: "stack", steps: 1, hash: "",
                deeds: [{ step: 0, command: { do: "explode" } }] }), "cannot be done"], ["no.json", "{}", "repro"],
            ["cut.rec", "LENDREC\n\x02\x00", "too early"]]) {
            await drop(page, name, bytes);
            await until(page, (said) => document.getElementById("message").textContent.includes(said), said);
            assert.equal(await page.evaluate(() => window.lendulet.player.sceneName), "playground.gltf", name);
        }
    },

    async "files: a recording made in the page is sound, and one of the program plays, seeks and shows its shapes"({
        open, program,
    }) {
        const folder = mkdtempSync(join(tmpdir(), "lendulet-"));
        try {
            const page = await open({ ...wide, acceptDownloads: true }, "?shadows=0#scene=convex_pile:30&paused=1");
            await page.click("#record");
            await steps(page, 20);
            await page.evaluate(() => window.lendulet.hand.shoot(300, 200));
            const { now, hash } = await steps(page, 10);
            const bytes = await saved(page, () => page.click("#record"));
            const file = join(folder, "page.rec");
            writeFileSync(file, bytes);
            const info = execFileSync(program, ["info", file], { encoding: "utf8" });
            assert.match(info, /steps +30 /);
            assert.ok(info.includes(hash), info);
            await drop(page, "page.rec", bytes);
            await until(page, () => window.lendulet.player.world.kind === "recording");
            const played = await steps(page, 30);
            assert.equal(played.hash, hash);
            assert.ok(played.now.every((v, i) => i % 8 === 3 || Math.abs(v - now[i]) < 1e-4), "the poses are others");

            const other = join(folder, "program.rec");
            execFileSync(program, ["run", "mesh_terrain:40", "--seconds", "3", "--record", other, "--quiet"]);
            await drop(page, "program.rec", readFileSync(other));
            await until(page, () => window.lendulet.player.world.length === 180);
            const moments = await page.evaluate(() => {
                const { player } = window.lendulet, { colliders, bodies } = player.world.shapes();
                const at = (step) => (player.look(step), player.now.slice(300, 308).join());
                const forward = [100, 130, 180].map(at), back = [180, 130, 100].map(at).reverse();
                return { forward, back, shapes: colliders.length, of: bodies };
            });
            assert.deepEqual(moments.forward, moments.back);
            assert.equal(moments.shapes, moments.of);
            await page.click("#shoot");
            await until(page, () => document.getElementById("message").textContent.includes("recording"));
        } finally {
            rmSync(folder, { recursive: true });
        }
    },

    async "files: a repro file and an address make the same run again, in the page and by the program"({
        open, program,
    }) {
        const page = await open({ ...wide, acceptDownloads: true }, "?shadows=0#scene=wall_ball:4&paused=1");
        await steps(page, 15);
        await page.click("#drop");
        await steps(page, 10);
        await page.evaluate(() => window.lendulet.change({ do: "set", solverSteps: 4 }));
        await steps(page, 20);
        await page.selectOption("#shape", "cone");
        await page.click("#drop"); // after the last step
        const hash = await page.evaluate(() => window.lendulet.player.world.hash);
        const repro = await saved(page, () => page.click("#save-repro"));
        // The address follows within a second: until both deeds are in it.
        const found = await until(page, () => {
            const deeds = /deeds=([^&]*)/.exec(location.hash)?.[1] ?? "";
            return atob(deeds.replaceAll("-", "+").replaceAll("_", "/")).includes("shape") && location.href;
        });
        const address = await found.jsonValue();
        await page.evaluate(() => window.lendulet.open("stack:3"));
        await drop(page, "again.json", repro);
        await until(page, () => window.lendulet.player.sceneName === "wall_ball:4");
        assert.equal((await steps(page, 45)).hash, hash);
        await until(page, () => document.getElementById("message").textContent.startsWith("The same bits"));
        const folder = mkdtempSync(join(tmpdir(), "lendulet-"));
        try {
            const file = join(folder, "again.json");
            writeFileSync(file, repro);
            const text = execFileSync(program, ["run", file, "--quiet", "--json", "-"], { encoding: "utf8" });
            assert.equal(JSON.parse(text).hash, hash);
        } finally {
            rmSync(folder, { recursive: true });
        }
        const other = await open({}, "?shadows=0" + new URL(address).hash + "&paused=1");
        assert.equal((await steps(other, 45)).hash, hash, "the address makes another run");
        const again = await other.evaluate(() => {
            const { player } = window.lendulet;
            return { deeds: player.deeds.map((d) => [d.step, d.command.do]), bodies: player.now.length / 8 };
        });
        assert.deepEqual(again.deeds, [[15, "box"], [25, "set"], [45, "shape"]]);
    },

    async "files: a picture and a film are saved, and show the scene"({ open, look }) {
        const page = await open({ ...wide, acceptDownloads: true }, "?shadows=0#scene=stack:4&paused=1");
        const picture = await saved(page, () => page.click("#save-picture"));
        assert.equal(picture.subarray(1, 4).toString(), "PNG");
        const { colours, commonest } = await look(page, picture);
        assert.ok(colours > 50 && commonest < 0.95, `${colours} colours, ${commonest} of one`);
        await page.click("#film");
        assert.equal(await page.getAttribute("#film", "aria-pressed"), "true");
        await page.waitForTimeout(1500);
        const film = await saved(page, () => page.click("#film"));
        assert.equal(await page.getAttribute("#film", "aria-pressed"), "false");
        assert.equal(film.readUInt32BE(0), 0x1a45dfa3, "no WebM");
        // It plays, in the canvas's size, and its picture is not empty.
        const shown = await page.evaluate(async (base64) => {
            const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
            const video = document.createElement("video"), canvas = document.getElementById("canvas");
            video.muted = true;
            video.src = URL.createObjectURL(new Blob([bytes], { type: "video/webm" }));
            await new Promise((done, fail) => {
                video.onloadeddata = done;
                video.onerror = () => fail(new Error(video.error.message));
            });
            const pen = new OffscreenCanvas(video.videoWidth, video.videoHeight).getContext("2d");
            await video.play();
            await new Promise((done) => {
                video.onended = done;
                video.ontimeupdate = () => video.currentTime > 0.7 && done();
            });
            pen.drawImage(video, 0, 0);
            const { data } = pen.getImageData(0, 0, video.videoWidth, video.videoHeight);
            const colours = new Set(new Uint32Array(data.buffer)).size;
            const size = [canvas.width, canvas.height], film = [video.videoWidth, video.videoHeight];
            return { size, film, colours };
        }, film.toString("base64"));
        assert.ok(shown.film.every((v, i) => Math.abs(v - shown.size[i]) <= 1), JSON.stringify(shown));
        assert.ok(shown.colours > 50, JSON.stringify(shown));
    },

    async "settings change while the world runs, and rewinding goes back to the old ones"({ open }) {
        const page = await open(wide, "?shadows=0#scene=stack:4&paused=1");
        const base = await steps(page, 40);
        await page.fill("#set-gravity", "-3");
        await page.press("#set-gravity", "Enter");
        await page.selectOption("#set-broad-phase", { label: "sweep-3" });
        await page.fill("#set-friction", "0.1");
        await page.press("#set-friction", "Enter");
        const tuned = await page.evaluate(() => window.lendulet.player.world.settings());
        assert.equal(tuned.gravity[1], 3);
        assert.equal(tuned.broadPhase, 2);
        assert.ok(Math.abs(tuned.friction - 0.1) < 1e-6);
        const risen = await steps(page, 60);
        assert.ok(risen.now[8 * 4 + 1] > base.now[8 * 4 + 1] + 0.5, "it rises");
        await page.fill("#set-substeps", "2000");
        await page.press("#set-substeps", "Enter");
        await until(page, () => document.getElementById("message").textContent.includes("64"));
        await page.evaluate(() => window.lendulet.player.look(6));
        const again = await steps(page, 10);
        assert.equal(again.step, 40);
        assert.equal(again.hash, base.hash);
    },

    async "a fork keeps the bits until something is done to one of the two"({ open }) {
        const page = await open(wide, "?shadows=0#scene=large_pyramid:5&paused=1");
        await steps(page, 20);
        await page.click("#fork");
        await steps(page, 30);
        const hashes = () => page.evaluate(() => {
            const { world, twin, apart } = window.lendulet.player;
            return [world.hash, twin.hash, apart];
        });
        const [a, b, none] = await hashes();
        assert.equal(a, b);
        assert.equal(none, 0);
        await until(page, () => document.getElementById("apart").textContent.includes("same bits"));
        await page.click("#shoot");
        await steps(page, 40);
        const [c, d, far] = await hashes();
        assert.notEqual(c, d);
        assert.ok(far > 0.1, `${far} m apart`);
        await page.click("#fork");
        assert.equal(await page.evaluate(() => window.lendulet.player.twin), null);
        assert.ok(!(await page.isVisible("#futures")));
    },

    async "the engine's own structures are drawn: boxes, levels, intervals, joints, momenta, islands, colours"({
        open,
    }) {
        const page = await open(wide, "?shadows=0#scene=ragdolls:4&paused=1");
        await steps(page, 70);
        const lines = () => page.evaluate(() => {
            window.lendulet.frame();
            const { children } = window.lendulet.picture.structure.group;
            return children.map((mesh) => (mesh.visible ? mesh.geometry.drawRange.count : 0));
        });
        await page.selectOption("#set-broad-phase", { label: "rtree-omt" });
        await steps(page, 1);
        const seen = {};
        for (const view of ["leaves", "levels", "intervals"]) {
            await page.selectOption("#boxes", view);
            seen[view] = (await lines())[0];
            assert.ok(seen[view] > 20, `${view}: ${seen[view]}`);
        }
        for (const id of ["show-joints", "show-momenta", "show-trails"]) await page.check(`#${id}`);
        await steps(page, 5);
        const [, joints, momenta, trails] = await lines();
        assert.ok(joints > 40 * 6 && momenta > 20 && trails > 20, `${joints} ${momenta} ${trails}`);
        const groups = await page.evaluate(() => {
            window.lendulet.setColours("island");
            const list = window.lendulet.player.world.groups();
            const kinds = (k) => new Set(list.filter((_, i) => i % 2 === k)).size;
            return { islands: kinds(0), colours: kinds(1) };
        });
        assert.ok(groups.islands >= 2 && groups.colours >= 2, JSON.stringify(groups));
        await page.selectOption("#colours", "colour");
    },
};
