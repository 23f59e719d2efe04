// The list of built-in scenes, in groups, with a search field.
import type { SceneInfo } from "../engine/types";
import { groups, isListed, sizeOf, titleOf } from "../scenes";
import { element, make } from "./dom";

export class SceneList {
    private readonly links = new Map<string, HTMLAnchorElement>();

    constructor(scenes: SceneInfo[], open: (scene: string) => void) {
        const list = element("list"), byName = new Map(scenes.map((s) => [s.name, s]));
        const add = (title: string, infos: SceneInfo[]) => {
            if (infos.length === 0) return;
            const section = make("section");
            section.append(make("h3", title));
            for (const info of infos) {
                const scene = nameWithSize(info);
                const link = make("a", titleOf(info.name), { href: `#scene=${scene}`, title: info.description });
                link.addEventListener("click", (event) => {
                    event.preventDefault();
                    open(scene);
                });
                section.append(link);
                this.links.set(info.name, link);
            }
            list.append(section);
        };
        for (const { title, scenes: names } of groups) {
            add(title, Object.keys(names).flatMap((name) => byName.get(name) ?? []));
        }
        add("More", scenes.filter((s) => !isListed(s.name)));
        const search = element<HTMLInputElement>("search");
        search.addEventListener("input", () => this.filter(search.value));
    }

    private filter(text: string): void {
        const wanted = text.trim().toLowerCase();
        for (const [name, link] of this.links) {
            const words = `${name} ${link.textContent} ${link.title}`.toLowerCase();
            link.hidden = !words.includes(wanted);
        }
        for (const section of document.querySelectorAll<HTMLElement>("#list section"))
            section.hidden = [...section.querySelectorAll("a")].every((link) => link.hidden);
    }

    mark(name: string): void {
        for (const [other, link] of this.links) {
            if (other === name) link.setAttribute("aria-current", "true");
            else link.removeAttribute("aria-current");
        }
    }
}

// As the page opens it.
export function nameWithSize(info: SceneInfo): string {
    const size = sizeOf(info.name, info.size);
    return size > 0 ? `${info.name}:${size}` : info.name;
}
