// Tests of the page in a real browser: node test/run.mjs FOLDER [IMAGES [WORDS]]
// FOLDER: the built page. IMAGES: where pictures are written to; "-" or none: they are only looked at.
// WORDS: only checks whose names contain them; "quick": those that `./dev check web-quick` makes do with.
// CHROMIUM in the environment names another browser than /usr/bin/chromium, LENDULET another program than
// build/release/bin/lendulet.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { checks, look } from "./checks.mjs";
import { explainChecks } from "./explain.mjs";
import { fileChecks } from "./files.mjs";
import { nativeChecks } from "./native.mjs";
import { serve } from "./server.mjs";
import { threadChecks } from "./threads.mjs";
import { toolChecks } from "./tools.mjs";

const [folder, into = "-", words = ""] = process.argv.slice(2);
const quick = words === "quick";
const inQuick = ["every scene", "play,", "picking", "balls,", "files: glTF", "tools: all", "explain: a phone",
    "threads: native", "threads: without"];
const images = into === "-" ? null : into;
if (!folder) {
    console.error("usage: node test/run.mjs FOLDER [IMAGES [WORDS]]");
    process.exit(2);
}
const server = await serve(resolve(folder));
const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking",
        "--disable-component-update", "--disable-sync",
        "--disable-gpu-watchdog"], // where the machine is busy, drawing in software may stand for a while
});
const native = JSON.parse(readFileSync(join(folder, "native-hashes.json"), "utf8"));
if (images) mkdirSync(images, { recursive: true });

const problems = [];
let forgiven = null; // what the browser may complain of in this check
const ours = /^(http:\/\/(127\.0\.0\.1|localhost):|ws:\/\/localhost:|data:|blob:)/;
// A page in which every error and every request that leaves the machine is a failure.
// `missing`: a file that the server does not have for it.
async function open({ missing, ...options } = {}, address = "?shadows=0", url = server.url) {
    const context = await browser.newContext({ viewport: { width: 640, height: 400 }, ...options });
    const page = await context.newPage();
    page.setDefaultTimeout(90000); // the machine may be busy
    page.on("pageerror", (error) => problems.push(`error in the page: ${error.message}`));
    page.on("console", (entry) => {
        if (entry.type() === "error" && !forgiven?.test(entry.text())) problems.push(`the page says: ${entry.text()}`);
    });
    page.on("request", (request) => {
        if (!ours.test(request.url())) problems.push(`asks for ${request.url()}`);
    });
    if (missing) await page.route(`**/${missing}`, (route) => route.fulfill({ status: 404 }));
    await page.goto(url + address);
    await page.waitForFunction(() => window.lendulet !== undefined, null, { polling: 100 });
    return page;
}

const program = process.env.LENDULET ?? fileURLToPath(new URL("../../build/release/bin/lendulet", import.meta.url));
const tools = {
    open, look, native, scenes: quick ? 5 : 27, program, folder: resolve(folder), keeps: images !== null,
    forgive: (pattern) => (forgiven = pattern),
    save: (name, bytes) => images && writeFileSync(join(images, name), bytes),
};
let failed = 0;
const isChosen = (name) => (quick ? inQuick.some((start) => name.startsWith(start)) : name.includes(words));
const all = [checks, explainChecks, fileChecks, toolChecks, threadChecks, nativeChecks].flatMap(Object.entries);
const chosen = all.filter(([name]) => isChosen(name));
for (const [name, check] of chosen) {
    const start = Date.now();
    const took = () => `${((Date.now() - start) / 1000).toFixed(1).padStart(5)} s  ${name}`;
    problems.length = 0;
    forgiven = null;
    try {
        await check(tools);
        if (problems.length > 0) throw new Error(problems.join("\n"));
        console.log(`ok      ${took()}`);
    } catch (error) {
        ++failed;
        console.log(`FAILED  ${took()}\n${error.stack ?? error}`);
    }
    for (const context of browser.contexts()) await context.close();
}
await browser.close();
server.close();
if (failed > 0 || chosen.length === 0) console.log(`${failed} of ${chosen.length} failed`);
process.exit(failed > 0 || chosen.length === 0 ? 1 : 0);
