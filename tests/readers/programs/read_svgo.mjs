/** SVGO with its default plugins; what it has written is read by Paper.js, its size in pixels of 1/96 inch. */

import { optimize } from "svgo";
import { PX, answer, text, userUnit } from "./answer.mjs";
import { paperContours } from "./paper_contours.mjs";

const { data } = optimize(text);
const [, size] = /<svg[^>]* width="([^"]*)"/.exec(data);
answer("svgo", paperContours(data), {
    scale: size.endsWith("mm") ? userUnit(data) : PX, // Paper.js applies the viewBox to sizes in pixels
    down: true,
    entities: [`width="${size}"`, ...Array(data.split("<path").length - 1).fill("path")],
});
