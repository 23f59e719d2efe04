// A static server on the loopback interface for tests.
import { createReadStream, statSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";

const types = {
    ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml",
    ".wasm": "application/wasm", ".json": "application/json",
};

// As those servers that let the page's engine share memory between threads.
const isolated = { "cross-origin-opener-policy": "same-origin", "cross-origin-embedder-policy": "require-corp" };

// Resolves to { url, asked, close }; `asked`: paths that were asked for; `alone`: isolated from other pages.
export function serve(folder, alone = true) {
    const asked = [];
    const server = createServer((request, response) => {
        const path = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
        asked.push(path);
        const file = join(folder, normalize(path === "/" ? "/index.html" : path));
        if (!file.startsWith(folder) || !statSync(file, { throwIfNoEntry: false })?.isFile()) {
            response.writeHead(404).end();
            return;
        }
        const type = types[extname(file)] ?? "application/octet-stream";
        response.writeHead(200, { "content-type": type, ...(alone ? isolated : {}) });
        createReadStream(file).pipe(response);
    });
    return new Promise((resolve) =>
        server.listen(0, "127.0.0.1", () =>
            resolve({ url: `http://127.0.0.1:${server.address().port}/`, asked, close: () => server.close() })));
}
