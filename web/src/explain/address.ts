// The mode in the page's address: #explain=WHAT&a=SHAPE&b=SHAPE&simplex=NAME&step=N, in words of `lendulet explain`.
import type { Question } from "./sequence";

const known = ["gjk", "epa", "distance", "clip", "sat"];

export interface Address extends Partial<Question> {
    simplex: string;
    step?: number;
}

export function isAddress(hash: string): boolean {
    return new URLSearchParams(hash.slice(1)).has("explain");
}
export function readAddress(hash: string): Address {
    const values = new URLSearchParams(hash.slice(1)), what = values.get("explain") ?? "", step = values.get("step");
    return {
        what: known.includes(what) ? what : undefined,
        simplex: values.get("simplex") === "barycentric" ? "barycentric" : "half-space",
        a: values.get("a") ?? undefined, b: values.get("b") ?? undefined,
        step: step !== null && Number(step) >= 1 ? Math.round(Number(step)) : undefined,
    };
}
// Replaces the address without a new entry in the browser's history.
export function writeAddress({ what, simplex, a, b }: Question, step: number): void {
    const more = simplex === "half-space" ? "" : `&simplex=${simplex}`;
    const hash = `#explain=${what}&a=${a}&b=${b}${more}&step=${step}`;
    if (location.hash !== hash) history.replaceState(null, "", hash);
}
// The same from the command line, as a picture.
export function commandOf({ what, simplex, a, b }: Question): string {
    return `lendulet explain ${what} ${a} ${b}${simplex === "half-space" ? "" : ` --simplex ${simplex}`}`;
}
