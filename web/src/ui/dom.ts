// Small helpers for the page's elements.

// The element of this id, which index.html has.
export function element<T extends HTMLElement = HTMLElement>(id: string): T {
    const found = document.getElementById(id);
    if (!found) throw new Error(`the page has no element "${id}"`);
    return found as T;
}

export function make<K extends keyof HTMLElementTagNameMap>(
    tag: K, text = "", attributes: Record<string, string> = {},
): HTMLElementTagNameMap[K] {
    const made = document.createElement(tag);
    made.textContent = text;
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    return made;
}

// A list of names and values whose values change often: elements are made once.
export class Pairs {
    private readonly values = new Map<string, HTMLElement>();
    constructor(private readonly list: HTMLElement) {}
    set(name: string, value: string): void {
        let shown = this.values.get(name);
        if (!shown) {
            shown = make("dd");
            this.list.append(make("dt", name), shown);
            this.values.set(name, shown);
        }
        if (shown.textContent !== value) shown.textContent = value;
    }
}

// A number to three digits or so, with a unit.
export function amount(value: number, unit: string): string {
    if (!Number.isFinite(value)) return "∞";
    const size = Math.abs(value);
    if (size !== 0 && (size >= 1e5 || size < 1e-3)) return `${value.toExponential(2).replace("e+", "e")} ${unit}`;
    const digits = size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3;
    return `${value.toFixed(digits).replace(/^-(0(\.0+)?)$/, "$1")} ${unit}`;
}
// Components to two decimals, fewer where they are large.
export function triple(v: readonly number[]): string {
    const size = Math.max(...v.map(Math.abs)), digits = size >= 100 ? 0 : size >= 10 ? 1 : 2;
    return v.map((x) => x.toFixed(digits).replace(/^-(0(\.0+)?)$/, "$1")).join("  ");
}
