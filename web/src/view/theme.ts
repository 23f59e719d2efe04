// Colours of the scene in light and dark, and of bodies by what they are and do.
import * as THREE from "three";

export interface Theme {
    dark: boolean;
    sky: number;      // background, and what fades into it
    ground: number;   // static bodies
    line: number;     // grid on them
    sun: number;
    sunStrength: number;
    hemisphere: [sky: number, earth: number, strength: number];
}

export const light: Theme = {
    dark: false, sky: 0xe9ecef, ground: 0xd9dcdd, line: 0xb3babf, sun: 0xfff1dd, sunStrength: 2.6,
    hemisphere: [0xf3f7ff, 0xb9b2a6, 1.5],
};
export const dark: Theme = {
    dark: true, sky: 0x14181d, ground: 0x39414a, line: 0x59646f, sun: 0xffe9cf, sunStrength: 2.3,
    hemisphere: [0xb4c4da, 0x55504a, 1.75],
};

// Eight muted colours that stand beside each other well in both themes.
const palette = [0xd98a5b, 0x6f9bb8, 0xd7b968, 0x7fa889, 0xb9798b, 0x8d8fc0, 0xc9a48a, 0x5f8f8b].map(
    (hex) => new THREE.Color(hex),
);
const resting = new THREE.Color(0x7d8894), restless = new THREE.Color(0xe0935a);
const slow = new THREE.Color(0x3f6f9f), middling = new THREE.Color(0xe6c66a), fast = new THREE.Color(0xc9463d);
const picked = new THREE.Color(0xffffff);
export const driven = new THREE.Color(0x9a86b8); // kinematic bodies

export type Colouring = "body" | "sleep" | "speed" | "island" | "colour";
export const colourings: Colouring[] = ["body", "sleep", "speed", "island", "colour"];

// A number of its own for each body, the same in every run.
function scramble(index: number): number {
    let h = Math.imul(index + 1, 0x9e3779b1);
    h ^= h >>> 15;
    return (Math.imul(h, 0x85ebca6b) ^ (h >>> 13)) >>> 0;
}

// `speed`: m/s, below 0 where the body sleeps.
export function colourOf(out: THREE.Color, how: Colouring, index: number, speed: number): void {
    if (how === "body") {
        const h = scramble(index);
        out.copy(palette[h % palette.length]);
        const shade = 0.9 + 0.2 * ((h >>> 8 & 255) / 255);
        out.multiplyScalar(shade);
    } else if (how === "sleep") {
        out.copy(speed < 0 ? resting : restless);
    } else {
        // Logarithmic: from a few centimetres to some ten metres a second.
        const t = speed <= 0 ? 0 : Math.min(Math.max(Math.log10(speed / 0.05) / 2.6, 0), 1);
        if (t < 0.5) out.lerpColors(slow, middling, 2 * t);
        else out.lerpColors(middling, fast, 2 * t - 1);
    }
}
// By the number of an island, or of a colour in which contacts are solved; below 0: none.
export function colourOfGroup(out: THREE.Color, group: number): void {
    if (group < 0) out.copy(resting);
    else out.setHSL(((group * 0.61803) % 1 + 1) % 1, 0.5, 0.58);
}
export function highlight(out: THREE.Color): void {
    out.lerp(picked, 0.55);
}
