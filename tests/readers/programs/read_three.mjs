/** three.js: `SVGLoader`, in the user units of the page; holes by its `createShapes`. */

import { JSDOM } from "jsdom";
import { SVGLoader } from "three/addons/loaders/SVGLoader.js";
import { SAMPLES, answer, text, userUnit } from "./answer.mjs";

globalThis.DOMParser = new JSDOM().window.DOMParser;
const { paths } = new SVGLoader().parse(text);
const parts = paths.flatMap((path) => path.subPaths);
const contours = parts.map((part) => ({
    points: part.curves.flatMap((curve) => curve.getPoints(SAMPLES).map(({ x, y }) => [x, y])),
    closed: part.autoClose || part.currentPoint.distanceTo(part.curves[0].getPoint(0)) === 0,
}));
answer("three", contours, {
    scale: userUnit(text),
    down: true,
    entities: parts.flatMap((part) => part.curves.map((curve) => curve.type)),
});
