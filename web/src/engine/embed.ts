// A glTF file and the files that were dropped with it, as one file.
import { Refused } from "./types";

const types: Record<string, string> = { png: "image/png", jpg: "image/jpeg", jpeg: "image/jpeg", webp: "image/webp" };

export function base64(bytes: Uint8Array): string {
    let text = "";
    for (let at = 0; at < bytes.length; at += 0x8000) text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
    return btoa(text);
}

// Buffers and images that a .gltf file names are put into it where a file of that name, in whatever folder, is among
// those given. Anything else comes back as it is.
export async function withFiles(bytes: Uint8Array<ArrayBuffer>, files: File[]): Promise<Uint8Array<ArrayBuffer>> {
    if (files.length < 2) return bytes;
    let json: { buffers?: { uri?: string }[]; images?: { uri?: string }[] };
    try {
        json = JSON.parse(new TextDecoder().decode(bytes)) as typeof json;
    } catch {
        return bytes; // its reader says what is wrong
    }
    for (const part of [...(json.buffers ?? []), ...(json.images ?? [])]) {
        if (typeof part?.uri !== "string" || part.uri.startsWith("data:")) continue;
        const name = decodeURIComponent(part.uri).split("/").pop()!;
        const file = files.find((f) => f.name === name);
        if (!file) throw new Refused(`The file refers to ${name}, which was not dropped with it.`);
        const type = types[name.split(".").pop()!.toLowerCase()] ?? "application/octet-stream";
        part.uri = `data:${type};base64,${base64(new Uint8Array(await file.arrayBuffer()))}`;
    }
    return new TextEncoder().encode(JSON.stringify(json));
}
