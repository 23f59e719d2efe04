// How the page shows the built-in scenes (scenes.json): in which group, by what title, and in a size for looking at
// rather than for benchmarks. Scenes that are not in the table are shown under "More", in the engine's size.
import table from "./scenes.json";

interface Shown {
    title?: string;
    size?: number;
    follow?: string; // name of the body that the camera goes along with
    look?: number[]; // the box, by its two corners, that is seen first; without: what moves
}

export const groups = table as unknown as { title: string; scenes: Record<string, Shown> }[];

const shown = new Map(groups.flatMap(({ scenes }) => Object.entries(scenes)));

export function titleOf(name: string): string {
    const words = name.replaceAll("_", " ");
    return shown.get(name)?.title ?? words[0].toUpperCase() + words.slice(1);
}
export function sizeOf(name: string, engineSize: number): number {
    return shown.get(name)?.size ?? engineSize;
}
export function followedIn(name: string): string | undefined {
    return shown.get(name)?.follow;
}
export function lookIn(name: string): number[] | undefined {
    return shown.get(name)?.look;
}
export function isListed(name: string): boolean {
    return shown.has(name);
}
