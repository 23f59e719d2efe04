// What the engine did with two shapes, step by step: the bytes of explain/flat.h as objects, and who is asked for them.
import { Module, fileBytes } from "../engine/module";
import { Refused } from "../engine/types";

export enum MarkKind {
    solid, face, path, dot, arrow,
}
export enum Ink {
    origin, difference, a, b, step, found,
}
export interface Solid {
    points: Float32Array;
    indices: Uint32Array;
    curved: boolean;
}
export interface Mark {
    kind: MarkKind;
    ink: Ink;
    solid: Solid | null;
    faint: boolean;
    points: Float32Array; // m, in the frame of A
    label: string;
    width: number; // pixels or so
    opacity: number;
}
export interface Step {
    title: string;
    note: string;
    marks: Mark[];
}
export interface Sequence {
    solids: Solid[]; // A, B, their difference
    steps: Step[];   // the first shows the shapes
}

export function sequenceAt(buffer: ArrayBuffer, start: number): Sequence {
    let at = start;
    const words = (count: number) => ((at += 4 * count), new Uint32Array(buffer, at - 4 * count, count));
    const [solidCount, stepCount, markCount, pointCount, indexCount, textBytes] = words(6);
    const solidWords = words(5 * solidCount), stepWords = words(6 * stepCount), markWords = words(10 * markCount);
    const coordinates = new Float32Array(words(3 * pointCount).slice().buffer), indices = words(indexCount).slice();
    const bytes = new Uint8Array(buffer, at, textBytes).slice(), decoder = new TextDecoder();
    const text = (from: number, size: number) => decoder.decode(bytes.subarray(from, from + size));
    const rows = (list: Uint32Array, width: number) =>
        Array.from({ length: list.length / width }, (_, i) => list.subarray(width * i, width * (i + 1)));
    const points = (from: number, count: number) => coordinates.subarray(3 * from, 3 * (from + count));
    const real = (word: number) => new Float32Array(Uint32Array.of(word).buffer)[0];

    const solids = rows(solidWords, 5).map(([from, count, first, many, curved]): Solid =>
        ({ points: points(from, count), indices: indices.subarray(first, first + many), curved: curved !== 0 }));
    const marks = rows(markWords, 10).map(([kind, ink, solid, faint, from, count, label, size, width, opacity]): Mark =>
        ({
            kind, ink, solid: solids[solid] ?? null, faint: faint !== 0, points: points(from, count),
            label: text(label, size), width: real(width), opacity: real(opacity),
        }));
    const steps = rows(stepWords, 6).map(([title, titleBytes, note, noteBytes, first, many]): Step =>
        ({ title: text(title, titleBytes), note: text(note, noteBytes), marks: marks.slice(first, first + many) }));
    return { solids, steps };
}

// As `lendulet explain WHAT A B --simplex NAME` takes it.
export interface Question {
    what: string;
    simplex: string;
    a: string;
    b: string;
}
// Rejects with Refused where there is nothing to see.
export type Explain = (question: Question) => Promise<Sequence>;

// The engine's second module, loaded when it is first asked.
class Explainer extends Module {
    static async load(): Promise<Explainer> {
        return new Explainer(await Module.start(await fileBytes("lendulet_explain.wasm")));
    }
    ask({ what, simplex, a, b }: Question): Sequence {
        return this.withTexts([what, simplex, a, b], (texts) => this.with(new Uint8Array(4), (out) => {
            const size = this.call("lendulet_explain", ...texts, out), at = this.view.getUint32(out, true);
            if (size < 0) throw new Refused(this.text(at));
            return sequenceAt(this.buffer.slice(at, at + size), 0);
        }));
    }
}

let loading: Promise<Explainer> | null = null;
export const explainInPage: Explain = async (question) => {
    loading ??= Explainer.load();
    return (await loading).ask(question);
};
