// Pairs that show something, in the words of `lendulet explain`; the first is what the mode opens with.
export const pairs: [what: string, a: string, b: string][] = [
    ["distance", "box:0.5,0.4,0.3", "capsule:0.4,0.2@1.1,0.6,0.2@0,0,40"],
    ["distance", "box:0.6,0.4,0.5", "box:0.4,0.4,0.4@0.7,0.5,0.2@30,20,10"],
    ["distance", "hull:20,0.6", "cone:0.5,0.45@1.2,0.3,0.4@20,0,60"],
    ["distance", "cylinder:0.4,0.4", "box:0.4,0.3,0.4@0.5,0.4,0.2@10,20,30"],
    ["clip", "box:0.6,0.3,0.5", "box:0.4,0.3,0.4@0.4,0.59,0.2@0,30,0"],
    ["sat", "box:0.6,0.3,0.5", "box:0.4,0.3,0.4@0.4,0.59,0.2@0,30,10"],
];
