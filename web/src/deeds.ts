// What is done by hand: commands, each with the step before which it is done. They make a run again, in repro files and
// in the page's address.
import type { Command } from "./engine/types";

export interface Deed {
    step: number;
    command: Command;
}

// What is to be done in a world, as it was once done by hand. `end`: what to do after so many steps.
export interface Script {
    deeds: Deed[];
    end?: { step: number; reached: () => void };
}

const longest = 8000; // characters of an address; browsers and chats take that many

type Test = (value: unknown) => boolean;
const isNumber: Test = (v) => typeof v === "number" && Number.isFinite(v);
const isWhole: Test = (v) => Number.isInteger(v) && (v as number) >= 0;
const isList: Test = (v) => Array.isArray(v) && v.length <= 4 && v.every(isNumber);
const isVector: Test = (v) => isList(v) && (v as number[]).length === 3;

const flight = { at: isVector, velocity: isVector, density: isNumber };
const members: Record<string, Record<string, Test>> = {
    sphere: { radius: isNumber, ...flight },
    box: { half: isVector, ...flight },
    shape: { type: isWhole, size: isList, rounding: isNumber, ...flight },
    grab: { body: isWhole, point: isVector },
    drag: { target: isVector },
    release: {},
    set: {},
};

function isCommand(value: unknown): value is Command {
    const command = value as Record<string, unknown> | null;
    const tests = typeof command === "object" && command ? members[command.do as string] : undefined;
    if (!tests || !command) return false;
    if (command.do === "set")
        return Object.entries(command).every(([name, v]) =>
            name === "do" || (name === "gravity" ? isVector(v) : isNumber(v)));
    return Object.entries(tests).every(([name, test]) => test(command[name]));
}
// In order of steps, and such that the engine can be asked to do them.
export function isDeeds(list: unknown): list is Deed[] {
    const isDeed = (d: Partial<Deed> | null, i: number, all: Partial<Deed>[]) =>
        isWhole(d?.step) && isCommand(d?.command) && (i === 0 || all[i - 1].step! <= d!.step!);
    return Array.isArray(list) && list.every(isDeed);
}

// With numbers of six digits: what is done is then what can be written down and read again.
export function tidy(command: Command): Command {
    const round = (v: unknown): unknown =>
        typeof v === "number" ? Number(v.toPrecision(6)) : Array.isArray(v) ? v.map(round) : v;
    return Object.fromEntries(Object.entries(command).map(([name, v]) => [name, round(v)])) as unknown as Command;
}

// Notes a deed. Of several drags before the same step the last one counts.
export function note(deeds: Deed[], deed: Deed): void {
    const last = deeds[deeds.length - 1];
    if (last?.step === deed.step && last.command.do === "drag" && deed.command.do === "drag") deeds.pop();
    deeds.push(deed);
}

// For an address; "" where there are none, or too many.
export function encode(deeds: Deed[]): string {
    if (deeds.length === 0) return "";
    const text = JSON.stringify(deeds.map(({ step, command }) => [step, command]));
    if (text.length > longest) return "";
    return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}
export function fits(deeds: Deed[]): boolean {
    return deeds.length === 0 || encode(deeds) !== "";
}
// Nothing where it is no list of deeds.
export function decode(text: string): Deed[] | undefined {
    try {
        const list = JSON.parse(atob(text.replaceAll("-", "+").replaceAll("_", "/"))) as [number, Command][];
        const deeds = list.map(([step, command]) => ({ step, command }));
        return isDeeds(deeds) ? deeds : undefined;
    } catch {
        return undefined;
    }
}
